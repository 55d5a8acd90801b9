"""Computes the geometry of a lane from its two bounds: pairs of opposite points, with stations, tangents and widths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import shapely

if TYPE_CHECKING:
    from drivelint.arrays import Floats, Mask

_SPACING_M = 4.0  # the most between points of a lane, because positions are searched by the grid cells of each segment
_SAME_POINT_M = 0.0005  # points at most this far apart are one point
_JITTER_M = 0.01  # a step back that is at most this long is inaccurate drawing
_WIDEST_M = 60.0  # a wider lane is an error in the bounds
LARGEST_COORDINATE_M: Final = 1e12  # a larger coordinate is an error, and GEOS may fail on it
_LONGEST_M = 100_000.0  # a longer lane is an error in the bounds


class UnbuildableError(ValueError):
    """Raised for a lane without a valid shape or direction; the caller adds the lane's name."""


def stations(line: Floats) -> Floats:
    """Return the station (m) of each point of a line (n, 2) or (n, 3): the horizontal distance along the line."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T))])


def resampled(line: Floats, s: Floats, at: Floats) -> Floats:
    """Return the points (m, k) of a line (n, k), whose stations are `s` (n,), at the stations `at` (m,)."""
    return np.column_stack([np.interp(at, s, column) for column in line.T])


@dataclass(frozen=True)
class LaneGeometry:
    """A lane's points: stations s (n,), centre, left and right (n, 2), unit tangents (n, 2), half widths (n,)."""

    s: Floats
    centre: Floats
    left: Floats
    right: Floats
    tangent: Floats
    half_width: Floats

    @property
    def length(self) -> float:
        """The length of the centre line (m)."""
        return float(self.s[-1])

    @property
    def turn_rad(self) -> float:
        """The change of heading along the lane (rad), positive to the left."""
        a, b = self.tangent[:-1], self.tangent[1:]
        return float(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(1)).sum())

    @property
    def area(self) -> float:
        """The area between the bounds (m2)."""
        ring = np.vstack([self.right, self.left[::-1]])
        x, y = (ring - ring[0]).T
        return abs(0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)))

    @property
    def width(self) -> float:
        """The mean width (m)."""
        return float(((self.half_width[:-1] + self.half_width[1:]) * np.diff(self.s)).sum() / self.s[-1])

    @property
    def polygon(self) -> shapely.Polygon:
        """The polygon between the bounds."""
        return shapely.Polygon(np.vstack([self.right, self.left[::-1]])).buffer(0.0)

    def points_with_half_widths(self, z: Floats) -> Floats:
        """Return x, y, height and half width (m) of each point, (n, 4), for `driving_side`; `z`: heights (m), NaN: unknown."""
        return np.column_stack([self.centre, z, self.half_width])

    def station(self, place: Floats) -> float:
        """Return the station (m) of the point of the centre line that is closest to a position (2,)."""
        return float(shapely.line_locate_point(shapely.LineString(self.centre), shapely.Point(place)))


def check_bounds(left: Floats, right: Floats) -> None:
    """Raise `UnbuildableError` if no lane can be made of these bounds (n, 2), (m, 2)."""
    if len(left) < 2 or len(right) < 2:
        raise UnbuildableError("a bound has fewer than two points")
    if not all((np.abs(bound) < LARGEST_COORDINATE_M).all() for bound in (left, right)):
        raise UnbuildableError("a bound has an impossible coordinate")


def lane_geometry(left: Floats, right: Floats) -> LaneGeometry:
    """Return the geometry of a lane with these bounds. Errors: `UnbuildableError` with the problem."""
    check_bounds(left, right)
    left, right = _bounds_of_equal_point_count(left, right)
    for keep_points in (_mask_of_distinct_points, _mask_without_backward_steps):
        keep = keep_points((left + right) / 2)
        left, right = left[keep], right[keep]
    centre = (left + right) / 2
    if len(centre) < 2:
        raise UnbuildableError("it has no length")
    total_m = float(np.hypot(*np.diff(centre, axis=0).T).sum())
    if total_m > _LONGEST_M:
        raise UnbuildableError(f"it is {total_m / 1000:.0f} km long")
    left, right = _bound_with_added_points(centre, left), _bound_with_added_points(centre, right)
    centre = (left + right) / 2
    step = np.diff(centre, axis=0)
    length = np.hypot(*step.T)
    direction = step / length[:, None]
    tangent = np.vstack([direction[:1], direction[:-1] + direction[1:], direction[-1:]])
    size = np.hypot(*tangent.T)
    if (size < 0.1).any():
        raise UnbuildableError("its centre line turns back on itself")
    tangent = tangent / size[:, None]
    across = left - right
    half = (tangent[:, 0] * across[:, 1] - tangent[:, 1] * across[:, 0]) / 2
    if (half <= 0).all():
        raise UnbuildableError("its left bound lies on the right of its right bound")
    half = np.maximum(half, 0.0)
    if 2 * half.max() > _WIDEST_M:
        raise UnbuildableError(f"it is {2 * half.max():.0f} m wide")
    return LaneGeometry(np.r_[0.0, np.cumsum(length)], centre, left, right, tangent, half)


def _mask_of_distinct_points(centre: Floats) -> Mask:
    """Return the mask of points of a centre line (n, 2) that do not repeat the point before them."""
    distinct: Mask = np.r_[True, np.hypot(*np.diff(centre, axis=0).T) > _SAME_POINT_M]
    return distinct


def _mask_without_backward_steps(centre: Floats) -> Mask:
    """Return the mask of the points of a centre line (n, 2) to keep: all but the points of short steps against its direction."""
    step = np.diff(centre, axis=0)
    short = np.hypot(*step.T) <= _JITTER_M
    back = np.sum(step[:-1] * step[1:], axis=1) < 0.0
    forwards: Mask = np.r_[True, ~(back & (short[:-1] | short[1:])), True][: len(centre)]
    return forwards


def _bounds_of_equal_point_count(left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Return the bounds with equal numbers of points: unchanged if the numbers are equal, else at equal shares of their lengths."""
    if len(left) == len(right):
        return left, right
    shares = [s / s[-1] if s[-1] > 0 else np.linspace(0.0, 1.0, len(s)) for s in map(stations, (left, right))]
    at = np.unique(np.round(np.concatenate(shares), 6))
    return resampled(left, shares[0], at), resampled(right, shares[1], at)


def _bound_with_added_points(centre: Floats, bound: Floats) -> Floats:
    """Return a bound with points added, so that the points of the centre line are at most `_SPACING_M` apart."""
    length = np.hypot(*np.diff(centre, axis=0).T)
    pieces = np.maximum(1, np.ceil(length / _SPACING_M)).astype(np.int64)
    start = np.repeat(np.arange(len(pieces)), pieces)
    share = (np.arange(len(start)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[start]
    points = bound[start] + share[:, None] * (bound[start + 1] - bound[start])
    return np.vstack([points, bound[-1:]])
