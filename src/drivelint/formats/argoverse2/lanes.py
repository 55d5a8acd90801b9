"""Vector maps of Argoverse 2 (`log_map_archive_*.json`): lane segments by their two bounds, and pedestrian crossings.

A segment's bounds run in the direction of travel and have heights. Neighbours share a bound. The file does not state the direction of a
neighbour: it follows from the neighbour's bounds. Lanes are linked by their successors only, as some releases leave out the predecessors.
The map is cut off, across lanes, 100 m from the vehicle's path. It has no speed limits, signs, traffic lights or stop lines. All six
cities are in the United States.

Source: Argoverse user guide ("HD Maps"); av2-api, `LaneSegment`, `LaneMarkType`, `PedestrianCrossing`. The name of a double line begins
with the line nearer to the lane (`rendering/map.py`).
"""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import shapely

from drivelint.errors import MapError
from drivelint.formats.argoverse2.cities import NATION, frame_by_file_name
from drivelint.road.boundary_lanes import (
    BoundedLane,
    Mark,
    build_lanes,
    crossings,
    map_from_bounds,
    side_driven_on,
)
from drivelint.road.driving_side import choose_side
from drivelint.road.lane_geometry import stations
from drivelint.road.quality import MapQuality
from drivelint.road.tree_parts import query_in_parts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.arrays import Floats
    from drivelint.road.map_reader import MapOptions, MapSource, MapTables

_LANE_TYPE_AND_DRIVABLE: Final = {"VEHICLE": ("driving", True), "BUS": ("bus", True), "BIKE": ("biking", False)}
_MARKING_BY_LINE: Final = {
    "SOLID": "solid", "DASHED": "broken", "DOUBLE_SOLID": "solid_solid", "DOUBLE_DASH": "broken_broken",
    "SOLID_DASH": "solid_broken", "DASH_SOLID": "broken_solid",
}  # fmt: skip
_COLOURS: Final = {"WHITE": "white", "YELLOW": "yellow", "BLUE": "blue"}
_SIDES: Final = ("left", "right")
_PARSE_ERRORS: Final = (KeyError, TypeError, ValueError, AttributeError, OverflowError)
"""The errors that reading an invalid part of the file raises."""
_MIN_LANE_OVERLAP_IN_JUNCTION_M2: Final = 1.0
"""Lanes inside intersections that overlap by more than this area are in one junction."""
_MAX_HEIGHT_DIFFERENCE_WITHIN_LEVEL_M: Final = 3.0
"""Lanes whose heights differ by more are on different levels."""


