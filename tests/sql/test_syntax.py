"""What a SELECT reads and needs, held against what DuckDB returns when the tables are empty."""

from __future__ import annotations

import re

import duckdb
import pytest

from drivelint.errors import DriveLintError
from drivelint.sql import store, syntax
from drivelint.sql.derivations import Derivation, _tables_read_tables_needed_and_occasion, derivations
from tests.sql.lines import expected_by_select

TABLES = ("a", "b", "c")
NEEDS, OCCASIONS, NO_OCCASIONS = map(expected_by_select, ("needs", "occasions", "no_occasions"))


@pytest.fixture(scope="module")
def con() -> duckdb.DuckDBPyConnection:
    con = duckdb.connect()
    for table in TABLES:
        con.execute(f"CREATE TABLE {table} AS SELECT 1 AS x")
    return con


@pytest.mark.parametrize("sql", NEEDS)
def test_a_select_has_no_rows_without_those_of_what_it_needs(con: duckdb.DuckDBPyConnection, sql: str) -> None:
    needs = syntax.tables_needing_rows(syntax.parse_select(sql, "here"))
    assert needs == NEEDS[sql]
    assert con.execute(sql).fetchall()
    for table in needs:
        con.execute(f"BEGIN; DELETE FROM {table}")
        assert not con.execute(sql).fetchall()
        con.execute("ROLLBACK")


@pytest.mark.parametrize("sql", OCCASIONS)
def test_a_select_has_no_rows_without_those_of_its_occasion(con: duckdb.DuckDBPyConnection, sql: str) -> None:
    ctes = OCCASIONS[sql]
    assert syntax.has_no_rows_without(syntax.parse_select(sql, "here"), frozenset(ctes))
    assert con.execute(sql).fetchall()
    for cte in ctes:
        sql = re.sub(rf"{cte} AS \((.*?)\)", rf"{cte} AS (SELECT * FROM (\1) WHERE false)", sql, count=1)
    assert not con.execute(sql).fetchall()


@pytest.mark.parametrize("sql", NO_OCCASIONS)
def test_a_cte_without_which_there_may_be_rows_is_no_occasion(sql: str) -> None:
    assert not syntax.has_no_rows_without(syntax.parse_select(sql, "here"), frozenset(NO_OCCASIONS[sql]))


OF_DERIVATIONS = [step for step in derivations().values() if step.occasion]


@pytest.mark.sample(6, ci=6)
@pytest.mark.parametrize("step", OF_DERIVATIONS, ids=lambda step: step.table)
def test_the_occasion_of_a_derivation_is_a_query(step: Derivation) -> None:
    """A statement of its own, which stops before the derivation's does."""
    assert syntax.tables_read(syntax.parse_select(step.occasion, step.table)) & derivations().keys() <= step.reads
    with store.connect() as con:
        assert con.execute(step.occasion).fetchone() is None


def test_an_occasion_that_does_not_hold_is_refused() -> None:
    sql = "WITH p AS (FROM a),\n-- occasion: p\nq AS (FROM b)\nFROM q LEFT JOIN p USING (x)"
    with pytest.raises(DriveLintError, match=r"^here\.sql: without rows in p there may be rows"):
        _tables_read_tables_needed_and_occasion(sql, "here.sql")
    reads, needs, occasion = _tables_read_tables_needed_and_occasion(sql.replace("LEFT JOIN", "JOIN"), "here.sql")
    assert reads == needs == {"a", "b"}
    assert occasion == "WITH p AS (FROM a) SELECT 1 FROM p LIMIT 1"


def test_what_is_read() -> None:
    tree = syntax.parse_select("WITH a AS (FROM b) SELECT (SELECT max(x) FROM c) FROM a WHERE x IN (FROM d)", "here")
    assert syntax.tables_read(tree) == {"b", "c", "d"}
    tree = syntax.parse_select(
        "WITH a AS (FROM A WHERE x > 0) SELECT * FROM a, (WITH b AS (FROM a) FROM B), main.a", "here"
    )
    assert syntax.tables_read(tree) == {"a"}
    tree = syntax.parse_select("WITH b AS (FROM a) SELECT * FROM (WITH a AS (FROM c) FROM a JOIN b USING (x))", "here")
    assert syntax.tables_read(tree) == {"a", "c"}


@pytest.mark.parametrize("name", ["st_extent_agg", "ST_Union_Agg"])
def test_the_aggregates_of_spatial_are_known(name: str) -> None:
    assert not syntax.tables_needing_rows(syntax.parse_select(f"SELECT {name}(x) FROM a", "here"))


@pytest.mark.parametrize("step", derivations().values(), ids=lambda step: step.table)
def test_what_a_derivation_needs_it_reads(step: Derivation) -> None:
    assert step.needs & derivations().keys() <= step.reads


def test_what_is_no_select_is_refused() -> None:
    with pytest.raises(DriveLintError, match=r"^here\.sql: "):
        syntax.parse_select("SELEC 1", "here.sql")
