"""Who moves how: ways with round corners, speeds without jumps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tests.outsiders.first.road import Array, Map
from tests.outsiders.log import Box, at

Speed = float | Sequence[tuple[float, float]]


def blur(values: Array, sigma: float) -> Array:
    """Gaussian smoothing that goes straight on at both ends."""
    reach = int(3 * sigma) + 1
    head = values[0] - (values[1] - values[0]) * np.arange(reach, 0, -1).reshape(-1, *[1] * (values.ndim - 1))
    tail = values[-1] + (values[-1] - values[-2]) * np.arange(1, reach + 1).reshape(-1, *[1] * (values.ndim - 1))
    padded = np.concatenate([head, values, tail])
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    kernel /= kernel.sum()
    if values.ndim == 1:
        return np.convolve(padded, kernel, "valid")
    return np.stack([np.convolve(column, kernel, "valid") for column in padded.T], axis=1)


def line(points: Array | list[tuple[float, float]], soft: float = 1.5) -> Array:
    """A way through points, with its corners rounded: even steps of 0.1 m, then blurred over `soft` metres."""
    raw = np.array([(*p, 0.0)[:3] for p in points], dtype=float)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(raw, axis=0), axis=1))])
    even = np.arange(0.0, along[-1], 0.1)
    dense = np.stack([np.interp(even, along, raw[:, k]) for k in range(3)], axis=1)
    return blur(dense, soft / 0.1) if soft else dense


def route(roads: Map, names: str, start: float, end: float, n: float = 1.75) -> Array:
    """From `start` metres before a junction to `end` metres after it; names such as 'S SW W'."""
    first, *between, last = names.split()
    ways = [roads.roads[first].along((start, -n), (0.0, -n))]
    ways += [roads.roads[name].along((0.0, n), (roads.roads[name].length, n)) for name in between]
    return line(np.concatenate([*ways, roads.roads[last].along((0.0, n), (end, n))]))


def to_stop(  # noqa: PLR0917
    v: float, d: float, a: float = 2.0, wait: float = 1e3, go: float = 0.0, up: float = 1.5
) -> list[tuple[float, float]]:
    """Speeds of one who comes at v, stands after d metres, waits, and goes on."""
    brake = (d - v * v / (2 * a)) / v
    assert brake > 0, (v, d, a)
    stop = brake + v / a
    return [(0.0, v), (brake, v), (stop, 0.0), (stop + wait, 0.0), (stop + wait + go / up, go)]


SIZE: dict[str, tuple[float, float, float]] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.5, 2.0, 2.4),
    "truck": (12.0, 2.5, 3.8),
    "bus": (12.0, 2.5, 3.2),
    "motorcycle": (2.2, 0.8, 1.5),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (5.0, 2.1, 2.3),
    "pedestrian": (0.4, 0.5, 1.75),
    "animal": (2.4, 0.7, 2.2),
    "object": (1.0, 1.0, 1.0),
}


@dataclass
class Actor:
    """Somebody who moves along a way; in the log all of it is known unless it is said here that it is not."""

    kind: str
    way: Array
    speed: Speed
    start: float = 0.0  # metres along the way at time zero
    size: tuple[float, float, float] | None = None
    no_size: bool = False
    no_class: bool = False
    no_height: bool = False  # z is null
    lamps: list[tuple[float, str]] | None = field(default_factory=lambda: [(0.0, "off")])
    flipped: bool = False  # the log has its heading wrong by pi
    until: float = 1e9
    noise: float = 0.0
    jolt: bool = False  # speeds are not blurred: an impact

    def box(self, name: str) -> Box:
        """Return what the log knows of its kind and size."""
        size = (None, None, None) if self.no_size else (self.size or SIZE[self.kind])
        return Box(name, None if self.no_class else self.kind, size)

    def states(self, name: str, seed: int, duration: float, hz: float) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`."""
        fine = np.arange(0.0, duration + 0.005, 0.01)
        v = self._speeds(fine)
        x, y, z, h = self._places(name, fine, v)
        vx, vy = v * np.cos(h), v * np.sin(h)  # a negative speed is driven in reverse
        ax, ay = (blur(np.gradient(c, 0.01), 5.0) for c in (vx, vy))
        ahead = np.gradient(v, 0.01)
        pick = np.rint(np.arange(0.0, duration + 1e-9, 1.0 / hz) * 100).astype(int)
        pick = pick[fine[pick] <= self.until + 1e-9]
        random = np.random.default_rng(seed)
        if self.noise:
            x, y = x + random.normal(0, self.noise, x.size), y + random.normal(0, self.noise, x.size)
            vx, vy = vx + random.normal(0, self.noise, x.size), vy + random.normal(0, self.noise, x.size)
        yaw = (h + (math.pi if self.flipped else 0.0) + math.pi) % math.tau - math.pi
        size = self.size or SIZE[self.kind]
        return {
            "actor_id": [name] * len(pick),
            "t_ns": [int(i) * 10_000_000 for i in pick],
            "x_m": x[pick].tolist(),
            "y_m": y[pick].tolist(),
            "z_m": [None if self.no_height else value + size[2] / 2 for value in z[pick].tolist()],
            "yaw_rad": yaw[pick].tolist(),
            "vx_mps": vx[pick].tolist(),
            "vy_mps": vy[pick].tolist(),
            "ax_mps2": ax[pick].tolist(),
            "ay_mps2": ay[pick].tolist(),
            "indicator": [None if self.lamps is None else at(self.lamps, t) for t in fine[pick].tolist()],
            "brake_light": ["on" if ahead[i] < -0.4 else "off" for i in pick],
        }

    def _speeds(self, t: Array) -> Array:
        knots = [(0.0, self.speed)] if isinstance(self.speed, float | int) else self.speed
        v = np.interp(t, [k[0] for k in knots], [k[1] for k in knots])
        return v if self.jolt else blur(v, 35.0)

    def _places(self, name: str, t: Array, v: Array) -> tuple[Array, Array, Array, Array]:
        """Return x, y, z and heading of the way at each time."""
        gone = self.start + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) * 0.005)])
        flat = np.diff(self.way[:, :2], axis=0)
        length = np.linalg.norm(flat, axis=1)
        keep = np.concatenate([[True], length > 1e-9])
        way = self.way[keep]
        flat, length = flat[keep[1:]], length[keep[1:]]
        along = np.concatenate([[0.0], np.cumsum(length)])
        assert gone[t <= self.until][-1] <= along[-1] + 1e-6, (name, gone[-1], along[-1])
        heading = np.unwrap(np.arctan2(flat[:, 1], flat[:, 0]))
        x, y, z = (np.interp(gone, along, way[:, k]) for k in range(3))
        return x, y, z, np.interp(gone, (along[1:] + along[:-1]) / 2, heading)


def still(kind: str, x: float, y: float, yaw: float = 0.0, **more: Any) -> Actor:
    way = np.array([(x, y, 0.0), (x + math.cos(yaw), y + math.sin(yaw), 0.0)])
    return Actor(kind, way, 0.0, **more)


def ahead(m: Map, s: float, n: float = 1.75) -> Array:
    return m.along((s, n), (m.roads["main"].length, n))


def against(m: Map, s: float, n: float = -1.75) -> Array:
    return m.along((s, n), (0.0, n))


def out_and_back(  # noqa: PLR0917
    m: Map, s: float, a: float, b: float, c: float, d: float, home: float = 1.75, out: float = -1.75
) -> Array:
    """From s on: moves out between a and b, back between c and d."""
    return m.along((s, home), (a, home), (b, out), (c, out), (d, home), (m.roads["main"].length, home))


def car(way: Array, speed: Speed, kind: str = "car", **more: Any) -> Actor:
    return Actor(kind, way, speed, **more)
