"""Mutants of the SELECTs of library tables."""

from __future__ import annotations

import duckdb

from drivelint.casefile.mutants import mutants_of_select

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
