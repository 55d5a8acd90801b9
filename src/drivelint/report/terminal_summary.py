"""The summary of a run on one screen of a terminal, for a catalogue of any size: the worst drives and rules; others are counted."""

from __future__ import annotations

import re
import shlex
from collections import Counter
from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.compute as pc
from rich import box
from rich.console import Group
from rich.table import Table
from rich.text import Text

from drivelint.errors import ExitCode
from drivelint.gate import descriptions
from drivelint.phrases import plural, terminal_safe_line
from drivelint.report.inputs import LAW_LABEL, input_notes, n_rules, undecided_verdicts_by_cause
from drivelint.report.law import law_words
from drivelint.report.outcome import (
    LABEL_OF_EXIT_CODE,
    LET_THROUGH_WORDS,
    headline,
    one_finding_per_event_and_status,
    rule_counts,
    status_at_gate,
)
from drivelint.report.worst_first import is_contact, moment_ns, worst_first, worst_time_words
from drivelint.result import counts
from drivelint.result.certainty import doubt_words
from drivelint.result.model import exit_status, gating_verdicts_lacking_signal, map_misfit_reason
from drivelint.result.text import breach_title, closing_speed_words, ego_name, number, seconds, tolerance

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rich.console import JustifyMethod, RenderableType

    from drivelint.result.gate import Gate
    from drivelint.result.model import Result
    from drivelint.result.text import Row

MOST_DRIVES: Final = 8
MOST_RULES: Final = 5
MOST_REASONS: Final = 3
MOST_WORSE: Final = 3
_COUNT_COLUMNS_WIDTH: Final = 29
"""The width of the drives table's columns with counts."""
_COLUMN_GAP: Final = 5
_LEAST_FINDING_WIDTH: Final = 44
"""In a narrower column, a finding would need more than two lines: it is put below the drive's name instead."""

STYLE_OF_SEVERITY: Final = {"critical": "bold red", "major": "red", "minor": "yellow"}
_SHORT_SEVERITIES: Final = {"critical": "crit", "major": "maj", "minor": "min"}
PROFILE_MEANINGS: Final = {
    "relaxed": "planned with a large margin",
    "nominal": "planned with a usual margin",
    "aggressive": "planned with a small margin",
    "observed": "as it was driven",
}
"""The profiles that drivelint ships, each with the overtake that it assumes, in words."""
_STYLE_OF_LABEL: Final = {
    "PASS": "bold green",
    "FAIL": "bold red",
    "ERROR": "bold magenta",
}
_STYLE_OF_OTHER_LABELS: Final = "bold yellow"
_STYLE_OF_HEADLINE_PART: Final = {"contact": "bold red", "possible contact": "red", "warning": "yellow"}


def render(result: Result, out: str | None, width: int = 120) -> Group:
    """Return the head, each drive's worst finding, broken and unknown rules, map and logs, the exit code and the next steps.

    Findings that a gate lets through are only counted, but if a drive has no other findings, the worst is shown.
    """
    rules = _rules_by_id(result)
    every = one_finding_per_event_and_status(result.gate, worst_first(result.findings, rules).to_pylist())
    gating_findings = [row for row in every if status_at_gate(result.gate, row["finding_id"]) not in LET_THROUGH_WORDS]
    drives = _drives_table(result, gating_findings, every, rules, width)
    parts: list[RenderableType] = [_extent_line(result), Text(), _outcome_text(result), Text(), drives, Text()]
    if gating_findings:
        parts += [_broken_rules_table(gating_findings, _let_through_words(result, every)), Text()]
    end = _exit_and_next_steps_lines(result, gating_findings or every, out, width)
    lines = [*_lines_on_rules_and_inputs(result), Text(), *end]
    return Group(*parts, *_lines_with_each_misfit_once(result, _outcome_text(result).plain, lines))


