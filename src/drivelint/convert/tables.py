"""The trace tables as Parquet: each column with its comment, the same bytes for the same rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.formats.tables import parquet
from drivelint.result.files import described_parquet

if TYPE_CHECKING:
    from pathlib import Path

    import pyarrow as pa

MAP_FILE: Final = "map.xodr"
_MARK: Final = "drivelint.converted"


def parquet_bytes(rows: pa.Table, table: str) -> bytes:
    """Return a table of `schemas/model.sql` as Parquet; the field metadata `comment` says what each column is."""
    return described_parquet(rows, table, {_MARK: table})


def is_converted(path: Path) -> bool:
    """Say whether a Parquet file was written by `convert`. Errors: `TraceError` where it is damaged."""
    return _MARK.encode() in (parquet.schema(path).metadata or {})
