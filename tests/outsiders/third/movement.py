"""Who moves how along a way: speeds and places across it that change smoothly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from tests.outsiders.log import Box, Size
from tests.outsiders.third.ways import Array, Way

MPH = 0.44704
KMH = 1 / 3.6
N, F = 1.75, -1.75  # centre of the own lane, and of the opposing one, of a road with two lanes
FINE_S = 0.02  # the step at which movements are worked out before they are sampled
PAD_S = 2.0  # worked out before the log begins and after it ends

Knots = Sequence[tuple[float, float]]
Blink = Sequence[tuple[float, float, str]]  # from, to, near / far / hazard
SIZES: dict[str, tuple[float, float, float]] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.5, 2.0, 2.3),
    "truck": (12.0, 2.5, 3.8),
    "bus": (12.0, 2.5, 3.2),
    "motorcycle": (2.2, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (5.0, 2.1, 2.2),
    "pedestrian": (0.5, 0.6, 1.75),
    "animal": (2.4, 0.8, 2.3),
    "object": (1.0, 1.0, 1.0),
}
UNKNOWN: Size = (None, None, None)


class Actor(NamedTuple):
    """Somebody who moves along a way: at the time at[0] they are at the place at[1]."""

    name: str
    kind: str | None
    way: Way
    at: tuple[float, float]
    speed: Knots
    d: Knots  # metres to the left of the way (right, in a mirrored scene)
    size: Size
    blink: Blink | None = ()  # None: not known
    there: tuple[float, float] = (0.0, 1e9)  # the time for which the log knows them
    z: float = 0.0
    noise: float = 0.0
    flipped: bool = False  # the log has the heading turned round

    def box(self) -> Box:
        """Return what the log knows of its kind and size."""
        return Box(self.name, self.kind, self.size)

    def states(
        self, until: float, step: float, hand: int, high: bool, random: np.random.Generator
    ) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`; `high`: whether the log knows heights."""
        t, x, y, vx, vy, ax, ay, yaw = self._movement(until, step)
        trembling = random.normal(0, 1, (2, len(t))) * self.noise
        yaw = yaw * hand + (math.pi if self.flipped else 0)
        return {
            "actor_id": [self.name] * len(t),
            "t_ns": [nanoseconds(when) for when in t],
            "x_m": (x + trembling[0]).tolist(),
            "y_m": ((y + trembling[1]) * hand).tolist(),
            "z_m": [self.z if high else None] * len(t),
            "yaw_rad": np.arctan2(np.sin(yaw), np.cos(yaw)).tolist(),
            "vx_mps": vx.tolist(),
            "vy_mps": (vy * hand).tolist(),
            "ax_mps2": ax.tolist(),
            "ay_mps2": (ay * hand).tolist(),
            "indicator": [self._lamp(when, hand) for when in t],
        }

    def _movement(self, until: float, step: float) -> list[Array]:
        """Return times, positions, speeds, accelerations and headings."""
        time = np.arange(-PAD_S, until + PAD_S, FINE_S)
        speed = np.interp(time, [k[0] for k in self.speed], [k[1] for k in self.speed])
        wide = round(0.8 / FINE_S)  # nobody changes their acceleration at once
        speed = np.convolve(np.pad(speed, wide, mode="edge"), np.ones(wide) / wide, mode="same")[wide:-wide]
        d = _smooth(time, self.d)
        s = np.zeros_like(time)
        for _ in range(12):  # beside the way of a bend the same speed gets on faster or slower along it
            s = np.cumsum(speed / (1 - d * self.way.bend(s))) * FINE_S
            s += self.at[1] - np.interp(self.at[0], time, s)
        x, y, heading = self.way.pose(s)
        x, y = x - d * np.sin(heading), y + d * np.cos(heading)
        soft = np.ones(15) / 15  # where a line becomes an arc, nobody turns the wheel at once
        x, y = np.convolve(x, soft, mode="same"), np.convolve(y, soft, mode="same")
        vx, vy = np.gradient(x, FINE_S), np.gradient(y, FINE_S)
        ax, ay = np.gradient(vx, FINE_S), np.gradient(vy, FINE_S)
        sideways = np.gradient(d, FINE_S)
        fast = np.abs(speed) > 0.3
        yaw = heading + np.where(fast, np.arctan(sideways / np.where(fast, speed, 1)), 0)
        keep = np.round((np.arange(0, until + 1e-9, step) + PAD_S) / FINE_S).astype(int)
        t = np.round(time[keep], 3)
        keep = keep[(t >= self.there[0]) & (t <= self.there[1])]
        return [column[keep] for column in (np.round(time, 3), x, y, vx, vy, ax, ay, yaw)]

    def _lamp(self, time: float, hand: int) -> str | None:
        if self.blink is None:
            return None
        near, far = ("left", "right") if hand == 1 else ("right", "left")
        sides = {"near": near, "far": far, "hazard": "hazard"}
        return next((sides[side] for begin, end, side in self.blink if begin <= time < end), "off")


def nanoseconds(time: float) -> int:
    """Return a time of whole milliseconds in nanoseconds."""
    return round(time * 1000) * 1_000_000


def _smooth(time: Array, knots: Knots) -> Array:
    """Between two knots a quintic that starts and ends at rest."""
    out = np.full_like(time, knots[0][1])
    for (t0, d0), (t1, d1) in pairwise(knots):
        u = np.clip((time - t0) / (t1 - t0), 0, 1)
        out += (d1 - d0) * u**3 * (10 - 15 * u + 6 * u * u)
    return out


def _knots(value: float | Knots) -> Knots:
    return [(0.0, float(value))] if isinstance(value, int | float) else value


def who(  # noqa: PLR0917
    name: str,
    kind: str | None,
    way: Way,
    at: tuple[float, float],
    speed: float | Knots,
    d: float | Knots = N,
    **more: Any,
) -> Actor:
    """An actor; a speed or place across that does not change is one number, a size of None is not known."""
    size = more.pop("size", SIZES[kind or "car"]) or UNKNOWN
    return Actor(name, kind, way, at, _knots(speed), _knots(d), size, **more)


def ego(way: Way, at: tuple[float, float], speed: float | Knots, d: float | Knots = N, **more: Any) -> Actor:
    """The ego: a car, if nothing else is said."""
    return who("ego", more.pop("kind", "car"), way, at, speed, d, **more)


def car(way: Way, at: tuple[float, float], speed: float | Knots, d: float | Knots = N, **more: Any) -> Actor:
    """Another car."""
    return who(more.pop("name", "car"), "car", way, at, speed, d, **more)
