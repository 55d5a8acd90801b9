"""Reference lines made of straights and arcs, and what moves along them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Fn = Callable[[Array], Array]


@dataclass(frozen=True)
class Course:
    """A line from a start; `u` counts from it towards the side that is driven on."""

    x: float
    y: float
    h: float
    parts: tuple[tuple[float, float], ...]
    near: int

    @property
    def length(self) -> float:
        return sum(p[0] for p in self.parts)

    def starts(self) -> list[tuple[float, float, float, float, float, float]]:
        """s, x, y, heading, length and curvature of every part."""
        rows = []
        s, x, y, h = 0.0, self.x, self.y, self.h
        for length, bend in self.parts:
            rows.append((s, x, y, h, length, bend))
            x, y, h = advance(x, y, h, length, bend)
            s += length
        return rows

    def offset(self, way: Fn, u: float) -> Fn:
        """Turn way that is driven at `u` beside the line into way along the line."""
        grid = np.arange(-600.0, self.length + 600.0, 0.1)
        stretch = np.ones_like(grid)
        for s0, _, _, _, length, bend in self.starts():
            stretch[(grid >= s0) & (grid < s0 + length)] = 1.0 - bend * self.near * u
        driven = np.concatenate([[0.0], np.cumsum(stretch[:-1] * 0.1)])
        first = float(way(np.zeros(1))[0])
        driven += first - float(np.interp(first, grid, driven))

        def place(t: Array) -> Array:
            return np.asarray(np.interp(way(t), driven, grid), dtype=np.float64)

        return place

    def at(self, s: Array, u: Array) -> tuple[Array, Array, Array]:
        """World position and heading at `s` along and `u` to the near side."""
        x, y, h = np.empty_like(s), np.empty_like(s), np.empty_like(s)
        rows = self.starts()
        for i, (s0, x0, y0, h0, _, bend) in enumerate(rows):
            low = -np.inf if i == 0 else s0
            high = np.inf if i == len(rows) - 1 else rows[i + 1][0]
            for j in np.flatnonzero((s >= low) & (s < high)):
                x[j], y[j], h[j] = advance(x0, y0, h0, float(s[j]) - s0, bend)
        t = self.near * u
        return x - t * np.sin(h), y + t * np.cos(h), h


def advance(x: float, y: float, h: float, way: float, bend: float) -> tuple[float, float, float]:
    """Go `way` along a part of constant curvature."""
    if abs(bend) < 1e-12:
        return x + way * float(np.cos(h)), y + way * float(np.sin(h)), h
    end = h + bend * way
    return (
        x + float(np.sin(end) - np.sin(h)) / bend,
        y - float(np.cos(end) - np.cos(h)) / bend,
        end,
    )


STEP = 0.01


def go(s0: float, *points: tuple[float, float], back: bool = False, soft: float = 1.0) -> Fn:
    """Way along a course from speeds (time, m/s), linear between; `back` runs against the line."""
    times = np.array([p[0] for p in points])
    speeds = np.array([p[1] for p in points])
    grid = np.arange(-3.0, 90.0, STEP)
    v = np.interp(grid, times, speeds)
    n = max(1, round(soft / STEP))
    if n > 1:
        pad = np.pad(v, (n // 2, n - 1 - n // 2), mode="edge")
        v = np.convolve(pad, np.ones(n) / n, mode="valid")
    way = np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * STEP)])
    way -= np.interp(0.0, grid, way)
    sign = -1.0 if back else 1.0

    def place(t: Array) -> Array:
        return np.asarray(s0 + sign * np.interp(t, grid, way), dtype=np.float64)

    return place


def side(*points: tuple[float, float]) -> Fn:
    """Place across the road from (time, u), gently from each to the next."""

    def place(t: Array) -> Array:
        out = np.full_like(t, points[0][1])
        for (t0, u0), (t1, u1) in pairwise(points):
            w = np.clip((t - t0) / (t1 - t0), 0.0, 1.0)
            out = np.where(t >= t0, u0 + (u1 - u0) * (w**3 * (10 - 15 * w + 6 * w * w)), out)
        return out

    return place


@dataclass(frozen=True)
class Motion:
    """How something moves along a course: `s` and `u` over time."""

    course: Course
    s: Fn
    u: Fn
    back: bool = False
    turned: float | None = None
    free: bool = False

    def at(self, t: Array) -> tuple[Array, Array, Array, Array, Array]:
        """x, y, yaw, vx and vy at the times."""
        x, y, h = self.course.at(self.s(t), self.u(t))
        e = 0.02
        x1, y1, _ = self.course.at(self.s(t + e), self.u(t + e))
        x0, y0, _ = self.course.at(self.s(t - e), self.u(t - e))
        vx, vy = (x1 - x0) / (2 * e), (y1 - y0) / (2 * e)
        if self.turned is not None:
            return x, y, h + self.turned, vx, vy
        head = h + np.pi if self.back else h
        along = vx * np.cos(head) + vy * np.sin(head)
        across = -vx * np.sin(head) + vy * np.cos(head)
        if self.free:
            moving = np.hypot(vx, vy) > 0.05
            yaw = np.where(moving, np.arctan2(vy, vx), head)
        else:
            lean = np.arctan2(across * np.sign(along), np.maximum(np.abs(along), 2.0))
            yaw = head + lean
        return x, y, np.arctan2(np.sin(yaw), np.cos(yaw)), vx, vy


def walk(course: Course, *points: tuple[float, float, float]) -> Motion:
    """Somebody on foot: straight from each (time, s, u) to the next."""
    t = np.array([p[0] for p in points])
    s = np.array([p[1] for p in points])
    u = np.array([p[2] for p in points])

    def way(at: Array) -> Array:
        return np.asarray(np.interp(at, t, s), dtype=np.float64)

    def across(at: Array) -> Array:
        return np.asarray(np.interp(at, t, u), dtype=np.float64)

    return Motion(course, way, across, free=True)
