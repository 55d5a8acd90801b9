"""Great Britain: crossroads."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import GB, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.junction import crossroads, through
from tests.outsiders.sixteenth.ways import Motion, Path, line


def _lights() -> Iterator[Drive]:
    yield draw(
        "gb-red-just",
        crossroads(lights=True),
        [ego(Motion(through("W", "E"), 12, 164.75))],
        GB,
        24,
        [("ukhc.r175.red", "fail", "front over the line at 10.0, red at 9.7")],
        hz=20,
        turned=1,
        lights={
            "tlW": [(0, "green"), (6.7, "amber"), (9.7, "red")],
            "tlE": [(0, "green"), (6.7, "amber"), (9.7, "red")],
        },
    )
    yield draw(
        "gb-red-amber-start",
        crossroads(lights=True),
        [ego(Motion(through("W", "E"), [(0, 10), (2, 10), (6, 0), (11, 0), (15, 8), (24, 8)], 244.35))],
        GB,
        24,
        [
            ("ukhc.r175.red", "fail", "over the line at 11.7 on red and amber"),
            ("performance.precise-stop", "pass", "0.4 m"),
        ],
        lights={"tlW": [(0, "red"), (11, "red_amber"), (13, "green")]},
    )


def _blocked() -> Iterator[Drive]:
    yield draw(
        "gb-green-blocked",
        crossroads(lights=True),
        [
            ego(Motion(through("W", "E"), [(0, 8), (5, 8), (8, 0), (26, 0), (30, 6)], 248)),
            Actor("q", "truck", Motion(through("W", "E"), [(0, 0), (25.5, 0), (30, 8)], 309.75)),
        ],
        GB,
        34,
        [("ukhc.r176.green-exit-clear", "fail", "stands 18 s in the junction behind a lorry")],
        lights={"tlW": [(0, "green")]},
    )
    yield draw(
        "gb-side-road-blocked",
        crossroads(),
        [
            ego(Motion(through("W", "E"), [(0, 8), (5, 8), (8, 0), (26, 0), (30, 6)], 248)),
            Actor("q", "car", Motion(through("W", "E"), [(0, 0), (25.5, 0), (30, 8)], 306.5)),
        ],
        GB,
        34,
        [("ukhc.r151.side-roads-clear", "fail", "stands 18 s in the junction behind a car")],
    )
    yield draw(
        "gb-stop-on-line",
        crossroads(stop=True),
        [ego(Motion(through("W", "E"), [(0, 10), (6, 10), (10, 0), (12, 0), (16, 8)], 205.95))],
        GB,
        30,
        [("ukhc.r171.stop-sign", "fail", "stands 1.2 m over the line, not before it")],
    )


def _right_turns() -> Iterator[Drive]:
    yield draw(
        "gb-right-turn-short",
        crossroads(),
        [
            ego(
                Motion(through("W", "N"), [(0, 11), (6, 11), (9, 6), (13, 6), (17, 10)], 190.5),
                ind=[(0, "off"), (4, "left"), (16, "off")],
            ),
            Actor("o", "car", Motion(through("E", "W"), 12, 135.6)),
        ],
        GB,
        30,
        [("ukhc.r180.right-turn-gap", "fail", "oncoming about 0.5 s after it")],
    )
    yield draw(
        "gb-corner-cut",
        crossroads(),
        [
            ego(
                Motion(
                    Path(-300, -1.75, 0, [(286, 0), (math.pi / 2 * 11, 1 / 11), (284, 0)]),
                    [(0, 10), (6, 10), (9, 6), (14, 6), (18, 10)],
                    190,
                ),
                ind=[(0, "off"), (4, "left"), (16, "off")],
            )
        ],
        GB,
        26,
        [("ukhc.r180.corner-cut", "fail", "enters the road 3 m on the wrong side")],
    )


def _left_turns() -> Iterator[Drive]:
    yield draw(
        "gb-left-hooks-cyclist",
        crossroads(),
        [
            ego(
                Motion(through("W", "S"), [(0, 11), (7, 11), (9.5, 5.5), (13, 5.5), (17, 9)], 187.4),
                ind=[(0, "off"), (7, "right"), (14, "off")],
            ),
            Actor(
                "c",
                "bicycle",
                Motion(through("W", "E"), [(0, 5.5), (10.2, 5.5), (11.4, 2), (13, 2), (16, 5)], 229.7, -1.5),
            ),
        ],
        GB,
        26,
        [
            ("ukhc.h3.no-cut-across", "fail", "turns across a cyclist who brakes"),
            ("ukhc.r182.no-pass-before-turn", "fail", "passes it within 5 s before"),
        ],
    )
    yield draw(
        "gb-left-wide",
        crossroads(),
        [
            ego(
                Motion(
                    through("W", "S"),
                    [(0, 10), (6, 10), (9, 5.5), (13, 5.5), (17, 9)],
                    190,
                    [(0, 0), (9, 0), (11, 0.75), (16, 0.75), (20, 0)],
                ),
                ind=[(0, "off"), (6, "right"), (14, "off")],
            )
        ],
        GB,
        26,
        [("ukhc.r183.keep-in", "fail", "1.6 m and more from the near edge")],
    )
    yield draw(
        "gb-left-walker",
        crossroads(),
        [
            ego(
                Motion(through("W", "S"), [(0, 10), (6, 10), (9, 5.5), (13, 5.5), (17, 9)], 190),
                ind=[(0, "off"), (6, "right"), (14, "off")],
            ),
            Actor("p", "pedestrian", Motion(line(-25.816, -18), 1.4)),
        ],
        GB,
        26,
        [("ukhc.h2.turn-pedestrian", "fail", "walker reaches the ground about a second after the ego")],
    )


def british_junctions() -> Iterator[Drive]:
    yield from _lights()
    yield from _blocked()
    yield from _right_turns()
    yield from _left_turns()
