"""What might be excused for too long."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go, side
from tests.outsiders.fourteenth.places import MID, ON, OPP, OWN, SLOW, lit, motorway, stop_arm, street
from tests.outsiders.fourteenth.scenes import alone, behind, on, over, pass_by, turn


def excuses_a() -> Iterator[Drive]:
    gb = street("gb", length=1600.0, at=(12.0, -3.0, -0.7))
    mw = motorway("gb", at=(12.0, -3.0, -0.7))
    bike = Actor("b", "bicycle", on(gb.course, go(150.0, (0, 4)), 3.0))
    stays = side((0.0, OWN), (2.0, OWN), (4.0, 0.3), (19.0, 0.3), (21.0, OWN))
    out = side((0.0, OWN), (4.0, OWN), (6.5, OPP))
    slow = Actor("slow", "car", on(gb.course, go(184.5, (0, 13)), OWN))
    half = side((0.0, SLOW), (4.0, SLOW), (7.0, 8.7), (20.0, 8.7), (22.0, MID))
    de_stop = stop_arm("de")
    yield alone(
        "astride-after-cyclist",
        "passes a cyclist and stays over the middle line for 13 s more",
        gb,
        ((0, 13),),
        [
            ("ukhc.r131.keep-in-lane", "fail", "0.6 m over the middle for 13 s more with nobody near"),
            ("ukhc.r163.cyclist", "not fail", "1.5 m at 29 mph"),
        ],
        u=stays,
        others=[bike],
        seconds=40.0,
    )
    yield alone(
        "stays-out-after-pass",
        "passes a car and stays in the opposing lane for 25 s",
        gb,
        ((0, 20),),
        [("ukhc.r143.direction", "fail", "25 s there after the car was passed")],
        u=out,
        others=[slow],
        seconds=40.0,
    )
    yield alone(
        "half-a-change",
        "13 s astride, then over to the next lane",
        mw,
        ((0, 26),),
        [("ukhc.r131.keep-in-lane", "fail", "over 13 s, ten allowed")],
        u=half,
        seconds=27.0,
    )
    yield turn(
        "stop-de-half-second",
        "halts 0.4 m before the line for 0.5 s",
        de_stop,
        "N",
        ((0, 10), (3, 10), (11.92, 0), (12.42, 0), (15, 8)),
        [("stvo.rin1", "fail", "half a second, one asked for")],
        hz=20.0,
    )


def excuses_b() -> Iterator[Drive]:
    de = motorway("de", at=(12.0, -3.0, -0.7))
    level = street("gb", length=1600.0, at=(12.0, -3.0, -0.7))
    level.road.sign("no1", 240.0, "632", country="GB", name="no_overtaking")
    gb_stop = stop_arm("gb")
    first = Actor(
        "first", "car", on(gb_stop.way("S", "N"), go(51.5, (0, 9), (2, 9), (12, 0), (13.5, 0), (16.5, 9)), OWN)
    )
    minimal = [(0.0, "minimal_risk_manoeuvre", "off"), (5.0, "minimal_risk_manoeuvre", "on")]
    yield turn(
        "stop-second-in-line",
        "halts behind the one at the line, then rolls over it",
        gb_stop,
        "N",
        ((0, 9), (2, 9), (12.9, 0), (16.2, 0), (18.2, 3), (26, 6)),
        [("ukhc.r171.stop-sign", "fail", "no halt of its own at the line")],
        others=[first],
        seconds=28.0,
    )
    yield turn(
        "light-red-02",
        "over the line 0.25 s before green",
        lit("gb"),
        "N",
        ((0.0, 10.0),),
        [("ukhc.r175.red", "fail", "red at 7.48 s")],
        lights={"tl": ((0.0, "red"), (7.7, "green"))},
        hz=20.0,
    )
    yield pass_by(
        "pass-level-banned",
        level,
        "pulls out before a no-overtaking sign and draws level after it",
        [("ukhc.r165.no-overtaking-sign", "fail", "draws level about 60 m after the sign")],
    )
    yield alone(
        "mrm-08",
        "4.9 m/s2 for 0.9 s in a minimal risk manoeuvre",
        de,
        ((0, 25), (6, 25), (6.9, 20.59), (11, 12)),
        [("alks-r157.mrm", "fail", "4.9 for 0.9 s")],
        soft=0.1,
        env=ON,
        hz=20.0,
        lamp=((0.0, "off"), (5.0, "hazard")),
        events=minimal,
    )


def excuses_c() -> Iterator[Drive]:
    de = motorway("de", at=(12.0, -3.0, -0.7))
    said = [(0.0, "emergency_manoeuvre", "off")]
    changed = ((8.0, SLOW), (13.0, MID))
    at = over(changed, 8.7, 0.9)
    yield alone(
        "emergency-08",
        "5.8 m/s2 for 0.9 s, not declared",
        de,
        ((0, 25), (6, 25), (6.9, 19.78), (11, 12)),
        [("alks-r157.emergency", "fail", "5.8 for 0.9 s")],
        soft=0.1,
        env=ON,
        hz=20.0,
        events=said,
    )
    yield alone(
        "de-reverses-fast",
        "stands, then reverses at 8 m/s on the motorway",
        de,
        ((0, 12), (14, 12), (18, 0), (20.1, 0), (22.1, -8), (30, -8), (34, 0)),
        [
            ("stvo.ri3", "fail", "8 m/s backwards"),
            ("ukhc.r263.no-reverse", "fail", "8 m/s backwards"),
            ("comfort.lateral", "not fail", "straight back"),
        ],
        s0=700.0,
        turned=0.0,
        seconds=36.0,
    )
    yield behind(
        "thw-dips",
        "closes to 0.8 s for a second and falls back",
        de,
        ((0, 25), (4, 25), (6, 28), (8, 24.2), (13, 25)),
        ((0, 25),),
        25.5,
        [("criticality.thw", "fail", "under 0.85 s for a second")],
        hz=20.0,
    )
    yield alone(
        "r79-hazard",
        "hazard lights 4 s before the line in place of the indicator",
        de,
        ((0, 25),),
        [("alks-r157.r79.lane-change", "fail", "no side was told")],
        u=side(*changed),
        env=ON,
        lamp=((0.0, "off"), (at - 4.0, "hazard"), (at + 3.0, "off")),
    )


def excuses_d() -> Iterator[Drive]:
    gb_stop = stop_arm("gb")
    yield turn(
        "stop-08",
        "halts 0.85 m before the line",
        gb_stop,
        "N",
        ((0, 10), (3, 10), (11.79, 0), (14, 0), (17, 8)),
        [("performance.precise-stop", "fail", "0.8 m, half a metre allowed")],
    )


def excuses() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from excuses_a()
    yield from excuses_b()
    yield from excuses_c()
    yield from excuses_d()
