"""Evidence for pictures and charts, taken from the database while a batch is in it, into tables that stay until the end of the run.

Scenes of findings and near misses with lanes and danger spaces; tracks; overtakes and opportunities. (Courses are the evaluation's.)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa
import shapely

from drivelint.reasons.reason_table import make_reason_table
from drivelint.result.names import TABLE_OF_FILE
from drivelint.result.schemas import conform, empty_table
from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import duckdb
    from numpy.typing import NDArray

    from drivelint.road.map_reader import MapTables

ORDER: Final = {
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
"""The time before and after the moment for which paths are kept."""
PATH_STEP_NS: Final = 200_000_000
"""A path has at most one point per time step of this length."""
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
        for name, keys in ORDER.items()
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
    left, right = (_simplified(edges[f"{side}x_m"], edges[f"{side}y_m"], ring) for side in "lr")
    x, y = _coordinates(np.column_stack([left, shapely.reverse(right)]), len(first))
    rows = edges.select(["drive_id", "ego_id", "t_ns", "actor_id", "length_m"]).take(pa.array(first))
    return rows.append_column("x_m", x).append_column("y_m", y)


def _lane_shapes(con: duckdb.DuckDBPyConnection) -> None:
    """Add the shapes of lanes near scenes that are not in `lane_shape` yet."""
    con.execute(statement("evidence/near_lane"))
    store.insert(con, "lane_shape", _shapes_of_near(con))


def lanes_of_map(environment: MapTables) -> pa.Table:
    """Return the table `lane_shape` of every lane of a map, totally ordered."""
    with store.workspace(None) as con:
        for table in ("lanelet", "lane_boundary", "lane_point"):
            store.insert(con, table, environment.tables[table])
        con.execute("CREATE TEMP TABLE _near AS SELECT environment_id, lanelet_id FROM lanelet")
        return conform(_shapes_of_near(con), "lane_shape")


def _shapes_of_near(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the shapes of the lanes of `_near`."""
    lanes = con.execute(statement("evidence/lane")).to_arrow_table()
    if not lanes.num_rows:
        return empty_table("lane_shape")
    points = con.execute(statement("evidence/lane_point")).fetchnumpy()
    for side in ("left", "right"):
        bounds = _simplified(points[f"{side}_x_m"], points[f"{side}_y_m"], points["lane"].astype(np.intp))
        for axis, values in zip("xy", _coordinates(bounds[:, None], lanes.num_rows), strict=True):
            lanes = lanes.append_column(f"{side}_{axis}_m", values)
    return lanes


def _simplified(x_m: Any, y_m: Any, line: NDArray[np.intp]) -> NDArray[np.object_]:
    """Return lines, given as their points and which line each is of, with only the points that keep them true."""
    lines = shapely.linestrings(np.column_stack([x_m, y_m]), indices=line)
    return np.asarray(shapely.simplify(lines, SIMPLIFY_TOLERANCE_M))


def _coordinates(lines: NDArray[np.object_], n: int) -> tuple[pa.ListArray, pa.ListArray]:
    """Return the x and y, in centimetres, of `n` shapes of one or more lines each (m, k), as a list per shape."""
    points, index = shapely.get_coordinates(lines.ravel(), return_index=True)
    offsets = pa.array(np.searchsorted(index // lines.shape[1], np.arange(n + 1)), pa.int32())
    x, y = np.round(points, 2).T
    return pa.ListArray.from_arrays(offsets, pa.array(x)), pa.ListArray.from_arrays(offsets, pa.array(y))
