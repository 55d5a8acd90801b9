"""The lanes around a scene, from the table `lane_shape`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import shapely

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    import pyarrow as pa
    from numpy.typing import NDArray

    Points = NDArray[np.float64]
    """Shape (n, 2)."""
    View = Callable[[Points], Points]

_ARROW_EVERY_M: Final = 25.0
_ON_ROAD_M: Final = 6.0  # a bound nearer than this belongs to the road that the ego is on
_SLANT_RAD: Final = math.radians(50)  # and it runs along it if the ego does not cross it more steeply


class Road:
    """All lane shapes of a result."""

    def __init__(self, lanes: pa.Table) -> None:
        self._lanes: dict[tuple[str, str], dict[str, Any]] = {}
        for row in lanes.to_pylist():
            for side in ("left", "right"):
                row[side] = np.column_stack([row[f"{side}_x_m"], row[f"{side}_y_m"]])
            self._lanes[row["environment_id"], row["lanelet_id"]] = row

    def near(self, environment_id: str | None, lanelets: Sequence[str]) -> Lanes:
        """Return these lanes of a map; none without a map."""
        keys = [(environment_id, lanelet) for lanelet in lanelets] if environment_id is not None else []
        return Lanes([self._lanes[key] for key in keys if key in self._lanes])


class Lanes:
    """Some lanes, drawn through a view from map metres to drawing units."""

    def __init__(self, lanes: Sequence[Mapping[str, Any]]) -> None:
        self._lanes = lanes

    def direction(self, x_m: float, y_m: float, yaw_rad: float) -> float:
        """Return the heading of the road at a place, the way round that is nearer to `yaw_rad`; that itself off the road."""
        ends = [
            (lane[side][:-1], lane[side][1:]) for lane in self._lanes if lane["drivable"] for side in ("left", "right")
        ]
        if not ends:
            return yaw_rad
        a, b = np.concatenate([e[0] for e in ends]), np.concatenate([e[1] for e in ends])
        step = b - a
        length = np.maximum(np.hypot(step[:, 0], step[:, 1]), 1e-9)
        u = np.clip(((np.array([x_m, y_m]) - a) * step).sum(axis=1) / length**2, 0.0, 1.0)
        away = np.hypot(*(a + u[:, None] * step - (x_m, y_m)).T)
        heading = np.arctan2(step[:, 1], step[:, 0])
        # half turns do not count: the bounds of oncoming lanes run the other way
        turn = np.mod(heading - yaw_rad + math.pi / 2, math.pi) - math.pi / 2
        fits = (away < _ON_ROAD_M) & (np.abs(turn) < _SLANT_RAD)
        return yaw_rad + float(turn[np.where(fits, away, np.inf).argmin()]) if fits.any() else yaw_rad

    def drivable(self, view: View) -> list[shapely.Geometry]:
        """Return the areas that are driven on."""
        return self._areas(view, drivable=True)

    def beside(self, view: View) -> list[shapely.Geometry]:
        """Return the other areas: footways, shoulders, parking."""
        return self._areas(view, drivable=False)

    def markings(self, view: View) -> Iterator[tuple[str, Points]]:
        """Yield each bound once: solid, broken, edge (a kerb or a bound that the map does not describe)."""
        seen: set[frozenset[tuple[float, float]]] = set()
        # a bound inside a junction is only where somebody could drive: nothing is painted there
        for lane in (lane for lane in self._lanes if not lane["in_junction"]):
            for side in ("left", "right"):
                line: Points = lane[side]
                ends = frozenset((round(float(x) * 2) / 2, round(float(y) * 2) / 2) for x, y in (line[0], line[-1]))
                kind = _marking(lane[f"{side}_marking"], drivable=lane["drivable"])
                if kind and ends not in seen:
                    seen.add(ends)
                    yield kind, view(line)

    def arrows(self, view: View) -> Iterator[tuple[Points, Points]]:
        """Yield points in the middle of lanes that are driven on, each with one a little further in the direction of travel."""
        for lane in (lane for lane in self._lanes if lane["drivable"] and not lane["in_junction"]):
            left, right = shapely.linestrings(lane["left"]), shapely.linestrings(lane["right"])
            n = int(left.length // _ARROW_EVERY_M)
            for k in range(n):
                share = np.array([(k + 0.5) / n, (k + 0.5) / n + 0.5 / left.length])
                pair = [
                    shapely.get_coordinates(shapely.line_interpolate_point(line, share, normalized=True))
                    for line in (left, right)
                ]
                at, towards = view((pair[0] + pair[1]) / 2)
                yield at, towards

    def _areas(self, view: View, *, drivable: bool) -> list[shapely.Geometry]:
        rings = [
            view(np.concatenate([lane["left"], lane["right"][::-1]]))
            for lane in self._lanes
            if lane["drivable"] is drivable
        ]
        return list(shapely.make_valid(np.array([shapely.Polygon(ring) for ring in rings], dtype=object)))


def _marking(marking: str | None, *, drivable: bool) -> str | None:
    """Return how a bound is drawn; None: not at all."""
    if marking is None or marking in {"curb", "grass"}:
        return "edge"
    if marking == "none":
        return "edge" if not drivable else None
    return "broken" if marking.startswith("broken") or marking == "botts_dots" else "solid"
