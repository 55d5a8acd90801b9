"""The order in which the library tables are filled: the tables that a SELECT reads are filled before."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from graphlib import TopologicalSorter
from typing import TYPE_CHECKING, Final

from drivelint.errors import DriveLintError
from drivelint.memo import Memo
from drivelint.sql.declarations import lifetimes
from drivelint.sql.library import library_tables

if TYPE_CHECKING:
    from collections.abc import Iterable
_OCCASION: Final = re.compile(r"^-- occasion: (\w+(?:, \w+)*)$", re.MULTILINE)
TABLES_NEEDED_FOR_DRIVES: Final = (
    "clock",
    "step",
    "ego_state",
    "ego_condition",
    "capability",
    "registration",
    "exposure",
    "recorded",
)
"""The derived tables that the table `drive` and the command `inspect` read, independently of rules."""
TABLES_NEEDED_FOR_RULES: Final = (*TABLES_NEEDED_FOR_DRIVES, "pair")
"""The derived tables that the evaluation and the evidence of findings always read, for any rules."""
TABLES_NEEDED_FOR_RULES_ABOUT_OTHERS: Final = (*TABLES_NEEDED_FOR_RULES, "lost_object")
"""The derived tables that the evaluation reads for rules about other actors than the ego."""


@dataclass(frozen=True)
class Derivation:
    """One library table. `sql`: the SELECT that fills it. `reads`: the library tables it reads.

    `needs`: tables that must have rows, else the library table is empty.
    """

    table: str
    sql: str
    reads: frozenset[str]
    needs: frozenset[str] = frozenset()
    occasion: str = ""
    """A query over the CTEs that a line `-- occasion: a, b` names, or ''. If the query has no rows, the table has none."""

    @property
    def is_of_map_only(self) -> bool:
        """Whether the table depends only on the map, and is filled once per map."""
        return lifetimes()[self.table] == "map"


@cache
def derivations() -> dict[str, Derivation]:
    """Return table -> derivation, ordered so that each derivation follows the tables that it reads."""
    return {derivation.table: derivation for derivation in _derivations_with_sources(library_tables())}


@cache
def _derivation(table: str) -> Derivation:
    """Return the derivation of one table. Only this file is parsed: parsing all files takes longer than judging a short drive."""
    file = library_tables()[table]
    sql = file.select
    reads, needs, occasion = _READS_BY_SQL.find_or_compute(
        sql, lambda: _tables_read_tables_needed_and_occasion(sql, str(file.path))
    )
    return Derivation(table, sql, reads & library_tables().keys() - {table}, needs, occasion)


_Reads = tuple[frozenset[str], frozenset[str], str]
_READS_BY_SQL: Final = Memo[_Reads]("derivations", _Reads)


def _tables_read_tables_needed_and_occasion(sql: str, where: str) -> _Reads:
    """Return the tables that a SELECT reads, the tables that must have rows for it to return rows, and `Derivation.occasion`.

    Errors: `DriveLintError` if the SELECT may return rows although the CTEs of its occasion have none.
    """
    from drivelint.sql import syntax  # imported here, since it is needed only for a derivation that is not cached

    tree = syntax.parse_select(sql, where)
    occasion = ""
    if mark := _OCCASION.search(sql):
        ctes = mark[1].split(", ")
        if not syntax.has_no_rows_without(tree, frozenset(ctes)):
            raise DriveLintError(f"{where}: without rows in {mark[1]} there may be rows: remove the line -- occasion")
        first = " UNION ALL ".join(f"SELECT 1 FROM {name}" for name in ctes)
        occasion = f"{sql[: mark.start()].rstrip().removesuffix(',')} {first} LIMIT 1"
    return syntax.tables_read(tree), syntax.tables_needing_rows(tree), occasion


def _derivations_with_sources(tables: Iterable[str]) -> list[Derivation]:
    """Return the derivations of these tables and of all tables that they read, in order; other tables are skipped."""
    graph: dict[str, list[str]] = {}
    todo = [table for table in tables if table in library_tables()]
    while todo:
        table = todo.pop()
        if table not in graph:
            graph[table] = sorted(_derivation(table).reads)
            todo += graph[table]
    return [_derivation(table) for table in TopologicalSorter(dict(sorted(graph.items()))).static_order()]


def derived_tables() -> frozenset[str]:
    """Return the names of the tables that have a derivation."""
    return frozenset(library_tables())


def tables_with_sources(tables: Iterable[str]) -> frozenset[str]:
    """Return these tables and all library tables that they read, directly or indirectly."""
    return frozenset[str]().union(*map(_table_with_sources, tables))


@cache
def _table_with_sources(table: str) -> frozenset[str]:
    reads = _derivation(table).reads if table in library_tables() else ()
    return frozenset({table}).union(*map(_table_with_sources, reads))


def needed_derivations(
    tables: Iterable[str], further_tables: Iterable[str] = TABLES_NEEDED_FOR_RULES_ABOUT_OTHERS
) -> list[Derivation]:
    """Return the derivations that fill these tables and `further_tables`, with all tables that they read, in order."""
    return _derivations_with_sources([*tables, *further_tables])
