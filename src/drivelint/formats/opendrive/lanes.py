"""Builds the lanelets: one per road, section and lane, with points in the direction of travel."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from drivelint.formats.opendrive.crosssection import EdgeEvaluator, LaneEdges, sample_stations
from drivelint.formats.opendrive.lanelet import LaneKey, Lanelet, lanelet_id
from drivelint.formats.opendrive.network import DRIVABLE_LANE_TYPES
from drivelint.formats.opendrive.xml import MalformedError
from drivelint.road.lane_geometry import LaneGeometry

if TYPE_CHECKING:
    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.direction import DrivingDirection
    from drivelint.formats.opendrive.network import Lane, LaneSection, Network, Road
    from drivelint.road.quality import MapQuality

NARROW_LANE_M = 0.05  # a lane that is nowhere wider is a line, not a lane
SHORT_SECTION_M = 1e-3  # a shorter section is a rounding error: links pass through it


@dataclass(eq=False)
class BuiltLanes:
    """The lanelets that were built, and the lanes that were left out, by cause."""

    built: dict[LaneKey, Lanelet] = field(default_factory=dict)
    short: set[LaneKey] = field(default_factory=set)  # links pass through these
    narrow: set[LaneKey] = field(default_factory=set)
    failed: set[LaneKey] = field(default_factory=set)


def build_lanelets(
    net: Network, direction: DrivingDirection, offset: tuple[float, float], quality: MapQuality
) -> BuiltLanes:
    """Build every lane of the network; lanes that are left out are reported in `quality`."""
    lanes = BuiltLanes()
    for road in net.roads.values():
        _report_plan_view_faults(road, quality)
        for lane_section in road.lane_sections:
            _SectionBuilder(road, lane_section, direction, offset, lanes, quality).build()
        _set_neighbours_across_centre(road, lanes)
    return lanes


def _report_plan_view_faults(road: Road, quality: MapQuality) -> None:
    gap, kink = road.plan.joint_gaps_and_turns()
    name = f"the geometries of road {road.road_id}"
    if (gap > 0.05).any():
        message = f"{name} leave gaps of up to {float(gap.max()):.2f} m"
        quality.add("reference_gap", "warning", road.road_id, message, int((gap > 0.05).sum()))
    if (kink > 0.05).any():
        message = f"{name} turn on the spot by up to {float(np.degrees(kink.max())):.1f} degrees"
        quality.add("reference_kink", "warning", road.road_id, message, int((kink > 0.05).sum()))
    if abs(road.plan.end - road.stated_length_m) > 0.01:
        message = f"{name} are {road.plan.end:.2f} m long, the road states {road.stated_length_m:.2f} m: the shorter length is used"
        quality.add("length_mismatch", "warning", road.road_id, message)


@dataclass(eq=False)
class _SectionBuilder:
    """Builds the lanelets of one lane section into `lanes`."""

    road: Road
    lane_section: LaneSection
    direction: DrivingDirection
    offset: tuple[float, float]
    lanes: BuiltLanes
    quality: MapQuality

    def build(self) -> None:
        lane_section, road = self.lane_section, self.road
        keys = [self._lane_key(lane) for lane in lane_section.lanes]
        length, name = (
            lane_section.end_m - lane_section.start_m,
            f"section {lane_section.section} of road {road.road_id}",
        )
        if length < SHORT_SECTION_M:
            self.lanes.short.update(keys)
            message = f"{name} is {length:.4f} m long: it is left out, and links lead through it"
            self.quality.add("short_section", "info", road.road_id, message, max(len(keys), 1))
            return
        self._report_failed(_reason_by_unbuildable_lane(lane_section))
        try:
            evaluator = EdgeEvaluator(road, lane_section)
            breaks = evaluator.record_change_stations()
            at, step = evaluator.stations_and_sizes_of_sideways_jumps(breaks)
            s = sample_stations(evaluator, np.sort(np.concatenate([breaks, at - SHORT_SECTION_M])))
            edges = evaluator.edges(s)
        except MalformedError as error:
            self._report_failed(
                {
                    lane.number: str(error)
                    for lane in lane_section.lanes
                    if self._lane_key(lane) not in self.lanes.failed
                }
            )
            return
        if len(at):
            message = f"lane edges in {name} step sideways by up to {float(step.max()):.2f} m"
            self.quality.add("edge_step", "warning", road.road_id, message, len(at))
        self._add_lanelets(evaluator, edges, s)
        for number, low in sorted(evaluator.negative_m.items()):
            if low < -0.01:
                lane_id = lanelet_id((road.road_id, lane_section.section, number))
                message = f"the width of lane {lane_id} falls to {low:.2f} m: treated as 0 there"
                self.quality.add("negative_width", "warning", lane_id, message)

    def _add_lanelets(self, evaluator: EdgeEvaluator, edges: LaneEdges, s: Floats) -> None:
        """Create a lanelet between the edges of each lane, from left to right, and make lanelets beside each other neighbours."""
        row = {number: i for i, number in enumerate(evaluator.numbers)}
        lanelets: list[Lanelet] = []
        for lane in self.lane_section.lanes[::-1]:
            key = self._lane_key(lane)
            if key in self.lanes.failed:
                continue
            outer, inner = row[lane.number], row[lane.number] + (1 if lane.number > 0 else -1)
            if float(np.abs(edges.t[outer] - edges.t[inner]).max()) < NARROW_LANE_M:
                self.lanes.narrow.add(key)
                message = f"lane {lanelet_id(key)} is nowhere wider than {NARROW_LANE_M} m: it is left out, and its neighbours are adjacent"
                self.quality.add("narrow_lane", "info", lanelet_id(key), message)
                continue
            lanelets.append(self._lanelet(lane, edges, s, (min(outer, inner), max(outer, inner))))
        for a, b in pairwise(lanelets):
            _make_neighbours(a, b)
        self.lanes.built.update((lanelet.key, lanelet) for lanelet in lanelets)

    def _lanelet(self, lane: Lane, edges: LaneEdges, s: Floats, edge_rows: tuple[int, int]) -> Lanelet:
        """Return the lanelet of a lane. `edge_rows`: the rows of its left and right edge in `edges`, seen along the reference line."""
        i, j = edge_rows
        along, bidirectional = self.direction.direction_and_is_two_way(lane)
        line = edges.line
        t, dt = 0.5 * (edges.t[i] + edges.t[j]), 0.5 * (edges.dt[i] + edges.dt[j])
        x, y = line.x - line.sin * t, line.y + line.cos * t
        forward = line.speed * (1.0 - line.curvature * t)
        tx, ty = forward * line.cos - dt * line.sin, forward * line.sin + dt * line.cos
        norm = np.hypot(tx, ty)
        still = norm < 1e-6
        if still.any():  # the centre line has no direction here, but its chords have one
            tx, ty = np.where(still, np.gradient(x), tx), np.where(still, np.gradient(y), ty)
            norm = np.maximum(np.hypot(tx, ty), 1e-12)
        folded = np.any(line.curvature * edges.t[[i, j]] > 1.0, axis=0)
        if folded.any():
            name = lanelet_id(self._lane_key(lane))
            severity = "error" if lane.kind in DRIVABLE_LANE_TYPES and (forward <= 0.0).any() else "warning"
            message = (
                f"an edge of lane {name} folds back on itself: the bend is too tight for the distance "
                "of the edge from the reference line"
            )
            self.quality.add("folded_lane", severity, name, message, int(folded.sum()))
        z = self.road.elevation.evaluate(s, s)[0] if len(self.road.elevation.start) else np.full_like(s, np.nan)
        order = slice(None, None, along)
        left, right = (i, j) if along > 0 else (j, i)
        bounds = [np.column_stack([edges.x[k], edges.y[k]])[order] + self.offset for k in (left, right)]
        centre = np.column_stack([x, y])[order] + self.offset
        geometry = LaneGeometry(
            s=np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(centre, axis=0).T))]),
            centre=centre,
            left=bounds[0],
            right=bounds[1],
            tangent=(along * np.column_stack([tx, ty]) / norm[:, None])[order],
            half_width=(0.5 * (edges.t[i] - edges.t[j]))[order],
        )
        return Lanelet(
            self._lane_key(lane), lane, self.road, self.lane_section, along, bidirectional,
            line=geometry, road_s=s[order], z=z[order], t=t[order],
        )  # fmt: skip

    def _lane_key(self, lane: Lane) -> LaneKey:
        return (self.road.road_id, self.lane_section.section, lane.number)

    def _report_failed(self, reasons: dict[int, str]) -> None:
        for number, reason in sorted(reasons.items()):
            key = (self.road.road_id, self.lane_section.section, number)
            self.lanes.failed.add(key)
            message = f"lane {lanelet_id(key)} cannot be built: {reason}"
            self.quality.add("invalid_lane", "error", lanelet_id(key), message)


def _reason_by_unbuildable_lane(lane_section: LaneSection) -> dict[int, str]:
    """Return lane number -> why the lane cannot be built. A lane outside an invalid lane has no place either."""
    reasons: dict[int, str] = {}
    for side in (1, -1):
        broken: Lane | None = None
        for lane in sorted(
            (lane for lane in lane_section.lanes if lane.number * side > 0), key=lambda lane: abs(lane.number)
        ):
            if lane.invalid is not None:
                reasons[lane.number] = lane.invalid
                broken = broken or lane
            elif broken is not None and lane.borders is None:
                reasons[lane.number] = f"lane {broken.number}, on whose edge it lies, is invalid"
    return reasons


def _make_neighbours(a: Lanelet, b: Lanelet) -> None:
    """Make `b` the neighbour of `a` on its right, seen along the reference line."""
    setattr(a, "right" if a.along > 0 else "left", b)
    setattr(b, "left" if b.along > 0 else "right", a)


def _set_neighbours_across_centre(road: Road, lanes: BuiltLanes) -> None:
    """Give each innermost lane of a one-sided lane section a neighbour: the lane across the centre line that it adjoins longest."""
    built = [lanes.built[key] for key in road.lane_keys if key in lanes.built]
    for a in built:
        inward = "right" if (a.lane.number > 0) == (a.along > 0) else "left"
        if getattr(a, inward) is not None:
            continue
        across = [b for b in built if b.lane.number * a.lane.number < 0 and _is_innermost(b, built)]
        across = [b for b in across if _common_length_m(a, b) > SHORT_SECTION_M]
        if across and _is_innermost(a, built):
            setattr(a, inward, max(across, key=lambda b: (_common_length_m(a, b), -b.lane_section.section)))


def _is_innermost(a: Lanelet, built: list[Lanelet]) -> bool:
    return not any(
        b.lane_section is a.lane_section
        and b.lane.number * a.lane.number > 0
        and abs(b.lane.number) < abs(a.lane.number)
        for b in built
    )


def _common_length_m(a: Lanelet, b: Lanelet) -> float:
    return min(a.lane_section.end_m, b.lane_section.end_m) - max(a.lane_section.start_m, b.lane_section.start_m)