class _LaneSegment(NamedTuple):
    """A lane segment: its bounds (n, 3) in metres, its other values as in the file, and other lanes by their ids."""

    left: Floats
    right: Floats
    lane_type: str
    is_intersection: bool
    successors: tuple[str, ...]
    left_id: str | None
    right_id: str | None
    left_mark: str
    right_mark: str


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables. Errors: `MapError` if the file is not a map of Argoverse 2, or no lane can be built."""
    archive = _map_json(source)
    quality = MapQuality()
    segments = _lane_segments(archive["lane_segments"], quality)
    _report_unread_types(segments.values(), quality)
    _report_missing_lanes(segments, quality)
    lanes = build_lanes((_bounded_lane(name, segments) for name in segments), request.offset, quality)
    if not lanes:
        first = next((row["message"] for row in quality.rows), "it has no lane segment")
        raise MapError(f"map {source.name} has no lane that can be built: {first}")
    for lane in lanes:
        segment, line = segments[lane.lanelet_id], lane.line
        left, right = (
            _heights_at(segment.left, line.left - request.offset),
            _heights_at(segment.right, line.right - request.offset),
        )
        lane.z = (left + right) / 2
    _set_junctions(lanes, segments)
    side = choose_side([("option", request.side), ("lanes", side_driven_on(lanes)), ("attribute", "rht")], quality)
    walks = _crossings_as_lanes(archive.get("pedestrian_crossings", {}), quality)
    furniture = {"traffic_signal": [], "stop_line": [], "crossing": crossings(walks, lanes, request.offset, quality)}
    geo = frame_by_file_name(source.name)
    return map_from_bounds(
        source,
        request,
        lanes,
        furniture,
        quality,
        map_format="argoverse2",
        side_and_source=side,
        geo=geo,
        nation=NATION,
    )


def _map_json(source: MapSource) -> dict[str, Any]:
    try:
        archive = json.loads(source.content)
    except (ValueError, RecursionError) as error:
        raise MapError(f"map {source.name} is not readable as JSON ({error}): get it again") from error
    parts = [archive.get(name, {}) for name in ("lane_segments", "pedestrian_crossings")]
    if "lane_segments" not in archive or not all(isinstance(part, dict) for part in parts):
        raise MapError(
            f"map {source.name} is JSON, but not a map of Argoverse 2 (lane_segments by their ids): give an OpenDRIVE file"
        )
    return dict(archive)


def _lane_segments(records: Mapping[str, Any], quality: MapQuality) -> dict[str, _LaneSegment]:
    """Return the lane segments by their ids; segments that cannot be read are reported."""
    segments: dict[str, _LaneSegment] = {}
    for key, segment in records.items():
        try:
            name = _id_text(segment["id"])
            if name in segments:
                raise ValueError("another segment has the same id")
            segments[name] = _lane_segment(segment)
        except _PARSE_ERRORS as error:
            quality.add("invalid_lane", "error", key, f"lane segment {key} is left out: {_error_text(error)}")
    return segments


def _error_text(error: Exception) -> str:
    return f"it has no {error}" if isinstance(error, KeyError) else str(error)


def _lane_segment(record: Mapping[str, Any]) -> _LaneSegment:
    """Return a segment. Errors: those of `_PARSE_ERRORS`."""
    left, right = (None if (number := record[f"{side}_neighbor_id"]) is None else _id_text(number) for side in _SIDES)
    return _LaneSegment(
        left=_line_points(record["left_lane_boundary"]),
        right=_line_points(record["right_lane_boundary"]),
        lane_type=str(record["lane_type"]),
        is_intersection=bool(record["is_intersection"]),
        successors=tuple(map(_id_text, record["successors"])),
        left_id=left,
        right_id=right,
        left_mark=str(record["left_lane_mark_type"]),
        right_mark=str(record["right_lane_mark_type"]),
    )


def _id_text(number: Any) -> str:
    return str(int(number))


def _line_points(line: Any) -> Floats:
    """Return the points (n, 3) of a line; a height that is not given is NaN. Errors: those of `_PARSE_ERRORS`."""
    rows = [(point["x"], point["y"], point.get("z", np.nan)) for point in line]
    if len(rows) < 2:
        raise ValueError("a line has fewer than two points")
    return np.array(rows, np.float64).reshape(-1, 3)


def _bounded_lane(segment_id: str, segments: Mapping[str, _LaneSegment]) -> BoundedLane:
    segment = segments[segment_id]
    kind, drivable = _LANE_TYPE_AND_DRIVABLE.get(segment.lane_type, ("none", False))
    lane = BoundedLane(
        segment_id, segment.left[:, :2], segment.right[:, :2], kind, drivable,
        successors=tuple(to for to in segment.successors if to in segments),
        marks=(_mark("left", segment.left_mark), _mark("right", segment.right_mark)),
    )  # fmt: skip
    if neighbour := segments.get(segment.left_id or ""):
        lane.left_id, lane.left_against = segment.left_id, _runs_against(segment.left, neighbour.right, neighbour.left)
    if neighbour := segments.get(segment.right_id or ""):
        lane.right_id, lane.right_against = (
            segment.right_id,
            _runs_against(segment.right, neighbour.left, neighbour.right),
        )
    return lane


def _runs_against(bound: Floats, bound_if_same_way: Floats, bound_if_opposite: Floats) -> bool:
    """Return whether a neighbour is driven the other way: the ends of `bound` are nearer to those of `bound_if_opposite`."""
    ends = bound[[0, -1], :2]
    to_with, to_against = (
        float(np.hypot(*(ends - line).T).sum())
        for line in (bound_if_same_way[[0, -1], :2], bound_if_opposite[[-1, 0], :2])
    )
    return to_against < to_with


def _mark(side: str, mark_type: str) -> Mark:
    line, _, colour = mark_type.rpartition("_")
    return Mark(
        side, 0.0, 1.0, "none" if mark_type == "NONE" else _MARKING_BY_LINE.get(line), color=_COLOURS.get(colour)
    )


def _report_unread_types(segments: Iterable[_LaneSegment], quality: MapQuality) -> None:
    """Report the types of lanes and markings that are not read."""
    words = Counter[str]()
    for segment in segments:
        words.update([segment.lane_type] if segment.lane_type not in _LANE_TYPE_AND_DRIVABLE else [])
        marks = (segment.left_mark, segment.right_mark)
        words.update(word for word in marks if word != "UNKNOWN" and _mark("", word).marking is None)
    if words:
        listed = ", ".join(f"{word} ({n})" for word, n in sorted(words.items()))
        message = f"types of lanes and markings that are not read: {listed}"
        quality.add("unknown_word", "info", None, message, words.total())


def _report_missing_lanes(segments: Mapping[str, _LaneSegment], quality: MapQuality) -> None:
    """Report how many successors and neighbours of lanes are missing because the map is cut out of a larger one."""
    behind = sum(to not in segments for segment in segments.values() for to in segment.successors)
    beside = sum(
        name is not None and name not in segments
        for segment in segments.values()
        for name in (segment.left_id, segment.right_id)
    )
    if behind or beside:
        message = f"the map is a part of a larger one: it lacks {behind} lanes that follow its lanes and {beside} lanes beside them"
        quality.add("missing_link", "info", None, message, behind + beside)


def _heights_at(bound: Floats, points: Floats) -> Floats:
    """Return the heights of a bound (n, 3) at points on it (m, 2)."""
    along = shapely.line_locate_point(shapely.LineString(bound[:, :2]), shapely.points(points))
    return np.asarray(np.interp(along, stations(bound), bound[:, 2]), np.float64)


def _set_junctions(lanes: Sequence[BoundedLane], segments: Mapping[str, _LaneSegment]) -> None:
    """Set the junction of each lane inside an intersection.

    Lanes are in one junction if they begin or end at the same lane, follow each other, lie side by side, or overlap.
    """
    inside = {lane.lanelet_id: lane for lane in lanes if segments[lane.lanelet_id].is_intersection}
    parent = {name: name for name in inside}

    def root_of_junction(lane_id: str) -> str:
        while parent[lane_id] != lane_id:
            lane_id = parent[lane_id]
        return lane_id

    for group in (*_connected_lane_groups(lanes, inside), *_overlapping_lane_pairs(list(inside.values()))):
        names = sorted({root_of_junction(name) for name in group}, key=int)
        parent.update(dict.fromkeys(names[1:], names[0]))
    for name, lane in inside.items():
        lane.junction_id = f"j{root_of_junction(name)}"


def _connected_lane_groups(lanes: Sequence[BoundedLane], inside: Mapping[str, BoundedLane]) -> list[list[str]]:
    """Return groups of lanes inside intersections that share a predecessor or a successor, follow each other, or lie side by side."""
    groups = [[to for to in (lane.lanelet_id, *lane.successors) if to in inside] for lane in lanes]
    before: dict[str, list[str]] = defaultdict(list)
    for lane in inside.values():
        groups.append([n for n in (lane.lanelet_id, lane.left_id, lane.right_id) if n is not None and n in inside])
        for to in lane.successors:
            before[to].append(lane.lanelet_id)
    return [group for group in (*groups, *before.values()) if len(group) > 1]


def _overlapping_lane_pairs(lanes: Sequence[BoundedLane]) -> list[list[str]]:
    """Return pairs of lanes that overlap on the same level."""
    if not lanes:
        return []
    areas = [lane.line.polygon for lane in lanes]
    parts = query_in_parts(shapely.STRtree(areas), areas, "intersects")
    overlaps = []
    for i, j in (pair for first, second in parts for pair in zip(first.tolist(), second.tolist(), strict=True)):
        if i >= j:
            continue
        a, b = lanes[i], lanes[j]
        apart = max(np.nanmin(a.z) - np.nanmax(b.z), np.nanmin(b.z) - np.nanmax(a.z)) if _have_heights(a, b) else 0.0
        if (
            apart <= _MAX_HEIGHT_DIFFERENCE_WITHIN_LEVEL_M
            and shapely.area(shapely.intersection(areas[i], areas[j])) > _MIN_LANE_OVERLAP_IN_JUNCTION_M2
        ):
            overlaps.append([a.lanelet_id, b.lanelet_id])
    return overlaps


def _have_heights(*lanes: BoundedLane) -> bool:
    return all(np.isfinite(lane.z).any() for lane in lanes)


def _crossings_as_lanes(records: Mapping[str, Any], quality: MapQuality) -> list[BoundedLane]:
    """Return the pedestrian crossings as lanes for people on foot, bounded by the two edges."""
    crossings = []
    for key, crossing in records.items():
        try:
            first, second = (_line_points(crossing[edge])[:, :2] for edge in ("edge1", "edge2"))
            name = _id_text(crossing["id"])
        except _PARSE_ERRORS as error:
            quality.add("invalid_lane", "error", key, f"crossing {key} is left out: {_error_text(error)}")
            continue
        if float((first[-1] - first[0]) @ (second[-1] - second[0])) < 0.0:
            second = second[::-1]
        crossings.append(BoundedLane(name, first, second, "crosswalk", drivable=False))
    return crossings
