"""Builds lanes from their two bounds (Lanelet2, CommonRoad, OSI, Argoverse), whose points are in the direction of travel.

Such maps have no roads: lanes side by side are grouped as one road, and numbered from its middle outwards.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyarrow as pa
import shapely

from drivelint.arrays import words_of_codes
from drivelint.road import driving_side
from drivelint.road.lane_geometry import LaneGeometry, UnbuildableError, check_bounds, lane_geometry
from drivelint.road.tables import Rows, crossing_row, map_tables

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.arrays import Floats
    from drivelint.road.geo_reference import GeoFrame
    from drivelint.road.map_reader import MapOptions, MapSource, MapTables
    from drivelint.road.quality import MapQuality


class Mark(NamedTuple):
    """The marking of one side of a lane between two shares (0 to 1) of the lane's length. None: unknown."""

    side: str
    begin: float
    end: float
    marking: str | None
    lane_change: str | None = None
    color: str | None = None


SpeedLimitSpan = tuple[float, float, float | None]


def both_marks(left: str | None, right: str | None) -> tuple[Mark, Mark]:
    """Return the marks of a lane with the same markings along its whole length."""
    return Mark("left", 0.0, 1.0, left), Mark("right", 0.0, 1.0, right)


@dataclass(eq=False)
class BoundedLane:
    """One lane. Fields that are not explained here are as in the table `lanelet`.

    `left`, `right`: bounds (n, 2), (m, 2) in metres, in the direction of travel. `left_against`, `right_against`: the lane on that side has
    the opposite direction. `marks`: empty if the markings are unknown. `limits`: start and end (shares of the length) and m/s (None: no
    limit, or an unreadable one); empty if the map states none. `limit_source`: the column `source` of `speed_limit`. `z`: the height of
    each point of `line`, NaN: unknown.
    """

    lanelet_id: str
    left: Floats
    right: Floats
    kind: str = "driving"
    drivable: bool = True
    bidirectional: bool = False
    road_type: str | None = None
    junction_id: str | None = None
    successors: tuple[str, ...] = ()
    left_id: str | None = None
    left_against: bool | None = None
    right_id: str | None = None
    right_against: bool | None = None
    limit_source: str = "sign"
    marks: tuple[Mark, ...] = ()
    limits: tuple[SpeedLimitSpan, ...] = ()
    road_id: str = ""
    lane_no: int = 0
    along: int = 1
    line: LaneGeometry = field(init=False)
    z: Floats = field(init=False)

    @property
    def road_s(self) -> Floats:
        """The stations of the lane's points along the road."""
        return self.line.s if self.along > 0 else self.line.s[-1] - self.line.s


def build_lanes(lanes: Iterable[BoundedLane], offset: tuple[float, float], quality: MapQuality) -> list[BoundedLane]:
    """Build the lanes and return them sorted by id; a lane that cannot be built is left out and reported in `quality`."""
    built: dict[str, BoundedLane] = {}
    for lane in sorted(lanes, key=lambda lane: _lane_sort_key(lane.lanelet_id)):
        try:
            lane.line = lane_geometry(lane.left + offset, lane.right + offset)
            lane.z = np.full(len(lane.line.s), np.nan)
        except UnbuildableError as error:
            quality.add("invalid_lane", "error", lane.lanelet_id, f"lanelet {lane.lanelet_id} is left out: {error}")
            continue
        built[lane.lanelet_id] = lane
    for lane in built.values():
        lacking = [name for name in lane.successors if name not in built]
        if lacking:
            message = f"lanelet {lane.lanelet_id} leads to {', '.join(lacking)}, which the map does not contain"
            quality.add("missing_link", "warning", lane.lanelet_id, message, len(lacking))
        lane.successors = tuple(name for name in lane.successors if name in built)
        if lane.left_id not in built:
            lane.left_id = lane.left_against = None
        if lane.right_id not in built:
            lane.right_id = lane.right_against = None
    _group_into_roads(built)
    return list(built.values())


def _lane_sort_key(name: str) -> tuple[int, int, str]:
    """Return the sort key of a name: names that are numbers come first, in the order of the numbers."""
    return (0, int(name), name) if name.isdecimal() else (1, 0, name)


