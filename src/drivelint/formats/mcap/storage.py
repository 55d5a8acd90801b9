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


def _is_sqlite(path: Path) -> bool:
    try:
        return is_sqlite(path)
    except OSError as error:
        raise TraceError(f"{path}: cannot be read: {error.strerror or error}") from error
