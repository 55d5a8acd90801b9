"""Who moves how: along straights and arcs, at speeds and lateral places that change smoothly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.outsiders.log import Box, Size, at

Array = NDArray[np.float64]
Knots = float | Sequence[tuple[float, float]]  # a constant, or (time, value) with smooth change between
Steps = Sequence[tuple[float, str]]  # (time, value) from then on

NEAR, FAR = -1.75, 1.75  # lane centres of a road with two lanes of 3.5 m
KMH = 1 / 3.6
DT = 0.01  # step of the internal integration, s


class Line:
    """Straights and arcs; `zero` metres after its start its s is 0; straight on beyond both ends."""

    def __init__(
        self, start: tuple[float, float, float], pieces: Sequence[tuple[float, float]], zero: float = 0
    ) -> None:
        before, after, step = 1500.0, 2500.0, 0.1
        curvature = [np.zeros(round(before / step))]
        curvature += [np.full(round(length / step), bend) for length, bend in pieces]
        curvature.append(np.zeros(round(after / step)))
        k = np.concatenate(curvature)
        sharp = np.abs(k).max() > 1 / 50  # a driver turns the wheel over some metres
        window = 41 if sharp else 201
        k = np.convolve(k, np.full(window, 1 / window), mode="same")
        first = round(before / step)
        bends = np.concatenate([[0.0], np.cumsum(k * step)])
        h = bends + start[2]
        middle = (h[1:] + h[:-1]) / 2
        x = np.concatenate([[0.0], np.cumsum(np.cos(middle) * step)])
        y = np.concatenate([[0.0], np.cumsum(np.sin(middle) * step)])
        self.s = np.arange(len(h)) * step - before - zero
        early, back = first - 150, 150 * step  # a point that is certainly on the first straight
        self.x = x - x[early] + start[0] - back * math.cos(start[2])
        self.y = y - y[early] + start[1] - back * math.sin(start[2])
        self.h = h
        self.k = np.append(k, 0.0)


def follow(knots: Knots, t: Array, order: int) -> Array:
    """The knots' value at each time, changing as a smooth step of third or fifth order."""
    if isinstance(knots, int | float):
        return np.full(len(t), float(knots))
    times, values = np.array(knots, dtype=float).T
    i = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 2)
    part = np.clip((t - times[i]) / (times[i + 1] - times[i]), 0, 1)
    ease = part**2 * (3 - 2 * part) if order == 3 else part**3 * (10 + part * (6 * part - 15))
    value: Array = values[i] + (values[i + 1] - values[i]) * ease
    return value


