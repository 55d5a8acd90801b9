"""Lane changes at length."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive, car
from tests.outsiders.fourteenth.lines import go, side
from tests.outsiders.fourteenth.places import FAST, MID, ON, OVER, SLOW, motorway
from tests.outsiders.fourteenth.scenes import alone, behind, comes_in, on, over


def own_changes_a() -> Iterator[Drive]:
    de = motorway("de", bends=((300, 0.0), (1200, -1 / 900), (900, 1 / 800)), at=(-80.0, 33.0, 1.1))
    to_mid = side((0.0, SLOW), (5.0, SLOW), (9.0, MID))
    twice = ((5.0, SLOW), (10.0, MID), (15.0, MID), (20.0, FAST))
    first = over(twice, 8.7, 0.9)
    second = 15.0 + over(((0.0, MID), (5.0, FAST)), 5.1, 0.9)
    lamps = ((0.0, "off"), (first - 4.0, "left"), (first + 3.0, "off"), (second - 1.5, "left"), (second + 3.0, "off"))
    long = side((0.0, SLOW), (6.0, SLOW), (9.0, 9.6), (17.0, 7.8), (20.0, MID))

    def ahead(gap: float, v: float, size: float = 4.5) -> list[Actor]:
        return [Actor("lead", "car", on(de.course, go(100 + gap + (size + 4.5) / 2, (0, v)), MID))]

    me = car(on(de.course, go(100.0, (0, 26)), side(*twice)), lamp=lamps)
    yield Drive(
        "r79-second",
        "two changes; the second's indicator comes 1.5 s before the line",
        de,
        me,
        [],
        26.0,
        [("alks-r157.r79.lane-change", "fail", "first 4 s, second 1.5 s")],
        env=ON,
        hz=20.0,
    )
    yield alone(
        "r79-lorry-long",
        "a lorry takes 8 s to get over",
        de,
        ((0, 21),),
        [("alks-r157.r79.lane-change-done", "not fail", "heavy vehicles have ten seconds")],
        u=long,
        kind="truck",
        env=ON | OVER,
        seconds=26.0,
    )
    yield alone(
        "de-out-behind-8m",
        "moves out to 8 m behind one of the same speed, then drops back in 3 s",
        de,
        ((0, 30), (8, 30), (10, 26), (13, 26), (15, 29)),
        [
            ("stvo.rg1", "fail", "8 m, 11.1 asked for at once of one who changes itself"),
            ("criticality.thw", "fail", "0.27 s, asked for at once"),
        ],
        u=to_mid,
        others=ahead(8.0, 30.0),
    )


def own_changes_b() -> Iterator[Drive]:
    de = motorway("de", bends=((300, 0.0), (1200, -1 / 900), (900, 1 / 800)), at=(-80.0, 33.0, 1.1))
    to_mid = side((0.0, SLOW), (5.0, SLOW), (9.0, MID))

    def ahead(gap: float, v: float, size: float = 4.5) -> list[Actor]:
        return [Actor("lead", "car", on(de.course, go(100 + gap + (size + 4.5) / 2, (0, v)), MID))]

    yield alone(
        "de-lorry-out-38m",
        "the lorry moves out to 38 m behind another",
        de,
        ((0, 22),),
        [("stvo.s4-truck", "fail", "38 m, asked for at once")],
        u=to_mid,
        kind="truck",
        env=OVER,
        others=ahead(38.0, 22.0, 12.0),
        seconds=12.0,
    )
    yield alone(
        "de-swings-right",
        "behind a slow one it goes to the right lane and past it there",
        de,
        ((0, 31),),
        [("stvo.ri2", "fail", "31 past 27 m/s on the right, no queue")],
        u=side((0.0, MID), (3.0, MID), (6.5, SLOW), (16.0, SLOW), (19.0, MID)),
        others=ahead(36.0, 27.0),
        seconds=24.0,
    )
    yield comes_in(
        "de-cut-in-short",
        "another comes in 9 m ahead; 2 s later the ego has 14 m again",
        ((0, 30), (6.0, 30), (7.2, 26.5), (9, 26.5), (11, 30)),
        ((0, 30),),
        9.0,
        [("stvo.rg1", "not fail", "others took it; over 11 m within 2.5 s")],
        env={},
    )
    yield comes_in(
        "de-cut-in-stays",
        "another comes in 6 m ahead and the ego stays so",
        ((0, 30),),
        ((0, 30),),
        6.0,
        [("stvo.rg1", "fail", "6 m for 18 s, three allowed")],
        env={},
        hz=5.0,
    )


def own_changes_c() -> Iterator[Drive]:
    de = motorway("de", bends=((300, 0.0), (1200, -1 / 900), (900, 1 / 800)), at=(-80.0, 33.0, 1.1))
    yield alone(
        "mrm-jolt",
        "a jolt of 6 m/s2 for 0.3 s in a minimal risk manoeuvre",
        de,
        ((0, 25), (6, 25), (6.3, 23.2), (6.4, 22.9), (11, 13)),
        [("alks-r157.mrm", "pass", "above 4 for 0.35 s only")],
        soft=0.05,
        env=ON,
        lamp=((0.0, "off"), (5.0, "hazard")),
        events=[(0.0, "minimal_risk_manoeuvre", "off"), (5.0, "minimal_risk_manoeuvre", "on")],
    )
    yield behind(
        "thw-just-under",
        "24 m/s, 20.2 m behind a lorry of unknown class",
        de,
        ((0, 24),),
        ((0, 24),),
        20.2,
        [("criticality.thw", "fail", "0.84 s, 0.9 asked for")],
        kind=None,
        size=(16.5, 2.5, 4.0),
        hz=5.0,
    )
    yield behind(
        "thw-just-over",
        "24 m/s, 23 m behind",
        de,
        ((0, 24),),
        ((0, 24),),
        23.0,
        [("criticality.thw", "pass", "0.96 s")],
        hz=5.0,
    )


def own_changes() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from own_changes_a()
    yield from own_changes_b()
    yield from own_changes_c()
