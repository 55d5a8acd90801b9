"""The gap between the ego's box and every other box: against vectorised shapely on numpy arrays."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from drivelint.sql import store
from tests.bench import traffic
from tests.bench.clock import Span, repeat
from tests.bench.rivals.comparison import agree
from tests.bench.table import Row

if TYPE_CHECKING:
    import duckdb
    import pyarrow as pa
    from numpy.typing import NDArray

    from tests.bench.place import Place

    Floats = NDArray[np.float64]

LENGTH, WIDTH = 4.8, 1.8
NEAR_M = 30.0
_CLEARANCE_SQL = """
CREATE OR REPLACE TEMP TABLE gap AS
SELECT t_ns, object_id, box_clearance(
        ex * cos(yaw) + ey * sin(yaw), ey * cos(yaw) - ex * sin(yaw), cos(turn), sin(turn), $hl, $hw, $hl, $hw
    ) AS clearance_m
FROM (
    SELECT o.t_ns, o.actor_id AS object_id, e.yaw_rad AS yaw, o.yaw_rad - e.yaw_rad AS turn, o.x_m - e.x_m AS ex, o.y_m - e.y_m AS ey
    FROM actor_state e JOIN actor_state o ON o.t_ns = e.t_ns AND o.actor_id <> e.actor_id
    WHERE e.actor_id = '0'
)
WHERE ex * ex + ey * ey <= $far ** 2
"""


class Boxes(NamedTuple):
    """Poses of the boxes of one side, each of shape (pairs,)."""

    x: Floats
    y: Floats
    yaw: Floats

    def of(self, mask: NDArray[np.bool_]) -> Boxes:
        """Return some of them."""
        return Boxes(self.x[mask], self.y[mask], self.yaw[mask])

    def polygons(self) -> NDArray[np.object_]:
        """Return them as shapely polygons."""
        along = np.array([1, 1, -1, -1]) * LENGTH / 2
        aside = np.array([1, -1, -1, 1]) * WIDTH / 2
        c, s = np.cos(self.yaw)[:, None], np.sin(self.yaw)[:, None]
        x = self.x[:, None] + along * c - aside * s
        y = self.y[:, None] + along * s + aside * c
        return np.asarray(shapely.polygons(np.stack([x, y], axis=2)))


def compare(place: Place) -> list[Row]:
    """Compare gaps and overlaps: of every pair, and of those whose centres are near enough to matter."""
    shape, runs = place.sizes.reference, place.sizes.runs
    states, _ = traffic.drive(shape)
    ego, object_boxes = _sides(states, shape)
    rows = []
    with store.connect() as con:
        store.insert(con, "actor_state", _as_read(states))
        for label, far in (("all pairs", np.inf), (f"pairs nearer than {NEAR_M:.0f} m", NEAR_M)):
            params = {"hl": LENGTH / 2, "hw": WIDTH / 2, "far": 1e9 if far == np.inf else far}
            distance, overlap = _theirs(ego, object_boxes, far)
            _same(con, params, distance, overlap)
            their_time = repeat(partial(_theirs, ego, object_boxes, far), runs)
            our_time = repeat(partial(con.execute, _CLEARANCE_SQL, params), runs)
            rows += _rows(label, len(distance), their_time, our_time)
    return rows


def _rows(label: str, pairs: int, their_time: Span, our_time: Span) -> list[Row]:
    return [
        Row(
            "shapely",
            f"{label}: shapely",
            their_time.wall,
            cpu=their_time.cpu,
            note=f"{pairs:,} pairs; boxes, distance, intersects",
        ),
        Row(
            "shapely",
            f"{label}: ours",
            our_time.wall,
            cpu=our_time.cpu,
            note="join by time and separating axes, in SQL",
        ),
        Row("shapely", f"{label}: ours is faster", their_time.wall / our_time.wall, "x"),
    ]


def _theirs(ego: Boxes, object_boxes: Boxes, far: float) -> tuple[Floats, NDArray[np.bool_]]:
    near = np.hypot(object_boxes.x - ego.x, object_boxes.y - ego.y) <= far
    a, b = ego.of(near).polygons(), object_boxes.of(near).polygons()
    shapely.prepare(a)
    return np.asarray(shapely.distance(a, b)), np.asarray(shapely.intersects(a, b))


def _same(
    con: duckdb.DuckDBPyConnection, params: dict[str, float], distance: Floats, overlap: NDArray[np.bool_]
) -> None:
    con.execute(_CLEARANCE_SQL, params)
    found = con.execute(
        "SELECT count(*), sum(greatest(clearance_m, 0.0)), min(clearance_m), count(*) FILTER (clearance_m <= 0) FROM gap"
    ).fetchall()[0]
    agree("pairs", found[0], len(distance))
    agree("sum of gaps", found[1] or 0.0, float(distance.sum()))
    agree("overlaps", found[3], int(overlap.sum()))
    if not overlap.any() and len(distance):
        agree("least gap", found[2], float(distance.min()))


def _as_read(states: pa.Table) -> pa.Table:
    """Return the states as the table `actor_state` has them."""
    import pyarrow as pa

    return states.append_column("drive_id", pa.array(["bench"] * states.num_rows))


def _sides(states: pa.Table, shape: traffic.Shape) -> tuple[Boxes, Boxes]:
    """Return ego and other boxes, pair by pair; the states lie actor by actor, the ego's first."""
    frames = states.num_rows // shape.actors
    x, y, yaw = (states[key].to_numpy() for key in ("x_m", "y_m", "yaw_rad"))
    ego = Boxes(*(np.tile(values[:frames], shape.actors - 1) for values in (x, y, yaw)))
    return ego, Boxes(x[frames:], y[frames:], yaw[frames:])
