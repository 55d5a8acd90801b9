"""The values of the report's first page: the outcome in one sentence, the broken rules, and the verdicts by pack."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import pyarrow.compute as pc

from drivelint.report.outcome import headline
from drivelint.report.worst_first import certainty_rank, is_contact, moment_ns, worst_time_words
from drivelint.result import counts
from drivelint.result.certainty import POSSIBLE, certainty
from drivelint.result.text import closing_speed_words, ego_name, measure, non_breaking, seconds

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.report.html.incidents import FindingLine
    from drivelint.result.model import Result
    from drivelint.result.text import Row

_MOST_NAMED_CONTACTS: Final = 4
_LEAST_KM_FOR_RATES: Final = 100.0
_DRIVE_SUMMARIES_UP_TO_N_DRIVES: Final = 6
_MOST_NAMED_PARTIES: Final = 6


def page_headline(result: Result) -> tuple[str, str, str]:
    """Return the outcome (fail, near, unknown, not_applicable or pass), the word for it, and the sentence at the top of the page."""
    outcome = headline(result)
    return outcome.kind, outcome.label, outcome.sentence[:1].upper() + outcome.sentence[1:]


def contact_summary(result: Result, lines: Sequence[FindingLine], rules: Mapping[str, Row]) -> dict[str, Any] | None:
    """Return the contacts of all findings, with their times; None if no finding is a contact. `lines`: the findings of the page.

    `named`: the first contacts in words, each with a link to its surest finding; `n_more`: the number of further contacts;
    `sure`: False if all contacts are only possible.
    """
    starts = result.start_times
    hrefs = {line.row["finding_id"]: line.href for line in lines}
    ordered = result.findings.sort_by([("drive_id", "ascending"), ("t_worst_ns", "ascending")]).to_pylist()
    touches = [row for row in ordered if is_contact(row, rules)]
    met = counts.group_rows(touches, lambda row: (row["drive_id"], frozenset((row["ego_id"], row["object_id"]))))
    contacts = []
    for rows in met.values():
        first = min(rows, key=certainty_rank)
        names = ego_name(first["ego_id"]) + ("" if first["object_id"] is None else f" and object {first['object_id']}")
        # print the depth of the overlap: one centimetre may be an error of the recorder
        measured_rows = [row for row in rows if row["unit"] == "m" and row["observed"] is not None]
        worst = min(measured_rows, key=lambda row: row["observed"], default=None)
        later = (
            "" if worst is None else worst_time_words(worst, rules, starts[worst["drive_id"]]).removeprefix("deepest")
        )
        deep = "" if worst is None else f", {measure(-worst['observed'], 'm')} deep{non_breaking(later)}"
        speed = "" if first["closing_mps"] is None else f", {closing_speed_words(first['closing_mps'])}"
        where = f", {first['drive_id']}" if len(starts) > 1 else ""
        text = f"{names} at {non_breaking(seconds(moment_ns(first, rules), starts[first['drive_id']]))}{speed}{deep}{where}"
        doubt = certainty(first) == POSSIBLE
        contacts.append((f"possibly {text}" if doubt else text, hrefs.get(first["finding_id"], ""), doubt))
    if not contacts:
        return None
    sure = not all(doubt for *_, doubt in contacts)
    return {
        "named": [contact[:2] for contact in contacts[:_MOST_NAMED_CONTACTS]],
        "n_more": len(contacts[_MOST_NAMED_CONTACTS:]),
        "sure": sure,
    }


def finding_rates(result: Result, events: Sequence[Row]) -> dict[str, Any]:
    """Return, by severity, the number of findings, of drives with findings, and of findings per 100 km and per hour of driving.

    `events`: one finding of each event.
    `per`: whether the drives together are long enough for rates (100 km and 1 hour).
    """
    km, hours = (float(pc.sum(result.drives[name]).as_py() or 0.0) for name in ("km", "duration_s"))
    hours /= 3600
    by_severity = counts.group_rows(events, lambda row: row["severity"])
    rows = [
        {
            "severity": severity,
            "n": len(by_severity[severity]),
            "n_drives": len({row["drive_id"] for row in by_severity[severity]}),
            "per_100_km": 100 * len(by_severity[severity]) / km if km else None,
            "per_hour": len(by_severity[severity]) / hours if hours else None,
        }
        for severity in counts.SEVERITIES
        if severity in by_severity
    ]
    return {"rows": rows, "per": km >= _LEAST_KM_FOR_RATES and hours >= 1}


def broken_rules(
    result: Result, rules: Mapping[str, Row], lines: Sequence[FindingLine], events: Sequence[Row]
) -> list[dict[str, Any]]:
    """Return the rules with findings, the gravest and most frequent first.

    `worst`: the rule's worst finding on the page, None if the page shows none of its findings. `events`: one finding of each event.
    """
    verdicts = counts.verdict_counts_by(result.verdicts, "rule_id")
    lines_by_rule = counts.group_rows(lines, lambda line: line.row["rule_id"])
    entries = [
        {
            "rule": rules[rule_id],
            "n": len(rows),
            "n_drives": len({row["drive_id"] for row in rows}),
            "n_fail": verdicts[rule_id]["fail"],
            "n_judged": verdicts[rule_id]["fail"] + verdicts[rule_id]["pass"],
            "worst": min(lines_by_rule.get(rule_id, []), key=_margin_of_finding_line, default=None),
        }
        for rule_id, rows in counts.group_rows(events, lambda row: row["rule_id"]).items()
    ]
    return sorted(
        entries, key=lambda b: (counts.SEVERITIES.index(b["rule"]["severity"]), -b["n"], b["rule"]["rule_id"])
    )


def _margin_of_finding_line(line: FindingLine) -> float:
    return float("-inf") if line.row["margin"] is None else line.row["margin"]


def pack_summaries(result: Result) -> list[dict[str, Any]]:
    """Return, for each pack, the number of its rules and of its verdicts of each kind."""
    verdicts_by_pack = counts.verdict_counts_by_pack(result.rules, result.verdicts)
    rules = counts.group_rows(result.rules.select(["pack", "pack_title"]).to_pylist(), lambda row: row["pack"])
    return [
        {
            "pack": pack,
            "about": rules[pack][-1]["pack_title"],
            "n_rules": len(rules[pack]),
            "verdicts": verdicts,
            "shares": verdict_shares(verdicts),
        }
        for pack, verdicts in verdicts_by_pack.items()
    ]


def verdict_shares(verdicts: Mapping[str, int]) -> list[dict[str, Any]]:
    """Return each kind of verdict with its number, and its position and width in a bar in percent."""
    total, at, shares = sum(verdicts.values()), 0.0, []
    for verdict in ("fail", "error", "unknown", "pass", "not_applicable"):
        width = 100 * verdicts[verdict] / total if total else 0.0
        shares.append({"verdict": verdict, "n": verdicts[verdict], "x": f"{at:.3f}%", "w": f"{width:.3f}%"})
        at += width
    return shares


def drive_summaries(sections: Sequence[Mapping[str, Any]], n_drives: int) -> list[dict[str, Any]]:
    """Return the gravest moments of each drive in time order; an empty list if the first page has no room for so many drives.

    `who`: the vehicles and people that the findings are about.
    """
    summaries = []
    for section in sections if n_drives <= _DRIVE_SUMMARIES_UP_TO_N_DRIVES else ():
        parties = [f"{party['name']} ({party['what']})" for party in section["parties"] if party["n"]]
        summary = {
            "drive_id": section["drive_id"],
            "file_name": section["file_name"],
            "who": parties[:_MOST_NAMED_PARTIES],
            "n_more": len(parties[_MOST_NAMED_PARTIES:]),
            "moments": [moment for moment in section["moments"] if moment["leading"]],
        }
        summaries += [summary] if summary["moments"] else []
    return summaries


def first_page_texts(
    rules: Sequence[Mapping[str, Any]], summaries: Sequence[Mapping[str, Any]], lines: Sequence[FindingLine]
) -> list[str]:
    """Return the texts of the first page about rules and findings; words in them may need an explanation."""
    worst = [b["worst"] for b in rules if b["worst"] is not None]
    leading = [
        line for story in summaries for moment in story["moments"] for _, lines_ in moment["cards"] for line in lines_
    ]
    profiles = {line.row["profile"] or "" for line in lines}
    return [b["rule"]["title"] for b in rules] + [line.sentence for line in worst + leading] + sorted(profiles)
