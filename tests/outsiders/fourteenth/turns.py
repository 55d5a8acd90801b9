"""Turning and crossing at junctions."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go, side, walk
from tests.outsiders.fourteenth.places import EDGE, OWN, Cross, crossroads
from tests.outsiders.fourteenth.scenes import on, turn


def turns_a() -> Iterator[Drive]:
    gb = crossroads("gb", at=(5.0, 5.0, 0.0))
    de = crossroads("de", at=(5.0, 5.0, -0.8))
    gap = "ukhc.r180.right-turn-gap"
    cut = "ukhc.r180.corner-cut"
    slow = ((0, 9), (6, 9), (9, 6))

    def against(place: Cross, s0: float, v: float, to: str = "S") -> Actor:
        return Actor("o", "car", on(place.way("N", to), go(s0, (0, v)), OWN))

    short = side((0.0, OWN), (8.0, OWN), (10.5, -1.2), (12.8, -1.2), (15.0, OWN))
    yield turn(
        "across-close",
        "turns right a second before the oncoming car",
        gb,
        "E",
        slow,
        [(gap, "fail", "under 1.5 s between them")],
        others=[against(gb, -8.0, 11.0)],
    )
    yield turn(
        "across-room",
        "turns right 6 s before the oncoming car",
        gb,
        "E",
        slow,
        [(gap, "pass", "over 4 s")],
        others=[against(gb, -60.0, 11.0)],
    )
    yield turn(
        "across-de-close",
        "turns left a second before the oncoming van in Germany",
        de,
        "W",
        slow,
        [(gap, "fail", "under 1.5 s between them"), ("criticality.pet", "fail", "under 1.5 s")],
        others=[against(de, -8.0, 11.0)],
    )
    yield turn(
        "corner-cut", "cuts the corner by 2 m", gb, "E", slow, [(cut, "fail", "about 2 m on the other side")], u=short
    )
    yield turn(
        "corner-cut-little",
        "cuts the corner by 0.8 m",
        gb,
        "E",
        slow,
        [(cut, "fail", "0.8 m on the other side, 0.3 allowed")],
        u=side((0.0, OWN), (6.0, OWN), (10.0, 0.1), (14.0, 0.1), (17.0, OWN)),
    )
    yield turn("corner-kept", "turns right round the middle", gb, "E", slow, [(cut, "pass", "own side")])


def turns_b() -> Iterator[Drive]:
    gb = crossroads("gb", at=(5.0, 5.0, 0.0))
    keep = "ukhc.r183.keep-in"
    h2 = "ukhc.h2.turn-pedestrian"
    slow = ((0, 9), (6, 9), (9, 6))

    def foot(place: Cross, to: str, t: float, u0: float, u1: float) -> Actor:
        # on the arm's mouth, 4 m out: straight across from u0 at t to u1
        course = place.way("S", to)
        s = EDGE + place.r * 1.5708 + 4.0
        return Actor("f", "pedestrian", walk(course, (0.0, s, u0), (t, s, u0), (t + abs(u1 - u0) / 1.4, s, u1)))

    wide = side((0.0, OWN), (9.0, OWN), (11.0, 0.9))
    yield turn(
        "near-wide",
        "turns left and comes out 1.7 m from the edge",
        gb,
        "W",
        slow,
        [(keep, "fail", "1.7 m, 1.5 allowed")],
        u=wide,
    )
    yield turn("near-kept", "turns left in the middle of the lane", gb, "W", slow, [(keep, "pass", "0.85 m")])
    yield turn(
        "near-walker",
        "turns left just before somebody who crosses the mouth",
        gb,
        "W",
        slow,
        [(h2, "fail", "under 1.5 s")],
        others=[foot(gb, "W", 12.5, 4.5, -4.5)],
    )
    yield turn(
        "near-walker-gone",
        "turns left when somebody has long crossed",
        gb,
        "W",
        slow,
        [(h2, "not fail", "gone")],
        others=[foot(gb, "W", 1.0, 4.5, -4.5)],
    )


def turns_c() -> Iterator[Drive]:
    gb = crossroads("gb", at=(5.0, 5.0, 0.0))
    h3 = "ukhc.h3.no-cut-across"
    slow = ((0, 9), (6, 9), (9, 6))

    def bike(place: Cross, s0: float, v: float) -> Actor:
        return Actor("b", "bicycle", on(place.way("S", "N"), go(s0, (0, v)), 2.9))

    midway = side((0.0, 0.6), (9.0, 0.6))
    yield turn(
        "near-hook",
        "passes a cyclist and turns left before it",
        gb,
        "W",
        slow,
        [
            (h3, "fail", "under 1.5 s between them"),
            ("ukhc.r131.keep-in-lane", "fail", "after the turn 0.3 m over the middle for 7 s, nobody near"),
        ],
        others=[bike(gb, 62.0, 5.4)],
        u=midway,
    )
    yield turn(
        "near-hook-behind",
        "lets the cyclist go first",
        gb,
        "W",
        ((0, 9), (3, 9), (6, 4.5), (20, 4.5)),
        [(h3, "not fail", "the cyclist was through before")],
        others=[bike(gb, 75.0, 6.0)],
        u=midway,
        seconds=24.0,
    )
    yield turn(
        "junction-hit",
        "crosses and is struck in the side",
        gb,
        "N",
        ((0, 9),),
        [("ukhc.no-collision", "fail", "struck in the middle")],
        others=[Actor("o", "car", on(gb.way("W", "E"), go(20.0, (0, 11.0)), OWN))],
    )
    yield turn(
        "junction-queue",
        "stands 10 s in the junction behind a queue",
        gb,
        "N",
        ((0, 9), (7, 9), (11.2, 0), (21.5, 0), (24, 6)),
        [("ukhc.r151.side-roads-clear", "fail", "10 s in the junction")],
        others=[Actor("q", "van", on(gb.way("S", "N"), go(128.0, (0, 1), (5, 1), (8, 0), (21, 0), (24, 7)), OWN))],
        seconds=27.0,
    )


def turns() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from turns_a()
    yield from turns_b()
    yield from turns_c()
