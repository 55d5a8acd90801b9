"""Finds, from the syntax tree of a SELECT, which tables it reads, and which tables must have rows for it to return rows."""

from __future__ import annotations

import re
from collections import Counter
from copy import deepcopy
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import duckdb
import msgspec

from drivelint.errors import DriveLintError
from drivelint.sql.store import macro_definitions

if TYPE_CHECKING:
    from collections.abc import Container, Iterator, Mapping

    Node = dict[str, Any]
    Names = frozenset[str]

_NO_NAMES: Final[frozenset[str]] = frozenset()
_CALL: Final = re.compile(r"(\w+)\"?\(")
_MACRO: Final = re.compile(r"^CREATE OR REPLACE MACRO (\w+)\(", re.MULTILINE)
_PARAMETER: Final = re.compile(rb"\$(\w+)")
_NAME_FOR_CTES_WITHOUT_ROWS: Final = "ctes without rows"
_INNER_NODE_TYPES: Final = (dict, list)
"""The types of a tree's inner nodes. Nine tenths of a tree are single values, which `walk` skips."""


@cache
def parser() -> duckdb.DuckDBPyConnection:
    """Return a connection that only parses and prints statements."""
    return duckdb.connect()


def with_values(sql: str, literals: Mapping[str, str]) -> str:
    """Return SQL with literals in place of its parameters.

    A name such as `$x` within a comment or a string is not replaced: a value there could end the comment, and be executed.
    """
    content, parts, end = sql.encode(), [], 0
    for at, kind in duckdb.tokenize(sql):
        match = _PARAMETER.match(content, at) if kind == duckdb.token_type.operator else None
        if match and (name := match[1].decode()) in literals:
            parts += [content[end:at], literals[name].encode()]
            end = match.end()
    return b"".join([*parts, content[end:]]).decode()


def syntax_tree(sql: str) -> Node:
    """Return DuckDB's syntax tree of a SELECT, with the keys `error`, and `error_message` or `statements`."""
    try:
        tree: Node = msgspec.json.decode(parser().execute("SELECT json_serialize_sql(?)", [sql]).fetchall()[0][0])
    except msgspec.DecodeError:  # DuckDB writes infinity, which is not valid JSON
        return {"error": True, "error_message": "a number in it is beyond all numbers, such as 1e999"}
    return tree


def parse_select(sql: str, where: str) -> Node:
    """Return the syntax tree of one SELECT. Errors: `DriveLintError` that begins with `where`."""
    tree = syntax_tree(sql)
    if tree["error"]:
        raise DriveLintError(f"{where}: {tree['error_message']}")
    node: Node = tree["statements"][0]["node"]
    return node


def tables_read(tree: Node) -> Names:
    """Return the tables that a SELECT reads, without the names of CTEs in scope."""
    sources = ((node, ctes) for node, ctes in walk(tree) if node.get("type") == "BASE_TABLE")
    return frozenset(_lower_case(node["table_name"]) for node, ctes in sources if not _is_cte(node, ctes))


def tables_needing_rows(tree: Node) -> Names:
    """Return tables that must have rows for the SELECT to return rows. The answer may be incomplete, which only costs time."""
    return _tables_needed_by_query(tree, {}, lateral=False)


def has_no_rows_without(tree: Node, ctes: Names) -> bool:
    """Return whether a SELECT has no rows if these CTEs have none; false if that is unknown, or several CTEs have one name."""
    n_named = Counter(_lower_case(entry["key"]) for node, _ in walk(tree) for entry in _cte_entries(node))
    if any(n_named[name] != 1 for name in ctes):
        return False
    tree = deepcopy(tree)
    for node, in_sight in walk(tree):
        if node.get("type") == "BASE_TABLE" and _lower_case(node["table_name"]) in ctes and _is_cte(node, in_sight):
            node["table_name"] = _NAME_FOR_CTES_WITHOUT_ROWS  # one table name replaces all of these CTEs
    return _NAME_FOR_CTES_WITHOUT_ROWS in _tables_needed_by_query(tree, {}, lateral=False)


def walk(root: Any) -> Iterator[tuple[Node, Names]]:
    """Yield every node of a tree with the names of the CTEs in its scope; without recursion, since expressions may be deep."""
    todo: list[tuple[Any, Names]] = [(root, _NO_NAMES)]
    while todo:
        part, ctes = todo.pop()
        if isinstance(part, list):
            todo += [(item, ctes) for item in reversed(part) if isinstance(item, _INNER_NODE_TYPES)]
        else:
            yield part, ctes
            # a CTE can read earlier CTEs; only the SELECT that defines the CTE, and its inner parts, can read it
            for entry in _cte_entries(part):
                todo.append((entry["value"], ctes))
                ctes |= {_lower_case(entry["key"])}
            if part.get("type") == "RECURSIVE_CTE_NODE":
                ctes |= {_lower_case(part["cte_name"])}
            todo += [
                (part[key], ctes)
                for key in reversed(part)
                if isinstance(part[key], _INNER_NODE_TYPES) and key != "cte_map"
            ]


