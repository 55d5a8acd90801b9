"""The map of a ScenarioNet scenario: its lanes, their markings and limits, and the lights, stop signs and crossings on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import shapely

from drivelint.errors import MapError
from drivelint.formats.scenarionet.centre_lines import (
    fill_unknown_bound_distances_and_return_filled_shares,
    measure_bound_distances,
    named_boundary_spans,
    read_centre_lines,
)
from drivelint.formats.scenarionet.furniture import furniture_rows
from drivelint.formats.scenarionet.lane_graph import find_neighbours, link_lanes
from drivelint.formats.scenarionet.pickled_numpy import PickleError
from drivelint.formats.scenarionet.scenario import number_array, read_scenario
from drivelint.road.boundary_lanes import BoundedLane, Mark, build_lanes, map_from_bounds, side_driven_on
from drivelint.road.driving_side import choose_side
from drivelint.road.overlapping_lanes import mark_junctions
from drivelint.road.quality import MapQuality

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.arrays import Floats
    from drivelint.formats.scenarionet.centre_lines import CentreLine
    from drivelint.formats.scenarionet.scenario import Scenario
    from drivelint.road.map_reader import MapOptions, MapSource, MapTables

_MARKING_BY_LINE_TYPE: Final = {
    "BROKEN_SINGLE": "broken", "SOLID_SINGLE": "solid", "SOLID_DOUBLE": "solid_solid", "BROKEN_DOUBLE": "broken_broken",
}  # fmt: skip
"""The part of a type between ROAD_LINE_ and the colour -> marking. Missing: double lines that may be crossed from one side only."""
_LEAST_JUNCTION_OVERLAP_SHARE: Final = 0.1  # of the smaller lane's area: a smaller overlap is an inaccuracy of bounds
_LEAST_CROSSING_ANGLE_RAD: Final = float(np.radians(25.0))  # lanes at a smaller angle split or merge
_MPS_PER_MPH: Final = 0.44704
_MPS_PER_KMH: Final = 1.0 / 3.6
_HIGHEST_LIMIT_MPS: Final = 60.0


def read(source: MapSource, request: MapOptions) -> MapTables:
    """Return the map's tables. Errors: `MapError` if the pickle is damaged or not a scenario, or no lane for driving can be built."""
    quality = MapQuality()
    try:
        scenario = read_scenario(source.content)
        centres = read_centre_lines(scenario, quality)
        link_lanes(centres)
        measure_bound_distances(centres, scenario)
    except PickleError as error:
        raise MapError(f"map {source.name}: {error}") from error
    assumed_shares = fill_unknown_bound_distances_and_return_filled_shares(centres)
    lanes = build_lanes(_bounded_lanes(centres, scenario, quality), request.offset, quality)
    if not any(lane.drivable for lane in lanes):
        first = next((row["message"] for row in quality.rows), "it has none")
        raise MapError(f"map {source.name} has no lane for driving that can be built: {first}: give --map")
    _report_assumed_widths(centres, assumed_shares, quality)
    for lane in lanes:
        centre = centres[lane.lanelet_id]
        lane.z = np.interp(_stations_on(centre, lane.line.centre - request.offset), centre.s, centre.z)
    mark_junctions(lanes, least_share=_LEAST_JUNCTION_OVERLAP_SHARE, least_angle_rad=_LEAST_CROSSING_ANGLE_RAD)
    side_of_place = scenario.dataset.side_driven_on(scenario.place_name)
    side = choose_side(
        [("option", request.side), ("attribute", side_of_place), ("lanes", side_driven_on(lanes))], quality
    )
    beside = furniture_rows(scenario, lanes, request.offset, quality)
    nation = scenario.dataset.nation_of(scenario.place_name)
    return map_from_bounds(
        source, request, lanes, beside, quality, map_format="scenarionet", side_and_source=side, nation=nation
    )


def _stations_on(lane: CentreLine, places: Floats) -> Floats:
    line = shapely.LineString(lane.line)
    return np.asarray(shapely.line_locate_point(line, shapely.points(places)), np.float64)


def _bounded_lanes(centres: Mapping[str, CentreLine], scenario: Scenario, quality: MapQuality) -> list[BoundedLane]:
    """Return the lanes with their bounds; report lanes without a known width in `quality`."""
    lanes, beside = [], find_neighbours(centres)
    for name, lane in centres.items():
        if np.isnan(lane.bound_distances).any():
            message = (
                f"lane {name} is left out: neither it nor the lanes that it joins have bounds, so its width is unknown"
            )
            quality.add("invalid_lane", "error", name, message)
            continue
        lanes.append(
            BoundedLane(
                name,
                *lane.bounds,
                lane.kind,
                lane.kind == "driving",
                road_type="motorway" if lane.feature.get("type") == "LANE_FREEWAY" else None,
                successors=lane.successors,
                limit_source="lane",
                marks=_markings_of_sides(lane, scenario) if scenario.dataset.markings else (),
                limits=_speed_limit_spans(lane) if scenario.dataset.speed_limits else (),
                **beside[name]._asdict(),
            )
        )
    return lanes


def _markings_of_sides(lane: CentreLine, scenario: Scenario) -> tuple[Mark, ...]:
    """Return the marks of the lines that a lane names, each on its part of the lane; the marking of a side without lines is unknown."""
    marks = []
    for side, at, name in named_boundary_spans(lane):
        if not at.any():
            continue
        begin, end = (float(lane.s[at][k] / lane.s[-1]) for k in (0, -1))
        if end > begin:
            word = str(scenario.features.get(name, {}).get("type"))
            marking = next(
                (marking for part, marking in _MARKING_BY_LINE_TYPE.items() if word.startswith(f"ROAD_LINE_{part}_")),
                None,
            )
            marks.append(Mark(("left", "right")[side], begin, end, marking))
    sides = {mark.side for mark in marks}
    marks += [Mark(side, 0.0, 1.0, None) for side in ("left", "right") if side not in sides]
    return tuple(sorted(marks, key=lambda mark: (mark.side, mark.begin)))


def _speed_limit_spans(lane: CentreLine) -> tuple[tuple[float, float, float | None], ...]:
    for key, unit in (("speed_limit_mph", _MPS_PER_MPH), ("speed_limit_kmh", _MPS_PER_KMH)):
        limit = _number_or_zero(lane.feature.get(key)) * unit
        if 0.0 < limit < _HIGHEST_LIMIT_MPS:
            return ((0.0, 1.0, limit),)
    return ()


def _number_or_zero(value: Any) -> float:
    try:
        number = number_array(value, "a number")
    except PickleError:
        return 0.0
    return float(number) if number.size == 1 else 0.0


def _report_assumed_widths(
    centres: Mapping[str, CentreLine], assumed_shares: Mapping[str, float], quality: MapQuality
) -> None:
    """Report how many lanes have an assumed width, and on which share of their sides."""
    of = {name: share for name, share in assumed_shares.items() if np.isfinite(centres[name].bound_distances).all()}
    if of:
        whole = sum(float(lane.s[-1]) for lane in centres.values())
        part = sum(share * float(centres[name].s[-1]) for name, share in of.items())
        message = (
            f"along {part / whole:.0%} of the lanes' sides ({len(of)} of {len(centres)} lanes) the edge of the lane is not known: "
            "the lane is assumed to be as wide as the lanes that it joins, or as on its other side"
        )
        quality.add("assumed_width", "info", None, message, len(of))
