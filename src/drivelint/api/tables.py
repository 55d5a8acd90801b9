"""Tables for Python: stored as Arrow tables, returned as Arrow, polars or pandas, queried with SQL."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import duckdb

from drivelint.errors import DriveLintError, UsageError
from drivelint.phrases import hint
from drivelint.result.geometry import GEOMETRIES_OF_TABLE, GEOMETRY_IN_DEGREES_COLUMN, with_geometry
from drivelint.sql import declarations, store
from drivelint.sql.internal_names import without_internal_names

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    import geopandas as gpd
    import pandas as pd
    import polars as pl
    import pyarrow as pa

_SANDBOX_SETTINGS = (
    "SET python_enable_replacements = false; SET enable_external_access = false; SET lock_configuration = true"
)
"""Settings with which a query can read only the tables, and cannot write files."""


class Table:
    """Rows with named columns. pyarrow, polars, pandas and DuckDB also accept this object itself (Arrow's PyCapsule interface)."""

    __slots__ = ("_rows", "_schema_table")

    def __init__(self, rows: pa.Table, schema_table: str | None = None) -> None:
        self._rows = rows
        self._schema_table = schema_table or ""

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns."""
        return tuple(self._rows.column_names)

    def describe(self) -> Table:
        """Return a row per column: `column`, `type`, and `meaning` with the unit; `meaning` is empty for the result of a query."""
        import pyarrow as pa

        meanings = declarations.column_comments().get(self._schema_table, {})
        types = [str(kind) for kind in self._rows.schema.types]
        texts = [meanings.get(column, "") for column in self.columns]
        return Table(pa.table({"column": list(self.columns), "type": types, "meaning": texts}))

    def __len__(self) -> int:
        return int(self._rows.num_rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Yield every row as a dictionary."""
        return iter(self.rows())

    def __getitem__(self, column: str) -> pl.Series:
        """Return a column as a polars Series. Errors: `KeyError` with the nearest name."""
        import polars as pl

        if column not in self.columns:
            raise KeyError(f"{column!r} is no column: {hint(str(column), self.columns)}")
        return pl.Series(column, self._rows[column])

    def arrow(self) -> pa.Table:
        """Return the rows as a pyarrow Table."""
        return self._rows

    def pl(self) -> pl.DataFrame:
        """Return the rows as a polars DataFrame."""
        import polars as pl

        return pl.DataFrame(self._rows)

    def df(self) -> pd.DataFrame:
        """Return the rows as a pandas DataFrame. Errors: `DriveLintError` if pandas is not installed."""
        try:
            import pandas  # noqa: F401, ICN001 - pyarrow needs it
        except ImportError as error:
            raise DriveLintError(
                "df() needs pandas, which is not installed: pip install pandas, or use pl()"
            ) from error
        return self._rows.to_pandas()

    def geo(self) -> gpd.GeoDataFrame:
        """Return the rows with their geometries as a GeoDataFrame of geopandas.

        `geom` is in the map's metres, `geom_lonlat` in degrees of longitude and latitude.

        Errors: `DriveLintError` if geopandas is not installed, or the table has no geometry.
        """
        if self._schema_table not in GEOMETRIES_OF_TABLE:
            raise UsageError(
                "geo(): this table has no geometry; findings, drives, scenes, lanes, spaces, courses and tracks have"
            )
        try:
            import geopandas as gpd
        except ImportError as error:
            raise DriveLintError("geo() needs geopandas, which is not installed: pip install geopandas") from error
        table, shapes = with_geometry(self._rows, self._schema_table), GEOMETRIES_OF_TABLE[self._schema_table]
        series = {
            column: gpd.GeoSeries.from_wkb(
                table[column].to_pylist(), crs="OGC:CRS84" if column == GEOMETRY_IN_DEGREES_COLUMN else None
            )
            for column in shapes
        }
        return gpd.GeoDataFrame(self.df().assign(**series), geometry=next(iter(shapes)))

    def rows(self) -> list[dict[str, Any]]:
        """Return every row as a dictionary."""
        return list(self._rows.to_pylist())

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._rows.__arrow_c_stream__(requested_schema)

    def __repr__(self) -> str:
        return repr(self.pl())

    def _repr_html_(self) -> str:
        return str(self.pl()._repr_html_())


def _unique_names(names: Sequence[str]) -> list[str]:
    """Return unique column names: a repeated name gets a number, as DuckDB numbers the columns of a table."""
    unique: list[str] = []
    for name in names:
        n, free = 0, name
        while free in unique or (n and free in names):
            n += 1
            free = f"{name}_{n}"
        unique.append(free)
    return unique


class TableSet:
    """Several tables with names, and SQL queries over them."""

    def __init__(self, tables: Mapping[str, pa.Table], schema_tables: Mapping[str, str]) -> None:
        """Store the tables. `schema_tables`: name -> table of the schema that describes its columns and geometry."""
        self.tables = {name: Table(rows, schema_tables.get(name)) for name, rows in tables.items()}
        self._shapes = {name: table for name, table in schema_tables.items() if table in GEOMETRIES_OF_TABLE}

    def sql(self, query: str, params: object = None) -> Table:
        """Return the rows of a DuckDB query over the tables, by their names. `params`: values for `?` or `$name`.

        For a query with `geom`, `geom_lonlat` or a function `ST_...`, the spatial extension is loaded, and tables with a geometry have
        these columns (GEOMETRY). A geometry in the result is WKB. A query cannot change the tables, and tables that it creates are lost
        afterwards. Repeated column names, as after a join, get numbers: `t_start_ns_1`.
        Errors: `DriveLintError` for a query that DuckDB refuses, or a statement that returns no table.
        """
        has_geometry = re.search(r"\bgeom(_lonlat)?\b|\bst_", query, re.IGNORECASE) is not None
        with store.open_without_creating_tables() if has_geometry else duckdb.connect() as con:
            for name, rows in self._queryable_tables().items():
                if has_geometry and name in self._shapes:
                    con.register("_wkb", with_geometry(rows, self._shapes[name]))
                    shapes = ", ".join(
                        f"ST_GeomFromWKB({column}) AS {column}" for column in GEOMETRIES_OF_TABLE[self._shapes[name]]
                    )
                    con.execute(f"CREATE TABLE {name} AS SELECT * REPLACE ({shapes}) FROM _wkb")
                    con.unregister("_wkb")
                else:
                    con.register(name, rows)
            con.execute(_SANDBOX_SETTINGS)
            try:
                answer = con.execute(query, params)
                if answer is None or answer.description is None:
                    raise UsageError("the query returns nothing: give a SELECT or FROM")
                rows = answer.to_arrow_table()
                return Table(rows.rename_columns(_unique_names(rows.column_names)))
            except duckdb.Error as error:
                # the message has DuckDB's error already
                raise UsageError(f"the query failed: {without_internal_names(str(error))}") from None

    def _queryable_tables(self) -> dict[str, Any]:
        return {name: table.arrow() for name, table in self.tables.items()}
