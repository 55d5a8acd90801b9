"""States of one actor at a place."""

from __future__ import annotations

import pyarrow as pa


def states(x: float) -> pa.Table:
    return pa.table(
        {
            "x_m": [x + i for i in range(20)],
            "y_m": [0.0] * 20,
            "yaw_rad": [0.0] * 20,
            "vx_mps": [10.0] * 20,
            "vy_mps": [0.0] * 20,
        }
    )
