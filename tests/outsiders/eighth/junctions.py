"""Crossroads with lights or a stop sign, and a roundabout; arms are named by their angle, 0 to the east and 90 to the north."""

from __future__ import annotations

import math
from functools import cache
from typing import Final

import numpy as np

from tests.outsiders.eighth.road import Lane, Link, Map, Road, Section, Shape
from tests.outsiders.eighth.ways import Way, curve
from tests.outsiders.eighth.worlds import NONE, SOLID, straight

ARMS: Final = (0, 90, 180, 270)
STOP: Final = {True: ("stop", "601.1", "GB"), False: ("stop", "206", "DE")}
_REACH: Final = 14.0  # from the middle of a crossroads to its arms
_RING: Final = 10.0  # inner radius of a roundabout
_RIM: Final = 26.0  # from its middle to its arms
_SPLAY: Final = 25  # degrees between an arm and where its ways meet the ring

Names = tuple[int, int]


def crossroads(*, gb: bool = True, lights: bool = False, stop: bool = False, wide: float = 3.5) -> Map:
    """Four arms; lights and stop lines on all of them, or a stop sign in the west; the northern arm may be wider."""
    arms, ways = _crossroads(gb, wide)
    inwards = -1 if gb else 1
    for angle, arm in arms.items():
        if lights:
            arm.stop_line(f"s{angle}", 1.5, inwards).light(f"l{angle}", 1.0, inwards)
    if stop:
        arms[180].stop_line("s180", 1.5, inwards).sign("p180", 2.0, inwards, STOP[gb])
    lane = 1 if gb else -1
    links = tuple(Link(arms[a].number, road.number, (inwards, lane)) for (a, _), road in ways.items())
    return Map((*arms.values(), *ways.values()), ((100, links),))


def second_head(drawn: Map) -> Map:
    """One more light for the western arm's lane, at its near side."""
    drawn.roads[2].light("extra", 0.8, -1, -5.5)
    return drawn


@cache
def through(a: int, b: int, *, gb: bool = True, wide: float = 3.5) -> Way:
    """Over the crossroads, from one arm to another."""
    arms, ways = _crossroads(gb, wide)
    inwards, lane = (-1, 1) if gb else (1, -1)
    return arms[a].way(inwards) + ways[a, b].way(lane) + arms[b].way(-inwards)


def _crossroads(gb: bool, wide: float) -> tuple[dict[int, Road], dict[Names, Road]]:
    arms: dict[int, Road] = {}
    ways: dict[Names, Road] = {}
    for i, angle in enumerate(ARMS):
        h = math.radians(angle)
        place = (_REACH * math.cos(h), _REACH * math.sin(h), h)
        arms[angle] = straight(150.0, "town", gb=gb, place=place, number=i + 1, width=wide if angle == 90 else 3.5)
        arms[angle].before = ("junction", 100, "")
    inwards = -1 if gb else 1
    for a, b in ((a, b) for a in ARMS for b in ARMS if a != b):
        start, heading = arms[a].shape, math.radians(a) + math.pi
        turn = (b - a) % 360 - 180
        shape = Shape(start.x, start.y, heading, 2 * _REACH)
        if abs(turn) >= 1:
            turned = math.radians(turn)
            bend = math.tan(abs(turned) / 2) / _REACH * (1 if turn > 0 else -1)
            shape = Shape(start.x, start.y, heading, abs(turned / bend), bend)
        first, last = (wide if arm == 90 else 3.5 for arm in (a, b))
        lanes = (Lane("driving", first, "none"),)
        section = Section(0, lanes, ()) if gb else Section(0, (), lanes)
        road = Road(10 + len(ways), shape, (section,), gb, "town", arms[a].limit, arms[a].unit, NONE, 100)
        road.before, road.after = ("road", arms[a].number, "start"), ("road", arms[b].number, "start")
        road.flare = last - first
        road.joins = {1 if gb else -1: (inwards, -inwards)}
        ways[a, b] = road
    return arms, ways


def roundabout() -> Map:
    """A British roundabout of one lane, 5 m wide, with four arms."""
    arm, ring, past, way_in, way_out = _roundabout()
    junctions = []
    for i, angle in enumerate(ARMS):
        before = ring[(angle + 90) % 360].number
        links = [(before, past[angle], 1), (arm[angle].number, way_in[angle], -1), (before, way_out[angle], 1)]
        junctions.append((200 + i, tuple(Link(road, by.number, (lane, 1)) for road, by, lane in links)))
    roads = [road for part in (arm, ring, past, way_in, way_out) for road in part.values()]
    return Map(tuple(roads), tuple(junctions))


@cache
def round_to(a: int, b: int) -> Way:
    """Clockwise round the roundabout, from one arm to another."""
    arm, ring, past, way_in, way_out = _roundabout()
    way = arm[a].way(-1) + way_in[a].way(1)
    at = a
    while True:
        way = way + ring[at].way(1)
        at = (at - 90) % 360
        if at == b:
            return way + way_out[b].way(1) + arm[b].way(1)
        way = way + past[at].way(1)


