"""Who takes part: boxes that go along a way, and what a poor log makes of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.outsiders.fifth.ways import Path, Speed, on_foot
from tests.outsiders.log import Box, Size

CAR, VAN, TRUCK, BUS = (4.4, 1.8, 1.5), (5.6, 2.0, 2.3), (11.5, 2.5, 3.6), (11.0, 2.5, 3.1)
BIKE, MOTO = (1.8, 0.6, 1.7), (2.2, 0.8, 1.5)
PED, CHILD = (0.5, 0.5, 1.75), (0.4, 0.4, 1.1)
HORSE, DOG = (2.4, 0.8, 2.3), (0.8, 0.3, 0.6)

Lamps = Sequence[tuple[float, float, str]]  # from, to, which
_COLUMNS = ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps")


@dataclass
class Actor:
    """Somebody, and the rows of its track: t, x, y, yaw, vx, vy, indicator, brake light."""

    id: str
    kind: str | None
    size: Size
    rows: list[list[Any]]

    def box(self) -> Box:
        return Box(self.id, self.kind, self.size)

    def states(self) -> dict[str, list[Any]]:
        """Return the columns of `actor_state`."""
        return {
            "actor_id": [self.id] * len(self.rows),
            "t_ns": [round(row[0] * 1e9) for row in self.rows],
            **{name: [round(row[k], 4) for row in self.rows] for k, name in enumerate(_COLUMNS, 1)},
            "indicator": [row[6] for row in self.rows],
            "brake_light": [row[7] for row in self.rows],
        }


def drive(  # noqa: PLR0917
    name: str,
    kind: str | None,
    size: Size | None,
    path: Path,
    speed: Speed,
    until: float,
    hz: float = 10,
    ind: Lamps | None = (),
    t0: float = 0.0,
    t1: float | None = None,
    lamps: bool = True,
) -> Actor:
    """Somebody who goes along a path; the log knows them from t0 to t1; `ind`: None where it tells no indicator."""
    rows = []
    for i in range(round(until * hz) + 1):
        t = i / hz
        if t < t0 - 1e-9 or (t1 is not None and t > t1 + 1e-9):
            continue
        s, v, a = speed(t)
        x, y, h = path.at(s)
        lamp = None if ind is None else next((which for begin, end, which in ind if begin <= t < end), "off")
        brake = _brake(v, a) if lamps else None
        rows.append([t, x, y, h, v * math.cos(h), v * math.sin(h), lamp, brake])
    return Actor(name, kind, size or (None, None, None), rows)


def _brake(v: float, a: float) -> str:
    if a < -6:
        return "strong"
    return "on" if a * (1 if v >= 0 else -1) < -0.4 or abs(v) < 0.01 else "off"


def ego(path: Path, speed: Speed, until: float, size: Size = CAR, cls: str = "car", **more: Any) -> Actor:
    """The ego: a car, if nothing else is said."""
    return drive("ego", cls, size, path, speed, until, **more)


def walk(
    points: Sequence[tuple[float, float]],
    v: float = 1.35,
    t: float = 0.0,
    *,
    name: str = "walker",
    cls: str | None = "pedestrian",
    until: float = 30.0,
    size: Size = PED,
    **more: Any,
) -> Actor:
    """Somebody on foot, who stands until t and then walks from one point to the other."""
    path, speed = on_foot(points, v, t)
    return drive(name, cls, size, path, speed, until, ind=None, lamps=False, **more)


def noisy(actor: Actor, seed: int, metres: float = 0.05, speed: float = 0.05) -> Actor:
    """Positions and speeds tremble."""
    random = np.random.default_rng(seed)
    for row in actor.rows:
        n = random.normal(0, 1, 4)
        row[1] += metres * n[0]
        row[2] += metres * n[1]
        row[4] += speed * n[2]
        row[5] += speed * n[3]
    return actor


def turned(actor: Actor) -> Actor:
    """The heading is turned round."""
    for row in actor.rows:
        row[3] += math.pi
    return actor


def frozen(actor: Actor, t: float) -> Actor:
    """The track sticks where it was at t."""
    last = actor.rows[0]
    for row in actor.rows:
        if row[0] >= t:
            row[1:6] = last[1:6]
        else:
            last = row
    return actor


def gap(actor: Actor, t0: float, t1: float) -> Actor:
    """The log has a hole."""
    actor.rows = [row for row in actor.rows if not t0 < row[0] < t1]
    return actor


def jump(actor: Actor, t: float, dx: float, dy: float) -> Actor:
    """From t on the track is elsewhere."""
    for row in actor.rows:
        if row[0] >= t:
            row[1] += dx
            row[2] += dy
    return actor
