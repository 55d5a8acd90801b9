"""The roads on which the drives go, each with the lines that its lanes follow."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from tests.outsiders.second.movement import Line
from tests.outsiders.second.road import KERB, LANE, WALK, LaneSpec, Road, crossing, sign


class World(NamedTuple):
    """A map and the line that the ego's road has."""

    hand: int  # 1: the right is driven on, -1: the left
    roads: Sequence[Road]
    junctions: str
    line: Line
    way: dict[str, Line]

    def xodr(self) -> str:
        head = '<header revMajor="1" revMinor="7" name="outsider" version="1" north="0" south="0" east="0" west="0"/>'
        roads = "".join(road.xml(self.hand) for road in self.roads)
        return f'<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE>{head}{roads}{self.junctions}</OpenDRIVE>\n'


def straight(hand: int, limit: tuple[str, str] | None, length: float = 1500, **extra: Any) -> World:
    """A rural road with two lanes, 1500 m straight on to the east."""
    limits = [(0, *limit)] if limit else []
    road = Road(1, (0, 0, 0), [(length, 0)], [LANE], [LANE], limits=limits)
    for key, value in extra.items():
        setattr(road, key, value)
    return World(hand, [road], "", Line((0, 0, 0), []), {})


def bend(hand: int, limit: tuple[str, str], radius: float = 100) -> World:
    """A rural road: 200 m straight, a bend to the left of a quarter circle, straight again."""
    pieces = [(200.0, 0.0), (radius * math.pi / 2, 1 / radius), (300.0, 0.0)]
    road = Road(1, (0, 0, 0), pieces, [LANE], [LANE], limits=[(0, *limit)])
    return World(hand, [road], "", Line((0, 0, 0), pieces), {})


def town(hand: int, zebra: bool = False, light: bool = False, cycle: bool = False, length: float = 800) -> World:
    """A street with footways; a crossing 300 m along it, with a light and a stop line 3 m before it if asked for."""
    limit = ("30", "mph") if hand < 0 else ("50", "km/h")
    side = [("driving", 3.5, "broken"), ("biking", 1.5, "curb"), WALK] if cycle else [KERB, WALK]
    signals = ""
    if light:
        signals = sign(10, 295.5, -4, hand, "1000001", moving=True) + sign(11, 295.5, -2, hand, "294")
    objects = crossing(20, 300, "zebra" if zebra else "pelican") if zebra or light else ""
    road = Road(1, (0, 0, 0), [(length, 0)], side, side, limits=[(0, *limit)], kind="town", objects=objects)
    road.signals = signals
    return World(hand, [road], "", Line((0, 0, 0), []), {})


def motorway(hand: int, limit: tuple[str, str] | None, lanes: int = 3, length: float = 2500) -> World:
    """One carriageway with a hard shoulder; the reference line is the central reserve."""
    own = [("driving", 3.75, "broken")] * (lanes - 1) + [("driving", 3.75, "solid"), ("shoulder", 3.0, "none")]
    road = Road(1, (0, 0, 0), [(length, 0)], own, middle=[(0, "solid")], kind="motorway")
    road.limits = [(0, *limit)] if limit else []
    return World(hand, [road], "", Line((0, 0, 0), []), {})


def lane(n: int, lanes: int = 3) -> float:
    """The centre of a motorway's nth lane, counted from the hard shoulder, which is 0."""
    return -(3.75 * lanes + 1.5) if n == 0 else -(3.75 * (lanes - n) + 1.875)


ARMS = {"W": math.pi, "S": -math.pi / 2, "E": 0.0, "N": math.pi / 2}
RADIUS = 12.0  # of the junction, from its middle to the ends of the arms


