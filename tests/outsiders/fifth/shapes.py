"""The parts that a road's reference line is made of: straights, arcs, and curves from one pose to another."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Pose = tuple[float, float, float]
Shape = tuple[float, float] | tuple[float, float, float]  # length and curvature, or the pose to which a curve leads


class Arc(NamedTuple):
    """An arc, or a straight, that begins at s of its road."""

    s: float
    length: float
    start: Pose
    curvature: float

    def pose(self, s: float) -> Pose:
        x, y, h = self.start
        length, k = s - self.s, self.curvature
        if abs(k) < 1e-12:
            return x + length * math.cos(h), y + length * math.sin(h), h
        end = h + k * length
        return x + (math.sin(end) - math.sin(h)) / k, y - (math.cos(end) - math.cos(h)) / k, end

    def xml(self) -> str:
        return "<line/>" if self.curvature == 0 else f'<arc curvature="{self.curvature:.8f}"/>'


class Curve(NamedTuple):
    """A cubic curve; `terms`: of u and v, by powers of a parameter from 0 to 1, which `u` has at the lengths `along`."""

    s: float
    length: float
    start: Pose
    terms: NDArray[np.float64]
    u: NDArray[np.float64]
    along: NDArray[np.float64]

    def pose(self, s: float) -> Pose:
        x, y, h = self.start
        u = float(np.interp(s - self.s, self.along, self.u))
        q = sum(u**i * self.terms[i] for i in range(4))
        d = sum(i * u ** (i - 1) * self.terms[i] for i in range(1, 4))
        c, sn = math.cos(h), math.sin(h)
        return x + q[0] * c - q[1] * sn, y + q[0] * sn + q[1] * c, h + math.atan2(d[1], d[0])

    def xml(self) -> str:
        named = ((name, axis, self.terms[i][j]) for j, axis in enumerate("UV") for i, name in enumerate("abcd"))
        terms = " ".join(f'{name}{axis}="{value:.8f}"' for name, axis, value in named)
        return f'<paramPoly3 pRange="normalized" {terms}/>'


def curve(s: float, start: Pose, end: Pose) -> Curve:
    """Return the curve from one pose to another, nearly an arc where one leads there."""
    (x, y, h), (x1, y1, h1) = start, end
    chord = math.hypot(x1 - x, y1 - y)
    turned = abs((h1 - h + math.pi) % (2 * math.pi) - math.pi)
    reach = 2 / 3 * chord * math.tan(turned / 4) / math.sin(turned / 2) if turned > 1e-3 else chord / 3
    c, sn = math.cos(h), math.sin(h)
    p0, p1 = np.zeros(2), np.array([reach, 0.0])
    p3 = np.array([(x1 - x) * c + (y1 - y) * sn, -(x1 - x) * sn + (y1 - y) * c])
    p2 = p3 - np.array([math.cos(h1 - h), math.sin(h1 - h)]) * reach
    terms = np.array([p0, 3 * (p1 - p0), 3 * (p2 - 2 * p1 + p0), p3 - 3 * p2 + 3 * p1 - p0])
    u = np.linspace(0, 1, 401)
    points = sum(np.outer(u**i, terms[i]) for i in range(4))
    along = np.r_[0, np.cumsum(np.hypot(*np.diff(points, axis=0).T))]
    return Curve(s, float(along[-1]), start, terms, u, along)
