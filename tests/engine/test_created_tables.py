"""Tables that are created when they are filled: they refuse NULL as an INSERT does, and a batch that was interrupted leaves no obstacle."""

from __future__ import annotations

import duckdb
import pytest

from drivelint.sql import store


@pytest.mark.ci
def test_null_in_a_column_that_is_declared_not_null_is_an_error() -> None:
    select = """
        SELECT 'd' AS drive_id, 'e' AS ego_id, no::BIGINT AS t_ns, 'a' AS lanelet_id, CASE WHEN no < 2 THEN 'border' END AS lane_type,
            NULL AS road_type, 0.0 AS off_m, NULL AS with_direction
        FROM range(3) AS r(no)"""
    with store.connect() as con:
        with pytest.raises(duckdb.Error, match=r"NOT NULL constraint failed: ego_aside\.lane_type"):
            store.create_from_select(con, "ego_aside", select, {})
        assert store.create_from_select(con, "ego_aside", f"{select} WHERE no < 2", {}) == 2


@pytest.mark.ci
@pytest.mark.parametrize("left", [["drive_ids_1"], ["actor_ids_1"], ["drive_ids_1", "actor_ids_1", "drive_ids_2"]])
def test_types_that_an_interrupted_batch_left_do_not_stop_the_next(left: list[str]) -> None:
    made = "SELECT type_name FROM duckdb_types() WHERE contains(type_name, '_ids_')"
    with store.connect() as con:
        for name in left:
            con.execute(f"CREATE TYPE {name} AS ENUM ('old')")
        for no in range(2):
            store.recreate_with_enums(con, ["ego_aside"], [f"drive {no}"], ["e"])
            con.execute(f"INSERT INTO ego_aside VALUES ('drive {no}', 'e', 0, 'a', 'border', NULL, 0.0, NULL)")
        assert len(con.execute(made).fetchall()) == 2
