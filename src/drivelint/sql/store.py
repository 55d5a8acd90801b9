"""The DuckDB database: opened offline with its spatial extension, with tables created from `schemas/*.sql` and `queries/library`."""

from __future__ import annotations

import ctypes
import re
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import duckdb

from drivelint.errors import DriveLintError, MemoryShortError
from drivelint.sql import progress_bar, words
from drivelint.sql.declarations import (
    column_comments,
    column_lists,
    column_types,
    create_statements,
    lifetimes,
    word_columns,
)
from drivelint.sql.kept_schemas import cached_schemas
from drivelint.sql.statements import statement_texts
from drivelint.temporary import temporary_folder

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    import pyarrow as pa

ACTOR_ID_COLUMNS = frozenset({"ego_id", "object_id", "actor_id"})
"""Columns with the id of an actor."""
_TABLES_WITH_TEXT_IDS = frozenset({"margin"})
"""Tables with ids from a rule's SQL: the rule may return an actor id that no log contains."""
_NEVER_ALLOWED = ("allow_persistent_secrets", "autoinstall_known_extensions", "autoload_known_extensions")
"""Settings that are off from the start."""
_CODES = r"SELECT regexp_extract(type_name, '^actor_ids_(\d+)$', 1) FROM duckdb_types() WHERE regexp_matches(type_name, '^actor_ids_\d+$')"


def quoted(text: object) -> str:
    """Return a text as an SQL string literal."""
    return "'" + str(text).replace("'", "''") + "'"


def connect(
    path: Path | None = None, *, threads: int | None = None, memory_limit: str | None = None, spill: Path | None = None
) -> duckdb.DuckDBPyConnection:
    """Open a database with the spatial extension from its wheel (no network), all tables of `schemas/` and all macros.

    Beyond `memory_limit` (default: 80 % of the machine's memory) tables spill to the folder `spill`; without `spill`, DuckDB would use
    the working folder. Column comments are created only in a database file: this takes longer than creating the tables, and in memory
    nothing reads them. Errors: `DriveLintError` if the pinned extension cannot be loaded.
    """
    con = open_without_creating_tables(path)
    con.execute("SET allow_community_extensions=false")
    con.execute("SET GLOBAL python_enable_replacements=false")  # GLOBAL: also for cursors of the connection
    progress_bar.turn_off(con)
    con.execute("SET preserve_insertion_order=false")
    if path is None:
        # a database in memory needs no checkpoint; one would repack the tables, a tenth of the time for deriving them
        con.execute("SET GLOBAL checkpoint_threshold='1TB'")
    if threads:
        con.execute(f"SET threads={int(threads)}")
    if memory_limit:
        con.execute("SET memory_limit=?", [memory_limit])
    if spill:
        con.execute("SET temp_directory=?", [str(spill)])
    with _fast_transaction(con):
        create_tables(con, comments=path is not None)
        create_macros(con)
    return con


@contextmanager
def _fast_transaction(con: duckdb.DuckDBPyConnection) -> Iterator[None]:
    """Run statements in one transaction, without optimiser, on one core: opening a database then takes a third less time."""
    with one_thread(con):
        con.execute("PRAGMA disable_optimizer; BEGIN")
        yield
        con.execute("COMMIT; PRAGMA enable_optimizer")


@contextmanager
def uniform_memory_errors() -> Iterator[None]:
    """Raise `duckdb.OutOfMemoryException` also if memory runs out at a commit, for which DuckDB raises `TransactionException`."""
    try:
        yield
    except duckdb.TransactionException as error:
        if any(words in str(error) for words in ("failed to pin block", "could not allocate block")):
            raise duckdb.OutOfMemoryException(str(error)) from error
        raise


@contextmanager
def temporary_database(memory: int | None, *, threads: int | None = None) -> Iterator[duckdb.DuckDBPyConnection]:
    """Open a database in memory that spills to a temporary folder beyond `memory` bytes; the folder is removed afterwards.

    `memory`: None means 80 % of the machine's memory. `threads`: cores that a statement may use; None: all.
    Errors: those of `connect`; `MemoryShortError` if memory runs out although the database spills.
    """
    limit = None if memory is None else f"{memory}B"
    with temporary_folder() as spill, connect(threads=threads, memory_limit=limit, spill=spill) as con:
        try:
            with uniform_memory_errors():
                yield con
        except duckdb.OutOfMemoryException as error:
            raise MemoryShortError("the database") from error
        finally:
            con.interrupt()  # after Ctrl-C the database's threads continue, and closing the database would wait for them


