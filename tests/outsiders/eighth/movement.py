"""Who moves how along a way, and what the log gets wrong of it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np

from tests.outsiders.eighth.ways import Array, Way
from tests.outsiders.log import Box, Size, at

FINE_S: Final = 0.01
PAD_S: Final = 2.0  # worked out before the log begins and after it ends
SIZES: Final[dict[str, Size]] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.6, 2.0, 2.3),
    "truck": (9.0, 2.5, 3.5),
    "bus": (12.0, 2.55, 3.1),
    "motorcycle": (2.1, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "pedestrian": (0.5, 0.6, 1.75),
    "animal": (2.4, 0.8, 2.4),
    "object": (1.0, 1.0, 1.0),
    "trailer": (10.0, 2.5, 3.8),
    "vehicle": (4.6, 1.85, 1.5),
}
_LAMPLESS: Final = {"pedestrian", "animal", "object", "bicycle"}
_COLUMNS: Final = (
    "actor_id", "t_ns", "x_m", "y_m", "z_m", "yaw_rad", "vx_mps", "vy_mps", "indicator", "brake_light",
)  # fmt: skip

Knots = Sequence[tuple[float, float]]


class Actor(NamedTuple):
    """Somebody on a way: from s0 on with these speeds, and so far to its left."""

    name: str
    kind: str | None
    way: Way
    s0: float
    speed: Knots
    left: Knots = ((0, 0),)
    size: Size = (None, None, None)
    blink: Sequence[tuple[float, str]] = ((0, "off"),)
    there: tuple[float, float] = (0.0, math.inf)  # the time for which the log knows them
    gaps: Sequence[tuple[float, float]] = ()  # and when it does not
    turned: bool = False  # the log has the heading turned round
    noise: float = 0.0
    frozen: tuple[float, float] | None = None
    jump: tuple[float, float, float] | None = None  # from, to, metres along x
    soft: float = 0.8  # so long an acceleration takes to come
    z: float = 0.0

    def box(self) -> Box:
        """Return what the log knows of its kind and size."""
        return Box(self.name, self.kind, self.size)

    def states(self, until: float, rate: int, random: np.random.Generator) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`."""
        return dict(zip(_COLUMNS, map(list, zip(*self._rows(until, rate, random), strict=True)), strict=True))

    def _rows(self, until: float, rate: int, random: np.random.Generator) -> Iterator[tuple[Any, ...]]:
        x, y, yaw, vx, vy, acceleration = self._movement(until)
        lamps = self.kind not in _LAMPLESS
        for i in range(round(until * rate) + 1):
            t = i / rate
            if not self._known(t):
                continue
            held = self.frozen[0] if self.frozen and self.frozen[0] <= t <= self.frozen[1] else t
            k = round((held + PAD_S) / FINE_S)
            place = [x[k], y[k]]
            if self.jump and self.jump[0] <= t <= self.jump[1]:
                place[0] += self.jump[2]
            if self.noise:
                place = [place[0] + random.normal(0, self.noise), place[1] + random.normal(0, self.noise)]
            heading = yaw[k] + (math.pi if self.turned else 0)
            heading = (heading + math.pi) % (2 * math.pi) - math.pi
            yield (
                self.name,
                round(t * 1e9),
                *(round(float(v), 4) for v in place),
                self.z,
                round(float(heading), 5),
                round(float(vx[k]), 4),
                round(float(vy[k]), 4),
                at(self.blink, t) if lamps else None,
                ("on" if acceleration[k] < -0.6 else "off") if lamps else None,
            )

    def _known(self, t: float) -> bool:
        hidden = any(begin <= t <= end for begin, end in self.gaps)
        return self.there[0] - 1e-9 <= t <= self.there[1] + 1e-9 and not hidden

    def _movement(self, until: float) -> tuple[Array, ...]:
        """Return positions, headings, velocities and the acceleration along the way."""
        t = np.arange(-PAD_S, until + PAD_S + FINE_S / 2, FINE_S)
        v = np.interp(t, [k[0] for k in self.speed], [k[1] for k in self.speed])
        if self.soft:
            n = int(self.soft / FINE_S) // 2 * 2 + 1
            v = np.convolve(np.pad(v, n // 2, mode="edge"), np.ones(n) / n, "valid")
        s = np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * FINE_S)])
        d = np.full_like(t, self.left[0][1], dtype=float)
        for (begin, a), (end, b) in pairwise(self.left):
            here = (t >= begin) & (t < end)
            d[here] = a + (b - a) * (1 - np.cos(math.pi * (t[here] - begin) / (end - begin))) / 2
        d[t >= self.left[-1][0]] = self.left[-1][1]
        x, y, heading = self.way.pose(s - np.interp(0, t, s) + self.s0)
        x, y = x - np.sin(heading) * d, y + np.cos(heading) * d
        drift = np.arctan2(np.gradient(d, FINE_S) * np.sign(v), np.maximum(np.abs(v), 1.0))
        yaw = heading + np.where(np.abs(v) > 0.3, drift, 0)
        return x, y, yaw, np.gradient(x, FINE_S), np.gradient(y, FINE_S), np.gradient(v, FINE_S)


def who(  # noqa: PLR0917
    name: str, kind: str | None, way: Way, s0: float, speed: float | Knots, left: float | Knots = 0, **more: Any
) -> Actor:
    """An actor; a speed or place across that does not change is one number."""
    size = more.pop("size", None) or SIZES[kind or "vehicle"]
    return Actor(name, kind, way, s0, _knots(speed), _knots(left), size, **more)


def ego(way: Way, s0: float, speed: float | Knots, left: float | Knots = 0, **more: Any) -> Actor:
    """The ego: a car, if nothing else is said."""
    return who("ego", more.pop("kind", "car"), way, s0, speed, left, **more)


def car(name: str, way: Way, s0: float, speed: float | Knots, left: float | Knots = 0, **more: Any) -> Actor:
    """Another car."""
    return who(name, "car", way, s0, speed, left, **more)


def _knots(value: float | Knots) -> Knots:
    return [(0.0, float(value))] if isinstance(value, int | float) else value
