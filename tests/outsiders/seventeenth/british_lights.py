"""Great Britain: traffic lights, and standing in a junction."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import LIT_CROSS
from tests.outsiders.seventeenth.drive import Drive, draw, go
from tests.outsiders.seventeenth.maps import cross

DRIVES: list[Drive] = [
    draw(
        "light_red_amber",
        LIT_CROSS,
        [go("ego", 10, -116.25)],
        16,
        [("ukhc.r175.red", "fail", "red with amber till 11 s")],
        moved=(0, 0, 2),
        signals=[("tl", 0, "red"), ("tl", 8, "red_amber"), ("tl", 11, "green")],
    ),
    draw(
        "light_green_then_red",
        LIT_CROSS,
        [go("ego", 10, -116.25)],
        16,
        [("ukhc.r175.red", "pass", "its front was over on amber")],
        signals=[("tl", 0, "green"), ("tl", 7, "amber"), ("tl", 10.2, "red")],
    ),
    draw(
        "light_creep",
        LIT_CROSS,
        [go("ego", ((0, 10), (5, 10), (10, 0), (15, 0), (19, 6)), -90.05)],
        24,
        [("ukhc.r175.red", "fail", "its front 1.2 m over the line on red")],
        signals=[("tl", 0, "red"), ("tl", 14, "red_amber"), ("tl", 15, "green")],
    ),
    draw(
        "green_blocked",
        LIT_CROSS,
        [
            go("ego", ((0, 9), (5.5, 9), (10, 0), (21, 0), (25, 6)), -69.75),
            go("q0", ((0, 0), (20, 0), (24, 6)), 7),
            go("q1", ((0, 0), (20, 0), (24, 6)), 14),
            go("q2", ((0, 0), (20, 0), (24, 6)), 21),
        ],
        28,
        [("ukhc.r176.green-exit-clear", "fail", "stands 11 s in the junction"), ("ukhc.r175.red", "pass", "green")],
        hz=5,
        moved=(0, 0, -2.6),
        signals=[("tl", 0, "green")],
    ),
    draw(
        "side_road_blocked",
        cross(),
        [
            go("ego", ((0, 9), (5.5, 9), (10, 0), (21, 0), (25, 6)), -69.75),
            go("q0", ((0, 0), (20, 0), (24, 6)), 7),
            go("q1", ((0, 0), (20, 0), (24, 6)), 14),
            go("q2", ((0, 0), (20, 0), (24, 6)), 21),
        ],
        28,
        [("ukhc.r151.side-roads-clear", "fail", "stands 11 s in the junction")],
    ),
]
