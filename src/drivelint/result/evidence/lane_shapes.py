"""Gathers the simplified shapes of lanes near scenes into `lane_shape`, each lane once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import shapely

from drivelint.sql import store

if TYPE_CHECKING:
    import duckdb
    from numpy.typing import NDArray

SIMPLIFY_TOLERANCE_M: Final = 0.1

# lanelets near a scene whose shape is not yet kept
_NEW: Final = """
CREATE OR REPLACE TEMP TABLE _near AS
SELECT DISTINCT s.environment_id, s.lanelet_id
FROM (SELECT environment_id, unnest(lanelets) AS lanelet_id FROM scene WHERE environment_id IS NOT NULL) s
ANTI JOIN lane_shape k USING (environment_id, lanelet_id)
"""

_LANES: Final = """
WITH share AS (
    SELECT environment_id, lanelet_id, side, marking, sum(to_picometres(s_end_m - s_start_m)) AS m
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
    """Add the shapes of lanes near scenes that are not in `lane_shape` yet."""
    con.execute(_NEW)
    lanes = con.execute(_LANES).to_arrow_table()
    if lanes.num_rows:
        points = con.execute(_POINTS).fetchnumpy()
        for side in ("left", "right"):
            for axis, values in zip("xy", _simplified(points, side, lanes.num_rows), strict=True):
                lanes = lanes.append_column(f"{side}_{axis}_m", values)
        store.insert(con, "lane_shape", lanes)


def _simplified(points: dict[str, NDArray[np.float64]], side: str, n: int) -> tuple[pa.ListArray, pa.ListArray]:
    """Return the x and y of `n` bounds as lists in centimetres, with only the points that keep them true."""
    xy = np.column_stack([points[f"{side}_x_m"], points[f"{side}_y_m"]])
    lines = shapely.linestrings(xy, indices=points["lane"].astype(np.intp))
    kept, index = shapely.get_coordinates(shapely.simplify(lines, SIMPLIFY_TOLERANCE_M), return_index=True)
    offsets = pa.array(np.searchsorted(index, np.arange(n + 1)), pa.int32())
    x, y = np.round(kept, 2).T
    return pa.ListArray.from_arrays(offsets, pa.array(x)), pa.ListArray.from_arrays(offsets, pa.array(y))
