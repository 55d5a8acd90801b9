"""Motions: a way, a speed over time and a place across the way over time, worked out every hundredth of a second."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from tests.outsiders.log import Box, Size, at
from tests.outsiders.thirteenth.road import Floats, Road

FINE = 0.01
Speeds = float | Sequence[tuple[float, float]]  # (s, m/s), straight between them
Across = Sequence[tuple[float, float]]  # (s, m to the near side of the way), smooth between them
Lamps = str | Sequence[tuple[float, str]] | None
SIZES: dict[str | None, Size] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.5, 2.0, 2.3),
    "truck": (10.0, 2.5, 3.5),
    "bus": (12.0, 2.5, 3.2),
    "motorcycle": (2.1, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "pedestrian": (0.5, 0.5, 1.75),
    "animal": (2.4, 0.7, 2.2),
    "trailer": (6.0, 2.2, 2.0),
    None: (4.5, 1.8, 1.5),
}


class Way:
    """A line through points; beyond its ends it goes straight on."""

    def __init__(self, x: Floats, y: Floats) -> None:
        kept = np.r_[True, np.hypot(np.diff(x), np.diff(y)) > 1e-6]
        self.x, self.y = x[kept], y[kept]
        self.s = np.r_[0, np.cumsum(np.hypot(np.diff(self.x), np.diff(self.y)))]
        h = np.unwrap(np.arctan2(np.diff(self.y), np.diff(self.x)))
        self.h = np.r_[h[0], (h[1:] + h[:-1]) / 2, h[-1]]

    def pose(self, s: Floats) -> tuple[Floats, Floats, Floats]:
        """Return x, y and heading."""
        h = np.interp(s, self.s, self.h)
        over = np.where(s > self.s[-1], s - self.s[-1], np.where(s < 0, s, 0))
        return np.interp(s, self.s, self.x) + over * np.cos(h), np.interp(s, self.s, self.y) + over * np.sin(h), h

    def nearest(self, x: float, y: float) -> float:
        """Return s of the point of the way that is nearest."""
        return float(self.s[np.argmin(np.hypot(self.x - x, self.y - y))])


def along(road: Road, back: bool = False) -> Way:
    """The reference line of a road, from 100 m before it to 100 m behind it."""
    x, y = road.at(np.arange(-100, road.length + 100, 0.25), 0.0)
    return Way(x[::-1], y[::-1]) if back else Way(x, y)


def line(x0: float, y0: float, x1: float, y1: float) -> Way:
    """From one point straight to another."""
    n = max(int(np.hypot(x1 - x0, y1 - y0) / 0.25), 2)
    return Way(np.linspace(x0, x1, n), np.linspace(y0, y1, n))


class Track(NamedTuple):
    """What somebody does, every hundredth of a second: x, y, heading, vx, vy."""

    x: Floats
    y: Floats
    h: Floats
    vx: Floats
    vy: Floats


@dataclass
class Actor:
    """Somebody; side: 1 where the near side is the left; seen: when the log has it; None: always."""

    name: str
    cls: str | None
    way: Way
    start: float
    speeds: Speeds
    across: Across = ((0.0, 0.0),)
    side: int = 1
    size: Size | None = None
    indicator: Lamps = None
    seen: Sequence[tuple[float, float]] | None = None
    noise: float = 0.0
    soft: float = 0.4

    def box(self) -> Box:
        """What it is."""
        return Box(self.name, self.cls, self.size or SIZES[self.cls])

    def visible(self, t: float) -> bool:
        """Whether the log has it."""
        return self.seen is None or any(begin <= t <= end for begin, end in self.seen)

    def lamp(self, t: float) -> str | None:
        """Return the state of its indicator."""
        if self.indicator is None or isinstance(self.indicator, str):
            return self.indicator
        return at(self.indicator, t)

    def track(self, seconds: float) -> Track:
        """Work out the motion."""
        t = np.arange(0, seconds + FINE / 2, FINE)
        points = self.speeds if isinstance(self.speeds, Sequence) else [(0.0, self.speeds)]
        speed = _even(np.interp(t, *np.array(points, float).T), int(self.soft / FINE))
        s = self.start + np.r_[0, np.cumsum((speed[1:] + speed[:-1]) / 2 * FINE)]
        u = _glide(self.across, t) * self.side
        x, y, h = self.way.pose(s)
        x, y = x - u * np.sin(h), y + u * np.cos(h)
        aside = np.arctan2(np.gradient(u, FINE), np.maximum(np.abs(speed), 0.5)) * np.sign(speed)
        return Track(x, y, h + np.where(np.abs(speed) > 0.5, aside, 0), np.gradient(x, FINE), np.gradient(y, FINE))


def _even(values: Floats, width: int) -> Floats:
    """Even out kinks: the mean over so many steps."""
    if width < 2:
        return values
    padded = np.pad(values, (width, width), mode="edge")
    return np.convolve(padded, np.ones(width) / width, mode="same")[width:-width]


def _glide(points: Across, t: Floats) -> Floats:
    """From point to point without a jerk."""
    u = np.full_like(t, points[0][1])
    for (begin, before), (end, after) in pairwise(points):
        m = t >= begin
        q = np.clip((t[m] - begin) / max(end - begin, 1e-6), 0, 1)
        u[m] = before + (after - before) * (q**3 * (10 - 15 * q + 6 * q * q))
    return u