def spill_folder(con: duckdb.DuckDBPyConnection) -> str:
    """Return the folder to which a database spills; '' if it does not spill."""
    (folder,) = con.execute("SELECT current_setting('temp_directory')").fetchall()[0]
    return str(folder or "")


_open_cursors_by_connection_id: dict[int, set[duckdb.DuckDBPyConnection]] = {}
"""Id of a connection -> its open cursors: interrupting a connection does not interrupt its cursors."""
_connection_id_by_cursor_id: dict[int, int] = {}
"""Id of an open cursor -> id of the connection that it was opened on, so that a cursor of a cursor is interrupted, too."""


@contextmanager
def cursor(con: duckdb.DuckDBPyConnection) -> Iterator[duckdb.DuckDBPyConnection]:
    """Open a second connection to the database of `con`, which `interrupt` interrupts together with `con`."""
    with con.cursor() as child:
        root = _connection_id_by_cursor_id.get(id(con), id(con))
        cursors = _open_cursors_by_connection_id.setdefault(root, set())
        cursors.add(child)
        _connection_id_by_cursor_id[id(child)] = root
        try:
            yield child
        finally:
            cursors.discard(child)
            del _connection_id_by_cursor_id[id(child)]


def interrupt(con: duckdb.DuckDBPyConnection) -> None:
    """Stop the statements that run on a connection and on its cursors; called from another thread."""
    for connection in (con, *_open_cursors_by_connection_id.get(id(con), ())):
        with suppress(duckdb.ConnectionException):  # its thread has closed it meanwhile
            connection.interrupt()


def lock_down(con: duckdb.DuckDBPyConnection) -> None:
    """Forbid a database to open files, use the network or change settings, before rules run in it.

    Attached databases stay attached, Arrow tables can still be registered, and spilling still works. Only `memory_limit` and `threads`
    can be set: a batch that runs out of memory is repeated with more memory, and one thread is best for few rows. A database that is
    already locked is not changed.
    """
    if con.execute("SELECT current_setting('lock_configuration')").fetchall()[0][0]:
        return
    for setting in (
        "allowed_configs=['memory_limit', 'threads']",
        "enable_external_access=false",
        "lock_configuration=true",
    ):
        con.execute(f"SET {setting}")


@contextmanager
def one_thread(con: duckdb.DuckDBPyConnection) -> Iterator[None]:
    """Limit a database to one thread: for few rows, several threads use a quarter more processor time and finish no sooner."""
    (before,) = con.execute("SELECT current_setting('threads')").fetchall()[0]
    con.execute("SET threads=1")
    try:
        yield
    finally:
        con.execute(f"SET threads={int(before)}")


def set_and_return_default_memory_limit(con: duckdb.DuckDBPyConnection) -> str:
    """Set a database's memory limit to DuckDB's default, 80 % of the machine's memory, and return the limit."""
    con.execute("RESET memory_limit")
    # RESET changes only the value of the setting; SET also informs the buffer manager
    (limit,) = con.execute("SELECT current_setting('memory_limit')").fetchall()[0]
    con.execute("SET memory_limit=?", [limit])
    return str(limit)


def release_memory_and_leave_limit_of_1_byte(con: duckdb.DuckDBPyConnection) -> None:
    """Return unused memory to the system. Afterwards the memory limit is 1 byte: the caller must set it again.

    Until DuckDB has to evict blocks, it keeps a scattered record of 200 bytes for every freed block. A limit that is too small makes it
    evict all blocks that it can. This takes a few milliseconds, and writes some megabytes of tables to the spill folder. The C library
    keeps freed pages until it is requested to return them.
    """
    # IOException: the disk is full, so the blocks stay in memory
    with suppress(duckdb.OutOfMemoryException, duckdb.IOException):
        con.execute("SET memory_limit='1B'")
    try:
        ctypes.CDLL(None).malloc_trim(0)
    except (OSError, TypeError, AttributeError):  # not glibc
        return


def open_without_creating_tables(path: Path | None = None, *, read_only: bool = False) -> duckdb.DuckDBPyConnection:
    """Open a database without creating tables, with the spatial extension from its wheel. `path` None: an empty database in memory.

    The signature of the extension is not verified: that would hash its 80 MB each time, and the file was installed together with duckdb,
    which is not verified either. Afterwards, any other extension must be signed. Errors: `DriveLintError` if the pinned extension cannot
    be loaded.
    """
    config: dict[str, Any] = dict.fromkeys(_NEVER_ALLOWED, False) | {"allow_unsigned_extensions": True}
    con = duckdb.connect(str(path) if path else ":memory:", read_only=read_only, config=config)
    _load_spatial(con)
    con.execute("SET allow_unsigned_extensions=false")
    return con


