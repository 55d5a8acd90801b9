"""Finds the junctions of a map that names none: where lanes for driving lie over each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import shapely

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.road.boundary_lanes import BoundedLane

_LEAST_AREA_M2: Final = 1.0
_LEVEL_M: Final = 3.0  # as far apart in height, lanes do not meet


def mark_junctions(lanes: Sequence[BoundedLane]) -> None:
    """Mark lanes for driving whose areas overlap another's, that do not lie side by side, as parts of one junction."""
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
        if shapely.area(common) > _LEAST_AREA_M2 and not _on_another_level(a, b, common):
            overlaps |= {i, j}
            parent[max(root(i), root(j))] = min(root(i), root(j))
    for i in sorted(overlaps):
        driven[i].junction_id = f"j{driven[root(i)].lanelet_id}"


def _on_another_level(a: BoundedLane, b: BoundedLane, common: shapely.Geometry) -> bool:
    """Say whether one lane lies above the other where both are; a height that is not known is any."""
    place = shapely.get_coordinates(shapely.point_on_surface(common))[0]
    heights = [float(np.interp(lane.line.station(place), lane.line.s, lane.z)) for lane in (a, b)]
    return abs(heights[0] - heights[1]) >= _LEVEL_M
