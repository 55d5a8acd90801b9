"""The evidence of a verdict: the rule's SQL with the values of its parameters, and the rows that it read at the deciding step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

from drivelint.catalogue.required_value_parts import read_parts
from drivelint.explain.model import RequiredValuePart, Step, TableRows
from drivelint.reasons import reason_text
from drivelint.sql import declarations
from drivelint.sql.syntax import with_values

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.catalogue import Rule
    from drivelint.explain.sandbox import Judgement, Sandbox
    from drivelint.explain.target import Target

MAX_SHOWN_ROWS_PER_TABLE: Final = 6
"""The number of rows that are shown of each table."""
CONDITION_TABLES: Final = ("ego_condition", "ego_state")
"""Tables that show why a condition is not known."""
TABLES_WITH_ROW_PER_TRACK_STEP: Final = ("pair",)
"""Tables with a row at each step of an object's track. After the end of the track, its last row is shown."""
SERIES_PADDING_NS: Final = 30_000_000_000
"""Of a longer episode, this much time is shown before and after the explained interval."""
_SPAN_COLUMNS: Final = (
    ("t_ns", "t_ns"),
    ("t_start_ns", "t_end_ns"),
    ("t_from_ns", "t_to_ns"),
    ("t0_ns", "t_end_ns"),
    ("t_first_ns", "t_last_ns"),
)
_OBJECT_COLUMNS: Final = ("object_id", "vbp_id", "ov_id", "lead_id")


def sql_with_values(rule: Rule, params: Mapping[str, object]) -> dict[str, str]:
    """Return the rule's SQL sections with the parameters replaced by their values, for display only."""
    literals = {name: _sql_literal(value) for name, value in params.items()}
    return {section: with_values(sql, literals) for section, sql in rule.sections.items()}


