"""Maps of 123D (`map.arrow`, `maps/<data set>/<data set>_<location>.arrow`): lanes by their bounds, junctions, lights, crossings."""

from __future__ import annotations

import math
from collections import defaultdict
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.errors import MapError
from drivelint.formats.d123 import facts
from drivelint.formats.d123.map_furniture import crossing_rows, light_rows, report_missing_content, road_lines
from drivelint.formats.d123.map_layers import Intersection, Lane, LaneGroup, MapLayers, decode_points
from drivelint.formats.d123.markings import lane_marks
from drivelint.road.boundary_lanes import BoundedLane, build_lanes, map_from_bounds, side_driven_on
from drivelint.road.driving_side import choose_side
from drivelint.road.line_heights import line_heights_closest_to_points
from drivelint.road.overlapping_lanes import mark_junctions
from drivelint.road.quality import MapQuality

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.arrays import Floats, Indices
    from drivelint.road.boundary_lanes import Mark, SpeedLimitSpan
    from drivelint.road.map_reader import MapOptions, MapSource, MapTables

_UNDRIVABLE_LANE_TYPES: Final = frozenset({"biking"})
_MAX_SAMPLED_POINTS: Final = 200  # of a bound, to find the direction of a lane
_MAX_CREDIBLE_SPEED_LIMIT_MPS: Final = 45.0  # 160 km/h: a higher limit is a mistake, or in another unit


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables. Errors: `MapError` for a file that is no map of 123D, a version that is not read, or a map without lanes."""
    layers, quality = MapLayers.of_source(source), MapQuality()
    about = facts.dataset_facts(layers.info.dataset)
    lanes = _lanes(layers, quality)
    bounds = {str(name): (lane.left_boundary, lane.right_boundary) for name, lane in lanes.items()}
    marks = lane_marks(bounds, road_lines(layers, quality), about)
    intersections = layers.features("INTERSECTION", Intersection, quality)
    junctions = _intersection_by_lane(lanes, layers.features("LANE_GROUP", LaneGroup, quality), intersections)
    followers = _successors_by_lane(lanes)
    bounded = [
        _bounded_lane(
            name,
            lane,
            lanes=lanes,
            successors=followers[name],
            marks=marks[str(name)],
            junction=junctions.get(name),
            quality=quality,
        )
        for name, lane in lanes.items()
    ]
    built = build_lanes(bounded, request.offset, quality)
    if not any(lane.drivable for lane in built):
        first = next((row["message"] for row in quality.rows if row["check_id"] == "invalid_lane"), "it has no lane")
        raise MapError(
            f"map {source.name} has no lane for vehicles that can be built: {first}: give another map with --map"
        )
    if layers.header.get("map_has_z"):
        _set_heights(built, lanes, request.offset)
    if not intersections:
        mark_junctions(built)
    by_place = about.side_driven_on(layers.info.location)
    side = choose_side([("option", request.side), ("attribute", by_place), ("lanes", side_driven_on(built))], quality)
    signalled = {
        name
        for name, number in junctions.items()
        if intersections[number].intersection_type == facts.SIGNALLED_INTERSECTION_TYPE
    }
    furniture = {
        "traffic_signal": light_rows(built, signalled | layers.light_lanes),
        "crossing": crossing_rows(layers, built, request.offset, quality),
    }
    report_missing_content(layers, about, quality)
    return map_from_bounds(
        source,
        request,
        built,
        furniture,
        quality,
        map_format="123d",
        side_and_source=side,
        nation=about.nation_of(layers.info.location),
    )


def _lanes(layers: MapLayers, quality: MapQuality) -> dict[int, Lane]:
    """Return the lanes with their bounds as arrays, (n, 2) or (n, 3), in the order of the map."""
    lanes = {}
    for name, lane in layers.features("LANE", Lane, quality).items():
        try:
            lane.left_boundary, lane.right_boundary = (
                decode_points(lane.left_boundary),
                decode_points(lane.right_boundary),
            )
        except ValueError as error:
            quality.add("invalid_lane", "error", str(name), f"lanelet {name} is left out: {error}")
            continue
        lanes[name] = lane
    return lanes


def _intersection_by_lane(
    lanes: Mapping[int, Lane], groups: Mapping[int, LaneGroup], intersections: Mapping[int, Intersection]
) -> dict[int, int]:
    """Return lane -> the intersection to which its lane group belongs."""
    of_group: dict[int, int] = {}
    for name, within in groups.items():
        if within.intersection_id is not None and within.intersection_id in intersections:
            of_group[name] = within.intersection_id
    for number, intersection in intersections.items():
        for name in intersection.lane_group_ids or ():
            of_group.setdefault(name, number)
    intersection_by_lane = {}
    for name, lane in lanes.items():
        group = lane.lane_group_id
        if group is not None and group in of_group:
            intersection_by_lane[name] = of_group[group]
    return intersection_by_lane


def _successors_by_lane(lanes: Mapping[int, Lane]) -> dict[int, set[str]]:
    """Return lane -> its successors: the lanes that it names as such, and the lanes that name it as predecessor."""
    successors: dict[int, set[str]] = defaultdict(set)
    for name, lane in lanes.items():
        successors[name].update(map(str, lane.successor_ids or ()))
        for before in lane.predecessor_ids or ():
            successors[before].add(str(name))
    return successors


def _bounded_lane(
    lane_number: int,
    lane: Lane,
    *,
    lanes: Mapping[int, Lane],
    successors: set[str],
    marks: tuple[Mark, ...],
    junction: int | None,
    quality: MapQuality,
) -> BoundedLane:
    """Return a lane in the form from which `build_lanes` builds it."""
    kind, road_type = facts.LANE_TYPES.get(lane.lane_type, ("driving", None))
    if lane.lane_type not in facts.LANE_TYPES:
        message = f"type {lane.lane_type} of lanelet {lane_number} is not known: it is treated as a lane for vehicles"
        quality.add("unknown_word", "warning", str(lane_number), message)
    limits, limit_source = _limit_spans_and_source(lane_number, lane.speed_limit_mps, quality)
    beside = [
        (None, None)
        if neighbour_id is None or neighbour_id not in lanes
        else (str(neighbour_id), _runs_against(lane, lanes[neighbour_id]))
        for neighbour_id in (lane.left_lane_id, lane.right_lane_id)
    ]
    (left_id, left_against), (right_id, right_against) = beside
    return BoundedLane(
        str(lane_number), lane.left_boundary[:, :2], lane.right_boundary[:, :2], kind, kind not in _UNDRIVABLE_LANE_TYPES,
        road_type=road_type, junction_id=None if junction is None else str(junction), successors=tuple(sorted(successors)),
        left_id=left_id, left_against=left_against, right_id=right_id, right_against=right_against,
        marks=marks, limits=limits, limit_source=limit_source,
    )  # fmt: skip


def _limit_spans_and_source(
    lane_number: int, limit_mps: float | None, quality: MapQuality
) -> tuple[tuple[SpeedLimitSpan, ...], str]:
    """Return the limit of a lane, if the map has one, and its source."""
    if limit_mps is None or math.isnan(limit_mps):
        return (), "lane"
    if 0.0 < limit_mps <= _MAX_CREDIBLE_SPEED_LIMIT_MPS:
        return ((0.0, 1.0, limit_mps),), "lane"
    quality.add(
        "invalid_speed", "warning", str(lane_number), f"{limit_mps:g} m/s is not a speed limit: treated as unknown"
    )
    return ((0.0, 1.0, None),), "unread"


def _runs_against(lane: Lane, neighbour: Lane) -> bool:
    """Return whether a neighbour is driven the other way, by the directions of both lanes where they are nearest to each other."""
    (middles, along), (neighbour_middles, its_along) = (
        _piece_middles_and_directions(lane),
        _piece_middles_and_directions(neighbour),
    )
    near = np.hypot(*(middles[:, None] - neighbour_middles[None]).transpose(2, 0, 1))
    i, j = np.unravel_index(int(np.argmin(near)), near.shape)
    return bool(along[i] @ its_along[j] < 0.0)


def _piece_middles_and_directions(lane: Lane) -> tuple[Floats, Floats]:
    """Return the middles (n, 2) and directions (n, 2) of the pieces of both bounds of a lane."""
    lines = [bound[_sample_indices(len(bound)), :2] for bound in (lane.left_boundary, lane.right_boundary)]
    middles = np.vstack([(line[1:] + line[:-1]) / 2.0 for line in lines])
    return middles, np.vstack([np.diff(line, axis=0) for line in lines])


def _sample_indices(n: int) -> Indices:
    """Return the indices of at most `_MAX_SAMPLED_POINTS` of n points, evenly spread, including the first and the last."""
    return np.unique(np.linspace(0, n - 1, min(n, _MAX_SAMPLED_POINTS)).astype(np.intp))


def _set_heights(built: Sequence[BoundedLane], lanes: Mapping[int, Lane], offset: tuple[float, float]) -> None:
    """Set the heights of the centre lines: the mean of the heights of both bounds."""
    for lane in built:
        source = lanes[int(lane.lanelet_id)]
        pairs = ((source.left_boundary, lane.line.left), (source.right_boundary, lane.line.right))
        if all(bound.shape[1] == 3 for bound, _ in pairs):
            lane.z = np.mean(
                [line_heights_closest_to_points(bound, points - offset) for bound, points in pairs], axis=0
            )
