"""How actors of a story move: speeds by station, halts, steps to the side; nothing is jerky."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from tests.scenes import Actor

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from tests.demo.line import Line

    Floats = NDArray[np.float64]

HZ = 10
_FINE = 0.02  # s, of the simulation
_GRID_M = 0.1
_BACK_MPS = 1.5


def smooth(u: ArrayLike) -> Floats:
    """Return a smooth step from 0 at u = 0 to 1 at u = 1, without a jump in its first two derivatives."""
    v = np.clip(np.asarray(u, np.float64), 0.0, 1.0)
    found: Floats = v**3 * (v * (6 * v - 15) + 10)
    return found


@dataclass
class Plan:
    """How somebody drives along a line: greatest speeds on stretches (`speed` elsewhere), halts, steps to the side."""

    start: float
    offset: float
    speed: float
    limits: list[tuple[float, float, float]] = field(default_factory=list)
    halts: list[tuple[float, float, float]] = field(default_factory=list)
    shifts: list[tuple[float, float, float]] = field(default_factory=list)
    brake: float = 1.1
    pull: float = 1.2
    rounding_s: float = 1.6
    """Length of the window that rounds the corners of the speed."""

    def slow(self, start: float, end: float, speed: float) -> None:
        """Drive no faster than this between two stations."""
        self.limits.append((start, end, speed))

    def halt(self, at: float, seconds: float, *, back: float = 0.0) -> None:
        """Come to stand with the centre at a station, for so long; then go back so far, at walking pace."""
        self.halts.append((at, seconds, back))

    def shift(self, by: float, at: float, within: float) -> None:
        """Move to the nearside by so much, beginning at a station, within a distance."""
        self.shifts.append((at, within, by))

    def stations(self, line: Line, h: int) -> tuple[Floats, Floats]:
        """Return times from 0 at `HZ`, and the stations at them, until 30 m before the end of the line.

        Speeds are those of the actor itself: a station on the line is shorter or longer where it drives beside it in a bend.
        """
        end = line.length_m
        grid = np.arange(0.0, end, _GRID_M)
        n = self.offsets(grid)
        scale = np.hypot(1.0 - line.curvature(grid) * n * h, np.gradient(n, _GRID_M))
        made = np.concatenate([[0.0], np.cumsum((scale[1:] + scale[:-1]) / 2 * _GRID_M)])
        halts = sorted(self.halts)
        s, v, waiting, back, way = self.start, self.speed, 0.0, 0.0, [self.start]
        while s < end - 30.0 and len(way) < 60 * 60 / _FINE:
            if waiting > 0.0 or back > 0.0:
                step = 0.0 if waiting > 0.0 else _BACK_MPS * _FINE
                waiting, back, s = waiting - _FINE, back - step, s - step
                way.append(s)
                continue
            here = scale[min(int(s / _GRID_M), len(scale) - 1)]
            free = min((top for a, b, top in self.limits if a <= s <= b), default=self.speed)
            ahead = [np.sqrt(top**2 + 2 * self.brake * (a - s)) for a, b, top in self.limits if s < a]
            gap = halts[0][0] - s if halts else np.inf
            target = min([free, *ahead, np.sqrt(2 * self.brake * max(gap, 0.0))])
            v = min(v + self.pull * _FINE, float(target))
            if gap < 0.02:
                _, waiting, back = halts.pop(0)
                v = 0.0
            s += v * _FINE / here
            way.append(s)
        fine = np.interp(way, grid, made)
        n_window = round(self.rounding_s / _FINE) | 1
        window = np.hanning(n_window + 2)[1:-1]
        before = fine[0] - self.speed * _FINE * np.arange(n_window // 2, 0, -1)
        after = fine[-1] + (fine[-1] - fine[-2]) * np.arange(1, n_window // 2 + 1)
        rounded = np.convolve(np.concatenate([before, fine, after]), window / window.sum(), "valid")
        every = round(1 / (HZ * _FINE))
        found: Floats = np.interp(rounded[::every], made, grid)
        return np.arange(len(found)) / HZ, found

    def offsets(self, s: Floats) -> Floats:
        """Return the nearside offset at stations."""
        n = np.full(s.shape, self.offset)
        for at, within, by in self.shifts:
            n = n + by * smooth((s - at) / within)
        return n


@dataclass(frozen=True)
class Body:
    """Class and box."""

    kind: str
    length: float
    width: float


CAR = Body("car", 4.8, 1.8)
BUS = Body("bus", 11.0, 2.5)
BICYCLE = Body("bicycle", 1.8, 0.6)
WALKER = Body("pedestrian", 0.5, 0.5)
HORSE = Body("animal", 2.2, 0.6)


def track(name: str, body: Body, line: Line, h: int, t: Floats, s: Floats, n: Floats, *, turned: float = 0.0) -> Actor:  # noqa: PLR0917
    """Return an actor at stations s and nearside offsets n of a line; it heads along it, turned by so much.

    `turned`: pi for who comes the other way; heading and velocity else follow from the motion, or from the line at rest.
    """
    x, y, heading = line.at(s, n * h)
    vx, vy = np.gradient(x, t), np.gradient(y, t)
    along, across = np.gradient(s, t), np.gradient(n * h, t)
    drift = np.where(np.abs(along) > 0.3, np.arctan2(across * np.sign(along), np.abs(along)), 0.0)
    yaw = heading + turned + drift
    return Actor(name, t, x, y, np.arctan2(np.sin(yaw), np.cos(yaw)), vx, vy, body.length, body.width, body.kind)
