"""The lanes near the actors, drawn once: surfaces, bounds and driving directions."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import shapely

from drivelint.annotate import draw
from drivelint.annotate.draw import Colour
from drivelint.arrays import floats
from drivelint.formats.foxglove import messages as foxglove

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from drivelint.arrays import Floats
    from drivelint.road.map_reader import MapTables

NEAR_LANES_M: Final = 40.0
"""Lanes within about this distance of an actor's path are drawn (the path is reduced to cells of a grid of this size)."""
_CELL_NUMBERS_PER_COLUMN: Final = 1 << 31  # more than any map has in one column of the grid
ASPHALT = Colour(0.27, 0.28, 0.30)
PAVEMENT = Colour(0.42, 0.40, 0.37)
VERGE = Colour(0.33, 0.36, 0.32)
BOUND_COLOUR = Colour(0.80, 0.80, 0.78)
ARROW_COLOUR = Colour(0.55, 0.57, 0.60)
_FOOTWAY_TYPES: Final = frozenset({"sidewalk", "walking"})
_LANE_POINT_COLUMNS: Final = ("x_m", "y_m", "z_m", "tx", "ty", "left_x_m", "left_y_m", "right_x_m", "right_y_m")
_SURFACE_BELOW_BOUNDS_M: Final = 0.05  # below the bounds, so that neither flickers through the other


class Road:
    """The lanelets of one map; each is encoded once for all drives."""

    def __init__(self, environment: MapTables) -> None:
        points, lanelets = environment.tables["lane_point"], environment.tables["lanelet"]
        order = points.sort_by([("lanelet_id", "ascending"), ("k", "ascending")])
        self._points = {name: floats(order[name]) for name in _LANE_POINT_COLUMNS}
        names = np.asarray(order["lanelet_id"].to_numpy(zero_copy_only=False), object).astype(str)
        self._names, first, count = np.unique(names, return_index=True, return_counts=True)
        self._rows = [slice(int(a), int(a + n)) for a, n in zip(first, count, strict=True)]
        self._lanelet_rows = {row["lanelet_id"]: row for row in lanelets.to_pylist()}
        self._encoded: dict[int, bytes] = {}

    def lanes_near(self, x: Floats, y: Floats, log_time: int) -> bytes:
        """Return the SceneUpdate with the lanes near some positions."""
        return b"".join(self._lanelet_entity(int(i), log_time) for i in self._distinct_lanelet_numbers_near(x, y))

    def drivable_outlines(self, x: Floats, y: Floats) -> Iterator[tuple[str, Floats]]:
        """Yield the drivable lanes near some positions: lanelet id, and closed outline (n, 2), counterclockwise."""
        for i in self._distinct_lanelet_numbers_near(x, y):
            name, rows = str(self._names[i]), self._rows[i]
            if self._lanelet_rows[name]["drivable"]:
                left, right = (
                    np.stack([self._points[f"{side}_{axis}_m"][rows] for axis in "xy"], axis=1)
                    for side in ("left", "right")
                )
                yield name, np.concatenate([right, left[::-1], right[:1]])

    def _distinct_lanelet_numbers_near(self, x: Floats, y: Floats) -> NDArray[np.int64]:
        column, row = (np.floor(values / NEAR_LANES_M).astype(np.int64) for values in (x, y))
        _, first = np.unique(column * _CELL_NUMBERS_PER_COLUMN + row, return_index=True)
        cells = np.stack([column[first], row[first]])
        around = shapely.box(*((cells - 1) * NEAR_LANES_M), *((cells + 2) * NEAR_LANES_M))
        return np.unique(self._lanelet_of_segment[self._spatial_index.query(around)[1]])

    @cached_property
    def _lanelet_of_segment(self) -> NDArray[np.int64]:
        """The number of the lanelet of each segment in the spatial index."""
        return np.repeat(np.arange(len(self._rows)), [r.stop - r.start - 1 for r in self._rows])

    @cached_property
    def _spatial_index(self) -> Any:
        xy = np.stack([self._points["x_m"], self._points["y_m"]], axis=1)
        start = np.concatenate([np.arange(r.start, r.stop - 1) for r in self._rows])
        pieces: Any = shapely.linestrings(np.stack([xy[start], xy[start + 1]], axis=1))
        return shapely.STRtree(pieces)

    def _lanelet_entity(self, number: int, log_time: int) -> bytes:
        name = str(self._names[number])
        about = self._lanelet_rows[name]
        if number not in self._encoded:
            self._encoded[number] = self._lanelet_primitives(number, about)
        facts = {"lane type": about["lane_type"], "road": about["road_id"]}
        return draw.entity(name, log_time, self._encoded[number], facts)

    def _lanelet_primitives(self, number: int, lanelet: dict[str, Any]) -> bytes:
        if lanelet["lane_type"] == "none":
            return b""
        p = {name: values[self._rows[number]] for name, values in self._points.items()}
        z = np.nan_to_num(p["z_m"])
        left, right = (np.stack([p[f"{side}_x_m"], p[f"{side}_y_m"], z], axis=1) for side in ("left", "right"))
        down = np.array([0.0, 0.0, _SURFACE_BELOW_BOUNDS_M])
        ground = ASPHALT if lanelet["drivable"] else PAVEMENT if lanelet["lane_type"] in _FOOTWAY_TYPES else VERGE
        parts = [draw.ribbon(left - down, right - down, ground)]
        parts += [
            draw.line(side, BOUND_COLOUR, thickness=0.12, line_type=foxglove.LINE_STRIP, pixels=False)
            for side in (left, right)
        ]
        if lanelet["drivable"] and lanelet["length_m"] > 10.0:
            k = len(z) // 2
            yaw = math.atan2(p["ty"][k], p["tx"][k])
            parts.append(draw.arrow((float(p["x_m"][k]), float(p["y_m"][k]), float(z[k])), yaw, 3.0, ARROW_COLOUR))
        return b"".join(parts)