def _group_into_roads(lanes: Mapping[str, BoundedLane]) -> None:
    """Group lanes side by side as one road, and number them: -1, -2, ... to the right of its middle, 1, 2, ... to the left."""
    for first in lanes.values():
        if first.road_id:
            continue
        row = _row_of_lanes_with_directions(first, lanes)
        name = f"r{first.lanelet_id}"
        rightmost_left = max((i for i, (_, along) in enumerate(row) if along < 0), default=-1)
        for i, (lane, along) in enumerate(row):
            lane.road_id, lane.along = name, along
            lane.lane_no = rightmost_left - i if i > rightmost_left else rightmost_left - i + 1


def _row_of_lanes_with_directions(
    first: BoundedLane, lanes: Mapping[str, BoundedLane]
) -> list[tuple[BoundedLane, int]]:
    """Return the lanes side by side with `first`, from left to right in its direction; 1: same direction, -1: opposite."""
    row, lane_ids = [(first, 1)], {first.lanelet_id}
    for step in (1, -1):
        lane, along = first, 1
        while True:
            to_left = (step < 0) == (along > 0)
            name = lane.left_id if to_left else lane.right_id
            against = lane.left_against if to_left else lane.right_against
            if name is None or name in lane_ids or name not in lanes or lanes[name].road_id:
                break
            lane, along = lanes[name], -along if against else along
            lane_ids.add(name)
            row.insert(0, (lane, along)) if step < 0 else row.append((lane, along))
    return row


def map_from_bounds(
    source: MapSource,
    request: MapOptions,
    lanes: Sequence[BoundedLane],
    furniture: Mapping[str, Rows],
    quality: MapQuality,
    *,
    map_format: str,
    side_and_source: tuple[str, str],
    geo: GeoFrame | None = None,
    nation: str | None = None,
) -> MapTables:
    """Return the map of lanes from `build_lanes`. `furniture`: table -> rows, such as signals. Other parameters: see `map_tables`."""
    by_id = {lane.lanelet_id: lane for lane in lanes}
    content: dict[str, Rows | dict[str, Any]] = {
        "lanelet": [_lanelet_row(lane) for lane in lanes],
        "lane_point": lane_point_columns(lanes),
        "lane_link": [
            {"from_id": lane.lanelet_id, "to_id": to, "turn_rad": by_id[to].line.turn_rad}
            for lane in lanes
            for to in sorted(set(lane.successors))
        ],
        "lane_boundary": [
            {
                "lanelet_id": lane.lanelet_id, "side": mark.side, "marking": mark.marking, "color": mark.color,
                "s_start_m": mark.begin * lane.line.length, "s_end_m": mark.end * lane.line.length, "lane_change": mark.lane_change,
            }
            for lane in lanes
            for mark in lane.marks or both_marks(None, None)
        ],
        "speed_limit": [
            {
                "lanelet_id": lane.lanelet_id, "limit_mps": limit, "source": lane.limit_source,
                "s_start_m": begin * lane.line.length, "s_end_m": end * lane.line.length,
            }
            for lane in lanes
            for begin, end, limit in lane.limits
        ],
        "road_object": [],
        **furniture,
    }  # fmt: skip
    return map_tables(
        source,
        request,
        content,
        quality,
        map_format=map_format,
        side_and_source=side_and_source,
        geo=geo,
        nation=nation,
    )


def signal_row(lane: BoundedLane, s_m: float, place: Floats, **columns: Any) -> dict[str, Any]:
    """Return a row of `traffic_signal`. `s_m`: where it applies on the lane; `place`: its x and y; `columns`: more columns."""
    return {
        "country": None, "type": None, "subtype": None, "value": None, "unit": None, "dynamic": False, "turns": None, **columns,
        "road_id": lane.road_id, "road_s_m": s_m if lane.along > 0 else lane.line.length - s_m,
        "lanelet_id": lane.lanelet_id, "lane_s_m": s_m, "x_m": float(place[0]), "y_m": float(place[1]),
    }  # fmt: skip


