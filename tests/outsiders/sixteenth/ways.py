"""Where somebody is at a time: a path of lines and arcs, speeds along it, and places across it.

All of it is in a frame in which the right is driven on; a British drive is mirrored when it is written.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

TICK = 0.01  # a motion is known at every hundredth of a second
LONGEST = 90.0  # seconds

Array = npt.NDArray[np.float64]
Knots = float | Sequence[tuple[float, float]]  # one value, or (time, value)
Bends = Sequence[tuple[float, float]]  # (length, curvature)


class Piece(NamedTuple):
    """A line or an arc, and where it begins along the path."""

    s: float
    x: float
    y: float
    heading: float
    length: float
    curvature: float

    def end(self) -> tuple[float, float, float]:
        """Return the place and the heading at its end."""
        h, k, n = self.heading, self.curvature, self.length
        if abs(k) < 1e-9:
            return self.x + n * math.cos(h), self.y + n * math.sin(h), h
        turned = h + k * n
        return self.x + (math.sin(turned) - math.sin(h)) / k, self.y - (math.cos(turned) - math.cos(h)) / k, turned

    def at(self, along: Array) -> tuple[Array, Array, Array]:
        """Return places and headings at distances from its begin."""
        h, k = self.heading, self.curvature
        if abs(k) < 1e-9:
            return self.x + along * math.cos(h), self.y + along * math.sin(h), h + 0 * along
        turned = h + k * along
        return self.x + (np.sin(turned) - math.sin(h)) / k, self.y - (np.cos(turned) - math.cos(h)) / k, turned


class Path:
    """Lines and arcs from a place on; before and after them it goes straight on."""

    def __init__(self, x: float, y: float, heading: float, bends: Bends) -> None:
        self.pieces: list[Piece] = []
        s = 0.0
        for length, curvature in bends:
            piece = Piece(s, x, y, heading, length, curvature)
            self.pieces.append(piece)
            x, y, heading = piece.end()
            s += length
        self.length = s

    def at(self, s: Array) -> tuple[Array, Array, Array]:
        """Return places and headings at distances along it."""
        x, y, heading = np.zeros_like(s), np.zeros_like(s), np.zeros_like(s)
        last = len(self.pieces) - 1
        for i, piece in enumerate(self.pieces):
            here = np.ones_like(s, dtype=bool)
            if i > 0:
                here &= s >= piece.s
            if i < last:
                here &= s < piece.s + piece.length
            along, beyond = s[here] - piece.s, np.zeros(int(here.sum()))
            if i == last:
                beyond = beyond + np.maximum(along - piece.length, 0)
                along = np.minimum(along, piece.length)
            if i == 0:
                beyond = beyond + np.minimum(along, 0)
                along = np.maximum(along, 0)
            px, py, ph = piece.at(along)
            x[here], y[here], heading[here] = px + beyond * np.cos(ph), py + beyond * np.sin(ph), ph
        return x, y, heading


def line(x: float, y: float, heading: float = 0.0) -> Path:
    """A straight way from a place on."""
    return Path(x, y, heading, [(3000.0, 0.0)])


def against(x: float) -> Path:
    """Straight against the direction of a road along x, from a place on it."""
    return line(x, 0.0, math.pi)


class Motion:
    """Along a path: speeds change evenly between their times, places across it smoothly; left is positive."""

    def __init__(self, path: Path, speed: Knots, start: float = 0.0, across: Knots = 0.0) -> None:
        self.t = np.arange(0, LONGEST + 2 * TICK, TICK)
        self.speed = _even(self.t, speed)
        way = start + np.concatenate([[0], np.cumsum((self.speed[1:] + self.speed[:-1]) / 2 * TICK)])
        aside = _smooth(self.t, across)
        x, y, heading = path.at(way)
        self.x, self.y = x - aside * np.sin(heading), y + aside * np.cos(heading)
        self.vx, self.vy = np.gradient(self.x, TICK), np.gradient(self.y, TICK)
        drift = np.gradient(aside, TICK)
        slope = np.arctan2(drift * np.sign(self.speed), np.abs(self.speed))
        self.yaw = heading + np.where(np.abs(self.speed) > 0.3, slope, 0)

    def gain(self) -> Array:
        """Return the gain of speed at every tick, in m/s2."""
        gained: Array = np.gradient(np.abs(self.speed), TICK)
        return gained


def along(across: Knots, speed: Knots, start: float) -> Motion:
    """Return a motion on a straight road along x."""
    return Motion(line(0.0, 0.0), speed, start, across)


def _even(t: Array, knots: Knots) -> Array:
    pairs = [(0.0, knots)] if isinstance(knots, (int, float)) else knots
    value: Array = np.interp(t, [when for when, _ in pairs], [v for _, v in pairs])
    return value


def _smooth(t: Array, knots: Knots) -> Array:
    pairs = [(0.0, knots)] if isinstance(knots, (int, float)) else knots
    value = np.full_like(t, pairs[0][1])
    for (begin, before), (end, after) in pairwise(pairs):
        later = t >= begin
        u = np.clip((t[later] - begin) / max(end - begin, 1e-9), 0, 1)
        value[later] = before + (after - before) * (u * u * u * (10 - 15 * u + 6 * u * u))
    return value
