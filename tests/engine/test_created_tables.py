"""Tables that are created when they are filled: they refuse NULL as an INSERT does, and a batch that was interrupted leaves no obstacle."""

from __future__ import annotations

import duckdb
import pytest

from drivelint.sql import store


@pytest.mark.ci
def test_null_in_a_column_that_is_declared_not_null_is_an_error() -> None:
    select = """
        SELECT 'd' AS drive_id, 'e' AS ego_id, no::BIGINT AS t_ns, CASE WHEN no < 2 THEN 'engaged' END AS mode, NULL AS is_on
        FROM range(3) AS r(no)"""
    with store.connect() as con:
        with pytest.raises(duckdb.Error, match=r"NOT NULL constraint failed: ego_mode\.mode"):
            store.create_from_select(con, "ego_mode", select, {})
        assert store.create_from_select(con, "ego_mode", f"{select} WHERE no < 2", {}) == 2


@pytest.mark.ci
@pytest.mark.parametrize("left", [["drive_ids_1"], ["actor_ids_1"], ["drive_ids_1", "actor_ids_1", "drive_ids_2"]])
def test_types_that_an_interrupted_batch_left_do_not_stop_the_next(left: list[str]) -> None:
    made = "SELECT type_name FROM duckdb_types() WHERE contains(type_name, '_ids_')"
    with store.connect() as con:
        for name in left:
            con.execute(f"CREATE TYPE {name} AS ENUM ('old')")
        for no in range(2):
            store.recreate_with_enums(con, ["ego_mode"], [f"drive {no}"], ["e"])
            con.execute(f"INSERT INTO ego_mode VALUES ('drive {no}', 'e', 0, 'engaged', NULL)")
        assert len(con.execute(made).fetchall()) == 2