@dataclass
class Actor:
    """Somebody: at the place `at` = (time, s) of a line, with speed v along it and lateral place u."""

    name: str
    at: tuple[float, float]
    v: Knots
    u: Knots = NEAR
    line: Line | None = None  # None: the scene's first line
    kind: str | None = "car"
    size: Size = (4.5, 1.8, 1.5)
    facing: int = 1  # -1: turned the other way; speeds stay those along the line
    lamp: Steps | None = ((-1.0, "off"),)
    ground: float | None = 0.0
    there: tuple[float, float] = (-1.0, 1e9)  # first and last moment in the log
    turned: tuple[float, float] | None = None  # between these times the log has the heading the wrong way round
    mirror: bool = True  # u counts to the other side where the left is driven on

    def box(self) -> Box:
        """Return what the log knows of its kind and size."""
        return Box(self.name, self.kind, self.size)

    def states(  # noqa: PLR0917
        self, line: Line, hand: int, seconds: float, rate: float, noise: float, seed: int
    ) -> dict[str, list[Any]]:
        t = np.arange(0, seconds + DT / 2, DT)
        v = follow(self.v, t, 3)
        s = np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * DT)])
        s += self.at[1] - np.interp(self.at[0], t, s)
        u = follow(self.u, t, 5) * (hand if self.mirror else 1)
        du = np.gradient(u, DT)
        way = self.line or line
        h, k = np.interp(s, way.s, way.h), np.interp(s, way.s, way.k)
        x, y = np.interp(s, way.s, way.x) - u * np.sin(h), np.interp(s, way.s, way.y) + u * np.cos(h)
        along = v * (1 - k * u)
        vx, vy = along * np.cos(h) - du * np.sin(h), along * np.sin(h) + du * np.cos(h)
        slip = np.where(np.abs(along) > 0.3, np.arctan2(du, np.maximum(np.abs(along), 0.3)) * np.sign(v), 0.0)
        yaw = h + slip + (math.pi if self.facing < 0 else 0.0)
        ax, ay = np.gradient(vx, DT), np.gradient(vy, DT)
        push = np.gradient(v, DT) * np.where(self.facing > 0, 1, -1)
        pick = np.arange(0, len(t), round(1 / rate / DT))
        pick = pick[(t[pick] >= self.there[0]) & (t[pick] <= self.there[1])]
        if self.turned:
            yaw = yaw + np.where((t >= self.turned[0]) & (t <= self.turned[1]), math.pi, 0.0)
        shake = np.random.default_rng(seed)
        if noise:
            x, y = x + shake.normal(0, noise, len(t)), y + shake.normal(0, noise, len(t))
            vx, vy = vx + shake.normal(0, noise, len(t)), vy + shake.normal(0, noise, len(t))
        brakes = np.where(push < -6, "strong", np.where((push < -1) | (np.abs(v) < 0.05), "on", "off"))
        people = self.kind in ("pedestrian", "animal", "bicycle", "object")
        count = len(pick)
        high = (self.size[2] or 1.5) / 2
        return {
            "actor_id": [self.name] * count,
            "t_ns": [round(float(t[i]) * 1e9) for i in pick],
            "x_m": x[pick].tolist(),
            "y_m": y[pick].tolist(),
            "z_m": [None if self.ground is None else self.ground + high] * count,
            "yaw_rad": ((yaw[pick] + math.pi) % (2 * math.pi) - math.pi).tolist(),
            "vx_mps": vx[pick].tolist(),
            "vy_mps": vy[pick].tolist(),
            "ax_mps2": ax[pick].tolist(),
            "ay_mps2": ay[pick].tolist(),
            "indicator": [None if people or self.lamp is None else at(self.lamp, float(t[i])) for i in pick],
            "brake_light": [None if people else str(brakes[i]) for i in pick],
        }


BICYCLE: dict[str, Any] = {"kind": "bicycle", "size": (1.8, 0.6, 1.7)}
TRUCK: dict[str, Any] = {"kind": "truck", "size": (16.0, 2.5, 3.8)}
ON_FOOT: dict[str, Any] = {"kind": "pedestrian", "size": (0.5, 0.6, 1.8), "u": 0.0}


def ego(at: tuple[float, float], v: Knots, u: Knots = NEAR, **more: Any) -> Actor:
    return Actor("ego", at, v, u, **more)


def bike(name: str, at: tuple[float, float], v: Knots, u: Knots = -3.0, **more: Any) -> Actor:
    return Actor(name, at, v, u, **(BICYCLE | more))


def truck(name: str, at: tuple[float, float], v: Knots, u: Knots = NEAR, **more: Any) -> Actor:
    return Actor(name, at, v, u, **(TRUCK | more))


def walker(name: str, at: tuple[float, float], v: Knots, line: Line, **more: Any) -> Actor:
    """Somebody on foot along a line of their own; u is their place across it."""
    return Actor(name, at, v, line=line, **(ON_FOOT | more))


def across(x: float, hand: int, from_near: bool = True) -> Line:
    """A way across a road that runs east, at x; its s is metres past the middle of the road."""
    north = (hand > 0) == from_near
    return Line((x, 0, math.pi / 2 if north else -math.pi / 2), [])
