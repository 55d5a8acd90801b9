"""The furniture of a Lanelet2 map: lights, signs, stop lines and crossings."""

from __future__ import annotations

import re
from collections import defaultdict
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from drivelint.formats.lanelet2.file import attribute, line_points
from drivelint.formats.lanelet2.traffic_rules import is_dynamic
from drivelint.road.boundary_lanes import BoundedLane, crossings, signal_row
from drivelint.road.signcodes import signal_kind
from drivelint.road.tables import Rows, stop_line_row

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from drivelint.arrays import Floats
    from drivelint.road.quality import MapQuality


STOP_LINE_TOLERANCE_M = 1.0  # a stop line that misses the end of a lane by less than this lies between two lanes
_NATIONAL_SIGN_CODE = re.compile(r"([a-z]{2})(\d.*)")  # a code of a national catalogue, as in de274-60


def furniture_rows(
    layers: Any, lanes: Sequence[BoundedLane], offset: tuple[float, float], quality: MapQuality
) -> dict[str, Rows]:
    """Return rows of `traffic_signal`, `stop_line` and `crossing`."""
    return {
        "traffic_signal": _signal_rows(layers, lanes, offset),
        "stop_line": _stop_line_rows(layers, lanes, offset, quality),
        "crossing": crossings(_crosswalks(layers, lanes), lanes, offset, quality),
    }


def _signal_rows(layers: Any, lanes: Sequence[BoundedLane], offset: tuple[float, float]) -> Rows:
    """Return a row for each lane and each of its regulatory elements that is a light, a right of way or a sign.

    The element applies at its stop line, else at the end of the lane.
    """
    by_id = {lane.lanelet_id: lane for lane in lanes}
    rows = []
    for x in sorted(layers.laneletLayer, key=lambda x: x.id):
        lane = by_id.get(str(x.id))
        if lane is None:
            continue
        for element in sorted(x.regulatoryElements, key=lambda r: r.id):
            s = _signal_station(element, lane, offset)
            place = np.array([np.interp(s, lane.line.s, c) for c in lane.line.centre.T])
            columns = {"country": attribute(x, "region") or None, "type": attribute(element, "subtype")}
            rows += [
                signal_row(
                    lane,
                    s,
                    place,
                    signal_id=str(element.id),
                    kind=kind,
                    **columns,
                    dynamic=kind == "traffic_light" or is_dynamic(element),
                )
                for kind in _signal_kinds(element, x)
            ]
    return rows


def _signal_station(element: Any, lane: BoundedLane, offset: tuple[float, float]) -> float:
    """Return the station on a lane at which a regulatory element applies."""
    for line in sorted((x for x in _parameter_members(element, "ref_line") if len(x) > 1), key=lambda x: x.id):
        at = _station_where_crossed(lane, line_points(line) + offset)
        if at is not None:
            return at
    return lane.line.length


def _signal_kinds(element: Any, lanelet: Any) -> list[str]:
    """Return the kinds of signals that a regulatory element is for a lanelet, each once."""
    subtype = attribute(element, "subtype")
    if subtype == "right_of_way":
        yields = {x.id for x in _parameter_members(element, "yield")}
        return ["give_way" if lanelet.id in yields else "priority_here"]
    if subtype == "all_way_stop":
        return ["stop"]
    if subtype == "traffic_sign":
        signs = _parameter_members(element, "refers")
        return sorted({kind for sign in signs if (kind := _sign_kind(attribute(sign, "subtype"))) is not None})
    return [subtype] if subtype == "traffic_light" else []


def _sign_kind(word: str) -> str | None:
    """Return the kind of a sign by its subtype: a national code, as de206, or a word, as stop_sign (Autoware)."""
    code = _NATIONAL_SIGN_CODE.fullmatch(word.lower())
    return signal_kind(code[1], code[2], "") if code else signal_kind("", "", word)


