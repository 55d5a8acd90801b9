"""Evidence for pictures: who was where around the worst step of every finding and near miss, and the lanes there.

Taken from the database while a batch is in it, into the tables `scene` and `lane_shape`, which stay until the end of the run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import shapely

from drivelint import store
from drivelint.report.contract import conform

if TYPE_CHECKING:
    import duckdb
    from numpy.typing import NDArray

PATH_S: Final = 5.0
"""How long before and after the moment the ways are kept."""
PATH_STEP_NS: Final = 200_000_000
"""A way has at most one point in so long."""
REACH_M: Final = (60.0, 300.0)
"""Least and largest reach of a scene around the ego."""
PER_RULE: Final = 20
"""Scenes per ego, rule and profile: those with the worst margins."""
_TRUE_TO_M: Final = 0.1

_MOMENTS: Final = """
CREATE OR REPLACE TEMP TABLE _moment AS
WITH told AS (
    SELECT drive_id, ego_id, rule_id, profile, object_id, t_worst_ns AS t_ns, margin, 0 AS weight FROM finding
    UNION ALL
    SELECT drive_id, ego_id, rule_id, profile, object_id, t_worst_ns, margin, 1 FROM verdict WHERE near_miss
),
worst AS (
    SELECT t.drive_id, t.ego_id, t.t_ns, t.object_id
    FROM told t
    SEMI JOIN ego_state e ON e.drive_id = t.drive_id AND e.ego_id = t.ego_id AND e.t_ns = t.t_ns AND e.x_m IS NOT NULL AND e.y_m IS NOT NULL
    QUALIFY row_number() OVER (
        PARTITION BY t.drive_id, t.ego_id, t.rule_id, t.profile, t.weight ORDER BY t.margin NULLS FIRST, t.t_ns, t.object_id
    ) <= $per_rule
),
seen AS (
    SELECT w.drive_id, w.ego_id, w.t_ns, max(p.distance_m) AS far_m FROM worst w
    LEFT JOIN pair p ON p.drive_id = w.drive_id AND p.ego_id = w.ego_id AND p.t_ns = w.t_ns AND p.object_id = w.object_id
    GROUP BY ALL
)
SELECT s.drive_id, s.ego_id, s.t_ns, l.environment_id, e.x_m, e.y_m,
    least(greatest(coalesce(s.far_m, 0.0) + 30.0, $least_m), $most_m) AS reach_m
