"""What one party did around the moment, by the verdicts on it: rules broken, kept, not decided, and never asked."""

from __future__ import annotations

from textwrap import shorten
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.catalogue.header import CONTACT
from drivelint.incident.words import how_sure, measured, profile
from drivelint.phrases import listed
from drivelint.report.html.reasons import summarise_reasons, verdict_reason
from drivelint.result.counts import SEVERITIES, grouped
from drivelint.result.text import seconds

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.result.text import Row

_UNDECIDED: Final = frozenset({"unknown", "error"})
_ROOM: Final = {"broken": 820, "kept": 240, "near": 80, "reasons": 330}
"""Characters that each part has on the page at least; the number of what is left out is told."""
_WASTE: Final = 12
"""Characters that the end of a text's last line leaves empty."""
_ALL_ROOM: Final = 1680
"""Characters of all parts: what one does not use, the others may."""
_SECOND_ROOM: Final = 45
"""Characters that fit where the table second by second has a row less than its most."""


def conduct(
    verdicts: Iterable[Row],
    findings: Iterable[Row],
    rules: Mapping[str, Row],
    span: tuple[int, int],
    start_ns: int,
    *,
    seconds_left: int = 0,
) -> dict[str, Any]:
    """Return what the verdicts and findings of one ego say about a span of the drive.

    A rule counts once, by its worst verdict there: broken, not decided (or in error), kept, or never asked; `elsewhere`: broken, but
    only outside the span. `near`: of the rules that are kept,
    those with a near miss. A verdict without a time is about the whole drive. `seconds_left`: rows that the table second by second
    does not fill. `only_hit`: nothing but a contact was found.
    """
    told = {name: [row for row in rows if _within(row, span)] for name, rows in (("v", verdicts), ("f", findings))}
    by_rule = grouped(told["v"], lambda row: row["rule_id"])
    found = grouped(told["f"], lambda row: row["rule_id"])
    failures = {rule: [row for row in rows if row["verdict"] == "fail"] for rule, rows in by_rule.items()}
    # a verdict is about a judged interval, which may be longer than the span: its findings say when the rule was broken
    failed = {rule for rule, rows in failures.items() if any(not row["finding_ids"] for row in rows)}
    elsewhere = {rule for rule, rows in failures.items() if rows} - failed - found.keys()
    broken = sorted(found.keys() | failed, key=lambda rule: (SEVERITIES.index(rules[rule]["severity"]), rule))
    rest = {rule: rows for rule, rows in sorted(by_rule.items()) if rule not in set(broken)}
    undecided = {rule: rows for rule, rows in rest.items() if any(row["verdict"] in _UNDECIDED for row in rows)}
    kept = [
        rule
        for rule, rows in rest.items()
        if rule not in undecided and rule not in elsewhere and any(row["verdict"] == "pass" for row in rows)
    ]
    parts = {
        "broken": [_line(rules[rule], found.get(rule) or by_rule[rule], start_ns) for rule in broken],
        "kept": [_quoted(rules[rule]) for rule in kept],
        "near": [_quoted(rules[rule]) for rule in kept if any(row["near_miss"] for row in rest[rule])],
        "reasons": _reasons(undecided, rules),
    }
    spare = (
        _ALL_ROOM + _SECOND_ROOM * seconds_left - sum(min(_length(parts[name]), room) for name, room in _ROOM.items())
    )
    told_parts = {}
    for name, room in _ROOM.items():
        told_parts[name] = _fitting(parts[name], min(room, _length(parts[name])) + max(spare, 0))
        spare -= max(_length(told_parts[name].shown) - room, 0)
    return {
        "n": {"broken": len(broken), "kept": len(kept), "undecided": len(undecided)},
        **told_parts,
        "only_hit": bool(broken) and all(CONTACT in rules[rule]["tags"] for rule in broken),
        "elsewhere": len(elsewhere - undecided.keys()),
        "never": len(rules) - len(broken) - len(undecided) - len(kept) - len(elsewhere - undecided.keys()),
    }


class Fitting(NamedTuple):
    """The first of some texts, and how many more there are."""

    shown: list[str]
    more: int


def _length(texts: Sequence[str]) -> int:
    """Return the room that texts take, in characters."""
    return sum(len(text) + _WASTE for text in texts)


def _fitting(texts: Sequence[str], room: int) -> Fitting:
    """Return as many of the texts as fit, at least one."""
    shown = list(texts[:1])
    for text in texts[1:]:
        if _length([*shown, text]) > room:
            break
        shown.append(text)
    return Fitting(shown, len(texts) - len(shown))


def _quoted(rule: Row) -> str:
    """Return what a rule asks, in quotes: it is true where the rule is kept."""
    return f"\u201c{rule['title']}\u201d"


def short_clause(clause: str) -> str:
    """Return the number of a clause without what it says."""
    return clause.partition(":")[0].partition(" (")[0]


def _within(row: Row, span: tuple[int, int]) -> bool:
    start, end = row["t_start_ns"], row["t_end_ns"]
    return start is None or end is None or (start <= span[1] and end >= span[0])


def _line(rule: Row, rows: Sequence[Row], start_ns: int) -> str:
    """Return the worst finding of a rule in words, and how many there are."""
    row = min(rows, key=lambda r: (r["margin"] is None, r["margin"] or 0.0, r["t_worst_ns"] or 0))
    times = f" ({len(rows)} findings)" if len(rows) > 1 else ""
    about = f"{short_clause(rule['clause'])}, {rule['severity']}"
    what = measured(row, rule) or shorten(row["reason"], 120, placeholder=" ...")
    sure = f"; {how_sure(row)}" if row.get("n_copies") is not None else ""
    return f"{_quoted(rule)}{profile(row['profile'])} ({about}): {seconds(row['t_worst_ns'], start_ns)}, {what}{times}{sure}"


def _reasons(undecided: Mapping[str, Sequence[Row]], rules: Mapping[str, Row]) -> list[str]:
    """Return why rules are not decided, in words, the reason of most rules first."""
    unknown = [row for rows in undecided.values() for row in rows if row["verdict"] in _UNDECIDED]
    told = []
    for rows in grouped(unknown, lambda row: verdict_reason(row).kind).values():
        titles = [_quoted(rules[rule]) for rule in sorted({row["rule_id"] for row in rows})]
        why = shorten(summarise_reasons(verdict_reason(row) for row in rows), 100, placeholder=" ...")
        told.append((-len(titles), why, f"{listed(titles, 3)}: {why}"))
    return [text for *_, text in sorted(told)]
