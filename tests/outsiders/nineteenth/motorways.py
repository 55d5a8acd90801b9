"""Motorways."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from tests.outsiders.nineteenth.drive import Actor, Drive, Knots, Lamps, Size, Wanted, draw, gaining, steady
from tests.outsiders.nineteenth.maps import (
    MOTORWAY_WIDTH,
    MPH_70,
    Exit,
    carriageway,
    middle_of,
)
from tests.outsiders.nineteenth.path import Path, line
from tests.outsiders.nineteenth.road import Limit, Map, Sign

MOTORWAY = line(2500)
LONG_BEND = Path(0, 0, 0, [(400, 0), (700, 1 / 900), (1400, 0)])
FAST, MIDDLE, SLOW = middle_of(1), middle_of(2), middle_of(3)
EXIT_SIGNS = [Sign("x3", "450", 460, -11, "exit_300"), Sign("x1", "450", 640, -11, "exit_100")]


def ego(
    speed: Knots, across: Knots, start: float = 60, cls: str = "car", *, path: Path = MOTORWAY, ind: Lamps = None
) -> Actor:
    """The ego on a motorway."""
    return Actor("ego", cls, path, start, speed, across, ind=ind)


def other(
    name: str,
    speed: Knots,
    across: Knots,
    start: float,
    cls: str = "car",
    *,
    path: Path = MOTORWAY,
    size: Size | None = None,
) -> Actor:
    """Somebody else on it."""
    return Actor(name, cls, path, start, speed, across, size=size)


def on_motorway(  # noqa: PLR0917
    name: str,
    nation: str,
    ego: Actor,
    others: Sequence[Actor],
    seconds: float,
    wanted: Sequence[Wanted],
    *,
    path: Path = MOTORWAY,
    limit: Limit = None,
    **more: Any,
) -> Drive:
    """A drive on a motorway of three lanes and a hard shoulder."""
    road = carriageway(path, 3, limit=limit or (MPH_70 if nation != "de" else None))
    return draw(name, nation, Map([road]), [ego, *others], seconds, wanted, **more)


def leaving(name: str, make: Callable[[Exit], Sequence[Actor]], wanted: Sequence[Wanted]) -> Drive:
    """A drive on a motorway with an exit."""
    road = Exit(EXIT_SIGNS)
    return draw(name, "gb-eng", road.map, make(road), 34, wanted)


def leaves(road: Exit, ind: Lamps) -> Sequence[Actor]:
    """The ego, which takes the exit."""
    moved = [(16.5, MOTORWAY_WIDTH * 2 + middle_of(2)), (20.5, MOTORWAY_WIDTH * 2 + middle_of(3))]
    return [Actor("ego", "car", road.off, 60, 27, moved, ind=ind)]


def distances() -> Iterator[Drive]:
    """Distances behind others."""
    yield on_motorway(
        "rg1_bend",
        "de",
        ego(32, 0, 300, path=LONG_BEND.offset(MIDDLE)),
        [other("l", 30.5, 0, 300 + 4.5 + 26, path=LONG_BEND.offset(MIDDLE))],
        14,
        [("stvo.rg1", "fail", "closes in to 5 m in a long bend")],
        hz=20,
        path=LONG_BEND,
    )
    yield on_motorway(
        "rg1_cut_restored",
        "de",
        ego(gaining(30, [(0, 0), (4, 0), (4.6, -1.9), (8, -1.9), (9, 0)]), MIDDLE),
        [other("l", 30, [(3, FAST), (6, MIDDLE)], 60 + 4.5 + 9)],
        16,
        [("stvo.rg1", "not fail", "9 m when it came in, more than 12 m within a second or two")],
    )
    yield on_motorway(
        "rg1_self_cut",
        "de",
        ego(31, [(3, SLOW), (6, MIDDLE)]),
        [other("l", 31, MIDDLE, 60 + 4.5 + 6)],
        14,
        [("stvo.rg1", "fail", "the ego itself moves in 6 m behind; no grace")],
    )


def braking_and_speed() -> Iterator[Drive]:
    """Braking for nothing, and for something; crawling; a change of lane."""
    yield on_motorway(
        "rg2_for_nothing",
        "de",
        ego(gaining(33, steady(-4, 5, 8)), MIDDLE),
        [],
        16,
        [
            ("stvo.rg2", "fail", "4 m/s2 for 2 s with nobody about"),
            ("comfort.decel-iso15622", "fail", "mean over 2 s is near 4 at 25-30 m/s, 3.5 allowed"),
        ],
    )
    yield on_motorway(
        "rg2_lead_brakes",
        "de",
        ego(gaining(31, steady(-3, 5.4, 9)), MIDDLE),
        [other("l", gaining(31, steady(-3.2, 4.9, 8.5)), MIDDLE, 60 + 4.5 + 35)],
        16,
        [("stvo.rg2", "not fail", "the one ahead braked first")],
    )
    yield on_motorway(
        "rg2_other_lane",
        "de",
        ego(gaining(31, steady(-3.5, 5.4, 8)), MIDDLE),
        [other("l", gaining(31, steady(-3.2, 4.9, 8.5)), FAST, 60 + 4.5 + 35)],
        16,
        [("stvo.rg2", "fail", "the one that braked is in another lane")],
    )
    yield on_motorway(
        "rg2_walker",
        "de",
        ego(gaining(31, steady(-5, 4, 7)), MIDDLE),
        [Actor("w", "pedestrian", Path(312, -14, math.pi / 2, [(30, 0)]), 0, 1.6, 0)],
        14,
        [("stvo.rg2", "not fail", "somebody walks onto the carriageway")],
    )
    yield on_motorway(
        "rg4_slow",
        "de",
        ego(17, SLOW),
        [],
        40,
        [("stvo.rg4", "fail", "61 km/h all the time, nobody ahead, limit 130")],
        limit=("130", "km/h"),
        hz=5,
    )
    yield on_motorway(
        "rg6_moto_left",
        "de",
        ego(28, [(4, MIDDLE), (7, FAST)], 200),
        [other("b", 40, FAST, 200 - 25 - 70, "motorcycle")],
        7,
        [("stvo.rg6", "fail", "a motorcycle at 40 m/s 30 m behind; 54 m are safe")],
        hz=20,
    )


def stopping() -> Iterator[Drive]:
    """Standing on a motorway."""
    yield on_motorway(
        "ri1_queue",
        "de",
        ego([(0, 22), (3, 22), (14, 0), (60, 0)], SLOW),
        [other("q", 0, SLOW, 60 + 66 + 121 + 4.5 + 5), other("q2", 0, SLOW, 60 + 66 + 121 + 15)],
        25,
        [("stvo.ri1", "pass", "a queue 5 m ahead"), ("ukhc.r240.no-stopping", "not fail", "behind a queue")],
    )
    yield on_motorway(
        "ri1_far_queue",
        "de",
        ego([(0, 22), (3, 22), (14, 0), (60, 0)], SLOW),
        [other("q", 0, SLOW, 60 + 66 + 121 + 4.5 + 70)],
        25,
        [("stvo.ri1", "fail", "the standing one is 70 m ahead")],
    )
    yield on_motorway(
        "ri1_breakdown",
        "de",
        ego([(0, 22), (3, 22), (14, 0), (60, 0)], -13.0, ind=[(0, "off"), (5, "hazard")]),
        [],
        25,
        [
            ("stvo.ri1", "not fail", "a breakdown on the shoulder with hazard lights"),
            ("ukhc.r269.hard-shoulder", "not fail", "hazard lights on at once, stops at 2 m/s2"),
        ],
    )


def on_the_wrong_side() -> Iterator[Drive]:
    """Past others on the wrong side, and backwards."""
    yield on_motorway(
        "ri2_queue",
        "de",
        ego(12, SLOW, 40),
        [other(f"q{i}", 9, MIDDLE, 60 + 22 * i) for i in range(5)],
        24,
        [("stvo.ri2", "pass", "a queue at 9 m/s passed at 12")],
    )
    yield on_motorway(
        "ri2_queue_fast",
        "de",
        ego(18, SLOW, 40),
        [other(f"q{i}", 9, MIDDLE, 80 + 22 * i) for i in range(5)],
        20,
        [("stvo.ri2", "fail", "a queue at 9 m/s passed at 18: 32 km/h more")],
    )
    yield on_motorway(
        "ri2_changed",
        "de",
        ego(33, [(1, MIDDLE), (4, SLOW), (14, SLOW), (17, MIDDLE)], 60),
        [other("a", 28, MIDDLE, 110)],
        22,
        [("stvo.ri2", "fail", "goes to the right, past, and back to the left")],
        hz=20,
    )
    yield on_motorway(
        "ri3_back",
        "de",
        ego([(0, 15), (8, 0), (12, 0), (13, -1.5), (18, -1.5), (19, 0), (30, 0)], -13.1, 300, ind=[(0, "hazard")]),
        [],
        24,
        [
            ("stvo.ri3", "fail", "reverses on the shoulder of a motorway"),
            ("ukhc.r263.no-reverse", "fail", "1.5 m/s backwards for 5 s"),
        ],
    )


def lorries_and_shoulders() -> Iterator[Drive]:
    """Lorries, the hard shoulder, hazard lights, astride."""
    yield on_motorway(
        "s4_trailer",
        "de",
        ego(22, SLOW, cls="truck"),
        [
            other("l", 22, SLOW, 60 + 12 + 55, "truck"),
            other("lt", 22, SLOW, 60 + 12 + 55 - 6 - 0.8 - 3.6, "trailer", size=(7.2, 2.5, 3.5)),
        ],
        15,
        [("stvo.s4-truck", "fail", "55 m to the lorry, 47 m to its trailer")],
        cond={"vehicle_class": "goods_over_7t5"},
        hz=20,
    )
    yield on_motorway(
        "right_lane_lorry",
        "gb-eng",
        ego(24, FAST, cls="truck"),
        [other("a", 22, MIDDLE, 100)],
        14,
        [("ukhc.r265.right-lane-ban", "fail", "a lorry over 7.5 t in the right-hand lane of three")],
        cond={"vehicle_class": "goods_over_7t5"},
    )
    yield on_motorway(
        "shoulder_drive",
        "gb-eng",
        ego(28, [(3, SLOW), (6, -12.5), (12, -12.5), (15, SLOW)]),
        [other("a", 20, SLOW, 110, "truck")],
        20,
        [("ukhc.r269.hard-shoulder", "fail", "passes a lorry on the hard shoulder")],
    )
    yield on_motorway(
        "hazards_mw",
        "gb-eng",
        ego([(0, 30), (5, 30), (12, 12), (40, 12)], MIDDLE, ind=[(0, "off"), (5, "hazard")]),
        [other("q", 8, MIDDLE, 600)],
        20,
        [
            ("ukhc.r116.hazards", "not fail", "warns of a queue on a motorway"),
            ("ukhc.r240.no-stopping", "not fail", "never stands"),
        ],
    )
    yield on_motorway(
        "astride",
        "gb-eng",
        ego(28, [(3, SLOW), (6, -7.5), (18, -7.5), (20, SLOW)]),
        [],
        25,
        [("ukhc.r131.keep-in-lane", "fail", "astride the line for more than 12 s")],
    )


def exits() -> Iterator[Drive]:
    """Leaving, or not."""
    yield leaving(
        "exit_no_signal",
        lambda x: leaves(x, ind="off"),
        [("ukhc.exit-sign-signal", "fail", "the exit sign at 640 m passed without signal; leaves")],
    )
    yield leaving(
        "exit_signal_stays",
        lambda x: [Actor("ego", "car", x.on, 60, 27, middle_of(2), ind=[(0, "off"), (18, "right"), (24, "off")])],
        [("ukhc.signal-then-leaves", "fail", "signals beside the exit lane, then goes on along the motorway")],
    )
