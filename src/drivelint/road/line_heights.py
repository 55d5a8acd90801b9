"""Interpolates heights along the lines of a map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from drivelint.road.lane_geometry import stations

if TYPE_CHECKING:
    from drivelint.arrays import Floats


def line_heights_closest_to_points(line: Floats, points: Floats) -> Floats:
    """Return the heights (m) of a line (n, 3) at its locations closest to these points (m, 2)."""
    at = shapely.line_locate_point(shapely.LineString(line[:, :2]), shapely.points(points))
    return np.asarray(np.interp(at, stations(line), line[:, 2]), np.float64)
