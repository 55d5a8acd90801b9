"""Builds the ground truth of roads with logical lanes, signs, lights and road markings."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.osi.map_trace import Trace

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from drivelint.road.map_reader import MapTables

AHEAD, BACK, BOTH = 2, 3, 4


def straight(s: float, t: float) -> tuple[float, float]:
    return s, t


class Road(Trace):
    """Collects a ground truth; `place` turns s and t of the reference line 9 into x and y, `z` is its height."""

    def __init__(self, place: Callable[[float, float], tuple[float, float]] = straight, z: float = 0.0) -> None:
        super().__init__()
        self.place, self.z = place, z
        self.truth.reference_line.add().id.value = 9

    def edge(
        self,
        name: int,
        t: float,
        begin: float = 0.0,
        end: float = 100.0,
        *,
        physical: Sequence[int] = (),
        rule: int = 0,
    ) -> None:
        """Add a logical boundary along the reference line."""
        bound = self.truth.logical_lane_boundary.add()
        bound.id.value, bound.reference_line_id.value, bound.passing_rule = name, 9, rule
        for s in np.linspace(begin, end, 5).tolist():
            point = bound.boundary_line.add()
            point.s_position = s
            point.position.x, point.position.y = self.place(s, t)
            point.position.z = self.z
        for number in physical:
            bound.physical_boundary_id.add().value = number

    def logical(
        self, name: int, left: Sequence[int], right: Sequence[int], way: int = AHEAD, *, kind: int = 2,
        span: tuple[float, float] = (0.0, 100.0), on: Sequence[int] = (),
        beside: tuple[Sequence[int], Sequence[int]] = ((), ()), before: Sequence[int] = (), after: Sequence[int] = (),
    ) -> Any:  # fmt: skip
        """Add a logical lane; `left` and `right` are boundaries, `on` physical lanes, as seen along the reference line."""
        lane = self.truth.logical_lane.add()
        lane.id.value, lane.type, lane.move_direction, lane.reference_line_id.value = name, kind, way, 9
        lane.start_s, lane.end_s = span
        for field, names in ((lane.left_boundary_id, left), (lane.right_boundary_id, right)):
            for number in names:
                field.add().value = number
        for field, names in ((lane.left_adjacent_lane, beside[0]), (lane.right_adjacent_lane, beside[1])):
            for number in names:
                relation = field.add()
                relation.other_lane_id.value, relation.start_s, relation.end_s = number, *span
        for field, names in ((lane.predecessor_lane, before), (lane.successor_lane, after)):
            for number in names:
                field.add().other_lane_id.value = number
        for number in on:
            lane.physical_lane_reference.add().physical_lane_id.value = number
        return lane

    def marking(
        self, name: int, at: tuple[float, float, float], yaw: float = 0.0, *, width: float = 3.2, kind: int = 3,
        sign: int = 17, lanes: Sequence[int] = (), logical: Sequence[int] = (), length: float = 0.3,
    ) -> Any:  # fmt: skip
        """Add a road marking that lies flat, readable for whoever drives towards `yaw`."""
        mark = self.truth.road_marking.add()
        mark.id.value = name
        mark.base.position.x, mark.base.position.y, mark.base.position.z = at
        mark.base.dimension.length, mark.base.dimension.width, mark.base.dimension.height = 0.01, width, length
        # x points to the sky and z, which is upwards on the picture, in the direction of travel
        mark.base.orientation.pitch, mark.base.orientation.yaw = -math.pi / 2, yaw + math.pi
        mark.classification.type, mark.classification.traffic_main_sign_type = kind, sign
        assign(mark.classification, lanes, logical)
        return mark

    def sign(
        self, name: int, at: tuple[float, float, float], kind: int, *, yaw: float = math.pi, value: float = 0.0,
        unit: int = 0, lanes: Sequence[int] = (), logical: Sequence[int] = (),
    ) -> Any:  # fmt: skip
        """Add a traffic sign that faces `yaw`."""
        sign = self.truth.traffic_sign.add()
        sign.id.value = name
        main = sign.main_sign
        main.base.position.x, main.base.position.y, main.base.position.z = at
        main.base.orientation.yaw = yaw
        main.classification.type = kind
        if value:
            main.classification.value.value, main.classification.value.value_unit = value, unit
        assign(main.classification, lanes, logical)
        return sign

    def bulb(
        self, name: int, at: tuple[float, float, float], icon: int = 2, *, lanes: Sequence[int] = (),
        logical: Sequence[int] = (), reference: tuple[str, str] | None = None,
    ) -> Any:  # fmt: skip
        """Add one bulb of a traffic light."""
        light = self.truth.traffic_light.add()
        light.id.value, light.classification.icon = name, icon
        light.base.position.x, light.base.position.y, light.base.position.z = at
        assign(light.classification, lanes, logical)
        if reference is not None:
            source = light.source_reference.add()
            source.type = reference[0]
            source.identifier.append(reference[1])
        return light

    def load(self, **options: Any) -> MapTables:
        """Return the map of it, as the reader of the trace hands it over."""
        beside = type(self.truth).FromString(self.truth.SerializeToString())
        lanes = type(self.truth)()
        for field in ("lane_boundary", "lane", "reference_line", "logical_lane_boundary", "logical_lane"):
            getattr(lanes, field).extend(getattr(self.truth, field))
            beside.ClearField(field)
        content = lanes.SerializeToString(deterministic=True) + beside.SerializeToString(deterministic=True)
        return load_map(MapSource("embedded", content), **options)


def assign(classification: Any, lanes: Sequence[int], logical: Sequence[int]) -> None:
    for number in lanes:
        classification.assigned_lane_id.add().value = number
    for number in logical:
        classification.logical_lane_assignment.add().assigned_lane_id.value = number


def two_way(**options: Any) -> Road:
    """Lanes 1 (to the right, along +s) and 2 (against it) with a footway 3 on the right; 3.5 m and 1.5 m wide, 100 m long."""
    road = Road(**options)
    for number, kind in ((61, 3), (62, 4), (63, 12)):
        road.bound(number, [(0.0, 0.0), (100.0, 0.0)], kind)
    road.edge(11, 3.5, physical=[61])
    road.edge(12, 0.0, physical=[62, 61], rule=4)
    road.edge(13, -3.5, physical=[63], rule=2)
    road.edge(14, -5.0)
    road.logical(1, [12], [13], beside=([2], [3]))
    road.logical(2, [11], [12], BACK, beside=([], [1]))
    road.logical(3, [13], [14], 0, kind=4, beside=([1], []))
    return road
