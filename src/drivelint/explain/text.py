"""An explanation as text for a terminal, and as JSON."""

from __future__ import annotations

import json
import math
import re
import textwrap
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Final

from rich.console import Group
from rich.text import Text

from drivelint.drive.declared_events import EVENTS
from drivelint.explain.plot import plot_lines
from drivelint.explain.verdict_context import lacks_signal
from drivelint.phrases import one_line
from drivelint.reasons.signals import UNRECORDED_PREFIX, remedy, unknown_condition_column
from drivelint.result.text import breach_title, ego_name, replace_non_finite, seconds
from drivelint.result.text_templates import text_template
from drivelint.sql import declarations
from drivelint.sql.library import library_tables

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rich.console import RenderableType

    from drivelint.explain.model import Explanation, Row

EXPLAIN_SCHEMA_VERSION: Final = 1
"""The version of the JSON, increased when a key changes its meaning or is removed."""
PLOT_HEIGHT: Final = 8
_TABLE_ROW_INDENT: Final = 4
"""The number of spaces before a row of a table."""
_STYLE_BY_VERDICT: Final = {"pass": "bold green", "fail": "bold red", "unknown": "bold yellow", "error": "bold magenta"}
_LEAST_NUMBER_SHOWN_WITH_TWO_DECIMALS: Final = 0.1
_LEAST_NUMBER_SHOWN_WITH_SIX_DIGITS: Final = 1e6
_NUMBER_WITH_MANY_DECIMALS_AND_UNIT: Final = re.compile(
    r"(?<![\w.-])-?\d+\.\d{3,}(?= (?:m|s|rad|m/s|m/s2|m/s3|mph|km/h|%)(?![\w/]))"
)
"""A number with more than two decimals that a unit follows."""
_JSON_KEY_BY_FIELD: Final = {"other_verdicts": "others", "description": "what", "nearest_value": "found"}
"""The keys in the JSON of fields with another name."""
_MEANING_BY_VERDICT: Final = {
    "fail": "the rule was broken",
    "pass": "the rule was kept",
    "unknown": "it is not known whether the rule was kept: this is not a pass",
    "not_applicable": "the situation that the rule is about did not occur",
    "error": "the rule could not be run",
}
_SECTION_BY_REASON_CODE: Final = {
    "reference_time_unknown": "reference",
    "anchor_unknown": "anchor",
    "null_value": "condition",
}
_NULL_MEANS_NONE: Final = re.compile(r"NULL: (?:none|no |never)(?!.*known)")
"""Matches the comment of a column in which NULL is a known answer: there is none."""
_LACKING_VALUES: Final[dict[str, bool | None]] = {"NULL": None, "no": False}
"""Word -> the value of a column by which a row tells that something is not known; `no` only of `_TELLS_WHETHER_KNOWN`."""
_TELLS_WHETHER_KNOWN: Final = re.compile(r"(?:^|_)(?:known|seen)$")
"""Matches the name of a column that tells whether something is known."""
_REASONS_NOT_TO_APPLY: Final = {
    "other_nation": "the rule is the law of another nation",
    "outside_conditions": "the rule applies only in other conditions",
}


def to_json(explanation: Explanation) -> str:
    """Return the explanation as JSON; a step is [t_ns, observed, required, margin, holds]."""
    plain = {"explain_schema": EXPLAIN_SCHEMA_VERSION, **_with_json_keys(asdict(explanation))}
    plain["series"] = [list(step) for step in explanation.series]
    plain["rows"] = [rows._asdict() for rows in explanation.rows]
    plain["parts"] = [_with_json_keys(part._asdict()) for part in explanation.parts]
    plain["changes"] = [_with_json_keys(change._asdict()) for change in explanation.changes]
    return json.dumps(replace_non_finite(plain), indent=2, ensure_ascii=False, allow_nan=False)


def _with_json_keys(fields: dict[str, Any]) -> dict[str, Any]:
    return {_JSON_KEY_BY_FIELD.get(name, name): value for name, value in fields.items()}


