"""Who moves how, and what a bad recorder makes of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.outsiders.tenth.ways import Knots, Path, run, side

Row = dict[str, Any]
Change = Callable[[Row], Row | None]
Lamps = list[tuple[float, str | None]]


SIZE: dict[str | None, tuple[float, float, float]] = {
    "car": (4.4, 1.8, 1.5),
    "van": (5.6, 2.0, 2.3),
    "truck": (11.5, 2.5, 3.7),
    "bus": (12.0, 2.55, 3.2),
    "motorcycle": (2.1, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "pedestrian": (0.5, 0.6, 1.7),
    "animal": (2.3, 0.8, 2.2),
    "trailer": (7.0, 2.5, 3.5),
    "object": (1.0, 1.0, 1.0),
    None: (4.3, 1.8, 1.5),
    "vehicle": (4.5, 1.8, 1.5),
}


@dataclass
class Actor:
    """One road user."""

    id: str
    cls: str | None
    way: Path
    s0: float
    speed: Knots
    lat: Knots
    span: tuple[float, float]
    lamps: Lamps
    ego: bool
    size: tuple[float | None, float | None, float | None]
    change: Change | None
    reverse: bool
    brake: bool
    z: float | None = None

    def state(self, t: float) -> Row | None:
        """Where it is at t, and how fast."""
        if not self.span[0] - 1e-9 <= t <= self.span[1] + 1e-9:
            return None
        v, s = run(self.speed, t)
        d, dd = side(self.lat, t)
        x, y, h = self.way.at(self.s0 + s)
        x, y = x - d * math.sin(h), y + d * math.cos(h)
        vx = v * math.cos(h) - dd * math.sin(h)
        vy = v * math.sin(h) + dd * math.cos(h)
        yaw = h + (math.atan2(dd, v) if abs(v) > 0.5 else 0.0)
        if self.reverse:
            yaw += math.pi
        lamp: str | None = None
        for since, what in self.lamps:
            if t >= since - 1e-9:
                lamp = what
        a = (run(self.speed, t + 0.05)[0] - run(self.speed, t - 0.05)[0]) / 0.1
        row: Row = {
            "actor_id": self.id,
            "t_ns": round(t * 1e9),
            "x_m": x,
            "y_m": y,
            "z_m": self.z,
            "yaw_rad": math.remainder(yaw, 2 * math.pi),
            "vx_mps": vx,
            "vy_mps": vy,
            "indicator": lamp,
            "brake_light": ("on" if a < -0.4 else "off") if self.brake else None,
        }
        return self.change(row) if self.change else row

    def columns(self, times: list[float], *, high: bool) -> dict[str, list[Any]]:
        """The columns of its states; `high`: with how high it is."""
        rows = [row for t in times if (row := self.state(t))]
        return {name: [row[name] for row in rows] for name in rows[0] if high or name != "z_m"}


def noise(seed: int, m: float = 0.05, mps: float = 0.05) -> Callable[[Row], Row]:
    """Make a recorder that trembles, the same whenever it begins at 0 s."""
    rng = np.random.default_rng(seed)

    def change(row: Row) -> Row:
        nonlocal rng
        if row["t_ns"] == 0:
            rng = np.random.default_rng(seed)
        row["x_m"] += float(rng.normal(0, m))
        row["y_m"] += float(rng.normal(0, m))
        row["vx_mps"] += float(rng.normal(0, mps))
        row["vy_mps"] += float(rng.normal(0, mps))
        return row

    return change


def flipped(row: Row) -> Row:
    """Turn the heading by pi."""
    row["yaw_rad"] = math.remainder(row["yaw_rad"] + math.pi, 2 * math.pi)
    return row


def without(t0: float, t1: float) -> Callable[[Row], Row | None]:
    """Lose somebody from t0 to t1."""
    return lambda row: None if t0 <= row["t_ns"] / 1e9 < t1 else row


def jump(t0: float, dx: float, dy: float) -> Callable[[Row], Row]:
    """Jump at t0."""

    def change(row: Row) -> Row:
        if row["t_ns"] / 1e9 >= t0:
            row["x_m"] += dx
            row["y_m"] += dy
        return row

    return change
