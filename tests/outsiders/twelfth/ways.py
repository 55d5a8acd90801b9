"""Where somebody is at a time: along x, along lines and arcs, or on foot from point to point."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

Speeds = float | Sequence[tuple[float, float]]  # one speed, or (time, speed), between which it changes evenly
Moves = Sequence[tuple[float, float, float]]  # begin, duration, place across that is reached
Point = tuple[float, float, float]  # time, x, y


class Pose(NamedTuple):
    """Place, heading and velocity."""

    x: float
    y: float
    heading: float
    vx: float
    vy: float


class Motion(Protocol):
    """Whatever knows where it is at a time."""

    def at(self, t: float) -> Pose:
        """Return the pose at a time in seconds."""


class Piece(NamedTuple):
    """A line (curvature 0) or an arc."""

    x: float
    y: float
    heading: float
    length: float
    curvature: float


class Path:
    """Lines and arcs that follow each other; begins at x, y with a heading in degrees."""

    def __init__(self, x: float, y: float, degrees: float) -> None:
        self.pieces: list[Piece] = []
        self.end = (x, y, math.radians(degrees))

    @property
    def length(self) -> float:
        return sum(piece.length for piece in self.pieces)

    def fwd(self, length: float) -> Path:
        """Go on straight."""
        x, y, h = self.end
        self.pieces.append(Piece(x, y, h, length, 0.0))
        self.end = (x + length * math.cos(h), y + length * math.sin(h), h)
        return self

    def arc(self, radius: float, degrees: float) -> Path:
        """Go on along an arc, to the left if the angle is positive."""
        x, y, h = self.end
        a = math.radians(degrees)
        k = math.copysign(1 / radius, a)
        self.pieces.append(Piece(x, y, h, abs(a) * radius, k))
        self.end = (x + (math.sin(h + a) - math.sin(h)) / k, y - (math.cos(h + a) - math.cos(h)) / k, h + a)
        return self

    def at(self, s: float) -> tuple[float, float, float]:
        """Return place and heading; before and after the path it goes on as it begins and ends."""
        left = s
        for piece in self.pieces[:-1]:
            if left <= piece.length:
                return _on(piece, left)
            left -= piece.length
        return _on(self.pieces[-1], left)


class Profile:
    """A speed that changes evenly between times, and the way made with it."""

    def __init__(self, speeds: Speeds) -> None:
        knots = [(0.0, float(speeds))] if isinstance(speeds, int | float) else speeds
        self.times = np.array([t for t, _ in knots], float)
        self.speeds = np.array([v for _, v in knots], float)
        steps = np.diff(self.times) * (self.speeds[1:] + self.speeds[:-1]) / 2
        self.made = np.concatenate([[0.0], np.cumsum(steps)])

    def speed(self, t: float) -> float:
        return float(np.interp(t, self.times, self.speeds))

    def way(self, t: float) -> float:
        ts, vs = self.times, self.speeds
        if t <= ts[0]:
            return float((t - ts[0]) * vs[0])
        if t >= ts[-1]:
            return float(self.made[-1] + (t - ts[-1]) * vs[-1])
        i = int(np.searchsorted(ts, t, side="right")) - 1
        return float(self.made[i] + (t - ts[i]) * (vs[i] + self.speed(t)) / 2)


class Straight:
    """Along x, forwards (way 1) or backwards (way -1), with moves across; a speed below 0 is reversing."""

    def __init__(self, x: float, y: float, speeds: Speeds, moves: Moves = (), way: int = 1) -> None:
        self.x, self.y, self.moves, self.way = x, y, moves, way
        self.profile = Profile(speeds)

    def across(self, t: float) -> tuple[float, float]:
        """Return y and its speed: a move is a quintic that begins and ends at rest."""
        y = self.y
        for begin, lasts, reached in self.moves:
            if t >= begin + lasts:
                y = reached
            elif t > begin:
                u = (t - begin) / lasts
                speed = (reached - y) * 30 * (u**2 - 2 * u**3 + u**4) / lasts
                return y + (reached - y) * (10 * u**3 - 15 * u**4 + 6 * u**5), speed
        return y, 0.0

    def at(self, t: float) -> Pose:
        y, vy = self.across(t)
        v = self.profile.speed(t)
        heading = 0.0 if self.way > 0 else math.pi
        if abs(v) > 0.3:
            heading += math.atan2(vy * self.way * (1 if v > 0 else -1), abs(v))
        return Pose(self.x + self.way * self.profile.way(t), y, heading, self.way * v, vy)


class Along:
    """Along a path from s0 on, off metres to its left, with moves across."""

    def __init__(self, path: Path, s0: float, speeds: Speeds, off: float = 0.0, moves: Moves = ()) -> None:
        self.path, self.s0 = path, s0
        self.profile = Profile(speeds)
        self.side = Straight(0, off, 1.0, moves)

    def at(self, t: float) -> Pose:
        x, y, h = self.path.at(self.s0 + self.profile.way(t))
        v = self.profile.speed(t)
        off, side = self.side.across(t)
        heading = h
        if abs(v) > 0.3:
            heading += math.atan2(side * (1 if v > 0 else -1), abs(v))
        return Pose(
            x - off * math.sin(h),
            y + off * math.cos(h),
            heading,
            v * math.cos(h) - side * math.sin(h),
            v * math.sin(h) + side * math.cos(h),
        )


class Walk:
    """Somebody on foot, from point to point."""

    def __init__(self, points: Sequence[Point]) -> None:
        self.points = points

    def at(self, t: float) -> Pose:
        times = [point[0] for point in self.points]
        x = float(np.interp(t, times, [point[1] for point in self.points]))
        y = float(np.interp(t, times, [point[2] for point in self.points]))
        i = min(max(int(np.searchsorted(times, t, side="right")) - 1, 0), len(self.points) - 2)
        (t0, x0, y0), (t1, x1, y1) = self.points[i], self.points[i + 1]
        walks = t0 <= t < t1
        vx, vy = ((x1 - x0) / (t1 - t0), (y1 - y0) / (t1 - t0)) if walks else (0.0, 0.0)
        return Pose(x, y, math.atan2(y1 - y0, x1 - x0), vx, vy)


def _on(piece: Piece, u: float) -> tuple[float, float, float]:
    x, y, h, _, k = piece
    if k == 0:
        return x + u * math.cos(h), y + u * math.sin(h), h
    a = k * u
    return x + (math.sin(h + a) - math.sin(h)) / k, y - (math.cos(h + a) - math.cos(h)) / k, h + a
