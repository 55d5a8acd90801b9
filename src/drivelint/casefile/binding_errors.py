"""Finds all columns that a rule's SQL names and its tables lack, although DuckDB reports one error of a statement at a time.

Each section is bound alone. If DuckDB does not find a column, the column is reported and replaced by the most similar one, or by NULL, and
the section is bound again.
"""

from __future__ import annotations

import json
import re
from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import duckdb

from drivelint.catalogue.rule_file import Section, readable_sections
from drivelint.phrases import hint, nearest_word
from drivelint.sql import store
from drivelint.sql.syntax import with_values

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from drivelint.catalogue import Rule

_MAX_ERRORS: Final = 50
_EXPLAIN: Final = "EXPLAIN "
_NAME: Final = re.compile(rb'(?:"[^"]*"|\w+)(?:\s*\.\s*(?:"[^"]*"|\w+))*')
_COLUMN_NOT_FOUND: Final = re.compile(
    r'Referenced column "(.+?)" not found|[\w ]+ "(.+?)" does not have a column named "(.+?)"', re.DOTALL
)
_REFERENCE_STEP: Final = """CREATE OR REPLACE TEMP TABLE reference_step (ref_id INTEGER, ref_no INTEGER, drive_id VARCHAR, ego_id VARCHAR,
    object_id VARCHAR, t_ns BIGINT, seg INTEGER)"""


class _BindingError(NamedTuple):
    """An error of DuckDB: its message, and its byte offset in the SQL (None if not known).

    `column`: the column that is not found. `replacement`: the SQL to put in place of the unknown name; None for another error.
    """

    message: str
    offset: int | None
    column: str | None = None
    replacement: str | None = None


def unknown_columns(file: Path) -> list[str]:
    """Return a line `file:line: message` per column of the rule's SQL that DuckDB does not find, and per section with another error.

    The other error of a section is reported only if it stands first, since a later one may follow from the unknown columns. Errors that
    reading the rule reports (unknown tables and functions, wrong syntax) are not reported.
    """
    sections, defaults = readable_sections(file)
    problems: list[str] = []
    lost_columns: set[str] = set()
    con = _binding_database()
    con.execute(_REFERENCE_STEP)
    try:
        for name in sorted(sections, key=lambda section: section != "reference"):
            sql, section_problems = _bind(con, sections[name], defaults, lost_columns)
            problems += [f"{file}:{line}: {message}" for line, message in section_problems]
            if name == "reference" and sql is not None:
                _create_reference_table(con, sql)
    finally:
        con.execute("DROP TABLE IF EXISTS temp.reference")
    return problems


def is_valid_sql(rule: Rule) -> bool:
    """Return whether DuckDB can bind all SQL of a rule."""
    defaults = {name: param.default for name, param in rule.params.items()}
    con = _binding_database()
    con.execute(_REFERENCE_STEP)
    try:
        for name in sorted(rule.sections, key=lambda section: section != "reference"):
            names = con.extract_statements(rule.sections[name])[0].named_parameters
            sql = with_values(rule.sections[name], {name: _literal(defaults.get(name)) for name in names})
            con.execute(_EXPLAIN + sql)
            if name == "reference":
                _create_reference_table(con, sql)
    except (duckdb.ProgrammingError, duckdb.NotSupportedError):
        return False
    finally:
        con.execute("DROP TABLE IF EXISTS temp.reference")
    return True


def _create_reference_table(con: duckdb.DuckDBPyConnection, sql: str) -> None:
    """Create the empty table `reference` with the columns of @reference, whose SQL is not run."""
    columns = con.execute(f"DESCRIBE SELECT 0 AS ref_id, * FROM ({sql})").fetchall()
    listed = ", ".join(
        '"{}" {}'.format(name.replace('"', '""'), kind.replace('"NULL"', "INTEGER")) for name, kind, *_ in columns
    )
    con.execute(f"CREATE OR REPLACE TEMP TABLE reference ({listed})")


@cache
def _binding_database() -> duckdb.DuckDBPyConnection:
    """Return the process's database for binding SQL, which may be that of a refused rule: it is locked, and its tables are empty."""
    con = store.connect(threads=1)
    con.execute("SET errors_as_json=true")
    con.execute("PRAGMA disable_optimizer")  # it would compute constant expressions
    store.lock_down(con)
    return con


def _bind(
    con: duckdb.DuckDBPyConnection, section: Section, defaults: Mapping[str, object], lost_columns: set[str]
) -> tuple[str | None, list[tuple[int, str]]]:
    """Return a section's SQL without parameters and unknown names (None if it cannot be bound), and its problems: line and message.

    Parameters are replaced by their defaults, and unknown names by the nearest name; NULL, if a column has none near.
    `lost_columns`: the columns replaced by NULL so far, to which columns are added. They are reported only once.
    """
    problems: list[tuple[int, str]] = []
    try:
        statements = con.extract_statements(section.sql)
    except duckdb.Error:
        return None, problems  # reading the rule reports wrong syntax
    if [statement.type for statement in statements] != [duckdb.StatementType.SELECT]:
        return None, problems  # EXPLAIN would execute the second of two statements; reading the rule reports them
    names = statements[0].named_parameters
    sql = with_values(section.sql.rstrip().rstrip(";"), {name: _literal(defaults.get(name)) for name in names})
    is_changed = False
    for _ in range(_MAX_ERRORS):
        try:
            con.execute(_EXPLAIN + sql)
        except duckdb.Error as error:
            problem = _read_error(error)
        else:
            return sql, problems
        content = sql.encode()
        if (problem.column and problem.column not in lost_columns) or not (problem.replacement or is_changed):
            line = section.sql_line + (content[: problem.offset].count(b"\n") if problem.offset is not None else 0)
            problems.append((line, problem.message))
        span = _NAME.match(content, problem.offset) if problem.offset is not None else None
        if span is None or problem.replacement is None:
            break
        if problem.column and problem.replacement == "NULL":
            lost_columns.add(problem.column)
        sql = (content[: span.start()] + problem.replacement.encode() + content[span.end() :]).decode()
        is_changed = True
    return None, problems


def _read_error(error: duckdb.Error) -> _BindingError:
    kind, _, text = str(error).partition(": ")
    try:
        details: dict[str, Any] = json.loads(text)
    except json.JSONDecodeError:
        return _BindingError(" ".join(str(error).split()), None)
    message = str(details["exception_message"])
    offset = int(details["position"]) - len(_EXPLAIN) if "position" in details else None
    listed = re.findall(r'"([^"]+)"', message.partition("andidate bindings:")[2])
    listed = listed or [name for name in str(details.get("candidates", "")).split(",") if name]
    column = _COLUMN_NOT_FOUND.match(message)
    if column is None:  # an unknown table or function is reported by reading the rule
        candidate = listed[0] if kind == "Catalog Error" and listed else None
        return _BindingError(" ".join(f"{kind}: {message}".split()), offset, None, candidate)
    table, name = column[2], column[1] or column[3]
    where = f"in {table}" if table else "here"
    near = nearest_word(name, listed)
    names = f"; {hint(name, listed)}" if near else f"; the nearest: {', '.join(listed)}" if listed else ""
    replacement = (f"{table}.{near}" if table else near) if near else "NULL"
    return _BindingError(f"there is no column {name!r} {where}{names}", offset, name, replacement)


def _literal(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return "'" + value.replace("'", "''") + "'"
    return "NULL" if value is None else f"({value!r})::DOUBLE"
