"""How much ground the lanes of a map lie on: the tables in which places are looked up have a row for each square of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow.compute as pc

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.arrays import Floats

SQUARE_M: Final = 2.0
"""The grid of `lane_cell`."""
BYTES_PER_SQUARE: Final = 224
"""What a square takes in the database: a row of `lane_cell`, and those of `strip_cell` for the ground beside the lane."""


def ground_squares(lane_points: pa.Table) -> float:
    """Return about how many rows `lane_cell` has: the squares that the boxes round the segments of the lanes touch."""
    if lane_points.num_rows < 2:
        return 0.0
    lane = pc.dictionary_encode(lane_points["lanelet_id"].combine_chunks()).indices.to_numpy()
    x, y, half = (lane_points[name].to_numpy() for name in ("x_m", "y_m", "half_width_m"))
    reach = 2.0 * np.maximum(half[1:], half[:-1])
    columns, rows = ((np.abs(np.diff(axis)) + reach) / SQUARE_M + 1.0 for axis in (x, y))
    squares: Floats = columns * rows
    return float(squares[lane[1:] == lane[:-1]].sum())
