"""Crossroads at the origin: one lane each way, arms that run outwards."""

from __future__ import annotations

import math

from tests.outsiders.sixth.lines import Geom
from tests.outsiders.sixth.maps import WALK, side, unit
from tests.outsiders.sixth.road import Lane, Map, Road

ARMS = {"s": -math.pi / 2, "e": 0.0, "n": math.pi / 2, "w": math.pi}
IDS = {"s": "1", "e": "2", "n": "3", "w": "4"}
RADIUS, FAR = 12.0, 200.0  # the arms begin so far from the middle, and are so long


def cross(nation: str, arms: str = "senw", speed: float = 30, width: float = 3.5, walk: bool = False) -> Map:
    """A junction of these arms, in a town."""
    hand = side(nation)
    lanes = [Lane("driving", width, "solid")] + ([WALK] if walk else [])
    common = (hand, "town", speed, unit(nation))
    roads = []
    for a in arms:
        h = ARMS[a]
        geoms = [Geom((RADIUS * math.cos(h), RADIUS * math.sin(h), h), FAR)]
        roads.append(Road(IDS[a], geoms, list(lanes), list(lanes), *common, "broken", pred=("junction", "900", "")))
    text = ""
    ways = [(a, b) for a in arms for b in arms if a != b]
    for number, (a, b) in enumerate(ways, 100):
        road = Road(str(number), turn(a, b), [Lane("driving", width, "none")], [], *common, "none", junction="900")
        road.pred, road.succ, road.links = ("road", IDS[a], "start"), ("road", IDS[b], "start"), (-hand, hand)
        roads.append(road)
        text += (
            f'<connection id="{number}" incomingRoad="{IDS[a]}" connectingRoad="{number}" contactPoint="start">'
            f'<laneLink from="{-hand}" to="{hand}"/></connection>'
        )
    return Map(roads, [f'<junction id="900" name="x">{text}</junction>'])


def lit(nation: str, speed: float = 30, arms: str = "senw", walk: bool = True) -> Map:
    """A junction with a light and a stop line at each of some arms."""
    drawn = cross(nation, speed=speed, walk=walk)
    for a in arms:
        drawn[IDS[a]].stopline("st" + IDS[a], 2.0, -1).signal("tl" + IDS[a], 2.0, -1, "1000001")
    return drawn


def with_stop_sign(nation: str, speed: float = 30) -> Map:
    """A road from the south with a stop sign, that ends at another."""
    drawn = cross(nation, "sew", speed=speed)
    sign = ("stop1", "601.1", "gb") if nation == "gb" else ("s206", "206", "de")
    drawn["1"].stopline("st1", 2.0, -1).signal(sign[0], 2.0, -1, sign[1], sign[2], "stop")
    return drawn


def turn(a: str, b: str) -> list[Geom]:
    """The line through the junction from arm a to arm b."""
    h = ARMS[a]
    start = (RADIUS * math.cos(h), RADIUS * math.sin(h), h + math.pi)
    d = (ARMS[b] - (h + math.pi) + math.pi) % (2 * math.pi) - math.pi
    if abs(d) < 0.01:
        return [Geom(start, 2 * RADIUS)]
    return [Geom(start, RADIUS * math.pi / 2, math.copysign(1 / RADIUS, d))]


def through(a: str, b: str) -> list[Geom]:
    """Way from the far end of arm a to the far end of arm b; the junction begins at s = 200."""
    ha, hb = ARMS[a], ARMS[b]
    out = RADIUS + FAR
    coming = Geom((out * math.cos(ha), out * math.sin(ha), ha + math.pi), FAR)
    return [coming, *turn(a, b), Geom((RADIUS * math.cos(hb), RADIUS * math.sin(hb), hb), FAR)]