def _load_spatial(con: duckdb.DuckDBPyConnection) -> None:
    import duckdb_extension_spatial

    wheel = Path(next(iter(duckdb_extension_spatial.__path__)))
    for file in sorted(wheel.rglob("spatial.duckdb_extension")):
        try:
            con.execute(f"LOAD {quoted(file)}")
        except duckdb.Error as error:
            if "allocate memory" in str(error):
                raise MemoryShortError("the database") from error
            raise DriveLintError(
                f"duckdb {duckdb.__version__} cannot load its spatial extension {file}: {error}; "
                "install duckdb and duckdb-extension-spatial in the same version"
            ) from error
        return
    raise DriveLintError(f"no spatial extension in {wheel}: reinstall duckdb-extension-spatial=={duckdb.__version__}")


@cache
def arrow_schemas() -> dict[str, pa.Schema]:
    """Return table -> Arrow schema for every table of `schemas/`, as DuckDB exports its rows.

    Geometries are omitted: the database makes them from the other columns.
    """
    return cached_schemas(create_tables, column_comments())


def table_with_owner_id(
    name: str, owner_id: str, content: Sequence[Mapping[str, Any]] | Mapping[str, Any], reader: str
) -> pa.Table:
    """Return a table of `schemas/` from rows or columns, with `owner_id` (the id of the drive or map) as its first column.

    Errors: `KeyError` for a missing column; `InternalError`, which names the `reader`, for a word outside its column's vocabulary.
    """
    import pyarrow as pa

    first, *fields = arrow_schemas()[name]
    columns = {
        f.name: content[f.name] if isinstance(content, dict) else [row[f.name] for row in content] for f in fields
    }
    table = pa.table(columns, schema=pa.schema(fields))
    words.refuse_wrong_words(table, word_columns()[name], f"reader {reader}: table {name}")
    return table.add_column(0, first, pa.repeat(pa.scalar(owner_id), table.num_rows))


def recreate_with_enums(
    con: duckdb.DuckDBPyConnection, tables: Iterable[str], drives: Iterable[str], actors: Iterable[str]
) -> None:
    """Recreate tables empty, with the ids of drives and actors as ENUM columns.

    Nearly every join is on these ids; with numbers, derivations take a fifth less time. The values of the ENUM are sorted, so ENUM and
    text have the same order. `drives`, `actors`: all ids that the tables will contain.
    """
    old = _enum_numbers(con)
    for kind, ids in (("drive", drives), ("actor", actors)):
        names = sorted(set(ids))
        can_be_enum = names and not any("\0" in name for name in names)  # SQL text cannot contain NUL
        kind_of_ids = f"ENUM ({', '.join(map(quoted, names))})" if can_be_enum else "VARCHAR"
        # an interrupted or failed call may have left one of the two types
        con.execute(f"CREATE OR REPLACE TYPE {kind}_ids_{max(old, default=0) + 1} AS {kind_of_ids}")
    _recreate_empty(con, tables, _id_types(max(old, default=0) + 1))
    for no in old:
        con.execute(f"DROP TYPE IF EXISTS drive_ids_{no}; DROP TYPE actor_ids_{no}")


def recreate_empty(con: duckdb.DuckDBPyConnection, tables: Iterable[str]) -> None:
    """Recreate tables empty, with the id types that `recreate_with_enums` created last; column comments are lost.

    Deleted rows use memory until a checkpoint, and a database in memory has no checkpoints.
    """
    _recreate_empty(con, tables, id_types(con))


def _recreate_empty(con: duckdb.DuckDBPyConnection, tables: Iterable[str], types: Mapping[str, str]) -> None:
    statements: list[str] = []
    for table in tables:
        body = column_lists()[table]
        for column in types.keys() & column_comments()[table].keys() if _has_enums(table) else ():
            body = re.sub(rf"^    {column} VARCHAR", f"    {column} {types[column]}", body, flags=re.MULTILINE)
        statements.append(f"CREATE OR REPLACE TABLE {table} (\n{body})")
    if statements:
        con.execute(";".join(statements))


