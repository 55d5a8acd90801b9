"""Lines of straights and bends: pose and curvature at a station."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]


class Piece(NamedTuple):
    """A stretch of constant curvature (1/m, left positive)."""

    length_m: float
    curvature: float = 0.0


class Pose(NamedTuple):
    """A place and a heading (radians, counter-clockwise from east)."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0


def straight(length_m: float) -> Piece:
    """Return a straight of this length."""
    return Piece(length_m)


def left(length_m: float, *, radius: float) -> Piece:
    """Return a left-hand bend of this length."""
    return Piece(length_m, 1.0 / radius)


def right(length_m: float, *, radius: float) -> Piece:
    """Return a right-hand bend of this length."""
    return Piece(length_m, -1.0 / radius)


ORIGIN = Pose()


@dataclass(frozen=True)
class Line:
    """Pieces laid one after the other from a pose; the last one goes on for ever."""

    pieces: tuple[Piece, ...]
    start: Pose = ORIGIN

    @property
    def length_m(self) -> float:
        """Return the length of all pieces."""
        return sum(piece.length_m for piece in self.pieces)

    def placed_pieces(self) -> Iterable[tuple[float, Pose, Piece]]:
        """Yield each piece with the station and the pose at which it begins."""
        station, pose = 0.0, self.start
        for piece in self.pieces:
            yield station, pose, piece
            station, pose = station + piece.length_m, _end(pose, piece)

    def at(self, s: ArrayLike, left_m: ArrayLike = 0.0) -> tuple[Floats, Floats, Floats]:
        """Return x, y (m) and the line's heading (rad) at stations, moved to the left by `left_m`."""
        s, left_m = np.broadcast_arrays(np.asarray(s, np.float64), np.asarray(left_m, np.float64))
        x, y, heading = np.zeros(s.shape), np.zeros(s.shape), np.zeros(s.shape)
        for k, (station, pose, piece) in enumerate(self.placed_pieces()):
            here = (s >= station) | (k == 0)
            found = _walk(pose, s - station, piece.curvature)
            x, y, heading = (np.where(here, new, old) for new, old in zip(found, (x, y, heading), strict=True))
        return x - left_m * np.sin(heading), y + left_m * np.cos(heading), heading

    def curvature(self, s: ArrayLike) -> Floats:
        """Return the curvature at stations."""
        starts = np.array([station for station, _, _ in self.placed_pieces()])
        bends = np.array([piece.curvature for piece in self.pieces])
        found: Floats = bends[np.clip(np.searchsorted(starts, s, side="right") - 1, 0, None)]
        return found

    def pose(self, s: float) -> Pose:
        """Return the pose at a station."""
        x, y, heading = self.at(s)
        return Pose(float(x), float(y), float(heading))

    def cut(self, start: float, end: float) -> Line:
        """Return the part between two stations."""
        parts = []
        for station, _, piece in self.placed_pieces():
            length = min(end, station + piece.length_m) - max(start, station)
            if length > 1e-9:
                parts.append(Piece(length, piece.curvature))
        return Line(tuple(parts), self.pose(start))

    def then(self, *pieces: Piece) -> Line:
        """Return the line with more pieces at its end."""
        return Line((*self.pieces, *pieces), self.start)


def _walk(pose: Pose, u: Floats, curvature: float) -> tuple[Floats, Floats, Floats]:
    turned = pose.heading + curvature * u
    if not curvature:
        return pose.x + u * math.cos(pose.heading), pose.y + u * math.sin(pose.heading), turned
    return (
        pose.x + (np.sin(turned) - math.sin(pose.heading)) / curvature,
        pose.y - (np.cos(turned) - math.cos(pose.heading)) / curvature,
        turned,
    )


def _end(pose: Pose, piece: Piece) -> Pose:
    x, y, heading = _walk(pose, np.array(piece.length_m), piece.curvature)
    return Pose(float(x), float(y), float(heading))
