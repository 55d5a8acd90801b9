"""Lanelet2 maps (`.osm`), read with the library lanelet2: lanes, neighbours, limits, lights, stop lines, crossings."""

from __future__ import annotations

import math
from collections import defaultdict
from typing import TYPE_CHECKING, Any

from drivelint.errors import MapError
from drivelint.formats.lanelet2.file import attribute, line_points, load_map_and_is_local
from drivelint.formats.lanelet2.furniture import furniture_rows
from drivelint.formats.lanelet2.traffic_rules import TrafficRules, is_dynamic, limit_text
from drivelint.road.boundary_lanes import BoundedLane, both_marks, build_lanes, map_from_bounds, side_driven_on
from drivelint.road.driving_side import choose_side
from drivelint.road.geo_reference import tangent_plane_frame
from drivelint.road.overlapping_lanes import mark_junctions
from drivelint.road.quality import MapQuality

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from drivelint.road.map_reader import MapOptions, MapSource, MapTables

_MARKING_BY_LINE_STYLE = {
    "solid": "solid",
    "dashed": "broken",
    "solid_solid": "solid_solid",
    "dashed_dashed": "broken_broken",
}
_MARKING_BY_BOUND_TYPE = {"curbstone": "curb", "virtual": "none"}
_LEFT_DRIVING_NATIONS = frozenset({"gb", "uk", "ie", "au", "nz", "jp", "in", "za", "sg", "my", "th", "hk", "cy", "mt"})


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables.

    Errors: as `file.load_map_and_is_local`, and `MapError` if no lanelet can be built.
    """
    quality = MapQuality()
    layers, local = load_map_and_is_local(source, request, quality)
    lanes = build_lanes(_lanes(layers, quality), request.offset, quality)
    if not lanes:
        raise MapError(f"map {source.name} has no lanelet that can be built: is it a plain OpenStreetMap extract?")
    mark_junctions(lanes)
    regions = {attribute(x, "region") for x in layers.laneletLayer} - {""}
    by_region = {"lht" if region[:2].lower() in _LEFT_DRIVING_NATIONS else "rht" for region in regions}
    side_of_regions = by_region.pop() if len(by_region) == 1 else None
    side = choose_side(
        [("option", request.side), ("lanes", side_driven_on(lanes)), ("attribute", side_of_regions)], quality
    )
    beside = furniture_rows(layers, lanes, request.offset, quality)
    geo = None if request.origin is None or local else tangent_plane_frame(*request.origin)
    return map_from_bounds(
        source, request, lanes, beside, quality, map_format="lanelet2", side_and_source=side, geo=geo
    )


BoundKey = tuple[int, bool]
"""A bound of a lane: the id of its line, and whether it runs against the direction in which the line was drawn."""


def _bound_key(line: Any, *, is_reversed: bool = False) -> BoundKey:
    return line.id, bool(line.inverted()) != is_reversed


def _lanes(layers: Any, quality: MapQuality) -> Iterable[BoundedLane]:
    """Yield the lanes. Neighbours share a bound; a successor begins at the two points where a lane ends."""
    rules = TrafficRules()
    access = {x.id: lane_access for x in layers.laneletLayer if (lane_access := rules.access(x)) is not None}
    lanelets = sorted((x for x in layers.laneletLayer if x.id in access), key=lambda x: x.id)
    for x in [x for x in lanelets if not (len(x.leftBound) and len(x.rightBound))]:
        lanelets.remove(x)
        quality.add("invalid_lane", "error", str(x.id), f"lanelet {x.id} is left out: a bound has no points")
    starts: dict[tuple[int, int], list[str]] = defaultdict(list)
    lefts: dict[BoundKey, list[Any]] = defaultdict(list)
    rights: dict[BoundKey, list[Any]] = defaultdict(list)
    for x in lanelets:
        starts[x.leftBound[0].id, x.rightBound[0].id].append(str(x.id))
        lefts[_bound_key(x.leftBound)].append(x)
        rights[_bound_key(x.rightBound)].append(x)
    for x in lanelets:
        lane_type, drivable, bidirectional, is_unread = access[x.id]
        if is_unread:
            message = "cars may not use it by its tags participant:*, which no lane type shows"
            quality.add("access_unread", "warning", str(x.id), message)
        limit_mps = rules.limit_mps(x)
        readable = limit_mps is None or math.isfinite(limit_mps)
        limits = () if limit_mps is None else ((0.0, 1.0, limit_mps if readable else None),)
        if not readable:
            reason = _why_no_limit(x)
            quality.add("invalid_speed", "warning", str(x.id), f"{reason}: treated as unknown")
        lane = BoundedLane(
            str(x.id), line_points(x.leftBound), line_points(x.rightBound), lane_type, drivable, bidirectional=bidirectional,
            road_type=_road_type(x),
            successors=tuple(sorted(starts[x.leftBound[-1].id, x.rightBound[-1].id])),
            marks=both_marks(_marking(x.leftBound, is_left_line_nearer=False), _marking(x.rightBound, is_left_line_nearer=True)),
            limits=limits, limit_source="sign" if readable else "unread",
        )  # fmt: skip
        left, right = x.leftBound, x.rightBound
        lane.left_id, lane.left_against = _neighbour_id_and_against(
            x, rights[_bound_key(left)], lefts[_bound_key(left, is_reversed=True)]
        )
        lane.right_id, lane.right_against = _neighbour_id_and_against(
            x, lefts[_bound_key(right)], rights[_bound_key(right, is_reversed=True)]
        )
        yield lane


def _why_no_limit(lanelet: Any) -> str:
    """Return why the limit that a lanelet states is not known."""
    if any(attribute(rule, "subtype") == "speed_limit" and is_dynamic(rule) for rule in lanelet.regulatoryElements):
        return "its limit is dynamic: what it is at a time is not in the map"
    text = limit_text(lanelet)
    return "its sign has no limit that can be read" if text is None else f"{text[:20]!r} is not a speed limit"


def _neighbour_id_and_against(
    lanelet: Any, same_way_lanes: Sequence[Any], other_way_lanes: Sequence[Any]
) -> tuple[str | None, bool | None]:
    """Return the neighbour across a line, and whether it is driven the other way.

    `same_way_lanes`: the lanes with this line as the bound of their other side. `other_way_lanes`: the lanes with this line, reversed, as
    the bound of the same side.
    """
    for lanes, other_way in ((same_way_lanes, False), (other_way_lanes, True)):
        for x in lanes:
            if x.id != lanelet.id:
                return str(x.id), other_way
    return None, None


def _road_type(lanelet: Any) -> str | None:
    if attribute(lanelet, "subtype") == "highway":
        return "motorway" if attribute(lanelet, "location") != "urban" else "town"
    return {"urban": "town", "nonurban": "rural"}.get(attribute(lanelet, "location"))


def _marking(bound: Any, *, is_left_line_nearer: bool) -> str | None:
    """Return the marking of a bound. Lanelet2 names a double line from left to right; here, the line nearer to the lane comes first."""
    kind, style = attribute(bound, "type"), attribute(bound, "subtype")
    if kind in _MARKING_BY_BOUND_TYPE:
        return _MARKING_BY_BOUND_TYPE[kind]
    if kind not in {"line_thin", "line_thick"}:
        return None
    if style in {"solid_dashed", "dashed_solid"}:
        first_solid = (style == "solid_dashed") != bool(bound.inverted())
        return "solid_broken" if first_solid == is_left_line_nearer else "broken_solid"
    return _MARKING_BY_LINE_STYLE.get(style)
