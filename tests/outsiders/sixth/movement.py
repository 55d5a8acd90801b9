"""Who moves how along a line: speeds between knots, places across that change smoothly."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tests.outsiders.log import Box, Size
from tests.outsiders.sixth.lines import Array, Geom

if TYPE_CHECKING:
    from collections.abc import Sequence

Keys = float | list[tuple[float, float]]  # one value, or (t, value)
Lamps = str | list[tuple[float, str]] | None  # one state, or from when on; None: not known

FINE_S = 0.01  # the step at which movements are worked out before they are sampled
SIZES: dict[str, Size] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.9, 2.0, 2.4),
    "truck": (12.0, 2.5, 3.8),
    "bus": (12.0, 2.5, 3.1),
    "bicycle": (1.8, 0.6, 1.7),
    "pedestrian": (0.5, 0.5, 1.75),
    "animal": (2.3, 0.7, 1.6),
    "trailer": (8.0, 2.5, 3.5),
}


@dataclass
class Actor:
    """Somebody as the log has them, step by step."""

    name: str
    cls: str | None
    size: Size
    t: Array
    x: Array
    y: Array
    yaw: Array
    vx: Array
    vy: Array
    z: Array
    ind: list[str | None]

    def box(self) -> Box:
        """Return what the log knows of its kind and size."""
        return Box(self.name, self.cls, self.size)

    def states(self, noise: float, high: bool, random: np.random.Generator) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`; `high`: whether the log knows heights."""
        n = len(self.t)
        jitter = random.normal(0, noise, (n, 2)) if noise else np.zeros((n, 2))
        return {
            "actor_id": [self.name] * n,
            "t_ns": [round(float(t) * 1e9) for t in self.t],
            "x_m": (self.x + jitter[:, 0]).tolist(),
            "y_m": (self.y + jitter[:, 1]).tolist(),
            **({"z_m": self.z.tolist()} if high else {}),
            "yaw_rad": ((self.yaw + math.pi) % (2 * math.pi) - math.pi).tolist(),
            "vx_mps": self.vx.tolist(),
            "vy_mps": self.vy.tolist(),
            "indicator": list(self.ind),
            "brake_light": [None] * n,
        }


def follow(  # noqa: PLR0917
    way: Sequence[Geom], s: float, v: Keys, u: Keys, hand: int, against: bool, until: float, soft: float
) -> tuple[Array, ...]:
    """Return x, y, heading and both speeds, every hundredth of a second."""
    ref = _line(way)
    time = np.arange(0, until + FINE_S, FINE_S)
    speed = _soft(np.interp(time, *_knots(v)), soft)
    dist = np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2 * FINE_S)])
    along = s - dist if against else s + dist
    across = _ease(u, time) * hand
    x, y, h = (np.interp(along, ref[:, 0], ref[:, k]) for k in (1, 2, 3))
    over = np.where(along > ref[-1, 0], along - ref[-1, 0], np.where(along < 0, along, 0.0))
    x, y = x + over * np.cos(h) - across * np.sin(h), y + over * np.sin(h) + across * np.cos(h)
    vx, vy = np.gradient(x, FINE_S), np.gradient(y, FINE_S)
    facing = h + (math.pi if against else 0.0)
    unmoved = (np.hypot(vx, vy) < 0.2) | (speed < -0.01)
    return x, y, np.where(unmoved, facing, np.arctan2(vy, vx)), vx, vy


def walk(path: Sequence[tuple[float, float, float]], time: Array) -> tuple[Array, ...]:
    """Return x, y, heading and both speeds of somebody who moves straight between (t, x, y)."""
    k = np.array(path, float)
    x, y = np.interp(time, k[:, 0], k[:, 1]), np.interp(time, k[:, 0], k[:, 2])
    i = np.clip(np.searchsorted(k[:, 0], time, "right") - 1, 0, len(k) - 2)
    d = k[i + 1] - k[i]
    inside = (time >= k[0, 0]) & (time < k[-1, 0])
    vx, vy = np.where(inside, d[:, 1] / d[:, 0], 0.0), np.where(inside, d[:, 2] / d[:, 0], 0.0)
    return x, y, np.arctan2(d[:, 2], d[:, 1]), vx, vy


def lamps(ind: Lamps, time: Array) -> list[str | None]:
    """Return the indicator at each step."""
    if not isinstance(ind, list):
        return [ind] * len(time)
    return [next((state for begin, state in reversed(ind) if t >= begin - 1e-9), "off") for t in time]


def _line(way: Sequence[Geom]) -> Array:
    """Return rows of s, x, y and heading."""
    points = np.concatenate([g.points() for g in way])
    points[:, 2] = np.unwrap(points[:, 2])
    step = np.hypot(np.diff(points[:, 0]), np.diff(points[:, 1]))
    points = points[np.concatenate([[True], step > 1e-6])]
    s = np.concatenate([[0], np.cumsum(np.hypot(np.diff(points[:, 0]), np.diff(points[:, 1])))])
    return np.column_stack([s, points])


def _knots(keys: Keys) -> tuple[list[float], list[float]]:
    knots = keys if isinstance(keys, list) else [(0.0, float(keys))]
    return [float(k[0]) for k in knots], [float(k[1]) for k in knots]


def _soft(speed: Array, seconds: float) -> Array:
    """Nobody changes their acceleration at once."""
    w = int(seconds / FINE_S) // 2 * 2 + 1
    for _ in range(2):
        speed = np.convolve(np.pad(speed, w // 2, "edge"), np.ones(w) / w, "valid")
    return speed


def _ease(keys: Keys, time: Array) -> Array:
    """Between two knots half a wave of a cosine."""
    if not isinstance(keys, list):
        return np.full_like(time, float(keys))
    kt, kv = (np.array(column) for column in _knots(keys))
    i = np.clip(np.searchsorted(kt, time, "right") - 1, 0, len(kt) - 1)
    j = np.minimum(i + 1, len(kt) - 1)
    span = np.where(kt[j] > kt[i], kt[j] - kt[i], 1.0)
    p = np.clip((time - kt[i]) / span, 0, 1)
    eased: Array = kv[i] + (kv[j] - kv[i]) * (1 - np.cos(np.pi * p)) / 2
    return eased
