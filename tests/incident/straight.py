"""Rows of `queries/incident/step.sql` of an ego that drives straight on towards another actor."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

STEP_S = 0.1


def steps(v: np.ndarray, x: np.ndarray, other_x: float, other_v: float = 0.0) -> pa.Table:
    """Return an ego that drives east along y = 0 and an object on its line, boxes of 4 m by 2 m."""
    n = len(v)
    t = np.arange(n) * STEP_S
    columns = {
        "t_ns": np.round(t * 1e9).astype(np.int64), "x_m": x, "y_m": np.zeros(n), "yaw_rad": np.zeros(n),
        "length_m": np.full(n, 4.0), "width_m": np.full(n, 2.0), "speed_mps": v, "vx_mps": v, "vy_mps": np.zeros(n),
        "lane_offset_m": np.zeros(n), "object_x_m": other_x + other_v * t, "object_y_m": np.full(n, 1.0),
        "object_yaw_rad": np.zeros(n), "object_length_m": np.full(n, 4.0), "object_width_m": np.full(n, 2.0),
        "object_speed_mps": np.full(n, abs(other_v)), "object_vx_mps": np.full(n, other_v), "object_vy_mps": np.zeros(n),
        "object_lane_offset_m": np.ones(n), "clearance_m": np.full(n, np.nan),
        "heading_diff_rad": np.zeros(n), "out_since_ns": np.full(n, np.nan),
    }  # fmt: skip
    return pa.table({name: pa.array(values, from_pandas=True) for name, values in columns.items()})
