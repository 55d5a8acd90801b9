"""Writes the SQL of one finding as a file that any DuckDB can run: with its macros, its tables from Parquet files, and its values."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import duckdb

from drivelint.evaluate.sql_fragments import condition_ctes_sql
from drivelint.phrases import terminal_safe_line
from drivelint.sql import syntax
from drivelint.sql.statements import statement_texts
from drivelint.sql.store import macro_definitions

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from drivelint.catalogue import Rule

Row = dict[str, Any]

_CALL_PATTERN: Final = re.compile(r"\b([a-z_]\w*)\s*\(", re.IGNORECASE)
_MACRO_PATTERN: Final = re.compile(r"\bCREATE OR REPLACE (?:TEMP )?MACRO (\w+)")
_COMMENT_PATTERN: Final = re.compile(r"--.*")
_SPATIAL_CALL_PATTERN: Final = re.compile(r"\bST_\w+\s*\(")
COMPARED_FINDING_COLUMNS: Final = ("observed", "required", "margin")
"""The columns that the SQL of a finding must reproduce."""


def tables_of_condition(rule: Rule) -> list[str]:
    """Return the tables that the condition of a rule reads, sorted."""
    where = f"{rule.path}: @condition"
    return sorted(syntax.tables_read(syntax.parse_select(rule.sections["condition"], where)))


def select_of_finding(rule: Rule, params: Mapping[str, object], finding: Row, ref_id: int | None) -> str:
    """Return the SELECT that computes a finding's numbers at its worst step. `ref_id`: the condition's number of the reference point."""
    with_values = syntax.with_values(
        condition_ctes_sql(rule), {name: param_literal(value) for name, value in params.items()}
    )
    at = [f"t_ns = {finding['t_worst_ns']}"]
    if rule.per_object and finding["object_id"] is not None:
        at.append(f"object_id = {text_literal(finding['object_id'])}")
    if rule.per_profile:
        at.append(f"profile = {text_literal(finding['profile'])}")
    if rule.has_column("ref_id"):
        at.append(f"ref_id = {ref_id}")
    return (
        f"WITH {with_values}\n"
        "SELECT t_ns, object_id, profile, finite(observed) AS observed, finite(required) AS required,\n"
        f"    margin_of({text_literal(rule.sense)}, observed, required, holds) AS margin, holds\n"
        f"FROM _state\nWHERE {' AND '.join(at)}"
    )


def param_literal(value: object) -> str:
    """Return a parameter as an SQL literal of the same type. A plain 0.5 would be a DECIMAL, which divides differently."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return text_literal(value)
    text = repr(value)
    if isinstance(value, float) and "e" not in text:
        text += "e0"
    return f"({text})" if text.startswith("-") else text  # two minus signs would begin a comment


def text_literal(text: str) -> str:
    """Return a text as an SQL literal on one line, without invisible characters, which an id may contain."""
    letters = (c if c.isprintable() else f"' || chr({ord(c)}) || '" for c in text.replace("'", "''"))
    return f"'{''.join(letters)}'" if text.isprintable() else f"('{''.join(letters)}')"


def is_split_by_shell_as_by_parser(sql: str) -> bool:
    """Return whether DuckDB's shell ends a statement where its parser does. If not, the shell would run text as an unchecked statement."""
    content = sql.encode()
    kinds = (content[at : at + 1] for at, kind in duckdb.tokenize(sql) if kind == duckdb.token_type.string_const)
    return "/*" not in sql and all(first == b"'" for first in kinds)


def called_macro_definitions(sql: str) -> list[str]:
    """Return the macros that a statement calls directly or indirectly, in the order of their definitions."""
    definitions = _macro_definitions_by_name()
    names: set[str] = set()
    todo = [sql]
    while todo:
        callees = {name.lower() for name in _CALL_PATTERN.findall(_COMMENT_PATTERN.sub("", todo.pop()))}
        new = (callees & definitions.keys()) - names
        names |= new
        todo += [definitions[name] for name in new]
    return [text for name, text in definitions.items() if name in names]


@cache
def _macro_definitions_by_name() -> dict[str, str]:
    """Return name -> definition of the macros for rules and for judging."""
    sources = f"{macro_definitions()}\n{statement_texts('statement_macros')['judging']}"
    definitions = {}
    for definition in syntax.parser().extract_statements(sources):
        text = "\n".join(
            line for line in definition.query.strip().splitlines() if line.strip() and not line.startswith("--")
        )
        if match := _MACRO_PATTERN.search(text):
            definitions[match[1].lower()] = text.rstrip().rstrip(";")
    return definitions


def finding_sql_text(rule: Rule, finding: Row, sql: str, tables: Iterable[str]) -> str:
    """Return the text of `finding.sql`. Run in its folder, it prints the finding's numbers."""
    macros = called_macro_definitions(sql)
    spatial = any(_SPATIAL_CALL_PATTERN.search(text) for text in (sql, *macros))
    numbers = ", ".join(f"{name} {_number_literal(finding[name])}" for name in COMPARED_FINDING_COLUMNS)
    lines = [
        f"-- Finding {finding['finding_id']} of the rule {rule.id}: {terminal_safe_line(rule.title)}",
        f"-- {terminal_safe_line(rule.clause)}",
        "-- Run it in this folder with DuckDB 1.4 or later: duckdb < finding.sql",
        f"-- It gives what findings.parquet says of the worst step: {numbers}.",
    ]
    if rule.quantifier == "eventually":
        lines.append("-- The rule asks for one step at which it holds. This is the step that comes nearest to it.")
    lines += ["INSTALL spatial;", "LOAD spatial;"] if spatial else []
    lines += [f"CREATE TEMP VIEW {table} AS FROM read_parquet('{table}.parquet');" for table in tables]
    lines += [f"{text};" for text in macros]
    return "\n".join([*lines, f"{sql};", ""])


def _number_literal(value: float | None) -> str:
    return "NULL" if value is None else repr(value)
