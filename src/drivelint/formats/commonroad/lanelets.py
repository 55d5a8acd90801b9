"""The maps in CommonRoad scenarios (XML, 2018b and 2020a): lanelets, signs, lights and stop lines.

They are read with lxml, because commonroad-io pins a protobuf of 2022, which cannot be installed beside a current one.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

from drivelint.errors import MapError
from drivelint.formats import safe_xml
from drivelint.formats.commonroad.country import country_in_scenario_name
from drivelint.formats.commonroad.signs import (
    MapSigns,
    points,
    read_signs,
    referenced_ids,
    signal_rows,
    stop_line_stations,
)
from drivelint.road.boundary_lanes import (
    BoundedLane,
    both_marks,
    build_lanes,
    crossings,
    map_from_bounds,
    side_driven_on,
)
from drivelint.road.countries import nation_of, side_of_nation
from drivelint.road.driving_side import choose_side
from drivelint.road.geo_reference import GeoFrame
from drivelint.road.quality import MapQuality
from drivelint.road.tables import stop_line_row

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lxml import etree

    from drivelint.road.map_reader import MapOptions, MapSource, MapTables

_LANE_TYPE_BY_LANELET_TYPE = {
    "sidewalk": "sidewalk", "busLane": "bus", "bicycleLane": "biking", "exitRamp": "exit", "accessRamp": "entry",
    "shoulder": "shoulder", "border": "border", "parking": "parking", "restricted": "restricted",
}  # fmt: skip
_LANE_TYPE_BY_USER = {"bus": "bus", "taxi": "taxi", "bicycle": "biking", "pedestrian": "sidewalk", "train": "rail"}
"""The type of a lanelet that cars may not use, by the first of these that may."""
_UNDRIVABLE_LANE_TYPES = frozenset({"sidewalk", "biking", "shoulder", "border", "parking", "restricted", "rail"})
_ROAD_TYPE_BY_LANELET_TYPE = {"interstate": "motorway", "highway": "motorway", "country": "rural", "urban": "town"}
_READ_LANELET_TYPES = {
    *_LANE_TYPE_BY_LANELET_TYPE,
    *_ROAD_TYPE_BY_LANELET_TYPE,
    "crosswalk",
    "mainCarriageWay",
    "driveWay",
    "intersection",
    "busStop",
}
_MARKINGS = {
    "solid": "solid", "broad_solid": "solid", "dashed": "broken", "broad_dashed": "broken", "curb": "curb",
    "lowered_curb": "curb", "solid_solid": "solid_solid", "dashed_dashed": "broken_broken", "no_marking": "none",
}  # fmt: skip
"""`lineMarking` -> marking of `lane_boundary`. Mixed double lines are missing: the file does not state which line is nearer."""


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables. Errors: `MapError` if the file is not XML, or no lanelet can be built."""
    root = safe_xml.parse_map(source)
    quality = MapQuality()
    signs = read_signs(root, country_in_scenario_name(root), quality)
    built: list[BoundedLane] = []
    walks: list[BoundedLane] = []
    for element in root.findall("lanelet"):
        try:
            kinds = [t.text or "" for t in element.findall("laneletType")]
            (walks if "crosswalk" in kinds else built).append(_bounded_lane(element, kinds, signs, quality))
        except (ValueError, KeyError) as error:
            name = element.get("id") or f"in line {element.sourceline}"
            quality.add("invalid_lane", "error", name, f"lanelet {name} is left out: {error}")
    signs.report_problems(root.findall("lanelet"), [light.get("id", "") for light in root.findall("trafficLight")])
    _report_unread_markings_and_types(root, quality)
    _remove_town_road_types_of_highway_scenario(root, built, quality)
    _set_junctions(root, built)
    lanes = build_lanes(built, request.offset, quality)
    if not lanes:
        first = next((row["message"] for row in quality.rows), "it has no <lanelet>")
        raise MapError(f"map {source.name} has no lane that can be built: {first}")
    nation = nation_of(country_in_scenario_name(root))
    by_country = None if nation is None else side_of_nation(nation)
    side = choose_side([("option", request.side), ("lanes", side_driven_on(lanes)), ("attribute", by_country)], quality)
    try:
        lines = stop_line_stations(root, lanes, request.offset)
        signals = signal_rows(root, signs, lanes, request.offset, lines)
    except ValueError as error:
        raise MapError(
            f"map {source.name}: a sign, light or stop line cannot be read: {error}: correct or remove it"
        ) from error
    furniture = {
        "traffic_signal": signals,
        "stop_line": [
            stop_line_row(stop, name, s) for stop, name, s in sorted((f"{n}.stop", n, s) for n, s in lines.items())
        ],
        "crossing": crossings(walks, lanes, request.offset, quality),
    }
    geo = _geo_frame(root, quality)
    return map_from_bounds(
        source,
        request,
        lanes,
        furniture,
        quality,
        map_format="commonroad",
        side_and_source=side,
        geo=geo,
        nation=nation,
    )


