"""British motorways."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.lines import side
from tests.outsiders.fourteenth.places import FAST, MID, OVER, SHOULDER, SLOW, motorway
from tests.outsiders.fourteenth.scenes import alone, behind


def british_motorways_a() -> Iterator[Drive]:
    gb = motorway("gb", at=(10.0, 10.0, 0.1))
    two = motorway("gb", lanes=2, at=(10.0, 10.0, 0.1))
    ban = "ukhc.r265.right-lane-ban"
    sh = "ukhc.r269.hard-shoulder"
    yield alone(
        "gb-lorry-right",
        "lorry over 7.5 t in the right lane of three",
        gb,
        ((0, 24),),
        [(ban, "fail", "third of three lanes")],
        u=FAST,
        kind="truck",
        env=OVER,
    )
    yield alone(
        "gb-lorry-middle",
        "lorry over 7.5 t in the middle lane",
        gb,
        ((0, 24),),
        [(ban, "pass", "second of three lanes")],
        u=MID,
        kind="truck",
        env=OVER,
    )
    yield alone(
        "gb-tow-right",
        "car with a trailer in the right lane for some seconds",
        gb,
        ((0, 25),),
        [(ban, "fail", "third of three lanes for 6 s")],
        u=side((0.0, MID), (4.0, MID), (7.0, FAST), (13.0, FAST), (16.0, MID)),
        env={"vehicle_class": "car_towing"},
    )
    yield alone(
        "gb-lorry-two",
        "lorry in the right lane of two",
        two,
        ((0, 24),),
        [(ban, "not fail", "two lanes")],
        u=FAST,
        kind="truck",
        env=OVER,
    )
    yield alone(
        "gb-shoulder",
        "along the hard shoulder at 20 m/s for 15 s",
        gb,
        ((0, 20),),
        [(sh, "fail", "no emergency")],
        u=side((0.0, SLOW), (2.0, SLOW), (5.0, SHOULDER), (18.0, SHOULDER), (21.0, SLOW)),
        seconds=24.0,
    )


def british_motorways_b() -> Iterator[Drive]:
    gb = motorway("gb", at=(10.0, 10.0, 0.1))
    sh = "ukhc.r269.hard-shoulder"
    r131 = "ukhc.r131.keep-in-lane"
    breakdown = ((0, 20), (5, 20), (13, 0))
    down = side((0.0, SLOW), (3.0, SLOW), (8.0, SHOULDER))
    long = side((0.0, SLOW), (4.0, SLOW), (7.0, 8.7), (20.0, 8.7), (23.0, SLOW))
    yield alone(
        "gb-breakdown",
        "breaks down with hazard lights and rolls out on the shoulder",
        gb,
        breakdown,
        [(sh, "not fail", "a breakdown with hazard lights")],
        u=down,
        lamp=((0.0, "off"), (3.0, "hazard")),
        seconds=40.0,
        hz=5.0,
    )
    yield alone(
        "gb-astride", "astride two lanes for 13 s", gb, ((0, 28),), [(r131, "fail", "13 s")], u=long, seconds=26.0
    )
    yield alone(
        "gb-weaves",
        "over the line for 2 s and back",
        gb,
        ((0, 28),),
        [(r131, "pass", "2 s")],
        u=side((0.0, SLOW), (5.0, SLOW), (7.0, 9.3), (9.0, SLOW)),
    )
    yield alone(
        "gb-stops",
        "stops in the middle lane for 10 s",
        gb,
        ((0, 20), (4, 20), (13, 0), (23, 0), (26, 8)),
        [("ukhc.r240.no-stopping", "fail", "10 s")],
        u=MID,
        seconds=28.0,
    )
    yield alone(
        "gb-reverses",
        "reverses 25 m on the hard shoulder",
        gb,
        ((0, 0), (4, 0), (6, -3.0), (14, -3.0), (16, 0)),
        [("ukhc.r263.no-reverse", "fail", "3 m/s")],
        u=SHOULDER,
        turned=0.0,
        s0=500.0,
        lamp=((0.0, "hazard"),),
    )


def british_motorways_c() -> Iterator[Drive]:
    gb = motorway("gb", at=(10.0, 10.0, 0.1))
    think = "ukhc.r126.thinking-gap"
    yield behind(
        "gb-12m",
        "27 m/s, 12 m behind",
        gb,
        ((0, 27),),
        ((0, 27),),
        12.0,
        [(think, "fail", "12 m, thinking distance 18 m")],
    )
    yield behind("gb-25m", "27 m/s, 26 m behind", gb, ((0, 27),), ((0, 27),), 26.0, [(think, "pass", "26 m")])
    yield behind(
        "gb-bike-9m",
        "27 m/s, 9 m behind a motorcycle of unknown class at the lane's side",
        gb,
        ((0, 27),),
        ((0, 27),),
        9.0,
        [(think, "not pass", "9 m, 18 m")],
        kind=None,
        size=(2.2, 0.8, 1.4),
        other_u=MID - 1.2,
    )
    yield alone(
        "gb-hazards-motorway",
        "hazard lights on while driving on the motorway",
        gb,
        ((0, 28),),
        [("ukhc.r116.hazards", "not fail", "motorway")],
        lamp=((0.0, "hazard"),),
    )


def british_motorways() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from british_motorways_a()
    yield from british_motorways_b()
    yield from british_motorways_c()
