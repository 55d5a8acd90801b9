"""Great Britain: crossings for people on foot."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import SIGNALLED_CROSSING, ZEBRA, ZEBRA_ONE_WAY
from tests.outsiders.seventeenth.drive import Actor, Drive, draw, go
from tests.outsiders.seventeenth.ways import NORTH, SOUTH, Way

DRIVES: list[Drive] = [
    draw(
        "zebra_on",
        ZEBRA,
        [
            go("ego", 9, 50),
            Actor("p", Way(200, 9.2, SOUTH), ((0, 0.5), (12, 0.5), (12.2, 0)), cls="pedestrian", seen_from=8),
        ],
        22,
        [
            ("ukhc.r195.zebra-on", "fail", "he stands on it, 0.35 m in from the kerb"),
            ("ukhc.no-collision", "pass", "0.25 m"),
        ],
        moved=(120, -60, 0.9),
    ),
    draw(
        "zebra_queue",
        ZEBRA,
        [
            go("ego", ((0, 9), (5.5, 9), (10, 0), (23, 0), (27, 6)), 129.75),
            go("q0", ((0, 0), (22, 0), (26, 6)), 205.5),
            go("q1", ((0, 0), (22, 0), (26, 6)), 212.5),
            go("q2", ((0, 0), (22, 0), (26, 6)), 219.5),
        ],
        30,
        [
            ("ukhc.r192.keep-clear", "fail", "stands on it for 13 s behind somebody"),
            ("ukhc.r191.no-stopping", "not fail", "in a queue"),
        ],
        noise=0.02,
    ),
    draw(
        "zebra_stands",
        ZEBRA,
        [go("ego", ((0, 9), (5.5, 9), (10, 0), (23, 0), (27, 6)), 129.75)],
        30,
        [
            ("ukhc.r191.no-stopping", "fail", "stands on it for 13 s, nobody there"),
            ("ukhc.r192.keep-clear", "not fail", "behind nobody"),
        ],
    ),
    draw(
        "crossing_overtake",
        ZEBRA_ONE_WAY,
        [go("ego", 12, 50, 1.825), go("v", 7, 106, 5.475)],
        24,
        [("ukhc.r191.crossing-overtake", "fail", "gets past at 11 s, 8 m before it")],
    ),
    draw(
        "crossing_stopped",
        ZEBRA_ONE_WAY,
        [
            go("ego", 9, 50, 1.825),
            go("v", ((0, 8), (7, 8), (10, 0), (19, 0), (21, 6)), 127, 5.475),
            Actor("p", Way(200, 9.5, SOUTH), ((0, 0), (13, 0), (14, 1.2)), cls="pedestrian"),
        ],
        24,
        [("ukhc.r191.crossing-overtake", "fail", "past one that stopped for somebody")],
        hz=5,
        moved=(-2000, 5, -1.3),
    ),
    draw(
        "pelican_flash",
        SIGNALLED_CROSSING,
        [go("ego", 9, 50), Actor("p", Way(200, -16.4, NORTH), 1.2, cls="pedestrian")],
        22,
        [("ukhc.r196.pelican", "fail", "onto it at 16.3 s")],
        moved=(4, 4, 2.2),
        signals=[("tl", 0, "red"), ("tl", 13, "flashing")],
    ),
    draw(
        "pelican_green_walker",
        SIGNALLED_CROSSING,
        [go("ego", 9, 50), Actor("p", Way(200, -16.4, NORTH), 1.2, cls="pedestrian")],
        22,
        [("ukhc.r198.still-crossing", "fail", "onto it at 16.3 s")],
        signals=[("tl", 0, "red"), ("tl", 13, "green")],
    ),
]
