"""Reads signs, lights and road markings of an OSI trace, and finds their lanes by the trace's assignments or by place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from drivelint.formats.osi import map_kinds as kinds
from drivelint.formats.osi.schema import LIGHT_REFERENCE, OPEN_DRIVE_REFERENCE
from drivelint.road.boundary_lanes import signal_row
from drivelint.road.sign_conditions import KINDS_WITH_UNREAD_CONDITIONS, add_unread_condition
from drivelint.road.signcodes import signal_kind
from drivelint.road.tables import crossing_row, stop_line_row

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.arrays import Floats
    from drivelint.road.boundary_lanes import BoundedLane
    from drivelint.road.quality import MapQuality

    Row = dict[str, Any]

_LARGEST_HEIGHT_DIFFERENCE_M = 1.0  # largest difference in height between a marking and its lane
_LEAST_CROSSING_SINE = 0.7  # sine of the smallest angle between a stop line and its lane


def read(
    truth: Any,
    lanes: Sequence[BoundedLane],
    logical_by_physical: Mapping[int, Sequence[int]],
    offset: tuple[float, float],
    quality: MapQuality,
) -> dict[str, list[Row]]:
    """Return the rows of the tables traffic_signal, stop_line and crossing.

    `logical_by_physical`: physical lane -> the logical lanes that replace it.
    """
    map_lanes = _MapLanes(lanes, logical_by_physical, np.array(offset))
    signals = [row for sign in truth.traffic_sign for row in _rows_of_sign(sign, map_lanes, quality)]
    signals += [
        row
        for bulbs in _bulbs_by_signal(truth.traffic_light).items()
        for row in _rows_of_light(*bulbs, map_lanes, quality)
    ]
    stops: list[Row] = []
    crossings: list[Row] = []
    for mark in truth.road_marking:
        classification = mark.classification
        if classification.is_out_of_service:
            continue
        symbol = classification.traffic_main_sign_type if classification.type == kinds.SYMBOL_MARKING_TYPE else None
        if not np.isfinite(_box_corners(mark, map_lanes)).all():
            message = f"road marking {mark.id.value} is left out: the log does not state its position"
            quality.add("road_marking_without_place", "warning", None, message)
        elif symbol == kinds.ZEBRA_SIGN_TYPE:
            crossings += _rows_of_zebra_crossing(mark, map_lanes)
        elif symbol == kinds.STOP_SIGN_TYPE or _kind_of_country_code(classification) == "stop_line":
            stops += _rows_of_stop_line(mark, map_lanes, quality)
    return {
        "traffic_signal": sorted(signals, key=lambda r: (r["signal_id"], r["type"] or "", r["lanelet_id"])),
        "stop_line": sorted(stops, key=lambda r: (r["stop_line_id"], r["lanelet_id"])),
        "crossing": sorted(crossings, key=lambda r: (r["crossing_id"], r["lanelet_id"])),
    }


@dataclass(frozen=True)
class _MapLanes:
    """The lanes of the map, with the offset from the log's coordinates to the map's."""

    lanes: Sequence[BoundedLane]
    logical_by_physical: Mapping[int, Sequence[int]]
    offset: Floats

    def map_position(self, base: Any) -> Floats | None:
        """Return the position of an object: x and y on the map, and the height; None if the log does not have it."""
        at = np.array([base.position.x + self.offset[0], base.position.y + self.offset[1], base.position.z])
        return at if base.HasField("position") and np.isfinite(at).all() else None

    def assigned_lanes(self, classification: Any, base: Any) -> list[BoundedLane]:
        """Return the lanes to which a sign, light or marking is assigned; for a replaced physical lane, the logical lanes beside it."""
        by_id = {lane.lanelet_id: lane for lane in self.lanes}
        names = [str(assignment.assigned_lane_id.value) for assignment in classification.logical_lane_assignment]
        lanes = [by_id[name] for name in names if name in by_id]
        if lanes:
            return _distinct_lanes(lanes)
        for ref in classification.assigned_lane_id:
            if ref.value in self.logical_by_physical:
                logical_lanes = [by_id[str(name)] for name in self.logical_by_physical[ref.value] if str(name) in by_id]
                lanes += _lanes_facing_object(base, self._lanes_beside(logical_lanes, self.map_position(base)))
            elif str(ref.value) in by_id:
                lanes.append(by_id[str(ref.value)])
        return _distinct_lanes(lanes)

    def _lanes_beside(self, lanes: list[BoundedLane], position: Floats | None) -> list[BoundedLane]:
        """Return the lanes that are beside a place, or if there are none, the nearest lanes; all if the place is unknown."""
        if position is None:
            return lanes
        place = position[:2]
        ends = {lane.lanelet_id: lane.line.station(place) for lane in lanes}
        inside = [lane for lane in lanes if 0.0 < ends[lane.lanelet_id] < lane.line.s[-1]]
        if inside or not lanes:
            return inside
        away = [float(np.hypot(*(lane.line.centre - place).T).min()) for lane in lanes]
        return [lane for lane, d in zip(lanes, away, strict=True) if d <= min(away) + 1e-6]


def _distinct_lanes(lanes: list[BoundedLane]) -> list[BoundedLane]:
    return sorted({lane.lanelet_id: lane for lane in lanes}.values(), key=lambda lane: lane.lanelet_id)


def _lanes_facing_object(base: Any, lanes: list[BoundedLane]) -> list[BoundedLane]:
    """Return the lanes whose traffic sees the front of a sign, which faces along its x axis; all lanes if there are none."""
    if not np.isfinite([base.orientation.roll, base.orientation.pitch, base.orientation.yaw]).all():
        return lanes
    normal = rotation_matrix(base)[:2, 0]
    if not (base.HasField("orientation") and np.hypot(*normal) >= _LEAST_CROSSING_SINE):
        return lanes
    facing = [lane for lane in lanes if float(np.dot(normal, lane.line.tangent[-1])) < 0]
    return facing or lanes


def rotation_matrix(base: Any) -> Floats:
    """Return the rotation matrix of an object's orientation, from roll, pitch and yaw, applied in this order."""
    roll, pitch, yaw = base.orientation.roll, base.orientation.pitch, base.orientation.yaw
    cr, sr, cp, sp, cy, sy = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def _kind_of_country_code(classification: Any) -> str | None:
    return (
        signal_kind(classification.country, classification.code, "")
        if classification.country and classification.code
        else None
    )


