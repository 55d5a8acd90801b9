"""The automated driver: the gap to the vehicle ahead."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go
from tests.outsiders.fourteenth.places import FAST, MID, ON, SLOW, motorway
from tests.outsiders.fourteenth.scenes import behind, on


def gaps_a() -> Iterator[Drive]:
    gb = motorway("gb", at=(500.0, -200.0, 0.7))
    de = motorway("de", at=(-1500.0, 900.0, 2.4))
    rule = "alks-r157.follow-gap"
    first = behind(
        "alks-gap-15",
        "50 km/h, 15 m behind: 20.8 m asked for",
        de,
        ((0, 13.89),),
        ((0, 13.89),),
        15.0,
        [(rule, "fail", "15 m, table 20.8 m")],
        env=ON,
    )
    second = behind(
        "alks-gap-24",
        "50 km/h, 24 m behind",
        de,
        ((0, 13.89),),
        ((0, 13.89),),
        24.0,
        [(rule, "pass", "24 m, table 20.8 m")],
        env=ON,
        hz=20.0,
    )
    s0 = 100 + 2.25 + 9.0 + 5.0
    tow = behind(
        "alks-gap-trailer",
        "30 km/h, 9 m behind a trailer, 20 m behind its lorry",
        gb,
        ((0, 8.33),),
        ((0, 8.33),),
        20.0,
        [(rule, "fail", "9 m to the trailer, table 10.8 m")],
        kind="truck",
        env=ON,
        u=SLOW,
        more=[Actor("trailer", "trailer", on(gb.course, go(s0, (0, 8.33)), SLOW))],
    )
    creep = behind(
        "alks-creep",
        "5 km/h, 1.3 m behind: 2 m is the least",
        gb,
        ((0, 1.4),),
        ((0, 1.4),),
        1.3,
        [(rule, "fail", "1.3 m, never less than 2 m")],
        env=ON,
        u=FAST,
    )
    yield first
    yield second
    yield tow
    yield creep


def gaps_b() -> Iterator[Drive]:
    gb = motorway("gb", at=(500.0, -200.0, 0.7))
    de = motorway("de", at=(-1500.0, 900.0, 2.4))
    rule = "alks-r157.follow-gap"
    creep2 = behind(
        "alks-creep-kept",
        "5 km/h, 2.9 m behind",
        gb,
        ((0, 1.4),),
        ((0, 1.4),),
        2.9,
        [(rule, "pass", "2.9 m, 2 m asked for")],
        env=ON,
        u=FAST,
        kind="bus",
    )
    eats = behind(
        "alks-eats-the-gap",
        "steady lead, the ego closes from 34 to 12 m by itself",
        de,
        ((0, 13.9), (4, 15.4), (18, 15.4)),
        ((0, 13.9),),
        34.0,
        [(rule, "fail", "about 10 m at 15 m/s in the end, by its own doing")],
        env=ON,
        seconds=22.0,
    )
    shrinks = behind(
        "alks-lead-slows",
        "lead slows from 14 to 11 m/s, ego makes the gap anew within 8 s",
        de,
        ((0, 13.9), (6, 13.9), (9, 9.5), (14, 9.5), (17, 11)),
        ((0, 13.9), (4, 13.9), (6, 11)),
        22.0,
        [(rule, "not fail", "others took the distance, soon restored")],
        env=ON,
        seconds=24.0,
    )
    curve = motorway("de", bends=((200, 0.0), (900, 1 / 500), (600, -1 / 450)), at=(20, 40, -1.0))
    bent = behind(
        "alks-gap-in-bend",
        "40 km/h in a bend, 10 m behind a motorcycle at the lane's side",
        curve,
        ((0, 11.11),),
        ((0, 11.11),),
        10.0,
        [(rule, "fail", "10 m, table 15.6 m")],
        env=ON,
        kind="motorcycle",
        u=SLOW,
        other_u=SLOW + 1.1,
    )
    yield creep2
    yield eats
    yield shrinks
    yield bent


def gaps_c() -> Iterator[Drive]:
    de = motorway("de", at=(-1500.0, 900.0, 2.4))
    rule = "alks-r157.follow-gap"
    curve = motorway("de", bends=((200, 0.0), (900, 1 / 500), (600, -1 / 450)), at=(20, 40, -1.0))
    nobody = behind(
        "alks-next-lane",
        "40 km/h, the other is in the next lane",
        curve,
        ((0, 11.11),),
        ((0, 11.11),),
        4.0,
        [(rule, "not fail", "not the ego's lane")],
        env=ON,
        u=SLOW,
        other_u=MID,
    )
    off = behind(
        "alks-not-engaged",
        "50 km/h, 12 m behind, but driven by a person",
        de,
        ((0, 13.89),),
        ((0, 13.89),),
        12.0,
        [(rule, "not fail", "the system does not drive")],
        env={"engaged": "no"},
    )
    yield nobody
    yield off


def gaps() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from gaps_a()
    yield from gaps_b()
    yield from gaps_c()