def _lanelet_row(lane: BoundedLane) -> dict[str, Any]:
    return {
        "lanelet_id": lane.lanelet_id, "road_id": lane.road_id, "section": 0, "lane_no": lane.lane_no,
        "lane_type": lane.kind, "drivable": lane.drivable, "bidirectional": lane.bidirectional,
        "along_road": lane.along, "junction_id": lane.junction_id, "road_type": lane.road_type,
        "length_m": lane.line.length, "width_m": lane.line.width, "area_m2": lane.line.area,
        "left_id": lane.left_id, "left_against": lane.left_against,
        "right_id": lane.right_id, "right_against": lane.right_against,
    }  # fmt: skip


def lane_point_columns(lanes: Sequence[Any]) -> dict[str, Any]:
    """Return the columns of `lane_point`.

    Each lane has `lanelet_id`, `line`, `road_s` (stations on its road) and `z` (heights, NaN: unknown).
    """
    counts = [len(lane.line.s) for lane in lanes]
    columns: dict[str, Any] = {
        "s_m": np.concatenate([lane.line.s for lane in lanes]),
        "half_width_m": np.concatenate([lane.line.half_width for lane in lanes]),
        "road_s_m": np.concatenate([lane.road_s for lane in lanes]),
        "z_m": pa.array(np.concatenate([lane.z for lane in lanes]), pa.float64(), from_pandas=True),
        "k": np.concatenate([np.arange(n, dtype=np.int32) for n in counts]),
        "lanelet_id": words_of_codes(
            np.repeat(np.arange(len(lanes), dtype=np.int32), counts), [lane.lanelet_id for lane in lanes]
        ),
    }
    for attribute, x, y in (
        ("centre", "x_m", "y_m"),
        ("tangent", "tx", "ty"),
        ("left", "left_x_m", "left_y_m"),
        ("right", "right_x_m", "right_y_m"),
    ):
        columns[x], columns[y] = np.vstack([getattr(lane.line, attribute) for lane in lanes]).T
    return columns


def side_driven_on(lanes: Sequence[BoundedLane]) -> str | None:
    """Return the driving side (lht, rht) by neighbouring lanes of opposite direction; None: there are none.

    In left-hand traffic, the oncoming lane is on the right. If the map states no neighbours, the geometry is used.
    """
    one_way = {lane.lanelet_id: lane for lane in lanes if lane.drivable and not lane.bidirectional}
    left = sum(lane.left_against is True and lane.left_id in one_way for lane in one_way.values())
    right = sum(lane.right_against is True and lane.right_id in one_way for lane in one_way.values())
    if left != right:
        return "rht" if left > right else "lht"
    outside = [lane.line for lane in one_way.values() if lane.junction_id is None]
    return driving_side.side_driven_on([line.points_with_half_widths(np.full(len(line.s), np.nan)) for line in outside])


def crossings(
    pedestrian_lanes: Iterable[BoundedLane],
    lanes: Sequence[BoundedLane],
    offset: tuple[float, float],
    quality: MapQuality,
) -> Rows:
    """Return the rows of `crossing`: one for each pair of a pedestrian lane (`pedestrian_lanes`) and a drivable lanelet that it crosses.

    A pedestrian lane that crosses no lanelet, or has no valid shape, is reported in `quality`.
    """
    drivable_lanes = [lane for lane in lanes if lane.drivable]
    lines = [shapely.LineString(lane.line.centre) for lane in drivable_lanes]
    tree = shapely.STRtree(lines)
    rows = []
    for walk in pedestrian_lanes:
        try:
            check_bounds(walk.left, walk.right)
        except UnbuildableError as error:
            message = f"crossing {walk.lanelet_id} is left out: {error}"
            quality.add("invalid_lane", "error", walk.lanelet_id, message)
            continue
        kind = "zebra" if walk.kind == "zebra" else None
        area = shapely.Polygon(np.vstack([walk.right, walk.left[::-1]]) + offset).buffer(0.0)
        crossed = tree.query(area, predicate="intersects")
        if not len(crossed):
            message = f"crossing {walk.lanelet_id} lies across no lane that vehicles drive on"
            quality.add("object_without_lane", "info", None, message)
        for i in crossed:
            common = shapely.get_coordinates(shapely.intersection(area, lines[i]))
            s = shapely.line_locate_point(lines[i], shapely.points(common))
            rows.append(crossing_row(walk.lanelet_id, drivable_lanes[i].lanelet_id, s, kind))
    return sorted(rows, key=lambda r: (r["crossing_id"], r["lanelet_id"]))
