"""Reference lines: straight pieces, arcs, and cubics that join two of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Pose = tuple[float, float, float]


@dataclass(frozen=True)
class Geom:
    """One piece of a reference line: a line or arc (`curv`), or a cubic (`poly`: bu cu du bv cv dv)."""

    start: Pose
    length: float
    curv: float = 0.0
    poly: tuple[float, ...] = ()

    def points(self, step: float = 0.1) -> Array:
        """Return rows of x, y and heading."""
        x0, y0, h0 = self.start
        if self.poly:
            return self._cubic(step)
        s = np.linspace(0, self.length, max(2, int(self.length / (0.25 if self.curv else 50.0)) + 2))
        if not self.curv:
            return np.column_stack([x0 + s * math.cos(h0), y0 + s * math.sin(h0), h0 + 0 * s])
        h, k = h0 + self.curv * s, self.curv
        return np.column_stack([x0 + (np.sin(h) - math.sin(h0)) / k, y0 - (np.cos(h) - math.cos(h0)) / k, h])

    def end(self) -> Pose:
        x, y, h = self.points()[-1]
        return float(x), float(y), float(h)

    def xml(self, s: float) -> str:
        x, y, h = self.start
        shape = f'<arc curvature="{self.curv:.9g}"/>' if self.curv else "<line/>"
        if self.poly:
            bu, cu, du, bv, cv, dv = self.poly
            shape = (
                f'<paramPoly3 aU="0" bU="{bu:.9g}" cU="{cu:.9g}" dU="{du:.9g}" aV="0" bV="{bv:.9g}" '
                f'cV="{cv:.9g}" dV="{dv:.9g}" pRange="normalized"/>'
            )
        return (
            f'<geometry s="{s:.6f}" x="{x:.6f}" y="{y:.6f}" hdg="{h:.9f}" length="{self.length:.6f}">{shape}</geometry>'
        )

    def _cubic(self, step: float) -> Array:
        x0, y0, h0 = self.start
        bu, cu, du, bv, cv, dv = self.poly
        p = np.linspace(0, 1, max(3, int(self.length / step) + 2))
        u, v = bu * p + cu * p**2 + du * p**3, bv * p + cv * p**2 + dv * p**3
        h = h0 + np.arctan2(bv + 2 * cv * p + 3 * dv * p**2, bu + 2 * cu * p + 3 * du * p**2)
        return np.column_stack([x0 + u * math.cos(h0) - v * math.sin(h0), y0 + u * math.sin(h0) + v * math.cos(h0), h])


def chain(start: Pose, *pieces: tuple[float, float]) -> list[Geom]:
    """Pieces of (length, curvature) one after the other."""
    out: list[Geom] = []
    for length, curv in pieces:
        out.append(Geom(start, length, curv))
        start = out[-1].end()
    return out


def join(a: Pose, b: Pose) -> Geom:
    """A smooth cubic from pose a to pose b."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    c, s = math.cos(a[2]), math.sin(a[2])
    u1, v1, h = dx * c + dy * s, -dx * s + dy * c, b[2] - a[2]
    m = math.hypot(dx, dy)
    eu, ev = m * math.cos(h), m * math.sin(h)
    poly = (m, 3 * u1 - 2 * m - eu, -2 * u1 + m + eu, 0.0, 3 * v1 - ev, -2 * v1 + ev)
    p = np.linspace(0, 1, 2001)
    du = poly[0] + 2 * poly[1] * p + 3 * poly[2] * p**2
    dv = 2 * poly[4] * p + 3 * poly[5] * p**2
    speed = np.hypot(du, dv)
    length = float(((speed[1:] + speed[:-1]) / 2).sum() / 2000)
    return Geom(a, length, 0.0, poly)


def back(geoms: list[Geom]) -> list[Geom]:
    """The same line (of lines and arcs) the other way."""
    out = []
    for g in reversed(geoms):
        x, y, h = g.end()
        out.append(Geom((x, y, h + math.pi), g.length, -g.curv))
    return out
