"""SUMO networks (`.net.xml`): the lanes, connections through junctions, limits, lights and priorities that SUMO simulates.

Edges have lanes with a centre line and a width; the lane with index 0 is next to the edge of the road. Edges whose id begins with a colon
lie inside a junction. A net contains no markings, kerbs or kinds of crossings: they are not known. Source: SUMO's documentation of "SUMO
Road Networks", "VClasses" and "Plain XML".
"""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.errors import MapError
from drivelint.formats import safe_xml
from drivelint.formats.sumo.location import NO_PROJECTION, location_of
from drivelint.formats.sumo.opendrive_import import opendrive_import
from drivelint.formats.sumo.right_of_way import signal_and_stop_line_rows
from drivelint.road.boundary_lanes import (
    BoundedLane,
    SpeedLimitSpan,
    build_lanes,
    crossings,
    map_from_bounds,
)
from drivelint.road.driving_side import choose_side
from drivelint.road.lane_geometry import LARGEST_COORDINATE_M
from drivelint.road.quality import MapQuality

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from lxml import etree

    from drivelint.arrays import Floats
    from drivelint.formats.sumo.opendrive_import import OpenDriveImport
    from drivelint.road.geo_reference import GeoFrame
    from drivelint.road.map_reader import MapOptions, MapSource, MapTables


DEFAULT_LANE_WIDTH_M: Final = 3.2  # SUMO's default, for a lane without a width
_LARGEST_MITRE_FACTOR: Final = 3.0
"""At a sharp bend, the corner of a lane's bound is at most this multiple of its distance from the centre line away."""
_ADDED_POINT_DISTANCE_M: Final = 0.5
"""The distance of an added point from the end of a line inside a junction."""
_LEAST_BEND_COSINE: Final = 0.85
"""A point is added only if the cosine of the angle between the line and the joined lane is at least this."""
_CAR: Final = "passenger"
_OTHER_CLASSES_OF_DRIVING_LANES: Final = frozenset({"private", "truck", "delivery", "evehicle", "trailer"})
_CLASSES_BY_LANE_KIND: Final = (
    # the type of a lane without cars or lorries is the first of these with a class that may drive on it
    ("bus", {"bus", "coach"}),
    ("taxi", {"taxi"}),
    ("HOV", {"hov"}),
    ("driving", {"motorcycle"}),
    ("tram", {"tram", "cable_car"}),
    ("rail", {"rail", "rail_urban", "rail_electric", "rail_fast", "subway"}),
    ("biking", {"bicycle", "moped", "scooter"}),
    ("sidewalk", {"pedestrian", "wheelchair"}),
    ("restricted", {"emergency", "authority", "army", "vip", "custom1", "custom2", "container"}),
)
_ALL_CLASSES: Final = frozenset({_CAR}).union(
    _OTHER_CLASSES_OF_DRIVING_LANES, *(classes for _, classes in _CLASSES_BY_LANE_KIND)
)
_DRIVABLE_KINDS: Final = frozenset({"driving", "bus", "taxi", "HOV", "entry"})
_ROAD_TYPE_BY_EDGE_TYPE: Final = {
    "motorway": "motorway",
    "motorway_link": "motorway",
    "residential": "town",
    "living_street": "town",
    "pedestrian": "pedestrian",
}