def _lines_with_each_misfit_once(result: Result, text_above: str, lines: list[Text]) -> list[Text]:
    """Return the lines; the reason why a map does not fit is left out where `text_above` or an earlier line contains it."""
    reasons = sorted({map_misfit_reason(drive) or "" for drive in result.drives.to_pylist()} - {""})
    for n, line in enumerate(lines):
        for reason in reasons:
            place = re.search(rf" \({re.escape(reason)}\)|: {re.escape(reason)}", line.plain)
            if place and reason in text_above:
                lines[n] = line[: place.start()] + line[place.end() :]
        text_above += line.plain
    return lines


def _extent_line(result: Result) -> Text:
    drives = result.drives
    packs = list(counts.verdict_counts_by_pack(result.rules, result.verdicts))
    total = [pc.sum(drives[name]).as_py() or 0.0 for name in ("km", "duration_s")]
    n_rules = plural(result.rules.num_rows, "rule")
    law = law_words(result)
    return Text(
        f"drivelint: {plural(drives.num_rows, 'drive')}, {total[0]:.2f} km, {total[1]:.0f} s, {n_rules} ({', '.join(packs)})"
        f"{'; law ' if law else ''}{law}"
    )


def gating_findings_worst_first(result: Result) -> list[Row]:
    """Return the findings that gate, the worst first; without a gate, all findings."""
    gate, rows = result.gate, result.findings
    if gate is not None:
        rows = rows.filter(pa.array([gate.is_gating(name) for name in rows["finding_id"].to_pylist()], pa.bool_()))
    findings: list[Row] = worst_first(rows, _rules_by_id(result)).to_pylist()
    return findings


def outcome_line(result: Result) -> str:
    """Return the run's outcome, the line below the head, as plain text with single spaces."""
    return " ".join(_outcome_text(result).plain.split())


def _rules_by_id(result: Result) -> dict[str, Any]:
    return {rule["rule_id"]: rule for rule in result.rules.to_pylist()}


def _outcome_text(result: Result) -> Text:
    """Return the run's outcome as word and sentence; if nothing was judged, also the reason."""
    outcome, ended = headline(result), exit_status(result)
    text = Text(f"{outcome.label}  ", _STYLE_OF_LABEL.get(outcome.label, _STYLE_OF_OTHER_LABELS))
    for n, part in enumerate(outcome.parts):
        text.append(f"{'; ' if n else ''}", "default").append(
            part.words, _STYLE_OF_HEADLINE_PART.get(part.kind, "default")
        )
    if ended.code == ExitCode.NOT_JUDGED:
        text.append(f"; {ended.why}", "default")
    return text


def _empty_table(names: Iterable[str], max_widths: Mapping[str, int]) -> Table:
    """Return a table; `max_widths`: the columns with text and their greatest widths; the other columns contain numbers.

    Text wraps, so that no end is lost; numbers and their headings do not.
    """
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, header_style="dim")
    for name in names:
        is_text = name in max_widths
        justify: JustifyMethod = "left" if is_text else "right"
        table.add_column(name, justify=justify, no_wrap=not is_text, overflow="fold", max_width=max_widths.get(name))
    return table