def crossroads(hand: int, arms: str = "WSEN", control: str = "", limit: tuple[str, str] | None = None) -> World:
    """A junction at the origin. Roads lead inwards, so s grows towards it; ways have their s = 0 where they enter it.

    control: signs of the ego's arm, W: "206" stop, "205" give way, "light"; the line is 1 m before the arm's end.
    """
    reach = 200.0
    limit = limit or (("30", "mph") if hand < 0 else ("50", "km/h"))
    roads, ways, links, number = [], {}, "", 100
    came_in, go_out = (-1, 1) if hand > 0 else (1, -1)
    for n, arm in enumerate(arms, 1):
        a = ARMS[arm]
        far = RADIUS + reach
        road = Road(n, (far * math.cos(a), far * math.sin(a), a + math.pi), [(reach, 0)], [KERB, WALK], [KERB, WALK])
        road.limits, road.kind = [(0, *limit)], "town"
        road.links = '<successor elementType="junction" elementId="1"/>'
        if control == "light":
            road.signals = sign(10 * n, reach - 1, -4, hand, "1000001", moving=True)
            road.signals += sign(10 * n + 1, reach - 1, -2, hand, "294")
        elif control and arm in "WE":
            road.signals = sign(10 * n, reach - 1, -4, hand, control) + sign(10 * n + 1, reach - 1, -2, hand, "294")
        roads.append(road)
    for a, start in enumerate(arms, 1):
        for b, goal in enumerate(arms, 1):
            if a == b:
                continue
            number += 1
            heading = ARMS[start] + math.pi
            turn = (ARMS[goal] - heading + math.pi) % (2 * math.pi) - math.pi
            piece = (2 * RADIUS, 0.0)
            if abs(turn) > 0.1:
                piece = (RADIUS * math.pi / 2, math.copysign(1 / RADIUS, turn))
            begin = (RADIUS * math.cos(ARMS[start]), RADIUS * math.sin(ARMS[start]), heading)
            road = Road(number, begin, [piece], [("driving", 3.5, "none")], middle=[(0, "none")], kind="town")
            road.limits, road.junction = [(0, *limit)], 1
            road.links = (
                f'<predecessor elementType="road" elementId="{a}" contactPoint="end"/>'
                f'<successor elementType="road" elementId="{b}" contactPoint="end"/>'
            )
            road.lane_links = {came_in: f'<predecessor id="{came_in}"/><successor id="{go_out}"/>'}
            roads.append(road)
            links += (
                f'<connection id="{number}" incomingRoad="{a}" connectingRoad="{number}" contactPoint="start">'
                f'<laneLink from="{came_in}" to="{came_in}"/></connection>'
            )
            ways[start + goal] = Line(begin, [piece])
    junction = f'<junction id="1" name="crossroads" type="default">{links}</junction>'
    return World(hand, roads, junction, ways["W" + goal_of(arms)], ways)


def goal_of(arms: str) -> str:
    return "E" if "E" in arms else arms[1]


def motorway_exit(hand: int) -> World:
    """Two lanes and an exit lane for 600 m, where it parts; exit signs 300 m and 50 m before. u = 0 between them."""
    limit = [(0, "70", "mph") if hand < 0 else (0, "130", "km/h")]
    three: list[LaneSpec] = [("driving", 3.75, "broken"), ("driving", 3.75, "broken"), ("exit", 3.75, "solid")]
    inner, outer = (-1, -3) if hand > 0 else (1, 3)
    middle = [(0, "solid")]
    part = '<successor elementType="junction" elementId="1"/>'
    main = Road(1, (0, 0, 0), [(600, 0)], three, middle=middle, kind="motorway", limits=limit, links=part)
    main.signals = sign(30, 300, -13, hand, "333") + sign(31, 550, -13, hand, "333")
    on = Road(101, (600, 0, 0), [(60, 0)], three[:2], middle=middle, kind="motorway", limits=limit, junction=1)
    off = Road(102, (600, -7.5 * hand, 0), [(60, -hand / 300)], three[2:], middle=middle, kind="motorway", limits=limit)
    off.junction = 1
    end = (600 + 300 * math.sin(0.2), -hand * (7.5 + 300 * (1 - math.cos(0.2))), -0.2 * hand)
    beyond = Road(2, (660, 0, 0), [(600, 0)], three[:2], middle=middle, kind="motorway", limits=limit)
    slip = Road(3, end, [(300, 0)], three[2:], middle=middle, kind="motorway", limits=limit)
    for road, goal, pairs in ((on, beyond, [(inner, inner), (2 * inner, 2 * inner)]), (off, slip, [(outer, inner)])):
        number = goal.number
        before = '<predecessor elementType="road" elementId="1" contactPoint="end"/>'
        road.links = before + f'<successor elementType="road" elementId="{number}" contactPoint="start"/>'
        road.lane_links = {here: f'<predecessor id="{there}"/><successor id="{here}"/>' for there, here in pairs}
        goal.links = '<predecessor elementType="junction" elementId="1"/>'
    links = "".join(
        f'<connection id="{n}" incomingRoad="1" connectingRoad="{n}" contactPoint="start">{lanes}</connection>'
        for n, lanes in (
            (101, f'<laneLink from="{inner}" to="{inner}"/><laneLink from="{2 * inner}" to="{2 * inner}"/>'),
            (102, f'<laneLink from="{outer}" to="{inner}"/>'),
        )
    )
    junction = f'<junction id="1" name="exit" type="default">{links}</junction>'
    start = (0, -7.5 * hand, 0)
    ways = {"off": Line(start, [(600, 0), (60, -hand / 300)]), "on": Line(start, [])}
    return World(hand, [main, on, off, beyond, slip], junction, ways["on"], ways)


def bridge(hand: int) -> World:
    """A road to the east, and 7 m above it another to the north that crosses it at x = 300."""
    low = Road(1, (0, 0, 0), [(800, 0)], [LANE], [LANE], limits=[(0, "60", "mph")])
    high = Road(2, (300, -300, math.pi / 2), [(600, 0)], [LANE], [LANE], limits=[(0, "60", "mph")], height=7.0)
    above = Line((300, -300, math.pi / 2), [], zero=300)
    return World(hand, [low, high], "", Line((0, 0, 0), []), {"above": above})
