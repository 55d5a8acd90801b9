"""Builds the physical lanes of an OSI trace (`lane` and `lane_boundary`) from centre lines and boundaries, or from boundaries alone.

In OSI, an intersection is one area with pairs of lanes that lead into it and out of it. Here, a smooth lane is drawn for each pair.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from drivelint.formats.osi import map_kinds as kinds
from drivelint.formats.osi.map_logical import MAX_LINK_GAP_M
from drivelint.road.boundary_lanes import BoundedLane, both_marks
from drivelint.road.lane_geometry import LARGEST_COORDINATE_M, UnbuildableError, resampled, stations

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.arrays import Floats
    from drivelint.road.quality import MapQuality

_DRIVING, _NONDRIVING = 2, 3
_LARGEST_MISSING_SIDE_M = 0.2  # a side that ends further than this from the lane's end is extended
_DASH_GAP_M = 15.0  # largest gap between boundaries of one side: dashed ones only reach to their last dash
_CURVE_POINTS = 13
_DIRECTION_FIELD = "centerline_is_driving_direction"


@dataclass(frozen=True)
class PhysicalLane:
    """A lane in the direction of travel: its message, centre line (n, 3) and bounds (n, 2). `is_reversed`: OSI's direction is opposite."""

    message: Any
    centre_line: Floats
    left: Floats
    right: Floats
    is_reversed: bool


def read(truth: Any, quality: MapQuality) -> dict[int, PhysicalLane]:
    """Return id -> lane, without areas of intersections. A lane without a shape or direction is left out and added to `quality`."""
    bounds = {b.id.value: b for b in truth.lane_boundary}
    directions = [lane.classification for lane in truth.lane if lane.classification.HasField(_DIRECTION_FIELD)]
    # if the flag is true or missing, and never false, the writer omits false
    omits_false = {classification.centerline_is_driving_direction for classification in directions} == {True}
    lanes: dict[int, PhysicalLane] = {}
    for lane in truth.lane:
        classification = lane.classification
        if classification.type == kinds.INTERSECTION_LANE_TYPE and (
            len(classification.lane_pairing) > 1 or len(classification.centerline) < 2
        ):
            continue
        try:
            lanes[lane.id.value] = _physical_lane(lane, bounds, omits_false=omits_false)
        except UnbuildableError as error:
            name = str(lane.id.value)
            quality.add("invalid_lane", "error", name, f"lane {name} is left out: {error}")
    return lanes


def _is_driven_in_point_order(classification: Any, *, omits_false: bool) -> bool:
    """Return whether a lane is driven in the order of its points. Errors: `UnbuildableError` if the log does not state it."""
    if classification.HasField(_DIRECTION_FIELD):
        return bool(classification.centerline_is_driving_direction)
    if omits_false:
        return False
    if _kind_and_is_drivable(classification)[1]:
        raise UnbuildableError(
            "the direction in which it is driven is not known (centerline_is_driving_direction is not set)"
        )
    return True


def _xyz(points: Iterable[Any]) -> Floats:
    return np.array([(p.x, p.y, p.z) for p in points], np.float64).reshape(-1, 3)


def _physical_lane(lane: Any, bounds: Mapping[int, Any], *, omits_false: bool) -> PhysicalLane:
    """Return a lane in the direction of travel. Errors: `UnbuildableError` with the missing or invalid part."""
    classification = lane.classification
    ids = classification.left_lane_boundary_id, classification.right_lane_boundary_id
    lines = [
        [_xyz(p.position for p in bounds[i.value].boundary_line) for i in side if i.value in bounds] for side in ids
    ]
    if not (lines[0] and lines[1]):
        lacks = "no boundaries" if not (lines[0] or lines[1]) else f"no {'right' if lines[0] else 'left'} boundary"
        raise UnbuildableError(f"it has {lacks} and therefore no width")
    centre = _xyz(classification.centerline)
    if not all((np.abs(points) < LARGEST_COORDINATE_M).all() for points in (centre, *lines[0], *lines[1])):
        raise UnbuildableError("a point of it has an impossible coordinate")
    if len(centre) < 2:
        if any(i.value not in bounds for side in ids for i in side):
            raise UnbuildableError("it has no centre line, and not all of its boundaries are in the log")
        first, second = _parts_beside_each_other(_line_of_boundaries(lines[0]), _line_of_boundaries(lines[1]))
        centre, left, right = (first + second) / 2, first[:, :2], second[:, :2]
    else:
        left, right = (_side_along_centre_line(centre[:, :2], np.vstack(side)[:, :2]) for side in lines)
    if _is_driven_in_point_order(classification, omits_false=omits_false):
        return PhysicalLane(lane, centre, left, right, is_reversed=False)
    return PhysicalLane(lane, centre[::-1], right[::-1], left[::-1], is_reversed=True)


