"""Ways that vehicles and roads take: chains of straights and arcs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Parts = Sequence[tuple[float, float]]  # length and curvature of each straight or arc


class Way:
    """A chain of straights and arcs; `origin`: how far along it its own measure s is zero."""

    def __init__(self, x: float, y: float, heading: float, parts: Parts, origin: float = 0.0) -> None:
        self.origin = origin
        self.geometry: list[tuple[float, float, float, float, float]] = []  # x, y, heading, length, curvature
        for length, curvature in parts:
            self.geometry.append((x, y, heading, length, curvature))
            x, y, heading = _along(x, y, heading, length, curvature)
        self.end = (x, y, heading)

    def pose(self, s: Array) -> tuple[Array, Array, Array]:
        """Return positions and headings at the places s."""
        at = s + self.origin
        starts = self._starts()
        which = np.clip(np.searchsorted(starts, at, side="right") - 1, 0, len(starts) - 1)
        x, y, heading = np.zeros_like(at), np.zeros_like(at), np.zeros_like(at)
        for index, (x0, y0, h0, _, curvature) in enumerate(self.geometry):
            here = which == index
            rest = at[here] - starts[index]
            turned = curvature * rest
            x[here] = x0 + rest * np.cos(h0 + turned / 2) * np.sinc(turned / 2 / np.pi)
            y[here] = y0 + rest * np.sin(h0 + turned / 2) * np.sinc(turned / 2 / np.pi)
            heading[here] = h0 + turned
        return x, y, heading

    def bend(self, s: Array) -> Array:
        """Return the curvatures at the places s."""
        starts = self._starts()
        which = np.clip(np.searchsorted(starts, s + self.origin, side="right") - 1, 0, len(starts) - 1)
        return np.array([part[4] for part in self.geometry])[which]

    def _starts(self) -> Array:
        return np.cumsum([0.0] + [part[3] for part in self.geometry])[:-1]


def _along(x: float, y: float, heading: float, length: float, curvature: float) -> tuple[float, float, float]:
    turned = curvature * length
    chord = length * float(np.sinc(turned / 2 / np.pi))
    return x + chord * math.cos(heading + turned / 2), y + chord * math.sin(heading + turned / 2), heading + turned


EAST = Way(0, 0, 0, [(1, 0)])  # along the x axis, s = x
WEST = Way(0, 0, math.pi, [(1, 0)])  # against it, s = -x


def line(x: float, y: float, degrees: float) -> Way:
    """A straight way of its own, such as that of somebody on foot."""
    return Way(x, y, math.radians(degrees), [(1, 0)])
