"""Ways through the plane, and the speeds at which they are gone along."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike


class Path:
    """A way through the plane, measured by its length."""

    def __init__(self, points: ArrayLike) -> None:
        every = np.asarray(points, float)
        apart = np.r_[True, np.hypot(*np.diff(every, axis=0).T) > 1e-6]
        self.points = every[apart]
        self.s = np.r_[0, np.cumsum(np.hypot(*np.diff(self.points, axis=0).T))]
        along = np.gradient(self.points, self.s, axis=0)
        self.heading = np.unwrap(np.arctan2(along[:, 1], along[:, 0]))
        self.length = float(self.s[-1])

    def at(self, s: float) -> tuple[float, float, float]:
        """Return position and heading; beyond its ends the way goes straight on."""
        heading = float(np.interp(s, self.s, self.heading))
        x, y = (float(np.interp(s, self.s, self.points[:, axis])) for axis in (0, 1))
        over = s - self.length if s > self.length else min(s, 0.0)
        return x + over * math.cos(heading), y + over * math.sin(heading), heading

    def near(self, x: float, y: float) -> float:
        """Return how far along it the point nearest to x, y is."""
        return float(self.s[np.argmin(np.hypot(self.points[:, 0] - x, self.points[:, 1] - y))])

    def __add__(self, other: Path) -> Path:
        return Path(np.vstack([self.points, other.points]))


class Speed:
    """Pieces of constant acceleration strung together, from the place s on."""

    def __init__(self, v: float, s: float = 0.0) -> None:
        self.pieces: list[tuple[float, float, float, float]] = []  # from t on: s, v, a
        self.t, self.s, self.v = 0.0, s, v

    def hold(self, seconds: float) -> Speed:
        return self._add(seconds, 0.0)

    def till(self, t: float) -> Speed:
        return self._add(t - self.t, 0.0)

    def at(self, s: float) -> Speed:
        return self._add((s - self.s) / self.v, 0.0)

    def acc(self, a: float, seconds: float) -> Speed:
        return self._add(seconds, a)

    def to(self, v: float, a: float) -> Speed:
        return self._add(abs(v - self.v) / a, math.copysign(a, v - self.v))

    def stop_at(self, s: float, a: float) -> Speed:
        """Go on at this speed until braking with a brings it to a halt at s."""
        self.at(s - self.v**2 / (2 * a) * (1 if self.v > 0 else -1))
        return self.to(0, a)

    def jump(self, v: float) -> Speed:
        """Go on at another speed at once, as people on foot can."""
        self.v = v
        return self

    def __call__(self, t: float) -> tuple[float, float, float]:
        """Return place, speed and acceleration."""
        pieces = [*self.pieces, (self.t, self.s, self.v, 0.0)]
        t0, s0, v0, a = next((piece for piece in reversed(pieces) if piece[0] <= t + 1e-9), pieces[0])
        d = t - t0
        return s0 + v0 * d + a * d * d / 2, v0 + a * d, a

    def _add(self, dt: float, a: float) -> Speed:
        if dt > 1e-9:
            self.pieces.append((self.t, self.s, self.v, a))
            self.t += dt
            self.s += self.v * dt + a * dt * dt / 2
            self.v += a * dt
            if abs(self.v) < 1e-9:
                self.v = 0.0
        return self


def on_foot(points: Sequence[tuple[float, float]], v: float, t: float) -> tuple[Path, Speed]:
    """Return the way and the speed of somebody who stands until t, walks to the end at v and stays there."""
    (x0, y0), (x1, y1) = points
    speed = Speed(0).hold(t).jump(v).hold(math.hypot(x1 - x0, y1 - y0) / v).jump(0.0)
    return Path(points), speed
