"""Places beside a road: from road coordinates (s, t) to map metres."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.network import Road


def place(road: Road, s: Floats, t: Floats, offset: tuple[float, float]) -> tuple[Floats, Floats, Floats]:
    """Return x, y (m) and the road's heading (rad) at road coordinates, each (n,); `s` is held within the road."""
    inside = np.clip(s, 0.0, road.length_m)
    order = np.argsort(inside, kind="stable")
    at = np.clip(inside[order], 0.0, max(road.length_m - 1e-6, 0.0))
    line = road.plan.evaluate(inside[order], at)
    back = np.argsort(order, kind="stable")
    x, y = (line.x - line.sin * t[order])[back] + offset[0], (line.y + line.cos * t[order])[back] + offset[1]
    return x, y, np.arctan2(line.sin, line.cos)[back]
