"""This module reads Parquet files through an open handle, so that no part of a path is taken for partition data."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import pyarrow as pa
import pyarrow.parquet as pq

from drivelint.errors import TraceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

T = TypeVar("T")


def schema(path: Path) -> pa.Schema:
    """Return the schema of a file. Errors: `TraceError` where the file is damaged."""
    return _open(path, lambda file: file.schema_arrow)


def n_rows(path: Path) -> int:
    """Return the number of rows of a file. Errors: `TraceError` where the file is damaged."""
    return _open(path, lambda file: int(file.metadata.num_rows))


def table(path: Path, columns: Iterable[str] | None = None) -> pa.Table:
    """Read a file, or some columns of it. Errors: `TraceError` where the file is damaged."""
    names = None if columns is None else list(columns)
    return _open(path, lambda file: file.read(columns=names).combine_chunks())


def column(rows: pa.Table, name: str) -> pa.Array:
    """Return a column as one array, dictionaries spelled out."""
    array = rows.column(name).combine_chunks()
    return array.cast(array.type.value_type) if pa.types.is_dictionary(array.type) else array


def _open(path: Path, take: Callable[[pq.ParquetFile], T]) -> T:
    try:
        with path.open("rb") as file:
            opened = pq.ParquetFile(file, page_checksum_verification=True)
            names = opened.schema_arrow.names
            if twice := [name for name in names if names.count(name) > 1]:
                raise TraceError(f"{path}: the column {twice[0]!r} stands twice: rename one, or remove it")
            return take(opened)
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        raise TraceError(f"{path}: not readable as Parquet: {' '.join(str(error).split())}: copy it again") from error
