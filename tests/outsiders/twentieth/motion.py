"""How road users move: a way over the map, a speed along it, and an offset across it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Move = tuple[str, *tuple[float, ...]]  # what to do, and its numbers
Knots = Sequence[tuple[float, float]]


@dataclass
class Way:
    """A line that somebody follows, resampled every 10 cm."""

    xy: Floats
    near: int

    def __post_init__(self) -> None:
        """Resamples the points evenly."""
        step = np.hypot(*np.diff(self.xy, axis=0).T)
        keep = np.concatenate([[True], step > 1e-6])
        xy = self.xy[keep]
        s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(xy, axis=0).T))])
        self.length = float(s[-1])
        self.s = np.linspace(0.0, self.length, max(int(self.length / 0.1), 2))
        self.x, self.y = np.interp(self.s, s, xy[:, 0]), np.interp(self.s, s, xy[:, 1])
        self.h = np.unwrap(np.arctan2(np.gradient(self.y, self.s), np.gradient(self.x, self.s)))

    def at(self, s: Floats) -> tuple[Floats, Floats, Floats]:
        """Points and headings, going straight on before its beginning and after its end."""
        x, y, h = np.interp(s, self.s, self.x), np.interp(s, self.s, self.y), np.interp(s, self.s, self.h)
        over = np.where(s < 0, s, np.where(s > self.length, s - self.length, 0.0))
        return x + over * np.cos(h), y + over * np.sin(h), h

    def station(self, x: float, y: float) -> float:
        """The station nearest to a point."""
        return float(self.s[int(np.argmin(np.hypot(self.x - x, self.y - y)))])


def speeds(s0: float, v0: float, moves: Sequence[Move], t: Floats) -> tuple[Floats, Floats, Floats]:
    """Stations, speeds and accelerations: hold T; to_s S; v V A; stop S A."""
    rows = [(0.0, s0, v0, 0.0)]
    now, s, v = 0.0, s0, v0

    def go(dur: float, acc: float) -> None:
        nonlocal now, s, v
        rows.append((now, s, v, acc))
        s += v * dur + acc * dur * dur / 2
        v += acc * dur
        now += dur
        rows.append((now, s, v, 0.0))

    for what, *numbers in moves:
        if what == "hold":
            go(numbers[0], 0.0)
        elif what == "to_s":
            go((numbers[0] - s) / v, 0.0)
        elif what == "v":
            target, acc = numbers
            go(abs(target - v) / acc, math.copysign(acc, target - v))
            v = target
            rows[-1] = (now, s, v, 0.0)
        else:
            end, acc = numbers
            way = end - s - math.copysign(v * v / 2 / acc, v)
            assert way / v >= -1e-6, f"cannot stop at {end} from {s} at {v}"
            go(max(way / v, 0.0), 0.0)
            go(abs(v) / acc, -math.copysign(acc, v))
            v, s = 0.0, end
            rows[-1] = (now, s, 0.0, 0.0)
    table = np.array(rows)
    i = np.searchsorted(table[:, 0], t + 1e-9, side="right") - 1
    dt = t - table[i, 0]
    acc = table[i, 3]
    return table[i, 1] + table[i, 2] * dt + acc * dt * dt / 2, table[i, 2] + acc * dt, acc


def when(s0: float, v0: float, moves: Sequence[Move], s: float) -> float:
    """When a station is first reached."""
    t = np.arange(0.0, 200.0, 0.002)
    at = speeds(s0, v0, moves, t)[0]
    return float(t[int(np.argmax(at >= s))])


def smooth(knots: Knots, at: Floats) -> tuple[Floats, Floats]:
    """Values and slopes of a curve that is level at its knots and smooth between them."""
    ks, vs = np.array([k for k, _ in knots]), np.array([v for _, v in knots])
    if len(ks) == 1:
        return np.full_like(at, vs[0]), np.zeros_like(at)
    i = np.clip(np.searchsorted(ks, at, side="right") - 1, 0, len(ks) - 2)
    span = ks[i + 1] - ks[i]
    p = np.clip((at - ks[i]) / span, 0.0, 1.0)
    rise = vs[i + 1] - vs[i]
    return vs[i] + rise * p**3 * (10 - 15 * p + 6 * p * p), rise * 30 * p * p * (1 - p) ** 2 / span


SIZES: dict[str, tuple[float, float, float]] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.6, 2.0, 2.4),
    "truck": (12.0, 2.5, 3.6),
    "bus": (12.0, 2.5, 3.1),
    "motorcycle": (2.2, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (6.0, 2.2, 2.5),
    "pedestrian": (0.5, 0.5, 1.75),
    "animal": (2.4, 0.7, 2.2),
    "object": (1.0, 1.0, 1.0),
    "vehicle": (4.6, 1.9, 1.6),
}


@dataclass
class Actor:
    """A road user: what it is, its way, speed and offset (to the near side, at stations of its way)."""

    name: str
    kind: str | None
    way: Way
    s0: float
    v0: float
    moves: Sequence[Move] = ()
    lat: Knots = ((0.0, 0.0),)
    size: tuple[float, float, float] | None = None
    lamp: Sequence[tuple[float, float, str]] | None = ()
    brake: bool = True
    seen: tuple[float, float] = (0.0, 1e9)
    lost: Sequence[tuple[float, float]] = ()
    flip: bool = False
    noise: float = 0.0

    def box(self) -> tuple[float, float, float]:
        """Length, width, height."""
        return self.size or SIZES[self.kind or "vehicle"]

    def states(self, t: Floats, seed: int) -> dict[str, Floats]:
        """Motion at the times t."""
        s, v, acc = speeds(self.s0, self.v0, self.moves, t)
        x, y, h = self.way.at(s)
        off, slope = smooth(self.lat, s)
        side = self.way.near * off
        x, y = x - side * np.sin(h), y + side * np.cos(h)
        yaw = h + np.arctan(slope * self.way.near)
        stretch = v * np.sqrt(1 + slope**2)
        vx, vy = stretch * np.cos(yaw), stretch * np.sin(yaw)
        if self.noise:
            rng = np.random.default_rng(seed)
            x, y = x + rng.normal(0, self.noise, len(t)), y + rng.normal(0, self.noise, len(t))
            vx, vy = vx + rng.normal(0, self.noise, len(t)), vy + rng.normal(0, self.noise, len(t))
            yaw = yaw + rng.normal(0, self.noise / 20, len(t))
        if self.flip:
            yaw = yaw + math.pi
        yaw = np.arctan2(np.sin(yaw), np.cos(yaw))
        return {"x": x, "y": y, "yaw": yaw, "vx": vx, "vy": vy, "acc": acc, "s": s, "v": v}

    def columns(self, times: Floats, seed: int) -> dict[str, list[Any]]:
        """Columns of `actor_state`."""
        st = self.states(times, seed)
        seen = [i for i, t in enumerate(times) if self._seen(float(t))]
        slows = st["acc"] * np.sign(np.where(st["v"] == 0, 1, st["v"])) < -0.5
        return {
            "actor_id": [self.name] * len(seen),
            "t_ns": [round(float(times[i]) * 1e9) for i in seen],
            "x_m": [st["x"][i] for i in seen],
            "y_m": [st["y"][i] for i in seen],
            "yaw_rad": [st["yaw"][i] for i in seen],
            "vx_mps": [st["vx"][i] for i in seen],
            "vy_mps": [st["vy"][i] for i in seen],
            "indicator": [self.indicator(float(times[i])) for i in seen],
            "brake_light": [("on" if slows[i] else "off") if self.brake else None for i in seen],
        }

    def _seen(self, t: float) -> bool:
        return self.seen[0] <= t <= self.seen[1] and not any(a <= t < b for a, b in self.lost)

    def indicator(self, t: float) -> str | None:
        """State of its indicator; near and far are the sides."""
        if self.lamp is None:
            return None
        sides = {"near": "left", "far": "right"} if self.way.near > 0 else {"near": "right", "far": "left"}
        for t0, t1, what in self.lamp:
            if t0 <= t < t1:
                return sides.get(what, what)
        return "off"
