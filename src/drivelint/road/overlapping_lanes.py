"""Finds the junctions of maps that do not name them, by drivable lanes that overlap."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import shapely

from drivelint.road.tree_parts import query_in_parts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.arrays import Floats
    from drivelint.road.boundary_lanes import BoundedLane

_LEAST_OVERLAP_M2: Final = 1.0
"""Lanes with a smaller common area do not overlap."""
_OTHER_LEVEL_HEIGHT_DIFFERENCE_M: Final = 3.0
"""Lanes with at least this difference in height are above each other and do not cross (as in `driving_side`)."""


def mark_junctions(lanes: Sequence[BoundedLane], *, least_share: float = 0.0, least_angle_rad: float = 0.0) -> None:
    """Mark overlapping lanes as parts of one junction, in place, except neighbours and successors.

    `least_share`: a smaller overlap, as share of the smaller lane's area, is inaccuracy of the bounds. `least_angle_rad`: lanes at a
    smaller angle split or merge, but do not cross (see `_crossing_angle_rad`). Lanes at different heights do not cross.
    """
    drivable_lanes = [lane for lane in lanes if lane.drivable]
    areas = [lane.line.polygon for lane in drivable_lanes]
    tree = shapely.STRtree(areas)
    parent = list(range(len(drivable_lanes)))

    def first_of_group(i: int) -> int:
        while parent[i] != i:
            i = parent[i]
        return i

    overlaps: set[int] = set()
    pairs = (np.stack(part, axis=1)[part[0] < part[1]] for part in query_in_parts(tree, areas, "intersects"))
    for i, j in (pair for part in pairs for pair in sorted(part.tolist())):
        a, b = drivable_lanes[i], drivable_lanes[j]
        if b.lanelet_id in {a.left_id, a.right_id, *a.successors} or a.lanelet_id in b.successors:
            continue
        common = shapely.intersection(areas[i], areas[j])
        if common.area <= max(_LEAST_OVERLAP_M2, least_share * min(areas[i].area, areas[j].area)):
            continue
        if (
            _height_difference_m(a, b, common) >= _OTHER_LEVEL_HEIGHT_DIFFERENCE_M
            or _crossing_angle_rad(a, b, common) < least_angle_rad
        ):
            continue
        overlaps |= {i, j}
        parent[max(first_of_group(i), first_of_group(j))] = min(first_of_group(i), first_of_group(j))
    for i in sorted(overlaps):
        drivable_lanes[i].junction_id = f"j{drivable_lanes[first_of_group(i)].lanelet_id}"


def _height_difference_m(a: BoundedLane, b: BoundedLane, common: shapely.Geometry) -> float:
    """Return the difference in height (m) of two lanes where they overlap; NaN: unknown."""
    return abs(float(np.subtract(*(_values_at_centroid(lane, common, lane.z[:, None])[0] for lane in (a, b)))))


def _crossing_angle_rad(a: BoundedLane, b: BoundedLane, common: shapely.Geometry) -> float:
    """Return the angle (rad) at which two lanes cross where they overlap.

    If they have a common start or end, the angle at their other ends is used if it is larger.
    """
    first, second = (_values_at_centroid(lane, common, lane.line.tangent) for lane in (a, b))
    across = abs(float(first[0] * second[1] - first[1] * second[0]))
    angle = float(np.arcsin(min(across, 1.0)))  # 0 for lanes of opposite direction, which do not cross
    if set(a.successors) & set(b.successors):
        angle = max(angle, _angle_between_rad(a.line.tangent[0], b.line.tangent[0]))
    if np.hypot(*(a.line.centre[0] - b.line.centre[0])) < 1.0:
        angle = max(angle, _angle_between_rad(a.line.tangent[-1], b.line.tangent[-1]))
    return angle


def _angle_between_rad(first: Floats, second: Floats) -> float:
    return float(np.arccos(np.clip(first @ second, -1.0, 1.0)))


def _values_at_centroid(lane: BoundedLane, area: shapely.Geometry, values: Floats) -> Floats:
    """Return the values (k,) of a lane closest to the centroid of an area; `values` (n, k): one row per point of the lane."""
    middle = area.centroid
    s = lane.line.station(np.array([middle.x, middle.y]))
    return np.array([np.interp(s, lane.line.s, column) for column in values.T])
