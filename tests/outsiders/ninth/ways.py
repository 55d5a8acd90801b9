"""Lines on the ground: pieces as OpenDRIVE knows them, and ways that somebody follows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Knots = Sequence[tuple[float, float]]
FINE_S: Final = 0.01


class Moves(NamedTuple):
    """Where somebody is at some times, how it heads and moves, and how fast it gains speed."""

    x: list[float]
    y: list[float]
    yaw: list[float]
    vx: list[float]
    vy: list[float]
    gain: list[float]

    def trembling(self, seed: int, noise: float) -> Moves:
        """Return the same with noise in places and speeds."""
        random = np.random.default_rng(seed)
        x, y, vx, vy = (
            (np.array(values) + random.normal(0, noise, len(values))).tolist()
            for values in (self.x, self.y, self.vx, self.vy)
        )
        return self._replace(x=x, y=y, vx=vx, vy=vy)


class Piece(NamedTuple):
    """A straight line, an arc, or (with `poly`: bU, cU, dU, cV, dV) a normalised parametric cubic."""

    x: float
    y: float
    heading: float
    length: float
    curvature: float = 0.0
    poly: tuple[float, ...] = ()

    def sample(self, n: int) -> tuple[Array, Array, Array]:
        """Return n points of it, and the heading at each."""
        u, v, turned = (
            self._cubic(np.linspace(0.0, 1.0, n)) if self.poly else self._arc(np.linspace(0.0, self.length, n))
        )
        c, s = math.cos(self.heading), math.sin(self.heading)
        return self.x + c * u - s * v, self.y + s * u + c * v, self.heading + turned

    def end(self) -> tuple[float, float, float]:
        """Return where it ends, and its heading there."""
        x, y, heading = self.sample(2)
        return float(x[-1]), float(y[-1]), float(heading[-1])

    def _arc(self, s: Array) -> tuple[Array, Array, Array]:
        if not self.curvature:
            return s, 0 * s, 0 * s
        a = s * self.curvature
        return np.sin(a) / self.curvature, (1 - np.cos(a)) / self.curvature, a

    def _cubic(self, p: Array) -> tuple[Array, Array, Array]:
        bu, cu, du, cv, dv = self.poly
        turned = np.arctan2(2 * cv * p + 3 * dv * p**2, bu + 2 * cu * p + 3 * du * p**2)
        return bu * p + cu * p**2 + du * p**3, cv * p**2 + dv * p**3, turned


def cubic(start: tuple[float, float, float], end: tuple[float, float, float]) -> Piece:
    """Return a smooth piece from one place and heading to another."""
    (x0, y0, h0), (x1, y1, h1) = start, end
    dx, dy = x1 - x0, y1 - y0
    u1, v1 = math.cos(h0) * dx + math.sin(h0) * dy, -math.sin(h0) * dx + math.cos(h0) * dy
    k = math.hypot(u1, v1) * 1.05
    a = h1 - h0
    tu, tv = k * math.cos(a), k * math.sin(a)
    piece = Piece(x0, y0, h0, 1.0, 0.0, (k, 3 * u1 - 2 * k - tu, k + tu - 2 * u1, 3 * v1 - tv, tv - 2 * v1))
    x, y, _ = piece.sample(2001)
    return piece._replace(length=float(np.hypot(np.diff(x), np.diff(y)).sum()))


def chain(x: float, y: float, heading: float, bends: list[tuple[float, float]]) -> list[Piece]:
    """Return pieces one after another: lengths and curvatures."""
    pieces = []
    for length, curvature in bends:
        pieces.append(Piece(x, y, heading, length, curvature))
        x, y, heading = pieces[-1].end()
    return pieces


class Way:
    """A dense line of points that somebody follows."""

    def __init__(self, x: Array, y: Array, heading: Array) -> None:
        keep = np.concatenate(([True], np.hypot(np.diff(x), np.diff(y)) > 1e-6))
        self.x, self.y, self.heading = x[keep], y[keep], np.unwrap(heading[keep])
        self.s = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(self.x), np.diff(self.y)))))
        self.length = float(self.s[-1])

    def back(self) -> Way:
        """Return it the other way round."""
        return Way(self.x[::-1], self.y[::-1], self.heading[::-1] + math.pi)

    def at(self, s: Array, d: Array) -> tuple[Array, Array, Array]:
        """Return places along it and to its left, and its heading there; beyond its ends it goes straight on."""
        x, y, heading = (np.interp(s, self.s, a) for a in (self.x, self.y, self.heading))
        over = np.where(s > self.length, s - self.length, np.where(s < 0, s, 0.0))
        x, y = x + np.cos(heading) * over, y + np.sin(heading) * over
        return x - np.sin(heading) * d, y + np.cos(heading) * d, heading

    def beside(self, left: float) -> Way:
        """Return the way so far to its left."""
        return Way(self.x - left * np.sin(self.heading), self.y + left * np.cos(self.heading), self.heading)

    def travel(self, start: float, speeds: Knots, left: Knots, until: float, times: Sequence[float]) -> Moves:
        """Return how somebody moves along it who is at the start at 0 s."""
        t = np.arange(0.0, until + 1.0, FINE_S) - 0.5
        v = np.interp(t, [when for when, _ in speeds], [speed for _, speed in speeds])
        s = np.concatenate(([0.0], np.cumsum((v[1:] + v[:-1]) * 0.005)))
        s = s - np.interp(0.0, t, s) + start
        d = np.full_like(t, left[0][1])
        for (a, da), (b, db) in pairwise(left):
            u = np.clip((t - a) / max(b - a, 1e-6), 0.0, 1.0)
            d = d + (db - da) * (10 * u**3 - 15 * u**4 + 6 * u**5)
        x, y, heading = self.at(s, d)
        yaw = heading + np.arctan2(np.gradient(d, FINE_S), np.maximum(np.abs(v), 1.0)) * np.sign(v)
        columns = (x, y, yaw, np.gradient(x, FINE_S), np.gradient(y, FINE_S), np.gradient(v, FINE_S) * np.sign(v))
        return Moves(*(np.interp(times, t, column).tolist() for column in columns))


def gone(speeds: Knots, t: float) -> float:
    """Return the way that is gone in a time."""
    steps = np.linspace(0, t, 4001)
    v = np.interp(steps, [when for when, _ in speeds], [speed for _, speed in speeds])
    return float(((v[1:] + v[:-1]) / 2).sum() * (t / 4000))


def when(speeds: Knots, start: float, s: float) -> float:
    """Return the time of getting from the start to s."""
    early, late = 0.0, 120.0
    for _ in range(60):
        middle = (early + late) / 2
        early, late = (middle, late) if start + gone(speeds, middle) < s else (early, middle)
    return early


def along(pieces: list[Piece], left: float | list[float] = 0.0) -> Way:
    """Return the way along pieces and to the left of them: by one number, or by one at each of their ends."""
    lefts = left if isinstance(left, list) else [left] * (len(pieces) + 1)
    found: list[tuple[Array, Array, Array]] = []
    for piece, start, end in zip(pieces, lefts[:-1], lefts[1:], strict=True):
        n = max(3, int(piece.length / (0.1 if piece.curvature or piece.poly else 1.0)))
        x, y, heading = piece.sample(n)
        d = np.linspace(start, end, n)
        found.append((x - np.sin(heading) * d, y + np.cos(heading) * d, heading))
    parts: Any = zip(*found, strict=True)
    return Way(*(np.concatenate(part) for part in parts))


def straight(x0: float, y0: float, x1: float, y1: float) -> Way:
    """Return the straight way between two points."""
    n = max(2, int(math.hypot(x1 - x0, y1 - y0)))
    heading = math.atan2(y1 - y0, x1 - x0)
    return Way(np.linspace(x0, x1, n), np.linspace(y0, y1, n), np.full(n, heading))


def meet(one: Way, other: Way, beyond: float = 0.0) -> tuple[float, float]:
    """Return where the one comes nearest to the other, beyond a place on it: the way along each."""
    keep = np.flatnonzero(one.s >= beyond)
    gap = np.hypot(one.x[keep][:, None] - other.x[None, :], one.y[keep][:, None] - other.y[None, :])
    i, j = np.unravel_index(int(gap.argmin()), gap.shape)
    return float(one.s[keep][i]), float(other.s[j])
