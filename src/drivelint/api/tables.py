"""Tables for whoever works with them in Python: held in Arrow, handed over as Arrow, polars or pandas, queried with SQL."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import duckdb

from drivelint.errors import DriveLintError, UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd
    import polars as pl
    import pyarrow as pa

_CLOSED = "SET python_enable_replacements = false; SET enable_external_access = false; SET lock_configuration = true"
"""A query sees the tables and nothing else, and can write no file."""


class Table:
    """Rows with named columns. pyarrow, polars, pandas and DuckDB take it as it is, too (Arrow's PyCapsule interface)."""

    __slots__ = ("_rows",)

    def __init__(self, rows: pa.Table) -> None:
        self._rows = rows

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns."""
        return tuple(self._rows.column_names)

    def __len__(self) -> int:
        return int(self._rows.num_rows)

    def arrow(self) -> pa.Table:
        """Return the rows as a table of pyarrow."""
        return self._rows

    def pl(self) -> pl.DataFrame:
        """Return the rows as a frame of polars."""
        import polars as pl

        return pl.DataFrame(self._rows)

    def df(self) -> pd.DataFrame:
        """Return the rows as a frame of pandas. Errors: `DriveLintError` where pandas is not installed."""
        try:
            import pandas  # noqa: F401, ICN001 - pyarrow needs it
        except ImportError as error:
            raise DriveLintError(
                "df() needs pandas, which is not installed: pip install pandas, or use pl()"
            ) from error
        return self._rows.to_pandas()

    def rows(self) -> list[dict[str, Any]]:
        """Return every row as a dictionary."""
        return list(self._rows.to_pylist())

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self._rows.__arrow_c_stream__(requested_schema)

    def __repr__(self) -> str:
        return repr(self.pl())

    def _repr_html_(self) -> str:
        return str(self.pl()._repr_html_())


class TableSet:
    """Tables by name, which `sql` queries together."""

    def __init__(self, tables: Mapping[str, pa.Table]) -> None:
        self.tables = {name: Table(rows) for name, rows in tables.items()}

    def sql(self, query: str, params: object = None) -> Table:
        """Return the rows of a DuckDB query over the tables, by their names; `params` fill in `?` or `$name`.

        The tables stay as they are, and nothing that a query creates is there for the next.
        Errors: `DriveLintError` for a query that DuckDB refuses.
        """
        with duckdb.connect() as con:
            for name, rows in self._queried().items():
                con.register(name, rows)
            con.execute(_CLOSED)
            try:
                return Table(con.execute(query, params).to_arrow_table())
            except duckdb.Error as error:
                raise UsageError(f"the query failed: {error}") from error

    def _queried(self) -> dict[str, Any]:
        return {name: table.arrow() for name, table in self.tables.items()}
