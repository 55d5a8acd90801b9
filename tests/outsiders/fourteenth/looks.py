"""Declared speeds and looks, and being overtaken."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go, side
from tests.outsiders.fourteenth.places import OPP, OWN, street
from tests.outsiders.fourteenth.scenes import alone, on


def looks_a() -> Iterator[Drive]:
    gb = street("gb", at=(4.0, 2.0, 0.9))
    speed = "declared.r125.chosen-speed-kept"
    why = "declared.r152.speed-reason"
    rev_rule = "declared.r202.checks-before-reversing"
    mirror = "declared.r161.mirrors-before-signal"
    rev = ((0, 5), (4, 0), (8, 0), (9.5, -2.0), (14, -2.0), (16, 0))
    yield alone(
        "chosen-23",
        "chose 20 m/s, drives 23",
        gb,
        ((0, 23),),
        [(speed, "fail", "23, 20 chosen"), (why, "fail", "no reason")],
        u=OWN,
        events=[(0.0, "chosen_speed", "20")],
    )
    yield alone(
        "chosen-lower",
        "chooses 15 m/s for the bend and is down in 4 s",
        gb,
        ((0, 20), (6, 20), (10, 14.6)),
        [(speed, "pass", "within the time to settle"), (why, "pass", "both with reason")],
        u=OWN,
        events=[(0.0, "chosen_speed", "20.5; dry road"), (6.0, "chosen_speed", "15; bend")],
    )
    yield alone(
        "reverse-unlooked",
        "reverses; mirrors but no blind spot",
        gb,
        rev,
        [(rev_rule, "fail", "no blind spot check")],
        u=OWN,
        turned=0.0,
        events=[(1.0, "blind_spot_check", None), (7.5, "mirror_check", None)],
    )
    yield alone(
        "reverse-looked",
        "reverses after both looks",
        gb,
        rev,
        [(rev_rule, "pass", "both")],
        u=OWN,
        turned=0.0,
        events=[(6.5, "blind_spot_check", None), (7.0, "mirror_check", None)],
    )
    yield alone(
        "signal-unlooked",
        "indicator 7 s after the mirrors",
        gb,
        ((0, 15),),
        [(mirror, "fail", "7 s old")],
        u=OWN,
        lamp=((0.0, "off"), (9.0, "left"), (12.0, "off")),
        events=[(2.0, "mirror_check", None)],
    )


def looks_b() -> Iterator[Drive]:
    gb = street("gb", at=(4.0, 2.0, 0.9))
    passed = "ukhc.r168.when-overtaken"

    def passer(v: float, back: float = 13.0) -> list[Actor]:
        u = side((0.0, OWN), (1.0, OWN), (3.5, OPP), (back, OPP), (back + 2.5, OWN))
        return [Actor("passer", "car", on(gb.course, go(70.0, (0, v)), u))]

    yield alone(
        "passed-speeds-up",
        "speeds up by 0.8 m/s2 while passed",
        gb,
        ((0, 17), (5, 17), (11, 21.8)),
        [(passed, "fail", "0.8 m/s2, 4.8 m/s gained")],
        u=OWN,
        others=passer(24.0),
    )
    yield alone(
        "passed-creeps-up",
        "gains 2.5 m/s little by little while passed",
        gb,
        ((0, 17), (3, 17), (13, 19.6)),
        [(passed, "fail", "2.6 m/s gained in the time")],
        u=OWN,
        others=passer(20.6, 17.0),
    )
    yield alone(
        "passed-steady", "steady while passed", gb, ((0, 17),), [(passed, "pass", "steady")], u=OWN, others=passer(23.0)
    )


def looks() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from looks_a()
    yield from looks_b()
