"""An explanation as a person reads it, and as a program does."""

from __future__ import annotations

import json
import re
import textwrap
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Final

from rich.console import Group
from rich.text import Text

from drivelint.drive.declared_events import EVENTS
from drivelint.explain.plot import plot
from drivelint.explain.verdict_context import lacks_signal
from drivelint.reasons.remedies import condition_of, remedy
from drivelint.result.text import finite, seconds
from drivelint.sql import store

if TYPE_CHECKING:
    from rich.console import RenderableType

    from drivelint.explain.model import Change, Explanation, Row, Sensitivity, TableRows

EXPLAIN_SCHEMA: Final = 1
"""Version of the JSON: raised when a key changes its meaning or goes."""
PLOT_HEIGHT: Final = 8
MAX_OTHER_VERDICTS: Final = 6
_STYLE: Final = {"pass": "bold green", "fail": "bold red", "unknown": "bold yellow", "error": "bold magenta"}
_MEANS: Final = {
    "fail": "the rule was broken",
    "pass": "the rule was kept",
    "unknown": "it cannot be told whether the rule was kept: that is no pass",
    "not_applicable": "what the rule is about did not happen",
    "error": "the rule could not be run",
}
_DOES: Final = {
    "fail": "fails", "unknown": "is unknown", "pass": "passes", "not_applicable": "does not apply", "error": "errs",
}  # fmt: skip
_WOULD: Final = {
    "fail": "it would fail", "unknown": "it would be unknown", "pass": "it would pass",
    "not_applicable": "it would not apply", "error": "it could not be judged",
}  # fmt: skip
_SENSE: Final = {">": "more than", ">=": "at least", "<": "less than", "<=": "at most"}
_WHEN: Final = {
    "invariant": "must hold at every step to which it applies",
    "execution": "must hold at one moment",
    "precondition": "must hold before one moment",
    "postcondition": "must hold after one moment",
}


def to_json(found: Explanation) -> str:
    """Return everything as JSON; a step is [t_ns, observed, required, margin, holds]."""
    plain = {"explain_schema": EXPLAIN_SCHEMA, **asdict(found)}
    plain["series"] = [list(step) for step in found.series]
    plain["rows"] = [rows._asdict() for rows in found.rows]
    plain["changes"] = [change._asdict() for change in found.changes]
    return json.dumps(finite(plain), indent=2, ensure_ascii=False, allow_nan=False)


def render(found: Explanation, width: int) -> Group:
    """Return the explanation for a terminal of `width` columns."""
    width = max(40, min(width, 120))
    parts: list[RenderableType] = [*_title(found, width)]
    sections = [
        ("What happened", _happened(found)),
        ("What would decide it", _decides(found)),
        ("What the rule asks", _asks(found)),
        ("How it was judged", _sql(found)),
        ("What it was judged on", _rows(found)),
        ("Margin over time" if found.rule["sense"] != "holds" else "Over time", _series(found, width)),
        ("What would change it", _changes(found)),
        ("How sure it is", _sure(found)),
    ]
    for heading, lines in sections:
        if lines:
            parts += [Text(), Text(heading, "bold"), *(Text(line) for line in _folded(lines, width))]
    return Group(*parts)


def _title(found: Explanation, width: int) -> list[RenderableType]:
    row, rule = found.verdict, found.rule
    who = [f"drive {row['drive_id']}", f"ego {row['ego_id']}"]
    who += [f"object {row['object_id']}"] if row["object_id"] is not None else []
    who += [f"profile {row['profile']}"] if row["profile"] is not None else []
    if row["t_start_ns"] is not None:
        start, end = (seconds(row[key], found.drive["t_start_ns"]) for key in ("t_start_ns", "t_end_ns"))
        who.append(f"at {start}" if start == end else f"{start} to {end}")
    if "finding_id" in row:
        who.append(f"finding {row['finding_id']}")
    word = row["verdict"].replace("_", " ").upper()
    return [
        Text(f"{rule['rule_id']}: {rule['title']}", "bold"),
        Text.assemble((word, _STYLE.get(row["verdict"], "bold")), f": {_MEANS[row['verdict']]}"),
        *(Text(line) for line in textwrap.wrap(", ".join(who), width)),
    ]


