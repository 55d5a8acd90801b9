"""Mechanical checks of a rule's SQL: one SELECT, known tables only, bound parameters, a named set of columns."""

from __future__ import annotations

import json
import re
from functools import cache
from typing import Any, NamedTuple

import duckdb

from drivelint import store
from drivelint.errors import RuleError
from drivelint.resources import folder

GIVEN = frozenset({"reference", "reference_step"})
"""Tables that the engine makes for a rule: its reference points, and the steps at which each is judged."""

_TABLE_FUNCTIONS = frozenset({"range", "generate_series", "unnest"})
_UNSTABLE = frozenset(
    {
        *("random", "setseed", "uuid", "uuidv4", "uuidv7", "gen_random_uuid", "nextval", "currval"),
        *("now", "today", "current_date", "current_time", "current_timestamp", "current_localtime"),
        *("current_localtimestamp", "get_current_timestamp", "transaction_timestamp"),
        *("getenv", "getvariable", "current_setting"),
    }
)
_MACRO = re.compile(r"\bMACRO\s+(\w+)", re.IGNORECASE)


class Query(NamedTuple):
    """What one SELECT is made of. `columns` is None where a star hides them."""

    tables: frozenset[str]
    parameters: frozenset[str]
    columns: tuple[str, ...] | None


@cache
def _parser() -> duckdb.DuckDBPyConnection:
    return duckdb.connect()


def inspect(sql: str, where: str) -> Query:
    """Take one section's SQL apart.

    Errors: `RuleError` when it is not exactly one SELECT, reads anything but documented tables, names a CTE like a
    table of ours
    or like the engine's own (`_...`), or calls what is not the same every time.
    """
    con = _parser()
    try:
        statements = con.extract_statements(sql)
    except duckdb.Error as error:
        raise RuleError(f"{where}: {str(error).splitlines()[0]}") from error
    if len(statements) != 1 or statements[0].type != duckdb.StatementType.SELECT:
        raise RuleError(f"{where}: a section is exactly one SELECT, found {len(statements)} statement(s)")
    row = con.execute("SELECT json_serialize_sql(?)", [sql]).fetchone()
    tree: dict[str, Any] = json.loads(row[0]) if row else {"error": True}
    if tree.get("error") or len(tree["statements"]) != 1:
        raise RuleError(
            f"{where}: only a plain SELECT can be checked: {tree.get('error_message', 'not one statement')}"
        )
    found = _Found()
    found.walk(tree["statements"][0]["node"])
    _allow(found, where)
    tables = frozenset(found.tables - found.ctes)
    return Query(tables, frozenset(statements[0].named_parameters), _columns(tree["statements"][0]["node"]))


class _Found:
    """Names met in a serialised statement."""

    def __init__(self) -> None:
        self.tables: set[str] = set()
        self.ctes: set[str] = set()
        self.functions: set[str] = set()
        self.table_functions: set[str] = set()

    def walk(self, node: Any) -> None:
        """Collect names, without recursion: a deep expression must not exhaust the stack."""
        todo = [node]
        while todo:
            part = todo.pop()
            if isinstance(part, list):
                todo.extend(part)
            elif isinstance(part, dict):
                self._meet(part)
                todo.extend(part.values())

    def _meet(self, part: dict[str, Any]) -> None:
        kind = part.get("type")
        if kind == "BASE_TABLE":
            prefix = f"{part['schema_name']}." if part.get("schema_name") else ""
            self.tables.add(prefix + part["table_name"].lower())
        elif kind == "TABLE_FUNCTION":
            self.table_functions.add(part["function"]["function_name"].lower())
        elif part.get("class") == "FUNCTION":
            self.functions.add(part["function_name"].lower())
        if isinstance(part.get("cte_map"), dict):
            self.ctes |= {entry["key"].lower() for entry in part["cte_map"]["map"]}


@cache
def macros() -> frozenset[str]:
    """Return the names of the library's macros, in lower case."""
    files = sorted((folder("queries") / "macros").glob("*.sql"))
    return frozenset(name.lower() for file in files for name in _MACRO.findall(file.read_text(encoding="utf-8")))


def _allow(found: _Found, where: str) -> None:
    known = store.schema().keys() | GIVEN
    shadow = sorted(name for name in found.ctes if name in known or name.startswith("_"))
    if shadow:
        raise RuleError(
            f"{where}: rename the CTE {shadow[0]!r}: it hides a table, or begins with _ like the engine's own"
        )
    strange = sorted(found.tables - found.ctes - known)
    if strange:
        raise RuleError(f"{where}: there is no table {strange[0]!r}; rules read the tables of schemas/*.sql only")
    functions = sorted(found.table_functions - _TABLE_FUNCTIONS - macros())
    if functions:
        raise RuleError(f"{where}: table function {functions[0]!r} is not allowed in a rule")
    unstable = sorted(found.functions & _UNSTABLE)
    if unstable:
        raise RuleError(f"{where}: {unstable[0]}() does not give the same answer every time: a rule may not use it")


def _columns(node: dict[str, Any]) -> tuple[str, ...] | None:
    """Names of the columns of a SELECT (of the first branch of a UNION); None where they cannot be read off."""
    while node["type"] == "SET_OPERATION_NODE":
        node = node["left"] if "left" in node else node["children"][0]
    if node["type"] != "SELECT_NODE":
        return None
    names: list[str] = []
    for item in node["select_list"]:
        if item["class"] == "STAR":
            return None
        name = item.get("alias") or (item["column_names"][-1] if item["class"] == "COLUMN_REF" else "")
        if not name:
            return None
        names.append(name.lower())
    return tuple(names)