@cache
def round_the_wrong_way() -> Way:
    """From the west anticlockwise round the roundabout, and out to the north."""
    arm = _roundabout()[0][180].way(-1)
    turns = np.linspace(math.radians(210), math.radians(420), 200)
    ring = np.column_stack([12.5 * np.cos(turns), 12.5 * np.sin(turns)])[:140]
    leaves = math.atan2(ring[-1, 1] - ring[-2, 1], ring[-1, 0] - ring[-2, 0])
    enter = curve(((-34, 1.75), _point(ring[0])), (0, math.radians(300)))
    leave = curve((_point(ring[-1]), (1.75, 45)), (leaves, math.radians(90)))
    return Way(np.vstack([arm.points[:-16], enter, ring, leave, np.array([(1.75, 60.0)])]))


@cache
def cut_corner() -> Way:
    """From the west to the south over the crossroads, entering the southern arm on its wrong side."""
    way = through(180, 270)
    down = -math.pi / 2
    over = curve(((-12, 1.2), (-1.0, -14.5)), (-0.3, down), 1.1)
    back = curve(((-1.0, -15), (1.75, -34)), (down, down))
    return Way(np.vstack([way.points[way.s < 140], over, back, np.array([(1.75, -120.0)])]))


def _point(place: np.ndarray) -> tuple[float, float]:
    return float(place[0]), float(place[1])


def _roundabout() -> tuple[dict[int, Road], ...]:
    parts: list[dict[int, Road]] = [{} for _ in range(5)]
    arm, ring, past, way_in, way_out = parts
    wide = (Section(0, (Lane("driving", 5.0),), ()),)
    for i, a in enumerate(ARMS):
        x, y = _polar(_RIM, a)
        arm[a] = straight(120, "town", number=i + 1, place=(x, y, math.radians(a)))
        arm[a].before = ("junction", 200 + i, "")
        after = ARMS.index((a - 90) % 360)
        bow = Shape(*_polar(_RING, a - _SPLAY), math.radians(a - _SPLAY - 90), _RING * math.radians(40), -1 / _RING)
        ring[a] = Road(20 + i, bow, wide, True, "town", 30, "mph", SOLID)
        ring[a].before, ring[a].after = ("junction", 200 + i, ""), ("junction", 200 + after, "")
    for i, a in enumerate(ARMS):
        before = ("road", ring[(a + 90) % 360].number, "end")
        mine, here = ("road", arm[a].number, "start"), ("road", ring[a].number, "start")
        on, off = math.radians(a - _SPLAY - 90), math.radians(a + _SPLAY - 90)
        bow = Shape(*_polar(_RING, a + _SPLAY), off, _RING * math.radians(2 * _SPLAY), -1 / _RING)
        inwards = _bend(_polar(_RIM, a), math.radians(a + 180), _polar(_RING, a - _SPLAY), on)
        outwards = _bend(_polar(_RING, a + _SPLAY), off, _polar(_RIM, a), math.radians(a))
        for road, shape, width, ends, lanes in (
            (past, bow, 5.0, (before, here), (1, 1)),
            (way_in, inwards, 3.5, (mine, here), (-1, 1)),
            (way_out, outwards, 5.0, (before, mine), (1, 1)),
        ):
            number = (40 if road is past else 50 if road is way_in else 60) + i
            section = Section(0, (Lane("driving", width, "none"),), ())
            road[a] = Road(number, shape, (section,), True, "town", 30, "mph", NONE, 200 + i, *ends)
            road[a].joins = {1: lanes}
        way_in[a].flare, way_out[a].flare = 1.5, -1.5
    return arm, ring, past, way_in, way_out


def _polar(radius: float, degrees: float) -> tuple[float, float]:
    return radius * math.cos(math.radians(degrees)), radius * math.sin(math.radians(degrees))


def _bend(start: tuple[float, float], h0: float, end: tuple[float, float], h1: float) -> Shape:
    """A curve from place to place as OpenDRIVE's cubics."""
    a, b = np.array(start), np.array(end)
    length = math.hypot(*(b - a))
    slope_a, slope_b = (length * np.array([math.cos(h), math.sin(h)]) for h in (h0, h1))
    turn = np.array([[math.cos(h0), math.sin(h0)], [-math.sin(h0), math.cos(h0)]])
    second, third = -3 * a + 3 * b - 2 * slope_a - slope_b, 2 * a - 2 * b + slope_a + slope_b
    factors = np.array([(0.0, 0.0), *(turn @ v for v in (slope_a, second, third))])
    cubics = tuple(
        (f"{letter}{axis}", float(factors[i, j])) for j, axis in enumerate("UV") for i, letter in enumerate("abcd")
    )
    fine = curve((start, end), (h0, h1), count=2000)
    total = float(np.hypot(*np.diff(fine, axis=0).T).sum())
    return Shape(*start, h0, total, 0.0, curve((start, end), (h0, h1)), h1, cubics)
