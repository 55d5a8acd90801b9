"""The summary of a run for a terminal; plain text if the output is not a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.compute as pc
from rich import box
from rich.console import Group
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from drivelint.phrases import name_list
from drivelint.report import NARROW_BELOW_COLUMNS, terminal_summary
from drivelint.report.outcome import one_finding_per_event_and_status
from drivelint.report.worst_first import moment_ns
from drivelint.result import counts
from drivelint.result.certainty import doubt_words
from drivelint.result.text import NO_VALUE, ego_name, measured_values_text, number, rule_name, seconds, with_count

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rich.console import RenderableType

    from drivelint.result.model import Result

MAX_RULES_PER_REASON: Final = 10
"""A reason shows this many rules."""
MAX_ROWS: Final = 20
"""A section shows this many rows; the files contain all."""

_STYLE_OF_VERDICT: Final = {
    "pass": "green",
    "fail": "bold red",
    "unknown": "yellow",
    "not_applicable": "dim",
    "error": "bold magenta",
}
_HEADING_OF_VERDICT: Final = {
    "pass": "pass",
    "fail": "fail",
    "unknown": "unknown",
    "not_applicable": "n/a",
    "error": "error",
}
_STYLE_OF_SEVERITY: Final = {
    "critical": "bold red",
    "major": "red",
    "minor": "yellow",
    "error": "red",
    "warning": "yellow",
}


def render(result: Result, out: str | None = None, width: int = 120, *, verbose: bool = False) -> Group:
    """Return the summary of a run as one rich renderable for a terminal of `width` columns.

    The summary fits one screen. With `verbose`, these tables precede it: drives, rules, findings, near misses, drives and verdicts that
    could not be judged, and data quality.
    """
    if not verbose:
        return terminal_summary.render(result, out, width)
    wide = width >= NARROW_BELOW_COLUMNS
    near = result.verdicts.filter(result.verdicts["near_miss"])
    sections: list[RenderableType | None] = [
        _drives_table(result, wide=wide),
        _rules_table(result, wide=wide),
        *_findings_tables(result, wide=wide),
        _finding_or_near_miss_table(result, "Near misses: kept, but with a small margin", near, "yellow", wide=wide),
        _unjudged_table(result),
        _quality_table(result),
        _assumptions_text(result),
        terminal_summary.render(result, out, width),
    ]
    return Group(*(Padding(section, (0, 0, 1, 0)) for section in sections if section is not None))


def _drives_table(result: Result, *, wide: bool) -> Table:
    verdicts_by_drive = counts.verdict_counts_by(result.verdicts, "drive_id")
    rows = result.drives.to_pylist()
    title = "Drives" if len(rows) <= MAX_ROWS else f"Drives (first {MAX_ROWS} of {len(rows)})"
    table = _empty_table(title, "bold", {"drive": 1})
    _add_number_columns(table, [*(("km", "time") if wide else ()), *_HEADING_OF_VERDICT.values()])
    for row in rows[:MAX_ROWS]:
        name = Text(row["drive_id"], style="" if row["status"] == "judged" else "yellow")
        if row["lossy"]:
            name.append(" (lossy)", style="yellow")
        duration = NO_VALUE if row["duration_s"] is None else f"{row['duration_s']:.1f} s"
        extent = [f"{row['km']:.2f}", duration] if wide else []
        table.add_row(name, *extent, *_count_cells(verdicts_by_drive[row["drive_id"]]))
    return table


def _rules_table(result: Result, *, wide: bool) -> Table:
    verdicts_by_rule = counts.verdict_counts_by(result.verdicts, "rule_id")
    table = _empty_table("Rules", "bold", {"rule": 1})
    if wide:
        table.add_column("severity")
    _add_number_columns(table, _HEADING_OF_VERDICT.values())
    for row in result.rules.to_pylist():
        name = Text(row["rule_id"])
        if row["status"] != "stable":
            name.append(f" ({row['status']})", style="dim")
        severity = [Text(row["severity"], style=_STYLE_OF_SEVERITY[row["severity"]])] if wide else []
        table.add_row(name, *severity, *_count_cells(verdicts_by_rule[row["rule_id"]]))
    table.add_section()
    packs = counts.verdict_counts_by_pack(result.rules, result.verdicts)
    for pack, sums in packs.items():  # verdicts of several packs are not added up
        label = "all" if len(packs) == 1 else f"all of {pack}"
        table.add_row(Text(label, style="bold"), *([""] if wide else []), *_count_cells(sums))
    return table


def _findings_tables(result: Result, *, wide: bool) -> list[Table | None]:
    """Return the table of findings; with a gate, two tables: first the findings that fail the gate, then the other findings."""
    gate, rows = result.gate, result.findings
    if gate is None:
        return [_finding_or_near_miss_table(result, "Findings", rows, "red", wide=wide)]
    stops = pa.array([gate.is_gating(name) for name in rows["finding_id"].to_pylist()], pa.bool_())
    title = "New findings" if gate.baseline is not None else "Findings"
    return [
        _finding_or_near_miss_table(result, title, rows.filter(stops), "red", wide=wide),
        _finding_or_near_miss_table(
            result, "Known or waived findings: they do not gate", rows.filter(pc.invert(stops)), "dim", wide=wide
        ),
    ]


def _finding_or_near_miss_table(
    result: Result, title: str, rows: pa.Table, style: str, *, wide: bool = True
) -> Table | None:
    """Return a table of findings or near misses with their measured values; None if `rows` is empty.

    The drive's name precedes its rows. In a narrow terminal the measured values are below the rule, so that no number or name is split.
    """
    if not rows.num_rows:
        return None
    is_of_findings = "finding_id" in rows.column_names
    events = one_finding_per_event_and_status(result.gate, rows.to_pylist()) if is_of_findings else []
    more = counts.extra_rows_sentence(rows.to_pylist(), events) if is_of_findings else ""
    limit_words = f"; the first {MAX_ROWS} rows" if rows.num_rows > MAX_ROWS else ""
    table = _empty_table(
        f"{title} ({len(events)})\n{more}{limit_words}" if more else _title_with_count(title, rows.num_rows), style
    )
    table.show_header = wide
    _add_number_columns(table, ["time"])
    table.add_column("rule [profile]", overflow="fold", ratio=2)
    if wide:
        table.add_column("object", overflow="fold")
        _add_number_columns(table, ["observed", "required", "margin"])
    egos = len(pc.unique(rows["ego_id"])) > 1
    previous, starts = None, result.start_times
    rules = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
    for row in rows.slice(0, MAX_ROWS).to_pylist():
        where = f"{row['drive_id']}, {ego_name(row['ego_id'])}" if egos else row["drive_id"]
        if where != previous:
            table.add_row("", Text(where, style="bold"))
            previous = where
        when, rule = seconds(moment_ns(row, rules), starts.get(row["drive_id"])), Text(rule_name(row))
        if doubt_words(row):
            rule.append(f" ({doubt_words(row)})", style="yellow")
        if wide:
            numbers = (number(row[name], row["unit"]) for name in ("observed", "required", "margin"))
            table.add_row(when, rule, Text(row["object_id"] or ""), *numbers)
        else:
            about = f"object {row['object_id']}: " if row["object_id"] is not None else ""
            table.add_row(when, rule)
            table.add_row("", Text(about + (measured_values_text(row) or row["reason"]), style="dim"))
    return table


def _unjudged_table(result: Result) -> Table | None:
    """Return a table of what could not be judged, with the reasons: drives, then verdicts that are unknown or errors."""
    drives = result.drives.filter(pc.equal(result.drives["status"], "not_judged")).to_pylist()
    rows = counts.distinct_rows(counts.undecided_verdicts(result.verdicts), ["verdict", "reason", "rule_id"])
    why = counts.group_rows(rows, lambda row: (row["verdict"], row["reason"]))
    if not drives and not why:
        return None
    table = _empty_table(
        _title_with_count("Could not be judged", len(drives) + len(why)), "yellow", {"what": 1, "why": 1}
    )
    for row in drives[:MAX_ROWS]:
        table.add_row(Text(f"drive {row['drive_id']}", style="yellow"), Text(row["status_reason"] or ""))
    order = sorted(why, key=lambda at: (at[0], -len(why[at]), at[1]))
    of_egos = counts.distinct_rows(counts.undecided_verdicts(result.verdicts), ["verdict", "reason", "ego_id"])
    egos = counts.group_rows(of_egos, lambda row: (row["verdict"], row["reason"]))
    several = len({row["ego_id"] for row in of_egos}) > 1
    for verdict, reason in order[:MAX_ROWS]:
        rules = _first_rule_lines([(row["rule_id"], row["count_all"]) for row in why[verdict, reason]])
        text = Text(reason)
        if several:
            text.append(f"\nego {name_list([row['ego_id'] for row in egos[verdict, reason]])}", "dim")
        table.add_row(Text("\n".join(rules), style=_STYLE_OF_VERDICT[verdict]), text)
    return table


def _first_rule_lines(rules: list[tuple[str, int]]) -> list[str]:
    """Return the first rules with their counts, and a line with the number and packs of the other rules."""
    packs = sorted({rule_id.partition(".")[0] for rule_id, _ in rules[MAX_RULES_PER_REASON:]})
    more = [f"and {len(rules) - MAX_RULES_PER_REASON} more of {', '.join(packs)}"] if packs else []
    return [with_count(*rule) for rule in rules[:MAX_RULES_PER_REASON]] + more


def _quality_table(result: Result) -> Table | None:
    """Return a table of the warnings and errors about the data quality of logs and maps."""
    checks = [(drive["drive_id"], check) for drive in result.drives.to_pylist() for check in drive["quality"]]
    worse = [(drive_id, check) for drive_id, check in checks if check["severity"] != "info"]
    groups = counts.group_rows(worse, lambda pair: tuple(pair[1][name] for name in ("severity", "check_id", "message")))
    if not groups:
        return None
    table = _empty_table(_title_with_count("Data quality", len(groups)), "yellow", {"check": 1, "message": 3})
    for (severity, check_id, message), pairs in list(groups.items())[:MAX_ROWS]:
        drives = {drive_id for drive_id, _ in pairs}
        where = pairs[0][0] if len(drives) == 1 else f"{len(drives)} drives"
        table.add_row(Text(check_id, style=_STYLE_OF_SEVERITY[severity]), Text(f"{where}: {message}"))
    return table


def _assumptions_text(result: Result) -> Text | None:
    assumed = counts.count_verdicts_assuming(result.verdicts, "line_of_sight")
    if not assumed:
        return None
    verb = "verdict assumes" if assumed == 1 else "verdicts assume"
    return Text(
        f"{assumed} {verb} that an actor that is missing in a log was not visible from the ego (--visibility)", "dim"
    )


def _empty_table(title: str, style: str, columns: Mapping[str, int] | None = None) -> Table:
    """Return a table with wrapped text; `columns`: the name of each column and its share of the width."""
    table = Table(title=Text(title, style=style), title_justify="left", box=box.SIMPLE_HEAD)
    table.show_edge = table.pad_edge = False
    for name, ratio in (columns or {}).items():
        table.add_column(name, overflow="fold", ratio=ratio)
    return table


def _title_with_count(title: str, n: int) -> str:
    return f"{title} ({n})" if n <= MAX_ROWS else f"{title} (first {MAX_ROWS} of {n})"


def _add_number_columns(table: Table, names: Iterable[str]) -> None:
    for name in names:
        table.add_column(name, justify="right", no_wrap=True)


def _count_cells(verdict_counts: dict[str, Any]) -> list[Text]:
    """Return one cell per kind of verdict; a zero is a dim dot, so that other numbers stand out."""
    return [
        Text(str(verdict_counts[verdict]), style=_STYLE_OF_VERDICT[verdict])
        if verdict_counts[verdict]
        else Text("·", style="dim")
        for verdict in counts.VERDICTS
    ]
