"""An OSI trace that carries lanes."""

from __future__ import annotations

from typing import Any

from drivelint.formats import load_map
from drivelint.formats.osi.schema import message_class
from drivelint.road.map_reader import MapSource, MapTables


def points(field: Any, line: list[tuple[float, float]]) -> None:
    for x, y in line:
        point = field.add()
        point = getattr(point, "position", point)
        point.x, point.y = x, y


class Trace:
    """Collects lanes of one ground truth."""

    def __init__(self) -> None:
        self.truth = message_class("GroundTruth")()

    def bound(self, name: int, line: list[tuple[float, float]], kind: int = 3) -> None:
        bound = self.truth.lane_boundary.add()
        bound.id.value, bound.classification.type = name, kind
        points(bound.boundary_line, line)

    def lane(
        self, name: int, middle: list[tuple[float, float]], *, left: int | tuple[int, ...] = 0, right: int | tuple[int, ...] = 0,
        ahead: bool | None = True, kind: int = 2, subtype: int = 2, pairs: tuple[tuple[int | None, int | None], ...] = (),
        beside: tuple[int, int] = (0, 0),
    ) -> None:  # fmt: skip
        lane = self.truth.lane.add()
        lane.id.value = name
        said = lane.classification
        said.type, said.subtype = kind, subtype
        if ahead is not None:
            said.centerline_is_driving_direction = ahead
        points(said.centerline, middle)
        for field, value in (
            (said.left_lane_boundary_id, left), (said.right_lane_boundary_id, right),
            (said.left_adjacent_lane_id, beside[0]), (said.right_adjacent_lane_id, beside[1]),
        ):  # fmt: skip
            for number in (value,) if isinstance(value, int) else value:
                if number:
                    field.add().value = number
        for before, after in pairs:
            pair = said.lane_pairing.add()
            if before is not None:
                pair.antecessor_lane_id.value = before
            if after is not None:
                pair.successor_lane_id.value = after

    def load(self, **options: Any) -> MapTables:
        kept = message_class("GroundTruth")()
        kept.lane.extend(self.truth.lane)
        kept.lane_boundary.extend(self.truth.lane_boundary)
        return load_map(MapSource("embedded", kept.SerializeToString(deterministic=True)), **options)