def _parameter_members(element: Any, role: str) -> Any:
    return element.parameters[role] if role in element.parameters else ()  # noqa: SIM401 - the library's maps have no get


def _station_where_crossed(lane: BoundedLane, line: Floats, tolerance_m: float = STOP_LINE_TOLERANCE_M) -> float | None:
    """Return the station (m) at which a line (n, 2) crosses a lane's centre line; None if it does not cross it.

    A line that misses an end of the centre line by less than `tolerance_m` crosses it at this end.
    """
    if not np.isfinite(line).all():
        return None
    across, centre = shapely.LineString(line), shapely.LineString(lane.line.centre)
    if not shapely.dwithin(across, centre, tolerance_m):
        return None
    common = shapely.get_coordinates(shapely.intersection(across, centre))
    if len(common):
        return float(np.mean(shapely.line_locate_point(centre, shapely.points(common))))
    s = float(shapely.line_locate_point(centre, shapely.Point(shapely.shortest_line(centre, across).coords[0])))
    return s if s in {0.0, centre.length} else None


def _stop_line_rows(
    layers: Any, lanes: Sequence[BoundedLane], offset: tuple[float, float], quality: MapQuality
) -> Rows:
    """Return a row for each stop line and drivable lane to which it applies.

    A line applies to the lanes that it crosses and that refer to it by a regulatory element; without such lanes, to all lanes
    that it crosses. A line between two lanes is placed at the end of the first.
    """
    drivable_lanes = [lane for lane in lanes if lane.drivable]
    tree = shapely.STRtree([shapely.LineString(lane.line.centre) for lane in drivable_lanes])
    referring = _lanes_by_stop_line(layers)
    rows = []
    for line in sorted(layers.lineStringLayer, key=lambda x: x.id):
        points = line_points(line) + offset
        if attribute(line, "type") != "stop_line" or len(line) < 2 or not np.isfinite(points).all():
            continue
        near = [drivable_lanes[i] for i in sorted(tree.query(shapely.LineString(points).buffer(STOP_LINE_TOLERANCE_M)))]
        own_stations = [
            (lane, s)
            for lane in near
            if lane.lanelet_id in referring[line.id] and (s := _station_where_crossed(lane, points)) is not None
        ]
        lane_stations = own_stations or [
            (lane, s) for lane in near if (s := _station_where_crossed(lane, points, tolerance_m=0.0)) is not None
        ]
        followers = {name for lane, _ in lane_stations for name in lane.successors}
        rows += [
            stop_line_row(str(line.id), lane.lanelet_id, s)
            for lane, s in lane_stations
            if s > 0.0 or lane.lanelet_id not in followers
        ]
        if not lane_stations:
            message = f"stop line {line.id} lies across no lane that vehicles drive on"
            quality.add("object_without_lane", "info", None, message)
    return sorted(rows, key=lambda r: (r["stop_line_id"], r["lanelet_id"]))


def _lanes_by_stop_line(layers: Any) -> dict[int, set[str]]:
    """Return stop line -> the lanes that refer to it by a regulatory element."""
    lane_ids: dict[int, set[str]] = defaultdict(set)
    for x in layers.laneletLayer:
        for element in x.regulatoryElements:
            for line in _parameter_members(element, "ref_line"):
                lane_ids[line.id].add(str(x.id))
    return lane_ids


def _crosswalks(layers: Any, lanes: Sequence[BoundedLane]) -> Iterator[BoundedLane]:
    """Yield the crosswalks, except those that their tags make lanes."""
    lane_ids = {lane.lanelet_id for lane in lanes}
    for x in sorted(layers.laneletLayer, key=lambda x: x.id):
        if attribute(x, "subtype") == "crosswalk" and str(x.id) not in lane_ids:
            marks = {attribute(bound, "type") for bound in (x.leftBound, x.rightBound)}
            kind = "zebra" if "zebra_marking" in marks else "crossing"
            yield BoundedLane(str(x.id), line_points(x.leftBound), line_points(x.rightBound), kind)
