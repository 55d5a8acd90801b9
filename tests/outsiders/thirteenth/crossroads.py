"""Crossroads and roundabouts about the origin, arms of one lane each way that run inwards."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from tests.outsiders.log import Size
from tests.outsiders.thirteenth.drive import Drive, Wanted, draw
from tests.outsiders.thirteenth.motion import SIZES, Across, Actor, Speeds, Way, line
from tests.outsiders.thirteenth.road import Frame, Lane, Map, Road, Section

INWARDS = {"W": 0.0, "S": math.pi / 2, "E": math.pi, "N": -math.pi / 2}
ARM = 150.0
RING = (14.0, 12.0)  # radius of the roundabout, and of the bends onto and off it


class Crossroads:
    """Four arms; signs: arm -> stop, give or light; ring: whether it is a roundabout."""

    def __init__(self, lht: bool, signs: Mapping[str, str], width: float, ring: bool, limit: float) -> None:
        self.lht, self.width, self.ring, self.limit = lht, width, ring, limit
        self.side = 1 if lht else -1
        self.edge = math.sqrt(RING[0] ** 2 + 2 * RING[0] * RING[1]) if ring else 12.0
        self.arms = {name: self._arm(i, name, signs.get(name, "")) for i, name in enumerate(INWARDS, 1)}
        pairs = [(a, b) for a in self.arms for b in self.arms if a != b]
        self.ways = {a + b: self._way(n, a, b) for n, (a, b) in enumerate(pairs, 20)}

    def map(self, frame: Frame) -> Map:
        """The map of it."""
        connections = [(self.arms[pair[0]].id, way.id, self.side, self.side) for pair, way in self.ways.items()]
        return Map([*self.arms.values(), *self.ways.values()], connections, frame)

    def route(self, a: str, b: str, u: float) -> tuple[Way, float, float]:
        """From arm to arm, u from the middle; also where the junction begins and ends on it."""
        way = self.ways[a + b]
        parts = (
            self.arms[a].at(np.arange(0, ARM, 0.25), u),
            way.at(np.linspace(0, way.length, 120), u),
            self.arms[b].at(np.arange(ARM - 0.25, 0, -0.25), -u),
        )
        whole = Way(np.concatenate([x for x, _ in parts]), np.concatenate([y for _, y in parts]))
        x, y = way.at(np.array([0.0, way.length]), u)
        return whole, whole.nearest(x[0], y[0]), whole.nearest(x[1], y[1])

    def _arm(self, number: int, name: str, sign: str) -> Road:
        h, w = INWARDS[name], self.width
        lanes = [Lane(width=w, mark="solid"), Lane("sidewalk", 2.0, "none")]
        start = (-(self.edge + ARM) * math.cos(h), -(self.edge + ARM) * math.sin(h), h)
        arm = Road(number, [(ARM, 0.0)], start, self.lht, "town", self.limit, [Section(0.0, lanes, lanes)])
        arm.link = '<successor elementType="junction" elementId="900"/>'
        if sign:
            arm.add_stop_line(ARM - 1, w / 2, w)
        if sign == "stop":
            arm.add_sign(ARM - 1, w + 1, "206", "stopsign")
        if sign == "give":
            arm.add_sign(ARM - 1, w + 1, "205", "give")
        if sign == "light":
            arm.add_light(ARM - 1, w + 1, f"L{name}", 1)
        return arm

    def _way(self, number: int, a: str, b: str) -> Road:
        turn = math.remainder(INWARDS[b] + math.pi - INWARDS[a], 2 * math.pi)
        begun = self.arms[a]
        x, y, h = (float(v[0]) for v in begun.pose(np.array([ARM])))
        way = Road(
            number,
            self._round(turn) if self.ring else self._across(turn),
            (x, y, h),
            self.lht,
            "town",
            self.limit,
            [Section(0.0, [Lane(width=self.width, mark="none")], [])],
            [(0.0, "none")],
            junction=900,
        )
        way.link = (
            f'<predecessor elementType="road" elementId="{begun.id}" contactPoint="end"/>'
            f'<successor elementType="road" elementId="{self.arms[b].id}" contactPoint="end"/>'
        )
        way.links = {self.side: [("predecessor", self.side), ("successor", -self.side)]}
        return way

    def _across(self, turn: float) -> list[tuple[float, float]]:
        if abs(turn) < 0.1:
            return [(2 * self.edge, 0.0)]
        return [(self.edge * math.pi / 2, (1 if turn > 0 else -1) / self.edge)]

    def _round(self, turn: float) -> list[tuple[float, float]]:
        ring, bend = RING
        onto = math.acos(bend / (ring + bend))
        along = 2 * onto - self.side * turn
        return [(bend * onto, self.side / bend), (ring * along, -self.side / ring), (bend * onto, self.side / bend)]


Other = Callable[[Crossroads], Actor]


def on(name: str, cls: str, way: str, back: float, speeds: Speeds, *, off: float = 0.0) -> Other:
    """Somebody on the way from arm to arm, at first so far before the junction."""

    def drawn(crossroads: Crossroads) -> Actor:
        route, begin, _ = crossroads.route(way[0], way[1], 1.75)
        return Actor(name, cls, route, begin - back, speeds, ((0.0, off),), crossroads.side)

    return drawn


def walker(x0: float, y0: float, x1: float, y1: float, t: float) -> Other:
    """Somebody on foot who sets out at t; y as in Great Britain, mirrored in Germany."""

    def drawn(crossroads: Crossroads) -> Actor:
        way = line(x0, crossroads.side * y0, x1, crossroads.side * y1)
        return Actor("p", "pedestrian", way, 0, steps(t, float(way.s[-1])), soft=0.1)

    return drawn


def steps(t: float, far: float, v: float = 1.4) -> Speeds:
    """Stand until t, then walk so far."""
    return [(0, 0), (t, 0), (t + 0.2, v), (t + far / v, v), (t + far / v + 0.2, 0)]


def halt(v0: float, back: float, gap: float, hold: float, v1: float = 6.0) -> Speeds:
    """Come to stand with the front so far before the junction, hold, go on."""
    way = back - gap
    brake = v0 * v0 / (2 * (way - 15)) if way > 30 else v0 * v0 / (2 * way * 0.7)
    begin = (way - v0 * v0 / (2 * brake)) / v0
    stand = begin + v0 / brake
    return [(0, v0), (begin, v0), (stand, 0), (stand + hold, 0), (stand + hold + v1 / 1.5, v1), (99, v1)]


def junction(name: str, way: str, speeds: Speeds, wanted: Wanted, *others: Other, **more: Any) -> Drive:
    """The ego goes from arm to arm; back: its front is at first so far before the junction."""
    lht = more.pop("lht", True)
    width = more.pop("width", 3.5)
    crossroads = Crossroads(lht, more.pop("signs", {}), width, more.pop("ring", False), more.pop("limit", 13.41))
    route, begin, _ = crossroads.route(way[0], way[1], width / 2)
    if more.pop("mirrored", False):
        route = Way(route.x, -route.y)
    cls = more.pop("cls", "car")
    size: Size = more.pop("size", None) or SIZES[cls]
    across: Across = more.pop("off", ((0.0, 0.0),))
    ego = Actor("ego", cls, route, begin - more.pop("back", 60) - (size[0] or 0) / 2, speeds, across, crossroads.side)
    ego.size, ego.indicator, ego.noise = size, more.pop("ind", None), more.pop("noise", 0.0)
    actors: Sequence[Actor] = [ego, *(other(crossroads) for other in others)]
    drawn = crossroads.map(more.pop("frame", (0.0, 0.0, 0.0)))
    return draw(name, drawn, actors, more.pop("seconds", 25), wanted, **more)
