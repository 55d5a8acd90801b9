"""Overtaking on a country road, and what is declared of it."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.nineteenth.cast import OWN, oncoming, passing_place
from tests.outsiders.nineteenth.drive import Actor, Drive, draw
from tests.outsiders.nineteenth.maps import (
    KMH_100,
    LONG,
    country,
)
from tests.outsiders.nineteenth.road import Sign

OUT, AHEAD, BACK = passing_place(26, 15, 100, 4, 25)
OUT_LATER, AHEAD_LATER, _ = passing_place(26, 15, 100, 9, 25)
AHEAD_TWO = passing_place(25, 14, 90, 4, 8)[1]
FAST = passing_place(29, 15, 110, 4, 30)
ROUND_SLOW, SLOW_AHEAD, _ = passing_place(12, 4, 40, 4, 12, 3, 1.8)
ROUND_QUICK, QUICK_AHEAD, _ = passing_place(14, 7, 40, 4, 12, 3, 1.8)


def oncoming_and_lines() -> Iterator[Drive]:
    """Somebody comes the other way; lines that must not be crossed."""
    yield draw(
        "ov_near_oncoming",
        "gb-eng",
        country(),
        [Actor("ego", "car", LONG, 60, 26, OUT), Actor("v", "car", LONG, AHEAD, 15, OWN), oncoming(LONG, 1000, 24)],
        30,
        [
            (
                "ukhc.r162.safe-distance-ahead",
                "fail",
                "670 m at pull out; 13.5 s over the line at 50 m/s towards each other: it is just back when the other is there",
            ),
            ("rss.opposite", "fail", "some 15-60 m head on at 50 m/s when it comes back"),
            ("ukhc.r126.ds-disjoint", "fail", "both need 60 m and more to stop"),
            ("ukhc.r126.ds-av-out-of-ov", "fail", "within the other's stopping distance"),
        ],
    )
    yield draw(
        "ov_far_oncoming",
        "gb-eng",
        country(),
        [Actor("ego", "car", LONG, 60, 26, OUT), Actor("v", "car", LONG, AHEAD, 15, OWN), oncoming(LONG, 2700, 24)],
        30,
        [
            ("ukhc.r162.safe-distance-ahead", "pass", "2.5 km at pull out"),
            ("rss.opposite", "not fail", "1.5 km left when it is back"),
            ("ukhc.no-collision", "pass", "far"),
        ],
        hz=5,
    )
    yield draw(
        "ov_solid_own_solid",
        "gb-eng",
        country(middle="broken solid"),
        [Actor("ego", "car", LONG, 60, 26, OUT), Actor("v", "van", LONG, AHEAD, 15, OWN)],
        30,
        [("ukhc.r129.no-cross-solid", "fail", "the line on the ego's side is the solid one")],
    )
    yield draw(
        "ov_solid_slow_cyclist",
        "gb-eng",
        country(middle="solid solid"),
        [Actor("ego", "car", LONG, 60, 12, ROUND_SLOW), Actor("c", "bicycle", LONG, SLOW_AHEAD, 4, -2.9)],
        24,
        [
            ("ukhc.r129.no-cross-solid", "not fail", "a cyclist at 4 m/s (8.9 mph) may be passed"),
            ("ukhc.r163.cyclist", "pass", "1.75-0.9 to -2.6: 3.4 m"),
        ],
    )
    yield draw(
        "ov_solid_quick_cyclist",
        "gb-eng",
        country(middle="solid solid"),
        [Actor("ego", "car", LONG, 60, 14, ROUND_QUICK), Actor("c", "bicycle", LONG, QUICK_AHEAD, 7, -2.9)],
        24,
        [("ukhc.r129.no-cross-solid", "fail", "a cyclist at 7 m/s (15.7 mph) is faster than 10 mph")],
    )


def lines_that_end() -> Iterator[Drive]:
    """Lines that turn solid, and a sign."""
    yield draw(
        "ov_back_late",
        "gb-eng",
        country(middle=[(0.0, "broken"), (60 + 26 * (BACK - 3), "solid solid")]),
        [Actor("ego", "car", LONG, 60, 26, OUT), Actor("v", "car", LONG, AHEAD, 15, OWN)],
        30,
        [("ukhc.r128.back-before-solid", "fail", "the line turns solid 3 s before it begins to come back")],
    )
    yield draw(
        "ov_back_in_time",
        "gb-eng",
        country(middle=[(0.0, "broken"), (60 + 26 * (BACK + 8), "solid solid")]),
        [Actor("ego", "car", LONG, 60, 26, OUT), Actor("v", "car", LONG, AHEAD, 15, OWN)],
        30,
        [
            ("ukhc.r128.back-before-solid", "pass", "back 4.5 s before the line turns solid"),
            ("ukhc.r129.no-cross-solid", "not fail", "line broken where it crossed"),
        ],
    )
    yield draw(
        "ov_sign_level_de",
        "de",
        country(limit=KMH_100, signs=[Sign("n1", "276", 60 + 26 * 4 + 70, -4.5)]),
        [Actor("ego", "car", LONG, 60, 26, OUT), Actor("v", "car", LONG, AHEAD, 15, OWN)],
        30,
        [
            (
                "ukhc.r165.no-overtaking-sign",
                "fail",
                "sign passed after pulling out but 30 m and more before drawing level",
            )
        ],
        hz=5,
    )


def others_about() -> Iterator[Drive]:
    """Somebody behind, somebody ahead of the one that is passed."""
    yield draw(
        "ov_being_overtaken",
        "gb-eng",
        country(),
        [
            Actor("ego", "car", LONG, 200, 22, [(6, OWN), (9, 1.75), (16.5, 1.75), (20, OWN)]),
            Actor("v", "truck", LONG, 330, 12, OWN),
            Actor("b", "car", LONG, 110, [(0, 30), (7.5, 30), (10, 21), (60, 21)], [(2, OWN), (4.5, 1.75)]),
        ],
        24,
        [
            (
                "ukhc.r162.not-being-overtaken",
                "fail",
                "the other is out, some 30 m behind at 8 m/s more: 3.6 s; it has to brake",
            )
        ],
    )
    yield draw(
        "ov_no_room",
        "gb-eng",
        country(),
        [
            Actor(
                "ego",
                "car",
                LONG,
                60,
                [(0, 25), (11.84, 25), (14.84, 14), (60, 14)],
                [(4, OWN), (7.5, 1.75), (14.9, 1.75), (18.4, OWN)],
            ),
            Actor("v", "car", LONG, AHEAD_TWO, 14, OWN),
            Actor("w", "van", LONG, AHEAD_TWO + 2.25 + 12 + 2.75, 14, OWN),
        ],
        32,
        [
            (
                "ukhc.r162.return-gap",
                "fail",
                "12 m between the two; the ego is 4.5 m long and each wants thinking distance (9 m)",
            )
        ],
    )
    yield draw(
        "ov_tailgate",
        "gb-sct",
        country(),
        [
            Actor("ego", "car", LONG, 60, [(0, 15), (4, 15), (7, 24)], [(4, OWN), (6.5, 1.75), (11, 1.75), (14, OWN)]),
            Actor("v", "car", LONG, 60 + 4.5 + 7, 15, OWN),
        ],
        22,
        [
            ("ukhc.r163.pull-out-separation", "fail", "7 m at 15 m/s"),
            ("ukhc.r126.thinking-gap", "fail", "7 m for 4 s at 15 m/s: 0.47 s, thinking distance 10 m"),
        ],
    )


def long_and_fast() -> Iterator[Drive]:
    """A lorry with a trailer; too fast."""
    yield draw(
        "ov_truck_trailer",
        "gb-eng",
        country(),
        [
            Actor("ego", "car", LONG, 60, 26, OUT),
            Actor("v", "truck", LONG, AHEAD + 30, 15, OWN),
            Actor("vt", "trailer", LONG, AHEAD + 30 - 6 - 1 - 4, 15, OWN, size=(8.0, 2.5, 3.5)),
            oncoming(LONG, 1000, 24),
        ],
        30,
        [
            (
                "ukhc.r162.safe-distance-ahead",
                "fail",
                "670 m at pull out for a lorry and trailer: some 15 m left in the end",
            ),
            ("ukhc.r126.ds-ov-out-of-av", "fail", "the other comes within the ego's stopping distance"),
            ("ukhc.r163.pull-out-separation", "not fail", "over 100 m"),
        ],
    )
    yield draw(
        "ov_speeding",
        "gb-eng",
        country(),
        [Actor("ego", "car", LONG, 60, 29, FAST[0]), Actor("v", "car", LONG, FAST[1], 15, OWN)],
        26,
        [("ukhc.r124.speed-limit", "fail", "29 m/s is 64.9 mph where 60 holds: an overtake is no excuse")],
    )


def declared_decisions() -> Iterator[Drive]:
    """Declared decisions."""
    yield draw(
        "dec_no_go",
        "gb-eng",
        country(),
        [
            Actor("ego", "car", LONG, 60, 26, OUT_LATER, ind=[(0, "off"), (7, "left"), (12, "off")]),
            Actor("v", "car", LONG, AHEAD_LATER, 15, OWN),
        ],
        35,
        [
            ("declared.r162.go-before-overtaking", "fail", "last word was no"),
            ("declared.r166.confidence-at-commit", "fail", "last 0.6"),
            ("declared.r161.mirrors-before-signal", "fail", "looked only after the signal"),
        ],
        events=[
            (7.2, "mirror_check", "left"),
            (6.5, "confidence", "0.95"),
            (7.0, "overtake_go", None),
            (8.0, "confidence", "0.6"),
            (8.4, "overtake_no_go", None),
            (8.5, "blind_spot_check", "left"),
            (8.7, "mirror_check", "left"),
        ],
    )


def declared_looks() -> Iterator[Drive]:
    """Declared looks."""
    yield draw(
        "dec_wrong_side",
        "gb-eng",
        country(),
        [
            Actor("ego", "car", LONG, 60, 26, OUT, ind=[(0, "off"), (3, "left"), (7, "off")]),
            Actor("v", "car", LONG, AHEAD, 15, OWN),
        ],
        30,
        [
            ("declared.r163.checks-before-pull-out", "fail", "both looks to the other side"),
            ("declared.r166.confidence-at-commit", "pass", "exactly the least, 0.9"),
            ("declared.r161.mirrors-before-signal", "not pass", "it looked into the mirror of the other side"),
        ],
        events=[
            (2.0, "overtake_go", None),
            (2.2, "confidence", "0.9"),
            (2.5, "mirror_check", "right"),
            (3.6, "blind_spot_check", "right"),
        ],
    )
