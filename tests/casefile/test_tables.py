"""Cases of library tables, and mutants of their SELECTs."""

from __future__ import annotations

import duckdb
import pytest

from drivelint.casefile.merged_cases import NumberedCase, merge_cases
from drivelint.casefile.mutants import mutants_of_select
from drivelint.casefile.table_cases import rows_difference
from drivelint.casefile.table_mutation import judge_table_mutants
from drivelint.sql.declarations import column_types
from drivelint.sql.library import library_tables

LANE_BESIDE = """
SELECT n.lanelet_id, count(b.marking) AS n
FROM lanelet n
CROSS JOIN (VALUES ('left'), ('right')) AS v(side)
JOIN lanelet m ON m.lanelet_id = CASE v.side WHEN 'left' THEN n.left_id ELSE n.right_id END
LEFT JOIN lane_boundary b ON b.lanelet_id = n.lanelet_id AND b.side = v.side
WHERE n.width_m < 4
GROUP BY ALL
"""


def test_a_mutant_of_a_select_with_a_cross_join_is_valid_sql() -> None:
    con = duckdb.connect()
    con.execute("CREATE TABLE lanelet AS SELECT 'a' AS lanelet_id, 'b' AS left_id, 'c' AS right_id, 3.5 AS width_m")
    con.execute("CREATE TABLE lane_boundary AS SELECT 'a' AS lanelet_id, 'left' AS side, 'solid' AS marking")
    (turned, _), _, _ = found = mutants_of_select(LANE_BESIDE)
    assert turned == "turned: n.width_m < 4"
    for _, select in found:
        con.execute(f"EXPLAIN {select}")


def test_a_reason_may_be_expected_as_a_mapping() -> None:
    row = {
        "drive_id": "d",
        "reason": '{"code":"others_fit","args":{"trouble":"{\\"code\\":\\"seldom_on_lane\\"}","n_fit":1}}',
    }
    for reason, same in (
        ({"code": "others_fit"}, True),
        ({"args": {"trouble": {"code": "seldom_on_lane"}, "n_fit": 1}}, True),
        ({"args": {"n_fit": 2}}, False),
        ({"args": {"trouble": {"code": "on_lane"}}}, False),
        ({"code": {"code": "others_fit"}}, False),
    ):
        assert (rows_difference("registration", [{"reason": reason}], [row]) == "") is same


@pytest.mark.parametrize("places", [(186.0, 285.0), (285.0, 186.0)])
def test_rows_with_the_same_ids_are_compared_in_no_order(places: tuple[float, float]) -> None:
    """A SELECT returns them in the order in which its threads end."""
    columns = {"drive_id": "d", "ego_id": "e", "chain_id": 1, "kind": "stop_line", "mark_id": "l"}
    rows = [{**dict.fromkeys(column_types()["way_mark"], "x"), **columns, "s_start_m": place} for place in places]
    wanted = [columns, {**columns, "s_start_m": 285}]
    assert rows_difference("way_mark", wanted, rows) == ""
    assert "expected s_start_m: 285" in rows_difference("way_mark", wanted, [rows[0] | {"s_start_m": 186.0}] * 2)


def test_a_case_with_an_empty_table_leaves_the_rows_of_the_other_cases() -> None:
    with_row = NumberedCase(0, {"pair": [{"drive_id": "d", "ego_id": "e", "t_ns": 0}]}, {})
    without = NumberedCase(1, {"pair": []}, {})
    row = {"drive_id": "0:d", "ego_id": "e", "t_ns": 0}
    assert (
        merge_cases([with_row, without], "drive_id") == merge_cases([without, with_row], "drive_id") == {"pair": [row]}
    )


def test_a_mutant_that_fails_on_the_rows_of_a_case_is_noticed() -> None:
    """The squares of `step` with another exponent are no numbers where a difference is negative."""
    step = library_tables()["step"]
    judged = judge_table_mutants(step)
    assert (judged.n, judged.survivors) == (len(mutants_of_select(step.select)), ())


def test_a_geometry_is_expected_as_text_wherever_its_outline_begins() -> None:
    row = {"geom": "POLYGON ((0 0, 2 0, 2 2, 0 2, 0 0))"}
    for geom, same in (
        ("POLYGON ((2 2, 0 2, 0 0, 2 0, 2 2))", True),
        ("POLYGON ((0 0, 2 0, 2 2, 0 0))", False),
        (None, False),
    ):
        assert (rows_difference("junction_area", [{"geom": geom}], [row]) == "") is same
    assert rows_difference("junction_area", [{"geom": None}], [{"geom": None}]) == ""


def test_a_number_in_quotes_has_the_decimals_of_its_zeros() -> None:
    row = {"slack0_m": 0.045}
    for slack, same in ((0.05, True), ("0.050", False), ("0.045", True), ("none", False)):
        assert (rows_difference("_lane_segment", [{"slack0_m": slack}], [row]) == "") is same
