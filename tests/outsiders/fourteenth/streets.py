"""Parked vehicles, the wrong side, lamps and the horn."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go, side
from tests.outsiders.fourteenth.maps import Lane
from tests.outsiders.fourteenth.places import OPP, OWN, street
from tests.outsiders.fourteenth.scenes import alone, on


def streets_a() -> Iterator[Drive]:
    gb = street("gb", kind="town", speed="30 mph", at=(4.0, 2.0, 0.9))
    give = "ukhc.r163.obstruction-give-way"
    wrong = "ukhc.r143.direction"
    round_it = side((0.0, OWN), (5.0, OWN), (8.0, -1.2), (11.0, -1.2), (14.0, OWN))
    stands = [Actor("p", "van", on(gb.course, go(205.0, (0, 0)), 2.4))]

    def meets(s: float, v: float) -> Actor:
        return Actor("o", "car", on(gb.course, go(s, (0, v), back=True), OPP, back=True))

    yields = Actor(
        "o", "car", on(gb.course, go(366.0, (0, 12), (8.0, 12), (10.5, 2), (13, 2), (16, 9), back=True), OPP, back=True)
    )
    walkway = street(
        "gb", kind="town", speed="30 mph", own=(Lane(mark="solid"), Lane(2.0, "sidewalk", "none")), at=(4.0, 2.0, 0.9)
    )
    yield alone(
        "parked-forces",
        "round a parked van; the oncoming car brakes hard",
        gb,
        ((0, 11),),
        [(give, "fail", "oncoming brakes with 4 m/s2")],
        u=round_it,
        others=[*stands, yields],
    )
    yield alone(
        "parked-clear",
        "round a parked van, the other 200 m away",
        gb,
        ((0, 11),),
        [(give, "not fail", "long back"), (wrong, "pass", "round something that stands")],
        u=round_it,
        others=[*stands, meets(480.0, 10)],
    )
    yield alone(
        "wrong-side",
        "20 s in the opposing lane for nothing",
        gb,
        ((0, 13),),
        [(wrong, "fail", "20 s at 13 m/s")],
        u=side((0.0, OWN), (3.0, OWN), (5.0, OPP), (25.0, OPP), (27.0, OWN)),
        seconds=30.0,
    )
    yield alone(
        "footway",
        "along the footway at 8 m/s for 3 s",
        walkway,
        ((0, 8),),
        [("ukhc.r145.off-road", "fail", "0.7 m on the footway at 8 m/s")],
        u=side((0.0, OWN), (5.0, OWN), (7.0, 3.3), (10.0, 3.3), (12.0, OWN)),
    )


def streets_b() -> Iterator[Drive]:
    gb = street("gb", kind="town", speed="30 mph", at=(4.0, 2.0, 0.9))
    night = {"light": "night"}
    yield alone(
        "parks-against",
        "stands 64 s at night facing the traffic",
        gb,
        ((0, 5), (3, 5), (6, 0)),
        [
            ("ukhc.r239.parked-with-traffic", "fail", "faces against"),
            ("ukhc.r248.parked-at-night", "fail", "faces against, night"),
        ],
        u=side((0.0, OWN), (1.0, OWN), (4.5, OPP - 0.6)),
        seconds=72.0,
        hz=2.0,
        env=night,
    )
    yield alone(
        "night-dark",
        "at night on a road of 60 mph with headlights off",
        street("gb"),
        ((0, 20),),
        [("ukhc.r113.headlights", "fail", "off, 60 mph")],
        u=OWN,
        env=night,
        events=[(0.0, "headlights", "off")],
    )
    yield alone(
        "night-dark-town",
        "at night in a street of 30 mph with headlights off",
        gb,
        ((0, 12),),
        [("ukhc.r115.dipped-headlights", "fail", "off"), ("ukhc.r113.headlights", "not fail", "lamps may excuse")],
        u=OWN,
        env=night,
        events=[(0.0, "headlights", "off")],
    )
    yield alone(
        "hazards-town",
        "hazard lights on for 6 s while driving in town",
        gb,
        ((0, 12),),
        [("ukhc.r116.hazards", "fail", "12 m/s in a street of 30 mph")],
        u=OWN,
        lamp=((0.0, "off"), (6.0, "hazard"), (12.0, "off")),
    )
    yield alone(
        "horn-standing",
        "sounds the horn, standing alone",
        gb,
        ((0, 8), (4, 0)),
        [("ukhc.r112.horn", "fail", "stands, nobody near")],
        u=OWN,
        events=[(0.0, "horn", "off"), (10.0, "horn", "on"), (11.0, "horn", "off")],
    )


def streets() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from streets_a()
    yield from streets_b()