def _happened(found: Explanation) -> list[str]:
    row = found.verdict
    lines = [row["reason"]]
    if row["near_miss"]:
        lines.append(
            f"Kept, but with less to spare than {_measure(found.rule['near_margin'], row['unit'])}: a near miss."
        )
    if row["assumes"] == "line_of_sight":
        lines.append(
            "Assumed: whoever the log does not have is not in plain view of the ego; without that: check --visibility none."
        )
    if row["n_expected"]:
        lines.append(f"{row['n_judged']} of {row['n_expected']} steps that had to be judged could be.")
    lines += found.notes
    if found.others:
        told = [
            _elsewhere(other, row["ego_id"], found.drive["t_start_ns"]) for other in found.others[:MAX_OTHER_VERDICTS]
        ]
        more = f"; {len(found.others) - MAX_OTHER_VERDICTS} more" if len(found.others) > MAX_OTHER_VERDICTS else ""
        lines.append(f"The same rule elsewhere in this drive: {'; '.join(told)}{more}.")
    return lines


def _elsewhere(other: Row, ego_id: str, start_ns: int | None) -> str:
    """Return another verdict in a few words; its ego only if it is another one."""
    text = str(other["verdict"]).replace("_", " ")
    text += f" for ego {other['ego_id']}" if other["ego_id"] != ego_id else ""
    text += f" with profile {other['profile']}" if other["profile"] else ""
    text += f" for object {other['object_id']}" if other["object_id"] else ""
    return text + (f" from {seconds(other['t_start_ns'], start_ns)}" if other["t_start_ns"] is not None else "")


def _decides(found: Explanation) -> list[str]:
    row = found.verdict
    if row["verdict"] != "unknown":
        return []
    told = remedy(row["reason_code"], row["object_id"], found.drive["format"], found.asks)
    unknown = [step.t_ns for step in found.series if step.holds is None]
    if len(unknown) > 1 and not lacks_signal(row["verdict"], row["reason_code"]):
        start, end = (seconds(t, found.drive["t_start_ns"]) for t in (unknown[0], unknown[-1]))
        told += f". This is for the first of {len(unknown)} unknown steps ({start} to {end}): others may lack something else"
    if found.asks and row["reason_code"] in {"null_value", "applies_unknown", "missing_step"}:
        told += ". More than this may be missing there"
    text = "\n".join(found.sql.values())
    asked = row["reason_code"].startswith(("missing_declared", "missing_mode"))
    named = [
        f"The rule reads the event {name} (value: {event.value}): {event.says}."
        for name, event in EVENTS.items()
        if asked and f"'{name}'" in text
    ]
    return [f"{told[0].upper()}{told[1:]}.", *named]


def _asks(found: Explanation) -> list[str]:
    rule = found.rule
    lines = [rule["clause"], rule["hypothesis"]]
    draft = "" if rule["status"] == "stable" else f", {rule['status']}: it never fails a gate"
    lines.append(f"It {_WHEN[rule['kind']]}. {rule['severity'].capitalize()}; a '{rule['legal']}' of the Code{draft}.")
    if rule["applies"]:
        told = (f"{name.replace('_', ' ')} {' or '.join(words)}" for name, words in rule["applies"].items())
        lines.append(f"It applies only with {', and '.join(told)}.")
    if rule["sense"] != "holds":
        what = rule["observes"] or "what is observed"
        lines.append(f"Kept where {what} is {_SENSE[rule['sense']]} what is required, in {rule['unit']}.")
    return lines


def _sql(found: Explanation) -> list[str]:
    if lacks_signal(found.verdict["verdict"], found.verdict["reason_code"]):
        return ["The rule was not run: the log or the map lacks a signal that it requires."]
    lines = []
    for name, sql in found.sql.items():
        lines += [f"|-- @{name}", *(f"|{line}" for line in sql.splitlines())]
    values = [f"{p['name']} = {_value(p['value'])} {p['unit']} ({p['why']})" for p in found.params]
    return [*(f"- {value}" for value in values), *lines]


def _rows(found: Explanation) -> list[str]:
    text = "\n".join(found.sql.values())
    at = "" if found.decides_ns is None else f", at {seconds(found.decides_ns, found.drive['t_start_ns'])}"
    condition = None if "finding_id" in found.verdict else condition_of(found.verdict["reason_code"])
    asked = {"ego_condition": condition, "ego_state": "lanelet_id"} if condition else {}
    lines = [f"From {found.source}{at}:"]
    for table in found.rows:
        lines += _table(table, text, found.drive["t_start_ns"] or 0, asked.get(table.table))
    return lines if found.rows else []


