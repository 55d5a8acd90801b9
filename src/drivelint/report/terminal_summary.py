"""The summary of a run in one screen of a terminal, whatever the catalogue's size: the worst first, the rest counted."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.compute as pc
from rich import box
from rich.console import Group
from rich.table import Table
from rich.text import Text

from drivelint.errors import ExitCode
from drivelint.gate import descriptions
from drivelint.phrases import listed, plural
from drivelint.result import counts
from drivelint.result.certainty import doubt
from drivelint.result.model import exit_status, off_map_reason
from drivelint.result.text import number, seconds

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from rich.console import JustifyMethod, RenderableType

    from drivelint.result.model import Result
    from drivelint.result.text import Row

MOST_DRIVES: Final = 8
MOST_RULES: Final = 5
MOST_REASONS: Final = 3

STYLE: Final = {"critical": "bold red", "major": "red", "minor": "yellow"}
_SHORT: Final = {"critical": "crit", "major": "maj", "minor": "min"}
_LABEL: Final = {
    ExitCode.OK: ("PASS", "bold green"),
    ExitCode.FAILED: ("FAIL", "bold red"),
    ExitCode.USAGE: ("ERROR", "bold magenta"),
    ExitCode.LOSSY: ("LOSSY", "bold yellow"),
    ExitCode.NOT_JUDGED: ("NOT JUDGED", "bold yellow"),
}


def render(result: Result, out: str | None, width: int = 120) -> Group:
    """Return the head, the worst of each drive, the broken rules, what is unknown, map and data, the exit code and what to do next.

    Findings that a gate lets through are counted, not listed.
    """
    gate, rows = result.gate, result.findings
    if gate is not None:
        rows = rows.filter(pa.array([gate.is_gating(name) for name in rows["finding_id"].to_pylist()], pa.bool_()))
    rules = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
    found = sorted(rows.to_pylist(), key=lambda row: _badness(row, rules))
    drives = _drives(result, found, rules, width)
    parts: list[RenderableType] = [_head(result), Text(), _verdict(result, found, rules), Text(), drives, Text()]
    if found:
        parts += [_broken(found), Text()]
    return Group(*parts, *_lines(result), Text(), *_end(result, found, out))


def _badness(row: Row, rules: dict[str, Any]) -> tuple[Any, ...]:
    """Order findings: severity, contacts first, the least margin, then the time."""
    margin = row["margin"]
    return (
        counts.SEVERITIES.index(row["severity"]),
        not _is_contact(row, rules),
        0.0 if margin is None else margin,
        row["t_worst_ns"] or 0,
        row["finding_id"],
    )


def _is_contact(row: Row, rules: dict[str, Any]) -> bool:
    return "contact" in rules[row["rule_id"]]["tags"]


def _head(result: Result) -> Text:
    drives = result.drives
    packs = list(counts.verdicts_by_pack(result.rules, result.verdicts))
    total = [pc.sum(drives[name]).as_py() or 0.0 for name in ("km", "duration_s")]
    n_rules = plural(result.rules.num_rows, "rule")
    return Text(
        f"drivelint: {plural(drives.num_rows, 'drive')}, {total[0]:.2f} km, {total[1]:.0f} s, {n_rules} ({', '.join(packs)})"
    )


def _severities(rows: list[Row]) -> str:
    n = {severity: sum(row["severity"] == severity for row in rows) for severity in counts.SEVERITIES}
    return ", ".join(f"{n[severity]} {severity}" for severity in counts.SEVERITIES if n[severity])


def _verdict(result: Result, found: list[Row], rules: dict[str, Any]) -> Text:
    """Return the run's verdict with the number of findings by severity, and in how many drives the ego touched something, or may have."""
    code = exit_status(result).code
    label, style = _LABEL.get(code, ("?", "bold yellow"))
    decided = counts.total(result.verdicts)
    if code == ExitCode.OK and (found or not decided["pass"] + decided["fail"]):
        label, style = "FINDINGS" if found else "UNKNOWN", "bold yellow"  # findings that do not gate are no pass
    text = Text(f"{label}  ", style)
    new = "new " if result.gate is not None and result.gate.baseline is not None else ""
    in_drives = len({row["drive_id"] for row in found})
    where = f" in {in_drives} of {plural(result.drives.num_rows, 'drive')}" if found else ""
    text.append(f"{_severities(found) or 'no'} {new}{'finding' if len(found) == 1 else 'findings'}{where}", "default")
    contacts = [row for row in found if _is_contact(row, rules)]
    touched = {row["drive_id"] for row in contacts if not doubt(row)}
    if touched:
        text.append(f"; CONTACT in {len(touched)}", "bold red")
    if maybe := {row["drive_id"] for row in contacts} - touched:
        text.append(f"; possible contact in {len(maybe)}", "red")
    if doubtful := sum(bool(doubt(row)) for row in found):
        text.append(f"; {doubtful} only possible", "default")
    if result.gate is not None and (through := result.findings.num_rows - len(found)):
        unless = "known, waived or only possible" if result.gate.confidence is not None else "known or waived"
        text.append(f"; {through} {unless}", "default")
    return text


