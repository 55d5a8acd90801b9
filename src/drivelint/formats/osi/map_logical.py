"""Builds the logical lanes of an OSI trace (OSI 3.5 and later) from their two boundaries along a reference line.

OSI's left, right, start and end refer to the direction of the reference line. Here, lanes are in the direction of travel.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from drivelint.formats.osi import map_kinds as kinds
from drivelint.road.boundary_lanes import BoundedLane, Mark
from drivelint.road.lane_geometry import LARGEST_COORDINATE_M, UnbuildableError, resampled

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from drivelint.arrays import Floats
    from drivelint.road.quality import MapQuality

_LARGEST_MISSING_BOUNDARY_M = 0.5  # a lane is invalid if a boundary ends further than this before the lane's end
MAX_LINK_GAP_M = 5.0  # the largest distance between a lane's end and the start of its successor


@dataclass(frozen=True)
class LogicalLane:
    """A lane in the direction of travel: its message and bounds (n, 3). `station_span`: its first and last s on the reference line.

    `direction_sign`: 1 if its direction is that of the reference line, otherwise -1.
    """

    message: Any
    left: Floats
    right: Floats
    station_span: tuple[float, float]
    direction_sign: int

    @property
    def centre_line(self) -> Floats:
        """The centre line (n, 3), in the middle between the bounds."""
        return (self.left + self.right) / 2

    @property
    def physical_lane_ids(self) -> list[int]:
        """The ids of the physical lanes to which the lane refers."""
        return [ref.physical_lane_id.value for ref in self.message.physical_lane_reference]

    def lane_fraction(self, s: float) -> float:
        """Return a station on the reference line as a share of the lane's length, from 0 at its start in the direction of travel."""
        begin, end = self.station_span
        at = min(max((s - begin) / (end - begin), 0.0), 1.0)
        return at if self.direction_sign > 0 else 1.0 - at


def read(truth: Any, quality: MapQuality) -> dict[int, LogicalLane]:
    """Return id -> logical lane. A lane without a shape or direction is left out and added to `quality`."""
    bounds = {bound.id.value: bound for bound in truth.logical_lane_boundary}
    lanes: dict[int, LogicalLane] = {}
    for message in truth.logical_lane:
        if message.type == kinds.CURB_LANE_TYPE:
            continue
        try:
            lanes[message.id.value] = _logical_lane(message, bounds)
        except UnbuildableError as error:
            name = str(message.id.value)
            quality.add("invalid_lane", "error", name, f"logical lane {name} is left out: {error}")
    return lanes


def bounded_lanes(lanes: Mapping[int, LogicalLane], truth: Any) -> Iterator[BoundedLane]:
    """Yield the lanes for the map, with links, neighbours, markings and speed limits."""
    bounds = {bound.id.value: bound for bound in truth.logical_lane_boundary}
    types = {bound.id.value: int(bound.classification.type) for bound in truth.lane_boundary}
    areas = {lane.id.value for lane in truth.lane if lane.classification.type == kinds.INTERSECTION_LANE_TYPE}
    log_has_markings = any(bound.physical_boundary_id for bound in bounds.values())
    linked = _lane_links(lanes)
    for name, lane in lanes.items():
        kind = kinds.LANE_KINDS.get(lane.message.type, "none")
        beside = [
            _neighbour_id_and_against(lane, side, lanes) for side in _left_and_right_values(lane, "adjacent_lane")
        ]
        yield BoundedLane(
            str(name), lane.left[:, :2], lane.right[:, :2], kind, kind in kinds.DRIVABLE_LANE_KINDS,
            bidirectional=kind in kinds.DRIVABLE_LANE_KINDS and lane.message.move_direction == kinds.BOTH_WAYS,
            junction_id=next((f"j{i}" for i in lane.physical_lane_ids if i in areas), None),
            successors=tuple(str(b) for a, b in linked if a == name),
            left_id=beside[0][0], left_against=beside[0][1], right_id=beside[1][0], right_against=beside[1][1],
            marks=tuple(_markings_of_sides(lane, bounds, types, log_has_markings=log_has_markings)),
            limits=tuple(_speed_limit_spans(lane)), limit_source="lane",
        )  # fmt: skip


