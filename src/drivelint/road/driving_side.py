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


SAME_CARRIAGEWAY_M: Final = 2.0  # the largest gap between opposite lanes of one carriageway, as in lane_beside.sql
CENTRAL_RESERVATION_M: Final = 15.0  # the largest gap between the two carriageways of a road
LEAST_LENGTH_M: Final = 20.0  # shorter lanes beside each other are a corner or an error of the map
DECISIVE_SHARE: Final = 2 / 3
_OVERLAP_M: Final = 0.5  # lanes that overlap more are not neighbours, such as lanes that fork
_LEVEL_M: Final = 3.0  # lanes with at least this difference in height are not neighbours
_ALONG: Final = float(np.cos(np.radians(30)))
_WIDEST_HALF_M: Final = 4.0
_PROBES: Final = 20_000  # the most segments that are examined, evenly spread


class _Pieces(NamedTuple):
    """The segments (m) of the centre lines of all lanes: lane, start and end (m, 4), length, unit direction."""

    lane: Indices
    begin: Floats
    end: Floats
    length: Floats
    ux: Floats
    uy: Floats


def side_driven_on(courses: Sequence[Floats]) -> str | None:
    """Return the driving side (lht, rht) by neighbouring lanes of opposite directions; None: there are none, or they disagree.

    `courses`: the one-way lanes outside junctions, as arrays (n, 4) in metres: x and y of the centre line, its height (NaN: unknown) and
    half the width. Lanes across a central reservation count only if too few lanes adjoin.
    """
    if len(courses) < 2:
        return None
    pieces = _pieces(courses)
    if not len(pieces.lane):
        return None
    for reach_m in (SAME_CARRIAGEWAY_M, CENTRAL_RESERVATION_M):
        left, right = _opposing(pieces, reach_m)
        if left + right >= LEAST_LENGTH_M:
            decisive = DECISIVE_SHARE * (left + right)
            return "rht" if left >= decisive else "lht" if right >= decisive else None
    return None


def _pieces(courses: Sequence[Floats]) -> _Pieces:
    lane = np.repeat(np.arange(len(courses)), [len(c) for c in courses])
    points = np.concatenate(courses)
    k = np.flatnonzero(lane[:-1] == lane[1:])
    dx, dy = points[k + 1, 0] - points[k, 0], points[k + 1, 1] - points[k, 1]
    length = np.hypot(dx, dy)
    k, dx, dy, length = k[length > 0], dx[length > 0], dy[length > 0], length[length > 0]
    return _Pieces(lane[k], points[k], points[k + 1], length, dx / length, dy / length)


def _opposing(pieces: _Pieces, reach_m: float) -> tuple[float, float]:
    """Return the lengths (m) along which the nearest lane on the left, and on the right, has the opposite direction.

    Gaps of more than `reach_m` do not count. If both sides have an opposite lane, only the nearer counts.
    """
    n = len(pieces.lane)
    chosen = np.unique(np.linspace(0, n - 1, min(_PROBES, n)).astype(np.intp))
    tree = shapely.STRtree(shapely.linestrings(np.stack([pieces.begin[:, :2], pieces.end[:, :2]], axis=1)))
    left, right = (_gap_to_opposing(pieces, tree, chosen, side, reach_m) for side in (1.0, -1.0))
    length = pieces.length[chosen]
    return float(length[left < right].sum()), float(length[right < left].sum())


def _gap_to_opposing(pieces: _Pieces, tree: shapely.STRtree, indices: Indices, side: float, reach_m: float) -> Floats:
    """Return the gap (m) from these pieces to the nearest lane on one side (1: left, -1: right); infinity if it is no opposite lane."""
    x, y, _, half = ((pieces.begin + pieces.end) / 2)[indices].T
    ux, uy = pieces.ux[indices], pieces.uy[indices]
    reach = (half - _OVERLAP_M, half + reach_m + _WIDEST_HALF_M)
    across = (np.stack([a + side * r * n for r in reach], axis=1) for a, n in ((x, -uy), (y, ux)))
    gaps = np.full(len(indices), np.inf)
    for probe, other_piece in query_in_parts(tree, shapely.linestrings(*across), "intersects"):
        nearest, gap = _nearest_opposing(pieces, indices, probe, other_piece, side=side, reach_m=reach_m)
        gaps[nearest] = gap
    return gaps


def _nearest_opposing(
    pieces: _Pieces, indices: Indices, probe: Indices, other_piece: Indices, *, side: float, reach_m: float
) -> tuple[Indices, Floats]:
    """Return the pieces (positions in `indices`) with a lane beside them, and the gap to the nearest; infinity if it is no opposite lane.

    `probe`, `other_piece`: pairs of a position in `indices`, and a piece that the line across meets.
    """
    x, y, z, half = ((pieces.begin + pieces.end) / 2)[indices].T
    ux, uy = pieces.ux[indices], pieces.uy[indices]
    along = ux[probe] * pieces.ux[other_piece] + uy[probe] * pieces.uy[other_piece]
    beside = (pieces.lane[other_piece] != pieces.lane[indices[probe]]) & (np.abs(along) > _ALONG)
    probe, other_piece, along = probe[beside], other_piece[beside], along[beside]
    # the point where the line across meets the other piece's centre line
    other_x, other_y, other_z, other_half = pieces.begin[other_piece].T
    dx, dy = other_x - x[probe], other_y - y[probe]
    cross = ux[probe] * pieces.uy[other_piece] - uy[probe] * pieces.ux[other_piece]
    off = dy * ux[probe] - dx * uy[probe] - (dx * ux[probe] + dy * uy[probe]) * cross / along
    gap = side * off - half[probe] - other_half
    on_level = ~(np.abs(z[probe] - other_z) >= _LEVEL_M)  # also true for an unknown height
    fits = (gap > -_OVERLAP_M) & (gap <= reach_m) & on_level
    probe, gap, along = probe[fits], gap[fits], along[fits]
    order = np.lexsort((along, gap, probe))
    nearest = order[np.r_[True, np.diff(probe[order]) > 0]] if len(order) else order
    return probe[nearest], np.where(along[nearest] < 0, gap[nearest], np.inf)


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
