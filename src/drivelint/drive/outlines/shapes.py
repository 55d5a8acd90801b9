"""Things that do not move and are no actors, as shapes on the ground."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
import shapely

from drivelint.arrays import rotate_vectors

BOX_CORNERS: Final = np.array([[0.5, 0.5, -0.5, -0.5], [0.5, -0.5, -0.5, 0.5]])
"""The corners of a box along and across it, by its length and width."""


class Outline(NamedTuple):
    """A thing that does not move: its name, its shape in the log's frame (m), the height of its middle, and its own (m; NaN: not known)."""

    name: str
    shape: shapely.Geometry
    z_m: float = np.nan
    height_m: float = np.nan


def box_shape(x_m: float, y_m: float, yaw_rad: float, length_m: float, width_m: float) -> shapely.Geometry:
    """Return the box around (x, y); a thing without a size is a point."""
    along, across = rotate_vectors(BOX_CORNERS[0] * length_m, BOX_CORNERS[1] * width_m, np.full(4, yaw_rad))
    return shapely.convex_hull(shapely.multipoints(np.column_stack([x_m + along, y_m + across])))
