"""The text of one screen that `drivelint audit` prints at its end."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from drivelint.phrases import one_line, plural
from drivelint.result.counts import SEVERITIES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from drivelint.audit.summary import AuditSummary
    from drivelint.errors import ExitCode


def summary_text(
    audit_summary: AuditSummary,
    out: str,
    code: ExitCode,
    gate_lines: Iterable[str] = (),
    *,
    fail_on: str = "critical",
    gate_reason: str = "",
) -> str:
    """Return the text: drives, findings by severity, broken rules, unknown verdicts, drives that were not judged, the gate, and next
    commands.

    `gate_reason`: the reason for the exit code if a gate determines it.
    """
    return "\n".join(
        map(one_line, _summary_lines(audit_summary, out, code, gate_lines, fail_on=fail_on, gate_reason=gate_reason))
    )


def _summary_lines(
    audit_summary: AuditSummary, out: str, code: ExitCode, gate_lines: Iterable[str], *, fail_on: str, gate_reason: str
) -> Iterator[str]:
    n_refused = audit_summary.n_refused - audit_summary.copies_not_judged
    yield f"{plural(audit_summary.n_distinct_drives, 'drive')} of {audit_summary.hours:,.2f} h; their egos drove {audit_summary.km:,.2f} km"
    states = (
        f"{audit_summary.n_judged - audit_summary.copies} judged",
        f"{n_refused} refused" if n_refused else "",
        f"{audit_summary.quarantined} quarantined" if audit_summary.quarantined else "",
        f"{audit_summary.lossy} lossy" if audit_summary.lossy else "",
        f"{audit_summary.off_map} with a map that does not fit" if audit_summary.off_map else "",
        f"{audit_summary.reused} already judged by an earlier run" if audit_summary.reused else "",
    )
    yield ", ".join(state for state in states if state)
    yield from _log_lines("lossy", audit_summary.lossy_logs, audit_summary.lossy)
    yield from _log_lines("map does not fit", audit_summary.off_map_logs, audit_summary.off_map)
    yield from _duplicate_log_lines(audit_summary, out)
    if audit_summary.missing_parts:
        of = (
            ""
            if audit_summary.n_asked is None
            else f"{audit_summary.n_drives} of {plural(audit_summary.n_asked, 'drive')} have a result: "
        )
        yield f"INCOMPLETE: these parts have not ended: {', '.join(audit_summary.missing_parts)}: {of}run the same commands again"
    elif audit_summary.n_asked is not None and audit_summary.n_asked != audit_summary.n_drives:
        yield f"asked for: {plural(audit_summary.n_asked, 'log')}{_reasons_for_count_difference(audit_summary)}"
    if audit_summary.digest is None:
        yield f"when all parts have ended: drivelint merge {out}"
        return
    counts = [f"{audit_summary.findings.get(severity, 0)} {severity}" for severity in SEVERITIES]
    sure = (
        f"examined: {audit_summary.possible} only possible"
        if audit_summary.robust
        else "not examined (--robustness examines it)"
    )
    yield f"findings: {', '.join(counts)}{_contact_phrases(audit_summary)}; certainty: {sure}"
    yield from _broken_rule_lines(audit_summary, out)
    yield from _unknown_reason_lines(audit_summary, out)
    yield from _unjudged_drive_lines(audit_summary, out)
    yield from [audit_summary.undecided] if audit_summary.undecided else []
    yield from gate_lines
    yield f"exit {int(code)}: {gate_reason or audit_summary.exit_reason(code, fail_on)}"
    yield f"rows     {(audit_summary.digest or '')[:12]} (digest of all rows: equal for equal results, see summary.json)"
    if not audit_summary.n_judged:
        return  # without a judged drive, these commands show nothing
    yield f"look     drivelint report {out}"
    yield f'ask      drivelint sql {out} "SELECT rule_id, count(*) FROM counted_events GROUP BY ALL ORDER BY 2 DESC"'
    yield "explain  drivelint check LOG --map MAP --out DIR: its findings have the same ids; then drivelint explain ID --in DIR"


def _broken_rule_lines(audit_summary: AuditSummary, out: str) -> Iterator[str]:
    """Yield lines about the rules that were broken most often."""
    for row in audit_summary.broken:
        yield f"  {row['severity']:<8} {row['rule_id']}: {plural(row['n_findings'], 'finding')} in {plural(row['n_drives'], 'drive')}"
    if (more := audit_summary.n_broken - len(audit_summary.broken)) > 0:
        query = "SELECT severity, rule_id, count(*) FROM counted_events GROUP BY ALL ORDER BY ALL"
        yield f'  and {plural(more, "more rule")}: drivelint sql {out} "{query}"'


def _unknown_reason_lines(audit_summary: AuditSummary, out: str) -> Iterator[str]:
    """Yield lines about the most frequent reasons for unknown verdicts."""
    if audit_summary.unknown_for:
        yield f"unknown: {audit_summary.unknown} verdicts of stable rules"
    for row in audit_summary.unknown_for:
        why = row["reason"] or row["reason_code"].replace("_", " ")
        yield f"  {row['n']} of {plural(row['n_rules'], 'rule')} in {plural(row['n_drives'], 'drive')}: {why}"
    if (more := audit_summary.n_unknown_for - len(audit_summary.unknown_for)) > 0:
        query = "SELECT reason_code, reason, count(*) FROM counted_verdicts WHERE verdict = 'unknown' GROUP BY ALL ORDER BY ALL"
        yield f'  and {plural(more, "more reason")}: drivelint sql {out} "{query}"'


def _unjudged_drive_lines(audit_summary: AuditSummary, out: str) -> Iterator[str]:
    """Yield lines about drives that could not be judged, with the reason."""
    if left := audit_summary.n_refused + audit_summary.quarantined - audit_summary.copies_not_judged:
        yield f"not judged: {plural(left, 'drive')}"
        for row in audit_summary.not_judged:
            parts = [plural(row["n"], "drive")] if row["n"] > 1 else []
            if not str(row["reason"]).startswith(str(row["log"])):
                parts.append(f"such as {row['log']}" if parts else row["log"])
            drive_text = f" ({', '.join(parts)})" if parts else ""
            yield f"  {row['status']}{drive_text}: {row['reason']}"
        if more := left - sum(row["n"] for row in audit_summary.not_judged):
            yield f"  and {more} more: drivelint sql {out} \"SELECT log, reason FROM receipts WHERE status <> 'judged'\""


def _log_lines(label: str, logs: list[str], n: int) -> Iterator[str]:
    """Yield a line with `label`, the first logs, and how many more there are."""
    if logs:
        yield f"  {label}: {', '.join(logs)}{f' and {n - len(logs)} more' if n > len(logs) else ''}"


def _duplicate_log_lines(audit_summary: AuditSummary, out: str) -> Iterator[str]:
    """Yield how many logs have the same content as another log, and the first of them."""
    n = audit_summary.copies + audit_summary.copies_not_judged
    if not n:
        return
    has = "has" if n == 1 else "have"
    yield f"{plural(n, 'more log')} {has} the same content as another log: logs with the same content count once"
    for row in audit_summary.copied:
        yield f"  {row['log']}: {_repetition_phrase(row)}"
    if audit_summary.copied and (more := n - len(audit_summary.copied)):
        query = "SELECT sha256, list(log) FROM drives WHERE sha256 IS NOT NULL GROUP BY ALL HAVING count(*) > 1"
        yield f'  and {more} more: drivelint sql {out} "{query}"'


def _repetition_phrase(row: dict[str, Any]) -> str:
    """Return a phrase that says how a result repeats an earlier one."""
    if row["log"] != row["other"]:
        return f"a copy of {row['other']}"
    if row["same_options"]:
        return "listed again with other tags"
    return "judged again, with another ego or map, or under other conditions"


def _contact_phrases(audit_summary: AuditSummary) -> str:
    """Return in how many drives an ego touched something, and in how many other drives it possibly did."""
    numbers = (("CONTACT", audit_summary.contacts), ("possible contact", audit_summary.contacts_possible))
    return "".join(f"; {words} in {plural(n, 'drive')}" for words, n in numbers if n)


def _reasons_for_count_difference(audit_summary: AuditSummary) -> str:
    parts = []
    if audit_summary.n_absent:
        parts.append(
            f"{plural(audit_summary.n_absent, 'result')} of earlier runs for other logs (--prune removes them)"
        )
    doubles = (audit_summary.n_asked or 0) - (audit_summary.n_drives - audit_summary.n_absent)
    if doubles > 0:
        parts.append(f"{plural(doubles, 'log')} with the same name, content and tags as another log: judged once")
    return f"; {'; '.join(parts)}" if parts else ""
