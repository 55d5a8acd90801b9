"""Gives the output tables' columns as Arrow schemas, read from `verdict.sql`, `output.sql` and `evidence.sql`."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Final

import duckdb

from drivelint.errors import DriveLintError
from drivelint.resources import folder

if TYPE_CHECKING:
    import pyarrow as pa

OUTPUT_VERSION: Final = 1
"""Version of the output files: raised when a column or a key changes its meaning or goes."""

TABLE_OF_FILE: Final = {
    "verdicts": "verdict",
    "findings": "finding",
    "drives": "drive",
    "rules": "rule",
    "scenes": "scene",
    "lanes": "lane_shape",
    "spaces": "danger_space",
    "courses": "course",
    "tracks": "track",
    "overtakes": "overtake_record",
    "opportunities": "opportunity_record",
}
"""Stem of the Parquet file -> table of the schema."""


@cache
def arrow_schema(table: str) -> pa.Schema:
    """Return the columns of a schema table in order, as DuckDB hands them over to Arrow."""
    with duckdb.connect() as con:
        for name in ("verdict", "output", "evidence"):
            con.execute((folder("schemas") / f"{name}.sql").read_text(encoding="utf-8"))
        return con.table(table).limit(0).to_arrow_table().schema


def conform(rows: pa.Table, table: str) -> pa.Table:
    """Return `rows` with exactly the columns and types of a schema table, in its order and in one chunk.

    Errors: `DriveLintError` naming the columns that are missing or in excess.
    """
    schema = arrow_schema(table)
    missing = sorted(set(schema.names) - set(rows.column_names))
    excess = sorted(set(rows.column_names) - set(schema.names))
    if missing or excess:
        raise DriveLintError(
            f"table {table}: columns missing {missing}, in excess {excess}: it must be that of schemas/"
        )
    return rows.select(schema.names).cast(schema).combine_chunks()


def empty_table(table: str) -> pa.Table:
    """Return a schema table without rows."""
    return arrow_schema(table).empty_table()
