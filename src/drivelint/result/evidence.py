"""Evidence for pictures and charts, taken from the database while a batch is in it, into tables that stay until the end of the run.

Scenes of findings and near misses with lanes and danger spaces; tracks; overtakes and opportunities. (Courses are the evaluation's.)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import shapely

from drivelint.reasons.reason_table import make_reason_table
from drivelint.result.schemas import TABLE_OF_FILE
from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import duckdb
    from numpy.typing import NDArray

_KEYS: Final = {
    "scenes": "drive_id, ego_id, t_ns",
    "lanes": "environment_id, lanelet_id",
    "spaces": "drive_id, ego_id, t_ns, actor_id <> ego_id, actor_id",
    "courses": "finding_id IS NULL, finding_id, drive_id, ego_id, rule_id, profile, object_id, occurrence",
    "tracks": "drive_id, NOT is_ego, actor_id, part",
    "overtakes": "drive_id, ego_id, occurrence",
    "opportunities": "drive_id, ego_id, occurrence, style, profile",
}
"""Table of evidence in a result -> the order of its rows."""
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
SIMPLIFY_TOLERANCE_M: Final = 0.1


def gather(con: duckdb.DuckDBPyConnection) -> None:
    """Add the evidence of the batch that was just judged.

    Reads `finding` and `verdict` (of which those of this batch have their states in `ego_state` and `pair`).
    """
    _scenes(con)
    _lane_shapes(con)
    con.execute(statement("evidence/track"), {"step_ns": PATH_STEP_NS})
    make_reason_table(con, "SELECT NULL AS rule_no, reason AS cause, 0 AS start_ns FROM overtake_sda")
    con.execute(statement("evidence/overtake_record"))
    con.execute(statement("evidence/opportunity_record"))


def tables(con: duckdb.DuckDBPyConnection) -> dict[str, pa.Table]:
    """Return the tables of evidence under the names that `Result` has for them, totally ordered."""
    return {
        name: con.execute(f"SELECT * FROM {TABLE_OF_FILE[name]} ORDER BY {keys}").to_arrow_table()
        for name, keys in _KEYS.items()
    }


def _scenes(con: duckdb.DuckDBPyConnection) -> None:
    """Add the scenes of the batch that was just judged, and the danger spaces in them."""
    least, most = REACH_M
    con.execute(statement("evidence/every_moment"), {"per_rule": SCENES_PER_RULE, "least_m": least, "most_m": most})
    counts = con.execute("SELECT ego_no, count(*) FROM _every_moment GROUP BY ego_no ORDER BY ego_no").fetchall()
    for first, end in _some(counts):
        con.execute(statement("evidence/moment"), {"first_no": first, "end_no": end})
        con.execute(statement("evidence/around"), {"path_ns": int(PATH_S * 1e9), "step_ns": PATH_STEP_NS})
        con.execute(statement("evidence/scene"))
        edges = con.execute(statement("evidence/danger_space_edge")).to_arrow_table()
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


def _lane_shapes(con: duckdb.DuckDBPyConnection) -> None:
    """Add the shapes of lanes near scenes that are not in `lane_shape` yet."""
    con.execute(statement("evidence/near_lane"))
    lanes = con.execute(statement("evidence/lane")).to_arrow_table()
    if lanes.num_rows:
        points = con.execute(statement("evidence/lane_point")).fetchnumpy()
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
