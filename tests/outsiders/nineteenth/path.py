"""Lines and arcs that follow each other, and how a whole drive is mirrored, turned and shifted.

Everything is thought of as driven on the right, with y to the left of the way. A drive in Great Britain is mirrored in y.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[np.float64]
Bend = tuple[float, float]  # length, curvature (left positive)
Place = tuple[Numbers, Numbers, Numbers]  # x, y, heading
_STRAIGHT = 1e-12


class Piece(NamedTuple):
    """A line (curvature 0) or an arc, and where on the path it begins."""

    s: float
    x: float
    y: float
    heading: float
    length: float
    curvature: float

    def after(self, length: Numbers) -> Place:
        """Return the places so far along it."""
        k, h = self.curvature, self.heading
        if abs(k) < _STRAIGHT:
            return self.x + length * np.cos(h), self.y + length * np.sin(h), h + 0 * length
        turned = h + k * length
        return self.x + (np.sin(turned) - np.sin(h)) / k, self.y - (np.cos(turned) - np.cos(h)) / k, turned


class Path:
    """A way over the ground; before its begin and beyond its end it goes straight on."""

    def __init__(self, x: float, y: float, heading: float, bends: Sequence[Bend]) -> None:
        self.x, self.y, self.heading = x, y, heading
        self.bends = [(float(length), float(curvature)) for length, curvature in bends if length > 1e-9]
        self.length = sum(length for length, _ in self.bends)
        self.pieces: list[Piece] = []
        s, at = 0.0, (x, y, heading)
        for length, curvature in self.bends:
            piece = Piece(s, *at, length, curvature)
            self.pieces.append(piece)
            ax, ay, ah = piece.after(np.float64(length))  # type: ignore[arg-type]
            s, at = s + length, (float(ax), float(ay), float(ah))
        self.end = at

    def at(self, s: Numbers, across: Numbers | float = 0.0) -> Place:
        """Return places and headings along it, so far to its left."""
        x, y, h = np.zeros_like(s), np.zeros_like(s), np.zeros_like(s)
        which = np.clip(np.searchsorted([p.s for p in self.pieces], s, side="right") - 1, 0, len(self.pieces) - 1)
        for i, piece in enumerate(self.pieces):
            here = which == i
            along = s[here] - piece.s
            over = np.maximum(along - piece.length, 0) if i == len(self.pieces) - 1 else 0 * along
            under = np.minimum(along, 0) if i == 0 else 0 * along
            px, py, ph = piece.after(along - over - under)
            x[here] = px + (over + under) * np.cos(ph)
            y[here] = py + (over + under) * np.sin(ph)
            h[here] = ph
        return x - across * np.sin(h), y + across * np.cos(h), h

    def offset(self, across: float) -> Path:
        """Return the path so far to its left."""
        return Path(
            self.x - across * math.sin(self.heading),
            self.y + across * math.cos(self.heading),
            self.heading,
            [(length * (1 - k * across), k / (1 - k * across)) for length, k in self.bends],
        )

    def reverse(self) -> Path:
        """Return the same path the other way."""
        return Path(*self.end[:2], self.end[2] + math.pi, [(length, -k) for length, k in reversed(self.bends)])


class Frame(NamedTuple):
    """Where a drive lies in the world."""

    mirrored: bool
    turned: float = 0.0
    x: float = 0.0
    y: float = 0.0

    @property
    def sign(self) -> int:
        return -1 if self.mirrored else 1

    def vector(self, x: Numbers, y: Numbers) -> tuple[Numbers, Numbers]:
        """Return a velocity in the world."""
        y = self.sign * y
        c, s = math.cos(self.turned), math.sin(self.turned)
        return c * x - s * y, s * x + c * y

    def place(self, x: Numbers, y: Numbers, heading: Numbers) -> Place:
        """Return places and headings in the world."""
        wx, wy = self.vector(x, y)
        return wx + self.x, wy + self.y, self.sign * heading + self.turned


def line(length: float) -> Path:
    """Return a straight path along x."""
    return Path(0, 0, 0, [(length, 0)])


def bend(before: float, radius: float, angle: float, after: float) -> Path:
    """Return a path with one bend to the left."""
    return Path(0, 0, 0, [(before, 0), (angle * radius, 1 / radius), (after, 0)])