def _rows_of_sign(sign: Any, map_lanes: _MapLanes, quality: MapQuality) -> Iterable[Row]:
    classification, base = sign.main_sign.classification, sign.main_sign.base
    if classification.is_out_of_service:
        return []
    value = classification.value.value if classification.value.value > 0 else None
    row = {
        "signal_id": str(sign.id.value), "kind": kinds.SIGN_KINDS.get(classification.type) or _kind_of_country_code(classification),
        "country": classification.country.lower() or None if classification.code else "osi",
        "type": classification.code or str(classification.type),
        "subtype": classification.sub_code or None, "value": value,
        "unit": None if value is None else kinds.UNITS.get(classification.value.value_unit),
        "dynamic": classification.variability in kinds.CHANGING_VARIABILITIES,
    }  # fmt: skip
    description = f"traffic sign {sign.id.value}"
    lanes = map_lanes.assigned_lanes(classification, base)
    plates = [
        f"type {plate.type}"
        for plate in (supplementary.classification for supplementary in sign.supplementary_sign)
        if plate.type != kinds.NO_PLATE_TYPE and not plate.is_out_of_service
    ]
    if plates and row["kind"] in KINDS_WITH_UNREAD_CONDITIONS:
        for lane in lanes:
            add_unread_condition(quality, lane.lanelet_id, description, ", ".join(plates))
    return _signal_rows(description, row, lanes, map_lanes.map_position(base), quality)


def _bulbs_by_signal(bulbs: Iterable[Any]) -> dict[str, list[Any]]:
    """Return signal id -> its bulbs that are in service. Signal ids are those of the log's signal states."""
    heads: dict[str, list[Any]] = {}
    for bulb in bulbs:
        reference_ids = {ref.type: ref.identifier[0] for ref in reversed(bulb.source_reference) if ref.identifier}
        name = reference_ids.get(OPEN_DRIVE_REFERENCE) or reference_ids.get(LIGHT_REFERENCE) or str(bulb.id.value)
        if not bulb.classification.is_out_of_service:
            heads.setdefault(name, []).append(bulb)
    return heads


def _rows_of_light(signal_id: str, bulbs: Sequence[Any], map_lanes: _MapLanes, quality: MapQuality) -> Iterable[Row]:
    lanes = _distinct_lanes(
        [lane for bulb in bulbs for lane in map_lanes.assigned_lanes(bulb.classification, bulb.base)]
    )
    icons = {int(bulb.classification.icon) for bulb in bulbs}
    arrows = icons - {kinds.LIGHT_ICON_WITHOUT_SYMBOL}
    turns = {turn for icon in arrows or icons for turn in kinds.TURNS_BY_LIGHT_ICON.get(icon, ())}
    row = {
        "signal_id": signal_id,
        "kind": next((kinds.LIGHT_KIND_BY_ICON[icon] for icon in sorted(icons) if icon in kinds.LIGHT_KIND_BY_ICON), None),
        "country": "osi", "dynamic": True, "turns": sorted(turns) if turns and icons <= kinds.TURNS_BY_LIGHT_ICON.keys() else None,
    }  # fmt: skip
    place = next((at for bulb in bulbs if (at := map_lanes.map_position(bulb.base)) is not None), None)
    return _signal_rows(f"traffic light {signal_id}", row, lanes, place, quality)


