"""Errors of a query suggest no table of DuckDB itself."""

from __future__ import annotations

import duckdb
import pytest

from drivelint.sql.internal_names import without_internal_names


@pytest.mark.ci
@pytest.mark.parametrize(("name", "suggested"), [("actor_state", None), ("finding", "findings")])
def test_a_suggestion_is_a_table_of_the_result(name: str, suggested: str | None) -> None:
    with duckdb.connect() as con:
        con.execute("CREATE TABLE findings (n INTEGER)")
        with pytest.raises(duckdb.CatalogException) as refused:
            con.execute(f"SELECT * FROM {name}")
    told = without_internal_names(str(refused.value))
    assert f"Table with name {name} does not exist!" in told
    assert "pg_" not in told
    assert ("Did you mean" in told) is (suggested is not None)
    assert suggested is None or f'"{suggested}"' in told


@pytest.mark.ci
@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("actor_state", "actor_state is in the log: drivelint convert LOG --to parquet writes it"),
        ("chain", "chain is kept only by drivelint check --keep-db."),
        ("nothing_of_ours", None),
    ],
)
def test_a_table_that_a_result_lacks_is_said_to_be_elsewhere(name: str, place: str | None) -> None:
    with duckdb.connect() as con, pytest.raises(duckdb.CatalogException) as refused:
        con.execute(f"SELECT * FROM {name}")
    told = without_internal_names(str(refused.value))
    assert place is None or place in told
    assert ("--" in told) is (place is not None)