def _logical_lane(message: Any, bounds: Mapping[int, Any]) -> LogicalLane:
    """Return a lane in the direction of travel. Errors: `UnbuildableError` with the missing or invalid part."""
    is_drivable = kinds.LANE_KINDS.get(message.type) in kinds.DRIVABLE_LANE_KINDS
    way = message.move_direction
    if is_drivable and way not in {kinds.INCREASING, kinds.DECREASING, kinds.BOTH_WAYS}:
        raise UnbuildableError("its move_direction does not state the direction of travel")
    left, right = (
        _side_points(message.left_boundary_id, bounds, "left"),
        _side_points(message.right_boundary_id, bounds, "right"),
    )
    begin, end = message.start_s, message.end_s
    low, high = max(left[0, 3], right[0, 3]), min(left[-1, 3], right[-1, 3])
    if not end > begin:
        raise UnbuildableError(f"it ends at {end:g} m of its reference line and begins at {begin:g} m")
    if low > begin + _LARGEST_MISSING_BOUNDARY_M or high < end - _LARGEST_MISSING_BOUNDARY_M:
        raise UnbuildableError(
            f"its boundaries extend from {low:g} to {high:g} m of its reference line, the lane from {begin:g} to {end:g} m"
        )
    begin, end = max(begin, low), min(end, high)
    if not end > begin:
        raise UnbuildableError(
            f"its left and right boundaries have no common part between {message.start_s:g} and {message.end_s:g} m of its reference line"
        )
    stations = np.concatenate([left[:, 3], right[:, 3]])
    at = np.unique(np.concatenate([[begin, end], stations[(stations > begin) & (stations < end)]]))
    first, second = (resampled(side[:, :3], side[:, 3], at) for side in (left, right))
    if way == kinds.DECREASING:
        return LogicalLane(message, second[::-1], first[::-1], (begin, end), -1)
    return LogicalLane(message, first, second, (begin, end), 1)


def _side_points(boundary_ids: Iterable[Any], bounds: Mapping[int, Any], side: str) -> Floats:
    """Return the points (n, 4) of one side: x, y, z and s, which ascends. Errors: `UnbuildableError` for an invalid boundary."""
    names = [i.value for i in boundary_ids]
    absent = [str(i) for i in names if i not in bounds]
    if not names or absent:
        raise UnbuildableError(
            f"the log lacks its {side} boundary {', '.join(absent)}" if absent else f"it has no {side} boundary"
        )
    parts = []
    for name in names:
        line = bounds[name].boundary_line
        rows = [(p.position.x, p.position.y, p.position.z, p.s_position) for p in line]
        points = np.array(rows, np.float64).reshape(-1, 4)
        if len(points) < 2 or not (np.abs(points) < LARGEST_COORDINATE_M).all():
            raise UnbuildableError(f"its {side} boundary {name} has fewer than two points with finite coordinates")
        parts.append(points)
    side_points = np.vstack(parts)
    if (np.diff(side_points[:, 3]) < -1e-3).any() or side_points[0, 3] >= side_points[-1, 3]:
        raise UnbuildableError(f"the s positions of its {side} boundary do not ascend")
    # at a lateral step of a boundary, two points have the same s
    side_points[:, 3] = np.maximum.accumulate(side_points[:, 3])
    side_points[1:, 3] += np.cumsum(np.diff(side_points[:, 3]) == 0) * 1e-9
    return side_points


def _left_and_right_values(lane: LogicalLane, field: str) -> tuple[Any, Any]:
    """Return the values of `left_<field>` and `right_<field>` in the message, swapped if needed to the driver's left and right."""
    values = getattr(lane.message, f"left_{field}"), getattr(lane.message, f"right_{field}")
    return values if lane.direction_sign > 0 else values[::-1]