def render(explanation: Explanation, width: int) -> Group:
    """Return the explanation for a terminal of `width` columns."""
    width = max(40, min(width, 120))
    parts: list[RenderableType] = [*_title_and_verdict(explanation, width)]
    prose = _sentences_by_section(explanation, width)
    sections = [
        ("What happened", prose["happened"]),
        ("What would decide it", prose["decides"]),
        ("How sure it is", prose["sure"]),
        ("What would change it", prose["changes"]),
        (
            "Margin over time" if explanation.rule["sense"] != "holds" else "Over time",
            _plot_and_legend_lines(explanation, width),
        ),
        ("Data on which it was judged", prose["rows"]),
        ("What the rule requires", prose["asks"]),
        ("How it was judged", [*prose["judged"], *_sql_lines(explanation, width)]),
    ]
    for heading, lines in sections:
        if lines:
            parts += [Text(), Text(heading, "bold"), *(Text(line) for line in _wrapped_lines(lines, width))]
    return Group(*parts)


def _title_and_verdict(explanation: Explanation, width: int) -> list[RenderableType]:
    row, rule = explanation.verdict, explanation.rule
    facts = [f"drive {row['drive_id']}", ego_name(row["ego_id"])]
    facts += [f"object {row['object_id']}"] if row["object_id"] is not None else []
    facts += [f"profile {row['profile']}"] if row["profile"] is not None else []
    if row["t_start_ns"] is not None:
        start, end = (seconds(row[key], explanation.drive["t_start_ns"]) for key in ("t_start_ns", "t_end_ns"))
        facts.append(f"at {start}" if start == end else f"{start} to {end}")
        broken = [step.t_ns for step in explanation.series if step.holds is False and step.t_ns >= row["t_start_ns"]]
        if broken and start != end:
            facts.append(f"first broken at {seconds(broken[0], explanation.drive['t_start_ns'])}")
    if "finding_id" in row:
        facts.append(f"finding {row['finding_id']}")
    word = row["verdict"].replace("_", " ").upper()
    title = breach_title(rule) if row["verdict"] == "fail" else rule["title"]
    return [
        Text(f"{rule['rule_id']}: {one_line(title)}", "bold"),
        Text.assemble((word, _STYLE_BY_VERDICT.get(row["verdict"], "bold")), f": {_meaning_of_verdict(row)}"),
        *(Text(line) for line in textwrap.wrap(", ".join(facts), width)),
    ]


def _meaning_of_verdict(row: Mapping[str, Any]) -> str:
    """Return the meaning of a verdict in words."""
    if row["verdict"] == "not_applicable" and row["reason_code"].startswith(UNRECORDED_PREFIX):
        return f"the log does not contain a signal that the rule needs; with `--rules {row['rule_id']}` the verdict is unknown"
    return _REASONS_NOT_TO_APPLY.get(row["reason_code"], _MEANING_BY_VERDICT[row["verdict"]])


def _sentences_by_section(explanation: Explanation, width: int) -> dict[str, list[str]]:
    """Return the sections of the template by their names, as lists of sentences."""
    row, start_ns = explanation.verdict, explanation.drive["t_start_ns"]
    template = text_template(
        __file__,
        "explanation.txt.j2",
        # a line break in a value must not begin a new sentence
        finalize=lambda value: value.replace("\n", "\v") if isinstance(value, str) else value,
        cells=lambda row, table: [
            _cut_line(line, width - _TABLE_ROW_INDENT) for line in _lines_on_row(explanation, table, row)
        ],
        at_least=_rounded_up,
        measure=_value_with_unit,
        rounded=_sentence_with_rounded_numbers,
        seconds=lambda t_ns: seconds(t_ns, start_ns),
        value=_value_text,
    )
    context = template.new_context(
        {
            "explanation": explanation,
            "row": row,
            "rule": explanation.rule,
            "not_run": lacks_signal(row),
            "remedy": remedy(row["reason_code"], row["object_id"], explanation.drive["format"], explanation.asks),
            "unknown": [step.t_ns for step in explanation.series if step.holds is None],
            "events": EVENTS,
            "null_sentences": _null_sentences(explanation),
            "sql": "\n".join(explanation.sql.values()),
        }
    )
    sections = {name: "".join(block(context)) for name, block in template.blocks.items()}
    return {name: list(filter(None, text.split("\n"))) for name, text in sections.items()}


