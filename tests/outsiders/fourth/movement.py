"""Who moves how: along paths of straights, arcs and smooth shifts to the side, with a plan of speeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.outsiders.log import Box, Size

Array = NDArray[np.float64]
Columns = dict[str, list[Any]]
Plan = Sequence["float | tuple[float, float]"]  # seconds to hold, or (speed to reach, acceleration without sign)

MPH = 0.44704
KMH = 1 / 3.6
NS = 1_000_000_000
FINE_S = 0.01  # step of the integration of speeds
SMOOTH_S = 0.5  # an acceleration takes this long to build up
PATH_M = 0.25  # spacing of the points of a path
SIZES: dict[str, tuple[float, float, float]] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.5, 2.0, 2.2),
    "truck": (12.0, 2.5, 3.6),
    "bus": (12.0, 2.55, 3.2),
    "trailer": (4.0, 2.0, 2.0),
    "bicycle": (1.8, 0.6, 1.7),
    "pedestrian": (0.5, 0.5, 1.75),
    "animal": (2.4, 0.7, 2.2),
    "object": (1.0, 1.0, 1.0),
}
UNKNOWN: Size = (None, None, None)


class Way(NamedTuple):
    """A path as dense points: distance, x, y, heading."""

    s: Array
    x: Array
    y: Array
    h: Array


def way(
    x: float,
    y: float,
    hdg: float = 0.0,
    bends: Sequence[tuple[float, float]] = (),
    shifts: Sequence[tuple[float, float, float]] = (),
) -> Way:
    """A path from (x, y): bends (length, curvature), then straight on; shifts (from, to, metres to the left) on top."""
    s = np.arange(0.0, 2600.0, PATH_M)
    curvature, at = np.zeros_like(s), 0.0
    for piece, bend in bends:
        inside = np.minimum(s + PATH_M / 2, at + piece) - np.maximum(s - PATH_M / 2, at)
        curvature += bend * np.clip(inside / PATH_M, 0.0, 1.0)
        at += piece
    if bends:
        window = np.ones(13) / 13  # about 3 m of transition
        curvature = np.convolve(np.pad(curvature, 6, mode="edge"), window, mode="valid")
    h = hdg + np.concatenate(([0.0], np.cumsum((curvature[1:] + curvature[:-1]) / 2 * PATH_M)))
    mid = (h[1:] + h[:-1]) / 2
    px = x + np.concatenate(([0.0], np.cumsum(np.cos(mid) * PATH_M)))
    py = y + np.concatenate(([0.0], np.cumsum(np.sin(mid) * PATH_M)))
    offset = np.zeros_like(s)
    for start, end, metres in shifts:
        u = np.clip((s - start) / (end - start), 0.0, 1.0)
        offset += metres * (10 * u**3 - 15 * u**4 + 6 * u**5)
    px, py = px - offset * np.sin(h), py + offset * np.cos(h)
    dx, dy = np.gradient(px), np.gradient(py)
    length = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(px), np.diff(py)))))
    return Way(length, px, py, np.unwrap(np.arctan2(dy, dx)))


def motion(v0: float, plan: Plan, duration: float) -> tuple[Array, Array, Array, Array]:
    """Return time, distance, speed and acceleration of a plan on the fine grid."""
    t = np.arange(0.0, duration + FINE_S / 2, FINE_S)
    a, at, v = np.zeros_like(t), 0.0, v0
    for item in plan:
        if isinstance(item, tuple):
            goal, rate = item
            span = abs(goal - v) / rate
            inside = np.clip((np.minimum(t + FINE_S, at + span) - np.maximum(t, at)) / FINE_S, 0.0, 1.0)
            a += inside * math.copysign(rate, goal - v)
            at, v = at + span, goal
        else:
            at += float(item)
    half = round(SMOOTH_S / 2 / FINE_S)
    a = np.convolve(np.pad(a, half, mode="edge"), np.ones(2 * half + 1) / (2 * half + 1), mode="valid")
    speed = v0 + np.concatenate(([0.0], np.cumsum((a[1:] + a[:-1]) / 2 * FINE_S)))
    speed[np.abs(speed) < 0.004] = 0.0
    return t, np.concatenate(([0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * FINE_S))), speed, a


def slow(distance: float, v0: float, v1: float, rate: float) -> list[float | tuple[float, float]]:
    """Hold v0, then change to v1 at `rate`, so that v1 is reached after `distance`."""
    return [(distance - abs(v0 * v0 - v1 * v1) / (2 * rate)) / v0, (v1, rate)]


@dataclass
class Actor:
    """Somebody in a scene, as drawn for right-hand traffic."""

    name: str
    kind: str | None
    path: Way
    v0: float = 0.0
    plan: Plan = ()
    lamp: Sequence[tuple[float, float, str]] = ()  # from, to, near / far / hazard / unknown
    size: Size | None = None  # None: that of the kind
    start: float = 0.0  # distance along the path at time zero
    z: float = 0.0

    def when(self, distance: float) -> float:
        """Return the time at which the centre has gone so far along the path."""
        t, s, _, _ = motion(self.v0, self.plan, 90.0)
        return float(np.interp(distance, self.start + s, t))

    def box(self) -> Box:
        """Return what the log knows of its kind and size."""
        return Box(self.name, self.kind, self.size or SIZES[self.kind or "car"])

    def states(self, duration: float, rate: float, flip: int) -> Columns:
        """Return the columns of `actor_state`."""
        t, s, v, a = motion(self.v0, self.plan, duration)
        at = [step / rate for step in range(int(duration * rate + 1e-6) + 1)]
        gone, speed, push = (np.interp(at, t, values) for values in (s + self.start, v, a))
        x, y, h = (np.interp(gone, self.path.s, values) for values in self.path[1:])
        high = self.z + SIZES[self.kind or "car"][2] / 2
        brakes = push * np.where(speed >= 0, 1, -1) < -0.7
        return {
            "actor_id": [self.name] * len(at),
            "t_ns": [round(when * NS) for when in at],
            "x_m": x.tolist(),
            "y_m": (y * flip).tolist(),
            "z_m": [high] * len(at),
            "yaw_rad": [math.remainder(heading * flip, 2 * math.pi) for heading in h],
            "vx_mps": [one * math.cos(heading) for one, heading in zip(speed.tolist(), h.tolist(), strict=True)],
            "vy_mps": [one * math.sin(heading) * flip for one, heading in zip(speed.tolist(), h.tolist(), strict=True)],
            "indicator": [self._lamp(when, flip) for when in at],
            "brake_light": ["on" if on else "off" for on in brakes],
        }

    def _lamp(self, time: float, flip: int) -> str | None:
        near, far = ("left", "right") if flip < 0 else ("right", "left")
        words = {"near": near, "far": far, "hazard": "hazard", "unknown": None}
        return next((words[lamp] for begin, end, lamp in self.lamp if begin <= time < end), "off")


def ego(path: Way, v0: float, *plan: float | tuple[float, float], kind: str | None = "car", **more: Any) -> Actor:
    return Actor("ego", kind, path, v0, plan, **more)


def east(name: str, kind: str | None, x: float, y: float, v: float, *plan: Any, **more: Any) -> Actor:
    """Somebody who goes along the x axis."""
    return Actor(name, kind, way(x, y, shifts=more.pop("shifts", ())), v, plan, **more)


def west(name: str, kind: str | None, x: float, y: float, v: float, *plan: Any, **more: Any) -> Actor:
    """Somebody who comes against the x axis."""
    return Actor(name, kind, way(x, y, math.pi), v, plan, **more)


def walker(x: float, y: float, hdg: float, v: float = 1.4, *plan: Any, **more: Any) -> Actor:
    kind = more.pop("kind", "pedestrian")
    return Actor("walker", kind, way(x, y, hdg), v, plan, **more)
