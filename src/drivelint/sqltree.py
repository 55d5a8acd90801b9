"""What the syntax tree of a SELECT tells: the tables that it reads, and those without whose rows it has none itself."""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING, Any

import duckdb

from drivelint.errors import DriveLintError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    Node = dict[str, Any]
    Names = frozenset[str]

_NONE: frozenset[str] = frozenset()


def parsed(sql: str, where: str) -> Node:
    """Return the syntax tree of one SELECT. Errors: `DriveLintError` that begins with `where`."""
    tree = json.loads(_parser().execute("SELECT json_serialize_sql(?)", [sql]).fetchall()[0][0])
    if tree["error"]:
        raise DriveLintError(f"{where}: {tree['error_message']}")
    node: Node = tree["statements"][0]["node"]
    return node


def reads(tree: Node) -> Names:
    """Return the tables that are read. A CTE may have the name of a table: then it is the CTE that is read."""
    nodes = list(_nodes(tree))
    own = {entry["key"] for node in nodes for entry in _ctes(node)}
    return frozenset(node["table_name"] for node in nodes if node.get("type") == "BASE_TABLE") - own


def needs(tree: Node) -> Names:
    """Return tables of which each must have rows, or the SELECT has none. One that is left out only costs time."""
    return _query(tree, {})


def _query(node: Node, ctes: Mapping[str, Names]) -> Names:
    """`ctes`: what each CTE in sight needs."""
    own = dict(ctes)
    for entry in _ctes(node):
        own[entry["key"]] = _query(entry["value"]["query"]["node"], own)
    match node["type"]:
        case "SELECT_NODE" if not _has_a_row_of_none(node):
            return _source(node["from_table"], own)
        case "SET_OPERATION_NODE" if node["setop_type"].startswith("UNION"):
            return _query(node["left"], own) & _query(node["right"], own)
        case "RECURSIVE_CTE_NODE":
            first = _query(node["left"], own)
            return first & _query(node["right"], own | {node["cte_name"]: first})
    return _NONE


def _source(node: Node, ctes: Mapping[str, Names]) -> Names:
    match node["type"], node.get("join_type"), node.get("ref_type"):
        case "BASE_TABLE", _, _:
            return ctes.get(node["table_name"], frozenset({node["table_name"]}))
        case "SUBQUERY", _, _:
            return _query(node["subquery"]["node"], ctes)
        case "JOIN", "INNER" | "SEMI", "REGULAR" | "CROSS" | "ASOF":
            return _source(node["left"], ctes) | _source(node["right"], ctes)
        case "JOIN", "LEFT" | "ANTI", "REGULAR" | "ASOF":
            return _source(node["left"], ctes)
    return _NONE


def _has_a_row_of_none(node: Node) -> bool:
    """Whether a SELECT may have a row although its source has none: it aggregates all rows into one."""
    if node["group_sets"]:
        return not all(node["group_sets"])
    items = node["select_list"]
    if node["aggregate_handling"] == "FORCE_AGGREGATES" and any(item["class"] == "COLUMN_REF" for item in items):
        return False  # GROUP BY ALL: it has a group for each value of that column
    calls = (each["function_name"] for each in _nodes([items, node["having"]]) if each.get("class") == "FUNCTION")
    return not _aggregates().isdisjoint(calls)


def _ctes(node: Node) -> list[Node]:
    found: list[Node] = node.get("cte_map", {}).get("map", [])
    return found


def _nodes(tree: Any) -> Iterator[Node]:
    if isinstance(tree, dict):
        yield tree
    for child in tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ():
        yield from _nodes(child)


@cache
def _aggregates() -> Names:
    """Aggregates that DuckDB brings; a macro that calls one counts as none, so there must be none such among ours."""
    names = "SELECT DISTINCT function_name FROM duckdb_functions() WHERE function_type = 'aggregate'"
    return frozenset(name for (name,) in _parser().execute(names).fetchall())


@cache
def _parser() -> duckdb.DuckDBPyConnection:
    return duckdb.connect()