def _sql_lines(explanation: Explanation, width: int) -> list[str]:
    if lacks_signal(explanation.verdict):
        return []
    columns_by_value = {
        word: {column for columns in _columns_with_value(explanation, value).values() for column in columns}
        for word, value in _LACKING_VALUES.items()
    }
    lines = (line for name, sql in explanation.sql.items() for line in (f"-- @{name}", *sql.splitlines()))
    return [
        f"|{part}" for line in lines for part in _folded_sql(line, _note_on_line(line, columns_by_value), width - 2)
    ]


def _folded_sql(line: str, note: str, width: int) -> list[str]:
    """Return a line of SQL and a note as lines of at most `width`, if it can be broken: they can be copied and run as one line can."""
    indent = line[: len(line) - len(line.lstrip())]
    is_comment = line.lstrip().startswith("--")
    if len(line + note) <= width or ("--" in line and not is_comment):
        return [line + note]
    unbroken = line if is_comment else re.sub(r"'[^']*'", lambda text: text[0].replace(" ", "\0"), line)
    lines = textwrap.wrap(
        unbroken,
        width,
        subsequent_indent=indent + ("-- " if is_comment else "    "),
        break_long_words=False,
        break_on_hyphens=False,
    )
    lines = [part.replace("\0", " ") for part in lines]
    return [*lines, indent + note.lstrip()] if note else lines


def _note_on_line(line: str, columns_by_value: Mapping[str, Collection[str]]) -> str:
    """Return a comment for the end of a line of SQL that names columns that tell what is not known; '' for another line."""
    code = "" if line.lstrip().startswith("GROUP BY") else line.partition("--")[0]
    notes = {
        word: sorted(column for column in columns if re.search(rf"\b{column}\b", code))
        for word, columns in columns_by_value.items()
    }
    notes_text = "; ".join(f"{word} here: {', '.join(columns)}" for word, columns in notes.items() if columns)
    return f"  -- {notes_text}" if notes_text else ""


def _columns_with_value(explanation: Explanation, lacking: bool | None) -> dict[str, list[str]]:
    """Return, for an unknown verdict, table -> columns that the rule's SQL names and that tell what is not known in a row that is shown.

    `lacking`: None for columns that are NULL, False for columns such as `known` and `begin_seen` that are false.
    """
    if explanation.verdict["verdict"] != "unknown" or lacks_signal(explanation.verdict):
        return {}
    sql = "\n".join(explanation.sql.values())
    columns_by_table: dict[str, list[str]] = {}
    for table, rows, *_ in explanation.rows:
        comments = declarations.column_comments().get(table, {})
        empty = dict.fromkeys(
            column
            for row in rows
            for column, value in row.items()
            if value is lacking and (lacking is None or _TELLS_WHETHER_KNOWN.search(column))
        )
        columns = [c for c in empty if re.search(rf"\b{c}\b", sql) and not _NULL_MEANS_NONE.search(comments.get(c, ""))]
        if columns and table != "profile":  # the numbers of a profile are chosen, not recorded
            columns_by_table[table] = columns
    return columns_by_table


def _null_sentences(explanation: Explanation) -> list[str]:
    """Return which section of the rule has no value, and for each table its columns that are not known, with the file that fills it."""
    section = _SECTION_BY_REASON_CODE.get(explanation.verdict["reason_code"])
    first = [f"The SELECT below that gives no value: @{section}."] if section in explanation.sql else []
    return first + [
        f"{word} in {table}{f' ({library_tables()[table].short_path})' if table in library_tables() else ''}: {', '.join(columns)}."
        for word, value in _LACKING_VALUES.items()
        for table, columns in _columns_with_value(explanation, value).items()
    ]


