"""The maps on which the drives go: streets, motorways, a bridge."""

from __future__ import annotations

import math
from typing import Any

from tests.outsiders.third.movement import MPH
from tests.outsiders.third.road import Area, Lane, Link, Map, Marks, Road, Section, Sign
from tests.outsiders.third.ways import Way

START = 300.0  # straight roads begin so far before x = 0
PAVEMENT = (Lane("sidewalk", 2.0, "none"),)
PARKING = (Lane("parking", 3.0), Lane("sidewalk", 2.0, "none"))


def straight(
    centre: str | Marks = "broken",
    limit: float | None = 60 * MPH,
    kind: str | None = "rural",
    *,
    beside: tuple[Lane, ...] = (),
    things: tuple[Sign | Area, ...] = (),
    until: float = 1200.0,
) -> Map:
    """A road with a lane each way; the places of things and of changes of the middle line are given in x."""
    marks = ((0.0, centre),) if isinstance(centre, str) else tuple((max(x + START, 0), mark) for x, mark in centre)
    lanes = (Lane("driving"), *beside)
    way = Way(-START, 0, 0, [(START + until, 0)])
    moved = tuple(thing.moved(START) for thing in things)
    return Map((Road(1, way, (Section(0, lanes, lanes, marks),), kind, limit, things=moved),))


def town(limit: float | None = 30 * MPH, **more: Any) -> Map:
    """A road in a town, with a footway on both sides."""
    return straight(limit=limit, kind="town", **{"beside": PAVEMENT, **more})


def zebra(x: float, name: str = "zebra", light: bool = False) -> tuple[Sign | Area, ...]:
    """A crossing of 4 m at x, with a light and a stop line 2 m before it if it is signalled."""
    crossing = Area("crossing", "crosswalk", name, x - 2, x + 2, -3.5, 3.5)
    if not light:
        return (crossing,)
    line = Area("line", "stopLine", "stopLine", x - 4.2, x - 3.9, 0.1, 3.4)
    return crossing, line, Sign("light", "traffic_light", x - 4, 4.0, "OpenDRIVE", "1000001")


MEDIAN = Lane("median", 2.0)


def lane_of(number: int, of: int) -> float:
    """Place across of a motorway lane: 1 is the one furthest from the middle, 0 the hard shoulder beside it."""
    return 2.0 + 3.5 * (of - number) + (1.75 if number else -0.25 + 1.75)


def motorway(lanes: int = 3, limit: float | None = 70 * MPH, kind: str | None = "motorway", extra: str = "") -> Map:
    """Two carriageways with a reserve between them; extra: a lane for joining beside lane 1 from x = 0 to 400."""
    drive = (*(Lane("driving", 3.5, "broken"),) * (lanes - 1), Lane("driving", 3.5, "solid"))
    edge = (Lane("shoulder", 3.0, "none"),)
    plain = (MEDIAN, *drive, *edge)
    way = Way(-START, 0, 0, [(START + 1700, 0)])
    sections: tuple[Section, ...] = (Section(0, plain, plain, ((0, "none"),)),)
    if extra:
        wider = (MEDIAN, *drive[:-1], Lane("driving", 3.5, "broken"), Lane(extra, 3.5), *edge)
        wide = Section(START, wider, plain, ((0, "none"),))
        sections = (sections[0], wide, Section(START + 400, plain, plain, ((0, "none"),)))
    return Map((Road(1, way, sections, kind, limit),))


def exit_map() -> Map:
    """A motorway of two lanes whose exit lane, from x = 0 on, parts from it at x = 300; a sign stands at x = -60."""
    fast, kind = 70 * MPH, "motorway"
    shoulder = Lane("shoulder", 3.0, "none")
    drive = (Lane("driving", 3.5, "broken"), Lane("driving"))
    open_drive = (Lane("driving", 3.5, "broken"), Lane("driving", 3.5, "broken"))
    first = (
        Section(0, (MEDIAN, *drive, shoulder), (), ((0, "solid"),)),
        Section(START, (MEDIAN, *open_drive, Lane("exit"), shoulder), (), ((0, "solid"),)),
    )
    things = (Sign("exit", "exit", START - 60, 13.0, "", "-1"),)
    join = ("successor", "junction", 9, "")
    one = Road(1, Way(-START, 0, 0, [(START + 300, 0)]), first, kind, fast, joins=(join,), things=things)
    main = (Section(0, (MEDIAN, *drive), (), ((0, "solid"),)),)
    ramp = (Section(0, (Lane("exit"),), (), ((0, "solid"),)),)
    way_main, way_ramp = Way(300, 0, 0, [(60, 0)]), Way(300, 9.0, 0, [(60, 1 / 300)])
    before = ("predecessor", "road", 1, "end")
    on = ((2, "predecessor", 2), (2, "successor", 2), (3, "predecessor", 3), (3, "successor", 3))
    off = ((1, "predecessor", 4), (1, "successor", 1))
    two = Road(2, way_main, main, kind, fast, 9, (before, ("successor", "road", 4, "start")), on)
    three = Road(3, way_ramp, ramp, kind, fast, 9, (before, ("successor", "road", 5, "start")), off)
    after = (Section(0, (MEDIAN, *drive, shoulder), (), ((0, "solid"),)),)
    four = Road(4, Way(360, 0, 0, [(900, 0)]), after, kind, fast, joins=(("predecessor", "road", 2, "end"),))
    five = Road(5, Way(*way_ramp.end, [(300, 0)]), ramp, kind, fast, joins=(("predecessor", "road", 3, "end"),))
    return Map((one, two, three, four, five), (Link(9, 1, 2, ((2, 2), (3, 3))), Link(9, 1, 3, ((4, 1),))))


EXIT_WAY = Way(-START, 9.0, 0, [(START + 300, 0), (60, 1 / 300), (300, 0)], START)  # along the inner edge of the exit


def bridge() -> Map:
    """A road east and, six metres above it, one north; they do not meet."""
    lanes = (Lane("driving"),)
    low = Road(1, Way(-START, 0, 0, [(1000, 0)]), (Section(0, lanes, lanes),))
    high = Road(2, Way(0, -START, math.pi / 2, [(1000, 0)]), (Section(0, lanes, lanes),), z=6.0)
    return Map((low, high))


def curve(radius: float, limit: float) -> tuple[Map, Way]:
    """A rural road with a bend to the near side that begins at s = 0, and its way."""
    way = Way(-START, 0, 0, [(START, 0), (radius * 1.4, 1 / radius), (300, 0)], START)
    lanes = (Lane("driving"), Lane("shoulder", 1.0, "none"))
    road = Road(1, Way(-START, 0, 0, [p[3:] for p in way.geometry]), (Section(0, lanes, lanes),), "rural", limit)
    return Map((road,)), way
