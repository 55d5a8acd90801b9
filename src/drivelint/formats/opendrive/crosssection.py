"""The edges of the lanes of one lane section (or one side of it), and the stations at which they must be sampled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drivelint.formats.opendrive.xml import MalformedError

if TYPE_CHECKING:
    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.network import Lane, LaneSection, Road
    from drivelint.formats.opendrive.planview import ReferenceLine

CHORD_TOLERANCE_M = 0.01  # the largest distance of a bound from the chord between two of its points
MAX_SPACING_M = 5.0  # the largest distance between two points
MIN_SIDEWAYS_STEP_M = 0.01  # a larger step in an edge is kept as a step
MAX_POINTS = 100_000  # per lane section: 100 km in steps of a metre
MAX_EDGE_OFFSET_M = 1000.0  # no lane lies further from its reference line
_SAME_STATION_M = 1e-3  # break points closer than this count as one
_INSIDE_TOLERANCE_M = 1e-6  # a record applies to a section if it begins no further inside than this


@dataclass(frozen=True, eq=False)
class LaneEdges:
    """Lane edges at stations: rows are the lanes' outer edges and lane 0's line, by lane number descending."""

    line: ReferenceLine  # the reference line, (n,)
    t: Floats  # (m, n) offset from it, left positive
    dt: Floats  # (m, n) its slope
    x: Floats  # (m, n)
    y: Floats  # (m, n)


class EdgeEvaluator:
    """Evaluates the lane edges of one lane section."""

    def __init__(self, road: Road, lane_section: LaneSection) -> None:
        self.road, self.lane_section = road, lane_section
        usable = [lane for lane in lane_section.lanes if lane.invalid is None]
        self.left = [lane for lane in usable if lane.number > 0]
        self.right = [lane for lane in usable if lane.number < 0][::-1]
        self.numbers = [*(lane.number for lane in self.left[::-1]), 0, *(lane.number for lane in self.right)]
        self.negative_m: dict[int, float] = {}

    def edges(self, s: Floats, lookup_s: Floats | None = None) -> LaneEdges:
        """Return the edges at stations `s` (n,), ascending. `lookup_s`: the stations at which records and geometries are looked up."""
        if lookup_s is None:
            lookup_s = np.clip(
                s + _INSIDE_TOLERANCE_M,
                self.lane_section.start_m + _INSIDE_TOLERANCE_M,
                self.lane_section.end_m - _INSIDE_TOLERANCE_M,
            )
        line = self.road.plan.evaluate(s, lookup_s)
        centre = self.road.offset.evaluate(s, lookup_s)
        left, right = (
            self._edges_outward(self.left, 1.0, centre, s, lookup_s),
            self._edges_outward(self.right, -1.0, centre, s, lookup_s),
        )
        rows = [*left[::-1], centre, *right]
        t, dt = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
        if not float(np.abs(t).max(initial=0.0)) < MAX_EDGE_OFFSET_M:
            raise MalformedError(
                f"an edge lies {float(np.abs(t).max()):.3g} m from the reference line: at most {MAX_EDGE_OFFSET_M:g} m is possible"
            )
        return LaneEdges(line, t, dt, line.x - line.sin * t, line.y + line.cos * t)

    def _edges_outward(
        self, lanes: list[Lane], side: float, centre: tuple[Floats, Floats], s: Floats, lookup_s: Floats
    ) -> list[tuple[Floats, Floats]]:
        edges = []
        t, dt = centre
        for lane in lanes:
            if lane.widths is not None:
                width, slope = lane.widths.evaluate(s, lookup_s)
            else:
                assert lane.borders is not None  # noqa: S101 - network.py makes sure
                border, slope = lane.borders.evaluate(s, lookup_s)
                # in the standard, borders have the sign of t; some writers write the distance without a sign
                sign = side if border.sum() * side < 0.0 else 1.0
                width, slope = side * (sign * border - t), side * (sign * slope - dt)
            low = float(width.min(initial=0.0))
            if low < 0.0:
                self.negative_m[lane.number] = min(low, self.negative_m.get(lane.number, 0.0))
                width, slope = np.maximum(width, 0.0), np.where(width < 0.0, 0.0, slope)
            t, dt = t + side * width, dt + side * slope
            edges.append((t, dt))
        return edges

    def record_change_stations(self) -> Floats:
        """Return the section's two ends, and every station between them at which a geometry, an offset or a width begins."""
        start, end = self.lane_section.start_m, self.lane_section.end_m
        profiles = [lane.widths or lane.borders for lane in (*self.left, *self.right)]
        stations = np.concatenate(
            [self.road.plan.s, self.road.offset.start, *(p.start for p in profiles if p is not None)]
        )
        stations = np.unique(stations[(stations > start + _SAME_STATION_M) & (stations < end - _SAME_STATION_M)])
        apart = np.diff(stations, prepend=-np.inf) > _SAME_STATION_M
        return np.concatenate([[start], stations[apart], [end]])

    def stations_and_sizes_of_sideways_jumps(self, record_change_stations: Floats) -> tuple[Floats, Floats]:
        """Return the inner break points where an edge steps sideways, and by how much (m)."""
        inner = record_change_stations[1:-1]
        if not len(inner):
            return inner, inner
        before, after = (
            self.edges(inner, inner - 2 * _INSIDE_TOLERANCE_M),
            self.edges(inner, inner + _INSIDE_TOLERANCE_M),
        )
        step = np.hypot(before.x - after.x, before.y - after.y).max(axis=0)
        return inner[step > MIN_SIDEWAYS_STEP_M], step[step > MIN_SIDEWAYS_STEP_M]


