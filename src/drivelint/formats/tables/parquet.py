"""Reads Parquet files through an open handle, because pyarrow would read parts of a path such as `key=value` as partition columns."""

from __future__ import annotations

import mmap
from typing import TYPE_CHECKING, Final, TypeVar

import pyarrow as pa
import pyarrow.parquet as pq

from drivelint.errors import TraceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from io import BufferedReader
    from pathlib import Path

T = TypeVar("T")
UNPACKED_BYTES_ALLOWED_FOR_ANY_FILE: Final = 512 << 20
MOST_UNPACKED_PER_PACKED_BYTE: Final = 500
"""A file is refused if it unpacks to more than `UNPACKED_BYTES_ALLOWED_FOR_ANY_FILE` and this multiple of its size: recorded data do not
pack so well."""
_MAGIC: Final = b"PAR1"


def schema(path: Path) -> pa.Schema:
    """Return the schema of a file. Errors: `TraceError` if the file is damaged."""
    return _read_from_open_file(path, lambda file: file.schema_arrow)


def n_rows(path: Path) -> int:
    """Return the number of rows of a file. Errors: `TraceError` if the file is damaged."""
    return _read_from_open_file(path, lambda file: int(file.metadata.num_rows))


def table(path: Path, columns: Iterable[str] | None = None) -> pa.Table:
    """Return all or the given columns of a file. Errors: `TraceError` if the file is damaged or would unpack to too many bytes."""
    names = None if columns is None else list(columns)

    def read(file: pq.ParquetFile) -> pa.Table:
        _refuse_if_unpacked_too_large(path, file.metadata, len(names or file.schema_arrow.names))
        return file.read(columns=names).combine_chunks()

    return _read_from_open_file(path, read)


def column(rows: pa.Table, name: str) -> pa.Array:
    """Return a column as one array, with dictionary-encoded values decoded."""
    array = rows.column(name).combine_chunks()
    return array.cast(array.type.value_type) if pa.types.is_dictionary(array.type) else array


def _read_from_open_file(path: Path, read_part: Callable[[pq.ParquetFile], T]) -> T:
    try:
        with path.open("rb") as file:
            head = file.read(len(_MAGIC) * 8)
            if not head.startswith(_MAGIC):
                beginning = f"it begins {head!r}" if head else "it is empty (0 bytes)"
                raise TraceError(f"{path}: not Parquet: {beginning}: copy it again")
            parquet_file = pq.ParquetFile(file, page_checksum_verification=True)
            _refuse_concatenated_files(path, file)
            names = parquet_file.schema_arrow.names
            if twice := [name for name in names if names.count(name) > 1]:
                raise TraceError(f"{path}: the column {twice[0]!r} occurs twice: rename or remove one of them")
            return read_part(parquet_file)
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        raise TraceError(f"{path}: not readable as Parquet: {' '.join(str(error).split())}: copy it again") from error


def _refuse_if_unpacked_too_large(path: Path, metadata: pq.FileMetaData, n_columns: int) -> None:
    unpacked = metadata.num_rows * n_columns * 8
    if unpacked > max(UNPACKED_BYTES_ALLOWED_FOR_ANY_FILE, MOST_UNPACKED_PER_PACKED_BYTE * path.stat().st_size):
        raise TraceError(
            f"{path}: {metadata.num_rows} rows in a file of {path.stat().st_size} bytes would unpack to {unpacked >> 20} MiB: "
            "write it again"
        )


def _refuse_concatenated_files(path: Path, file: BufferedReader) -> None:
    """Raise `TraceError` if two Parquet files are concatenated, because the last footer's offsets would be applied to the first file.

    The file is searched for magic bytes, because pyarrow ends the process if it reads column metadata with damaged statistics.
    """
    with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        at = data.find(_MAGIC * 2)
        while at >= 0:
            end = at + len(_MAGIC)
            if _is_complete_parquet(data[:end]):
                raise TraceError(
                    f"{path}: a second Parquet file begins at byte {end}: split the file, and give each part by itself"
                )
            at = data.find(_MAGIC * 2, at + 1)


def _is_complete_parquet(content: bytes) -> bool:
    try:
        pq.read_metadata(pa.BufferReader(content))
    except (pa.ArrowException, OSError):
        return False
    return True
