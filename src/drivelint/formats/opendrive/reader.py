"""This module reads an OpenDRIVE file into the tables of schemas/map.sql."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from drivelint.errors import MapError
from drivelint.formats import safe_xml
from drivelint.formats.opendrive.direction import DrivingSideStatements, report_lanes_against_side
from drivelint.formats.opendrive.furniture import furniture_rows
from drivelint.formats.opendrive.lanelet import boundary_rows, recorded_limit_rows
from drivelint.formats.opendrive.lanes import build_lanelets
from drivelint.formats.opendrive.links import lanelet_links
from drivelint.formats.opendrive.network import DYNAMIC_DIRECTION, DYNAMIC_TYPE, road_network
from drivelint.formats.opendrive.signlimits import speed_limit_rows
from drivelint.phrases import escape_invisible
from drivelint.road.boundary_lanes import lane_point_columns
from drivelint.road.driving_side import opposite_side, side_driven_on
from drivelint.road.quality import MapQuality
from drivelint.road.tables import map_tables

if TYPE_CHECKING:
    from lxml import etree

    from drivelint.formats.opendrive.direction import DrivingDirection
    from drivelint.formats.opendrive.lanelet import Lanelet
    from drivelint.formats.opendrive.lanes import BuiltLanes
    from drivelint.formats.opendrive.network import Network
    from drivelint.road.map_reader import MapOptions, MapSource, MapTables
    from drivelint.road.tables import Rows


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables. Errors: `MapError` if the file is not XML, includes another file, or no lane can be built."""
    quality = MapQuality()
    root = safe_xml.parse_map(source)
    _refuse_includes(root, source)
    net = road_network(root, quality)
    direction, lanes = _direction_and_lanes(net, request, quality)
    if not lanes.built:
        first = next((row["message"] for row in quality.rows if row["severity"] == "error"), "it has no roads")
        raise MapError(f"map {source.name} has no lane that can be built: {first}")
    lane_links = lanelet_links(net, lanes, quality)
    side = direction.handedness, direction.source
    turned = direction.forward != (direction.handedness == "rht")
    built = sorted(lanes.built.values(), key=lambda lane: lane.key)
    places = {lane.lanelet_id: n for n, lane in enumerate(built)}
    _report_unread_statements(built, quality)
    recorded = [row for lane in built for row in recorded_limit_rows(lane)]
    beside = furniture_rows(net, built, request.offset, quality)
    limits = speed_limit_rows(built, lane_links, beside["traffic_signal"], recorded, quality)
    content: dict[str, Rows | dict[str, Any]] = {
        "lanelet": [_lanelet_row(lane) for lane in built],
        "lane_point": lane_point_columns(built),
        "lane_link": [
            {"from_id": a.lanelet_id, "to_id": b.lanelet_id, "turn_rad": b.line.turn_rad} for a, b in lane_links
        ],
        "lane_boundary": [row for lane in built for row in boundary_rows(lane)],
        "speed_limit": sorted(limits, key=lambda row: places[row["lanelet_id"]]),
        **beside,
    }
    tables = map_tables(
        source,
        request,
        content,
        quality,
        map_format="opendrive",
        side_and_source=side,
        geo=net.geo,
        lanes_reversed=turned,
        nation=net.nation,
    )
    return replace(tables, lanes="rht" if direction.forward else "lht", lanes_source=direction.forward_source)


def _refuse_includes(root: etree._Element, source: MapSource) -> None:
    """Raise `MapError` if a part of the map is in another file; what an application adds in `<userData>` is no part of it."""
    for element in root.iter("include"):
        if not any(parent.tag == "userData" for parent in element.iterancestors()):
            file = escape_invisible(element.get("file", "without a name")[:200])
            raise MapError(
                f"map {source.name} includes another file in line {element.sourceline}, which is not read ({file}): "
                "replace <include> by the content of that file"
            )


def _report_unread_statements(lanes: list[Lanelet], quality: MapQuality) -> None:
    """Report the lanes of which the map states something that no column can have. The rules that need it are unknown there."""
    for lane in lanes:
        if lane.drivable and lane.lane.is_access_unread:
            message = "its <access>, <rule> or roadworks keep cars out at a place or in a way that is not read: who may use it is not known"
            quality.add("access_unread", "warning", lane.lanelet_id, message)
        if DYNAMIC_TYPE in lane.lane.varies:
            message = "its type may change (dynamicLaneType): whether it is open to traffic is not known"
            quality.add("lane_type_varies", "warning", lane.lanelet_id, message)
        if DYNAMIC_DIRECTION in lane.lane.varies:
            message = "its direction may change (dynamicLaneDirection): which one holds is not known"
            quality.add("lane_direction_varies", "warning", lane.lanelet_id, message)


def _direction_and_lanes(net: Network, request: MapOptions, quality: MapQuality) -> tuple[DrivingDirection, BuiltLanes]:
    """Build the lanes as for two-way traffic; build them again if their layout shows that the directions are wrong."""
    witnesses = DrivingSideStatements.collect(net, request)
    first, noted = witnesses.direction_on_two_way_roads(), len(quality.rows)
    lanes = build_lanelets(net, first, request.offset, quality)
    side = side_driven_on(
        [
            lane.line.points_with_half_widths(lane.z)
            for lane in sorted(lanes.built.values(), key=lambda lane: lane.key)
            if lane.drivable and not lane.bidirectional and lane.road.junction_id is None
        ]
    )
    if side is not None and not first.forward:
        side = opposite_side(side)
    built = quality.rows[noted:]
    del quality.rows[noted:]
    direction = witnesses.driving_side_and_lane_direction(side, quality)
    if (direction.forward, direction.travel) != (first.forward, first.travel):
        lanes = build_lanelets(net, direction, request.offset, quality)
    else:
        quality.rows += built
    report_lanes_against_side(net, direction, quality)
    return direction, lanes


def _lanelet_row(lane: Lanelet) -> dict[str, Any]:
    return {
        "lanelet_id": lane.lanelet_id, "road_id": lane.road.road_id, "section": lane.lane_section.section,
        "lane_no": lane.lane.number, "lane_type": lane.lane.kind, "drivable": lane.drivable,
        "bidirectional": lane.bidirectional, "along_road": lane.along, "junction_id": lane.road.junction_id,
        "road_type": lane.lane_section.road_type,
        "length_m": lane.line.length, "width_m": lane.mean_width_m(), "area_m2": lane.line.area,
        "left_id": lane.left.lanelet_id if lane.left else None,
        "left_against": _is_driven_other_way(lane, lane.left),
        "right_id": lane.right.lanelet_id if lane.right else None,
        "right_against": _is_driven_other_way(lane, lane.right),
    }  # fmt: skip


def _is_driven_other_way(lane: Lanelet, beside: Lanelet | None) -> bool | None:
    """Return whether the lane beside is driven the other way; a lane that is driven both ways counts as such."""
    return None if beside is None else beside.along != lane.along or beside.bidirectional
