"""Gathers the actors around the worst step of every finding and near miss: `scene` and `danger_space`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import shapely

from drivelint.result.evidence.lane_shapes import SIMPLIFY_TOLERANCE_M
from drivelint.sql import store
from drivelint.sql.statements import statement

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


def gather(con: duckdb.DuckDBPyConnection) -> None:
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
