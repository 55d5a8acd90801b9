"""Estimates the size of a map's spatial tables, which have a row for each grid square that a lane covers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow.compute as pc

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.arrays import Floats

SQUARE_SIDE_M: Final = 2.0
"""The size of a square of the grid of `_lane_cell`."""
BYTES_PER_SQUARE: Final = 224
"""The bytes of a square in the database: a row of `_lane_cell`, with a reserve for the statement that fills it."""


def approximate_square_count(lane_points: pa.Table) -> float:
    """Return the approximate number of rows of `_lane_cell`: the squares that the bounding boxes of lane segments touch."""
    if lane_points.num_rows < 2:
        return 0.0
    lane = pc.dictionary_encode(lane_points["lanelet_id"].combine_chunks()).indices.to_numpy()
    x, y, half = (lane_points[name].to_numpy() for name in ("x_m", "y_m", "half_width_m"))
    reach = 2.0 * np.maximum(half[1:], half[:-1])
    columns, rows = ((np.abs(np.diff(axis)) + reach) / SQUARE_SIDE_M + 1.0 for axis in (x, y))
    squares: Floats = columns * rows
    return float(squares[lane[1:] == lane[:-1]].sum())
