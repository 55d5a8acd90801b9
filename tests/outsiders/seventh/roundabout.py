"""A roundabout of one lane; at each of its four arms there is a junction."""

from __future__ import annotations

import math

from tests.outsiders.seventh.maps import Map
from tests.outsiders.seventh.road import Bend, Lane, Line, Piece, Pose, Road, Section, between
from tests.outsiders.seventh.ways import Way, chain

HALF = math.radians(24)  # half of the ring's part that belongs to a junction
ARMS = tuple(math.radians(degrees) for degrees in (270, 180, 90, 0))  # in the way of driving: clockwise
OUT = 38.0  # where the arms begin
ARM = 90.0
Joins = dict[str, tuple[str | int, ...]]


class Roundabout(Map):
    """British: it is gone round clockwise."""

    def __init__(self, radius: float = 20.0, width: float = 4.0) -> None:
        super().__init__("gb", width)
        self.town = self.kind("town", 30)
        self.inner = radius - width / 2
        side = [Lane("driving", width)]
        self.arms: list[Road] = []
        self.ring: list[Road] = []
        for i, angle in enumerate(ARMS):
            begin = (OUT * math.cos(angle), OUT * math.sin(angle), angle)
            joins: Joins = {"predecessor": ("junction", 1000 + i)}
            self.arms.append(Road(1 + i, begin, [Line(ARM)], [Section(0, side, side)], self.town, joins=joins))
            after = ARMS[(i + 1) % 4]
            turn = (angle - after) % (2 * math.pi)
            joins = {"predecessor": ("junction", 1000 + i), "successor": ("junction", 1000 + (i + 1) % 4)}
            piece = Bend((turn - 2 * HALF) * self.inner, -1 / self.inner)
            self.ring.append(self._lane(20 + i, self._pose(angle - HALF), piece, joins))
        self.roads += [*self.arms, *self.ring]
        self.ways = [self._junction(i) for i in range(4)]

    def way(self, arm: int, exits: int) -> Way:
        """The way from an arm into the ring and out by its so many-th exit."""
        pieces = [(self.arms[arm], -self.own, ARM, 0.0), self._all(self.ways[arm]["in"])]
        for j in range(exits):
            here, after = (arm + j) % 4, self.ways[(arm + j + 1) % 4]
            pieces += [self._all(self.ring[here]), self._all(after["on" if j < exits - 1 else "out"])]
        return chain([*pieces, (self.arms[(arm + exits) % 4], self.own, 0.0, ARM)])

    def _all(self, road: Road) -> tuple[Road, float, float, float]:
        return road, self.own, 0.0, road.length

    def _pose(self, angle: float) -> Pose:
        return self.inner * math.cos(angle), self.inner * math.sin(angle), angle - math.pi / 2

    def _lane(self, number: int, begin: Pose, piece: Piece, joins: Joins, junction: int = -1) -> Road:
        section = Section(0, [Lane("driving", self.width, "none")], [], ((0, "solid"),))
        return Road(number, begin, [piece], [section], self.town, junction, joins)

    def _junction(self, i: int) -> dict[str, Road]:
        """Return the ways through the junction at an arm: on round the ring, into it, out of it."""
        before, arm, after = self.ring[i - 1], self.arms[i], self.ring[i]
        x, y, heading = arm.start
        to_middle = (x, y, heading + math.pi)
        ring_in, ring_out = ("road", before.number, "end"), ("road", after.number, "start")
        number, junction, at_arm = 100 + 10 * i, 1000 + i, ("road", arm.number, "start")
        on = Bend(2 * HALF * self.inner, -1 / self.inner)
        ways = {
            "on": self._lane(number, before.end, on, {"predecessor": ring_in, "successor": ring_out}, junction),
            "in": self._lane(
                number + 1,
                to_middle,
                between(to_middle, after.start),
                {"predecessor": at_arm, "successor": ring_out},
                junction,
            ),
            "out": self._lane(
                number + 2,
                before.end,
                between(before.end, arm.start),
                {"predecessor": ring_in, "successor": at_arm},
                junction,
            ),
        }
        for name, road in ways.items():
            road.lane_joins = {"predecessor": -1 if name == "in" else 1, "successor": 1}
        self.roads += ways.values()
        self.links[junction] = [(before.number, number, 1, 1), (arm.number, number + 1, -1, 1)]
        self.links[junction].append((before.number, number + 2, 1, 1))
        return ways