FROM seen s
JOIN ego_state e USING (drive_id, ego_id, t_ns)
JOIN data_log l USING (drive_id)
"""

_SCENES: Final = """
WITH around AS (  -- every ego step near a moment, thinned
    SELECT m.drive_id, m.ego_id, m.t_ns AS at_ns, e.t_ns
    FROM _moment m
    JOIN ego_state e ON e.drive_id = m.drive_id AND e.ego_id = m.ego_id AND e.t_ns >= m.t_ns - $path_ns AND e.t_ns <= m.t_ns + $path_ns
    QUALIFY e.t_ns = m.t_ns OR row_number() OVER (
        PARTITION BY m.drive_id, m.ego_id, m.t_ns, (e.t_ns - m.t_ns + $path_ns) // $step_ns ORDER BY e.t_ns
    ) = 1
),
state AS (
    SELECT drive_id, ego_id, t_ns, ego_id AS actor_id, x_m, y_m, yaw_rad FROM ego_state
    UNION ALL
    SELECT drive_id, ego_id, t_ns, object_id, x_m, y_m, yaw_rad FROM pair
),
present AS (
    SELECT m.drive_id, m.ego_id, m.t_ns, m.ego_id AS actor_id, a.actor_class, e.length_m, e.width_m, e.x_m, e.y_m, e.yaw_rad, e.speed_mps
    FROM _moment m
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN actor a ON a.drive_id = m.drive_id AND a.actor_id = m.ego_id
    UNION ALL BY NAME
    SELECT m.drive_id, m.ego_id, m.t_ns, p.object_id AS actor_id, p.actor_class, p.length_m, p.width_m, p.x_m, p.y_m, p.yaw_rad, p.speed_mps
    FROM _moment m
    JOIN pair p USING (drive_id, ego_id, t_ns)
    WHERE p.x_m IS NOT NULL AND p.y_m IS NOT NULL AND p.distance_m <= m.reach_m
),
way AS (
    SELECT a.drive_id, a.ego_id, a.at_ns AS t_ns, s.actor_id,
        list({'t_ns': a.t_ns, 'x_m': round(s.x_m, 2), 'y_m': round(s.y_m, 2), 'yaw_rad': round(s.yaw_rad, 3)} ORDER BY a.t_ns) AS path
    FROM around a
    JOIN state s ON s.drive_id = a.drive_id AND s.ego_id = a.ego_id AND s.t_ns = a.t_ns AND s.x_m IS NOT NULL AND s.y_m IS NOT NULL
    GROUP BY ALL
),
cast_ AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, list({
            'actor_id': p.actor_id, 'actor_class': p.actor_class, 'length_m': p.length_m, 'width_m': p.width_m,
            'x_m': round(p.x_m, 3), 'y_m': round(p.y_m, 3), 'yaw_rad': round(p.yaw_rad, 4),
            'speed_mps': round(p.speed_mps, 3), 'path': w.path
        } ORDER BY p.actor_id <> p.ego_id, p.actor_id) AS actors
    FROM present p
    LEFT JOIN way w USING (drive_id, ego_id, t_ns, actor_id)
    GROUP BY ALL
),
-- danger spaces in corridor coordinates, as the runtime assertions have them
extent AS (
    SELECT DISTINCT m.drive_id, m.ego_id, m.t_ns, m.environment_id, e.chain_id, m.ego_id AS actor_id, o.sd_av_m AS length_m,
        e.front_s_m AS s0, e.front_s_m + o.sd_av_m AS s1, o.ds_av_d_m AS d_m, o.ds_av_half_m AS half_m
    FROM _moment m
    JOIN overtake_step o USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    UNION
    SELECT DISTINCT m.drive_id, m.ego_id, m.t_ns, m.environment_id, e.chain_id, p.object_id, o.sd_ov_m,
        p.rear_s_m - o.sd_ov_m, p.rear_s_m, o.ds_ov_d_m, o.ds_ov_half_m
    FROM _moment m
    JOIN overtake_step o USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN pair p ON p.drive_id = m.drive_id AND p.ego_id = m.ego_id AND p.t_ns = m.t_ns AND p.object_id = o.ov_id
),
piece AS (  -- the corridor's segments under a danger space, cut at its ends
    SELECT x.*, c.s_start_m + g.s0_m AS at_m, g.len_m, g.x0_m, g.y0_m, g.x1_m, g.y1_m, g.tx0, g.ty0, g.tx1, g.ty1,
        greatest(0.0, (x.s0 - c.s_start_m - g.s0_m) / g.len_m) AS u0, least(1.0, (x.s1 - c.s_start_m - g.s0_m) / g.len_m) AS u1
    FROM extent x
    JOIN chain c ON c.drive_id = x.drive_id AND c.ego_id = x.ego_id AND c.chain_id = x.chain_id
    JOIN lane_segment g ON g.environment_id = x.environment_id AND g.lanelet_id = c.lanelet_id
    WHERE x.length_m > 0 AND g.len_m > 0 AND x.half_m IS NOT NULL
        AND c.s_start_m + g.s0_m < x.s1 AND c.s_start_m + g.s0_m + g.len_m > x.s0
),
edge AS (
    SELECT DISTINCT drive_id, ego_id, t_ns, actor_id, length_m, d_m, half_m, round(at_m + u * len_m, 2) AS s_m,
        first(x0_m + u * (x1_m - x0_m) ORDER BY at_m) AS x_m, first(y0_m + u * (y1_m - y0_m) ORDER BY at_m) AS y_m,
        first(tx0 + u * (tx1 - tx0) ORDER BY at_m) AS tx, first(ty0 + u * (ty1 - ty0) ORDER BY at_m) AS ty
    FROM (SELECT *, unnest([u0, u1]) AS u FROM piece)
    GROUP BY ALL
),
side AS (
    SELECT drive_id, ego_id, t_ns, actor_id, length_m, s_m,
        [round(x_m - ty * (d_m + half_m), 2), round(y_m + tx * (d_m + half_m), 2)] AS l,
        [round(x_m - ty * (d_m - half_m), 2), round(y_m + tx * (d_m - half_m), 2)] AS r
    FROM edge
),
ring AS (
    SELECT drive_id, ego_id, t_ns, actor_id, length_m, list_concat(list(l ORDER BY s_m), list(r ORDER BY s_m DESC)) AS p
    FROM side GROUP BY ALL HAVING count(*) > 1
),
rings AS (
    SELECT drive_id, ego_id, t_ns, list({
            'actor_id': actor_id, 'length_m': round(length_m, 3), 'x_m': [q[1] FOR q IN p], 'y_m': [q[2] FOR q IN p]
        } ORDER BY actor_id <> ego_id, actor_id) AS spaces
    FROM ring GROUP BY ALL
),
extents AS (
    SELECT environment_id, lanelet_id, min(least(left_x_m, right_x_m)) AS x0, max(greatest(left_x_m, right_x_m)) AS x1,
        min(least(left_y_m, right_y_m)) AS y0, max(greatest(left_y_m, right_y_m)) AS y1
    FROM lane_point GROUP BY ALL
),
near AS (
    SELECT m.drive_id, m.ego_id, m.t_ns, list(b.lanelet_id ORDER BY b.lanelet_id) AS lanelets
    FROM _moment m
    JOIN extents b ON b.environment_id = m.environment_id AND b.x0 <= m.x_m + m.reach_m AND b.x1 >= m.x_m - m.reach_m
        AND b.y0 <= m.y_m + m.reach_m AND b.y1 >= m.y_m - m.reach_m
    GROUP BY ALL
)
INSERT INTO scene BY NAME
SELECT m.drive_id, m.ego_id, m.t_ns, m.environment_id, round(m.reach_m, 1) AS reach_m, coalesce(n.lanelets, []) AS lanelets, c.actors,
    coalesce(r.spaces, []) AS spaces
