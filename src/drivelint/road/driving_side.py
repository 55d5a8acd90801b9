"""Finds the side driven on from lanes that run beside each other in opposite directions.

In right-hand traffic whoever comes towards a driver passes on the left, on a road with both directions as on two roads of one direction
each. On a road of one direction alone nothing lies on either side, and its lanes' direction does not tell which side is driven on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import shapely

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.arrays import Floats, Indices


SAME_CARRIAGEWAY_M: Final = 2.0  # so far apart two directions of one carriageway may be painted, as in lane_beside.sql
CENTRAL_RESERVATION_M: Final = 15.0  # and the two carriageways of a road
LEAST_LENGTH_M: Final = 20.0  # less of it is a corner or a mistake in the map
DECISIVE_SHARE: Final = 2 / 3
_OVERLAP_M: Final = 0.5  # more of it is the same ground twice, as where lanes fork
_LEVEL_M: Final = 3.0  # as far apart in height, lanes are not beside each other
_ALONG: Final = float(np.cos(np.radians(30)))
_WIDEST_HALF_M: Final = 4.0
_PROBES: Final = 20_000  # stations looked at, evenly spread


class OneWayLane(NamedTuple):
    """The middle of a lane that is driven one way, outside junctions, as arrays (n,) in metres.

    `tx`, `ty`: the unit tangent; `z` NaN: not known.
    """

    x: Floats
    y: Floats
    z: Floats
    tx: Floats
    ty: Floats
    half_width: Floats


class _Pieces(NamedTuple):
    """The straight pieces of all courses, (m,): of which lane, from which point of `course` to the next, how long, and their direction."""

    course: OneWayLane  # all of them, one after the other
    lane: Indices
    k: Indices
    length: Floats
    ux: Floats
    uy: Floats


def side_driven_on(courses: Sequence[OneWayLane]) -> str | None:
    """Return lht or rht by the lanes that run beside each other in opposite directions; None: there are none, or they disagree.

    Those that touch count before those across a central reservation.
    """
    if len(courses) < 2:
        return None
    pieces = _pieces(courses)
    if not len(pieces.k):
        return None
    for reach_m in (SAME_CARRIAGEWAY_M, CENTRAL_RESERVATION_M):
        left, right = _opposing(pieces, reach_m)
        if left + right >= LEAST_LENGTH_M:
            decisive = DECISIVE_SHARE * (left + right)
            return "rht" if left >= decisive else "lht" if right >= decisive else None
    return None


def _pieces(courses: Sequence[OneWayLane]) -> _Pieces:
    lane = np.repeat(np.arange(len(courses)), [len(c.x) for c in courses])
    c = OneWayLane(*(np.concatenate(columns) for columns in zip(*courses, strict=True)))
    k = np.flatnonzero(lane[:-1] == lane[1:])
    dx, dy = c.x[k + 1] - c.x[k], c.y[k + 1] - c.y[k]
    length = np.hypot(dx, dy)
    kept = length > 0
    return _Pieces(
        c, lane[k[kept]], k[kept], *(a[kept] / length[kept] ** n for a, n in ((length, 0), (dx, 1), (dy, 1)))
    )


def _opposing(pieces: _Pieces, reach_m: float) -> tuple[float, float]:
    """Return along how many metres the nearest lane, within reach of a bound, is an opposing one, on the left and on the right.

    Where both sides have one, the nearer counts.
    """
    chosen = np.unique(np.linspace(0, len(pieces.k) - 1, min(_PROBES, len(pieces.k))).astype(np.intp))
    c, k = pieces.course, pieces.k
    ends = (np.stack([a[k], a[k + 1]], axis=1) for a in (c.x, c.y))
    tree = shapely.STRtree(shapely.linestrings(*ends))
    left, right = (_gap_to_opposing(pieces, tree, chosen, side, reach_m) for side in (1.0, -1.0))
    length = pieces.length[chosen]
    return float(length[left < right].sum()), float(length[right < left].sum())


def _gap_to_opposing(pieces: _Pieces, tree: shapely.STRtree, chosen: Indices, side: float, reach_m: float) -> Floats:
    """Return the gap (m) from these pieces to the nearest lane on one side (1 left, -1 right); infinity: none, or it runs the same way."""
    c, k = pieces.course, pieces.k[chosen]
    x, y, z, half = ((a[k] + a[k + 1]) / 2 for a in (c.x, c.y, c.z, c.half_width))
    ux, uy = pieces.ux[chosen], pieces.uy[chosen]
    reach = (half - _OVERLAP_M, half + reach_m + _WIDEST_HALF_M)
    across = (np.stack([a + side * r * n for r in reach], axis=1) for a, n in ((x, -uy), (y, ux)))
    probe, other = tree.query(shapely.linestrings(*across), predicate="intersects")
    elsewhere = pieces.lane[other] != pieces.lane[chosen[probe]]
    probe, other = probe[elsewhere], other[elsewhere]
    along = ux[probe] * pieces.ux[other] + uy[probe] * pieces.uy[other]
    parallel = np.abs(along) > _ALONG
    probe, other, along = probe[parallel], other[parallel], along[parallel]
    # where the line across meets the other's middle
    there = pieces.k[other]
    dx, dy = c.x[there] - x[probe], c.y[there] - y[probe]
    cross = ux[probe] * pieces.uy[other] - uy[probe] * pieces.ux[other]
    off = dy * ux[probe] - dx * uy[probe] - (dx * ux[probe] + dy * uy[probe]) * cross / along
    gap = side * off - half[probe] - c.half_width[there]
    on_level = ~(np.abs(z[probe] - c.z[there]) >= _LEVEL_M)  # a height that is not known is any
    fits = (gap > -_OVERLAP_M) & (gap <= reach_m) & on_level
    probe, gap, along = probe[fits], gap[fits], along[fits]
    order = np.lexsort((along, gap, probe))
    nearest = order[np.r_[True, np.diff(probe[order]) > 0]] if len(order) else order
    found = np.full(len(chosen), np.inf)
    found[probe[nearest]] = np.where(along[nearest] < 0, gap[nearest], np.inf)
    return found
