"""Bends, sudden speeds and late braking."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.places import street
from tests.outsiders.fourteenth.scenes import alone, behind


def hard_driving_a() -> Iterator[Drive]:
    gb = street("gb", at=(4.0, 2.0, 0.9))
    bend = street("de", bends=((120, 0.0), (400, 1 / 60), (200, 0.0)), at=(4.0, 2.0, 0.9))
    lat = "comfort.lateral"
    heavy = {"vehicle_class": "goods_over_7t5"}
    yield alone(
        "bend-car-15",
        "a car at 15 m/s in a bend of 60 m",
        bend,
        ((0, 15),),
        [(lat, "fail", "3.9 m/s2")],
        u=1.75,
        s0=40.0,
    )
    yield alone(
        "bend-car-126",
        "a car at 12.6 m/s in a bend of 60 m",
        bend,
        ((0, 12.6),),
        [(lat, "pass", "2.7 m/s2")],
        u=1.75,
        s0=40.0,
    )
    yield alone(
        "bend-lorry-126",
        "a lorry at 12.6 m/s in a bend of 60 m",
        bend,
        ((0, 12.6),),
        [(lat, "fail", "2.7 m/s2, lorries 2.5")],
        u=1.75,
        s0=40.0,
        kind="truck",
        env=heavy,
    )
    yield alone(
        "speeds-up-3",
        "3 m/s2 at 20 m/s",
        gb,
        ((0, 15), (5, 15), (9, 27)),
        [
            ("comfort.accel-iso15622", "fail", "3 m/s2 at 20 m/s, two allowed"),
            ("comfort.nuplan", "fail", "3, 2.4 allowed"),
        ],
        u=1.75,
    )
    yield alone(
        "speeds-up-15",
        "1.5 m/s2 from 12 to 24 m/s",
        gb,
        ((0, 12), (5, 12), (13, 24)),
        [("comfort.accel-iso15622", "pass", "1.5"), ("comfort.nuplan", "pass", "1.5")],
        u=1.75,
        hz=20.0,
    )


def hard_driving_b() -> Iterator[Drive]:
    gb = street("gb", at=(4.0, 2.0, 0.9))
    ttc = "criticality.ttc"
    drac = "criticality.drac"
    mttc = "criticality.mttc"
    ttb = "criticality.ttb"
    yield alone(
        "brakes-suddenly",
        "brakes from 0 to 4.5 m/s2 in a second",
        gb,
        ((0, 26), (6, 26), (9, 12.5)),
        [("comfort.jerk-iso15622", "fail", "4.5 m/s3 over a second, 2.5 allowed")],
        u=1.75,
    )
    yield behind(
        "late-brake",
        "comes up at 25 to one of 12 m/s and brakes very late",
        gb,
        ((0, 25), (6, 25), (7.8, 12)),
        ((0, 12),),
        94.0,
        [(ttc, "fail", "under 1.4 s at 6 s"), (drac, "fail", "over 4 m/s2"), (ttb, "fail", "under 1 s")],
        u=1.75,
    )
    yield behind(
        "early-brake",
        "comes up at 25 to one of 12 m/s and brakes early",
        gb,
        ((0, 25), (3, 25), (9, 12)),
        ((0, 12),),
        120.0,
        [(ttc, "pass", "over 3 s"), (drac, "pass", "under 3"), (ttb, "pass", "over 1 s")],
        u=1.75,
    )
    yield behind(
        "lead-brakes-hard",
        "20 m/s 14.5 m behind; it brakes with 7 m/s2, the ego 1 s later",
        gb,
        ((0, 20), (6.9, 20), (9.2, 3), (14, 3)),
        ((0, 20), (6, 20), (8.3, 4)),
        14.5,
        [(mttc, "fail", "about 1.3 s"), (ttc, "fail", "under a second")],
        u=1.75,
    )


def hard_driving() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from hard_driving_a()
    yield from hard_driving_b()