def create_from_select(con: duckdb.DuckDBPyConnection, table: str, select: str, types: Mapping[str, str]) -> int:
    """Replace a table by the rows of a SELECT, with the declared types of its columns; return the number of rows.

    `types`: those of `id_types`. One statement creates, fills and checks the table: like an INSERT, it refuses NULL in a NOT NULL column.
    Errors: `duckdb.Error`.
    """
    declared = column_types()[table]
    kinds = {column: kind.removesuffix(" NOT NULL") for column, kind in declared.items()}
    if _has_enums(table):
        kinds |= {column: kind for column, kind in types.items() if column in kinds}
    values = dict(zip(kinds, kinds, strict=True))
    required = [column for column, kind in declared.items() if kind.endswith(" NOT NULL")]
    if required:
        cases = " ".join(f"WHEN {column} IS NULL THEN {quoted(column)}" for column in required)
        failure = f"error('NOT NULL constraint failed: {table}.' || CASE {cases} END)"
        # in the outermost SELECT, which has the rows of the table only
        wrong = " OR ".join(f"{column} IS NULL" for column in required)
        values[required[0]] = f"CASE WHEN {wrong} THEN {failure} ELSE {required[0]} END"
    columns = ", ".join(f"({values[column]})::{kind} AS {column}" for column, kind in kinds.items())
    rows = con.execute(f"CREATE OR REPLACE TABLE {table} AS SELECT {columns} FROM (\n{select}\n)").fetchall()
    return int(rows[0][0])


def id_types(con: duckdb.DuckDBPyConnection) -> dict[str, str]:
    """Return column -> type of the ids that `recreate_with_enums` created last; without them, an empty dictionary."""
    codes = _enum_numbers(con)
    return _id_types(max(codes)) if codes else {}


def _id_types(no: int) -> dict[str, str]:
    return {"drive_id": f"drive_ids_{no}", **dict.fromkeys(ACTOR_ID_COLUMNS, f"actor_ids_{no}")}


def _has_enums(table: str) -> bool:
    """Return whether the ids of a table are ENUM columns: not if it has the ids of several batches, or those that a rule returns."""
    return table not in _TABLES_WITH_TEXT_IDS and lifetimes()[table] != "run"


def _enum_numbers(con: duckdb.DuckDBPyConnection) -> list[int]:
    return [int(no) for (no,) in con.execute(_CODES).fetchall()]


def macro_definitions() -> str:
    """Return the text of all macros in `queries/macros`."""
    return "\n".join(statement_texts("macros").values())


def create_macros(con: duckdb.DuckDBPyConnection) -> None:
    """Create every macro: derivations, rules and reasons call those of `queries/macros`, drivelint's statements also `statement_macros`."""
    con.execute("\n".join([macro_definitions(), *statement_texts("statement_macros").values()]))


def create_tables(con: duckdb.DuckDBPyConnection, *, comments: bool = False) -> None:
    """Create every table of `schemas/*.sql`, with `comments` including the comments of its columns."""
    con.execute(create_statements())
    for table, columns in column_comments().items() if comments else ():
        con.execute(";".join(f"COMMENT ON COLUMN {table}.{c} IS {quoted(text)}" for c, text in columns.items()))


def row_counts(con: duckdb.DuckDBPyConnection) -> dict[str, int]:
    """Return table -> number of rows, without counting them; deleted rows may be counted."""
    sql = "SELECT table_name, estimated_size FROM duckdb_tables() WHERE database_name = current_database()"
    return {table: int(n) for table, n in con.execute(sql).fetchall()}


def tables_without_rows(con: duckdb.DuckDBPyConnection) -> set[str]:
    """Return the tables without rows. A table whose rows were deleted may be missing; callers then only run unneeded statements."""
    return {table for table, n in row_counts(con).items() if not n}


def insert(con: duckdb.DuckDBPyConnection, table: str, rows: pa.Table) -> None:
    """Append an Arrow table by column name. Errors: `duckdb.Error` for a column that the table lacks."""
    columns = list(column_types().get(table, ())) or con.table(table).columns
    if unknown := sorted(set(rows.column_names) - set(columns)):
        raise duckdb.BinderException(f"table {table} has no column {unknown[0]!r}")
    if rows.num_rows:  # most tables of a trace or map are empty
        values = ", ".join(f'"{column}"' if column in rows.column_names else "NULL" for column in columns)
        con.from_arrow(rows).project(values).insert_into(table)


@contextmanager
def registered(con: duckdb.DuckDBPyConnection, tables: Mapping[str, pa.Table]) -> Iterator[None]:
    """Register Arrow tables under these names for statements of this connection, until the context ends."""
    for name, rows in tables.items():
        con.register(name, rows)
    try:
        yield
    finally:
        for name in tables:
            con.unregister(name)
