"""Gaps on German motorways."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.lines import side
from tests.outsiders.fourteenth.places import MID, OVER, SLOW, motorway
from tests.outsiders.fourteenth.scenes import behind


def german_gaps_a() -> Iterator[Drive]:
    de = motorway("de", at=(900.0, -900.0, -0.4), speed="120 km/h")
    g1 = "stvo.rg1"
    thw = "criticality.thw"
    yield behind(
        "de-8m",
        "30 m/s, 8 m behind",
        de,
        ((0, 30),),
        ((0, 30),),
        8.0,
        [(g1, "fail", "8 m, 11.1 m asked for"), (thw, "fail", "0.27 s")],
    )
    yield behind(
        "de-13m",
        "30 m/s, 21 m behind",
        de,
        ((0, 30),),
        ((0, 30),),
        21.0,
        [(g1, "pass", "21 m, 11.1 m asked for"), (thw, "fail", "0.7 s")],
        hz=20.0,
    )
    yield behind(
        "de-40m",
        "30 m/s, 40 m behind a van",
        de,
        ((0, 30),),
        ((0, 30),),
        40.0,
        [(g1, "pass", "40 m"), (thw, "pass", "1.33 s")],
        kind="van",
    )
    yield behind(
        "de-faster",
        "33 m/s closing to 20 m behind one of 27",
        de,
        ((0, 33), (9, 33), (11.5, 27)),
        ((0, 27),),
        78.0,
        [(g1, "fail", "at 33 behind 27 m/s 28.6 m are asked for, about 20 are left")],
    )
    yield behind(
        "de-lost-lead",
        "30 m/s, 7 m behind, the lead's track lost for 2 s",
        de,
        ((0, 30),),
        ((0, 30),),
        7.0,
        [(g1, "fail", "7 m, 11.1 m")],
        lost=(5.0, 7.0),
        kind=None,
        size=(4.6, 1.9, 1.5),
    )


def german_gaps_b() -> Iterator[Drive]:
    de = motorway("de", at=(900.0, -900.0, -0.4), speed="120 km/h")
    g1 = "stvo.rg1"
    s4 = "stvo.s4-truck"
    yield behind(
        "de-noise",
        "30 m/s, 6 m behind, positions shake by 0.1 m",
        de,
        ((0, 30),),
        ((0, 30),),
        6.0,
        [(g1, "fail", "6 m, 11.1 m")],
        noise=0.1,
        hz=20.0,
    )
    yield behind(
        "de-lorry-40",
        "lorry at 22 m/s, 40 m behind",
        de,
        ((0, 22),),
        ((0, 22),),
        40.0,
        [(s4, "fail", "40 m, 50 asked for")],
        ego_kind="truck",
        env=OVER,
        u=SLOW,
        kind="truck",
    )
    yield behind(
        "de-lorry-55",
        "lorry at 22 m/s, 55 m behind",
        de,
        ((0, 22),),
        ((0, 22),),
        55.0,
        [(s4, "pass", "55 m")],
        ego_kind="truck",
        env=OVER,
        u=SLOW,
        kind="van",
    )
    yield behind(
        "de-lorry-48",
        "bus at 22 m/s, 47.5 m behind",
        de,
        ((0, 22),),
        ((0, 22),),
        47.5,
        [(s4, "fail", "47.5 m, 50 asked for")],
        ego_kind="bus",
        env={"vehicle_class": "bus"},
        u=SLOW,
        kind="bus",
    )


def german_gaps_c() -> Iterator[Drive]:
    de = motorway("de", at=(900.0, -900.0, -0.4), speed="120 km/h")
    s4 = "stvo.s4-truck"
    late = side((0.0, MID), (4.0, MID), (7.0, SLOW))
    yield behind(
        "de-lorry-12",
        "lorry at 43 km/h, 20 m behind",
        de,
        ((0, 12),),
        ((0, 12),),
        20.0,
        [(s4, "not fail", "not faster than 50 km/h")],
        ego_kind="truck",
        env=OVER,
        u=SLOW,
    )
    yield behind(
        "de-lorry-cut-in",
        "a car comes in 35 m ahead of the lorry, which stays so for 14 s",
        de,
        ((0, 22),),
        ((0, 22),),
        35.0,
        [(s4, "fail", "35 m for 14 s, three allowed")],
        ego_kind="truck",
        env=OVER,
        u=SLOW,
        other_u=late,
        seconds=22.0,
    )
    yield behind(
        "de-lorry-cut-in-gone",
        "a faster car comes in 40 m ahead of the lorry and draws away",
        de,
        ((0, 22),),
        ((0, 26),),
        24.0,
        [(s4, "not fail", "beyond 50 m within 3 s of its coming")],
        ego_kind="truck",
        env=OVER,
        u=SLOW,
        other_u=late,
    )


def german_gaps() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from german_gaps_a()
    yield from german_gaps_b()
    yield from german_gaps_c()
