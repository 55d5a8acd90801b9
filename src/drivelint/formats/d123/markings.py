"""Finds the markings of the lanes of a 123D map from its road lines, which the map does not assign to lanes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import shapely

from drivelint.formats.d123 import facts
from drivelint.road.boundary_lanes import Mark, both_marks
from drivelint.road.lane_geometry import resampled, stations
from drivelint.road.tree_parts import all_pairs

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.arrays import Floats, Indices, Mask

_MAX_LINE_DISTANCE_FROM_BOUND_M: Final = 0.1  # about the width of a painted line
_BOUND_PIECE_LENGTH_M: Final = 2.0
_SIDE_DEPENDENT_MARKINGS: Final = frozenset({"broken_solid", "solid_broken"})
"""Markings whose name depends on the side from which they are seen: known only if the lane that owns the line is known."""
_UNKNOWN_MARKING_CODE: Final = -1
_MARKING_WORDS: Final = tuple(sorted({word for word in facts.MARKINGS.values() if word is not None}))


class RoadLine(NamedTuple):
    """A road line: the number of its type, and its points (n, 2) or (n, 3)."""

    type_number: int
    points: Floats


LaneBounds = tuple["Floats", "Floats"]
"""The left and the right bound of a lane."""


def lane_marks(
    bounds: Mapping[str, LaneBounds], lines: Sequence[RoadLine], about: facts.DatasetFacts
) -> dict[str, tuple[Mark, ...]]:
    """Return lane id -> its marks. `bounds`: in the order of the map."""
    if about.lines_of_lanes and (marks := _marks_if_lines_are_bounds_in_order(bounds, lines)) is not None:
        return marks
    return _marks_by_lines_along_bounds(bounds, lines, about)


def _marks_if_lines_are_bounds_in_order(
    bounds: Mapping[str, LaneBounds], lines: Sequence[RoadLine]
) -> dict[str, tuple[Mark, ...]] | None:
    """Return the marks if the lines are the lanes' own bounds, in the order of the lanes; None if they are not."""
    marks: dict[str, tuple[Mark, ...]] = {}
    k = 0
    for name, sides in bounds.items():
        words = []
        for bound in sides:
            if k < len(lines) and np.array_equal(lines[k].points, bound):
                words.append(facts.MARKINGS.get(lines[k].type_number))
                k += 1
            else:
                words.append("none")  # the map leaves out bounds without paint
        marks[name] = both_marks(*words)
    return marks if k == len(lines) else None


def _marks_by_lines_along_bounds(
    bounds: Mapping[str, LaneBounds], lines: Sequence[RoadLine], about: facts.DatasetFacts
) -> dict[str, tuple[Mark, ...]]:
    """Return the marks by the lines along each piece of a bound; unknown for a piece without lines, or with lines that differ."""
    if not lines:
        return dict.fromkeys(bounds, both_marks(None, None))
    codes = np.array([_marking_code(line, about) for line in lines], np.int64)
    tree = shapely.STRtree([shapely.LineString(line.points[:, :2]) for line in lines])
    samples = [_sample_points(bound) for sides in bounds.values() for bound in sides]
    counts = [len(points) // 2 for points in samples]
    pieces = _marking_codes_of_pieces(
        np.concatenate(samples), np.cumsum([0, *(len(points) for points in samples)]), tree, codes
    )
    of_bound = np.split(pieces, np.cumsum(counts)[:-1])
    return {
        name: (*_marks_of_side("left", of_bound[2 * i]), *_marks_of_side("right", of_bound[2 * i + 1]))
        for i, name in enumerate(bounds)
    }


def _marking_code(line: RoadLine, about: facts.DatasetFacts) -> int:
    """Return the index of a line's marking in `_MARKING_WORDS`, `_UNKNOWN_MARKING_CODE` if the marking is not certain."""
    word = facts.MARKINGS.get(line.type_number)
    unsure = {facts.ROAD_LINE_NUMBERS[name] for name in about.unsure_lines}
    if word is None or word in _SIDE_DEPENDENT_MARKINGS or line.type_number in unsure:
        return _UNKNOWN_MARKING_CODE
    return _MARKING_WORDS.index(word)


def _sample_points(bound: Floats) -> Floats:
    """Return points along a bound, (2 k + 1, 2): the ends and the middles of k equal pieces."""
    s = stations(bound)
    k = max(1, int(np.ceil(s[-1] / _BOUND_PIECE_LENGTH_M)))
    return resampled(bound[:, :2], s, np.linspace(0.0, s[-1], 2 * k + 1))


def _marking_codes_of_pieces(points: Floats, starts: Indices, tree: shapely.STRtree, codes: Indices) -> Indices:
    """Return the code of each piece: that of the lines near its middle and both its ends, if these lines agree.

    `starts`: the index of the first point of each bound, and the number of all points.
    """
    n = len(codes)
    at, line = all_pairs(tree, shapely.points(points), "dwithin", _MAX_LINE_DISTANCE_FROM_BOUND_M)
    keys = np.sort(at.astype(np.int64) * n + line)
    within = np.arange(len(points)) - np.repeat(starts[:-1], np.diff(starts))
    middles = np.flatnonzero(within % 2 == 1)
    is_middle = np.zeros(len(points), np.bool_)
    is_middle[middles] = True
    some = keys[is_middle[keys // n]]
    along = some[_are_among(some - n, keys) & _are_among(some + n, keys)]
    piece = np.searchsorted(middles, along // n)
    lowest, highest = np.full(len(middles), np.iinfo(np.int64).max), np.full(len(middles), _UNKNOWN_MARKING_CODE - 1)
    np.minimum.at(lowest, piece, codes[along % n])
    np.maximum.at(highest, piece, codes[along % n])
    return np.where(lowest == highest, lowest, _UNKNOWN_MARKING_CODE)


def _are_among(values: Indices, ordered: Indices) -> Mask:
    """Return which values are in `ordered`, an ascending array."""
    at = np.minimum(np.searchsorted(ordered, values), max(len(ordered) - 1, 0))
    return np.asarray(ordered[at] == values, np.bool_) if len(ordered) else np.zeros(len(values), np.bool_)


def _marks_of_side(side: str, piece_codes: Indices) -> list[Mark]:
    """Return the marks of one side; successive pieces with the same marking are one mark."""
    begins = np.flatnonzero(np.r_[True, piece_codes[1:] != piece_codes[:-1]])
    ends = np.r_[begins[1:], len(piece_codes)]
    return [
        Mark(
            side,
            b / len(piece_codes),
            e / len(piece_codes),
            None if piece_codes[b] == _UNKNOWN_MARKING_CODE else _MARKING_WORDS[piece_codes[b]],
        )
        for b, e in zip(begins.tolist(), ends.tolist(), strict=True)
    ]
