"""The library tables: each `queries/derive/<table>.sql` is one SELECT that fills the table of its name.

The order follows from which tables each SELECT reads.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from graphlib import TopologicalSorter
from typing import TYPE_CHECKING

from drivelint.errors import DriveLintError
from drivelint.resources import folder
from drivelint.sql import syntax
from drivelint.sql.store import column_comments, lifetimes

if TYPE_CHECKING:
    from collections.abc import Iterable

_GIVEN = {"profile"}  # filled from queries/profiles.toml
# What the engine and the drive table read themselves, whatever the rules are.
ALWAYS_NEEDED = (
    *("clock", "step", "ego_state", "pair", "lost_object"),
    *("ego_condition", "capability", "registration", "exposure"),
)


@dataclass(frozen=True)
class Derivation:
    """One library table: the SELECT that fills it, the library tables it reads, and the tables without which it is empty."""

    table: str
    sql: str
    reads: frozenset[str]
    needs: frozenset[str] = frozenset()

    @property
    def of_the_map(self) -> bool:
        """Whether the table depends on the map only, and is filled once per map."""
        return lifetimes()[self.table] == "map"


@cache
def derivations() -> dict[str, Derivation]:
    """Return every derivation, in an order in which each can be run after those before it."""
    found: dict[str, Derivation] = {}
    files = sorted((folder("queries") / "derive").glob("*.sql"))
    names = {file.stem for file in files}
    for file in files:
        if file.stem not in column_comments():
            raise DriveLintError(f"{file}: no table {file.stem!r} in schemas/")
        sql = file.read_text(encoding="utf-8")
        tree = syntax.parse_select(sql, str(file))
        found[file.stem] = Derivation(
            file.stem, sql, syntax.tables_read(tree) & names - {file.stem}, syntax.tables_needing_rows(tree)
        )
    if missing := sorted(column_comments("derived").keys() - names - _GIVEN):
        raise DriveLintError(
            f"queries/derive: no query for the library table {missing[0]!r} of schemas/derived.sql: reinstall drivelint"
        )
    order = TopologicalSorter({name: sorted(d.reads) for name, d in found.items()}).static_order()
    return {name: found[name] for name in order}


def with_sources(tables: Iterable[str]) -> set[str]:
    """Return these tables and the library tables from which they are derived."""
    found = set(tables)
    for name, derivation in reversed(derivations().items()):
        if name in found:
            found |= derivation.reads
    return found


def needed(tables: Iterable[str], also: Iterable[str] = ALWAYS_NEEDED) -> list[Derivation]:
    """Return the derivations behind these tables, in order."""
    wanted = with_sources([*tables, *also])
    return [d for name, d in derivations().items() if name in wanted]