FROM _moment m
JOIN cast_ c USING (drive_id, ego_id, t_ns)
LEFT JOIN near n USING (drive_id, ego_id, t_ns)
LEFT JOIN rings r USING (drive_id, ego_id, t_ns)
"""

# lanelets near a scene whose shape is not yet kept
_NEW: Final = """
CREATE OR REPLACE TEMP TABLE _near AS
SELECT DISTINCT s.environment_id, s.lanelet_id
FROM (SELECT environment_id, unnest(lanelets) AS lanelet_id FROM scene WHERE environment_id IS NOT NULL) s
ANTI JOIN lane_shape k USING (environment_id, lanelet_id)
"""

_LANES: Final = """
WITH share AS (
    SELECT environment_id, lanelet_id, side, marking, sum(s_end_m - s_start_m) AS m
    FROM lane_boundary SEMI JOIN _near USING (environment_id, lanelet_id) GROUP BY ALL
),
mark AS (
    SELECT environment_id, lanelet_id, first(marking ORDER BY m DESC, marking) FILTER (side = 'left') AS left_marking,
        first(marking ORDER BY m DESC, marking) FILTER (side = 'right') AS right_marking
    FROM share GROUP BY ALL
)
SELECT n.environment_id, n.lanelet_id, n.lane_type, n.drivable, n.junction_id IS NOT NULL AS in_junction, m.left_marking, m.right_marking
FROM lanelet n SEMI JOIN _near USING (environment_id, lanelet_id)
LEFT JOIN mark m USING (environment_id, lanelet_id)
ORDER BY n.environment_id, n.lanelet_id
"""

_POINTS: Final = """
SELECT dense_rank() OVER (ORDER BY environment_id, lanelet_id) - 1 AS lane, left_x_m, left_y_m, right_x_m, right_y_m
FROM lane_point SEMI JOIN _near USING (environment_id, lanelet_id)
ORDER BY environment_id, lanelet_id, k
"""


def gather(con: duckdb.DuckDBPyConnection) -> None:
    """Add the evidence of the batch that was just judged to `scene` and `lane_shape`.

    Reads `finding` and `verdict` (of which those of this batch have their states in `ego_state` and `pair`).
    """
    least, most = REACH_M
    con.execute(_MOMENTS, {"per_rule": PER_RULE, "least_m": least, "most_m": most})
    con.execute(_SCENES, {"path_ns": int(PATH_S * 1e9), "step_ns": PATH_STEP_NS})
    con.execute(_NEW)
    lanes = con.execute(_LANES).to_arrow_table()
    if lanes.num_rows:
        points = con.execute(_POINTS).fetchnumpy()
        for side in ("left", "right"):
            for axis, values in zip("xy", _simplified(points, side, lanes.num_rows), strict=True):
                lanes = lanes.append_column(f"{side}_{axis}_m", values)
        store.insert(con, "lane_shape", lanes)


def scenes(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the table `scene`, totally ordered."""
    return conform(con.execute("SELECT * FROM scene ORDER BY drive_id, ego_id, t_ns").to_arrow_table(), "scene")


def lanes(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the table `lane_shape`, totally ordered."""
    rows = con.execute("SELECT * FROM lane_shape ORDER BY environment_id, lanelet_id")
    return conform(rows.to_arrow_table(), "lane_shape")


def _simplified(points: dict[str, NDArray[np.float64]], side: str, n: int) -> tuple[pa.ListArray, pa.ListArray]:
    """Return the x and y of `n` bounds as lists in centimetres, with only the points that keep them true."""
    xy = np.column_stack([points[f"{side}_x_m"], points[f"{side}_y_m"]])
    lines = shapely.linestrings(xy, indices=points["lane"].astype(np.intp))
    kept, index = shapely.get_coordinates(shapely.simplify(lines, _TRUE_TO_M), return_index=True)
    offsets = pa.array(np.searchsorted(index, np.arange(n + 1)), pa.int32())
    x, y = np.round(kept, 2).T
    return pa.ListArray.from_arrays(offsets, pa.array(x)), pa.ListArray.from_arrays(offsets, pa.array(y))
