"""Lanelet2 maps (`.osm`), through the library of that name: lanes, neighbours, limits, lights, stop lines, crossings."""

from __future__ import annotations

import math
from collections import defaultdict
from typing import TYPE_CHECKING, Any

from drivelint.errors import MapError
from drivelint.formats.lanelet2.file import attribute, load, xy
from drivelint.formats.lanelet2.furniture import furniture
from drivelint.road.boundary_lanes import BoundedLane, both_marks, build_lanes, map_from_bounds, side_driven_on
from drivelint.road.driving_side import choose_side
from drivelint.road.geo_reference import tangent_plane
from drivelint.road.overlap import mark_junctions
from drivelint.road.quality import MapQuality

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from drivelint.road.map_reader import MapOptions, MapSource, MapTables

_KINDS = {
    "road": "driving", "highway": "driving", "play_street": "driving", "bus_lane": "bus", "exit": "exit",
    "emergency_lane": "stop", "bicycle_lane": "biking", "walkway": "sidewalk", "shared_walkway": "sidewalk",
    "stairs": "sidewalk", "pedestrian_lane": "sidewalk", "road_shoulder": "shoulder", "rail": "rail",
}  # fmt: skip
_DRIVEN = frozenset({"driving", "bus", "exit"})
_LINES = {"solid": "solid", "dashed": "broken", "solid_solid": "solid_solid", "dashed_dashed": "broken_broken"}
_EDGES = {"curbstone": "curb", "virtual": "none"}
_LEFT_DRIVEN = frozenset({"gb", "uk", "ie", "au", "nz", "jp", "in", "za", "sg", "my", "th", "hk", "cy", "mt"})


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables.

    Errors: `MapError` where the library is not installed, the file is none of Lanelet2's, or nothing says where the
    log's frame lies on the globe.
    """
    quality = MapQuality()
    layers, local = load(source, request, quality)
    lanes = build_lanes(_lanes(layers, quality), request.offset, quality)
    if not lanes:
        raise MapError(f"map {source.name} has no lanelet that can be built: is it a plain OpenStreetMap extract?")
    mark_junctions(lanes)
    regions = {attribute(x, "region") for x in layers.laneletLayer} - {""}
    by_region = {"lht" if region[:2].lower() in _LEFT_DRIVEN else "rht" for region in regions}
    said = by_region.pop() if len(by_region) == 1 else None
    side = choose_side([("option", request.side), ("lanes", side_driven_on(lanes)), ("attribute", said)], quality)
    beside = furniture(layers, lanes, request.offset, quality)
    geo = None if request.origin is None or local else tangent_plane(*request.origin)
    return map_from_bounds(source, request, lanes, beside, quality, kind="lanelet2", side=side, geo=geo)


Bound = tuple[int, bool]
"""A line as it bounds a lane: which, and whether it runs the other way round than it was drawn."""


def _bound(line: Any, *, turned: bool = False) -> Bound:
    return line.id, bool(line.inverted()) != turned


def _lanes(layers: Any, quality: MapQuality) -> Iterable[BoundedLane]:
    """Yield the lanes. Neighbours share a bound, what follows begins at the points where a lane ends."""
    mine = sorted((x for x in layers.laneletLayer if attribute(x, "subtype") in _KINDS), key=lambda x: x.id)
    for x in [x for x in mine if not (len(x.leftBound) and len(x.rightBound))]:
        mine.remove(x)
        quality.add("invalid_lane", "error", str(x.id), f"lanelet {x.id} is left out: a bound has no points")
    starts: dict[tuple[int, int], list[str]] = defaultdict(list)
    lefts: dict[Bound, list[Any]] = defaultdict(list)
    rights: dict[Bound, list[Any]] = defaultdict(list)
    for x in mine:
        starts[x.leftBound[0].id, x.rightBound[0].id].append(str(x.id))
        lefts[_bound(x.leftBound)].append(x)
        rights[_bound(x.rightBound)].append(x)
    import lanelet2

    rules = lanelet2.traffic_rules.create(
        lanelet2.traffic_rules.Locations.Germany, lanelet2.traffic_rules.Participants.Vehicle
    )
    for x in mine:
        kind = _KINDS[attribute(x, "subtype")]
        limit_mps = _limit(x, rules)
        readable = limit_mps is None or (math.isfinite(limit_mps) and limit_mps > 0.0)
        limits = () if limit_mps is None else ((0.0, 1.0, limit_mps if readable else None),)
        if not readable:
            said = attribute(x, "speed_limit")[:20]
            message = f"{said!r} is no speed limit: taken as unknown"
            quality.add("invalid_speed", "warning", str(x.id), message)
        lane = BoundedLane(
            str(x.id), xy(x.leftBound), xy(x.rightBound), kind, kind in _DRIVEN,
            bidirectional=kind in _DRIVEN and attribute(x, "one_way") in {"no", "false"},
            road_type=_road_type(x),
            successors=tuple(sorted(starts[x.leftBound[-1].id, x.rightBound[-1].id])),
            marks=both_marks(_marking(x.leftBound, near_left=False), _marking(x.rightBound, near_left=True)),
            limits=limits, limit_source="sign" if readable else "unread",
        )  # fmt: skip
        left, right = x.leftBound, x.rightBound
        lane.left_id, lane.left_against = _beside(x, rights[_bound(left)], lefts[_bound(left, turned=True)])
        lane.right_id, lane.right_against = _beside(x, lefts[_bound(right)], rights[_bound(right, turned=True)])
        yield lane


def _beside(own: Any, same: Sequence[Any], against: Sequence[Any]) -> tuple[str | None, bool | None]:
    """Return the neighbour across a bound: `same` have it as their other bound, `against` as the same one, turned round."""
    for lanes, other_way in ((same, False), (against, True)):
        for x in lanes:
            if x.id != own.id:
                return str(x.id), other_way
    return None, None


def _road_type(x: Any) -> str | None:
    if attribute(x, "subtype") == "highway":
        return "motorway" if attribute(x, "location") != "urban" else "town"
    return {"urban": "town", "nonurban": "rural"}.get(attribute(x, "location"))


def _limit(x: Any, rules: Any) -> float | None:
    """Return the limit in m/s by a lanelet's signs, not by a nation's default; None: the map does not say one."""
    signed = any(attribute(r, "subtype") == "speed_limit" for r in x.regulatoryElements)
    if not signed and "speed_limit" not in x.attributes:
        return None
    return float(rules.speedLimit(x).speedLimit) / 3.6


def _marking(bound: Any, *, near_left: bool) -> str | None:
    """Return the marking of a bound; of a double line, named left first along the bound, the nearer half comes first."""
    kind, style = attribute(bound, "type"), attribute(bound, "subtype")
    if kind in _EDGES:
        return _EDGES[kind]
    if kind not in {"line_thin", "line_thick"}:
        return None
    if style in {"solid_dashed", "dashed_solid"}:
        first_solid = (style == "solid_dashed") != bool(bound.inverted())
        return "solid_broken" if first_solid == near_left else "broken_solid"
    return _LINES.get(style)
