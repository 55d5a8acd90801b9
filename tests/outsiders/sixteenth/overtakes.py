"""Overtaking on roads of one lane each way."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import DE, ENGLAND, GB, OPPOSING, OWN, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import rural
from tests.outsiders.sixteenth.road import Sign
from tests.outsiders.sixteenth.ways import Motion, against, along


def _oncoming() -> Iterator[Drive]:
    yield draw(
        "overtake-into-oncoming",
        rural(limit=27.78, length=2500),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (9, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 12), (5, 12), (9, 22), (26, 22)],
                    100,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 12, 129.5)),
            Actor("onc", "car", Motion(against(2400), 25, 1660, OWN)),
        ],
        DE,
        26,
        [
            ("rss.opposite", "fail", "oncoming 25 m/s, meets it"),
            ("ukhc.no-collision", "fail", "head on at 15 s"),
            ("ukhc.r162.safe-distance-ahead", "fail", "oncoming too near"),
            ("ukhc.overtake-zone", "not pass", "too near"),
        ],
    )
    yield draw(
        "overtake-oncoming-gb",
        rural(length=2500),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (9, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 12), (5, 12), (9, 22), (26, 22)],
                    100,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 12, 129.5)),
            Actor("onc", "car", Motion(against(2400), 24, 1575, OWN)),
        ],
        ENGLAND,
        26,
        [
            ("ukhc.overtake-zone", "fail", "back 0.3 s before it meets the oncoming car"),
            ("ukhc.no-collision", "pass", "back in time"),
            ("ukhc.r126.ds-disjoint", "fail", "no room to stop"),
            ("rss.opposite", "fail", "no room"),
        ],
    )


def _others() -> Iterator[Drive]:
    yield draw(
        "overtake-second-in-gap",
        rural(length=2500),
        [
            ego(
                along(
                    [(0, OWN), (5, OWN), (8, OPPOSING), (13, OPPOSING), (16, OWN)],
                    [(0, 12), (5, 12), (8, 17), (13, 17), (16, 12)],
                    100,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 12, 129.5)),
            Actor("second", "car", along(OWN, 12, 150)),
        ],
        GB,
        26,
        [
            (
                "ukhc.r162.return-gap",
                "fail",
                "16 m between the slow one and the next: no room for 4.5 m and thinking distance before and behind",
            )
        ],
    )
    yield draw(
        "overtake-being-overtaken",
        rural(length=2500),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (9, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 12), (5, 12), (9, 22), (26, 22)],
                    100,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 12, 129.5)),
            Actor("rear", "car", along(OPPOSING, [(0, 24), (7, 24), (9, 18), (11, 18), (13, 21)], -3.5)),
        ],
        GB,
        26,
        [("ukhc.r162.not-being-overtaken", "fail", "somebody in the passing lane at 24, about 25 m behind")],
    )


def _tailgating_and_sign() -> Iterator[Drive]:
    yield draw(
        "overtake-tailgate",
        rural(length=2500),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (9, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 14), (5, 14), (9, 22), (26, 22)],
                    100,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 14, 112.5)),
        ],
        GB,
        26,
        [
            ("ukhc.r163.pull-out-separation", "fail", "8 m and less at 14 m/s"),
            ("ukhc.r126.thinking-gap", "fail", "8 m < 9.4"),
        ],
    )
    yield draw(
        "overtake-no-sign",
        rural(length=2500, sign=Sign("no", 60, -5.0, "632", "GB")),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (9, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 12), (5, 12), (9, 22), (26, 22)],
                    20,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 12, 49.5)),
        ],
        GB,
        26,
        [("ukhc.r165.no-overtaking-sign", "fail", "sign 40 m behind the start")],
    )


def _lines() -> Iterator[Drive]:
    yield draw(
        "overtake-runs-into-solid",
        rural(
            length=2500,
            middle=(
                ("solid broken", 0),
                ("solid solid", 260),
            ),
        ),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (9, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 12), (5, 12), (9, 22), (26, 22)],
                    100,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 12, 129.5)),
        ],
        GB,
        26,
        [("ukhc.r128.back-before-solid", "fail", "from 260 m on solid, back at about 370")],
    )
    yield draw(
        "overtake-broken-own-side",
        rural(length=2500, middle=(("solid broken", 0),)),
        [
            ego(
                along(
                    [(0, OWN), (6, OWN), (9, OPPOSING), (14, OPPOSING), (17, OWN)],
                    [(0, 12), (5, 12), (9, 22), (26, 22)],
                    100,
                ),
                ind=[(0, "off"), (4, "left"), (9, "off"), (14, "right"), (17, "off")],
            ),
            Actor("slow", "car", along(OWN, 12, 129.5)),
        ],
        GB,
        26,
        [
            ("ukhc.r129.no-cross-solid", "pass", "own side broken"),
            ("ukhc.r128.back-before-solid", "not fail", "stays broken"),
        ],
    )


def overtakes() -> Iterator[Drive]:
    yield from _oncoming()
    yield from _others()
    yield from _tailgating_and_sign()
    yield from _lines()
