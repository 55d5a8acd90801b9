"""The conduct of one party around the moment, from its verdicts: rules broken, kept, undecided, and never applicable."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

from drivelint.catalogue.header import CONTACT_TAG, EXCUSABLE_RULE_TAG
from drivelint.incident.breaches import broken_rule_line, kept_rule_line, quoted_title, reason_without_advice
from drivelint.incident.fitting import UndecidedReason
from drivelint.report.html.reasons import summarise_reasons, verdict_reason
from drivelint.result.counts import SEVERITIES, group_rows

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.result.text import Row

_QUOTATION_PATTERN: Final = re.compile("(\u201c[^\u201d]*\u201d)")
_EGO_PATTERN: Final = re.compile(r"\b[Tt]he ego\b")
_ACTOR_PATTERN_TEXT: Final = (
    r"(?:\b(?:object|actor) {0}(?![\w.-])|(?<=\bwith ){0}(?=:)|(?<![\w.-]){0}(?= (?:ran into|braked at|passed with)\b))"
)
"""An actor in the text of a reason: its id alone may be a number, which other numbers must not be taken for."""
_UNDECIDED_VERDICTS: Final = frozenset({"unknown", "error"})


def conduct_texts_and_counts(
    verdicts: Iterable[Row],
    findings: Iterable[Row],
    rules: Mapping[str, Row],
    span_ns: tuple[int, int],
    drive_start_ns: int,
    *,
    is_about_contact: bool = False,
) -> dict[str, Any]:
    """Return the conduct of one ego in a span of the drive, as lists of texts and numbers of rules.

    A rule counts once, by its worst verdict in the span: broken, undecided (or in error), kept, or never applicable. A verdict without
    a time is about the whole drive. `elsewhere`: rules broken only outside the span. `excused`: kept rules that may excuse what their
    titles forbid. `beside`: rules about contacts that found none although another rule did; these rules do not count as kept.
    `only_hit`: only rules about contacts were broken. `is_about_contact`: the sheet is about a contact.
    """
    rows_in_span = {
        name: [row for row in rows if _overlaps_span(row, span_ns)] for name, rows in (("v", verdicts), ("f", findings))
    }
    by_rule = group_rows(rows_in_span["v"], lambda row: row["rule_id"])
    findings_by_rule = group_rows(rows_in_span["f"], lambda row: row["rule_id"])
    failures = {rule: [row for row in rows if row["verdict"] == "fail"] for rule, rows in by_rule.items()}
    # a verdict's interval may be longer than the span: the times of its findings decide
    failed = {rule for rule, rows in failures.items() if any(not row["finding_ids"] for row in rows)}
    elsewhere = {rule for rule, rows in failures.items() if rows} - failed - findings_by_rule.keys()
    broken = sorted(
        findings_by_rule.keys() | failed, key=lambda rule: (SEVERITIES.index(rules[rule]["severity"]), rule)
    )
    rest = {rule: rows for rule, rows in sorted(by_rule.items()) if rule not in set(broken)}
    undecided = {
        rule: rows for rule, rows in rest.items() if any(row["verdict"] in _UNDECIDED_VERDICTS for row in rows)
    }
    kept_rules = [
        rule
        for rule, rows in rest.items()
        if rule not in undecided and rule not in elsewhere and any(row["verdict"] == "pass" for row in rows)
    ]
    is_about_contact |= any(CONTACT_TAG in rules[rule]["tags"] for rule in broken)
    beside = [rule for rule in kept_rules if is_about_contact and CONTACT_TAG in rules[rule]["tags"]]
    kept_rules = [rule for rule in kept_rules if rule not in beside]
    passed = {rule: [row for row in rest[rule] if row["verdict"] == "pass"] for rule in (*kept_rules, *beside)}
    lines = {rule: kept_rule_line(rules[rule], rows, span_ns, drive_start_ns) for rule, rows in passed.items()}
    parts = {
        "broken": [
            broken_rule_line(
                rules[rule],
                findings_by_rule.get(rule) or [row for row in by_rule[rule] if row["verdict"] == "fail"],
                drive_start_ns,
            )
            for rule in broken
        ],
        "kept": [lines[rule] for rule in kept_rules if EXCUSABLE_RULE_TAG not in rules[rule]["tags"]],
        "excused": [lines[rule] for rule in kept_rules if EXCUSABLE_RULE_TAG in rules[rule]["tags"]],
        "reasons": _undecided_reasons(undecided, rules),
    }
    return {
        "n": {"broken": len(broken), "kept": len(kept_rules), "undecided": len(undecided)},
        **parts,
        "only_hit": bool(broken) and all(CONTACT_TAG in rules[rule]["tags"] for rule in broken),
        "beside": [lines[rule] for rule in beside],
        "elsewhere": len(elsewhere - undecided.keys()),
        "never": len(rules) - len(broken) - len(undecided) - len(passed) - len(elsewhere - undecided.keys()),
    }


def conduct_with_party_name(
    conduct_lists: Mapping[str, Any], party_name: str, other_party: tuple[str, str] | None = None
) -> dict[str, Any]:
    """Return the texts about a party with `party_name` instead of "the ego"; titles in quotation marks are not changed.

    `other_party`: id and letter of the other party, which is named by its letter too; None: there is none.
    """
    named_lists = dict(conduct_lists)
    for part in ("broken", "kept", "excused", "beside"):
        if part in conduct_lists:
            named_lists[part] = [text_with_party_names(line, party_name, other_party) for line in conduct_lists[part]]
    if "reasons" in conduct_lists:
        named_lists["reasons"] = [
            reason._replace(why=text_with_party_names(reason.why, party_name, other_party))
            for reason in conduct_lists["reasons"]
        ]
    return named_lists


def text_with_party_names(text: str, party_name: str, other_party: tuple[str, str] | None = None) -> str:
    """Return a text with the letters of the parties; see `conduct_with_party_name`."""
    parts = _QUOTATION_PATTERN.split(text)
    unquoted = range(0, len(parts), 2)
    for i in unquoted:
        parts[i] = _EGO_PATTERN.sub(party_name, parts[i])
        if other_party is not None:
            actor_id, letter = other_party
            parts[i] = re.sub(_ACTOR_PATTERN_TEXT.format(re.escape(actor_id)), letter, parts[i])
    return "".join(parts)


def _overlaps_span(row: Row, span_ns: tuple[int, int]) -> bool:
    start, end = row["t_start_ns"], row["t_end_ns"]
    return start is None or end is None or (start <= span_ns[1] and end >= span_ns[0])


def _undecided_reasons(undecided: Mapping[str, Sequence[Row]], rules: Mapping[str, Row]) -> list[UndecidedReason]:
    """Return the reasons why rules are undecided: reasons of rules about contacts first, then the most frequent reasons."""
    unknown = [row for rows in undecided.values() for row in rows if row["verdict"] in _UNDECIDED_VERDICTS]
    of_rules: dict[str, set[str]] = {}
    for rows in group_rows(unknown, lambda row: verdict_reason(row).kind).values():
        reasons = (verdict_reason(row) for row in rows)
        why = summarise_reasons(reason._replace(text=reason_without_advice(reason.text)) for reason in reasons)
        of_rules.setdefault(why, set()).update(row["rule_id"] for row in rows)  # reasons may differ only in advice
    merged_reasons = [
        UndecidedReason(why, tuple(quoted_title(rules[rule]) for rule in sorted(rule_ids)))
        for why, rule_ids in of_rules.items()
    ]
    contacts = {quoted_title(rule) for rule in rules.values() if CONTACT_TAG in rule["tags"]}
    return sorted(merged_reasons, key=lambda reason: (contacts.isdisjoint(reason.titles), -len(reason.titles), reason))
