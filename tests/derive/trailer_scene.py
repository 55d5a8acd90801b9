"""A vehicle that draws a trailer."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tests.scenes import Actor


def trailer_behind(actor_id: str, tractor: Actor, hitch_m: float = 0.5, length: float = 6.0, **more: Any) -> Actor:
    """Return a trailer: its middle rolls after an eye `hitch_m` behind the tractor's rear and as far before its own front."""
    reach = (tractor.length or 0.0) / 2 + hitch_m
    hx, hy = tractor.x - reach * np.cos(tractor.yaw), tractor.y - reach * np.sin(tractor.yaw)
    bar = length / 2 + hitch_m
    yaw = tractor.yaw.copy()
    for i in range(1, len(yaw)):
        step = np.array([hx[i] - hx[i - 1], hy[i] - hy[i - 1]])
        yaw[i] = yaw[i - 1] + math.asin(
            np.clip((step[1] * np.cos(yaw[i - 1]) - step[0] * np.sin(yaw[i - 1])) / bar, -1, 1)
        )
    x, y = hx - bar * np.cos(yaw), hy - bar * np.sin(yaw)
    t = tractor.t_s
    return Actor(actor_id, t, x, y, yaw, np.gradient(x, t), np.gradient(y, t), length, 2.2, **more)
