"""Who moves how: actors, their tracks, and what is wrong with some of them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from tests.outsiders.eleventh.road import Path

Array = np.ndarray
FINE = 200
SIZES: dict[str, tuple[float, float, float]] = {
    "car": (4.4, 1.8, 1.5),
    "van": (5.6, 2.0, 2.3),
    "truck": (11.0, 2.5, 3.6),
    "bus": (12.0, 2.5, 3.1),
    "motorcycle": (2.2, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (4.8, 1.9, 1.8),
    "pedestrian": (0.5, 0.6, 1.7),
    "animal": (2.3, 0.7, 2.4),
    "object": (1.0, 1.0, 1.0),
    "vehicle": (4.6, 1.9, 1.6),
}


@dataclass
class Actor:
    """One road user with its track; a row of `rows` is t, x, y, yaw, vx, vy."""

    name: str
    kind: str | None
    size: tuple[float | None, float | None, float | None]
    rows: Array
    lamps: list[tuple[float, float, str]] | None = None
    ego: bool = False

    def lamp(self, t: float) -> str | None:
        """The indicator at a time, None: the log does not know."""
        if self.lamps is None:
            return None
        return next((w for a, b, w in self.lamps if a <= t < b), "off")

    def columns(self) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`."""
        names = ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps")
        times = self.rows[:, 0].tolist()
        return {
            "actor_id": [self.name] * len(times),
            "t_ns": [round(t * 1e9) for t in times],
            **{name: self.rows[:, i + 1].tolist() for i, name in enumerate(names)},
            "indicator": [self.lamp(t) for t in times],
        }


def blend(knots: list[tuple[float, float]], t: Array) -> Array:
    """Values at the knots, smooth in between."""
    out = np.full_like(t, knots[0][1])
    for (a, p), (b, q) in pairwise(knots):
        u = np.clip((t - a) / max(b - a, 1e-9), 0, 1)
        out += (q - p) * (10 * u**3 - 15 * u**4 + 6 * u**5)
    return out


def track(  # noqa: PLR0917
    path: Path,
    span: float,
    s0: float,
    v0: float,
    acc: list[tuple[float, float]] | None = None,
    lat: list[tuple[float, float]] | None = None,
    way: int = 1,
    hz: float = 10.0,
    back: bool = False,
) -> Array:
    """Drive along the path from s0; acc lists (from when, m/s2), lat lists (when, metres to the left)."""
    t = np.arange(round(span * FINE) + 1) / FINE
    a = np.zeros_like(t)
    for when, value in acc or []:
        a[t >= when] = value
    v = np.empty_like(t)
    v[0] = v0
    for i in range(1, len(t)):
        v[i] = max(0.0, v[i - 1] + a[i - 1] / FINE)
    s = s0 + way * np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 / FINE)])
    d = blend(lat or [(0.0, 0.0)], t)
    x, y, h = path.at(s, d)
    vx, vy = np.gradient(x, 1 / FINE), np.gradient(y, 1 / FINE)
    slip = np.where(v > 0.5, np.arctan2(np.gradient(d, 1 / FINE) * way, np.maximum(v, 0.5)), 0.0)
    yaw = h + slip + (np.pi if way < 0 else 0.0) + (np.pi if back else 0.0)
    yaw = (yaw + np.pi) % (2 * np.pi) - np.pi
    pick = np.round(np.arange(0, span + 1e-9, 1 / hz) * FINE).astype(int)
    rows: Array = np.stack([t, x, y, yaw, vx, vy], axis=1)[pick]
    return rows


def actor(name: str, kind: str | None, rows: Array) -> Actor:
    """Return somebody of the usual size."""
    return Actor(name, kind, SIZES[kind or "vehicle"], rows)


def ego(rows: Array, kind: str = "car", lamps: list[tuple[float, float, str]] | None = None) -> Actor:
    """The ego."""
    return Actor("ego", kind, SIZES[kind], rows, lamps, True)


def line(x: float, y: float, h: float) -> Path:
    """A straight line from a place in a direction."""
    return Path(x, y, h, [(10.0, 0.0)])


def still(path: Path, s: float, d: float, span: float, hz: float = 10.0, way: int = 1) -> Array:  # noqa: PLR0917
    """Stand at a place."""
    return track(path, span, s, 0.0, lat=[(0.0, d)], hz=hz, way=way)


def late(rows: Array, t: float) -> Array:
    """Recorded from t on."""
    return rows[rows[:, 0] >= t]


def gone(rows: Array, t: float) -> Array:
    """Recorded until t."""
    return rows[rows[:, 0] <= t]


def turned(rows: Array) -> Array:
    """With the heading turned round."""
    out = rows.copy()
    out[:, 3] = (out[:, 3] + 2 * np.pi) % (2 * np.pi) - np.pi
    return out


def noisy(rows: Array, sigma: float, seed: int) -> Array:
    """With a noise of sigma metres."""
    out = rows.copy()
    out[:, 1:3] += np.random.default_rng(seed).normal(0, sigma, (len(out), 2))
    return out


def jumped(rows: Array, t: float, dx: float, dy: float) -> Array:
    """From t on somewhere else."""
    out = rows.copy()
    out[out[:, 0] >= t, 1] += dx
    out[out[:, 0] >= t, 2] += dy
    return out


def frozen(rows: Array, t: float) -> Array:
    """The tracker stands still from t on, though it goes on reporting the speed."""
    out = rows.copy()
    n = int(np.searchsorted(out[:, 0], t))
    out[n:, 1:4] = out[n, 1:4]
    return out


def towed(rows: Array, back: float) -> Array:
    """A trailer whose centre is so far behind the centre of what pulls it."""
    out = rows.copy()
    out[:, 1] -= back * np.cos(out[:, 3])
    out[:, 2] -= back * np.sin(out[:, 3])
    return out
