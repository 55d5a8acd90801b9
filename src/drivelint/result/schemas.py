"""The columns of the output tables, as `schemas/` declares them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.errors import DriveLintError
from drivelint.sql.store import arrow_schemas

if TYPE_CHECKING:
    import pyarrow as pa

OUTPUT_VERSION: Final = 1
"""Version of the output files: raised when a column or a key changes its meaning or is removed."""


def conform(rows: pa.Table, table: str) -> pa.Table:
    """Return `rows` with exactly the columns and types of a schema table, in the schema's order and in one chunk.

    Errors: `DriveLintError`, which names missing and additional columns.
    """
    schema = arrow_schemas()[table]
    lacking = sorted(set(schema.names) - set(rows.column_names))
    excess = sorted(set(rows.column_names) - set(schema.names))
    if lacking or excess:
        raise DriveLintError(
            f"table {table}: columns missing {lacking}, in excess {excess}: it must be that of schemas/"
        )
    return rows.select(schema.names).cast(schema).combine_chunks()


def empty_table(table: str) -> pa.Table:
    """Return a schema table without rows."""
    return arrow_schemas()[table].empty_table()
