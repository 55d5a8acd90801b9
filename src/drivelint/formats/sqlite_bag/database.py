"""Opens a SQLite file of a bag without trusting it: it is checked before it is read, never written to, and runs no code.

Format: https://www.sqlite.org/fileformat2.html; tables: rosbag2_storage_sqlite3.
"""

from __future__ import annotations

import sqlite3
import struct
from contextlib import contextmanager
from itertools import product
from shlex import quote
from typing import TYPE_CHECKING, Final

from drivelint.errors import TraceError
from drivelint.formats.mcap.chunk import MAX_CHUNK_BYTES
from drivelint.receipts.events import report_searched_path

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

MAGIC: Final = b"SQLite format 3\0"
COLUMNS_BY_TABLE: Final = {
    "topics": {"id", "name", "type", "serialization_format"},
    "messages": {"topic_id", "timestamp", "data"},
}
"""Table -> the columns that are read."""
DEFINITIONS_TABLE: Final = "message_definitions"
_DEFINITION_COLUMNS: Final = {"topic_type", "encoding", "encoded_message_definition"}
_LOST_ROWS_TABLE: Final = "lost_and_found"
"""So begins the name of the table in which `.recover` of sqlite3 puts rows of unknown tables."""
_REPAIRED_PREFIX: Final = "repaired-"
_FILE_HEADER_BYTES: Final = 100
_SQLITE_STEPS_PER_PROGRESS_CALLBACK: Final = 100_000
"""SQLite returns to Python after so many of its steps, so that reading can be interrupted."""


def is_sqlite(path: Path) -> bool:
    """Return whether a file begins as SQLite files do. Errors: `OSError`."""
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


@contextmanager
def open_database(path: Path) -> Iterator[sqlite3.Connection]:
    """Open a file of a bag, and check its tables. Errors: `TraceError` if it is damaged, not closed, or no bag."""
    _refuse_incomplete_file(path)
    with convert_sqlite_errors(path):
        connection = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)
        try:
            connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MAX_CHUNK_BYTES)
            connection.set_progress_handler(lambda: 0, _SQLITE_STEPS_PER_PROGRESS_CALLBACK)
            connection.execute("PRAGMA trusted_schema = OFF")
            connection.execute("PRAGMA cell_size_check = ON")
            _check_tables(path, connection)
            yield connection
        finally:
            connection.close()


@contextmanager
def convert_sqlite_errors(path: Path) -> Iterator[None]:
    """Convert errors of SQLite about a file to `TraceError`."""
    try:
        yield
    except (sqlite3.Error, UnicodeError, OverflowError) as error:
        raise damage_error(path, str(error)) from error


def damage_error(path: Path, problem: str) -> TraceError:
    """Return the error for a file that cannot be read."""
    remedy = "copy it again"
    if not path.name.startswith(_REPAIRED_PREFIX):
        repaired = path.with_name(f"{_REPAIRED_PREFIX}{path.name}")
        remedy += f", or repair it with sqlite3 {quote(str(path))} .recover | sqlite3 {quote(str(repaired))}"
    return TraceError(f"{path}: a SQLite file that is damaged or cut off ({' '.join(problem.split())}): {remedy}")


def check_pages(path: Path, connection: sqlite3.Connection) -> None:
    """Raise `TraceError` if the pages of the file contradict each other: rows could be missing without an error."""
    outcome = connection.execute("PRAGMA quick_check(1)").fetchone()
    if outcome is None or outcome[0] != "ok":
        raise damage_error(path, "its check failed" if outcome is None else str(outcome[0])[:200])


def has_definitions(path: Path, connection: sqlite3.Connection) -> bool:
    """Return whether the file has message definitions. Errors: `TraceError` if their table is not as rosbag2 writes it."""
    row = connection.execute("SELECT 1 FROM sqlite_master WHERE name = ?", (DEFINITIONS_TABLE,)).fetchone()
    if row is not None:
        _check_table(path, connection, DEFINITIONS_TABLE, _DEFINITION_COLUMNS)
    return row is not None


def is_repaired_with_losses(connection: sqlite3.Connection) -> bool:
    """Return whether `.recover` of sqlite3 wrote the file, and found rows whose tables it does not know."""
    query = "SELECT 1 FROM sqlite_master WHERE substr(name, 1, ?) = ?"
    return connection.execute(query, (len(_LOST_ROWS_TABLE), _LOST_ROWS_TABLE)).fetchone() is not None


def _refuse_incomplete_file(path: Path) -> None:
    """Raise `TraceError` for a file that is shorter than it says, or whose last changes are in another file."""
    with path.open("rb") as file:
        head = file.read(_FILE_HEADER_BYTES)
    size = path.stat().st_size
    if len(head) < _FILE_HEADER_BYTES:
        raise damage_error(path, f"{size} bytes")
    (page,), (pages,) = struct.unpack_from(">H", head, 16), struct.unpack_from(">I", head, 28)
    due_bytes = pages * (65536 if page == 1 else page)
    if size < due_bytes:
        raise damage_error(path, f"{size} of {due_bytes} bytes")
    # SQLite writes beside the file to which a link leads
    places = [path, path.resolve()] if path.is_symlink() else [path]
    for place, suffix in product(places, ("-wal", "-journal")):
        beside = place.with_name(place.name + suffix)
        if report_searched_path(beside).is_file() and beside.stat().st_size:
            raise TraceError(
                f"{path}: its recorder did not close it, and {beside.name} has messages that are not in it: close it with "
                f"sqlite3 {quote(str(place))} 'PRAGMA journal_mode = DELETE'"
            )


def _check_tables(path: Path, connection: sqlite3.Connection) -> None:
    for table, columns in COLUMNS_BY_TABLE.items():
        _check_table(path, connection, table, columns)


def _check_table(path: Path, connection: sqlite3.Connection, table: str, columns: set[str]) -> None:
    """Raise `TraceError` unless the table is stored in the file with these columns: a view, for example, can have endless rows."""
    entries = connection.execute("SELECT type, rootpage FROM sqlite_master WHERE name = ?", (table,)).fetchall()
    if not entries:
        raise TraceError(f"{path}: a SQLite file without the table {table!r}: no bag of ROS 2: check the path")
    stored = {name for _, name, _, _, _, _, hidden in connection.execute(f"PRAGMA table_xinfo({table})") if not hidden}
    if len(entries) != 1 or entries[0][0] != "table" or not entries[0][1] or not columns <= stored:
        raise TraceError(
            f"{path}: its table {table!r} is not as rosbag2 writes it: record the log again, or convert it with ros2 bag convert"
        )
