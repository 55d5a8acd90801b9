"""Vector maps of Argoverse 2 (`log_map_archive_*.json`): lane segments by their two bounds, and pedestrian crossings.

A segment's bounds run in the direction of travel and have heights. Neighbours share a bound; which way a neighbour is driven, the file
does not say: its bounds do. Only the successors link lanes, as some releases leave the predecessors out. The map is cut 100 m from the
way of the vehicle, across lanes. It has no speed limit, no sign, no traffic light and no stop line. All six cities are in the United
States.

Source: Argoverse user guide ("HD Maps"); av2-api, `LaneSegment`, `LaneMarkType`, `PedestrianCrossing`, and `rendering/map.py`, which tells
that of a double line the nearer one is named first.
"""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import shapely

from drivelint.errors import MapError
from drivelint.formats.argoverse2.cities import frame_by_file_name
from drivelint.road.boundary_lanes import (
    BoundedLane,
    Mark,
    build_lanes,
    crossings,
    map_from_bounds,
    side_driven_on,
    stations,
)
from drivelint.road.driving_side import choose_side
from drivelint.road.quality import MapQuality

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.arrays import Floats
    from drivelint.road.map_reader import MapOptions, MapSource, MapTables

_KINDS: Final = {"VEHICLE": ("driving", True), "BUS": ("bus", True), "BIKE": ("biking", False)}
_LINES: Final = {
    "SOLID": "solid", "DASHED": "broken", "DOUBLE_SOLID": "solid_solid", "DOUBLE_DASH": "broken_broken",
    "SOLID_DASH": "solid_broken", "DASH_SOLID": "broken_solid",
}  # fmt: skip
_COLOURS: Final = {"WHITE": "white", "YELLOW": "yellow", "BLUE": "blue"}
_SIDES: Final = ("left", "right")
_COMMON_GROUND_M2: Final = 1.0
"""Lanes of which more lies over each other share the ground of a junction."""
_LEVEL_M: Final = 3.0
"""Lanes that are further apart in height are on two levels."""


