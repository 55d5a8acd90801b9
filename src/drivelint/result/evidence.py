"""Evidence for pictures and charts: copied from a batch of drives into tables that stay in the database until the end of the run.

The evidence: scenes of findings and near misses with lanes and danger spaces; tracks; overtakes and opportunities. The folder `evaluate`
makes the courses.
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

ORDER_OF_ROWS: Final = {
    "scenes": "drive_id, ego_id, t_ns",
    "lanes": "environment_id, lanelet_id",
    "spaces": "drive_id, ego_id, t_ns, actor_id <> ego_id, actor_id",
    "courses": "finding_id IS NULL, finding_id, drive_id, ego_id, rule_id, profile, object_id, occurrence",
    "tracks": "drive_id, NOT is_ego, actor_id, part",
    "overtakes": "drive_id, ego_id, occurrence",
    "opportunities": "drive_id, ego_id, occurrence, style, profile",
}
"""Evidence table of a result -> the order of its rows."""
PATH_BEFORE_AND_AFTER_MOMENT_S: Final = 5.0
"""Paths in a scene extend this long before and after the moment of the scene."""
PATH_STEP_NS: Final = 200_000_000
"""A path has at most one point per time step of this length."""
SCENE_RADIUS_RANGE_M: Final = (60.0, 300.0)
"""Least and largest radius of a scene around the ego."""
SCENES_PER_STATEMENT: Final = 400
"""Number of scenes made in one statement: their paths are lists, which the database keeps in memory."""
SCENES_PER_RULE: Final = 20
"""Largest number of scenes per ego, rule and profile: the scenes with the worst margins."""
SIMPLIFY_TOLERANCE_M: Final = 0.1


def gather(con: duckdb.DuckDBPyConnection) -> None:
    """Add the evidence of the batch that was just judged.

    Reads `finding` and `verdict`, of all batches; only drives of this batch have states in `ego_state` and `pair`.
    """
    _add_scenes(con)
    _add_lane_shapes(con)
    con.execute(statement("evidence/track"), {"step_ns": PATH_STEP_NS})
    make_reason_table(con, "SELECT NULL AS rule_no, reason AS cause, 0 AS start_ns FROM overtake_sda")
    con.execute(statement("evidence/overtake_record"))
    con.execute(statement("evidence/opportunity_record"))


def evidence_tables(con: duckdb.DuckDBPyConnection) -> dict[str, pa.Table]:
    """Return field of `Result` -> evidence table, totally ordered."""
    return {
        name: con.execute(f"SELECT * FROM {TABLE_OF_FILE[name]} ORDER BY {keys}").to_arrow_table()
        for name, keys in ORDER_OF_ROWS.items()
    }


def _add_scenes(con: duckdb.DuckDBPyConnection) -> None:
    """Add the scenes of the batch that was just judged, and the danger spaces of the scenes."""
    least, largest = SCENE_RADIUS_RANGE_M
    con.execute(statement("evidence/every_moment"), {"per_rule": SCENES_PER_RULE, "least_m": least, "most_m": largest})
    counts = con.execute("SELECT ego_no, count(*) FROM _every_moment GROUP BY ego_no ORDER BY ego_no").fetchall()
    for first, end in _groups_of_egos(counts):
        con.execute(statement("evidence/moment"), {"first_no": first, "end_no": end})
        con.execute(
            statement("evidence/around"),
            {"path_ns": int(PATH_BEFORE_AND_AFTER_MOMENT_S * 1e9), "step_ns": PATH_STEP_NS},
        )
        con.execute(statement("evidence/scene"))
        edges = con.execute(statement("evidence/danger_space_edge")).to_arrow_table()
        if edges.num_rows:
            store.insert(con, "danger_space", _danger_spaces(edges))


def _groups_of_egos(moments_by_ego: Sequence[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Cut egos into groups [first, end) with at most `SCENES_PER_STATEMENT` moments, or with one ego.

    `moments_by_ego`: (ego, number of moments).
    """
    first, n = 1, 0
    for ego, moments in moments_by_ego:
        if n and n + moments > SCENES_PER_STATEMENT:
            yield first, ego
            first, n = ego, 0
        n += moments
    if n:
        yield first, len(moments_by_ego) + 1


def _danger_spaces(edges: pa.Table) -> pa.Table:
    """Return one danger space per ring: the left points of its edges forwards, then the right points backwards, both simplified."""
    _, first, ring = np.unique(edges["ring"].to_numpy(), return_index=True, return_inverse=True)
    left, right = (_simplified_lines(edges[f"{side}x_m"], edges[f"{side}y_m"], ring) for side in "lr")
    x, y = _coordinate_lists(np.column_stack([left, shapely.reverse(right)]), len(first))
    rows = edges.select(["drive_id", "ego_id", "t_ns", "actor_id", "length_m"]).take(pa.array(first))
    return rows.append_column("x_m", x).append_column("y_m", y)


def _add_lane_shapes(con: duckdb.DuckDBPyConnection) -> None:
    """Add the shapes of the lanes near scenes, except lanes already in `lane_shape`."""
    con.execute(statement("evidence/near_lane"))
    store.insert(con, "lane_shape", _shapes_of_near_lanes(con))


def lane_shapes_of_map(environment: MapTables) -> pa.Table:
    """Return the table `lane_shape` for all lanes of a map, totally ordered."""
    with store.temporary_database(None) as con:
        for table in ("lanelet", "lane_boundary", "lane_point"):
            store.insert(con, table, environment.tables[table])
        con.execute("CREATE TEMP TABLE _near AS SELECT environment_id, lanelet_id FROM lanelet")
        return conform(_shapes_of_near_lanes(con), "lane_shape")


def _shapes_of_near_lanes(con: duckdb.DuckDBPyConnection) -> pa.Table:
    """Return the shapes of the lanes in the table `_near`."""
    lanes = con.execute(statement("evidence/lane")).to_arrow_table()
    if not lanes.num_rows:
        return empty_table("lane_shape")
    points = con.execute(statement("evidence/lane_point")).fetchnumpy()
    for side in ("left", "right"):
        bounds = _simplified_lines(points[f"{side}_x_m"], points[f"{side}_y_m"], points["lane"].astype(np.intp))
        for axis, values in zip("xy", _coordinate_lists(bounds[:, None], lanes.num_rows), strict=True):
            lanes = lanes.append_column(f"{side}_{axis}_m", values)
    return lanes


def _simplified_lines(x_m: Any, y_m: Any, line_of_point: NDArray[np.intp]) -> NDArray[np.object_]:
    """Return the lines, simplified to `SIMPLIFY_TOLERANCE_M`. `line_of_point`: for each point, the number of its line."""
    lines = shapely.linestrings(np.column_stack([x_m, y_m]), indices=line_of_point)
    return np.asarray(shapely.simplify(lines, SIMPLIFY_TOLERANCE_M))


def _coordinate_lists(lines: NDArray[np.object_], n_shapes: int) -> tuple[pa.ListArray, pa.ListArray]:
    """Return x and y in metres, rounded to centimetres, as one list per shape. `lines` (m, k): `n_shapes` shapes of k lines each."""
    points, index = shapely.get_coordinates(lines.ravel(), return_index=True)
    offsets = pa.array(np.searchsorted(index // lines.shape[1], np.arange(n_shapes + 1)), pa.int32())
    x, y = np.round(points, 2).T
    return pa.ListArray.from_arrays(offsets, pa.array(x)), pa.ListArray.from_arrays(offsets, pa.array(y))