def _table(table: TableRows, sql: str, start_ns: int, asked: str | None) -> list[str]:
    """Return the columns that the rule names, and the one that is asked for, each with what it means."""
    if not table.rows:
        return [f"{table.table}: no row: there is nothing of that kind here."]
    comments = store.column_comments().get(table.table, {})
    lines = []
    for row in table.rows:
        named = [
            column
            for column in row
            if column == asked or table.table == "capability" or re.search(rf"\b{column}\b", sql)
        ] or list(row)
        lines.append(f"{table.table}:")
        wide = max(len(column) for column in named)
        for column in named:
            value = _cell(column, row[column], start_ns)
            lines.append(f"|  {column:<{wide}}  {value:<12}  {_comment(comments.get(column, ''))}")
    return [*lines, *([f"... and {table.more} more rows of {table.table}."] if table.more else [])]


def _cell(column: str, value: Any, start_ns: int) -> str:
    """Return a value; a time as it is elsewhere, in seconds of the drive."""
    is_time = column.endswith("_ns") and column[0] == "t" and isinstance(value, int)
    if value is None:
        return "NULL"  # the comment beside it says what that means
    return seconds(value, start_ns) if is_time else _value(value)


def _comment(text: str) -> str:
    return text if len(text) <= 70 else text[:67].rstrip() + "..."


def _series(found: Explanation, width: int) -> list[str]:
    unit = found.rule["unit"] or ""
    lines = [f"|{line}" for line in plot(found.series, width - 16, PLOT_HEIGHT, found.drive["t_start_ns"] or 0, unit)]
    if not lines and len(found.series) == 1:
        return ["It was judged at one moment only."]
    if not lines:
        return []
    key = "Above the limit: kept, and by how much; below: broken; ?: not known."
    measured = any(step.margin is not None for step in found.series)
    return [*lines, key if measured else "█ broken, · kept, ? not known."]


def _changes(found: Explanation) -> list[str]:
    row = found.verdict
    if lacks_signal(row["verdict"], row["reason_code"]):
        return ["The rule was not run, since the log or the map lacks something: no number changes that."]
    lines = [_change(change) for change in found.changes]
    if row["margin"] is not None and row["verdict"] in {"pass", "fail"}:
        what = found.rule["observes"] or "what was observed"
        way = "more" if (found.rule["sense"][0] == ">") == (row["verdict"] == "fail") else "less"
        verb = "Kept" if row["verdict"] == "fail" else "Broken"
        lines.append(f"{verb} with the same limit, if {what} were {_measure(abs(row['margin']), row['unit'])} {way}.")
    if not found.changes:
        lines.append("The rule has no number of its own that could be set otherwise.")
    return lines


def _change(change: Change) -> str:
    now = f"{change.name} is {_measure(change.now, change.unit)} ({change.what})"
    if change.found is None or change.becomes is None:
        return f"{now}: nothing from {_value(change.low)} to {_value(change.high)} alone changes the verdict."
    sign = "=" if not change.beyond else ">=" if change.found > change.now else "<="
    return f"With {change.name} {sign} {_measure(change.found, change.unit)} {_WOULD[change.becomes]}: {now}."


def _sure(found: Explanation) -> list[str]:
    told = found.sensitivity
    if told is None:
        return []
    counts = ", ".join(f"{_DOES[verdict]} in {n}" for verdict, n in told.counts.items())
    return [f"{counts[0].upper()}{counts[1:]} of {told.samples}.", _errors(told, found.drive)]


def _errors(told: Sensitivity, drive: Row) -> str:
    part = ""
    if told.from_ns is not None:
        start = drive["t_start_ns"]
        part = f", on the part from {seconds(told.from_ns, start)} to {seconds(told.to_ns, start)}"
    return (
        f"So many copies of the drive were judged{part}, each with errors drawn once: {told.position_m:g} m in every actor's "
        f"position, {told.time_s:g} s in its clock, {told.map_m:g} m in the map's place (standard deviations; seed {told.seed})."
    )


def _folded(lines: list[str], width: int) -> list[str]:
    """Fold sentences; a line that begins with | stays as it is, without it."""
    folded: list[str] = []
    for line in lines:
        if line.startswith("|"):
            folded.append(f"  {line[1:]}")
        else:
            folded += textwrap.wrap(
                line, width, initial_indent="  ", subsequent_indent="    " if line[:2] == "- " else "  "
            )
    return folded


def _measure(value: float | None, unit: str | None) -> str:
    return f"{_value(value)} {unit}" if unit else _value(value)


def _value(value: Any) -> str:
    if value is None:
        return "not known"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
