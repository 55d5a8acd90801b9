"""Reads tables in Arrow's file format (`.arrow`, and `.feather` of version 2)."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import pyarrow as pa

from drivelint.errors import TraceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

T = TypeVar("T")


def table(path: Path, required: Iterable[str] = (), optional: Iterable[str] = ()) -> pa.Table:
    """Return the required columns of a file and its available optional columns; all columns if none is given.

    Errors: `TraceError` for a damaged file, a duplicate column, and a missing required column.
    """
    return _read_from_open_file(path, lambda file: chosen_columns(path, file.read_all(), required, optional))


def chosen_columns(path: Path, rows: pa.Table, required: Iterable[str], optional: Iterable[str]) -> pa.Table:
    """Return the required columns of a table and its available optional columns; all if none is given. Errors: those of `table`."""
    names = rows.schema.names
    required, optional = list(required), list(optional)
    if lacking := [name for name in required if name not in names]:
        raise TraceError(f"{path}: no column {', '.join(lacking)}: it needs {', '.join(required)}: get the log again")
    columns = [*required, *(name for name in optional if name in names)] or names
    if twice := [name for name in columns if names.count(name) > 1]:
        raise TraceError(f"{path}: the column {twice[0]!r} occurs twice: rename or remove one of them")
    rows = rows.select(columns)
    rows.validate(full=True)  # in a damaged file, offsets may point outside of the buffers
    return rows.combine_chunks()


def column_names_and_n_rows(path: Path) -> tuple[list[str], int]:
    """Return the names of the columns and the number of rows. Errors: `TraceError` for a damaged file."""

    def read(file: pa.RecordBatchFileReader) -> tuple[list[str], int]:
        return file.schema.names, sum(file.get_batch(i).num_rows for i in range(file.num_record_batches))

    return _read_from_open_file(path, read)


def _read_from_open_file(path: Path, read_part: Callable[[pa.RecordBatchFileReader], T]) -> T:
    try:
        with path.open("rb") as file, pa.ipc.open_file(pa.PythonFile(file)) as reader:
            return read_part(reader)
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        raise TraceError(
            f"{path}: not readable in Arrow's file format: {' '.join(str(error).split())}: copy it again"
        ) from error
