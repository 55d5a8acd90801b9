"""Junctions of maps that name none: lanes for driving that lie across each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import shapely

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.road.boundary_lanes import BoundedLane

_LEAST_M2: Final = 1.0
_LEVEL_M: Final = 3.0
"""As far apart in height, lanes lie over each other and not across (as in `driving_side`)."""


def mark_junctions(lanes: Sequence[BoundedLane], *, least_share: float = 0.0) -> None:
    """Mark lanes whose areas overlap another's, that do not lie side by side, as parts of one junction.

    `least_share`: of the smaller one's area; less of it is the inaccuracy of bounds. Lanes at different heights do not meet.
    """
    driven = [lane for lane in lanes if lane.drivable]
    areas = [lane.line.polygon for lane in driven]
    tree = shapely.STRtree(areas)
    parent = list(range(len(driven)))

    def root(i: int) -> int:
        while parent[i] != i:
            i = parent[i]
        return i

    overlaps: set[int] = set()
    for i, j in sorted(
        {(int(min(a, b)), int(max(a, b))) for a, b in tree.query(areas, predicate="intersects").T if a != b}
    ):
        a, b = driven[i], driven[j]
        if b.lanelet_id in {a.left_id, a.right_id, *a.successors} or a.lanelet_id in b.successors:
            continue
        common = shapely.intersection(areas[i], areas[j])
        least_m2 = max(_LEAST_M2, least_share * min(areas[i].area, areas[j].area))
        if common.area > least_m2 and not abs(_height(a, common) - _height(b, common)) >= _LEVEL_M:
            overlaps |= {i, j}
            parent[max(root(i), root(j))] = min(root(i), root(j))
    for i in sorted(overlaps):
        driven[i].junction_id = f"j{driven[root(i)].lanelet_id}"


def _height(lane: BoundedLane, area: shapely.Geometry) -> float:
    """Return the height of a lane (m) where it lies on an area; NaN: not known."""
    middle = area.centroid
    return float(np.interp(lane.line.station(np.array([middle.x, middle.y])), lane.line.s, lane.z))