@dataclass
class _Net:
    """The lanes of a file by id, and the ids of each edge's lanes in order of index."""

    lanes: dict[str, BoundedLane] = field(default_factory=dict)
    edges: dict[str, list[str]] = field(default_factory=dict)
    internal_edges: set[str] = field(default_factory=set)  # edges
    crossings: list[BoundedLane] = field(default_factory=list)


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables. Errors: `MapError` if the file is not XML, or no lane can be built."""
    root = safe_xml.parse_map(source)
    quality = MapQuality()
    left_hand = root.get("lefthand") in {"true", "1"}
    imported = opendrive_import(source.content, root, quality)
    net = _read_net(root, imported, left_hand=left_hand, quality=quality)
    _connect_lanes(root, net)
    lanes = build_lanes(net.lanes.values(), request.offset, quality)
    if not lanes:
        first = next((row["message"] for row in quality.rows), "it has no <lane>")
        raise MapError(f"map {source.name} has no lane that can be built: {first}")
    side = _handedness_and_source(request, "lht" if left_hand else None if imported else "rht", quality)
    signals, stop_lines = signal_and_stop_line_rows(root, {lane.lanelet_id: lane for lane in lanes})
    furniture = {
        "traffic_signal": signals,
        "stop_line": stop_lines,
        "crossing": crossings(net.crossings, lanes, request.offset, quality),
    }
    geo = _geo_frame(root, quality)
    tables = map_from_bounds(
        source, request, lanes, furniture, quality, map_format="sumo", side_and_source=side, geo=geo
    )
    # the net states the direction of its lanes, whichever side is driven on: traffic against them is detected
    return replace(tables, lanes_source="attribute") if imported else tables


def _geo_frame(root: etree._Element, quality: MapQuality) -> GeoFrame | None:
    """Return the geodetic frame of the net's coordinates, which are those of a projection plus `netOffset`.

    None: the net has no projection (`!`), or its offset cannot be read.
    """
    location = location_of(root.find("location"))
    if location.reference != NO_PROJECTION and location.offset is None:
        quality.add_unusable_geo_reference(location.reference, f"its netOffset is {location.offset_text!r}")
    return location.geo_frame()


def _handedness_and_source(request: MapOptions, net_side: str | None, quality: MapQuality) -> tuple[str, str]:
    """Return the side that is driven on, and its source. `net_side`: the side that the net states; None: its import lost the side."""
    if net_side is not None and request.side not in {None, net_side}:
        message = f"the option --handedness: {request.side}; the net: {net_side}; the option is used"
        quality.add("handedness_disagrees", "warning", None, message)
    return choose_side(
        [("option", request.side), ("attribute", None if request.side else net_side)], quality, "the net"
    )


def _read_net(root: etree._Element, imported: OpenDriveImport | None, *, left_hand: bool, quality: MapQuality) -> _Net:
    net = _Net()
    for edge in root.iterfind("edge"):
        name, function = edge.get("id", ""), edge.get("function", "normal")
        if function in {"walkingarea", "connector"}:
            continue
        lanes_by_index = []
        for element in edge.iterfind("lane"):
            try:
                lanes_by_index.append((int(element.attrib["index"]), _bounded_lane(edge, element, imported, quality)))
            except (ValueError, KeyError) as error:
                lane = element.get("id") or f"in line {element.sourceline}"
                quality.add("invalid_lane", "error", lane, f"lane {lane} is left out: {error}")
        lanes = [lane for _, lane in sorted(lanes_by_index, key=lambda item: item[0])]
        if function == "crossing":
            net.crossings += lanes
            continue
        net.edges[name] = [lane.lanelet_id for lane in lanes]
        net.lanes |= {lane.lanelet_id: lane for lane in lanes}
        if function == "internal":
            net.internal_edges.add(name)
        for outer, inner in pairwise(lanes):
            _set_neighbour(outer, inner.lanelet_id, inward=True, left_hand=left_hand, against=False)
            _set_neighbour(inner, outer.lanelet_id, inward=False, left_hand=left_hand, against=False)
        for element in edge.iterfind("lane"):
            opposite, lane_id = element.find("neigh"), element.get("id", "")
            if opposite is not None and lane_id in net.lanes:
                _set_neighbour(
                    net.lanes[lane_id], opposite.get("lane", ""), inward=True, left_hand=left_hand, against=True
                )
    return net


def _set_neighbour(lane: BoundedLane, neighbour_id: str, *, inward: bool, left_hand: bool, against: bool) -> None:
    """Set the neighbour of a lane, towards the middle of the road (`inward`) or away from it."""
    if inward != left_hand:
        lane.left_id, lane.left_against = neighbour_id, against
    else:
        lane.right_id, lane.right_against = neighbour_id, against


def _bounded_lane(
    edge: etree._Element, element: etree._Element, imported: OpenDriveImport | None, quality: MapQuality
) -> BoundedLane:
    """Return a lane. Errors: `KeyError` or `ValueError` if it is invalid."""
    middle = _shape_points(str(element.attrib["shape"]))
    half = float(element.get("width") or DEFAULT_LANE_WIDTH_M) / 2
    limit = float(element.attrib["speed"])
    if not 0 < half < math.inf or not 0 <= limit < math.inf:
        raise ValueError(f"its width of {2 * half:g} m or speed of {limit:g} m/s is not possible")
    kind, is_access_unread = _lane_kind_and_is_access_unread(element.get("allow"), element.get("disallow"))
    if is_access_unread:
        access_text = " ".join(
            f'{name}="{element.get(name)}"' for name in ("allow", "disallow") if element.get(name) is not None
        )
        quality.add(
            "access_unread",
            "warning",
            element.get("id"),
            f"cars may not use it ({access_text}), which no lane type shows",
        )
    if kind == "driving" and element.get("acceleration") in {"true", "1"}:
        kind = "entry"
    inside = edge.get("function") == "internal"
    # inside a junction the speed is what the bend allows, not a limit
    is_default = imported is not None and imported.has_default_limit(element, edge, limit)
    posted = None if inside or is_default else quality.limit_unless_placeholder(limit)
    return BoundedLane(
        str(element.attrib["id"]), left=_parallel_line(middle, half), right=_parallel_line(middle, -half),
        kind=kind, drivable=kind in _DRIVABLE_KINDS,
        road_type=_ROAD_TYPE_BY_EDGE_TYPE.get((edge.get("type") or "").removeprefix("highway.")),
        junction_id=edge.get("id", "").removeprefix(":").rpartition("_")[0] if inside else None,
        limits=() if posted is None else ((0.0, 1.0, posted),),
    )  # fmt: skip


def _lane_kind_and_is_access_unread(allow: str | None, disallow: str | None) -> tuple[str, bool]:
    """Return the type of a lane, and whether cars may not use it although it has the type of a lane for them."""
    if allow is not None:
        may = _ALL_CLASSES if allow == "all" else frozenset(allow.split())
    else:
        may = _ALL_CLASSES - (_ALL_CLASSES if disallow == "all" else frozenset((disallow or "").split()))
    if _CAR in may or may & _OTHER_CLASSES_OF_DRIVING_LANES:
        return "driving", _CAR not in may
    kind = next((kind for kind, classes in _CLASSES_BY_LANE_KIND if classes & may), "none")
    return kind, kind == "driving"


def _shape_points(shape: str) -> Floats:
    """Return the points (n, 2) of a shape, without heights and repeated points. Errors: `ValueError` for an invalid shape."""
    points = np.array([[float(v) for v in point.split(",")[:2]] for point in shape.split()], np.float64)
    if points.shape[1:] != (2,) or not (np.abs(points) < LARGEST_COORDINATE_M).all():
        raise ValueError("its shape is not a list of points x,y")
    points = points[np.r_[True, np.hypot(*np.diff(points, axis=0).T) > 1e-3]]
    if len(points) < 2:
        raise ValueError("its shape has no length")
    return points


def _parallel_line(line: Floats, offset_m: float) -> Floats:
    """Return the line beside another at the distance `offset_m` (positive: left), with the same number of points."""
    step = np.diff(line, axis=0)
    unit = step / np.hypot(*step.T)[:, None]
    normal = np.column_stack([-unit[:, 1], unit[:, 0]])
    before, after = np.vstack([normal[:1], normal]), np.vstack([normal, normal[-1:]])
    between = before + after
    # mitre: at a corner the point keeps the distance from both segments
    size = np.maximum((between * before).sum(1), 2 / _LARGEST_MITRE_FACTOR**2)
    parallel: Floats = line + offset_m * between / size[:, None]
    return parallel


def _connect_lanes(root: etree._Element, net: _Net) -> None:
    """Set the successors of the lanes, and the limits of lanes inside junctions to those of the lanes that they continue."""
    follows: dict[str, list[str]] = defaultdict(list)
    for link in root.iterfind("connection"):
        source = _lane_id(net, link.get("from", ""), link.get("fromLane", ""))
        target = link.get("via") or _lane_id(net, link.get("to", ""), link.get("toLane", ""))
        if source in net.lanes and target in net.lanes:
            follows[source].append(target)
    for name, targets in follows.items():
        net.lanes[name].successors = tuple(dict.fromkeys(targets))
    _bend_internal_lanes(net)
    inside = [lane for edge in net.edges if edge in net.internal_edges for lane in net.edges[edge]]
    for _ in range(2):  # a connection has two internal lanes where vehicles wait inside the junction
        _continue_speed_limits_into_junctions(net.lanes, follows, inside)


def _bend_internal_lanes(net: _Net) -> None:
    """Make lanes inside junctions begin and end in the direction of the lanes that they join.

    Their shapes are chords of a bend: without this, two lanes that meet at an angle leave a wedge that belongs to neither.
    """
    inside = {lane for edge in net.internal_edges for lane in net.edges[edge]}
    before: dict[str, list[str]] = defaultdict(list)
    for name, lane in net.lanes.items():
        for to in lane.successors:
            before[to].append(name)
    for name in sorted(inside):
        lane = net.lanes[name]
        middle, half = (lane.left + lane.right) / 2, float(np.hypot(*(lane.left - lane.right)[0])) / 2
        for end, outer_lanes in ((0, before[name]), (-1, [to for to in lane.successors if to not in inside])):
            if len(outer_lanes) == 1:
                middle = _bent_centre_line(middle, net.lanes[outer_lanes[0]], end)
        lane.left, lane.right = _parallel_line(middle, half), _parallel_line(middle, -half)


def _bent_centre_line(centre_line: Floats, joined_lane: BoundedLane, end: int) -> Floats:
    """Return a centre line with one more point, so that it begins (`end` 0) or ends (-1) in the direction of `joined_lane`.

    The line is unchanged if it is short, or its direction differs too much.
    """
    line = (joined_lane.left + joined_lane.right) / 2
    step = line[-1] - line[-2] if end == 0 else line[0] - line[1]
    step = step / np.hypot(*step)
    step_inwards = centre_line[1] - centre_line[0] if end == 0 else centre_line[-2] - centre_line[-1]
    length = float(np.hypot(*step_inwards))
    if length < 2 * _ADDED_POINT_DISTANCE_M or float(step_inwards @ step) < _LEAST_BEND_COSINE * length:
        return centre_line
    at = 1 if end == 0 else len(centre_line) - 1
    return np.insert(centre_line, at, centre_line[end] + _ADDED_POINT_DISTANCE_M * step, axis=0)


def _continue_speed_limits_into_junctions(
    lanes: Mapping[str, BoundedLane], successors: Mapping[str, Iterable[str]], junction_lanes: Iterable[str]
) -> None:
    waiting = {name for name in junction_lanes if not lanes[name].limits}
    limits_by_lane: dict[str, list[tuple[SpeedLimitSpan, ...]]] = defaultdict(list)
    for name, targets in successors.items():
        for to in targets:
            if to in waiting and lanes[name].limits:
                limits_by_lane[to].append(lanes[name].limits)
    for to, limits in limits_by_lane.items():
        if len(set(limits)) == 1:
            lanes[to].limits = limits[0]


def _lane_id(net: _Net, edge: str, index: str) -> str:
    """Return the id of a lane of an edge by its index, '' where there is none."""
    lane_ids = net.edges.get(edge, [])
    return f"{edge}_{index}" if f"{edge}_{index}" in lane_ids else ""
