"""Ways through the world: points with headings, and how far along them they are."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]


class Way:
    """A chain of points; beyond its ends it goes straight on."""

    def __init__(self, points: Array, heading: Array | None = None) -> None:
        keep = [0]
        for i in range(1, len(points)):
            if np.hypot(*(points[i] - points[keep[-1]])) > 0.02:
                keep.append(i)
        self.points = points[keep]
        parts = np.diff(self.points, axis=0)
        self.s: Array = np.concatenate([[0.0], np.cumsum(np.hypot(parts[:, 0], parts[:, 1]))])
        self.length = float(self.s[-1])
        if heading is not None:
            self.heading: Array = np.unwrap(heading[keep])
        elif len(self.points) > 2:
            slope = np.gradient(self.points, self.s, axis=0)
            self.heading = np.unwrap(np.arctan2(slope[:, 1], slope[:, 0]))
        else:
            self.heading = np.full(2, math.atan2(parts[0, 1], parts[0, 0]))

    def __add__(self, other: Way) -> Way:
        points = np.vstack([self.points, other.points])
        return Way(points, np.concatenate([self.heading, other.heading]))

    def back(self) -> Way:
        """The same way the other way round."""
        return Way(self.points[::-1], self.heading[::-1] + math.pi)

    def beside(self, d: float | Array) -> Way:
        """The way that is so far to the left of this one."""
        across = np.column_stack([-np.sin(self.heading) * d, np.cos(self.heading) * d])
        return Way(self.points + across, self.heading)

    def pose(self, s: Array) -> tuple[Array, Array, Array]:
        """Positions and headings so far along it."""
        x, y, heading = (np.interp(s, self.s, v) for v in (self.points[:, 0], self.points[:, 1], self.heading))
        before, after = np.minimum(s, 0), np.maximum(s - self.length, 0)
        x = x + before * math.cos(self.heading[0]) + after * math.cos(self.heading[-1])
        y = y + before * math.sin(self.heading[0]) + after * math.sin(self.heading[-1])
        return x, y, heading


def line(*points: Point) -> Way:
    """Straight from point to point."""
    return Way(np.array(points, float))


def along(y: float) -> Way:
    """Along the x axis, at y; s is x."""
    return line((0, y), (1, y))


def against(y: float, start: float) -> Way:
    """Against the x axis, at y, from x = start."""
    return line((start, y), (start - 1, y))


def curve(ends: tuple[Point, Point], headings: tuple[float, float], stretch: float = 1.0, count: int = 80) -> Array:
    """Return points of a smooth curve (Hermite's) from one point and heading to another."""
    a, b = np.array(ends[0], float), np.array(ends[1], float)
    length = math.hypot(b[0] - a[0], b[1] - a[1]) * stretch
    slope_a, slope_b = (np.array([math.cos(h), math.sin(h)]) * length for h in headings)
    u = np.linspace(0, 1, count)[:, None]
    start, end = (2 * u**3 - 3 * u**2 + 1) * a, (-2 * u**3 + 3 * u**2) * b
    points: Array = start + (u**3 - 2 * u**2 + u) * slope_a + end + (u**3 - u**2) * slope_b
    return points


def chain(parts: Sequence[Array | Sequence[Point]]) -> Way:
    """One way through all of these points; its headings are those between the points."""
    return Way(np.vstack([np.asarray(part, float) for part in parts]))