def _lines_on_row(explanation: Explanation, table: str, row: Row) -> list[str]:
    """Return the columns of a row that the rule's SQL or the verdict's condition names, each with value and meaning."""
    condition = (
        None if "finding_id" in explanation.verdict else unknown_condition_column(explanation.verdict["reason_code"])
    )
    condition_column = {"ego_condition": condition, "ego_state": "lanelet_id"}.get(table) if condition else None
    sql = "\n".join(explanation.sql.values())
    columns = [
        column
        for column in row
        if column == condition_column or table == "capability" or re.search(rf"\b{column}\b", sql)
    ] or list(row)
    wide, comments = max(map(len, columns)), declarations.column_comments().get(table, {})
    start_ns = explanation.drive["t_start_ns"] or 0
    return [
        f"{column:<{wide}}  {_cell_text(column, row[column], start_ns):<12}  {_column_comment(comments.get(column, ''), row[column])}"
        for column in columns
    ]


def _cut_line(line: str, width: int) -> str:
    """Return a line cut to `width`, so that a terminal does not wrap it."""
    return line if len(line) <= width else f"{line[: width - 3].rstrip()}..."


def _cell_text(column: str, value: Any, start_ns: int) -> str:
    """Return a value as text; a time in seconds from the drive's start."""
    is_time = column.endswith("_ns") and column[0] == "t" and isinstance(value, int)
    if value is None:
        return "NULL"  # the comment beside it explains NULL
    return seconds(value, start_ns) if is_time else _value_text(value)


def _column_comment(text: str, value: Any) -> str:
    """Return a column's comment, shortened. For NULL: only the part about NULL, if any; for other values: without that part."""
    of_value, null, of_null = text.partition("NULL: ")
    if null:
        text = null + of_null if value is None else of_value.rstrip("; ") or text
    return text if len(text) <= 70 else text[:67].rstrip() + "..."


def _plot_and_legend_lines(explanation: Explanation, width: int) -> list[str]:
    unit = one_line(explanation.rule["unit"] or "")
    lines = [
        f"|{line}"
        for line in plot_lines(explanation.series, width - 16, PLOT_HEIGHT, explanation.drive["t_start_ns"] or 0, unit)
    ]
    if not lines:
        return ["It was judged at one moment only."] if len(explanation.series) == 1 else []
    key = "Above the limit line: kept; below: broken; the height is the margin. ?: not known."
    is_measured = any(step.margin is not None for step in explanation.series)
    return [*lines, key if is_measured else "█ broken, · kept, ? not known."]


def _wrapped_lines(lines: list[str], width: int) -> list[str]:
    """Return the sentences wrapped and indented; a line that begins with `|` is not wrapped, and loses the `|`."""
    folded: list[str] = []
    for line in lines:
        if line.startswith("|"):
            folded.append(f"  {line[1:]}".replace("\v", "\\n"))
        else:
            folded += textwrap.wrap(
                line, width, initial_indent="  ", subsequent_indent="    " if line[:2] == "- " else "  "
            )
    return folded


def _value_with_unit(value: float | None, unit: str | None) -> str:
    return f"{_value_text(value)} {unit}" if unit else _value_text(value)


def _value_text(value: Any) -> str:
    if value is None:
        return "not known"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return _rounded_text(value) if isinstance(value, float) else str(value)


def _rounded_text(value: float) -> str:
    """Return a number with two decimals; a small number with two significant digits."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    return (
        f"{value:.2g}"
        if abs(value) < _LEAST_NUMBER_SHOWN_WITH_TWO_DECIMALS
        else f"{value:.2f}"
        if abs(value) < _LEAST_NUMBER_SHOWN_WITH_SIX_DIGITS
        else f"{value:.6g}"
    )


def _rounded_up(value: float) -> float:
    """Return the number rounded up to two decimals, so that a change by it is enough."""
    return math.ceil(round(value * 100, 6)) / 100 if value >= _LEAST_NUMBER_SHOWN_WITH_TWO_DECIMALS else value


def _sentence_with_rounded_numbers(text: str) -> str:
    """Return a sentence with its measured values rounded as in the other texts; the JSON is not rounded."""
    return _NUMBER_WITH_MANY_DECIMALS_AND_UNIT.sub(lambda match: _rounded_text(float(match[0])), text)