def _drives_table(
    result: Result, gating_findings: list[Row], all_findings: list[Row], rules: dict[str, Any], width: int
) -> Table:
    """Return a table with a row per drive, the worst first: its worst finding, and its findings by severity.

    `all_findings`: also findings that a gate lets through; if a drive has no other findings, the worst is named.
    """
    of_drive = counts.group_rows(gating_findings, lambda row: row["drive_id"])
    let_through = counts.group_rows(all_findings, lambda row: row["drive_id"])
    unknown = counts.verdict_counts_by(result.verdicts, "drive_id")
    lacking = set(counts.verdicts_lacking_signal(result.verdicts)["drive_id"].to_pylist())
    unrecorded = Counter(gating_verdicts_lacking_signal(result)["drive_id"].to_pylist())
    starts = result.start_times

    def sort_key(drive: Row) -> tuple[Any, ...]:
        findings = of_drive.get(drive["drive_id"], [])
        n = [-sum(row["severity"] == severity for row in findings) for severity in counts.SEVERITIES]
        return drive["status"] == "judged", *n, drive["drive_id"], drive["file_name"]

    drives = sorted(result.drives.to_pylist(), key=sort_key)
    names = [drive["drive_id"] + (" (lossy)" if drive["lossy"] else "") for drive in drives[:MOST_DRIVES]]
    longest = min(max(map(len, [*names, "drive"])), width // 3)
    beside = width - longest - _COLUMN_GAP - _COUNT_COLUMNS_WIDTH
    is_beside = beside >= _LEAST_FINDING_WIDTH
    widths = (
        {"drive": longest, "worst": beside} if is_beside else {"drive, its worst below": width - _COUNT_COLUMNS_WIDTH}
    )
    table = _empty_table((*widths, *_SHORT_SEVERITIES.values(), "unknown"), widths)

    def add_row(name: Text, worst: RenderableType, cells: Iterable[Text] = ()) -> None:
        table.add_row(*((name, worst) if is_beside else (Group(name, worst),)), *cells)

    for drive, label in zip(drives, names, strict=False):
        name = drive["drive_id"]
        findings = of_drive.get(name, [])
        if drive["status"] != "judged":
            add_row(Text(label, "yellow"), Text(drive["status_reason"] or "not judged", "yellow"))
            continue
        worst: RenderableType
        if findings:
            worst = _finding_cell(findings[0], rules, starts[name], several_egos=drive["n_egos"] > 1)
        elif name in let_through:
            worst = _let_through_cell(
                result, let_through[name][0], rules, starts[name], several_egos=drive["n_egos"] > 1
            )
        else:
            worst = _no_finding_cell(drive, unknown[name], lacks_signals=name in lacking)
        n = [sum(row["severity"] == severity for row in findings) for severity in counts.SEVERITIES]
        cells = [_count_cell(k, STYLE_OF_SEVERITY[severity]) for k, severity in zip(n, counts.SEVERITIES, strict=True)]
        n_unknown = unknown[name]["unknown"] + unrecorded[name]
        add_row(Text(label, "yellow" if drive["lossy"] else ""), worst, [*cells, _count_cell(n_unknown, "yellow")])
    if len(drives) > MOST_DRIVES:
        table.add_row(Text(f"... {len(drives) - MOST_DRIVES} more (--verbose)", "dim"))
    return table


def _no_finding_cell(drive: Row, verdicts: Mapping[str, int], *, lacks_signals: bool) -> Text:
    if map_misfit_reason(drive) is not None:
        return Text("no finding, but the map does not fit", "yellow")
    if verdicts["pass"]:
        return Text("no finding", "dim")
    applied = verdicts["unknown"] + verdicts["error"] or lacks_signals or not verdicts["not_applicable"]
    return Text("nothing was judged" if applied else "no rule applied", "yellow")


def _let_through_cell(
    result: Result, row: Row, rules: dict[str, Any], start_ns: int | None, *, several_egos: bool
) -> Table:
    """Return a finding that a gate lets through, and the reason."""
    how = status_at_gate(result.gate, row["finding_id"])
    # the text of a possible finding contains that word already
    why = "" if how == "possible" and doubt_words(row) else f"{LET_THROUGH_WORDS[how]}: "
    return _finding_cell(row, rules, start_ns, several_egos=several_egos, let_through_because=why)


def _count_cell(n: int, style: str) -> Text:
    return Text(str(n), style) if n else Text("·", "dim")


def _finding_cell(
    row: Row, rules: dict[str, Any], start_ns: int | None, *, several_egos: bool, let_through_because: str = ""
) -> Table:
    """Return time, measured value and rule of a finding; in a narrow column, the words wrap beside the time.

    For a contact, return the other actor and the closing speed just before the contact instead of the rule.
    """
    contact = is_contact(row, rules)
    object_names = [] if row["object_id"] is None else [f"object {row['object_id']}"]
    parts = []
    if contact and row["closing_mps"] is not None:
        parts = [*object_names, closing_speed_words(row["closing_mps"])]
        object_names = []
    elif row["observed"] is not None and row["required"] is not None:
        profile = "" if row["profile"] is None else f" [{row['profile']}]"
        limit = "at most" if rules[row["rule_id"]]["sense"] in {"<", "<="} else "needs"
        of_it = "" if tolerance(row, rules[row["rule_id"]]) is None else " with tolerance"
        parts.append(
            f"{number(row['observed'], row['unit'])}, {limit} {number(row['required'], row['unit'])}{of_it}{profile}"
        )
    if not contact:
        parts.append(breach_title(rules[row["rule_id"]]))
    parts += object_names
    if later := worst_time_words(row, rules, start_ns):
        parts.append(later)
    ego = f"{ego_name(row['ego_id'])} " if several_egos else ""
    contact_words = "possible contact " if doubt_words(row) else "CONTACT "
    if doubt_words(row) and not contact:
        parts[0] = f"possibly {parts[0]}"
    cell = Table.grid(padding=(0, 1, 0, 0))
    cell.add_column(no_wrap=True)
    cell.add_column(overflow="fold")
    cell.add_row(
        Text.assemble((let_through_because, "yellow"), f"{seconds(moment_ns(row, rules), start_ns):>8}"),
        Text.assemble(ego, (contact_words if contact else "", "bold red"), "; ".join(parts)),
    )
    return cell


def _let_through_words(result: Result, every: list[Row]) -> str:
    """Return in words how many findings a gate lets through, by the reason; '' for none."""
    n_by_status = Counter(status_at_gate(result.gate, row["finding_id"]) for row in every)
    return ", ".join(f"{n_by_status[name]} {words}" for name, words in LET_THROUGH_WORDS.items() if n_by_status[name])


def _broken_rules_table(findings: list[Row], left_out_words: str) -> Table:
    """Return a table with a row per broken rule, the worst first; a column counts the findings that are only possible, if any.

    `left_out_words`: the findings that the table leaves out, in words.
    """
    some_possible = any(doubt_words(row) for row in findings)
    first = f"broken rule (without {left_out_words})" if left_out_words else "broken rule"
    columns = (first, "findings", *(["possible"] if some_possible else []), "drives", "worst margin")
    table = _empty_table(columns, {first: 60})
    of_rule = counts.group_rows(findings, lambda row: row["rule_id"])
    for rule_id, rows in list(of_rule.items())[:MOST_RULES]:
        margins = [row["margin"] for row in rows if row["margin"] is not None]
        severity = rows[0]["severity"]
        name = Text.assemble((f"{severity:<8} ", STYLE_OF_SEVERITY[severity]), rule_id)
        n_drives = len({row["drive_id"] for row in rows})
        doubted = [_count_cell(sum(bool(doubt_words(row)) for row in rows), "yellow")] if some_possible else []
        worst = number(min(margins, default=None), rows[0]["unit"])
        table.add_row(name, str(len(rows)), *doubted, str(n_drives), worst)
    if len(of_rule) > MOST_RULES:
        table.add_row(Text(f"... {len(of_rule) - MOST_RULES} more (--verbose)", "dim"))
    return table


def _lines_on_rules_and_inputs(result: Result) -> list[Text]:
    """Return the lines on the number of rules judged, profiles, unknown verdicts by reason, map and logs."""
    n = rule_counts(result)
    parts = [f"{n.judged_somewhere} judged", f"{n.never} could never be judged" if n.never else ""]
    parts += [f"{n.unrecorded} need a signal that the log lacks" if n.unrecorded else ""]
    parts += [f"{n.idle} never applied" if n.idle else "", f"{n.open} not applicable or unknown" if n.open else ""]
    near = int(pc.sum(result.verdicts["near_miss"]).as_py() or 0)
    first = f"{plural(result.rules.num_rows, 'rule')}: {', '.join(part for part in parts if part)}"
    if near:
        first += f"    near misses: {near}"
    if conditions := {
        f"{c['condition']}={c['value']}" for cs in result.drives["conditions"].to_pylist() for c in cs or ()
    }:
        first += f"    judged in: {', '.join(sorted(conditions))}"
    return [Text(first), *_profile_lines(result), *_unknown_reason_lines(result), *_input_lines(result)]


def _profile_lines(result: Result) -> list[Text]:
    """Return the meaning of the profiles whose names are in brackets after the numbers of findings."""
    names = sorted(set(result.findings["profile"].to_pylist()) & PROFILE_MEANINGS.keys())
    meanings = "; ".join(f"{name}: {PROFILE_MEANINGS[name]}" for name in names)
    return [Text(f"profiles of overtaking (one overtake counts once): {meanings}", "dim")] if names else []


def _unknown_reason_lines(result: Result) -> list[Text]:
    """Return the reasons of unknown verdicts other than missing signals, the most frequent first."""
    order = undecided_verdicts_by_cause(result)
    lines = []
    for group in order[:MOST_REASONS]:
        times = f", {len(group)} times" if len(group) > 1 else ""
        rules = group[0]["rule_id"] if n_rules(group) == 1 else plural(n_rules(group), "rule")
        words = f"{group[0]['verdict']} ({rules}{times}): {group[0]['reason']}"
        lines.append(Text(words, "yellow"))
    if len(order) > MOST_REASONS:
        lines.append(Text(f"... {plural(len(order) - MOST_REASONS, 'more reason')} (--verbose)", "dim"))
    return lines


def _input_lines(result: Result) -> list[Text]:
    """Return a line for each note on the inputs (map, logs, what was not judged) except the law."""
    return [
        Text.assemble(f"{note.label}: ", (note.words, "yellow" if note.is_warning else "default"))
        for note in input_notes(result)
        if note.label != LAW_LABEL
    ]


def _lines_on_worse_findings(gate: Gate) -> list[Text]:
    """Return a line for each known finding that is worse than in the baseline, the most severe first."""
    entries = gate.baseline.entries if gate.baseline is not None else ()
    worse = [entry for entry in entries if entry.worse and gate.status_at_gate(entry.finding_id) == "known"]
    events = counts.group_rows(worse, lambda entry: entry.event_key)
    first = sorted((rows[0] for rows in events.values()), key=lambda entry: counts.SEVERITIES.index(entry.severity))
    lines = [Text(f"worse    {descriptions.finding_line(entry)}", "yellow") for entry in first[:MOST_WORSE]]
    more = len(first) - MOST_WORSE
    return (
        [*lines, Text(f"... {plural(more, 'more known finding')} worse than in the baseline", "dim")]
        if more > 0
        else lines
    )


def _exit_and_next_steps_lines(result: Result, findings: list[Row], out: str | None, width: int) -> list[Text]:
    end = exit_status(result)
    style = _STYLE_OF_LABEL.get(LABEL_OF_EXIT_CODE.get(end.code, ""), _STYLE_OF_OTHER_LABELS)
    gate = result.gate
    alone = "" if gate is not None and gate.baseline is not None else " (no baseline)"
    lines = [Text(f"exit {int(end.code)}: {end.why}{alone}", style)]
    if gate is not None and gate.baseline is not None:
        changes = descriptions.earlier_findings_sentence(gate.baseline)
        lines += [Text(f"baseline: {changes}"), *_lines_on_worse_findings(gate)]
    if gate is not None:
        lines += [Text(f"waiver   {line}", "yellow") for line in descriptions.waiver_warnings(gate)]
    if counts.verdict_counts(result.verdicts)["unknown"] or counts.verdicts_lacking_signal(result.verdicts).num_rows:
        lines.append(Text("inspect  drivelint inspect TRACE shows what a log lacks: unknown is not pass"))
    if out is None:
        lines.append(Text("keep     --out DIR writes a report, the tables and the logs with their verdicts", "dim"))
        return lines
    lines.append(Text(f"open     {out}/report.html"))
    unknown = [row for rows in undecided_verdicts_by_cause(result) for row in rows if row["verdict"] == "unknown"]
    if candidates := findings or unknown:
        name = f"{candidates[0]['rule_id']}@{candidates[0]['drive_id']}"
        is_safe = terminal_safe_line(name) == name  # the printed command must work in a shell
        if findings and not is_safe:
            name = findings[0]["finding_id"]
        if findings or is_safe:
            command = [f"explain  drivelint explain {shlex.quote(name)}", f"--in {out}"]
            is_too_long = len(" ".join(command)) > width
            # a shell joins the lines again when a person copies them
            lines.append(Text((" \\\n" + " " * len("explain  ") if is_too_long else " ").join(command)))
    return lines