def _table(names: Iterable[str], most: Mapping[str, int]) -> Table:
    """Return a table; `most`: the columns of words and their greatest widths."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, header_style="dim")
    for name in names:
        justify: JustifyMethod = "left" if name in most else "right"
        table.add_column(name, justify=justify, no_wrap=True, overflow="ellipsis", max_width=most.get(name))
    return table


def _drives(result: Result, found: list[Row], rules: dict[str, Any], width: int) -> Table:
    """Return one row a drive, the worst first: its worst finding, and its findings by severity."""
    of_drive = counts.grouped(found, lambda row: row["drive_id"])
    unknown = counts.verdicts_by(result.verdicts, "drive_id")
    starts = result.start_times

    def order(drive: Row) -> tuple[Any, ...]:
        mine = of_drive.get(drive["drive_id"], [])
        n = [-sum(row["severity"] == severity for row in mine) for severity in counts.SEVERITIES]
        return drive["status"] == "judged", *n, drive["drive_id"], drive["file_name"]

    drives = sorted(result.drives.to_pylist(), key=order)
    names = [drive["drive_id"] + (" (lossy)" if drive["lossy"] else "") for drive in drives[:MOST_DRIVES]]
    longest = min(max(map(len, names)), width // 3)
    table = _table(("drive", "worst", *_SHORT.values(), "unknown"), {"drive": longest, "worst": width - longest - 34})
    for drive, shown in zip(drives, names, strict=False):
        name = drive["drive_id"]
        mine = of_drive.get(name, [])
        if drive["status"] != "judged":
            table.add_row(Text(shown, "yellow"), Text(drive["status_reason"] or "not judged", "yellow"))
            continue
        worst = _worst(mine[0], rules, starts[name]) if mine else _without_finding(unknown[name])
        n = [sum(row["severity"] == severity for row in mine) for severity in counts.SEVERITIES]
        cells = [_cell(k, STYLE[severity]) for k, severity in zip(n, counts.SEVERITIES, strict=True)]
        table.add_row(
            Text(shown, "yellow" if drive["lossy"] else ""), worst, *cells, _cell(unknown[name]["unknown"], "yellow")
        )
    if len(drives) > MOST_DRIVES:
        table.add_row(Text(f"... {len(drives) - MOST_DRIVES} more (--verbose)", "dim"))
    return table


def _without_finding(verdicts: Mapping[str, int]) -> Text:
    return Text("no finding", "dim") if verdicts["pass"] else Text("nothing was judged", "yellow")


def _cell(n: int, style: str) -> Text:
    return Text(str(n), style) if n else Text("·", "dim")


def _worst(row: Row, rules: dict[str, Any], start_ns: int | None) -> Text:
    """Return when, what was measured and by which rule: numbers first, because a narrow column cuts the end."""
    contact = _is_contact(row, rules)
    parts = []
    if row["observed"] is not None and row["required"] is not None:
        profile = "" if row["profile"] is None else f" [{row['profile']}]"
        parts.append(f"{number(row['observed'], row['unit'])}, needs {number(row['required'], row['unit'])}{profile}")
    if not contact:
        parts.append(rules[row["rule_id"]]["title"])
    if row["object_id"] is not None:
        parts.append(f"object {row['object_id']}")
    when = f"{seconds(row['t_worst_ns'], start_ns):>8} "
    what = "possible contact " if doubt(row) else "CONTACT "
    if doubt(row) and not contact:
        parts[0] = f"possibly {parts[0]}"
    return Text.assemble(when, (what if contact else "", "bold red"), "; ".join(parts))


def _broken(found: list[Row]) -> Table:
    """Return one row a broken rule, the worst first."""
    table = _table(("broken rule", "findings", "drives", "worst margin"), {"broken rule": 60})
    of_rule = counts.grouped(found, lambda row: row["rule_id"])
    for rule_id, rows in list(of_rule.items())[:MOST_RULES]:
        margins = [row["margin"] for row in rows if row["margin"] is not None]
        severity = rows[0]["severity"]
        name = Text.assemble((f"{severity:<8} ", STYLE[severity]), rule_id)
        n_drives = len({row["drive_id"] for row in rows})
        table.add_row(name, str(len(rows)), str(n_drives), number(min(margins, default=None), rows[0]["unit"]))
    if len(of_rule) > MOST_RULES:
        table.add_row(Text(f"... {len(of_rule) - MOST_RULES} more (--verbose)", "dim"))
    return table


def _lines(result: Result) -> list[Text]:
    """Return how many rules were judged, what is unknown by what is missing, and how map and logs are."""
    by_rule = counts.verdicts_by(result.verdicts, "rule_id")
    rules = [by_rule[rule_id] for rule_id in result.rules["rule_id"].to_pylist()]
    judged = sum(bool(n["pass"] + n["fail"]) for n in rules)
    applied = sum(bool(sum(n.values()) - n["not_applicable"]) for n in rules)
    said = [f"{judged} judged", f"{applied - judged} never judgeable" if applied > judged else ""]
    said.append(f"{len(rules) - applied} never applied" if len(rules) > applied else "")
    near = int(pc.sum(result.verdicts["near_miss"]).as_py() or 0)
    first = f"{plural(len(rules), 'rule')}: {', '.join(part for part in said if part)}"
    if near:
        first += f"    near misses: {near}"
    if given := {f"{c['condition']}={c['value']}" for cs in result.drives["conditions"].to_pylist() for c in cs or ()}:
        first += f"    judged in: {', '.join(sorted(given))}"
    return [Text(first), *_unknown(result), _inputs(result)]


def _unknown(result: Result) -> list[Text]:
    """Return unknown verdicts by what is missing: signals that no log has in one line, then the most frequent other reasons."""
    rows = (
        counts.undecided(result.verdicts)
        .select(["verdict", "reason_code", "cause_code", "rule_id", "reason"])
        .to_pylist()
    )
    signals, others = (
        [row for row in rows if row["reason_code"].startswith("missing_") is missing] for missing in (True, False)
    )

    def rules(these: list[Row]) -> int:
        return len({row["rule_id"] for row in these})

    def by_rules(key: Callable[[Row], Any], these: list[Row]) -> list[tuple[Any, list[Row]]]:
        groups = counts.grouped(these, key)
        return sorted(groups.items(), key=lambda group: (-rules(group[1]), -len(group[1]), group[0]))

    lines = []
    if signals:
        missing = by_rules(lambda row: row["reason_code"].removeprefix("missing_").removeprefix("mode_"), signals)
        names = [f"{name.replace('_', ' ')} ({plural(rules(these), 'rule')})" for name, these in missing]
        lines.append(Text(f"unknown (not logged or not in the map): {listed(names)}", "yellow"))
    groups = by_rules(lambda row: (row["verdict"], row["reason_code"], row["cause_code"] or ""), others)
    for _, these in groups[:MOST_REASONS]:
        times = f", {len(these)} times" if len(these) > 1 else ""
        words = f"{these[0]['verdict']} ({plural(rules(these), 'rule')}{times}): {these[0]['reason']}"
        lines.append(Text(words, "yellow", no_wrap=True, overflow="ellipsis"))
    if len(groups) > MOST_REASONS:
        lines.append(Text(f"... {plural(len(groups) - MOST_REASONS, 'more reason')} (--verbose)", "dim"))
    return lines


def _inputs(result: Result) -> Text:
    """Return which map the drives were judged on, how many it fits, and whether the logs are whole."""
    drives = [drive for drive in result.drives.to_pylist() if drive["status"] == "judged"]
    maps = sorted({drive["map_name"] for drive in drives if drive["map_name"] is not None})
    on_map = [drive for drive in drives if drive["map_name"] is not None]
    off = sum(off_map_reason(drive) is not None for drive in on_map)
    fits = f"{listed(maps, 2)} fits {len(on_map) - off} of {plural(len(on_map), 'drive')}" if maps else "none"
    text = Text.assemble("map: ", (fits, "default" if maps and not off else "yellow"))
    lossy = [drive["drive_id"] for drive in drives if drive["lossy"]]
    warned = [q for drive in drives for q in drive["quality"] if q["severity"] != "info"]
    told = plural(len({(q["check_id"], q["message"]) for q in warned}), "warning") if warned else "no warnings"
    text.append(f"    data: {told}", "yellow" if warned else "default")
    if lossy:
        text.append(f"; parts lost in {listed(lossy, 2)}", "bold yellow")
    return text


def _end(result: Result, found: list[Row], out: str | None) -> list[Text]:
    end = exit_status(result)
    style = _LABEL.get(end.code, ("", "bold yellow"))[1]
    lines = [Text(f"exit {int(end.code)}: {end.why}", style)]
    gate = result.gate
    if gate is not None and gate.baseline is not None:
        lines.append(Text(f"baseline {descriptions.headline(gate.baseline)}"))
    if gate is not None:
        lines += [Text(f"waiver   {line}", "yellow") for line in descriptions.waiver_warnings(gate)]
    if counts.total(result.verdicts)["unknown"]:
        lines.append(Text("inspect  drivelint inspect TRACE tells what a log lacks: unknown is not pass"))
    if out is None:
        lines.append(Text("keep     --out DIR writes a report, the tables and the logs with their verdicts", "dim"))
        return lines
    lines.append(Text(f"open     {out}/report.html"))
    if found:
        worst = found[0]
        drive = worst["drive_id"]
        lines.append(Text(f"explain  drivelint explain {worst['rule_id']}@{drive} --in {out}"))
    return lines
