"""Fills the library tables that rules need, and the tables that these read. If a required table has no rows, the SELECT is skipped."""

from __future__ import annotations

from collections import deque
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack
from dataclasses import replace
from graphlib import TopologicalSorter
from typing import TYPE_CHECKING, Final

import duckdb

from drivelint.errors import DriveLintError
from drivelint.sql import store
from drivelint.sql.declarations import lifetimes
from drivelint.sql.derivations import TABLES_NEEDED_FOR_RULES_ABOUT_OTHERS, needed_derivations
from drivelint.sql.library import library_tables
from drivelint.sql.statements import statement, statement_texts

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from drivelint.sql.derivations import Derivation

DERIVATION_WORKERS: Final = 2
MOST_STATES_FOR_EMPTINESS_TEST: Final = 100_000
"""Up to this number of states, the occasion of a table (see `Derivation`) is queried first: running a statement's first part twice is then
faster than planning the whole statement."""
LEAST_STATES_FOR_ONE_WORKER: Final = 1_000_000
"""From this number of states on there is one worker: a statement uses all cores, and two statements would need twice the memory."""


def derive(
    con: duckdb.DuckDBPyConnection,
    tables: Iterable[str],
    *,
    are_map_tables: bool,
    always_needed_tables: Iterable[str] = TABLES_NEEDED_FOR_RULES_ABOUT_OTHERS,
    filled_tables: Collection[str] = (),
) -> None:
    """Fill the library tables that `tables` depend on.

    `are_map_tables`: fill the tables that depend on the map only, and the geometries of the map's own tables; else the tables of the
    drives. `always_needed_tables`: more tables to fill. `filled_tables`: tables that already have their rows.
    Two tables are filled at a time, because most are so small that DuckDB uses only one core. Do not call this inside a transaction: the
    other connections do not see its rows.
    Errors: `DriveLintError` naming the table, if its SELECT fails.
    """
    todo = {
        step.table: step
        for step in needed_derivations(tables, always_needed_tables)
        if step.is_of_map_only is are_map_tables and step.table not in filled_tables
    }
    graph = TopologicalSorter({table: sorted(step.reads & todo.keys()) for table, step in todo.items()})
    graph.prepare()
    rows = store.row_counts(con)
    n_states = rows["actor_state"]
    if n_states > MOST_STATES_FOR_EMPTINESS_TEST:
        todo = {table: replace(step, occasion="") for table, step in todo.items()}
    without_rows, types = {table for table, n in rows.items() if not n}, {} if are_map_tables else store.id_types(con)
    empty, old = without_rows - todo.keys(), todo.keys() - without_rows
    for table in statement_texts("map_shapes").keys() - empty if are_map_tables else ():
        con.execute(statement(f"map_shapes/{table}"))
    workers = DERIVATION_WORKERS if n_states < LEAST_STATES_FOR_ONE_WORKER else 1
    with ThreadPoolExecutor(workers) as pool, ExitStack() as stack:
        free = [stack.enter_context(store.cursor(con)) for _ in range(workers)]
        busy: dict[Future[int], tuple[str, duckdb.DuckDBPyConnection]] = {}
        ready: deque[str] = deque()
        stack.callback(_interrupt_until_stopped, tuple(free), busy)  # if a statement fails or the user interrupts
        while graph.is_active():
            ready.extend(sorted(graph.get_ready()))
            filled: list[str] = []
            while ready and free:
                table = ready.popleft()
                if todo[table].needs & empty:
                    _leave_empty(con, table, has_old_rows=table in old)
                    empty.add(table)
                    filled.append(table)
                else:
                    cursor = free.pop()
                    future = pool.submit(_fill_table, cursor, todo[table], types, has_old_rows=table in old)
                    busy[future] = table, cursor
            for future in wait(busy, return_when=FIRST_COMPLETED).done if not filled else ():
                table, cursor = busy.pop(future)
                if not future.result():
                    empty.add(table)
                free.append(cursor)
                filled.append(table)
            graph.done(*filled)


def _leave_empty(con: duckdb.DuckDBPyConnection, table: str, *, has_old_rows: bool) -> int:
    """Leave a table without rows, and return their number, 0. The tables of a whole run keep their rows."""
    if has_old_rows and lifetimes()[table] != "run":
        store.recreate_empty(con, [table])
    return 0


def _interrupt_until_stopped(cursors: Iterable[duckdb.DuckDBPyConnection], running: Iterable[Future[int]]) -> None:
    """Interrupt all cursors repeatedly until no statement runs, because an interrupt before a statement begins has no effect."""
    left = set(running)
    while left:
        for cursor in cursors:
            cursor.interrupt()
        left = wait(left, timeout=0.05).not_done


def _fill_table(
    con: duckdb.DuckDBPyConnection, step: Derivation, types: Mapping[str, str], *, has_old_rows: bool
) -> int:
    """Fill one table, and return the number of its rows. A table of the whole run gets more rows; others are replaced."""
    try:
        with store.uniform_memory_errors():
            if step.occasion and con.execute(step.occasion).fetchone() is None:
                return _leave_empty(con, step.table, has_old_rows=has_old_rows)
            if lifetimes()[step.table] == "run":
                return int(con.execute(f"INSERT INTO {step.table} BY NAME {step.sql}").fetchall()[0][0])
            return store.create_from_select(con, step.table, step.sql, types)
    except duckdb.OutOfMemoryException:
        raise  # not an error of the query: the caller may have more memory
    except duckdb.Error as error:
        raise DriveLintError(f"{library_tables()[step.table].short_path}: {str(error).splitlines()[0]}") from error
