"""The maps on which the drives go."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from tests.outsiders.fourth.movement import KMH, way
from tests.outsiders.fourth.road import Kinds, Lane, Road, Sections, Sign, World, stop_line

ORIGIN = (0.0, 0.0, 0.0)
SHOULDER = Lane("shoulder", 3.0, "none")


def side(count: int, width: float, *outer: Lane) -> list[Lane]:
    """`count` driving lanes with broken lines between them and a solid edge, then what lies further out."""
    marks = ["broken"] * (count - 1) + ["solid"]
    return [Lane("driving", width, mark) for mark in marks] + list(outer)


def two_lane(  # noqa: PLR0917
    kind: str,
    limit: float | None,
    length: float = 1500.0,
    walk: bool = False,
    curve: Sequence[tuple[float, float]] = (),
    types: Kinds = (),
    **more: Any,
) -> World:
    """A road with one lane each way along the x axis, with footways if asked for."""
    outer = [Lane("sidewalk", 2.0, "none")] if walk else []
    lanes = ((0.0, side(1, 3.5, *outer), side(1, 3.5, *outer)),)
    road = Road(1, ORIGIN, curve or ((length, 0.0),), lanes, types=types or ((0.0, kind, limit),), **more)
    return World([road])


def motorway(limit: float | None, count: int = 2) -> World:
    """One carriageway of a motorway along the x axis: lanes of 3.75 m, lane 1 the fast one, and a hard shoulder."""
    lanes: Sections = ((0.0, [], side(count, 3.75, SHOULDER)),)
    return World([Road(1, ORIGIN, ((2500.0, 0.0),), lanes, centre="solid", types=((0.0, "motorway", limit),))])


def exit_motorway(limit: float) -> World:
    """Two lanes; from x = 300 an exit lane beside them, which parts at x = 500 into a slip road to the near side."""
    one = [Lane("driving", 3.75, "broken", None, -1), Lane("driving", 3.75, "solid", None, -2)]
    one.append(Lane("shoulder", 3.0, "none", None, -4))
    two = [Lane("driving", 3.75, "broken", -1, -1), Lane("driving", 3.75, "broken", -2, -2)]
    two += [Lane("exit", 3.75, "solid", None, -1), Lane("shoulder", 3.0, "none", -3, None)]
    through = [Lane("driving", 3.75, "broken", -1, -1), Lane("driving", 3.75, "solid", -2, -2)]
    ramp = [Lane("exit", 3.75, "solid", -3, -1)]
    more: dict[str, Any] = {"centre": "solid", "types": ((0.0, "motorway", limit),)}
    before: dict[str, Any] = {**more, "junction": 100, "pred": ("road", 1, "end")}
    first: Sections = ((0.0, [], one), (300.0, [], two))
    roads = [
        Road(1, ORIGIN, ((500.0, 0.0),), first, succ=("junction", 100, ""), **more),
        Road(
            2,
            (520.0, 0.0, 0.0),
            ((900.0, 0.0),),
            ((0.0, [], side(2, 3.75, SHOULDER)),),
            pred=("road", 10, "end"),
            **more,
        ),
        Road(
            3,
            (520.0, -7.5, 0.0),
            ((200.0, -1 / 400), (300.0, 0.0)),
            ((0.0, [], side(1, 3.75)),),
            pred=("road", 11, "end"),
            **more,
        ),
        Road(10, (500.0, 0.0, 0.0), ((20.0, 0.0),), ((0.0, [], through),), succ=("road", 2, "start"), **before),
        Road(11, (500.0, -7.5, 0.0), ((20.0, 0.0),), ((0.0, [], ramp),), succ=("road", 3, "start"), **before),
    ]
    roads[0].signs.append(Sign("x1", 250.0, -11.0, "exit", "450"))
    return World(roads, [(1, 10, [(-1, -1), (-2, -2)]), (1, 11, [(-3, -1)])])


def entry_motorway(limit: float) -> World:
    """Two lanes with an entry lane beside them from x = 0 to x = 400, which then ends."""
    one = [Lane("driving", 3.75, "broken", None, -1), Lane("driving", 3.75, "broken", None, -2)]
    one.append(Lane("entry", 3.75, "solid"))
    two = [Lane("driving", 3.75, "broken", -1), Lane("driving", 3.75, "solid", -2), SHOULDER]
    types = ((0.0, "motorway", limit),)
    return World([Road(1, ORIGIN, ((1500.0, 0.0),), ((0.0, [], one), (400.0, [], two)), "solid", types)])


def bridge(limit: float) -> World:
    """A rural road along x, and a bridge 7 m above it along y at x = 300."""
    lanes, types = ((0.0, side(1, 3.5), side(1, 3.5)),), ((0.0, "rural", limit),)
    below = Road(1, ORIGIN, ((800.0, 0.0),), lanes, types=types)
    above = Road(2, (300.0, -400.0, math.pi / 2), ((800.0, 0.0),), lanes, types=types, height=7.0)
    return World([below, above])


def bend() -> World:
    """A country road with a bend of 60 m radius, to the left as drawn."""
    return two_lane("rural", 70 * KMH, curve=((100.0, 0.0), (94.0, 1 / 60), (400.0, 0.0)))


BEND = way(0, -1.75, bends=((100, 0), (61.75 * 94 / 60, 1 / 61.75)))  # along the right lane of that road


STARTS = {
    "w": (-212.0, 0.0, 0.0),
    "e": (212.0, 0.0, math.pi),
    "s": (0.0, -212.0, math.pi / 2),
    "n": (0.0, 212.0, -math.pi / 2),
}
NUMBER = {"w": 1, "e": 2, "s": 3, "n": 4}


def crossroads(limit: float, arms: str = "wesn", sign: str = "", lights: bool = False) -> World:
    """Arms of 200 m, 7 m wide, that end 12 m from the middle; signs stand on the arms s and n, lights on all."""
    types = ((0.0, "town", limit),)
    roads = [_arm(arm, types, sign if arm in "sn" else "", lights) for arm in arms]
    connections = []
    for a in arms:
        for b in arms:
            if a == b:
                continue
            hdg = STARTS[a][2]
            turn = math.remainder(STARTS[b][2] + math.pi - hdg, 2 * math.pi)
            shape = (24.0, 0.0) if abs(turn) < 0.1 else (12.0 * math.pi / 2, math.copysign(1 / 12, turn))
            start = (-12.0 * math.cos(hdg), -12.0 * math.sin(hdg), hdg)
            ident = 10 * NUMBER[a] + NUMBER[b]
            ways: Sections = ((0.0, [], [Lane("driving", 3.5, "none", -1, 1)]),)
            ends = (("road", NUMBER[a], "end"), ("road", NUMBER[b], "end"))
            roads.append(Road(ident, start, (shape,), ways, "none", types, 100, *ends))
            connections.append((NUMBER[a], ident, [(-1, -1)]))
    return World(roads, connections)


def _arm(arm: str, types: Kinds, sign: str, lights: bool) -> Road:
    lanes = ((0.0, side(1, 3.5), side(1, 3.5)),)
    road = Road(NUMBER[arm], STARTS[arm], ((200.0, 0.0),), lanes, types=types, succ=("junction", 100, ""))
    if sign:
        kind = {"stop": "206", "give_way": "205"}[sign]
        road.signs.append(Sign(f"{sign}_{arm}", 198.0, -4.0, sign, kind))
    if sign == "stop" or lights:
        road.areas.append(stop_line(f"line_{arm}", 199.0, -3.5, 0.0))
    if lights:
        road.signs.append(Sign(f"light_{arm}", 199.0, -4.0, "traffic_light", "1000001"))
    return road
