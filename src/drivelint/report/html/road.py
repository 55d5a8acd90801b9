"""The lanes around scenes, from the table `lane_shape`: drawn once in the page, in map coordinates, and shared by all scenes.

Drawn coordinates are decimetres from an origin of the map, y up. Each scene rotates and scales them by one matrix.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.arrays import wrap_angles
from drivelint.report.html.svg import polygon_path, polyline_path
from drivelint.result.counts import group_rows

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import pyarrow as pa
    from numpy.typing import NDArray

    from drivelint.result.text import Row

    Points = NDArray[np.float64]
    """Shape (n, 2)."""

UNITS_PER_M: Final = 10.0
"""Drawn units per metre."""
_ARROW_EVERY_M: Final = 25.0
_MOST_DISTANCE_TO_LANE_BOUND_M: Final = 6.0  # a lane bound nearer than this belongs to the road that the ego is on
_MOST_ANGLE_TO_LANE_BOUND_RAD: Final = math.radians(
    50
)  # a bound at a greater angle to the ego's heading does not give the road's heading
_TILE_SIDE_M: Final = 200.0  # the side of a tile: lanes that begin in the same square are drawn together


class DrawnMaps:
    """All lane shapes of a result."""

    def __init__(self, lanes: pa.Table) -> None:
        rows = lanes.to_pylist()
        for row in rows:
            for side in ("left", "right"):
                row[side] = np.column_stack([row[f"{side}_x_m"], row[f"{side}_y_m"]])
        maps = group_rows(rows, lambda row: row["environment_id"])
        self._maps = {name: DrawnLanes(f"m{n}", rows) for n, (name, rows) in enumerate(sorted(maps.items()))}
        self._none = DrawnLanes("m", [])

    def lanes_of(self, environment_id: str | None) -> DrawnLanes:
        """Return the lanes of a map; for None or an unknown id, a `DrawnLanes` without lanes."""
        return self._maps.get(environment_id or "", self._none)

    def tiles(self) -> list[dict[str, Any]]:
        """Return the tiles of all maps: the lanes of one square as SVG path data. The page draws each tile once."""
        return [tile for lanes in self._maps.values() for tile in lanes.tiles()]


class DrawnLanes:
    """The lanes of one map."""

    def __init__(self, name: str, lanes: Sequence[Row]) -> None:
        self._name, self._lanes = name, lanes
        points = np.concatenate([lane["left"] for lane in lanes]) if lanes else None
        self.origin = (0.0, 0.0) if points is None else tuple(float(v) for v in np.round(points.mean(axis=0)))
        self._tile = {lane["lanelet_id"]: self._tile_name(lane) for lane in lanes}
        ends = [(lane[side][:-1], lane[side][1:]) for lane in lanes if lane["drivable"] for side in ("left", "right")]
        no_points = np.empty((0, 2))
        self._a, self._b = (np.concatenate([e[i] for e in ends]) if ends else no_points for i in (0, 1))

    def to_drawn_units(self, xy: Points) -> Points:
        """Return map points, given in metres, in drawn units."""
        return (xy - self.origin) * UNITS_PER_M

    def tile_names(self, lanelets: Sequence[str]) -> list[str]:
        """Return the names of the tiles that contain these lanelets."""
        return sorted({self._tile[lanelet] for lanelet in lanelets if lanelet in self._tile})

    def road_heading_rad(self, x_m: float, y_m: float, yaw_rad: float) -> float:
        """Return the road's heading at a point, of its two directions the one nearer to `yaw_rad`; off the road, `yaw_rad`."""
        near = (
            np.minimum(self._a, self._b) < (x_m + _MOST_DISTANCE_TO_LANE_BOUND_M, y_m + _MOST_DISTANCE_TO_LANE_BOUND_M)
        ).all(axis=1) & (
            np.maximum(self._a, self._b) > (x_m - _MOST_DISTANCE_TO_LANE_BOUND_M, y_m - _MOST_DISTANCE_TO_LANE_BOUND_M)
        ).all(axis=1)
        if not near.any():
            return yaw_rad
        a, step = self._a[near], (self._b - self._a)[near]
        length = np.maximum(np.hypot(step[:, 0], step[:, 1]), 1e-9)
        u = np.clip(((np.array([x_m, y_m]) - a) * step).sum(axis=1) / length**2, 0.0, 1.0)
        away = np.hypot(*(a + u[:, None] * step - (x_m, y_m)).T)
        heading = np.arctan2(step[:, 1], step[:, 0])
        # ignore half turns: the bounds of oncoming lanes run in the opposite direction
        turn = wrap_angles(2.0 * (heading - yaw_rad)) / 2.0
        fits = (away < _MOST_DISTANCE_TO_LANE_BOUND_M) & (np.abs(turn) < _MOST_ANGLE_TO_LANE_BOUND_RAD)
        return yaw_rad + float(turn[np.where(fits, away, np.inf).argmin()]) if fits.any() else yaw_rad

    def tiles(self) -> Iterator[dict[str, Any]]:
        """Yield the drawing of each tile."""
        marks = self._markings()
        for name in sorted(set(self._tile.values())):
            lanes = [lane for lane in self._lanes if self._tile[lane["lanelet_id"]] == name]
            yield {
                "name": name,
                "road": self._area_paths(lanes, drivable=True),
                "beside": self._area_paths(lanes, drivable=False),
                "marks": [
                    (kind, "".join(line for tile, mark_kind, line in marks if (tile, mark_kind) == (name, kind)))
                    for kind in sorted({mark_kind for tile, mark_kind, _ in marks if tile == name})
                ],
                "arrows": "".join(arrow for lane in lanes for arrow in self._arrow_paths(lane)),
            }

    def _area_paths(self, lanes: Sequence[Row], *, drivable: bool) -> str:
        rings = [np.concatenate([lane["left"], lane["right"][::-1]]) for lane in lanes if lane["drivable"] is drivable]
        # give all rings the same orientation, so that overlapping lanes are filled, not cut out of each other
        return "".join(
            polygon_path(np.rint(self.to_drawn_units(ring if _doubled_signed_area_m2(ring) > 0 else ring[::-1])))
            for ring in rings
        )

    def _markings(self) -> list[tuple[str, str, str]]:
        """Return each bound once, as tile, kind and path. Kinds: solid, broken, and edge (a kerb, or a bound of unknown kind)."""
        drawn_ends: set[frozenset[tuple[float, float]]] = set()
        marks = []
        # bounds inside a junction are not painted on the road
        for lane in (lane for lane in self._lanes if not lane["in_junction"]):
            for side in ("left", "right"):
                line: Points = lane[side]
                ends = frozenset((round(float(x) * 2) / 2, round(float(y) * 2) / 2) for x, y in (line[0], line[-1]))
                kind = _drawn_marking(lane[f"{side}_marking"], drivable=lane["drivable"])
                if kind and ends not in drawn_ends:
                    drawn_ends.add(ends)
                    marks.append(
                        (self._tile[lane["lanelet_id"]], kind, polyline_path(np.rint(self.to_drawn_units(line))))
                    )
        return marks

    def _arrow_paths(self, lane: Row) -> Iterator[str]:
        """Yield small chevrons in the middle of a drivable lane, which point in the direction of travel."""
        if not lane["drivable"] or lane["in_junction"]:
            return
        left, right = (_stations_m(lane[side]) for side in ("left", "right"))
        n = int(left[-1] // _ARROW_EVERY_M)
        for k in range(n):
            share = np.array([(k + 0.5) / n, (k + 0.5) / n + 0.5 / left[-1]])
            pair = [_points_at_fractions(lane[side], s, share) for side, s in (("left", left), ("right", right))]
            at, towards = self.to_drawn_units((pair[0] + pair[1]) / 2)
            u = (towards - at) / max(float(np.hypot(*(towards - at))), 1e-9)
            v = np.array([-u[1], u[0]])
            yield polyline_path(np.rint(np.array([at - 8 * u + 6 * v, at, at - 8 * u - 6 * v])))

    def _tile_name(self, lane: Row) -> str:
        x, y = (int((lane["left"][0][i] - self.origin[i]) // _TILE_SIDE_M) for i in (0, 1))
        return f"{self._name}t{x}_{y}".replace("-", "n")


def _doubled_signed_area_m2(ring: Points) -> float:
    x, y = ring.T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def _stations_m(line: Points) -> NDArray[np.float64]:
    """Return the distance along a line from its first point to each point."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])


def _points_at_fractions(line: Points, stations_m: NDArray[np.float64], fractions: NDArray[np.float64]) -> Points:
    """Return the points of a line at the given shares of its length; `stations_m`: see `_stations_m`."""
    return np.column_stack([np.interp(fractions * stations_m[-1], stations_m, line[:, i]) for i in (0, 1)])


def _drawn_marking(marking: str | None, *, drivable: bool) -> str | None:
    """Return how a bound is drawn (edge, broken, solid); None if it is not drawn."""
    if marking is None or marking in {"curb", "grass"}:
        return "edge"
    if marking == "none":
        return "edge" if not drivable else None
    return "broken" if marking.startswith("broken") or marking == "botts_dots" else "solid"
