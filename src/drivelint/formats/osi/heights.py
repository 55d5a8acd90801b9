"""Detects heights of OSI objects that are copies of their widths, as omega-prime 0.3.7 writes when it converts Parquet to MCAP."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drivelint.drive.trace import QualityFinding

if TYPE_CHECKING:
    from drivelint.drive.trace import States


def forget_heights_copied_from_widths(states: States) -> QualityFinding | None:
    """Make all heights unknown if every known height equals its object's width, and return the finding; otherwise return None."""
    height, width = states.numbers["height_m"], states.numbers["width_m"]
    has_height = np.isfinite(height)
    if not has_height.any() or (height[has_height] != width[has_height]).any():
        return None
    states.numbers["height_m"] = np.full(len(states), np.nan)
    message = (
        "all heights of objects equal their widths, an error of omega-prime 0.3.7 when it converts Parquet to "
        "MCAP: heights are treated as unknown; use the Parquet file, or write the log again"
    )
    return QualityFinding("copied_height", "warning", message, int(has_height.sum()))
