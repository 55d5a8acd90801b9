"""One lane of one lane section as points, and the road type, speed limits and road marks along it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drivelint.formats.opendrive.network import DRIVABLE_LANE_TYPES, RoadMark
from drivelint.formats.opendrive.records import record_spans

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.network import Lane, LaneSection, Road, SpeedLimit
    from drivelint.road.lane_geometry import LaneGeometry
    from drivelint.road.tables import Rows

LaneKey = tuple[str, int, int]  # road, section, lane number


def lanelet_id(key: LaneKey) -> str:
    """Return the id of a lane in the tables."""
    return f"{key[0]}.{key[1]}.{key[2]}"


@dataclass(eq=False)
class Lanelet:
    """A lane of a section in the direction of travel: its points `line`, and their attributes as arrays (n,)."""

    key: LaneKey
    lane: Lane
    road: Road
    lane_section: LaneSection
    along: int
    bidirectional: bool
    line: LaneGeometry
    road_s: Floats
    z: Floats
    t: Floats  # of the centre line, in road coordinates
    left: Lanelet | None = None
    right: Lanelet | None = None

    @property
    def lanelet_id(self) -> str:
        """The id, road.section.lane."""
        return lanelet_id(self.key)

    @property
    def drivable(self) -> bool:
        """Whether motor vehicles may drive on the lanelet."""
        return self.lane.kind in DRIVABLE_LANE_TYPES

    def station_at(self, road_s: float) -> float:
        """Return the lanelet station (m) of a road station (m), limited to the lanelet."""
        step = self.along
        return float(np.interp(road_s, self.road_s[::step], self.line.s[::step]))

    def lateral_range(self, road_s: float) -> tuple[float, float]:
        """Return the least and the largest road coordinate t of the lanelet at a road station (m)."""
        s = self.station_at(road_s)
        t, half = (float(np.interp(s, self.line.s, values)) for values in (self.t, self.line.half_width))
        return t - half, t + half

    def lanelet_spans(self, spans: Iterable[tuple[int, float, float]]) -> list[tuple[int, float, float]]:
        """Return spans (index, from, to) of road stations as spans of lanelet stations, in the direction of travel."""
        stations = [(i, self.station_at(a), self.station_at(b)) for i, a, b in spans]
        ordered = [(i, min(a, b), max(a, b)) for i, a, b in stations if abs(b - a) > 1e-6]
        return sorted(ordered, key=lambda r: r[1])

    def mean_width_m(self) -> float:
        """Return the mean distance between the bounds (m)."""
        ds, half = np.diff(self.line.s), self.line.half_width
        return float(((half[:-1] + half[1:]) * ds).sum() / ds.sum()) if ds.sum() > 0 else 0.0


def recorded_limit_rows(lanelet: Lanelet) -> Rows:
    """Return rows of `speed_limit`: the lane's own records, else those of the road type; no row where neither states a limit."""
    rows: Rows = []
    start, end = lanelet.lane_section.start_m, lanelet.lane_section.end_m
    for i, a, b in record_spans((s.start_m for s in lanelet.lane.speeds), start, end):
        if i >= 0 and lanelet.lane.speeds[i].is_stated:
            rows += _rows_of_limit(lanelet, a, b, lanelet.lane.speeds[i], "lane")
            continue
        for j, c, d in record_spans((s.start_m for s in lanelet.road.speeds), a, b):
            if j >= 0 and lanelet.road.speeds[j].is_stated:
                rows += _rows_of_limit(lanelet, c, d, lanelet.road.speeds[j], "road_type")
    return sorted(rows, key=lambda row: float(row["s_start_m"]))


def _rows_of_limit(lanelet: Lanelet, start: float, end: float, speed: SpeedLimit, source: str) -> Rows:
    limit, source_word = speed.limit_mps, source if speed.readable else "unread"
    return [
        {"lanelet_id": lanelet.lanelet_id, "s_start_m": a, "s_end_m": b, "limit_mps": limit, "source": source_word}
        for _, a, b in lanelet.lanelet_spans([(0, start, end)])
    ]


def boundary_rows(lanelet: Lanelet) -> Rows:
    """Return rows of `lane_boundary` for the whole length of both sides; the marking is NULL where the map states none.

    A lane's marks are on its outer edge, those of lane 0 on the centre line. The name of a double line begins with the line
    nearer to this lanelet. (In OpenDRIVE, it begins with the inner line, and on the centre line with the left line.)
    """
    lane_no, along = lanelet.lane.number, lanelet.along
    inside = [
        lane for lane in lanelet.lane_section.lanes if lane.number * lane_no > 0 and abs(lane.number) < abs(lane_no)
    ]
    inner = max(inside, key=lambda lane: abs(lane.number)).marks if inside else lanelet.lane_section.centre_marks
    # double lines on the centre line are named left to right: for lanes left of it, the nearer line comes first
    swap_inner = bool(inside) or lane_no < 0
    outer_side, inner_side = ("left", "right") if (lane_no > 0) == (along > 0) else ("right", "left")
    rows = _mark_rows(lanelet, outer_side, lanelet.lane.marks, swaps_double_lines=False)
    rows += _mark_rows(lanelet, inner_side, inner, swaps_double_lines=swap_inner)
    return sorted(rows, key=lambda row: (str(row["side"]), float(row["s_start_m"])))


_SWAPPED_MARKING = {"solid_broken": "broken_solid", "broken_solid": "solid_broken"}


def _mark_rows(lanelet: Lanelet, side: str, marks: tuple[RoadMark, ...], *, swaps_double_lines: bool) -> Rows:
    rows = []
    spans = record_spans((m.start_m for m in marks), lanelet.lane_section.start_m, lanelet.lane_section.end_m)
    for i, a, b in lanelet.lanelet_spans(spans):
        mark = marks[i] if i >= 0 else RoadMark(0.0, None, None, None)
        marking = _SWAPPED_MARKING.get(mark.marking or "", mark.marking) if swaps_double_lines else mark.marking
        rows.append({
            "lanelet_id": lanelet.lanelet_id, "side": side, "s_start_m": a, "s_end_m": b,
            "marking": marking, "color": mark.color, "lane_change": mark.lane_change,
        })  # fmt: skip
    return rows
