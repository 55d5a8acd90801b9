"""What `drivelint audit` prints at its end, in one screen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from drivelint.phrases import one_line, plural
from drivelint.result.counts import SEVERITIES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from drivelint.audit.summary import AuditSummary
    from drivelint.errors import ExitCode


def summary_text(counted: AuditSummary, out: str, code: ExitCode, gate: Iterable[str] = ()) -> str:
    """Return the lines: drives, findings by severity, broken rules, unknowns, what was not judged, the gate, and what to do next."""
    return "\n".join(map(one_line, _lines(counted, out, code, gate)))


def _lines(counted: AuditSummary, out: str, code: ExitCode, gate: Iterable[str]) -> Iterator[str]:
    n_refused = counted.refused - counted.copies_not_judged
    n_drives = counted.n_drives - counted.copies - counted.copies_not_judged
    yield f"{plural(n_drives, 'drive')} of {counted.hours:,.2f} h; their egos drove {counted.km:,.2f} km"
    states = (
        f"{counted.judged - counted.copies} judged",
        f"{n_refused} refused" if n_refused else "",
        f"{counted.quarantined} quarantined" if counted.quarantined else "",
        f"{counted.lossy} lossy" if counted.lossy else "",
        f"{counted.off_map} off their map" if counted.off_map else "",
        f"{counted.reused} had a result already" if counted.reused else "",
    )
    yield ", ".join(state for state in states if state)
    yield from _named("lossy", counted.lossy_logs, counted.lossy)
    yield from _named("off their map", counted.off_map_logs, counted.off_map)
    yield from _copies(counted, out)
    if counted.missing_parts:
        of = (
            ""
            if counted.n_asked is None
            else f"{counted.n_drives} of {plural(counted.n_asked, 'drive')} have a result: "
        )
        yield f"INCOMPLETE: these parts have not ended: {', '.join(counted.missing_parts)}: {of}give the same audits again"
    elif counted.n_asked is not None and counted.n_asked != counted.n_drives:
        yield f"asked for: {plural(counted.n_asked, 'log')}{_difference(counted)}"
    if counted.digest is None:
        yield f"when all parts have ended: drivelint merge {out}"
        return
    found = [f"{counted.findings.get(severity, 0)} {severity}" for severity in SEVERITIES]
    sure = f"examined: {counted.possible} only possible" if counted.robust else "not examined: --robustness"
    yield f"findings: {', '.join(found)}{_contacts(counted)}; how sure they are was {sure}"
    yield from _broken(counted, out)
    yield from _unknown(counted, out)
    yield from _not_judged(counted, out)
    yield from [counted.undecided] if counted.undecided else []
    yield from gate
    yield f"exit {int(code)}    rows {(counted.digest or '')[:12]} (the same for the same results, see summary.json)"
    yield f"look     drivelint report {out}"
    yield f'ask      drivelint sql {out} "SELECT rule_id, count(*) FROM counted_events GROUP BY ALL ORDER BY 2 DESC"'
    yield "explain  drivelint check LOG --map MAP --out DIR: its findings have the same ids, for drivelint explain ID --in DIR"


def _broken(counted: AuditSummary, out: str) -> Iterator[str]:
    """Yield the rules that were broken most."""
    for row in counted.broken:
        yield f"  {row['severity']:<8} {row['rule_id']}: {plural(row['n_findings'], 'finding')} in {plural(row['n_drives'], 'drive')}"
    if (more := counted.n_broken - len(counted.broken)) > 0:
        query = "SELECT severity, rule_id, count(*) FROM counted_events GROUP BY ALL ORDER BY ALL"
        yield f'  and {plural(more, "more rule")}: drivelint sql {out} "{query}"'


def _unknown(counted: AuditSummary, out: str) -> Iterator[str]:
    """Yield the most frequent reasons of unknown verdicts."""
    if counted.unknown_for:
        yield f"unknown: {counted.unknown} verdicts of stable rules"
    for row in counted.unknown_for:
        why = row["reason"] or row["reason_code"].replace("_", " ")
        yield f"  {row['n']} of {plural(row['n_rules'], 'rule')} in {plural(row['n_drives'], 'drive')}: {why}"
    if (more := counted.n_unknown_for - len(counted.unknown_for)) > 0:
        query = "SELECT reason_code, reason, count(*) FROM counted_verdicts WHERE verdict = 'unknown' GROUP BY ALL ORDER BY ALL"
        yield f'  and {plural(more, "more reason")}: drivelint sql {out} "{query}"'


def _not_judged(counted: AuditSummary, out: str) -> Iterator[str]:
    """Yield drives that could not be judged, and why."""
    if left := counted.refused + counted.quarantined - counted.copies_not_judged:
        yield f"not judged: {plural(left, 'drive')}"
        for row in counted.not_judged:
            parts = [plural(row["n"], "drive")] if row["n"] > 1 else []
            if not str(row["reason"]).startswith(str(row["log"])):
                parts.append(f"such as {row['log']}" if parts else row["log"])
            which = f" ({', '.join(parts)})" if parts else ""
            yield f"  {row['status']}{which}: {row['reason']}"
        if more := left - sum(row["n"] for row in counted.not_judged):
            yield f"  and {more} more: drivelint sql {out} \"SELECT log, reason FROM receipts WHERE status <> 'judged'\""


def _named(what: str, logs: list[str], n: int) -> Iterator[str]:
    """Yield the first logs of which this is said, and how many more there are."""
    if logs:
        yield f"  {what}: {', '.join(logs)}{f' and {n - len(logs)} more' if n > len(logs) else ''}"


def _copies(counted: AuditSummary, out: str) -> Iterator[str]:
    """Yield how many logs have the content of another one, and the first of them."""
    n = counted.copies + counted.copies_not_judged
    if not n:
        return
    has = "has" if n == 1 else "have"
    yield f"{plural(n, 'more log')} {has} the content of another one: each content counts once"
    for row in counted.copied:
        yield f"  {row['log']}: {_repeated(row)}"
    if counted.copied and (more := n - len(counted.copied)):
        query = "SELECT sha256, list(log) FROM drives WHERE sha256 IS NOT NULL GROUP BY ALL HAVING count(*) > 1"
        yield f'  and {more} more: drivelint sql {out} "{query}"'


def _repeated(row: dict[str, Any]) -> str:
    """Return what a result is whose log has another one before."""
    if row["log"] != row["other"]:
        return f"a copy of {row['other']}"
    if row["same_options"]:
        return "listed again, with other tags"
    return "judged again, with another ego or map, or under other conditions"


def _contacts(counted: AuditSummary) -> str:
    """Return in how many drives an ego touched something, and in how many others it may have."""
    numbers = (("CONTACT", counted.contacts), ("possible contact", counted.contacts_possible))
    return "".join(f"; {words} in {plural(n, 'drive')}" for words, n in numbers if n)


def _difference(counted: AuditSummary) -> str:
    parts = []
    if counted.n_absent:
        parts.append(f"{plural(counted.n_absent, 'result')} of earlier runs, of other logs (--prune takes them out)")
    doubles = (counted.n_asked or 0) - (counted.n_drives - counted.n_absent)
    if doubles > 0:
        parts.append(f"{plural(doubles, 'log')} of the name and content of another, with its tags: judged once")
    return f"; {'; '.join(parts)}" if parts else ""