def _line_of_boundaries(boundaries: list[Floats]) -> Floats:
    """Return one side's boundaries joined to a line (n, 3). Errors: `UnbuildableError` for too few points or too large gaps."""
    boundaries = [part for part in boundaries if len(part) > 1]
    if not boundaries:
        raise UnbuildableError("none of its boundaries on one side has two points")
    gaps = np.array([[np.hypot(*(b[0] - a[-1])[:2]) for b in boundaries] for a in boundaries])
    np.fill_diagonal(gaps, np.inf)
    at = int(np.argmax(gaps.min(axis=0))) if len(boundaries) > 1 else 0  # the boundary that follows no other
    chain, left = [boundaries[at]], set(range(len(boundaries))) - {at}
    while left:
        follows = min(left, key=lambda k: (gaps[at, k], k))
        if gaps[at, follows] > _DASH_GAP_M:
            raise UnbuildableError(f"there are {gaps[at, follows]:.0f} m between its boundaries of one side")
        chain.append(boundaries[follows])
        left.remove(follows)
        at = follows
    return np.vstack(chain)


def _parts_beside_each_other(left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Return the parts (n, 3) of two boundaries that are beside each other, sampled at equal shares of their lengths."""
    left = _part_beside(left, right)
    right = _part_beside(right, left)
    shares = [s / s[-1] for s in map(stations, (left, right))]
    at = np.unique(np.round(np.concatenate(shares), 6))
    return resampled(left, shares[0], at), resampled(right, shares[1], at)


def _part_beside(side: Floats, opposite_side: Floats) -> Floats:
    """Return the part of a boundary beside the opposite boundary. Errors: `UnbuildableError` if there is none."""
    s = stations(side)
    line = shapely.LineString(side[:, :2])
    begin, end = (float(line.project(shapely.Point(p))) for p in (opposite_side[0, :2], opposite_side[-1, :2]))
    if end - begin < 1e-3:
        raise UnbuildableError("its two boundaries do not lie beside each other in the same order")
    at = np.unique(np.concatenate([[begin, end], s[(s > begin) & (s < end)]]))
    return resampled(side, s, at)


def _side_along_centre_line(centre_line: Floats, points: Floats) -> Floats:
    """Return one side's points, sorted along the centre line. Errors: `UnbuildableError` if fewer than two are beside it."""
    line = shapely.LineString(centre_line)
    station = np.asarray(shapely.line_locate_point(line, shapely.points(points)), np.float64)
    order = np.argsort(station, kind="stable")
    points, station = points[order], station[order]
    # before the lane's start and after its end, only the nearest point belongs to the lane
    inside = (station > 1e-6) & (station < line.length - 1e-6)
    first, last = points[station <= 1e-6], points[station >= line.length - 1e-6]
    side_points = np.vstack(
        [_nearest_point(first, centre_line[:1]), points[inside], _nearest_point(last, centre_line[-1:])]
    )
    if len(side_points) < 2:
        raise UnbuildableError("a boundary has fewer than two points beside it")
    return _side_extended_to_lane_ends(side_points, centre_line)


def _side_extended_to_lane_ends(side: Floats, centre_line: Floats) -> Floats:
    """Return a side (n, 2), extended parallel to the centre line (m, 2) up to both its ends.

    esmini draws a boundary only up to its last marked point, which may be metres before the lane's end.
    """
    way = np.gradient(centre_line, axis=0)
    left = np.column_stack([-way[:, 1], way[:, 0]]) / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
    line = shapely.LineString(centre_line)
    at = stations(centre_line)
    begin, end = (float(line.project(shapely.Point(p))) for p in (side[0], side[-1]))
    is_missing = (at < begin - _LARGEST_MISSING_SIDE_M), (at > end + _LARGEST_MISSING_SIDE_M)
    led = []
    for beyond, point, station in zip(is_missing, (side[0], side[-1]), (begin, end), strict=True):
        k = int(np.argmin(np.abs(at - station)))
        led.append(centre_line[beyond] + left[beyond] * float(np.dot(point - centre_line[k], left[k])))
    return np.vstack([led[0], side, led[1]])


def _nearest_point(points: Floats, target: Floats) -> Floats:
    """Return the point (1, 2) that is nearest to `target` (1, 2), or an empty array (0, 2) without points."""
    return points[np.argsort(np.hypot(*(points - target).T), kind="stable")[:1]]


def _kind_and_is_drivable(classification: Any) -> tuple[str, bool]:
    if classification.type in {_DRIVING, kinds.INTERSECTION_LANE_TYPE}:
        kind = kinds.LANE_KINDS.get(classification.subtype, "driving")
        return (kind if kind in kinds.DRIVABLE_LANE_KINDS else "driving"), True
    kind = kinds.LANE_KINDS.get(classification.subtype, "none")
    return kind if classification.type == _NONDRIVING and kind != "driving" else "none", False


def bounded_lanes(
    physical: Mapping[int, PhysicalLane], truth: Any, through_lanes: Sequence[BoundedLane]
) -> Iterable[BoundedLane]:
    """Yield the physical lanes with their links, neighbours and markings, then the lanes through intersections."""
    bounds = {b.id.value: b for b in truth.lane_boundary}
    linked = _lane_links(physical)
    for i, lane in physical.items():
        classification = lane.message.classification
        kind, drivable = _kind_and_is_drivable(classification)
        ids = [classification.left_lane_boundary_id, classification.right_lane_boundary_id]
        beside = [classification.left_adjacent_lane_id, classification.right_adjacent_lane_id]
        if lane.is_reversed:
            ids, beside = ids[::-1], beside[::-1]
        neighbours = [_neighbour_id_and_against(lane, side, physical) for side in beside]
        yield BoundedLane(
            str(i), lane.left, lane.right, kind, drivable,
            junction_id=f"j{i}" if classification.type == kinds.INTERSECTION_LANE_TYPE else None,
            successors=(
                *(str(b) for a, b in linked if a == i),
                *(way.lanelet_id for way in through_lanes if way.lanelet_id.split(".")[1] == str(i)),
            ),
            left_id=neighbours[0][0], left_against=neighbours[0][1],
            right_id=neighbours[1][0], right_against=neighbours[1][1],
            marks=both_marks(_marking_of_side(ids[0], bounds), _marking_of_side(ids[1], bounds)),
        )  # fmt: skip
    yield from through_lanes


def _lane_links(physical: Mapping[int, PhysicalLane]) -> list[tuple[int, int]]:
    """Return the pairs (a, b) in which b follows a. One of the two must state the link: esmini states some only at b."""
    pairs = set()
    for i, lane in physical.items():
        names = ["antecessor_lane_id", "successor_lane_id"]
        before, after = names[::-1] if lane.is_reversed else names
        for pair in lane.message.classification.lane_pairing:
            if pair.HasField(before):
                pairs.add((getattr(pair, before).value, i))
            if pair.HasField(after):
                pairs.add((i, getattr(pair, after).value))
    return sorted((a, b) for a, b in pairs if a in physical and b in physical and _leads_into(physical[a], physical[b]))


def _neighbour_id_and_against(
    lane: PhysicalLane, ids: Sequence[Any], physical: Mapping[int, PhysicalLane]
) -> tuple[str | None, bool | None]:
    for i in ids:
        if i.value in physical:
            neighbour = physical[i.value]
            same = (
                float(
                    np.dot(
                        *(
                            side_lane.centre_line[-1, :2] - side_lane.centre_line[0, :2]
                            for side_lane in (lane, neighbour)
                        )
                    )
                )
                > 0
            )
            return str(i.value), not same
    return None, None


def _marking_of_side(boundary_ids: Iterable[Any], bounds: Mapping[int, Any]) -> str | None:
    """Return the marking of one side of a lane; None if it is unknown or changes along the lane."""
    types = {bounds[i.value].classification.type for i in boundary_ids if i.value in bounds}
    return kinds.combined_marking(sorted(types)) if len(types) == 1 else None


def _leads_into(lane: PhysicalLane, next_lane: PhysicalLane) -> bool:
    return bool(np.linalg.norm((lane.centre_line[-1] - next_lane.centre_line[0])[:2]) < MAX_LINK_GAP_M)


def intersection_lanes(truth: Any, physical: Mapping[int, PhysicalLane]) -> list[tuple[BoundedLane, Floats]]:
    """Return a lane for each pair of lanes that an intersection joins, with its two end points (2, 3), which give its heights."""
    joining_lanes = []
    for area in truth.lane:
        if area.classification.type != kinds.INTERSECTION_LANE_TYPE or area.id.value in physical:
            continue
        pairs = {(p.antecessor_lane_id.value, p.successor_lane_id.value) for p in area.classification.lane_pairing}
        for into, out in sorted(pairs):
            a, b = physical.get(into), physical.get(out)
            if (
                a is None
                or b is None
                or not all(_kind_and_is_drivable(side_lane.message.classification)[1] for side_lane in (a, b))
            ):
                continue  # the pair is not two lanes for driving
            sides = (a.left, b.left), (a.right, b.right)
            left, right = (_cubic_curve(p[-1], p[-1] - p[-2], q[0], q[1] - q[0]) for p, q in sides)
            name = f"{area.id.value}.{into}.{out}"
            lane = BoundedLane(name, left, right, junction_id=f"j{area.id.value}", successors=(str(out),))
            joining_lanes.append((lane, np.vstack([a.centre_line[-1], b.centre_line[0]])))
    return joining_lanes


def _cubic_curve(start: Floats, start_direction: Floats, end: Floats, end_direction: Floats) -> Floats:
    """Return points (n, 2) on the cubic curve with these end points and end directions, each of shape (2,)."""
    reach = float(np.linalg.norm(end - start))
    v0 = start_direction / max(float(np.linalg.norm(start_direction)), 1e-9) * reach
    v1 = end_direction / max(float(np.linalg.norm(end_direction)), 1e-9) * reach
    u = np.linspace(0.0, 1.0, _CURVE_POINTS)[:, None]
    return (
        (2 * u**3 - 3 * u**2 + 1) * start
        + (u**3 - 2 * u**2 + u) * v0
        + (3 * u**2 - 2 * u**3) * end
        + (u**3 - u**2) * v1
    )
