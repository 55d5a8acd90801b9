"""Finds the driving side from neighbouring lanes of opposite directions, and chooses among several sources of it.

In right-hand traffic, oncoming vehicles pass on the left, both on two-way roads and on pairs of one-way roads. A single one-way road has
no oncoming lane, so it does not show the driving side.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import shapely

from drivelint.road.tree_parts import query_in_parts

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from drivelint.arrays import Floats, Indices
    from drivelint.road.quality import MapQuality


MOST_GAP_WITHIN_CARRIAGEWAY_M: Final = (
    2.0  # the largest gap between opposite lanes of one carriageway, as in lane_beside.sql
)
MOST_GAP_BETWEEN_CARRIAGEWAYS_M: Final = 15.0  # the largest gap between the two carriageways of a road
LEAST_OPPOSING_LENGTH_M: Final = 20.0  # shorter lanes beside each other are a corner or an error of the map
DECISIVE_SHARE_OF_OPPOSING_LENGTH: Final = 2 / 3
_MOST_OVERLAP_OF_NEIGHBOURS_M: Final = 0.5  # lanes that overlap more are not neighbours, such as lanes that fork
_OTHER_LEVEL_HEIGHT_DIFFERENCE_M: Final = 3.0  # lanes with at least this difference in height are not neighbours
_LEAST_PARALLEL_COS: Final = float(np.cos(np.radians(30)))
_LARGEST_HALF_LANE_WIDTH_M: Final = 4.0
_MOST_EXAMINED_SEGMENTS: Final = 20_000  # the most segments that are examined, evenly spread


class _LaneSegments(NamedTuple):
    """The segments (m) of the centre lines of all lanes: lane, start and end (m, 4), length, unit direction."""

    lane: Indices
    begin: Floats
    end: Floats
    length: Floats
    ux: Floats
    uy: Floats


def side_driven_on(lanes_points: Sequence[Floats]) -> str | None:
    """Return the driving side (lht, rht) by neighbouring lanes of opposite directions; None: there are none, or they disagree.

    `lanes_points`: the one-way lanes outside junctions, as arrays (n, 4) in metres: x and y of the centre line, its height (NaN: unknown)
    and half the width. Lanes across a central reservation count only if too few lanes adjoin.
    """
    if len(lanes_points) < 2:
        return None
    segments = _lane_segments(lanes_points)
    if not len(segments.lane):
        return None
    for most_gap_m in (MOST_GAP_WITHIN_CARRIAGEWAY_M, MOST_GAP_BETWEEN_CARRIAGEWAYS_M):
        left, right = _opposing_lengths_m(segments, most_gap_m)
        if left + right >= LEAST_OPPOSING_LENGTH_M:
            decisive = DECISIVE_SHARE_OF_OPPOSING_LENGTH * (left + right)
            return "rht" if left >= decisive else "lht" if right >= decisive else None
    return None


def _lane_segments(lanes_points: Sequence[Floats]) -> _LaneSegments:
    lane = np.repeat(np.arange(len(lanes_points)), [len(c) for c in lanes_points])
    points = np.concatenate(lanes_points)
    k = np.flatnonzero(lane[:-1] == lane[1:])
    dx, dy = points[k + 1, 0] - points[k, 0], points[k + 1, 1] - points[k, 1]
    length = np.hypot(dx, dy)
    k, dx, dy, length = k[length > 0], dx[length > 0], dy[length > 0], length[length > 0]
    return _LaneSegments(lane[k], points[k], points[k + 1], length, dx / length, dy / length)


def _opposing_lengths_m(segments: _LaneSegments, most_gap_m: float) -> tuple[float, float]:
    """Return the lengths (m) along which the nearest lane on the left, and on the right, has the opposite direction.

    Gaps of more than `most_gap_m` do not count. If both sides have an opposite lane, only the nearer counts.
    """
    n = len(segments.lane)
    sample = np.unique(np.linspace(0, n - 1, min(_MOST_EXAMINED_SEGMENTS, n)).astype(np.intp))
    tree = shapely.STRtree(shapely.linestrings(np.stack([segments.begin[:, :2], segments.end[:, :2]], axis=1)))
    left, right = (_gaps_to_opposing_m(segments, tree, sample, side, most_gap_m) for side in (1.0, -1.0))
    length = segments.length[sample]
    return float(length[left < right].sum()), float(length[right < left].sum())


def _gaps_to_opposing_m(
    segments: _LaneSegments, tree: shapely.STRtree, indices: Indices, side: float, most_gap_m: float
) -> Floats:
    """Return the gap (m) from these segments to the nearest lane on one side (1: left, -1: right); infinity if it is no opposite lane."""
    x, y, _, half = ((segments.begin + segments.end) / 2)[indices].T
    ux, uy = segments.ux[indices], segments.uy[indices]
    reach = (half - _MOST_OVERLAP_OF_NEIGHBOURS_M, half + most_gap_m + _LARGEST_HALF_LANE_WIDTH_M)
    across = (np.stack([a + side * r * n for r in reach], axis=1) for a, n in ((x, -uy), (y, ux)))
    gaps = np.full(len(indices), np.inf)
    for probes, other_segments in query_in_parts(tree, shapely.linestrings(*across), "intersects"):
        nearest, gap = _segments_and_gaps_to_nearest_lane_m(
            segments, indices, probes, other_segments, side=side, most_gap_m=most_gap_m
        )
        gaps[nearest] = gap
    return gaps


def _segments_and_gaps_to_nearest_lane_m(
    segments: _LaneSegments,
    indices: Indices,
    probes: Indices,
    other_segments: Indices,
    *,
    side: float,
    most_gap_m: float,
) -> tuple[Indices, Floats]:
    """Return the segments (positions in `indices`) with a lane beside them, and the gap to the nearest; infinity if it is no opposite lane.

    `probes`, `other_segments`: pairs of a position in `indices`, and a segment that the line across meets.
    """
    x, y, z, half = ((segments.begin + segments.end) / 2)[indices].T
    ux, uy = segments.ux[indices], segments.uy[indices]
    along = ux[probes] * segments.ux[other_segments] + uy[probes] * segments.uy[other_segments]
    beside = (segments.lane[other_segments] != segments.lane[indices[probes]]) & (np.abs(along) > _LEAST_PARALLEL_COS)
    probes, other_segments, along = probes[beside], other_segments[beside], along[beside]
    # the point where the line across meets the other segment
    other_x, other_y, other_z, other_half = segments.begin[other_segments].T
    dx, dy = other_x - x[probes], other_y - y[probes]
    cross = ux[probes] * segments.uy[other_segments] - uy[probes] * segments.ux[other_segments]
    off = dy * ux[probes] - dx * uy[probes] - (dx * ux[probes] + dy * uy[probes]) * cross / along
    gap = side * off - half[probes] - other_half
    on_level = ~(np.abs(z[probes] - other_z) >= _OTHER_LEVEL_HEIGHT_DIFFERENCE_M)  # also true for an unknown height
    fits = (gap > -_MOST_OVERLAP_OF_NEIGHBOURS_M) & (gap <= most_gap_m) & on_level
    probes, gap, along = probes[fits], gap[fits], along[fits]
    order = np.lexsort((along, gap, probes))
    nearest = order[np.r_[True, np.diff(probes[order]) > 0]] if len(order) else order
    return probes[nearest], np.where(along[nearest] < 0, gap[nearest], np.inf)


def opposite_side(side: str) -> str:
    """Return rht for lht, and lht for rht."""
    return "lht" if side == "rht" else "rht"


def correction_hint(side: str, source: str) -> str:
    """Return what the user can do if `side` is wrong; `source`: the source of `side`, such as option, attribute or lanes."""
    return (
        f"leave the option out, or set {opposite_side(side)}"
        if source == "option"
        else f"give --handedness {opposite_side(side)}"
    )


def choose_side(
    statements: Iterable[tuple[str, str | None]], quality: MapQuality, where: str = "the map"
) -> tuple[str, str]:
    """Return the first of the statements (source, side) that has a side, as side and source; report disagreement in `quality`."""
    stated_sides = [(source, side) for source, side in statements if side is not None]
    if not stated_sides:
        message = f"{where} does not state which side is driven on: right-hand traffic is assumed; set --handedness"
        quality.add("handedness_default", "warning", None, message)
        return "rht", "default"
    source, side = stated_sides[0]
    if len({side for _, side in stated_sides}) > 1:
        opinions = ", ".join(f"{source}: {side}" for source, side in stated_sides)
        message = f"{opinions}; the first is used: if it is wrong, {correction_hint(side, source)}"
        quality.add("handedness_disagrees", "warning", None, message)
    return side, source
