"""The trace tables as Parquet: each column with its comment, the same bytes for the same rows."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Final

import pyarrow.parquet as pq

from drivelint.formats.tables import parquet
from drivelint.sql.store import column_comments

if TYPE_CHECKING:
    from pathlib import Path

    import pyarrow as pa

MAP_FILE: Final = "map.xodr"
ROW_GROUP_SIZE: Final = 1 << 17
_MARK: Final = b"drivelint.converted"


def parquet_bytes(rows: pa.Table, table: str) -> bytes:
    """Return a table of `schemas/model.sql` as Parquet; the field metadata `comment` says what each column is."""
    comments = column_comments()[table]
    described = rows.schema.with_metadata({_MARK: table})
    for i, field in enumerate(rows.schema):
        described = described.set(i, field.with_metadata({"comment": comments[field.name]}))
    sink = io.BytesIO()
    pq.write_table(
        rows.cast(described).combine_chunks(),
        sink,
        version="2.6",
        compression="zstd",
        compression_level=3,
        row_group_size=ROW_GROUP_SIZE,
    )
    return sink.getvalue()


def is_converted(path: Path) -> bool:
    """Say whether a Parquet file was written by `convert`. Errors: `TraceError` where it is damaged."""
    return _MARK in (parquet.schema(path).metadata or {})
