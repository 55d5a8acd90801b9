"""Tables are documented contracts: every column of schemas/*.sql has a comment, and the database has them too."""

from __future__ import annotations

import re

import duckdb
import pytest

from drivelint.drive.order import MAX_GAP_PERIODS
from drivelint.resources import folder
from drivelint.sql import declarations, store
from drivelint.sql.derivations import derivations


@pytest.fixture(scope="module")
def database() -> duckdb.DuckDBPyConnection:
    con = duckdb.connect()
    store.create_tables(con, comments=True)
    return con


def test_every_column_of_every_table_has_a_comment(database: duckdb.DuckDBPyConnection) -> None:
    columns = database.execute(
        "SELECT table_name, column_name, comment FROM duckdb_columns() WHERE NOT internal"
    ).fetchall()
    assert len(columns) > 100
    bare = [f"{table}.{column}" for table, column, comment in columns if not (comment or "").strip()]
    assert not bare


def test_what_is_parsed_from_the_files_is_what_the_database_has(database: duckdb.DuckDBPyConnection) -> None:
    rows = database.execute(
        "SELECT table_name, column_name FROM duckdb_columns() WHERE NOT internal ORDER BY table_oid, column_index"
    )
    found: dict[str, list[str]] = {}
    for table, column in rows.fetchall():
        found.setdefault(table, []).append(column)
    assert {table: list(columns) for table, columns in declarations.column_comments().items()} == found


def test_every_table_of_the_library_is_filled_by_a_query_of_its_name() -> None:
    """A table that nothing fills is empty, and empty would read as: it never happened."""
    topics = sorted(path.name for path in (folder("queries") / "library").iterdir())
    declared = {table for topic in topics for table in declarations.column_comments(f"library/{topic}")}
    assert declared == {file.stem for file in (folder("queries") / "library").glob("*/*.sql")} == set(derivations())


def test_units_are_si_and_stand_in_the_name(database: duckdb.DuckDBPyConnection) -> None:
    """A time in ticks is BIGINT nanoseconds (`_ns`); no column is in minutes, degrees or miles."""
    columns = database.execute(
        "SELECT table_name, column_name, data_type FROM duckdb_columns() WHERE NOT internal"
    ).fetchall()
    assert [c for c in columns if c[1].endswith("_ns") and c[2].removesuffix("[]") != "BIGINT"] == []
    assert [c for c in columns if re.search(r"_(deg|mph|kmh|min|ft|ms)$", c[1])] == []


def test_only_the_wheels_extension_may_be_unsigned() -> None:
    with store.connect(threads=1) as con:
        assert con.execute("SELECT current_setting('allow_unsigned_extensions')").fetchall() == [(False,)]
        with pytest.raises(duckdb.InvalidInputException, match="while database is running"):
            con.execute("SET allow_unsigned_extensions=true")


def test_every_table_says_how_long_its_rows_stay() -> None:
    """A table of a map has no drive; what is derived for egos goes with its part of the drive, unless it is a result."""
    assert set(declarations.lifetimes()) == set(declarations.column_comments())
    for table, lifetime in declarations.lifetimes().items():
        columns = declarations.column_comments()[table]
        assert (lifetime == "map") <= ("environment_id" in columns and "drive_id" not in columns), table
        assert (lifetime in {"drive", "part"}) <= ("drive_id" in columns), table
    assert {declarations.lifetimes()[table] for table in derivations()} == {"map", "part", "run"}
    assert declarations.tables_of_lifetime("drive") == [
        "actor",
        "actor_state",
        "signal_state",
        "declared_event",
        "doubt",
        "margin",
    ]


def test_samples_are_continuous_for_python_and_for_sql_alike() -> None:
    with store.connect() as con:
        assert con.execute("SELECT max_gap_periods()").fetchall() == [(MAX_GAP_PERIODS,)]
