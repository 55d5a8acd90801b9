"""Derive the library tables: each `queries/derive/<table>.sql` is one SELECT that fills the table of its name.

The order follows from which tables each SELECT reads; only what is asked for, and what that reads, is run, and nothing for whose
rows there would have to be some in a table that has none.
"""

from __future__ import annotations

from collections import deque
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from graphlib import TopologicalSorter
from typing import TYPE_CHECKING, Final

import duckdb

from drivelint import sqltree
from drivelint.errors import DriveLintError
from drivelint.resources import folder
from drivelint.store import schema

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

WORKERS: Final = 2
LARGE: Final = 1_000_000
"""States from which on there is one: a statement then uses all cores, and two would need twice the memory."""
# a table whose rows were deleted may be missing here, which only costs time
_EMPTY = "SELECT table_name FROM duckdb_tables() WHERE database_name = current_database() AND estimated_size = 0"
_GIVEN = {"profile"}  # filled from queries/profiles.toml
# What the engine and the drive table read themselves, whatever the rules are.
ALWAYS = (
    "clock",
    "step",
    "ego_state",
    "pair",
    "lost_object",
    "ego_condition",
    "capability",
    "registration",
    "exposure",
)


@dataclass(frozen=True)
class Derivation:
    """One library table, the SELECT that fills it, the other library tables that it reads, and those without whose rows it has none."""

    table: str
    sql: str
    reads: frozenset[str]
    needs: frozenset[str] = frozenset()

    @property
    def of_the_map(self) -> bool:
        """Whether the table is a property of the map alone, filled once per environment and not once per batch."""
        return "drive_id" not in schema()[self.table]


@cache
def derivations() -> Mapping[str, Derivation]:
    """Return every derivation, in an order in which each can be run after those before it."""
    found: dict[str, Derivation] = {}
    files = sorted((folder("queries") / "derive").glob("*.sql"))
    names = {file.stem for file in files}
    for file in files:
        if file.stem not in schema():
            raise DriveLintError(f"{file}: no table {file.stem!r} in schemas/")
        sql = file.read_text(encoding="utf-8")
        tree = sqltree.parsed(sql, str(file))
        found[file.stem] = Derivation(file.stem, sql, sqltree.reads(tree) & names - {file.stem}, sqltree.needs(tree))
    if missing := sorted(schema("derived").keys() - names - _GIVEN):
        raise DriveLintError(
            f"queries/derive: no query for the library table {missing[0]!r} of schemas/derived.sql: reinstall drivelint"
        )
    order = TopologicalSorter({name: sorted(d.reads) for name, d in found.items()}).static_order()
    return {name: found[name] for name in order}


def behind(tables: Iterable[str]) -> set[str]:
    """Return these tables and the library tables from which they are derived."""
    found: set[str] = set()
    todo = [*tables]
    while todo:
        table = todo.pop()
        if table not in found:
            found.add(table)
            todo.extend(derivations()[table].reads if table in derivations() else ())
    return found


def needed(tables: Iterable[str]) -> list[Derivation]:
    """Return the derivations behind these tables, in order."""
    wanted = behind([*tables, *ALWAYS])
    return [d for name, d in derivations().items() if name in wanted]


def derive(
    con: duckdb.DuckDBPyConnection,
    tables: Iterable[str],
    *,
    of_the_map: bool,
    advance: Callable[[str], None] = lambda _table: None,
) -> None:
    """Fill the library tables behind `tables`: those of the map, or those of the drives.

    Two at a time, each on its own connection: most are so small that DuckDB plans and runs them on one core. Not inside a
    transaction, whose rows the other connections do not see.
    Errors: `DriveLintError` naming the table, if its SELECT fails.
    """
    todo = {step.table: step for step in needed(tables) if step.of_the_map is of_the_map}
    graph = TopologicalSorter({table: sorted(step.reads & todo.keys()) for table, step in todo.items()})
    graph.prepare()
    (n_states,) = con.execute("SELECT count(*) FROM actor_state").fetchall()[0]
    empty = {table for (table,) in con.execute(_EMPTY).fetchall()} - todo.keys()
    workers = WORKERS if n_states < LARGE else 1
    with ThreadPoolExecutor(workers) as pool, ExitStack() as stack:
        free = [stack.enter_context(con.cursor()) for _ in range(workers)]
        busy: dict[Future[int], tuple[str, duckdb.DuckDBPyConnection]] = {}
        ready: deque[str] = deque()
        stack.callback(_stop, tuple(free), busy)  # should one fail, or the user not want to wait
        while graph.is_active():
            ready.extend(sorted(graph.get_ready()))
            filled: list[str] = []
            while ready and free:
                table = ready.popleft()
                if todo[table].needs & empty:
                    empty.add(table)
                    filled.append(table)
                else:
                    cursor = free.pop()
                    busy[pool.submit(_fill, cursor, todo[table])] = table, cursor
            for done in wait(busy, return_when=FIRST_COMPLETED).done if not filled else ():
                table, cursor = busy.pop(done)
                if not done.result():
                    empty.add(table)
                free.append(cursor)
                filled.append(table)
            for table in filled:
                graph.done(table)
                advance(table)


def _stop(cursors: Iterable[duckdb.DuckDBPyConnection], running: Iterable[Future[int]]) -> None:
    """Interrupt until nothing runs: once is not enough, as an interrupt before a statement has begun is lost."""
    left = set(running)
    while left:
        for cursor in cursors:
            cursor.interrupt()
        left = wait(left, timeout=0.05).not_done


def _fill(con: duckdb.DuckDBPyConnection, step: Derivation) -> int:
    """Return how many rows the table got."""
    try:
        return int(con.execute(f"INSERT INTO {step.table} BY NAME {step.sql}").fetchall()[0][0])
    except duckdb.OutOfMemoryException:
        raise  # no fault of the query: there may be more
    except duckdb.Error as error:
        raise DriveLintError(f"queries/derive/{step.table}.sql: {str(error).splitlines()[0]}") from error
