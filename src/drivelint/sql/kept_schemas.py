"""Caches the Arrow schemas of tables: creating the tables and reading their schemas takes a quarter of a second."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import duckdb

from drivelint.memo import Memo

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    import pyarrow as pa

_SERIALIZED_SCHEMAS: Final = Memo[dict[str, bytes]]("schemas", dict[str, bytes])


def cached_schemas(
    create_tables: Callable[[duckdb.DuckDBPyConnection], None], tables: Iterable[str]
) -> dict[str, pa.Schema]:
    """Return table -> Arrow schema without the geometry column, for tables that `create_tables` creates."""
    import pyarrow as pa

    def compute_serialized_schemas() -> dict[str, bytes]:
        with duckdb.connect() as con:
            create_tables(con)
            empty = {name: f"SELECT COLUMNS(lambda c: c <> 'geom') FROM {name} LIMIT 0" for name in tables}
            return {
                name: con.execute(sql).to_arrow_table().schema.serialize().to_pybytes() for name, sql in empty.items()
            }

    return {
        name: pa.ipc.read_schema(pa.py_buffer(content))
        for name, content in _SERIALIZED_SCHEMAS.find_or_compute("", compute_serialized_schemas).items()
    }
