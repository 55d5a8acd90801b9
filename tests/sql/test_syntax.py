"""What a SELECT reads and needs, held against what DuckDB returns when the tables are empty."""

from __future__ import annotations

import re

import duckdb
import pytest

from drivelint.errors import DriveLintError
from drivelint.sql import store, syntax
from drivelint.sql.derivations import Derivation, _tables_read_tables_needed_and_occasion, derivations

TABLES = ("a", "b", "c")
NEEDS = {
    "FROM a": "a",
    "SELECT 1": "",
    "SELECT * FROM (VALUES (1)) v": "",
    "SELECT * FROM range(3)": "",
    "SELECT unnest([1, 2]) FROM a": "a",
    "SELECT a.x FROM a JOIN b USING (x)": "a b",
    "SELECT a.x FROM a, b CROSS JOIN c": "a b c",
    "SELECT a.x FROM a LEFT JOIN b USING (x) JOIN c USING (x)": "a c",
    "SELECT a.x FROM a RIGHT JOIN b USING (x)": "",  # b, but we have no such join
    "SELECT a.x FROM a FULL JOIN b USING (x)": "",
    "SELECT a.x FROM a POSITIONAL JOIN b": "",
    "FROM a SEMI JOIN b USING (x)": "a b",
    "FROM a ANTI JOIN (SELECT x + 1 AS x FROM b) USING (x)": "a",
    "SELECT a.x FROM a ASOF JOIN b ON a.x >= b.x": "a b",
    "SELECT a.x FROM a ASOF LEFT JOIN b ON a.x >= b.x": "a",
    "SELECT x FROM a WHERE EXISTS (FROM b)": "a",  # b too, which would only save time
    "SELECT x FROM a UNION ALL SELECT x FROM b": "",
    "SELECT x FROM a JOIN c USING (x) UNION ALL BY NAME SELECT x FROM b JOIN c USING (x)": "c",
    "FROM a EXCEPT SELECT x + 1 FROM b": "",  # a
    "WITH w AS (SELECT a.x FROM a JOIN b USING (x)), v AS (FROM w) SELECT v.x FROM v LEFT JOIN c USING (x)": "a b",
    "WITH a AS (FROM b) FROM a": "b",
    "WITH b AS (FROM a) SELECT * FROM (WITH a AS (FROM c) FROM a JOIN b USING (x))": "a c",
    "WITH RECURSIVE w AS (SELECT x FROM a UNION ALL SELECT w.x + 1 FROM w, b WHERE w.x < 3) FROM w": "a",
    "WITH RECURSIVE w AS (SELECT x FROM a UNION SELECT x FROM b) FROM w": "",
    "SELECT count(*) FROM a": "",
    "SELECT max(x) + 1 FROM a": "",
    "SELECT 1 FROM a HAVING count(*) >= 0": "",
    "SELECT count(*) OVER () FROM a": "a",
    "SELECT x, count(*) FROM a GROUP BY x": "a",
    "SELECT count(*) FROM a GROUP BY x": "a",
    "SELECT count(*) FROM a GROUP BY ()": "",
    "SELECT count(*) FROM a GROUP BY ROLLUP (x)": "",
    "SELECT x, count(*) FROM a GROUP BY ALL": "a",
    "SELECT count(*) FROM a GROUP BY ALL": "",
    "SELECT b.x FROM b JOIN (SELECT count(*) AS n FROM a) ON true": "b",
    "SELECT DISTINCT x FROM a ORDER BY x LIMIT 1": "a",
    "WITH A AS (SELECT 7 AS x) FROM a": "",
    "WITH a AS (FROM b) FROM main.a": "a",
    "SELECT x FROM B": "b",
    "SELECT 1 FROM a HAVING true": "",
    "SELECT 1 FROM a ORDER BY count(*)": "",
    "SELECT DISTINCT ON (count(*)) 1 FROM a": "",
    "SELECT 1 FROM a QUALIFY row_number() OVER (ORDER BY count(*)) = 1": "",
    "SELECT count(*) AS n, n FROM a GROUP BY ALL": "",
    "SELECT 5 AS k, k, count(*) FROM a GROUP BY ALL": "",
    "SELECT l.n FROM b, LATERAL (SELECT b.x, count(*) AS n FROM a GROUP BY ALL) l": "b",
    "SELECT geomean(x) FROM a": "",
    "SELECT wavg(x, x) FROM a": "",
    "SELECT b.x FROM b JOIN (SELECT x, count(*) AS n FROM a GROUP BY x) USING (x)": "a b",
}


@pytest.fixture(scope="module")
def con() -> duckdb.DuckDBPyConnection:
    con = duckdb.connect()
    for table in TABLES:
        con.execute(f"CREATE TABLE {table} AS SELECT 1 AS x")
    return con


@pytest.mark.parametrize("sql", NEEDS)
def test_a_select_has_no_rows_without_those_of_what_it_needs(con: duckdb.DuckDBPyConnection, sql: str) -> None:
    needs = syntax.tables_needing_rows(syntax.parse_select(sql, "here"))
    assert needs == set(NEEDS[sql].split())
    assert con.execute(sql).fetchall()
    for table in needs:
        con.execute(f"BEGIN; DELETE FROM {table}")
        assert not con.execute(sql).fetchall()
        con.execute("ROLLBACK")


OCCASIONS = {
    "WITH p AS (FROM a) FROM p": "p",
    "WITH p AS (FROM a), q AS (FROM b) FROM p UNION ALL FROM q": "p q",
    "WITH p AS (FROM a), q AS (SELECT * FROM p LEFT JOIN b USING (x)) SELECT x, count(*) AS n FROM q GROUP BY x": "p",
    "WITH p AS (FROM a) FROM b SEMI JOIN p USING (x)": "p",
}
NO_OCCASIONS = {
    "WITH p AS (FROM a), q AS (FROM b) FROM p UNION ALL FROM q": "p",
    "WITH p AS (FROM a) FROM b LEFT JOIN p USING (x)": "p",
    "WITH p AS (FROM a) SELECT count(*) FROM p": "p",
    "WITH p AS (FROM a) SELECT x FROM b WHERE NOT EXISTS (FROM p)": "p",
    "WITH p AS (FROM a) SELECT * FROM (WITH p AS (FROM b) FROM p) JOIN a USING (x)": "p",
    "WITH p AS (FROM a) FROM main.b": "p",
    "FROM a": "p",
}


@pytest.mark.parametrize("sql", OCCASIONS)
def test_a_select_has_no_rows_without_those_of_its_occasion(con: duckdb.DuckDBPyConnection, sql: str) -> None:
    ctes = OCCASIONS[sql].split()
    assert syntax.has_no_rows_without(syntax.parse_select(sql, "here"), frozenset(ctes))
    assert con.execute(sql).fetchall()
    for cte in ctes:
        sql = re.sub(rf"{cte} AS \((.*?)\)", rf"{cte} AS (SELECT * FROM (\1) WHERE false)", sql, count=1)
    assert not con.execute(sql).fetchall()


@pytest.mark.parametrize("sql", NO_OCCASIONS)
def test_a_cte_without_which_there_may_be_rows_is_no_occasion(sql: str) -> None:
    assert not syntax.has_no_rows_without(syntax.parse_select(sql, "here"), frozenset(NO_OCCASIONS[sql].split()))


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
