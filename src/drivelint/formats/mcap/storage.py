"""Opens a file of a bag by its storage: MCAP or SQLite."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.errors import TraceError
from drivelint.formats.mcap.reader import Container
from drivelint.formats.mcap.summary import Summary, read_index
from drivelint.formats.sqlite_bag.database import is_sqlite

if TYPE_CHECKING:
    from pathlib import Path


def recorded_file(path: Path, *, salvage: bool = True) -> Container:
    """Return the file, not yet read. `salvage`: of a damaged MCAP file, read what is readable. Errors: `TraceError`."""
    if _is_sqlite(path):
        from drivelint.formats.sqlite_bag.reader import SqliteFile

        return SqliteFile(path)
    return Container(path, salvage=salvage)


def file_index(path: Path) -> Summary:
    """Return the topics of a file, and of MCAP its index; an empty `Summary` if an MCAP file has none. Errors: `TraceError`."""
    if _is_sqlite(path):
        from drivelint.formats.sqlite_bag.reader import SqliteFile

        return SqliteFile(path).index()
    return read_index(path)


def recorded_span(path: Path) -> tuple[int, int] | None:
    """Return the first and the last log time of a file by its index, or None if it has none. Errors: `TraceError`."""
    if _is_sqlite(path):
        from drivelint.formats.sqlite_bag.database import open_database

        with open_database(path) as connection:
            first, last = connection.execute("SELECT min(timestamp), max(timestamp) FROM messages").fetchone()
        return (first, last) if isinstance(first, int) and isinstance(last, int) else None
    chunks = read_index(path).chunks.values()
    return (min(chunk[1] for chunk in chunks), max(chunk[2] for chunk in chunks)) if chunks else None


def _is_sqlite(path: Path) -> bool:
    try:
        return is_sqlite(path)
    except OSError as error:
        raise TraceError(f"{path}: cannot be read: {error.strerror or error}") from error
