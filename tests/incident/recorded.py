"""The overtake fixture and the case study, checked into folders, and their logs read with nothing of the package."""

from __future__ import annotations

import csv
import math
from typing import TYPE_CHECKING, NamedTuple

from shapely import affinity
from shapely.geometry import box

if TYPE_CHECKING:
    from pathlib import Path

    from shapely.geometry import Polygon


class State(NamedTuple):
    """One actor at one step, box centre, right-handed."""

    x: float
    y: float
    yaw: float
    vx: float
    vy: float

    @property
    def speed(self) -> float:
        return math.hypot(self.vx, self.vy)

    @property
    def box(self) -> Polygon:
        turned = affinity.rotate(box(-2.4, -0.9, 2.4, 0.9), self.yaw, origin=(0, 0), use_radians=True)
        return affinity.translate(turned, self.x, self.y)


Log = dict[str, dict[float, State]]
"""Actor -> time in s -> state."""


def fixture_log(path: Path) -> Log:
    found: Log = {}
    with path.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            numbers = [float(row[name]) for name in ("x_m", "y_m", "heading_deg", "vx_mps", "vy_mps")]
            numbers[2] = math.radians(numbers[2])
            found.setdefault(row["actor"], {})[round(float(row["time_s"]), 3)] = State(*numbers)
    return found


def carla_log(path: Path) -> Log:
    """Read a log of the case study, whose frame is left-handed."""
    found: Log = {}
    with path.open(encoding="utf-8") as file:
        for raw in csv.DictReader(file, skipinitialspace=True):
            row = {key.strip(): (value or "").strip() for key, value in raw.items() if key}
            if row["agentNo"]:
                x, y, yaw, vx, vy = (float(row[name]) for name in ("x", "y", "yaw", "vel_x", "vel_y"))
                found.setdefault(row["agentNo"], {})[round(float(row["time"]), 3)] = State(x, -y, -yaw, vx, -vy)
    return found


def gap(a: State, b: State) -> float:
    return float(a.box.distance(b.box))


def closing_by_places(a: dict[float, State], b: dict[float, State], t0: float, t1: float) -> float:
    """Return by how much the line between the centres shortens in a second, from places alone."""
    far = [math.hypot(a[t].x - b[t].x, a[t].y - b[t].y) for t in (t0, t1)]
    return (far[0] - far[1]) / (t1 - t0)
