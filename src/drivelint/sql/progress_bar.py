"""DuckDB's own progress bar, which it turns on in notebooks."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import duckdb


def turn_off(con: duckdb.DuckDBPyConnection) -> None:
    """Turn the bar off if it is on. In a notebook without ipywidgets it is off, and DuckDB would refuse the statement."""
    if con.execute("SELECT current_setting('enable_progress_bar')").fetchall()[0][0]:
        con.execute("SET enable_progress_bar=false")
