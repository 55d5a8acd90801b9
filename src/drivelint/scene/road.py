"""Roads, their lanes, and paths along lanes, as drawn: right-hand traffic, x to the east, in metres and radians."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.arrays import wrap_angles
from drivelint.errors import UsageError
from drivelint.phrases import hint

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.arrays import Floats
    from drivelint.scene.document import RoadThing

PATH_STEP_M: Final = 0.1
"""Distance between the points of a path along lanes."""
DRIVABLE_KINDS: Final = ("driving", "exit", "entry", "onRamp", "offRamp", "bidirectional")
_MOST_STRAIGHT_TURN_RAD: Final = 1e-6


class Pose(NamedTuple):
    """A position and a heading."""

    x: float
    y: float
    heading: float


class LinePiece(NamedTuple):
    """A straight or an arc; with `curve`, a cubic with the coefficients (bu, cu, du, bv, cv, dv) in its own frame, over 0..1."""

    length: float
    curvature: float = 0.0
    curve: tuple[float, ...] = ()


class Lane(NamedTuple):
    """A lane. Numbers from the middle outwards: 1, 2, ... along the road, -1, -2, ... against it.

    `marks`: (station, mark) pairs of the outer border.
    """

    number: int
    kind: str
    width: float
    marks: Sequence[tuple[float, str]]
    start: float
    end: float


@dataclass(frozen=True)
class Road:
    """A line of pieces that starts at a pose, and the lanes along this line."""

    name: str
    start: Pose
    pieces: Sequence[LinePiece]
    lanes: Sequence[Lane]
    kind: str = "rural"
    limits: Sequence[tuple[float, str]] = ()
    middle: Sequence[tuple[float, str]] = ((0.0, "none"),)
    heights: Sequence[tuple[float, float]] = ((0.0, 0.0),)
    things: Sequence[RoadThing] = field(default_factory=tuple)
    after: str | None = None
    """The road that this road continues."""
    turn: Turn | None = None
    """The lanes that this road connects through a junction; None: the road is not part of a junction."""

    @property
    def length(self) -> float:
        """The length of the line in metres."""
        return sum(piece.length for piece in self.pieces)

    def lane(self, number: int) -> Lane:
        """Return a lane. Errors: `UsageError`."""
        if (lane := next((lane for lane in self.lanes if lane.number == number), None)) is not None:
            return lane
        numbers = [str(lane.number) for lane in self.lanes]
        raise UsageError(f"road {self.name} has no lane {number}: {hint(str(number), numbers)}")

    def section_starts(self) -> list[float]:
        """Return the stations where lanes begin or end, from 0 on."""
        ends = {station for lane in self.lanes for station in (lane.start, lane.end) if 0 < station < self.length}
        return [0.0, *sorted(ends)]

    def lane_offset_m(self, lane: Lane, s: float) -> float:
        """Return the offset of a lane's middle from the line, left positive; where the lane is absent, the offset at its nearer end."""
        s = min(max(s, lane.start), lane.end - 1e-6)
        sign = int(math.copysign(1, lane.number))
        inner = sum(
            neighbour.width
            for neighbour in self.lanes
            if 0 < neighbour.number * sign < lane.number * sign and neighbour.start <= s < neighbour.end
        )
        return -sign * (inner + lane.width / 2)

    def poses_at(self, s: Floats, aside: Floats | float = 0.0) -> tuple[Floats, Floats, Floats]:
        """Return x, y and heading at stations, `aside` metres to the left of the line, which is straight beyond both ends."""
        s = np.asarray(s, float)
        x, y, heading = np.zeros(s.shape), np.zeros(s.shape), np.zeros(s.shape)
        pose, begin = self.start, 0.0
        for n, piece in enumerate(self.pieces):
            here = (s >= begin) | (n == 0)
            px, py, ph = _points_on_piece(pose, piece, s - begin)
            x, y, heading = np.where(here, px, x), np.where(here, py, y), np.where(here, ph, heading)
            pose, begin = end_of_piece(pose, piece), begin + piece.length
        past = s > begin
        over = np.maximum(s - begin, 0.0)
        x = np.where(past, pose.x + over * math.cos(pose.heading), x)
        y = np.where(past, pose.y + over * math.sin(pose.heading), y)
        heading = np.where(past, pose.heading, heading)
        return x - aside * np.sin(heading), y + aside * np.cos(heading), heading

    def end_pose(self) -> Pose:
        """Return the pose at the end of the line."""
        pose = self.start
        for piece in self.pieces:
            pose = end_of_piece(pose, piece)
        return pose

    def lane_exit_or_entry_pose(self, lane: Lane, *, is_exit: bool) -> Pose:
        """Return the pose at which traffic leaves a lane (`is_exit`) or enters it, in the direction of the traffic."""
        s = self.length if is_exit == (lane.number > 0) else 0.0
        x, y, heading = (float(v) for v in self.poses_at(np.array(s), self.lane_offset_m(lane, s)))
        return Pose(x, y, heading if lane.number > 0 else heading + math.pi)


class Turn(NamedTuple):
    """A path through a junction, from the end of one road's lane to the beginning of another road's lane."""

    junction: int
    from_road: str
    from_lane: int
    to_road: str
    to_lane: int


