"""Reads the lanes in the first ground truth of an OSI trace: logical lanes, and physical lanes in places without logical lanes.

OSI's left and right refer to the order of a line's points, which may be against the traffic. Here, lanes are in the direction of travel.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from google.protobuf.message import DecodeError

from drivelint.errors import MapError
from drivelint.formats.osi import map_furniture as osi_furniture
from drivelint.formats.osi import map_logical as osi_logical
from drivelint.formats.osi import map_physical as osi_physical
from drivelint.formats.osi.schema import message_class
from drivelint.road.boundary_lanes import build_lanes, map_from_bounds, side_driven_on
from drivelint.road.driving_side import choose_side
from drivelint.road.lane_geometry import resampled, stations
from drivelint.road.line_heights import line_heights_closest_to_points
from drivelint.road.quality import MapQuality

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.formats.osi.map_logical import LogicalLane
    from drivelint.formats.osi.map_physical import PhysicalLane
    from drivelint.road.map_reader import MapOptions, MapSource, MapTables

_SAME_ROAD_HEIGHT_M = 1.0  # lanes whose heights differ by less are on the same road


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables. Errors: `MapError` with the reason if no lane for driving can be built."""
    quality = MapQuality()
    try:
        truth = message_class("GroundTruth").FromString(source.content)
    except DecodeError as error:
        begin = source.content[:24]
        raise MapError(
            f"map {source.name} is neither XML nor OSI's lanes (it begins with {begin!r}): give an OpenDRIVE file (.xodr)"
        ) from error
    logical = osi_logical.read(truth, quality)
    physical = osi_physical.read(truth, quality)
    covers = _logical_by_physical(logical, physical)
    alone = {i: lane for i, lane in physical.items() if i not in covers}
    for i in sorted(alone.keys() & logical.keys()):
        message = f"lane {i} is left out: a logical lane at another place has the same id"
        quality.add("invalid_lane", "error", str(i), message)
        del alone[i]
    ways = osi_physical.intersection_lanes(truth, alone)
    bounded = [
        *osi_logical.bounded_lanes(logical, truth),
        *osi_physical.bounded_lanes(alone, truth, [way for way, _ in ways]),
    ]
    lanes = build_lanes(bounded, request.offset, quality)
    if not any(lane.drivable for lane in lanes):
        raise MapError(f"map {source.name}: {_why_no_driving_lane(truth, quality)}")
    heights = {str(i): lane.centre_line for i, lane in alone.items()} | {
        str(i): lane.centre_line for i, lane in logical.items()
    }
    heights |= {way.lanelet_id: ends for way, ends in ways}
    for lane in lanes:
        lane.z = line_heights_closest_to_points(heights[lane.lanelet_id], lane.line.centre - request.offset)
    # the option takes precedence over the side that the lanes show
    side_source = ("option", request.side) if request.side else ("lanes", side_driven_on(lanes))
    side = choose_side([side_source], quality, "the lanes")
    beside = osi_furniture.read(truth, lanes, covers, request.offset, quality)
    return map_from_bounds(source, request, lanes, beside, quality, map_format="osi", side_and_source=side)


def _logical_by_physical(
    logical: Mapping[int, LogicalLane], physical: Mapping[int, PhysicalLane]
) -> dict[int, list[int]]:
    """Return physical lane -> the logical lanes that replace it: those that refer to it, or that together cover most of it."""
    covers: dict[int, list[int]] = {}
    for name, lane in logical.items():
        for ref in lane.physical_lane_ids:
            covers.setdefault(ref, []).append(name)
    names = list(logical)
    areas = [
        shapely.Polygon(np.vstack([lane.left[:, :2], lane.right[::-1, :2]])).buffer(0.0) for lane in logical.values()
    ]
    tree = shapely.STRtree(areas)
    for ref, physical_lane in physical.items():
        if ref in covers or not names:
            continue
        s = stations(physical_lane.centre_line)
        points = resampled(
            physical_lane.centre_line, s, (np.arange(20) + 0.5) / 20 * s[-1]
        )  # the middles of 20 equal pieces
        over, under = tree.query(shapely.points(points[:, :2]), predicate="within")
        heights = [
            line_heights_closest_to_points(logical[names[a]].centre_line, points[[p], :2])[0]
            for p, a in zip(over, under, strict=True)
        ]
        level = np.abs(points[over, 2] - heights)
        same = level < _SAME_ROAD_HEIGHT_M
        if len(set(over[same].tolist())) > len(points) / 2:
            covers[ref] = sorted({names[a] for a in under[same].tolist()})
    return covers


def _why_no_driving_lane(truth: Any, quality: MapQuality) -> str:
    """Return the most frequent reason why no lane for driving could be built."""
    n = len(truth.logical_lane) + len(truth.lane)
    reasons = Counter(
        row["message"].partition(" is left out: ")[2] for row in quality.rows if row["check_id"] == "invalid_lane"
    )
    if not reasons:
        return f"none of the {n} lanes in the log is a lane for driving"
    reason, largest = min(reasons.items(), key=lambda item: (-item[1], item[0]))
    return f"none of the {n} lanes in the log is a lane for driving that can be built; {largest} of them fail because {reason}: give --map"