def _tables_needed_by_query(node: Node, ctes: Mapping[str, Names], *, lateral: bool) -> Names:
    """Return the tables that must have rows for a query to return rows.

    `ctes`: CTE in scope -> the tables that it needs. `lateral`: the query is right of a join, so it may use columns of the left side.
    """
    inner_ctes = dict(ctes)
    for entry in _cte_entries(node):
        inner_ctes[_lower_case(entry["key"])] = _tables_needed_by_query(
            entry["value"]["query"]["node"], inner_ctes, lateral=lateral
        )
    match node["type"]:
        case "SELECT_NODE" if not _has_row_without_source_rows(node, lateral=lateral):
            return _tables_needed_by_source(node["from_table"], inner_ctes, lateral=lateral)
        case "SET_OPERATION_NODE" if node["setop_type"].startswith("UNION"):
            return _tables_needed_by_query(node["left"], inner_ctes, lateral=lateral) & _tables_needed_by_query(
                node["right"], inner_ctes, lateral=lateral
            )
        case "RECURSIVE_CTE_NODE":
            first = _tables_needed_by_query(node["left"], inner_ctes, lateral=lateral)
            return first & _tables_needed_by_query(
                node["right"], inner_ctes | {_lower_case(node["cte_name"]): first}, lateral=lateral
            )
    return _NO_NAMES


def _tables_needed_by_source(node: Node, ctes: Mapping[str, Names], *, lateral: bool) -> Names:
    match node["type"], node.get("join_type"), node.get("ref_type"):
        case "BASE_TABLE", _, _:
            name = _lower_case(node["table_name"])
            return ctes[name] if _is_cte(node, ctes) else frozenset({name})
        case "SUBQUERY", _, _:
            return _tables_needed_by_query(node["subquery"]["node"], ctes, lateral=lateral)
        case "JOIN", "INNER" | "SEMI", "REGULAR" | "CROSS" | "ASOF":
            return _tables_needed_by_source(node["left"], ctes, lateral=lateral) | _tables_needed_by_source(
                node["right"], ctes, lateral=True
            )
        case "JOIN", "LEFT" | "ANTI", "REGULAR" | "ASOF":
            return _tables_needed_by_source(node["left"], ctes, lateral=lateral)
    return _NO_NAMES


def _has_row_without_source_rows(node: Node, *, lateral: bool) -> bool:
    """Return whether a SELECT may have a row although its source has none, because it aggregates all rows."""
    if node["group_sets"]:
        return not all(node["group_sets"])
    items = node["select_list"]
    if node["aggregate_handling"] == "FORCE_AGGREGATES":
        # GROUP BY ALL makes groups if an item is a column of the source, and not an alias of another item
        aliases = {_lower_case(item["alias"]) for item in items}
        columns = (_lower_case(item["column_names"][-1]) for item in items if item["class"] == "COLUMN_REF")
        return lateral or aliases.issuperset(columns)
    calls = {
        _lower_case(part["function_name"])
        for part, _ in walk([items, node["qualify"], node["modifiers"]])
        if part.get("class") == "FUNCTION"
    }
    return node["having"] is not None or any(
        name in _aggregate_function_names() or name.endswith("_agg") for name in calls
    )


def union_queries(node: Node) -> list[Node]:
    """Return the queries that a UNION or another set operation combines."""
    return [node["left"], node["right"]] if "left" in node else list(node["children"])


def column_name(item: Node) -> str:
    """Return the name of a column of a SELECT, in lower case; '' for a column without a name."""
    return _lower_case(item.get("alias") or (item["column_names"][-1] if item["class"] == "COLUMN_REF" else ""))


def byte_offset_of(part: Any) -> int | None:
    """Return a node's byte offset in the SQL, or that of its first inner node with an offset; None without any offset."""
    todo = [part]
    while todo:
        node = todo.pop(0)
        if isinstance(node, dict):
            place = node.get("query_location")
            if isinstance(place, int) and place < 1 << 62:
                return place
            todo.extend(node.values())
        elif isinstance(node, list):
            todo.extend(node)
    return None


def _is_cte(table: Node, ctes: Container[str]) -> bool:
    return _lower_case(table["table_name"]) in ctes and not table["schema_name"] and not table["catalog_name"]


def _cte_entries(node: Node) -> list[Node]:
    entries: list[Node] = node.get("cte_map", {}).get("map", [])
    return entries


def _lower_case(name: str) -> str:
    """Return a name in lower case, since DuckDB ignores case."""
    return name.lower()


@cache
def _aggregate_function_names() -> Names:
    """Return DuckDB's aggregates, and the macros of DuckDB and drivelint that call an aggregate.

    The aggregates of the spatial extension, whose names all end in `_agg`, are not included.
    """
    rows = parser().execute("SELECT function_name, function_type, macro_definition FROM duckdb_functions()").fetchall()
    names = {name for name, kind, _ in rows if kind == "aggregate"}
    # drivelint's macros are read as text, in a tenth of the time of creating them in a database
    queries = [statement.query for statement in parser().extract_statements(macro_definitions())]
    texts = [(match[1], text) for text in queries if (match := _MACRO.search(text))]
    texts += [(name, text) for name, kind, text in rows if kind == "macro" and text]
    calls = [(name, set(_CALL.findall(text.lower()))) for name, text in texts]
    while more := {name for name, functions in calls if functions & names} - names:
        names |= more
    return frozenset(names)