def _points_on_piece(pose: Pose, piece: LinePiece, u: Floats) -> tuple[Floats, Floats, Floats]:
    if piece.curve:
        bu, cu, du, bv, cv, dv = piece.curve
        p = np.clip(u / piece.length, 0.0, 1.0)
        local_x, local_y = p * (bu + p * (cu + p * du)), p * (bv + p * (cv + p * dv))
        turned = np.arctan2(bv + p * (2 * cv + p * 3 * dv), bu + p * (2 * cu + p * 3 * du))
        cos, sin = math.cos(pose.heading), math.sin(pose.heading)
        return pose.x + local_x * cos - local_y * sin, pose.y + local_x * sin + local_y * cos, pose.heading + turned
    heading = pose.heading + piece.curvature * np.maximum(u, 0.0)
    before = np.minimum(u, 0.0)
    u = np.maximum(u, 0.0)
    if abs(piece.curvature) < 1e-12:
        x, y = pose.x + u * math.cos(pose.heading), pose.y + u * math.sin(pose.heading)
    else:
        x = pose.x + (np.sin(heading) - math.sin(pose.heading)) / piece.curvature
        y = pose.y - (np.cos(heading) - math.cos(pose.heading)) / piece.curvature
    return x + before * math.cos(pose.heading), y + before * math.sin(pose.heading), heading


def end_of_piece(pose: Pose, piece: LinePiece) -> Pose:
    """Return the pose at the end of a piece that begins at `pose`."""
    return Pose(*(float(v) for v in _points_on_piece(pose, piece, np.array(piece.length))))


def connecting_piece(start: Pose, end: Pose) -> LinePiece:
    """Return a piece from one pose to another: a straight, an arc, or a cubic."""
    ahead, left = _ahead_and_left_m(start, end.x, end.y)
    turn = float(wrap_angles(np.asarray(end.heading - start.heading)))
    away = math.hypot(ahead, left)
    if abs(turn) < _MOST_STRAIGHT_TURN_RAD and abs(left) < 1e-3:
        return LinePiece(away)
    if abs(turn) > _MOST_STRAIGHT_TURN_RAD:
        radius = ahead / math.sin(turn) if abs(math.sin(turn)) > 1e-3 else left / 2
        if radius * turn > 0 and abs(radius * (1 - math.cos(turn)) - left) < 0.02:
            return LinePiece(radius * turn, 1 / radius)
    # the control points are as far away as those of the cubic that is nearest to an arc
    hold = (
        away if abs(turn) < 0.1 else min(4 * math.tan(abs(turn) / 4) * away / (2 * abs(math.sin(turn / 2))), 2 * away)
    )
    u1, v1 = hold * math.cos(turn), hold * math.sin(turn)
    cubic = (hold, 3 * ahead - 2 * hold - u1, hold + u1 - 2 * ahead, 0.0, 3 * left - v1, v1 - 2 * left)
    p = np.linspace(0.0, 1.0, 201)
    u = p * (cubic[0] + p * (cubic[1] + p * cubic[2]))
    v = p * (cubic[3] + p * (cubic[4] + p * cubic[5]))
    return LinePiece(float(np.hypot(np.diff(u), np.diff(v)).sum()), 0.0, cubic)


def _ahead_and_left_m(pose: Pose, x: float, y: float) -> tuple[float, float]:
    dx, dy = x - pose.x, y - pose.y
    cos, sin = math.cos(pose.heading), math.sin(pose.heading)
    return dx * cos + dy * sin, dy * cos - dx * sin


@dataclass(frozen=True)
class ActorPath:
    """The path of an actor: points with stations from 0; beyond both ends, the path is straight."""

    s: Floats
    x: Floats
    y: Floats
    heading: Floats
    z: Floats

    @classmethod
    def through_points(cls, x: Floats, y: Floats, heading: Floats | None = None, z: Floats | None = None) -> ActorPath:
        """Return the path through points; without `heading`, the headings are the directions from point to point."""
        steps = np.hypot(np.diff(x), np.diff(y))
        distinct = np.concatenate([[True], steps > 1e-9])
        x, y, z = x[distinct], y[distinct], np.zeros(int(distinct.sum())) if z is None else z[distinct]
        s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        if heading is None:
            between = np.arctan2(np.diff(y), np.diff(x))
            heading = np.concatenate([between, between[-1:]])
        else:
            heading = heading[distinct]
        return cls(s, x, y, np.unwrap(heading), z)

    def poses_at(self, s: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return x, y, heading and height at stations."""
        over = np.minimum(s, 0.0) + np.maximum(s - self.s[-1], 0.0)
        x, y, heading, z = (np.interp(s, self.s, column) for column in (self.x, self.y, self.heading, self.z))
        return x + over * np.cos(heading), y + over * np.sin(heading), heading, z


def path_along_lanes(roads: Mapping[str, Road], lanes: Sequence[tuple[str, int]]) -> ActorPath:
    """Return the path along the middles of these lanes, in the direction of their traffic, with the turns through junctions."""
    parts = []
    for road_name, number in lanes_with_junction_lanes_between(roads, lanes):
        road = roads[road_name]
        lane = road.lane(number)
        s = np.append(np.arange(0.0, road.length, PATH_STEP_M), road.length)
        aside = (
            np.array([road.lane_offset_m(lane, float(v)) for v in s])
            if len(road.section_starts()) > 1
            else road.lane_offset_m(lane, 0.0)
        )
        x, y, heading = road.poses_at(s, aside)
        stations, heights = np.array(road.heights, float).T
        z = np.interp(s, stations, heights)
        if number < 0:
            x, y, heading, z = x[::-1], y[::-1], heading[::-1] + math.pi, z[::-1]
        parts.append((x, y, heading, z))
    return ActorPath.through_points(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def lanes_with_junction_lanes_between(
    roads: Mapping[str, Road], lanes: Sequence[tuple[str, int]]
) -> list[tuple[str, int]]:
    """Return the lanes, and between them the lanes of the junctions that connect them."""
    route = list(lanes[:1])
    for (before, n), (behind, m) in pairwise(lanes):
        route += [(road.name, 1) for road in roads.values() if road.turn and road.turn[1:] == (before, n, behind, m)]
        route.append((behind, m))
    return route
