"""Ways to go along, and how speeds and offsets change with time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


Knots = list[tuple[float, float]]


@dataclass(frozen=True)
class Path:
    """A way to go along: points, headings, and how far along they are."""

    s: Floats
    x: Floats
    y: Floats
    h: Floats

    def at(self, s: float) -> tuple[float, float, float]:
        """The point and the heading at s, straight on beyond the ends."""
        over = min(0.0, s - self.s[0]) + max(0.0, s - self.s[-1])
        h = float(np.interp(s, self.s, self.h))
        x = float(np.interp(s, self.s, self.x)) + over * math.cos(h)
        y = float(np.interp(s, self.s, self.y)) + over * math.sin(h)
        return x, y, h

    @property
    def length(self) -> float:
        """How long it is."""
        return float(self.s[-1])


def path(points: list[tuple[float, float, float]]) -> Path:
    """A path through points with headings."""
    a = np.array(points)
    step = np.hypot(np.diff(a[:, 0]), np.diff(a[:, 1]))
    keep = np.concatenate([[True], step > 1e-6])
    a = a[keep]
    s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(a[:, 0]), np.diff(a[:, 1])))])
    return Path(s, a[:, 0], a[:, 1], np.unwrap(a[:, 2]))


def line(*corners: tuple[float, float]) -> Path:
    """A path of straight pieces."""
    points = []
    for (x0, y0), (x1, y1) in pairwise(corners):
        h = math.atan2(y1 - y0, x1 - x0)
        points += [(x0, y0, h), (x1 - 1e-4 * math.cos(h), y1 - 1e-4 * math.sin(h), h)]
    return path(points)


def join(*paths: Path) -> Path:
    """One path after the other."""
    points: list[tuple[float, float, float]] = []
    for p in paths:
        points += list(zip(p.x.tolist(), p.y.tolist(), p.h.tolist(), strict=True))
    return path(points)


def along(x: float, y: float, h: float, s: float, k: float) -> tuple[float, float, float]:
    """Go s further with curvature k."""
    if not k:
        return x + s * math.cos(h), y + s * math.sin(h), h
    e = h + s * k
    return x + (math.sin(e) - math.sin(h)) / k, y - (math.cos(e) - math.cos(h)) / k, e


def run(knots: Knots, t: float) -> tuple[float, float]:
    """Speed at t, and the way since 0, of a speed that is straight between the knots."""
    way, (t0, v0) = 0.0, knots[0]
    if t0 > 0:
        way += v0 * min(t, t0)
        if t <= t0:
            return v0, way
    for t1, v1 in knots[1:]:
        if t < t1:
            v = v0 + (v1 - v0) * (t - t0) / (t1 - t0)
            return v, way + (v0 + v) / 2 * (t - t0)
        way += (v0 + v1) / 2 * (t1 - t0)
        t0, v0 = t1, v1
    return v0, way + v0 * (t - t0)


def side(knots: Knots, t: float) -> tuple[float, float]:
    """Offset at t, and its rate, of an offset that is smooth between the knots."""
    if not knots or t <= knots[0][0]:
        return (knots[0][1] if knots else 0.0), 0.0
    for (t0, d0), (t1, d1) in pairwise(knots):
        if t < t1:
            u = (t - t0) / (t1 - t0)
            return d0 + (d1 - d0) * (3 - 2 * u) * u * u, (d1 - d0) * 6 * u * (1 - u) / (t1 - t0)
    return knots[-1][1], 0.0
