"""Which side of the road the traces drive on: the last witness, where neither the user nor the map says."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow.compute as pc
import shapely

if TYPE_CHECKING:
    import pyarrow as pa
    from numpy.typing import NDArray

    from drivelint.maps.contract import Environment

SAMPLES: Final = 400  # moving states looked at, evenly spread: enough to vote, cheap for a long log
LEAST_VOTES: Final = 20
FEW, MANY = 20, 2000  # positions looked at to see whether a drive is on its map
AGREEMENT: Final = 0.8  # an overtake drives against its lane for a while, a drive does not


def vote(
    environment: Environment, x_m: NDArray[np.float64], y_m: NDArray[np.float64], yaw_rad: NDArray[np.float64]
) -> str | None:
    """Return lht or rht as the headings of moving vehicles say, or None if they are too few or disagree.

    `x_m, y_m, yaw_rad`: moving states of any vehicles, shape (n,), in map coordinates. A state counts where exactly one
    one-way drivable lanelet holds it.
    """
    known = np.flatnonzero(np.isfinite(x_m) & np.isfinite(y_m) & np.isfinite(yaw_rad))
    if len(known) < LEAST_VOTES:
        return None
    chosen = known[np.unique(np.linspace(0, len(known) - 1, min(SAMPLES, len(known))).astype(np.int64))]
    areas, lines = _lanes(environment)
    if not len(areas):
        return None
    points = np.asarray(shapely.points(x_m[chosen], y_m[chosen]))
    state, lane = shapely.STRtree(areas).query(points, predicate="within")
    single = np.bincount(state, minlength=len(chosen))[state] == 1
    state, lane = state[single], lane[single]
    if len(state) < LEAST_VOTES:
        return None
    at = shapely.line_locate_point(lines[lane], points[state])
    ahead = shapely.get_coordinates(shapely.line_interpolate_point(lines[lane], at + 0.5))
    behind = shapely.get_coordinates(shapely.line_interpolate_point(lines[lane], np.maximum(at - 0.5, 0.0)))
    direction = np.arctan2(ahead[:, 1] - behind[:, 1], ahead[:, 0] - behind[:, 0])
    agree = float(np.mean(np.cos(yaw_rad[chosen][state] - direction) > 0))
    if agree >= AGREEMENT:
        return environment.handedness
    if agree <= 1 - AGREEMENT:
        return "lht" if environment.handedness == "rht" else "rht"
    return None


def ground(environment: Environment) -> shapely.STRtree:
    """Return the areas of every lanelet of any type, to look positions up in."""
    areas = _shapes(environment, environment.tables["lanelet"]["lanelet_id"])[0]
    shapely.prepare(areas)
    return shapely.STRtree(areas)


def on_map(lanes: shapely.STRtree, x_m: NDArray[np.float64], y_m: NDArray[np.float64]) -> tuple[int, int]:
    """Return how many known positions, evenly spread, are looked at, and how many of them lie on some lanelet.

    A few do where one is found; before it is said that there is none, `MANY` are looked at.
    """
    known = np.flatnonzero(np.isfinite(x_m) & np.isfinite(y_m))
    looked = found = 0
    for most in (FEW, MANY):
        if found or looked == len(known):
            break
        chosen = known[np.unique(np.linspace(0, len(known) - 1, min(most, len(known))).astype(np.int64))]
        points = np.asarray(shapely.points(x_m[chosen], y_m[chosen]))
        looked, found = len(chosen), len(np.unique(lanes.query(points, predicate="intersects")[0]))
    return looked, found


def _lanes(environment: Environment) -> tuple[NDArray[np.object_], NDArray[np.object_]]:
    """Return areas and centre lines of the one-way drivable lanelets."""
    lanelets = environment.tables["lanelet"]
    return _shapes(
        environment, lanelets.filter(pc.and_(lanelets["drivable"], pc.invert(lanelets["bidirectional"])))["lanelet_id"]
    )


def _shapes(environment: Environment, wanted: pa.ChunkedArray) -> tuple[NDArray[np.object_], NDArray[np.object_]]:
    """Return areas and centre lines of these lanelets."""
    points = environment.tables["lane_point"]
    points = points.filter(pc.is_in(points["lanelet_id"], value_set=wanted.combine_chunks())).sort_by(
        [("lanelet_id", "ascending"), ("k", "ascending")]
    )
    ids = points["lanelet_id"].to_numpy(zero_copy_only=False)
    if not len(ids):
        return np.array([], dtype=object), np.array([], dtype=object)
    _, index, counts = np.unique(ids, return_inverse=True, return_counts=True)
    line = np.asarray(shapely.linestrings(_xy(points, "x_m", "y_m"), indices=index))
    left, right = _xy(points, "left_x_m", "left_y_m"), _xy(points, "right_x_m", "right_y_m")
    ends = np.cumsum(counts)
    rings = [np.vstack([left[a:b], right[a:b][::-1]]) for a, b in zip(ends - counts, ends, strict=True)]
    area = np.array([shapely.Polygon(ring) for ring in rings], dtype=object)
    return area, line


def _xy(points: object, x: str, y: str) -> NDArray[np.float64]:
    return np.column_stack([points[x].to_numpy(), points[y].to_numpy()])  # type: ignore[index]
