"""Gathers the actors around the worst step of every finding and near miss: `scene` and `danger_space`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import shapely

from drivelint.result.evidence.lane_shapes import SIMPLIFY_TOLERANCE_M
from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import duckdb
    from numpy.typing import NDArray

PATH_S: Final = 5.0
"""How long before and after the moment the ways are kept."""
PATH_STEP_NS: Final = 200_000_000
"""A way has at most one point in so long."""
REACH_M: Final = (60.0, 300.0)
"""Least and largest reach of a scene around the ego."""
SCENES_AT_ONCE: Final = 400
"""Moments whose scenes are made at once: their ways are lists, which the database holds in memory."""
SCENES_PER_RULE: Final = 20
"""Scenes per ego, rule and profile: those with the worst margins."""

_MOMENTS: Final = """
CREATE OR REPLACE TEMP TABLE _every_moment AS
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
    least(greatest(coalesce(s.far_m, 0.0) + 30.0, $least_m), $most_m) AS reach_m,
    dense_rank() OVER (ORDER BY s.drive_id, s.ego_id) AS ego_no
FROM seen s
JOIN ego_state e USING (drive_id, ego_id, t_ns)
JOIN data_log l USING (drive_id)
"""

_SOME: Final = """
CREATE OR REPLACE TEMP TABLE _moment AS SELECT * EXCLUDE (ego_no) FROM _every_moment WHERE ego_no >= ? AND ego_no < ?
"""

_AROUND: Final = """
CREATE OR REPLACE TEMP TABLE _around AS  -- every ego step near a moment, thinned alike for all moments
SELECT m.drive_id, m.ego_id, m.t_ns AS at_ns, e.t_ns
FROM _moment m
JOIN ego_state e ON e.drive_id = m.drive_id AND e.ego_id = m.ego_id AND e.t_ns >= m.t_ns - $path_ns AND e.t_ns <= m.t_ns + $path_ns
QUALIFY e.t_ns = m.t_ns OR row_number() OVER (
    PARTITION BY m.drive_id, m.ego_id, m.t_ns, e.t_ns // $step_ns ORDER BY e.t_ns
) = 1
"""

_SCENES: Final = """
WITH state AS (
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
    FROM _around a
    JOIN present p ON p.drive_id = a.drive_id AND p.ego_id = a.ego_id AND p.t_ns = a.at_ns  -- the others are not drawn
    JOIN state s ON s.drive_id = a.drive_id AND s.ego_id = a.ego_id AND s.t_ns = a.t_ns AND s.actor_id = p.actor_id
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL
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
SELECT m.drive_id, m.ego_id, m.t_ns, m.environment_id, round(m.reach_m, 1) AS reach_m, coalesce(n.lanelets, []) AS lanelets, c.actors
FROM _moment m
JOIN cast_ c USING (drive_id, ego_id, t_ns)
LEFT JOIN near n USING (drive_id, ego_id, t_ns)
"""

_SPACES: Final = """
WITH frame AS (
    SELECT DISTINCT a.drive_id, a.ego_id, a.t_ns, l.environment_id FROM _around a JOIN data_log l USING (drive_id)
),
extent AS (
    SELECT DISTINCT m.drive_id, m.ego_id, m.t_ns, m.environment_id, e.chain_id, m.ego_id AS actor_id, o.sd_av_m AS length_m,
        o.ds_av_s_m AS s0, o.ds_av_s_m + o.sd_av_m AS s1, o.ds_av_d_m AS d_m, o.ds_av_half_m AS half_m
    FROM frame m
    JOIN overtake_step o USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    UNION
    SELECT DISTINCT m.drive_id, m.ego_id, m.t_ns, m.environment_id, e.chain_id, o.ov_id, o.sd_ov_m,
        o.ds_ov_s_m - o.sd_ov_m, o.ds_ov_s_m, o.ds_ov_d_m, o.ds_ov_half_m
    FROM frame m
    JOIN overtake_step o USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE o.ov_id IS NOT NULL
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
)
SELECT drive_id, ego_id, actor_id, t_ns, round(length_m, 3) AS length_m,
    x_m - ty * (d_m + half_m) AS lx_m, y_m + tx * (d_m + half_m) AS ly_m,
    x_m - ty * (d_m - half_m) AS rx_m, y_m + tx * (d_m - half_m) AS ry_m,
    dense_rank() OVER (ORDER BY drive_id, ego_id, t_ns, actor_id) AS ring
FROM edge
QUALIFY count(*) OVER (PARTITION BY drive_id, ego_id, t_ns, actor_id) > 1
ORDER BY ring, s_m
"""


def gather(con: duckdb.DuckDBPyConnection) -> None:
    """Add the scenes of the batch that was just judged, and the danger spaces in them."""
    least, most = REACH_M
    con.execute(_MOMENTS, {"per_rule": SCENES_PER_RULE, "least_m": least, "most_m": most})
    counts = con.execute("SELECT ego_no, count(*) FROM _every_moment GROUP BY ego_no ORDER BY ego_no").fetchall()
    for first, end in _some(counts):
        con.execute(_SOME, [first, end])
        con.execute(_AROUND, {"path_ns": int(PATH_S * 1e9), "step_ns": PATH_STEP_NS})
        con.execute(_SCENES)
        edges = con.execute(_SPACES).to_arrow_table()
        if edges.num_rows:
            store.insert(con, "danger_space", _rings(edges))


def _some(counts: Sequence[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Cut egos, given with their numbers of moments, into runs [first, end) of at most `SCENES_AT_ONCE` moments or one ego."""
    first, n = 1, 0
    for ego, moments in counts:
        if n and n + moments > SCENES_AT_ONCE:
            yield first, ego
            first, n = ego, 0
        n += moments
    if n:
        yield first, len(counts) + 1


def _rings(edges: pa.Table) -> pa.Table:
    """Return a danger space per ring: its edges' left points forth and right points back, without those that add nothing."""
    _, first, ring = np.unique(edges["ring"].to_numpy(), return_index=True, return_inverse=True)
    sides: list[NDArray[np.object_]] = []
    for side in ("l", "r"):
        points = np.column_stack([edges[f"{side}x_m"], edges[f"{side}y_m"]])
        lines = np.asarray(shapely.simplify(shapely.linestrings(points, indices=ring), SIMPLIFY_TOLERANCE_M))
        sides.append(lines if side == "l" else np.asarray(shapely.reverse(lines)))
    points, index = shapely.get_coordinates(np.column_stack(sides).ravel(), return_index=True)
    x, y = np.round(points, 2).T
    offsets = pa.array(np.searchsorted(index // 2, np.arange(len(first) + 1)), pa.int32())
    rows = edges.select(["drive_id", "ego_id", "t_ns", "actor_id", "length_m"]).take(pa.array(first))
    for name, values in (("x_m", x), ("y_m", y)):
        rows = rows.append_column(name, pa.ListArray.from_arrays(offsets, pa.array(values)))
    return rows
