"""The furniture of a scenario: its lights, stop signs and crossings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import shapely

from drivelint.formats.scenarionet.pickled_numpy import PickleError
from drivelint.formats.scenarionet.scenario import number_array, point_array
from drivelint.road.boundary_lanes import signal_row
from drivelint.road.lane_geometry import LARGEST_COORDINATE_M
from drivelint.road.tables import crossing_row

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.arrays import Floats
    from drivelint.formats.scenarionet.scenario import Scenario
    from drivelint.road.boundary_lanes import BoundedLane
    from drivelint.road.quality import MapQuality
    from drivelint.road.tables import Rows

_LARGEST_SIGN_DISTANCE_M: Final = 30.0  # a stop sign farther from its lane's centre line belongs to another lane


def furniture_rows(
    scenario: Scenario, lanes: Sequence[BoundedLane], offset: tuple[float, float], quality: MapQuality
) -> dict[str, Rows]:
    """Return rows of `traffic_signal`, `stop_line` and `crossing`; report signals and crossings without a lane in `quality`."""
    by_id = {lane.lanelet_id: lane for lane in lanes}
    signals = [*_light_rows(scenario, by_id, offset, quality), *_stop_sign_rows(scenario, by_id, offset, quality)]
    return {
        "traffic_signal": sorted(signals, key=lambda row: (row["signal_id"], row["lanelet_id"])),
        "stop_line": [],
        "crossing": _crossing_rows(scenario, lanes, offset, quality),
    }


def _light_rows(
    scenario: Scenario, lanes: Mapping[str, BoundedLane], offset: tuple[float, float], quality: MapQuality
) -> Rows:
    """Return a row for each light. Its id is that of its states; it applies at its stop point, else at the start of the lane."""
    rows, lost_names = [], []
    for name, light in scenario.lights.items():
        lane = lanes.get(str(light.get("lane", name)))
        if lane is None:
            lost_names.append(name)
            continue
        place = _place_on_map(light.get("stop_point"), offset) if scenario.dataset.stop_points else None
        s = 0.0 if place is None else lane.line.station(place)
        where = lane.line.centre[0] if place is None else place
        rows.append(signal_row(lane, s, where, signal_id=name, kind="traffic_light", dynamic=True))
    _report_signals_without_lane(lost_names, "lights", quality)
    return rows


def _stop_sign_rows(
    scenario: Scenario, lanes: Mapping[str, BoundedLane], offset: tuple[float, float], quality: MapQuality
) -> Rows:
    rows, lost_names = [], []
    for name, feature in scenario.features.items():
        if str(feature.get("type")) != "STOP_SIGN":
            continue
        place = _place_on_map(feature.get("position"), offset)
        lanes_of_sign = feature.get("lane")
        lanes_of_sign = (
            [lanes[str(i)] for i in lanes_of_sign if str(i) in lanes]
            if isinstance(lanes_of_sign, (list, tuple))
            else []
        )
        near = [
            lane
            for lane in lanes_of_sign
            if place is not None and _distance_to_lane_m(lane, place) <= _LARGEST_SIGN_DISTANCE_M
        ]
        if place is None or not near:
            lost_names.append(name)
            continue
        rows += [signal_row(lane, lane.line.station(place), place, signal_id=name, kind="stop") for lane in near]
    _report_signals_without_lane(lost_names, "stop signs", quality)
    return rows


def _distance_to_lane_m(lane: BoundedLane, place: Floats) -> float:
    return float(np.hypot(*(lane.line.centre - place).T).min())


def _place_on_map(value: Any, offset: tuple[float, float]) -> Floats | None:
    """Return x and y of a place, moved by the map's offset; None: it is missing or impossible."""
    try:
        place = number_array(value, "a place").reshape(-1)[:2]
    except PickleError:
        return None
    return place + offset if len(place) == 2 and bool((np.abs(place) < LARGEST_COORDINATE_M).all()) else None


def _report_signals_without_lane(names: list[str], kind: str, quality: MapQuality) -> None:
    if names:
        message = f"{kind} that apply to no lane of the map, or have no position: {', '.join(sorted(names)[:5])}"
        quality.add("signal_without_lane", "warning", None, message, len(names))


def _crossing_rows(
    scenario: Scenario, lanes: Sequence[BoundedLane], offset: tuple[float, float], quality: MapQuality
) -> Rows:
    """Return a row for each crossing and each drivable lane that it crosses."""
    drivable_lanes = [lane for lane in lanes if lane.drivable]
    lines = [shapely.LineString(lane.line.centre) for lane in drivable_lanes]
    tree = shapely.STRtree(lines)
    rows: Rows = []
    for name, feature in scenario.features.items():
        if str(feature.get("type")) != "CROSSWALK":
            continue
        try:
            outline = point_array(feature.get("polygon"), f"map_features[{name[:100]!r}]['polygon']")[:, :2]
        except PickleError:
            outline = np.empty((0, 2))
        if len(outline) < 3 or not (np.abs(outline) < LARGEST_COORDINATE_M).all():
            quality.add("invalid_lane", "error", name, f"crossing {name} is left out: it has no outline")
            continue
        area = shapely.Polygon(outline + offset).buffer(0.0)
        crossed = tree.query(area, predicate="intersects")
        if not len(crossed):
            quality.add(
                "object_without_lane", "info", None, f"crossing {name} lies across no lane that vehicles drive on"
            )
        for i in crossed:
            common = shapely.get_coordinates(shapely.intersection(area, lines[i]))
            s = shapely.line_locate_point(lines[i], shapely.points(common))
            rows.append(crossing_row(name, drivable_lanes[i].lanelet_id, s, None))
    return sorted(rows, key=lambda row: (row["crossing_id"], row["lanelet_id"]))