def _sql_literal(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f"'{value.replace(chr(39), chr(39) * 2)}'" if isinstance(value, str) else repr(value)


def judged_steps(rule: Rule, target: Target, judgement: Judgement) -> list[Step]:
    """Return the judged steps of the explained episode or window, at most 30 s before and after the explained interval."""
    row, span = target.verdict_row, target.judged_span_ns
    if span is None:
        return []
    start, end = target.verdict["t_start_ns"], target.verdict["t_end_ns"]
    start, end = max(start, span[0] - SERIES_PADDING_NS), min(end, span[1] + SERIES_PADDING_NS)
    same = {"ego_id": row["ego_id"], "profile": row["profile"]}
    if rule.kind != "invariant":
        same["ref_id"] = row["ref_id"]
    if rule.combine == "each":
        same["object_id"] = row["object_id"]
    return [
        Step(*(step[name] for name in Step._fields))
        for step in judgement.steps
        if start <= step["t_ns"] <= end and all(step[key] == value for key, value in same.items())
    ]


def required_value_parts(
    rule: Rule, target: Target, sandbox: Sandbox, params: Mapping[str, object], t_ns: int | None
) -> list[RequiredValuePart]:
    """Return the summands of the requirement at one time; [] if the rule defines none, or their sum is not the requirement."""
    row, parts = target.verdict_row, read_parts(rule)
    if parts is None or row["required"] is None or t_ns is None:
        return []
    keys = {"ego_id": row["ego_id"], "t_ns": t_ns, "object_id": row["object_id"], "profile": row["profile"]}
    keys = {name: keys[name] for name in parts.key_columns if keys.get(name) is not None}
    bound = {name: params[name] for name in parts.parameters} | {f"_{name}": value for name, value in keys.items()}
    where = " AND ".join(f"{name} = $_{name}" for name in keys)
    for values in sandbox.query(f"SELECT * FROM ({parts.sql}) WHERE {where} ORDER BY ALL", bound):
        summands = [
            RequiredValuePart(name, words, values[name])
            for name, words in parts.parts.items()
            if values[name] is not None
        ]
        if summands and math.isclose(sum(part.value for part in summands), row["required"], rel_tol=1e-6, abs_tol=1e-6):
            return summands
    return []


def rows_read_by_rule(
    rule: Rule, target: Target, sandbox: Sandbox, t_ns: int | None, *, missing_signal: str | None, condition: str | None
) -> list[TableRows]:
    """Return the rows of each table that the rule reads, for ego and object, at one time or in the whole drive.

    `missing_signal`: a signal whose absence prevented the rule from running; then return only the rows about this signal.
    `condition`: an unknown condition of the rule; then also return the ego's position and conditions.
    """
    if missing_signal is not None:
        sql = "SELECT signal, available, reason FROM capability WHERE ego_id = ? AND signal = ?"
        signals = sandbox.query(sql, [target.verdict_row["ego_id"], missing_signal])
        return [TableRows("capability", [{**row, "reason": reason_text.sentence(row["reason"])} for row in signals], 0)]
    rows_by_table = []
    for table in dict.fromkeys((*(CONDITION_TABLES if condition else ()), *rule.reads)):
        columns = list(declarations.column_comments().get(table, {}))
        if "drive_id" in columns or table == "profile":
            rows_by_table.append(_rows_of_table(target, sandbox, table, columns, t_ns))
    return rows_by_table


def _rows_of_table(target: Target, sandbox: Sandbox, table: str, columns: list[str], t_ns: int | None) -> TableRows:
    row = target.verdict_row
    terms: dict[str, list[Any]] = {}
    if "ego_id" in columns:
        terms["ego_id = ?"] = [row["ego_id"]]
    if "profile" in columns and row["profile"] is not None:
        terms["profile IS NOT DISTINCT FROM ?"] = [row["profile"]]
    object_columns = [column for column in _OBJECT_COLUMNS if column in columns and row["object_id"] is not None]
    if object_columns:
        terms[f"({' OR '.join(f'{column} = ?' for column in object_columns)})"] = [row["object_id"]] * len(
            object_columns
        )
    at_time = {} if t_ns is None else _where_terms_of_time(columns, t_ns)
    shown_rows = _select_rows(sandbox, table, columns, terms | at_time, row)
    if not shown_rows.rows and at_time and object_columns and table in TABLES_WITH_ROW_PER_TRACK_STEP:
        track = sandbox.query(f"SELECT t_ns FROM {table}{_where_clause(terms)} ORDER BY t_ns", _values_of_terms(terms))
        times = [state["t_ns"] for state in track]
        nearest = max((t for t in times if t < t_ns), default=min(times, default=None)) if t_ns is not None else None
        if nearest is not None:
            shown_rows = _select_rows(sandbox, table, columns, terms | _where_terms_of_time(columns, nearest), row)
            return shown_rows._replace(at_ns=nearest)
    return shown_rows


def _select_rows(
    sandbox: Sandbox, table: str, columns: list[str], terms: Mapping[str, list[Any]], verdict: Mapping[str, Any]
) -> TableRows:
    """Return the rows of a table that fulfil these terms; table and columns are from our schemas, never from a user."""
    where, values = _where_clause(terms), _values_of_terms(terms)
    # the rows of the ego and the object come first
    parties = [verdict["ego_id"], verdict["object_id"] or ""] if "actor_id" in columns else []
    first = "actor_id NOT IN (?, ?), COLUMNS(*)" if parties else "ALL"
    rows = sandbox.query(
        f"SELECT * FROM {table}{where} ORDER BY {first} LIMIT {MAX_SHOWN_ROWS_PER_TABLE}", [*values, *parties]
    )
    n = sandbox.query(f"SELECT count(*) AS n FROM {table}{where}", values)[0]["n"]
    # leave out the keys, which are the same in all rows
    plain = [{column: row[column] for column in row if column not in {"drive_id", "ego_id"}} for row in rows]
    return TableRows(table, plain, max(0, n - len(rows)))


def _where_clause(terms: Mapping[str, list[Any]]) -> str:
    return f" WHERE {' AND '.join(terms)}" if terms else ""


def _values_of_terms(terms: Mapping[str, list[Any]]) -> list[Any]:
    return [value for some in terms.values() for value in some]


def _where_terms_of_time(columns: list[str], t_ns: int) -> dict[str, list[int]]:
    """Return the SQL term that selects the rows of one time, with its values."""
    for start, end in _SPAN_COLUMNS:
        if start in columns and end in columns:
            return {f"{start} <= ? AND coalesce({end}, {start}) >= ?": [t_ns, t_ns]}
    return {"t0_ns <= ?": [t_ns]} if "t0_ns" in columns else {}
