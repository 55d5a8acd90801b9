"""Great Britain: turns, ways that cross, and contact."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import TOWN, WALKED_CROSS
from tests.outsiders.seventeenth.drive import Actor, Drive, draw, go
from tests.outsiders.seventeenth.maps import LEFT, RIGHT
from tests.outsiders.seventeenth.ways import EAST, NORTH, Way

DRIVES: list[Drive] = [
    draw(
        "right_gap_short",
        WALKED_CROSS,
        [
            Actor(
                "ego",
                Way(-162, 1.75, EAST, RIGHT),
                ((0, 10), (6, 10), (8, 6)),
                62,
                ind=((0, "off"), (5, "right"), (13, "off")),
            ),
            go("o", 12, 162.85, -1.75, back=True),
        ],
        20,
        [("ukhc.r180.right-turn-gap", "fail", "0.8 s")],
        hz=5,
    ),
    draw(
        "right_cut",
        WALKED_CROSS,
        [
            Actor(
                "ego",
                Way(-162, 1.75, EAST, RIGHT),
                ((0, 10), (6, 10), (8, 6)),
                62,
                off=((9, 0), (11, -2), (14, -2), (16, 0)),
            )
        ],
        20,
        [("ukhc.r180.corner-cut", "fail", "1.15 m over the middle of the new road")],
    ),
    draw(
        "left_wide",
        WALKED_CROSS,
        [
            Actor(
                "ego",
                Way(-162, 1.75, EAST, LEFT),
                ((0, 10), (6, 10), (8, 6)),
                62,
                off=((9, 0), (12, -1.4), (16, -1.4), (18, 0)),
            )
        ],
        22,
        [("ukhc.r183.keep-in", "fail", "2.25 m to the near edge")],
        moved=(40, 40, -0.8),
    ),
    draw(
        "left_across_bicycle",
        WALKED_CROSS,
        [
            Actor("ego", Way(-162, 1.75, EAST, LEFT), ((0, 10), (6, 10), (8.5, 6)), 61, off=((0, -0.6),)),
            go("c", 5.5, -74, 3.1, cls="bicycle"),
        ],
        20,
        [
            ("ukhc.r182.no-pass-before-turn", "fail", "got ahead less than 5 s before"),
            ("ukhc.h3.no-cut-across", "fail", "the bicycle comes over its ground within a second or so"),
        ],
    ),
    draw(
        "left_walker",
        WALKED_CROSS,
        [
            Actor("ego", Way(-162, 1.75, EAST, LEFT), ((0, 10), (6, 10), (8, 6)), 62),
            go("p", 1.4, 20.065, 14, back=True, cls="pedestrian", ind=None, seen_from=6),
        ],
        24,
        [("ukhc.h2.turn-pedestrian", "fail", "about 1.0 s")],
        moved=(9, 9, 1.8),
    ),
    draw(
        "crossed_behind",
        WALKED_CROSS,
        [go("ego", 10, -122), Actor("x", Way(-1.75, -162, NORTH), 10, 28.2)],
        20,
        [("criticality.pet", "fail", "0.6 s"), ("ukhc.no-collision", "pass", "never touched")],
    ),
    draw(
        "struck_between_steps",
        WALKED_CROSS,
        [go("ego", 4, -62), Actor("x", Way(-1.75, -162, NORTH), 24, -202.31, cls="motorcycle")],
        22,
        [("ukhc.no-collision", "fail", "the motorcycle goes through its middle between two steps")],
        hz=2,
    ),
    draw(
        "touch_mirror_high",
        TOWN,
        [go("ego", 6, 50, off=((3, 0), (6, 0.25))), go("pk", 0, 120, 3.75)],
        18,
        [("ukhc.no-collision", "fail", "0.05 m into it")],
        moved=(5, 5, 0.77),
    ),
]
