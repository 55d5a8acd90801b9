"""Driven against the reference line, on the lanes of its other side."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive, car
from tests.outsiders.fourteenth.lines import go
from tests.outsiders.fourteenth.places import FAST, MID, OVER, SLOW, Place, motorway, street
from tests.outsiders.fourteenth.scenes import alone, on


def turned_lines_a() -> Iterator[Drive]:
    gb = motorway("gb", at=(70.0, 10.0, 0.6))
    de = motorway("de", at=(70.0, 10.0, -0.6))
    road = street("gb", at=(70.0, 10.0, 1.6))

    def follow(place: Place, v: float, u: float, gap: float) -> tuple[Actor, list[Actor]]:
        me = car(on(place.course, go(1800.0, (0, v), back=True), u, back=True))
        ahead = on(place.course, go(1800.0 - gap - 4.5, (0, v), back=True), u, back=True)
        return me, [Actor("lead", "car", ahead)]

    short = follow(de, 13.89, -SLOW, 13.0)
    tight = follow(de, 31.0, -MID, 7.0)
    cyclist = Actor("b", "bicycle", on(road.course, go(530.0, (0, 5), back=True), -3.0, back=True))
    yield Drive(
        "against-line-alks",
        "50 km/h, 13 m behind, on the lanes of the other side",
        de,
        short[0],
        short[1],
        20.0,
        [("alks-r157.follow-gap", "fail", "13 m, table 20.8 m")],
        env={"engaged": "yes"},
    )
    yield Drive(
        "against-line-rg1",
        "31 m/s, 7 m behind, on the lanes of the other side",
        de,
        tight[0],
        tight[1],
        15.0,
        [("stvo.rg1", "fail", "7 m, 11.6 m"), ("stvo.ri3", "pass", "its lane's way")],
    )
    yield alone(
        "against-line-lorry",
        "lorry in the right lane of three, on the lanes of the other side",
        gb,
        ((0, 24),),
        [("ukhc.r265.right-lane-ban", "fail", "third lane"), ("ukhc.r143.direction", "pass", "its lane's way")],
        u=-FAST,
        kind="truck",
        env=OVER,
        s0=1500.0,
        back=True,
    )
    yield alone(
        "against-line-cyclist",
        "passes a cyclist at 0.8 m, on the lane of the other side",
        road,
        ((0, 13),),
        [("ukhc.r163.cyclist", "fail", "0.8 m")],
        u=-1.0,
        s0=600.0,
        back=True,
        others=[cyclist],
    )


def turned_lines() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from turned_lines_a()