class _Segment(NamedTuple):
    """A lane segment: what the file says, and its bounds (n, 3) in metres."""

    said: Mapping[str, Any]
    left: Floats
    right: Floats


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables; `MapError` where the file is no such map, or no lane of it can be built."""
    archive = _archive(source)
    quality = MapQuality()
    segments = _segments(archive["lane_segments"], quality)
    _report_words(segments.values(), quality)
    _report_cut(segments, quality)
    lanes = build_lanes((_lane(name, segments) for name in segments), request.offset, quality)
    if not lanes:
        first = next((row["message"] for row in quality.rows), "it has no lane segment")
        raise MapError(f"map {source.name} has no lane that can be built: {first}")
    for lane in lanes:
        segment = segments[lane.lanelet_id]
        sides = ((segment.left, lane.line.left), (segment.right, lane.line.right))
        lane.z = sum(_heights(bound, points - request.offset) for bound, points in sides) / 2
    _name_junctions(lanes, segments)
    side = choose_side([("option", request.side), ("lanes", side_driven_on(lanes)), ("attribute", "rht")], quality)
    walks = _walks(archive.get("pedestrian_crossings", {}), quality)
    furniture = {"traffic_signal": [], "stop_line": [], "crossing": crossings(walks, lanes, request.offset, quality)}
    geo = frame_by_file_name(source.name)
    return map_from_bounds(source, request, lanes, furniture, quality, kind="argoverse2", side=side, geo=geo)


def _archive(source: MapSource) -> dict[str, Any]:
    try:
        archive = json.loads(source.content)
    except (ValueError, RecursionError) as error:
        raise MapError(f"map {source.name} is not readable as JSON ({error}): get it again") from error
    parts = [archive.get(name, {}) for name in ("lane_segments", "pedestrian_crossings")]
    if "lane_segments" not in archive or not all(isinstance(part, dict) for part in parts):
        raise MapError(
            f"map {source.name} is JSON, but no map of Argoverse 2 (lane_segments by their ids): give an OpenDRIVE file"
        )
    return dict(archive)


def _segments(said: Mapping[str, Any], quality: MapQuality) -> dict[str, _Segment]:
    """Return the lane segments by their ids; those that cannot be understood are reported."""
    found: dict[str, _Segment] = {}
    for key, segment in said.items():
        try:
            bounds = [_points(segment[f"{side}_lane_boundary"]) for side in _SIDES]
            name = str(int(segment["id"]))
            if name in found:
                raise ValueError("another one has its id")
            found[name] = _Segment(segment, *bounds)
            _lane(name, found)
        except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
            found.pop(key, None)
            what = f"no {error}" if isinstance(error, KeyError) else str(error)
            quality.add("invalid_lane", "error", key, f"lane segment {key} is left out: {what}")
    return found


def _points(line: Any) -> Floats:
    """Return the points (n, 3) of a line; a height that is not given is NaN."""
    rows = [(point["x"], point["y"], point.get("z", np.nan)) for point in line]
    return np.array(rows, np.float64).reshape(-1, 3)


def _lane(name: str, segments: Mapping[str, _Segment]) -> BoundedLane:
    segment = segments[name]
    said = segment.said
    kind, drivable = _KINDS.get(said["lane_type"], ("none", False))
    lane = BoundedLane(
        name, segment.left[:, :2], segment.right[:, :2], kind, drivable,
        successors=tuple(to for to in map(_name, said["successors"]) if to in segments),
        marks=tuple(Mark(side, 0.0, 1.0, *_marking(said[f"{side}_lane_mark_type"])) for side in _SIDES),
    )  # fmt: skip
    lane.left_id, lane.left_against = _neighbour(segment, "left", segments)
    lane.right_id, lane.right_against = _neighbour(segment, "right", segments)
    return lane


def _name(number: Any) -> str | None:
    return None if number is None else str(int(number))


def _marking(word: str) -> tuple[str | None, None, str | None]:
    """Return marking, lane change (never known) and colour of a mark type."""
    line, _, colour = word.rpartition("_")
    if word == "NONE":
        return "none", None, None
    return _LINES.get(line), None, _COLOURS.get(colour)


def _neighbour(segment: _Segment, side: str, segments: Mapping[str, _Segment]) -> tuple[str | None, bool | None]:
    """Return the lane on one side, and whether it is driven the other way: then the two have the bound of the same side in common."""
    name = _name(segment.said[f"{side}_neighbor_id"])
    if name is None or name not in segments:
        return None, None
    other = segments[name]
    own, same, facing = (segment.left, other.right, other.left) if side == "left" else (segment.right, other.left, other.right)
    ends = own[[0, -1], :2]
    apart = [float(np.hypot(*(ends - line[[k, -1 - k], :2]).T).sum()) for line, k in ((same, 0), (facing, -1))]
    return name, apart[1] < apart[0]


def _report_words(segments: Iterable[_Segment], quality: MapQuality) -> None:
    """Name the types of lanes and markings that are not read."""
    types, marks = Counter[str](), Counter[str]()
    for segment in segments:
        types[segment.said["lane_type"]] += 1
        marks.update(segment.said[f"{side}_lane_mark_type"] for side in _SIDES)
    unread = {word: n for word, n in types.items() if word not in _KINDS}
    unread |= {word: n for word, n in marks.items() if word != "UNKNOWN" and _marking(word)[0] is None}
    if unread:
        listed = ", ".join(f"{word} ({n})" for word, n in sorted(unread.items()))
        message = f"types of lanes and markings that are not read: {listed}"
        quality.add("unknown_word", "info", None, message, sum(unread.values()))


def _report_cut(segments: Mapping[str, _Segment], quality: MapQuality) -> None:
    """Say of how many lanes the map does not have what follows or lies beside: it is cut out of a larger one."""
    said = [segment.said for segment in segments.values()]
    lost = {
        "lanes that follow": sum(_name(to) not in segments for each in said for to in each["successors"]),
        "lanes beside": sum(
            each[f"{side}_neighbor_id"] is not None and _name(each[f"{side}_neighbor_id"]) not in segments
            for each in said
            for side in _SIDES
        ),
    }
    n = sum(lost.values())
    if n:
        counts = " and ".join(f"{count} {what}" for what, count in lost.items() if count)
        message = f"the map is cut out of a larger one: it names {counts} others, which it does not have"
        quality.add("missing_link", "info", None, message, n)


def _heights(bound: Floats, points: Floats) -> Floats:
    """Return the heights of a bound (n, 3) at points on it (m, 2)."""
    along = shapely.line_locate_point(shapely.LineString(bound[:, :2]), shapely.points(points))
    return np.asarray(np.interp(along, stations(bound), bound[:, 2]), np.float64)


def _name_junctions(lanes: Sequence[BoundedLane], segments: Mapping[str, _Segment]) -> None:
    """Give the lanes inside intersections the junction that they are part of.

    Those are of one junction that begin or end at the same lane, follow each other, lie side by side, or over the same ground.
    """
    inside = {lane.lanelet_id: lane for lane in lanes if segments[lane.lanelet_id].said["is_intersection"]}
    parent = {name: name for name in inside}

    def root(name: str) -> str:
        while parent[name] != name:
            name = parent[name]
        return name

    for group in (*_links(lanes, inside), *_overlaps(list(inside.values()))):
        names = sorted({root(name) for name in group}, key=int)
        parent.update(dict.fromkeys(names[1:], names[0]))
    for name, lane in inside.items():
        lane.junction_id = f"j{root(name)}"


def _links(lanes: Sequence[BoundedLane], inside: Mapping[str, BoundedLane]) -> list[list[str]]:
    """Return groups of lanes inside intersections that are linked: by a lane before, by a lane behind, or side by side."""
    groups = [[to for to in (lane.lanelet_id, *lane.successors) if to in inside] for lane in lanes]
    before: dict[str, list[str]] = defaultdict(list)
    for lane in inside.values():
        groups.append([n for n in (lane.lanelet_id, lane.left_id, lane.right_id) if n is not None and n in inside])
        for to in lane.successors:
            before[to].append(lane.lanelet_id)
    return [group for group in (*groups, *before.values()) if len(group) > 1]


def _overlaps(lanes: Sequence[BoundedLane]) -> list[list[str]]:
    """Return pairs of lanes that lie over the same ground, on one level."""
    areas = [lane.line.polygon for lane in lanes]
    pairs = shapely.STRtree(areas).query(areas, predicate="intersects").T
    found = []
    for i, j in pairs[pairs[:, 0] < pairs[:, 1]].tolist():
        a, b = lanes[i], lanes[j]
        apart = max(np.nanmin(a.z) - np.nanmax(b.z), np.nanmin(b.z) - np.nanmax(a.z)) if _have_heights(a, b) else 0.0
        if apart <= _LEVEL_M and shapely.area(shapely.intersection(areas[i], areas[j])) > _COMMON_GROUND_M2:
            found.append([a.lanelet_id, b.lanelet_id])
    return found


def _have_heights(*lanes: BoundedLane) -> bool:
    return all(np.isfinite(lane.z).any() for lane in lanes)


def _walks(said: Mapping[str, Any], quality: MapQuality) -> list[BoundedLane]:
    """Return the pedestrian crossings, the two edges as the bounds of a lane for people on foot."""
    found = []
    for key, crossing in said.items():
        try:
            first, second = (_points(crossing[edge])[:, :2] for edge in ("edge1", "edge2"))
            name = str(int(crossing["id"]))
        except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
            message = f"crossing {key} is left out: {error!r}"
            quality.add("invalid_lane", "error", key, message)
            continue
        if len(first) and len(second) and float((first[-1] - first[0]) @ (second[-1] - second[0])) < 0.0:
            second = second[::-1]
        found.append(BoundedLane(name, first, second, "crosswalk", drivable=False))
    return found
