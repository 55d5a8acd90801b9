"""A connection that runs every statement under EXPLAIN ANALYZE, too, and keeps the joins that compare all rows with all."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple, Self

if TYPE_CHECKING:
    from collections.abc import Iterator

    import duckdb

LOOPS = ("BLOCKWISE_NL_JOIN", "NESTED_LOOP_JOIN", "CROSS_PRODUCT", "POSITIONAL_JOIN")
MOST_ROWS = 1_000
"""Rows of one side of a nested loop."""
A_FEW = 30
"""Rows of a list of constants, or drives of a batch: a cross product with them repeats the other side's rows."""
EXPLAINED = ("SELECT", "INSERT", "CREATE", "UPDATE")


class Loop(NamedTuple):
    """A join without keys, and the rows of both sides."""

    statement: str
    name: str
    left: int
    right: int


class Explained:
    """A connection that runs every statement under EXPLAIN ANALYZE, too, and keeps the joins without keys that it sees."""

    def __init__(self, con: duckdb.DuckDBPyConnection, loops: list[Loop], looked_at: list[str]) -> None:
        self._con = con
        self._loops = loops
        self._looked_at = looked_at

    def execute(self, query: Any, parameters: Any = None) -> duckdb.DuckDBPyConnection:
        statements = self._con.extract_statements(query) if isinstance(query, str) else [query]
        if len(statements) == 1 and statements[0].type.name in EXPLAINED:
            text = statements[0].query
            self._con.execute("BEGIN")
            plan = self._con.execute(f"EXPLAIN (ANALYZE, FORMAT json) {text}", parameters).fetchall()[0][1]
            self._con.execute("ROLLBACK")
            self._looked_at.append(text)
            self._loops += loops(json.loads(plan), text)
        return self._con.execute(query, parameters)

    def cursor(self) -> Explained:
        return Explained(self._con.cursor(), self._loops, self._looked_at)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._con.close()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._con, name)


def loops(plan: dict[str, Any], statement: str = "") -> Iterator[Loop]:
    """Give the joins of an analyzed plan that compare the rows of both sides one by one, and are no repetition by constants."""
    children = plan.get("children", [])
    name = plan.get("operator_name", "").strip()
    if name in LOOPS:
        left, right = (int(child.get("operator_cardinality", 0)) for child in children[:2])
        repeats = name == "CROSS_PRODUCT" and min(left, right) <= A_FEW
        # the planner takes a nested loop for a side of a handful of rows, too, although it has keys
        if (
            name == "BLOCKWISE_NL_JOIN"
            or min(left, right) > A_FEW
            or (left * right > A_FEW * MOST_ROWS and not repeats)
        ):
            yield Loop(" ".join(statement.split()), name, left, right)
    for child in children:
        yield from loops(child, statement)
