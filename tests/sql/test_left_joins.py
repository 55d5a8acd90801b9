"""Outer joins are by keys alone, whatever the planner makes of them on the tables of a test.

DuckDB runs a LEFT JOIN as a nested loop, in spite of its keys, if its condition has a part that is no comparison of both sides: one
about the left side only (`ON e.in_junction AND ...`), or a call that takes both. On small or empty tables the plan may look harmless.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint import catalogue
from drivelint.sql import syntax
from drivelint.sql.derivations import derivations
from tests.sql import selects

if TYPE_CHECKING:
    from collections.abc import Iterator


def nodes(tree: Any) -> Iterator[dict[str, Any]]:
    if isinstance(tree, dict):
        yield tree
    for child in tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ():
        yield from nodes(child)


def parts(condition: Any) -> list[Any]:
    if condition and condition["type"] == "CONJUNCTION_AND":
        return [part for child in condition["children"] for part in parts(child)]
    return [condition] if condition else []


def names(tree: Any) -> set[str]:
    """Return the tables of qualified columns; '' for a column without one."""
    columns = (node["column_names"] for node in nodes(tree) if node.get("class") == "COLUMN_REF")
    return {column[0].lower() if len(column) > 1 else "" for column in columns}


def doubtful(sql: str) -> list[str]:
    """Return the parts of the conditions of outer joins that are no comparison and not about the right side alone."""
    found = []
    for join in nodes(syntax.parse_select(sql, "a query")):
        if join.get("type") != "JOIN" or join["join_type"] not in {"LEFT", "RIGHT", "OUTER"}:
            continue
        right = {(node.get("alias") or node.get("table_name", "")).lower() for node in nodes(join["right"])}
        for part in parts(join["condition"]):
            tables = names(part)
            if "" in tables or not tables or tables <= right:
                continue
            if not part["type"].startswith("COMPARE") or not tables & right:
                found.append(f"{part['type']} of {', '.join(sorted(tables))}")
    return found


def test_outer_joins_compare_both_sides() -> None:
    queries = {
        **{name: each.sql for name, each in derivations().items()},
        **{
            f"{rule_id}@{section}": sql
            for rule_id, rule in catalogue.load_rules(()).items()
            for section, sql in rule.sections.items()
        },
        **selects.fixed(),
    }
    assert {name: found for name, sql in queries.items() if (found := doubtful(sql))} == {}
    assert len(queries) > 300


@pytest.mark.slow
def test_those_of_the_statements_of_rules_too() -> None:
    statements = selects.of_rules()
    assert {name: found for name, sql in statements.items() if (found := doubtful(sql))} == {}
    assert len(statements) > 100


@pytest.mark.parametrize(
    ("on", "n"),
    [
        ("a.x = b.x AND a.t <= b.t", 0),
        ("a.x = b.x AND b.is_open", 0),
        ("a.x = b.x AND a.is_open", 1),
        ("a.x = b.x AND a.hop = 0", 1),
        ("a.x = b.x AND blocks(a.x, b.y)", 1),
        ("a.x = b.x AND (a.y IS NULL OR a.y = b.y)", 1),
    ],
)
def test_what_is_doubtful(on: str, n: int) -> None:
    assert len(doubtful(f"SELECT * FROM a LEFT JOIN b ON {on}")) == n
