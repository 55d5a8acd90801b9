"""Ways that somebody goes: along roads, or from point to point."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from tests.outsiders.seventh.road import Road

Array = NDArray[np.float64]
Points = Sequence[tuple[float, float]]
STEP_M = 0.25  # between two points of a way
SAME_M = 1e-3  # nearer points are one


class Way:
    """A chain of points, and how far along it each is."""

    def __init__(self, points: Points) -> None:
        self.points = np.array(points, float)
        steps = np.diff(self.points, axis=0)
        self.s = np.concatenate([[0], np.cumsum(np.hypot(*steps.T))])
        self.heading = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
        self.middle = (self.s[1:] + self.s[:-1]) / 2
        self.length = float(self.s[-1])

    def at(self, s: Array) -> tuple[Array, Array, Array]:
        """Return places and headings; beyond its ends the way goes straight on."""
        heading = np.interp(s, self.middle, self.heading)
        x, y = np.interp(s, self.s, self.points[:, 0]), np.interp(s, self.s, self.points[:, 1])
        over = np.where(s > self.length, s - self.length, np.where(s < 0, s, 0))
        return x + over * np.cos(heading), y + over * np.sin(heading), heading

    def near(self, x: float, y: float) -> float:
        """Return how far along the way its point nearest to (x, y) is."""
        return float(self.s[np.argmin(np.hypot(self.points[:, 0] - x, self.points[:, 1] - y))])


def along(road: Road, t: float) -> Way:
    """The way along a whole road."""
    return chain([(road, t, 0.0, road.length)])


def chain(pieces: Sequence[tuple[Road, float, float, float]]) -> Way:
    """The way along pieces of roads: each with its t, from one s to another."""
    points: list[tuple[float, float]] = []
    for road, t, begin, end in pieces:
        for s in np.linspace(begin, end, max(2, int(abs(end - begin) / STEP_M) + 1)):
            x, y, _ = road.at(float(s), t)
            if not points or math.hypot(x - points[-1][0], y - points[-1][1]) >= SAME_M:
                points.append((x, y))
    return Way(points)


def through(*corners: tuple[float, float]) -> Way:
    """The way straight from point to point."""
    points: list[tuple[float, float]] = []
    for p, q in pairwise(corners):
        n = max(2, int(math.dist(p, q) / STEP_M))
        points += [(p[0] + (q[0] - p[0]) * i / n, p[1] + (q[1] - p[1]) * i / n) for i in range(n)]
    return Way([*points, corners[-1]])


def arc(middle: tuple[float, float], radius: float, until: float) -> Points:
    """Points of a turn to the right that begins at the top of a circle."""
    angles = np.linspace(0.03, until, 40)
    return [(float(middle[0] + radius * math.sin(a)), float(middle[1] + radius * math.cos(a))) for a in angles]