def _signal_rows(
    description: str, row: Row, lanes: Sequence[BoundedLane], place: Floats | None, quality: MapQuality
) -> Iterable[Row]:
    """Return one row per lane of a signal. If the signal's place is unknown, it is the end of the lane."""
    if not lanes:
        message = f"{description} is assigned to no lane of the map: it is not known to which lanes it applies"
        quality.add("signal_without_lane", "warning", None, message)
    if place is None:
        return [signal_row(lane, float(lane.line.s[-1]), lane.line.centre[-1], **row) for lane in lanes]
    return [signal_row(lane, lane.line.station(place[:2]), place, **row) for lane in lanes]


def _box_corners(mark: Any, map_lanes: _MapLanes) -> Floats:
    """Return the eight corners (8, 2) of a marking's box on the map; NaN if the log does not have place and size."""
    middle = map_lanes.map_position(mark.base)
    size = mark.base.dimension
    half = np.array([size.length, size.width, size.height]) / 2
    angles = mark.base.orientation.roll, mark.base.orientation.pitch, mark.base.orientation.yaw
    if middle is None or not np.isfinite([*half, *angles]).all():
        return np.full((8, 2), np.nan)
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1)
    corners: Floats = (middle[:, None] + rotation_matrix(mark.base) @ (half[:, None] * signs))[:2].T
    return corners


def _lanes_and_stations_under(mark: Any, shape: Any, map_lanes: _MapLanes) -> list[tuple[BoundedLane, float]]:
    """Return the lanes for driving under a painted shape, and the shape's station on each."""
    lane_stations = []
    z = mark.base.position.z
    for lane in map_lanes.lanes:
        common = shapely.intersection(lane.line.polygon, shape)
        if not lane.drivable or common.is_empty:
            continue
        s = lane.line.station(shapely.get_coordinates(common.centroid)[0])
        if abs(float(np.interp(s, lane.line.s, lane.z)) - z) <= _LARGEST_HEIGHT_DIFFERENCE_M:
            lane_stations.append((lane, s))
    return lane_stations


def _rows_of_stop_line(mark: Any, map_lanes: _MapLanes, quality: MapQuality) -> Iterable[Row]:
    """Return a row for each lane that a stop line crosses with half of its length, or on half of the lane's width."""
    corners = _box_corners(mark, map_lanes)
    middle = corners.mean(axis=0)
    way = np.linalg.eigh(np.cov((corners - middle).T))[1][:, -1]  # direction of the outline's longer side
    reach = float(np.abs((corners - middle) @ way).max())
    line = shapely.LineString([middle - way * reach, middle + way * reach])
    lane_ids = {lane.lanelet_id for lane in map_lanes.assigned_lanes(mark.classification, mark.base)}
    upwards = rotation_matrix(mark.base)[:2, 2]
    across: list[tuple[BoundedLane, float, float]] = []
    for lane, s in _lanes_and_stations_under(mark, line, map_lanes):
        tangent = np.array([np.interp(s, lane.line.s, lane.line.tangent[:, k]) for k in (0, 1)])
        width = 2 * float(np.interp(s, lane.line.s, lane.line.half_width))
        enough = shapely.intersection(lane.line.polygon, line).length > 0.5 * min(width, 2 * reach)
        if enough and abs(way[0] * tangent[1] - way[1] * tangent[0]) > _LEAST_CROSSING_SINE:
            across.append((lane, s, float(upwards @ tangent)))
    if lane_ids & {lane.lanelet_id for lane, _, _ in across}:
        across = [entry for entry in across if entry[0].lanelet_id in lane_ids]
    elif any(
        along > _LEAST_CROSSING_SINE for _, _, along in across
    ):  # a symbol is upright for the traffic to which it applies
        across = [entry for entry in across if entry[2] > 0]
    name = str(mark.id.value)
    if not across:
        quality.add("stop_line_without_lane", "warning", None, f"stop line {name} lies across no lane for driving")
    return [stop_line_row(name, lane.lanelet_id, s) for lane, s, _ in across]


def _rows_of_zebra_crossing(mark: Any, map_lanes: _MapLanes) -> Iterable[Row]:
    area = shapely.MultiPoint(_box_corners(mark, map_lanes)).convex_hull
    rows = []
    for lane, _ in _lanes_and_stations_under(mark, area, map_lanes):
        common = shapely.get_coordinates(shapely.intersection(area, shapely.LineString(lane.line.centre)))
        if len(common):
            s = [lane.line.station(point) for point in common]
            rows.append(crossing_row(str(mark.id.value), lane.lanelet_id, s, "zebra"))
    return rows