def _geo_frame(root: etree._Element, quality: MapQuality) -> GeoFrame | None:
    """Return the geodetic frame of the map's coordinates; None if the map states none that can be used.

    The map's coordinates plus the translation are coordinates of the reference, as in CommonRoad's own converters. `gpsLatitude` and
    `gpsLongitude` are not used: they are those of the town of `geoNameId`, or 999, not of the point 0,0.
    """
    reference = (root.findtext("location/geoTransformation/geoReference") or "").strip()
    more = root.find("location/geoTransformation/additionalTransformation")
    if not reference:
        return None
    x, y, turn, scale = (
        float(default) if more is None else safe_xml.number_or_nan(more.findtext(name) or default)
        for name, default in (("xTranslation", "0"), ("yTranslation", "0"), ("zRotation", "0"), ("scaling", "1"))
    )
    if not (math.isfinite(x) and math.isfinite(y)) or (turn, scale) != (0.0, 1.0):
        why = "of additionalTransformation, only xTranslation and yTranslation are understood, with zRotation 0 and scaling 1"
        quality.add_unusable_geo_reference(reference, why)
        return None
    return GeoFrame(reference, x, y)


def _bounded_lane(
    element: etree._Element, lanelet_types: Sequence[str], signs: MapSigns, quality: MapQuality
) -> BoundedLane:
    kind = next((_LANE_TYPE_BY_LANELET_TYPE[k] for k in lanelet_types if k in _LANE_TYPE_BY_LANELET_TYPE), None)
    users = {(e.text or "").strip() for name in ("userOneWay", "userBidirectional") for e in element.findall(name)}
    if kind is None and users and not users & {"vehicle", "car"}:
        kind = next((kind for user, kind in _LANE_TYPE_BY_USER.items() if user in users), None)
        if kind is None:
            message = f"cars may not use it ({', '.join(sorted(users))} may), which no lane type shows"
            quality.add("access_unread", "warning", str(element.attrib["id"]), message)
    kind = kind or "driving"
    limit_mps, limit_source = signs.speed_limit(element)
    left, right = element.find("leftBound"), element.find("rightBound")
    lane = BoundedLane(
        str(element.attrib["id"]), points(left), points(right), kind, kind not in _UNDRIVABLE_LANE_TYPES,
        bidirectional=len(element.findall("userOneWay")) == 0 and len(element.findall("userBidirectional")) > 0,
        road_type=next((_ROAD_TYPE_BY_LANELET_TYPE[k] for k in lanelet_types if k in _ROAD_TYPE_BY_LANELET_TYPE), None),
        successors=tuple(referenced_ids(element, "successor")),
        marks=both_marks(_marking(left), _marking(right)),
        limits=() if limit_mps is None else ((0.0, 1.0, limit_mps),), limit_source=limit_source,
    )  # fmt: skip
    if (beside := element.find("adjacentLeft")) is not None:
        lane.left_id, lane.left_against = beside.get("ref"), beside.get("drivingDir") != "same"
    if (beside := element.find("adjacentRight")) is not None:
        lane.right_id, lane.right_against = beside.get("ref"), beside.get("drivingDir") != "same"
    return lane


def _marking(bound: etree._Element | None) -> str | None:
    text = None if bound is None else bound.findtext("lineMarking")
    return _MARKINGS.get(text or "")


def _remove_town_road_types_of_highway_scenario(
    root: etree._Element, lanes: Sequence[BoundedLane], quality: MapQuality
) -> None:
    """Remove the road type `urban` in a scenario with the tag `highway`: converters write this type for every lanelet."""
    tags = {tag.tag for parent in root.findall("scenarioTags") for tag in parent}
    towns = [lane for lane in lanes if lane.road_type == "town"]
    if towns and tags & {"highway", "interstate"} and "urban" not in tags:
        for lane in towns:
            lane.road_type = None
        message = "the lanelets are urban, but the scenario's tags are highway: the type of the road is not known"
        quality.add("road_type_contradicted", "warning", None, message, len(towns))


def _report_unread_markings_and_types(root: etree._Element, quality: MapQuality) -> None:
    """Report the markings and lanelet types that are not read."""
    for tag, known_words, subject in (
        ("lineMarking", _MARKINGS, "markings"),
        ("laneletType", _READ_LANELET_TYPES, "types of lanelets"),
    ):
        counts = Counter((e.text or "").strip() for e in root.iterfind(f"lanelet//{tag}"))
        unread = {word: n for word, n in sorted(counts.items()) if word not in known_words and word != "unknown"}
        if unread:
            listed = ", ".join(f"{word or 'no word'} ({n})" for word, n in unread.items())
            quality.add("unknown_word", "info", None, f"{subject} that are not read: {listed}", sum(unread.values()))


def _set_junctions(root: etree._Element, lanes: Sequence[BoundedLane]) -> None:
    """Set the junction of each lanelet that an intersection names as a successor, if another lanelet leads to it."""
    inside: dict[str, str] = {}
    for crossing in root.findall("intersection"):
        for way in crossing.findall("incoming"):
            for name in ("successorsLeft", "successorsStraight", "successorsRight"):
                inside.update(dict.fromkeys(referenced_ids(way, name), crossing.get("id", "")))
    ends = {to for lane in lanes for to in lane.successors}
    for lane in lanes:
        if lane.lanelet_id in inside and lane.lanelet_id in ends:
            lane.junction_id = inside[lane.lanelet_id]
