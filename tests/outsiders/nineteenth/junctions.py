"""Junctions."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tests.outsiders.nineteenth.cast import halting
from tests.outsiders.nineteenth.drive import Actor, Drive, draw, gaining
from tests.outsiders.nineteenth.maps import (
    Cross,
    Roundabout,
)
from tests.outsiders.nineteenth.path import Path

ARM = Cross.length
BEFORE_LINE = ARM - 1.0 - 0.15  # the near edge of the stop line


def turning_before(name: str, x: float, speed: float, verdict: str, why: str) -> Drive:
    """The ego turns to the near side before somebody who walks across the road that it enters."""
    c = Cross()
    return draw(
        name,
        "gb-eng",
        c.map,
        [
            Actor("ego", "car", c.route(180, 270), ARM - 30, [(0, 7), (3, 5), (60, 5)]),
            Actor("w", "pedestrian", Path(x, -17.0, math.pi, [(40, 0)]), 0, speed),
        ],
        16,
        [("ukhc.h2.turn-pedestrian", verdict, why)],
    )


def mirrored_way(c: Roundabout) -> Path:
    """Return the wrong way round: in by one arm and, as a turn to the near side mirrored, out by the arm on the far side."""
    turned = [(length, -k) for length, k in c.ways[180, 270].bends]
    return Path(-c.edge - 60, 2.0, 0, [(60, 0), *turned, (60, 0)])


def stopping_at_lines() -> Iterator[Drive]:
    """Stop signs and lights."""
    c = Cross(signed=(180,))
    yield draw(
        "stop_short_halt",
        "de",
        c.map,
        [Actor("ego", "car", c.route(180, 270), 60, halting(9, 60, BEFORE_LINE - 2.25 - 0.6, 0.4))],
        26,
        [
            ("ukhc.r171.stop-sign", "pass", "halts for 0.4 s, 0.6 m before the line"),
            ("stvo.rin1", "fail", "less than a second"),
        ],
        hz=20,
    )
    c = Cross(signed=(180,))
    yield draw(
        "stop_good",
        "de",
        c.map,
        [Actor("ego", "car", c.route(180, 270), 60, halting(9, 60, BEFORE_LINE - 2.25 - 0.3, 2.5))],
        28,
        [
            ("ukhc.r171.stop-sign", "pass", "halts 0.3 m before the line"),
            ("stvo.rin1", "pass", "2.5 s"),
            ("performance.precise-stop", "pass", "0.3 m"),
        ],
    )
    c = Cross(lit=(180,))
    yield draw(
        "red_amber_jump",
        "gb-eng",
        c.map,
        [Actor("ego", "car", c.route(180, 0), 60, halting(11, 60, BEFORE_LINE - 2.25 - 1.4, 5))],
        26,
        [
            ("ukhc.r175.red", "fail", "goes over the line on red with amber"),
            ("performance.precise-stop", "fail", "stood 1.4 m before the line"),
        ],
        lights=[("tl180", 0, "red"), ("tl180", 16.0, "red_amber"), ("tl180", 24, "green")],
    )
    c = Cross(lit=(180, 90))
    yield draw(
        "other_light_red",
        "gb-eng",
        c.map,
        [Actor("ego", "car", c.route(180, 0), 60, 11)],
        16,
        [("ukhc.r175.red", "pass", "its light is green; the red one is the side road's")],
        lights=[("tl180", 0, "green"), ("tl90", 0, "red")],
    )


def turning_across() -> Iterator[Drive]:
    """A blocked junction, turns across the oncoming traffic."""
    c = Cross(lit=(180,))
    rt = c.route(180, 0)
    yield draw(
        "green_blocked",
        "gb-eng",
        c.map,
        [
            Actor("ego", "car", rt, 60, halting(9, 60, ARM + 10, 9)),
            Actor("q", "car", rt, ARM + 10 + 4.5 + 2, [(0, 0), (20.5, 0), (23.5, 8), (60, 8)]),
        ],
        28,
        [("ukhc.r176.green-exit-clear", "fail", "stands in the junction for 9 s behind a car")],
        lights=[("tl180", 0, "green")],
    )
    c = Cross()
    rt = c.route(180, 90)
    yield draw(
        "across_brakes",
        "gb-eng",
        c.map,
        [
            Actor("ego", "car", rt, ARM - 30, [(0, 8), (3, 6), (60, 6)]),
            Actor(
                "o", "van", c.route(0, 180), ARM - 62, gaining(12, [(0, 0), (3.2, 0), (3.6, -4.5), (5.6, -4.5), (6, 0)])
            ),
        ],
        14,
        [("ukhc.r180.right-turn-gap", "fail", "the other has to brake with 4.5 m/s2")],
    )
    c = Cross()
    yield draw(
        "corner_cut",
        "gb-eng",
        c.map,
        [Actor("ego", "car", c.route(180, 90), ARM - 50, 6, [(7, 0), (10.5, 2.4), (13.5, 2.4), (16, 0)])],
        18,
        [("ukhc.r180.corner-cut", "fail", "enters the road 1.5 m over its middle")],
    )


def turning_near_side() -> Iterator[Drive]:
    """Turns to the near side."""
    c = Cross()
    yield draw(
        "hook",
        "gb-eng",
        c.map,
        [
            Actor(
                "ego",
                "car",
                c.route(180, 270),
                ARM - 60,
                [(0, 9), (5, 9), (7, 5), (60, 5)],
                [(0, 0), (2, 0.6), (60, 0.6)],
            ),
            Actor("c", "bicycle", c.route(180, 0), ARM - 46, 5, -1.2),
        ],
        16,
        [
            ("ukhc.h3.no-cut-across", "fail", "passes the cyclist and turns a second before it"),
            ("ukhc.r182.no-pass-before-turn", "fail", "got ahead of it a second or two before the turn"),
        ],
    )
    c = Cross()
    yield draw(
        "hook_waits",
        "gb-eng",
        c.map,
        [
            Actor("ego", "car", c.route(180, 270), ARM - 50, [(0, 5), (6, 5), (8, 2), (10, 2), (13, 5), (60, 5)]),
            Actor("c", "bicycle", c.route(180, 0), ARM - 38, 5, -1.2),
        ],
        18,
        [
            ("ukhc.h3.no-cut-across", "not fail", "stays behind the cyclist"),
            ("ukhc.r182.no-pass-before-turn", "pass", "got ahead of nobody"),
        ],
    )
    c = Cross()
    yield draw(
        "wide_turn_far",
        "gb-eng",
        c.map,
        [Actor("ego", "car", c.route(180, 270), ARM - 40, 5, [(0, 0), (7, 0), (9.5, 1.6)])],
        16,
        [("ukhc.r183.keep-in", "fail", "2.4 m left between it and the near edge")],
    )
    yield turning_before("turn_walker", 13.6, 1.4, "fail", "the walker comes into its way a second after")


def crossing_ways() -> Iterator[Drive]:
    """Ways that cross; a roundabout."""
    c = Cross()
    yield draw(
        "pet_cross",
        "gb-eng",
        c.map,
        [Actor("ego", "car", c.route(180, 0), ARM - 50, 11), Actor("o", "car", c.route(90, 270), ARM - 50 - 13.5, 11)],
        14,
        [("criticality.pet", "fail", "about a second between the two"), ("ukhc.no-collision", "pass", "no contact")],
    )
    ring = Roundabout()
    yield draw(
        "round_ok",
        "gb-eng",
        ring.map,
        [
            Actor("ego", "car", ring.route(180, 90), 40, [(0, 10), (5, 10), (8, 6), (60, 6)]),
            Actor("o", "car", ring.route(0, 180), 70, 6),
        ],
        26,
        [("ukhc.r143.direction", "pass", "round the right way"), ("ukhc.no-collision", "pass", "nobody near")],
    )
    ring = Roundabout()
    yield draw(
        "round_wrong",
        "gb-eng",
        ring.map,
        [Actor("ego", "car", mirrored_way(ring), 20, [(0, 7), (60, 5)], [(0, -4.0), (4, -4.0), (6.0, 0)])],
        18,
        [("ukhc.r143.direction", "not pass", "round the ring against its traffic, out on the wrong side")],
    )