def sample_stations(evaluator: EdgeEvaluator, record_change_stations: Floats) -> Floats:
    """Return stations, breaks included, at most MAX_SPACING_M apart and with chords within CHORD_TOLERANCE_M of every edge."""
    s = _divide_intervals(record_change_stations, np.ceil(np.diff(record_change_stations) / MAX_SPACING_M - 1e-9))
    for _ in range(10):
        parts = _n_parts_of_intervals(evaluator, s)
        if (parts <= 1).all():
            break
        s = _divide_intervals(s, parts)
    return s


def _divide_intervals(s: Floats, parts: Floats) -> Floats:
    """Return the stations with each interval cut into equal parts."""
    count = np.maximum(parts, 1).astype(np.int64)
    if count.sum() > MAX_POINTS:
        raise MalformedError(f"its edges need {count.sum()} points: its numbers are not plausible")
    first = np.repeat(s[:-1], count)
    place = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    return np.append(first + place * np.repeat(np.diff(s) / count, count), s[-1])


def _n_parts_of_intervals(evaluator: EdgeEvaluator, s: Floats) -> Floats:
    """Return into how many parts each interval has to be cut (1: it stays whole)."""
    edges = evaluator.edges(_divide_intervals(s, np.full(len(s) - 1, 4.0)))
    x, y = edges.x, edges.y
    ax, ay, dx, dy = x[:, :-1:4], y[:, :-1:4], np.diff(x[:, ::4]), np.diff(y[:, ::4])
    square = np.maximum(dx * dx + dy * dy, 1e-18)
    off = np.zeros(len(s) - 1)
    for i in (1, 2, 3):
        px, py = x[:, i::4] - ax, y[:, i::4] - ay
        along = np.clip((px * dx + py * dy) / square, 0.0, 1.0)
        off = np.maximum(off, np.hypot(px - along * dx, py - along * dy).max(axis=0))
    by_chord = np.where(off > CHORD_TOLERANCE_M, np.ceil(np.sqrt(off / CHORD_TOLERANCE_M)), 1.0)
    by_length = np.ceil(np.sqrt(square.max(axis=0)) / MAX_SPACING_M - 1e-3)
    # a step in an edge, which no chord follows, would be cut without end
    return np.where(np.diff(s) > 2 * _SAME_STATION_M, np.clip(np.maximum(by_chord, by_length), 1.0, 16.0), 1.0)
