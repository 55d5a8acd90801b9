"""Converts the tables of a result to the bytes of Parquet files."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Final

import pyarrow.parquet as pq

from drivelint.result.geometry import with_geometry
from drivelint.result.schemas import OUTPUT_VERSION, conform
from drivelint.sql.declarations import column_comments

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pyarrow as pa

ROW_GROUP_SIZE: Final = 1 << 17


def parquet_bytes(rows: pa.Table, table: str) -> bytes:
    """Return an output table as Parquet, with the columns of `schemas/`; chunks and metadata of `rows` do not change the bytes."""
    about = {"drivelint.table": table, "drivelint.output_schema": str(OUTPUT_VERSION)}
    return parquet_bytes_with_metadata(conform(rows, table), table, about)


def parquet_bytes_with_metadata(rows: pa.Table, table: str, metadata: Mapping[str, str]) -> bytes:
    """Return a table of `schemas/` as Parquet with the metadata `metadata`: the same bytes for the same rows.

    Every column has its comment from `schemas/` as Arrow field metadata (`comment`). Tables with a geometry are GeoParquet.
    """
    comments = column_comments()[table]
    described = rows.schema.with_metadata(metadata)
    for i, field in enumerate(rows.schema):
        described = described.set(i, field.with_metadata({"comment": comments[field.name]}))
    sink = io.BytesIO()
    pq.write_table(
        with_geometry(rows.cast(described).combine_chunks(), table),
        sink,
        version="2.6",
        data_page_version="1.0",
        compression="zstd",
        compression_level=3,
        use_dictionary=True,
        write_statistics=True,
        write_page_checksum=True,
        row_group_size=ROW_GROUP_SIZE,
        store_schema=True,
    )
    return sink.getvalue()
