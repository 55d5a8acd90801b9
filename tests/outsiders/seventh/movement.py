"""Who moves how along a way: speeds told as a story, and places across it that change smoothly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tests.outsiders.log import Box, at

if TYPE_CHECKING:
    from tests.outsiders.seventh.ways import Array, Way

FINE_S = 0.01  # the step at which movements are worked out
PAD_S = 1.5  # worked out before the log begins and after it ends
STRONG_MPS2, LIT_MPS2 = -5, -0.6  # braking that brake lights show
CAR = (4.5, 1.8, 1.5)

Knots = Sequence[tuple[float, float]]
Lamps = Sequence[tuple[float, str]]


class Pace:
    """A speed over time, told as a story."""

    def __init__(self, speed: float) -> None:
        self.knots = [(0.0, float(speed))]

    def hold(self, seconds: float) -> Self:
        """Keep the speed."""
        time, speed = self.knots[-1]
        self.knots.append((time + seconds, speed))
        return self

    def to(self, speed: float, rate: float) -> Self:
        """Come to another speed."""
        time, before = self.knots[-1]
        self.knots.append((time + abs(speed - before) / rate, float(speed)))
        return self

    def until(self, metres: float) -> Self:
        """Keep the speed until so far from the start."""
        return self.hold(max(0.0, (metres - self._gone()) / self.knots[-1][1]))

    def slow(self, metres: float, speed: float, rate: float) -> Self:
        """Slow down such that the speed is reached so far from the start."""
        before = self.knots[-1][1]
        return self.until(metres - abs(before * before - speed * speed) / 2 / rate).to(speed, rate)

    def stop(self, metres: float, rate: float) -> Self:
        """Stop so far from the start."""
        return self.slow(metres, 0.0, rate)

    def _gone(self) -> float:
        return sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in pairwise(self.knots))


@dataclass
class Actor:
    """Somebody who goes along a way, from `start` metres on it; `side`: metres to its left, over time."""

    name: str
    way: Way
    pace: Pace | float
    start: float = 0.0
    side: Knots = ((0, 0),)
    kind: str | None = "car"
    size: tuple[float, float, float] | None = CAR
    lamps: Lamps = ()
    begin: float = 0.0  # the time from which on the log knows them, and the last one
    end: float = 1e9
    flipped: bool = False  # the log has the heading turned round
    z: float | None = None
    smooth: float = 0.8  # seconds over which a change of speed is spread
    jump: tuple[float, float, float, float] | None = None  # from, to: recorded so far off in x and y
    freeze: float = 1e9  # from then on the track stands still
    noise: float = 0.0

    def box(self) -> Box:
        """Return what the log knows of its kind and size."""
        return Box(self.name, self.kind, self.size or (None, None, None))

    def states(self, until: float, hertz: float, high: bool, seed: int) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`; `high`: whether the log knows heights."""
        fine = np.arange(-PAD_S, until + PAD_S + FINE_S, FINE_S)
        x, y, yaw, rate = self._movement(fine)
        vx, vy = np.gradient(x, FINE_S), np.gradient(y, FINE_S)
        random = np.random.default_rng(seed)
        times = [i / hertz for i in range(round(until * hertz) + 1)]
        times = [t for t in times if self.begin - 1e-9 <= t <= self.end + 1e-9]
        which = [round((min(t, self.freeze) + PAD_S) / FINE_S) for t in times]
        off = np.array([self._off(t) for t in times])
        if self.noise:
            off += [[random.normal(0, self.noise), random.normal(0, self.noise)] for _ in times]
        turned = yaw[which] + (math.pi if self.flipped else 0)
        columns = {
            "actor_id": [self.name] * len(times),
            "t_ns": [round(t * 1e9) for t in times],
            "x_m": (x[which] + off[:, 0]).tolist(),
            "y_m": (y[which] + off[:, 1]).tolist(),
            "z_m": [self.z] * len(times),
            "yaw_rad": ((turned + math.pi) % (2 * math.pi) - math.pi).tolist(),
            "vx_mps": vx[which].tolist(),
            "vy_mps": vy[which].tolist(),
            "indicator": [at([(0, "off"), *self.lamps], t) for t in times],
            "brake_light": ["strong" if a < STRONG_MPS2 else "on" if a < LIT_MPS2 else "off" for a in rate[which]],
        }
        return columns if high else {name: values for name, values in columns.items() if name != "z_m"}

    def _movement(self, fine: Array) -> tuple[Array, Array, Array, Array]:
        """Return places, headings, and how the speed changes."""
        knots = self.pace.knots if isinstance(self.pace, Pace) else [(0.0, float(self.pace))]
        speed = np.interp(fine, [t for t, _ in knots], [v for _, v in knots])
        if (n := int(self.smooth / FINE_S)) > 1:
            edges = [np.full(n // 2, speed[0]), speed, np.full(n - 1 - n // 2, speed[-1])]
            speed = np.convolve(np.concatenate(edges), np.ones(n) / n, "valid")[: len(fine)]
        s = np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2 * FINE_S)])
        s = s - np.interp(0, fine, s) + self.start
        side = np.full_like(fine, self.side[0][1])
        for (t0, d0), (t1, d1) in pairwise(self.side):
            u = np.clip((fine - t0) / max(t1 - t0, 1e-6), 0, 1)
            side += (d1 - d0) * (u * u * u * (10 - 15 * u + 6 * u * u))
        x, y, heading = self.way.at(s)
        x, y = x - side * np.sin(heading), y + side * np.cos(heading)
        across = np.gradient(side, FINE_S)
        yaw = heading + np.arctan2(across, np.maximum(np.abs(speed), 1.0)) * np.where(speed < 0, -1, 1)
        return x, y, yaw, np.gradient(speed, FINE_S)

    def _off(self, time: float) -> tuple[float, float]:
        """Return how far off the track is recorded."""
        if self.jump and self.jump[0] <= time < self.jump[1]:
            return self.jump[2], self.jump[3]
        return 0.0, 0.0


def ego(way: Way, pace: Pace | float, **more: Any) -> Actor:
    """The ego: a car, if nothing else is said."""
    return Actor("ego", way, pace, **more)
