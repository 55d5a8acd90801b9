"""Ways of lines and arcs, and how far somebody has gone along one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

Pairs = Sequence[tuple[float, float]]
Speeds = float | Pairs  # one speed, or (time, speed), between which it changes evenly

EAST, NORTH, WEST, SOUTH = 0.0, math.pi / 2, math.pi, -math.pi / 2


def step(x: float, y: float, h: float, k: float, d: float) -> tuple[float, float, float]:
    """Go d along the curvature k."""
    if abs(k) < 1e-12:
        return x + d * math.cos(h), y + d * math.sin(h), h
    after = h + k * d
    return x + (math.sin(after) - math.sin(h)) / k, y - (math.cos(after) - math.cos(h)) / k, after


class Way:
    """Pieces of (length, curvature) that follow each other; straight on before and behind them."""

    def __init__(self, x: float, y: float, h: float = EAST, pieces: Pairs = ()) -> None:
        self.starts: list[tuple[float, float, float, float, float]] = []
        s = 0.0
        for length, k in [*pieces, (1e6, 0.0)]:
            self.starts.append((s, x, y, h, k))
            x, y, h = step(x, y, h, k, length)
            s += length

    def at(self, s: float) -> tuple[float, float, float]:
        """Return x, y and heading after s metres."""
        if s < 0:
            _, x, y, h, _ = self.starts[0]
            return step(x, y, h, 0.0, s)
        s0, x, y, h, k = [start for start in self.starts if start[0] <= s][-1]
        return step(x, y, h, k, s - s0)


def smooth(points: Pairs, t: float) -> float:
    """Return the value at a time; from one point to the next it changes smoothly."""
    if t <= points[0][0]:
        return points[0][1]
    for (t0, a), (t1, b) in pairwise(points):
        if t <= t1:
            u = (t - t0) / (t1 - t0)
            return a + (b - a) * u**3 * (10 - 15 * u + 6 * u * u)
    return points[-1][1]


def gone(speeds: Speeds, t: float) -> float:
    """Return the metres gone by a time."""
    points = speeds if isinstance(speeds, Sequence) else ((0.0, speeds),)
    s = 0.0
    t0, v0 = points[0]
    if t <= t0:
        return v0 * (t - t0)
    for t1, v1 in points[1:]:
        if t <= t1:
            v = v0 + (v1 - v0) * (t - t0) / (t1 - t0)
            return s + (v0 + v) / 2 * (t - t0)
        s += (v0 + v1) / 2 * (t1 - t0)
        t0, v0 = t1, v1
    return s + v0 * (t - t0)
