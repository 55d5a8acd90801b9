"""Lanelets: one per road, section and lane, its points in the direction of travel."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from drivelint.maps.opendrive.crosssection import Edges, Evaluator, stations
from drivelint.maps.opendrive.network import DRIVABLE
from drivelint.maps.opendrive.xml import MalformedError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.maps.opendrive.cubic import Floats
    from drivelint.maps.opendrive.direction import Direction
    from drivelint.maps.opendrive.network import Lane, Network, Road, Strip
    from drivelint.maps.quality import Quality

NARROW_M = 0.05  # a lane that is nowhere wider is a line, not a lane
SHORT_M = 1e-3  # a shorter section is a rounding error: links go through it
LaneKey = tuple[str, int, int]  # road, section, lane number


@dataclass(eq=False)
class Lanelet:
    """A lane of a section as arrays, all (n,), in the direction of travel."""

    key: LaneKey
    lane: Lane
    road: Road
    strip: Strip
    along: int
    bidirectional: bool
    road_s: Floats
    x: Floats
    y: Floats
    z: Floats
    tx: Floats
    ty: Floats
    half_width: Floats
    left_x: Floats
    left_y: Floats
    right_x: Floats
    right_y: Floats
    s: Floats
    left: Lanelet | None = None
    right: Lanelet | None = None

    @property
    def lanelet_id(self) -> str:
        """The id, road.section.lane."""
        return lanelet_id(self.key)

    @property
    def drivable(self) -> bool:
        """Motor vehicles may drive here."""
        return self.lane.kind in DRIVABLE

    @property
    def length_m(self) -> float:
        """Length along the centre line."""
        return float(self.s[-1])

    def at(self, road_s: float) -> float:
        """Return the lanelet station (m) of a road station (m), held within the lanelet."""
        step = self.along
        return float(np.interp(road_s, self.road_s[::step], self.s[::step]))

    def ranges(self, spans: Iterable[tuple[int, float, float]]) -> list[tuple[int, float, float]]:
        """Return (index, from, to) spans of road stations as lanelet stations in the direction of travel, empty ones left out."""
        found = [(i, *sorted((self.at(a), self.at(b)))) for i, a, b in spans]
        return sorted(((i, a, b) for i, a, b in found if b - a > 1e-6), key=lambda r: r[1])

    def turn(self) -> float:
        """Return the heading change over the lanelet (rad), left positive."""
        cross = self.tx[:-1] * self.ty[1:] - self.ty[:-1] * self.tx[1:]
        dot = self.tx[:-1] * self.tx[1:] + self.ty[:-1] * self.ty[1:]
        return float(np.arctan2(cross, dot).sum())

    def area(self) -> float:
        """Return the area between the bounds (m2)."""
        x = np.concatenate([self.right_x, self.left_x[::-1]])
        y = np.concatenate([self.right_y, self.left_y[::-1]])
        x, y = x - x[0], y - y[0]
        return abs(0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)))

    def mean_width(self) -> float:
        """Return the mean distance between the bounds (m)."""
        ds = np.diff(self.s)
        return float(((self.half_width[:-1] + self.half_width[1:]) * ds).sum() / ds.sum()) if ds.sum() > 0 else 0.0


@dataclass(eq=False)
class Lanes:
    """What was built, and what was not and why."""

    built: dict[LaneKey, Lanelet] = field(default_factory=dict)
    short: set[LaneKey] = field(default_factory=set)  # links pass through these
    narrow: set[LaneKey] = field(default_factory=set)
    failed: set[LaneKey] = field(default_factory=set)


def lanelet_id(key: LaneKey) -> str:
    """Return the id of a lane in the tables."""
    return f"{key[0]}.{key[1]}.{key[2]}"


def build(net: Network, direction: Direction, offset: tuple[float, float], quality: Quality) -> Lanes:
    """Build every lane of the network; whatever is left out is a row of `quality`."""
    lanes = Lanes()
    for road in net.roads.values():
        _check_plan(road, quality)
        for strip in road.strips:
            _build_strip(road, strip, direction, offset, lanes, quality)
        _join_sides(road, lanes)
    return lanes


def _check_plan(road: Road, quality: Quality) -> None:
    gap, kink = road.plan.joints()
    if (gap > 0.05).any():
        n, worst = int((gap > 0.05).sum()), float(gap.max())
        quality.add("reference_gap", "warning", road.road_id, f"the geometries of road {road.road_id} leave gaps of up to {worst:.2f} m", n)
    if (kink > 0.05).any():
        n, worst = int((kink > 0.05).sum()), float(np.degrees(kink.max()))
        quality.add("reference_kink", "warning", road.road_id, f"the geometries of road {road.road_id} turn on the spot by up to {worst:.1f} deg", n)
    said = float(road.element.get("length", "nan"))
    if abs(road.plan.end - said) > 0.01:
        message = f"road {road.road_id} says {said:.2f} m, its geometries are {road.plan.end:.2f} m: the shorter one holds"
        quality.add("length_mismatch", "warning", road.road_id, message)


def _build_strip(road: Road, strip: Strip, direction: Direction, offset: tuple[float, float], lanes: Lanes, quality: Quality) -> None:
    keys = {lane.number: (road.road_id, strip.section, lane.number) for lane in strip.lanes}
    if strip.end_m - strip.start_m < SHORT_M:
        lanes.short.update(keys.values())
        message = f"section {strip.section} of road {road.road_id} is {strip.end_m - strip.start_m:.4f} m long: left out, its links pass through"
        quality.add("short_section", "info", road.road_id, message, len(keys))
        return
    reasons = _unbuildable(strip)
    try:
        evaluator = Evaluator(road, strip)
        breaks = evaluator.breaks()
        at, step = evaluator.steps(breaks)
        s = stations(evaluator, np.sort(np.concatenate([breaks, at - SHORT_M])))
        edges = evaluator.edges(s)
    except MalformedError as error:
        reasons = dict.fromkeys(keys, str(error))
    for number, reason in reasons.items():
        lanes.failed.add(keys[number])
        quality.add("invalid_lane", "error", lanelet_id(keys[number]), f"lane {lanelet_id(keys[number])} cannot be built: {reason}")
    if len(reasons) == len(keys):
        return
    if len(at):
        message = f"edges of section {strip.section} of road {road.road_id} step sideways by up to {float(step.max()):.2f} m"
        quality.add("edge_step", "warning", road.road_id, message, len(at))
    z, _ = road.elevation.evaluate(s, s) if len(road.elevation.start) else (np.full_like(s, np.nan), s)
    row = {number: i for i, number in enumerate(evaluator.numbers)}
    made: list[Lanelet] = []
    for lane in strip.lanes[::-1]:  # from left to right
        if lane.number in reasons:
            continue
        outer, inner = row[lane.number], row[lane.number] + (1 if lane.number > 0 else -1)
        if float(np.abs(edges.t[outer] - edges.t[inner]).max()) < NARROW_M:
            lanes.narrow.add(keys[lane.number])
            name = lanelet_id(keys[lane.number])
            quality.add("narrow_lane", "info", name, f"lane {name} is nowhere wider than {NARROW_M} m: left out, its neighbours adjoin")
            continue
        left, right = min(outer, inner), max(outer, inner)
        made.append(_lanelet(road, strip, lane, direction, edges, (left, right), s, z, offset, quality))
    for a, b in pairwise(made):
        _adjoin(a, b)
    for lanelet in made:
        lanes.built[lanelet.key] = lanelet
    for number, low in evaluator.negative_m.items():
        if low < -0.01:
            name = lanelet_id(keys[number])
            quality.add("negative_width", "warning", name, f"the width of lane {name} falls to {low:.2f} m: taken as 0 there")


def _unbuildable(strip: Strip) -> dict[int, str]:
    """Return lane number -> reason; a lane that lies outside an invalid one has no place either."""
    reasons: dict[int, str] = {}
    for side in (1, -1):
        broken: Lane | None = None
        for lane in sorted((lane for lane in strip.lanes if lane.number * side > 0), key=lambda lane: abs(lane.number)):
            if lane.invalid is not None:
                reasons[lane.number] = lane.invalid
                broken = broken or lane
            elif broken is not None and lane.borders is None:
                reasons[lane.number] = f"lane {broken.number}, on whose edge it lies, is invalid"
    return reasons


def _lanelet(
    road: Road, strip: Strip, lane: Lane, direction: Direction, edges: Edges, rows: tuple[int, int], s: Floats, z: Floats,
    offset: tuple[float, float], quality: Quality,
) -> Lanelet:  # fmt: skip
    """Return one lane as arrays; `rows` are those of its left and right edge, seen along the reference line."""
    i, j = rows
    along, bidirectional = direction.of(lane)
    line, (dx, dy) = edges.line, offset
    t, dt = 0.5 * (edges.t[i] + edges.t[j]), 0.5 * (edges.dt[i] + edges.dt[j])
    forward = line.speed * (1.0 - line.curvature * t)
    tx, ty = forward * line.cos - dt * line.sin, forward * line.sin + dt * line.cos
    x, y = line.x - line.sin * t, line.y + line.cos * t
    norm = np.hypot(tx, ty)
    still = norm < 1e-6
    if still.any():  # the centre line turns on the spot: its chords have a direction all the same
        tx, ty = np.where(still, np.gradient(x), tx), np.where(still, np.gradient(y), ty)
        norm = np.maximum(np.hypot(tx, ty), 1e-12)
    key = (road.road_id, strip.section, lane.number)
    folded = (line.curvature * edges.t[[i, j]] >= 1.0).any(axis=0)
    if folded.any():
        name = lanelet_id(key)
        severity = "error" if (forward <= 0.0).any() and lane.kind in DRIVABLE else "warning"
        message = f"the inner edge of lane {name} folds back on itself: the bend is tighter than the lane is far from its centre"
        quality.add("folded_lane", severity, name, message, int(folded.sum()))
    order = slice(None, None, along)
    left, right = (i, j) if along > 0 else (j, i)
    x, y = x[order] + dx, y[order] + dy
    return Lanelet(
        key=key, lane=lane, road=road, strip=strip, along=along, bidirectional=bidirectional,
        road_s=s[order], x=x, y=y, z=z[order], tx=(along * tx / norm)[order], ty=(along * ty / norm)[order],
        half_width=(0.5 * (edges.t[i] - edges.t[j]))[order],
        left_x=edges.x[left][order] + dx, left_y=edges.y[left][order] + dy,
        right_x=edges.x[right][order] + dx, right_y=edges.y[right][order] + dy,
        s=np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))]),
    )  # fmt: skip


def _adjoin(a: Lanelet, b: Lanelet) -> None:
    """Make `b` the neighbour of `a` on the right of the reference line."""
    if a.along > 0:
        a.right = b
    else:
        a.left = b
    if b.along > 0:
        b.left = a
    else:
        b.right = a


def _join_sides(road: Road, lanes: Lanes) -> None:
    """Adjoin the innermost lanes of strips that hold one side only to the lane across that they lie longest beside."""
    built = [lane for strip in road.strips for n in strip.lanes if (lane := lanes.built.get((road.road_id, strip.section, n.number)))]
    for a in built:
        inward = "right" if (a.lane.number > 0) == (a.along > 0) else "left"
        if getattr(a, inward) is not None:
            continue
        across = [b for b in built if b.lane.number * a.lane.number < 0 and _innermost(b, built)]
        across = [b for b in across if _overlap(a, b) > SHORT_M]
        if across and _innermost(a, built):
            setattr(a, inward, max(across, key=lambda b: (_overlap(a, b), -b.strip.section)))


def _innermost(a: Lanelet, built: list[Lanelet]) -> bool:
    return not any(
        b.strip is a.strip and b.lane.number * a.lane.number > 0 and abs(b.lane.number) < abs(a.lane.number) for b in built
    )


def _overlap(a: Lanelet, b: Lanelet) -> float:
    return min(a.strip.end_m, b.strip.end_m) - max(a.strip.start_m, b.strip.start_m)
