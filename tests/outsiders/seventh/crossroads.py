"""Crossroads and side roads; the arms lead away from the junction."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from tests.outsiders.seventh.maps import Map, Nation
from tests.outsiders.seventh.road import Bend, Lane, Line, Piece, Pose, Road, Section, between
from tests.outsiders.seventh.ways import Way, chain

if TYPE_CHECKING:
    from collections.abc import Mapping

FOUR: Mapping[str, float | Pose] = {"e": 0, "n": 90, "w": 180, "s": 270}
JUNCTION = 1000


class Crossroads(Map):
    """A junction in the middle of the map; its arms by their direction in degrees, or by where they begin."""

    def __init__(  # noqa: PLR0917
        self,
        nation: Nation = "gb",
        arms: Mapping[str, float | Pose] = FOUR,
        edge: float = 11.0,
        width: float = 3.5,
        footway: bool = False,
        lengths: Mapping[str, float] | None = None,
    ) -> None:
        super().__init__(nation, width)
        self.town = self.kind("town", 30 if nation == "gb" else 50)
        side = [Lane("driving", width)] + [Lane("sidewalk", 2.0, "none")] * footway
        self.arms: dict[str, Road] = {}
        for number, (name, where) in enumerate(arms.items(), 1):
            begin = where if isinstance(where, tuple) else _pose(where, edge)
            pieces = [Line((lengths or {}).get(name, 120))]
            joins: dict[str, tuple[str | int, ...]] = {"predecessor": ("junction", JUNCTION)}
            self.arms[name] = Road(number, begin, pieces, [Section(0, side, side)], self.town, joins=joins)
        self.ways: dict[tuple[str, str], Road] = {}
        for a in arms:
            for b in arms:
                if a != b:
                    self.ways[a, b] = self._through(self.arms[a], self.arms[b], edge, isinstance(arms[a], tuple))
        self.roads += [*self.arms.values(), *self.ways.values()]
        lanes = (-self.hand, self.hand)
        self.links[JUNCTION] = [(self.arms[a].number, road.number, *lanes) for (a, _), road in self.ways.items()]

    def way(self, a: str, b: str, far: float = 0, to: float = 0) -> Way:
        """The way from one arm to another, from so far before the junction to so far behind it (0: all)."""
        one, other, through = self.arms[a], self.arms[b], self.ways[a, b]
        return chain(
            [
                (one, -self.own, far or one.length, 0),
                (through, self.own, 0, through.length),
                (other, self.own, 0, to or other.length),
            ]
        )

    def lit(self, arm: str, *lights: str) -> None:
        """Draw a stop line with lights: the first beside the road, others above it."""
        self._line(arm)
        for n, ident in enumerate(lights):
            t = self.hand * 0.2 if n else -self.hand * (self.width + 0.6)
            self.arms[arm].sign(ident, 0.6, t, "1000001", "traffic_light", orientation="-", lane=-self.hand)

    def stop(self, arm: str) -> None:
        """Draw a stop line with a stop sign."""
        self._line(arm)
        country, kind = ("gb", "601.1") if self.hand == 1 else ("de", "206")
        road = self.arms[arm]
        t = -self.hand * (self.width + 0.6)
        road.sign(f"s{road.number}", 0.6, t, kind, "stop", country, "-", -self.hand)

    def _line(self, arm: str) -> None:
        self.arms[arm].area("stopLine", "stopline", 0.6, -self.own, 0.3, self.width)

    def _through(self, one: Road, other: Road, edge: float, odd: bool) -> Road:
        """Return the way from one arm to another, whose lane keeps to the near side of its line."""
        heading = one.start[2] + math.pi
        begin = (one.start[0], one.start[1], heading)
        turn = (other.start[2] - heading + math.pi) % (2 * math.pi) - math.pi
        piece: Piece = Line(2 * edge)
        if odd:
            piece = between(begin, other.start)
        elif abs(turn) >= 1e-6:
            radius = edge / math.tan(abs(turn) / 2)
            piece = Bend(radius * abs(turn), math.copysign(1 / radius, turn))
        lane = [Lane("driving", self.width, "none")]
        section = Section(0, lane if self.hand == 1 else [], [] if self.hand == 1 else lane, ((0, "none"),))
        joins: dict[str, tuple[str | int, ...]] = {
            "predecessor": ("road", one.number, "start"),
            "successor": ("road", other.number, "start"),
        }
        lanes = {"predecessor": -self.hand, "successor": self.hand}
        return Road(100 + len(self.ways), begin, [piece], [section], self.town, JUNCTION, joins, lanes)


def _pose(degrees: float, edge: float) -> Pose:
    heading = math.radians(degrees)
    return 0 + edge * math.cos(heading), 0 + edge * math.sin(heading), heading