def _lane_links(lanes: Mapping[int, LogicalLane]) -> list[tuple[int, int]]:
    """Return the pairs (a, b) in which b follows a. One of the two must state the link."""
    stated_links = {
        pair
        for name, lane in lanes.items()
        for field in ("predecessor_lane", "successor_lane")
        for connection in getattr(lane.message, field)
        for pair in ((name, connection.other_lane_id.value), (connection.other_lane_id.value, name))
    }
    return sorted(
        (a, b) for a, b in stated_links if a in lanes and b in lanes and a != b and _leads_into(lanes[a], lanes[b])
    )


def _leads_into(lane: LogicalLane, next_lane: LogicalLane) -> bool:
    """Return whether a lane ends at the start of `next_lane`, and not, as for opposing lanes, at its end."""
    end = lane.centre_line[-1, :2]
    to_begin, to_end = (float(np.linalg.norm(end - next_lane.centre_line[k, :2])) for k in (0, -1))
    return to_begin < MAX_LINK_GAP_M and to_begin <= to_end


def _neighbour_id_and_against(
    lane: LogicalLane, relations: Iterable[Any], lanes: Mapping[int, LogicalLane]
) -> tuple[str | None, bool | None]:
    """Return the id of the lane with the longest stretch beside `lane`, and whether it is driven in the opposite direction.

    Both are None without a neighbour.
    """
    begin, end = lane.station_span
    length = {
        r.other_lane_id.value: min(r.end_s, end) - max(r.start_s, begin)
        for r in relations
        if r.other_lane_id.value in lanes
    }
    if not length:
        return None, None
    longest = min(length, key=lambda name: (-length[name], name))
    neighbour = lanes[longest]
    if lane.message.reference_line_id.value == neighbour.message.reference_line_id.value:
        against = lane.direction_sign != neighbour.direction_sign
    else:
        ways = [side_lane.centre_line[-1, :2] - side_lane.centre_line[0, :2] for side_lane in (lane, neighbour)]
        against = float(np.dot(*ways)) < 0
    return str(longest), against or neighbour.message.move_direction == kinds.BOTH_WAYS


def _markings_of_sides(
    lane: LogicalLane, bounds: Mapping[int, Any], types: Mapping[int, int], *, log_has_markings: bool
) -> Iterator[Mark]:
    """Yield the markings of both sides.

    `types`: id of a physical boundary -> its type. `log_has_markings`: whether the log links boundaries to markings; then a boundary
    without a link has no marking, otherwise its marking is unknown.
    """
    sides = _left_and_right_values(lane, "boundary_id")
    for word, ids, nearest_first in (
        ("left", sides[0], lane.direction_sign > 0),
        ("right", sides[1], lane.direction_sign < 0),
    ):
        for i in ids:
            bound = bounds[i.value]
            stations = [p.s_position for p in bound.boundary_line]
            begin, end = sorted((lane.lane_fraction(min(stations)), lane.lane_fraction(max(stations))))
            if end <= begin:
                continue
            # OSI lists physical boundaries from right to left of the reference line
            physical = [types.get(p.value) for p in bound.physical_boundary_id]
            marking = (
                kinds.combined_marking(physical if nearest_first else physical[::-1])
                if physical or not log_has_markings
                else "none"
            )
            yield Mark(word, begin, end, marking, kinds.LANE_CHANGE_BY_PASSING_RULE.get(bound.passing_rule))


def _speed_limit_spans(lane: LogicalLane) -> Iterator[tuple[float, float, float]]:
    """Yield the speed limits for all vehicles, as (start, end, limit): shares of the lane's length, and m/s."""
    for rule in lane.message.traffic_rule:
        limit_value = rule.speed_limit.speed_limit_value
        unit = kinds.SPEED_UNITS_MPS.get(kinds.UNITS.get(limit_value.value_unit, ""))
        where = rule.traffic_rule_validity
        # the rule applies to all vehicles if it names no type, or only the type vehicle
        valid = where.valid_for_type
        for_all = not valid or any(validity.type == 2 and not validity.HasField("vehicle_type") for validity in valid)
        if rule.traffic_rule_type or unit is None or limit_value.value <= 0 or not for_all:
            continue
        begin, end = sorted((lane.lane_fraction(where.start_s), lane.lane_fraction(where.end_s)))
        if end > begin:
            yield begin, end, limit_value.value * unit
