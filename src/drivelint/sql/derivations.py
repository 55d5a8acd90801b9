"""The library tables: each `queries/derive/<table>.sql` is one SELECT that fills the table of its name.

The order follows from which tables each SELECT reads.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from graphlib import TopologicalSorter
from typing import TYPE_CHECKING, Final

from drivelint.errors import DriveLintError
from drivelint.memo import Memo
from drivelint.resources import folder
from drivelint.sql.store import column_comments, lifetimes

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

_OCCASION: Final = re.compile(r"^-- occasion: (\w+(?:, \w+)*)$", re.MULTILINE)
_TABLES_FROM_TOML = {"profile"}  # filled from queries/profiles.toml
NEEDED_OF_DRIVES: Final = (
    "clock",
    "step",
    "ego_state",
    "ego_condition",
    "capability",
    "registration",
    "exposure",
    "recorded",
)
"""What the drive table and `inspect` read, without any rule."""
NEEDED_OF_RULES: Final = (*NEEDED_OF_DRIVES, "pair")
"""What the evaluation and the evidence of findings read besides, whatever the rules are."""
ALWAYS_NEEDED: Final = (*NEEDED_OF_RULES, "lost_object")
"""What the evaluation reads of rules that look at others than the ego."""


@dataclass(frozen=True)
class Derivation:
    """One library table: the SELECT that fills it, the library tables it reads, and the tables without which it is empty."""

    table: str
    sql: str
    reads: frozenset[str]
    needs: frozenset[str] = frozenset()
    occasion: str = ""
    """A query without rows where the table has none: the CTEs that `-- occasion: a, b` behind them names have none. '': none is named."""

    @property
    def of_the_map(self) -> bool:
        """Whether the table depends on the map only, and is filled once per map."""
        return lifetimes()[self.table] == "map"


@cache
def derivations() -> dict[str, Derivation]:
    """Return every derivation, in an order in which each can be run after those before it."""
    if missing := sorted(column_comments("derived").keys() - _files().keys() - _TABLES_FROM_TOML):
        raise DriveLintError(
            f"queries/derive: no query for the library table {missing[0]!r} of schemas/derived.sql: reinstall drivelint"
        )
    return {each.table: each for each in _with_sources(_files())}


@cache
def _files() -> dict[str, Path]:
    return {file.stem: file for file in sorted((folder("queries") / "derive").glob("*.sql"))}


@cache
def _derivation(table: str) -> Derivation:
    """Return the derivation of one table. To read the syntax of all takes longer than to judge a short drive."""
    file = _files()[table]
    if table not in column_comments():
        raise DriveLintError(f"{file}: no table {table!r} in schemas/")
    sql = file.read_text(encoding="utf-8")
    reads, needs, occasion = _READS.of(sql, lambda: _reads(sql, str(file)))
    return Derivation(table, sql, reads & _files().keys() - {table}, needs, occasion)


_Reads = tuple[frozenset[str], frozenset[str], str]
_READS: Final = Memo[_Reads]("derivations", _Reads)


def _reads(sql: str, where: str) -> _Reads:
    """Return the tables that a SELECT reads, those that must have rows for it to have any, and `Derivation.occasion`.

    Errors: `DriveLintError` where the CTEs that are its occasion may have no rows and the SELECT still some.
    """
    from drivelint.sql import syntax  # only where a derivation is new

    tree = syntax.parse_select(sql, where)
    occasion = ""
    if mark := _OCCASION.search(sql):
        ctes = mark[1].split(", ")
        if not syntax.has_no_rows_without(tree, frozenset(ctes)):
            raise DriveLintError(f"{where}: without rows in {mark[1]} there may be rows: remove the line -- occasion")
        first = " UNION ALL ".join(f"SELECT 1 FROM {name}" for name in ctes)
        occasion = f"{sql[: mark.start()].rstrip().removesuffix(',')} {first} LIMIT 1"
    return syntax.tables_read(tree), syntax.tables_needing_rows(tree), occasion


def _with_sources(tables: Iterable[str]) -> list[Derivation]:
    """Return the derivations of those of these tables that are derived, and of all that they read, in order."""
    graph: dict[str, list[str]] = {}
    todo = [table for table in tables if table in _files()]
    while todo:
        table = todo.pop()
        if table not in graph:
            graph[table] = sorted(_derivation(table).reads)
            todo += graph[table]
    return [_derivation(table) for table in TopologicalSorter(dict(sorted(graph.items()))).static_order()]


def derived_tables() -> frozenset[str]:
    """Return the names of the tables that have a derivation."""
    return frozenset(_files())


def with_sources(tables: Iterable[str]) -> frozenset[str]:
    """Return these tables and the library tables from which they are derived."""
    return frozenset[str]().union(*map(_with_its_sources, tables))


@cache
def _with_its_sources(table: str) -> frozenset[str]:
    reads = _derivation(table).reads if table in _files() else ()
    return frozenset({table}).union(*map(_with_its_sources, reads))


def needed_derivations(tables: Iterable[str], also: Iterable[str] = ALWAYS_NEEDED) -> list[Derivation]:
    """Return the derivations behind these tables, in order."""
    return _with_sources([*tables, *also])
