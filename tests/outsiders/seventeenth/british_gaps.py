"""Great Britain: gaps on open roads, and being overtaken."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import LONG_ROAD, ROAD
from tests.outsiders.seventeenth.drive import Actor, Drive, draw, go
from tests.outsiders.seventeenth.maps import two_way
from tests.outsiders.seventeenth.ways import EAST, Way

DRIVES: list[Drive] = [
    draw(
        "bus_ahead",
        ROAD,
        [go("ego", 20, 50), go("l", 20, 74, cls="bus")],
        20,
        [("criticality.thw", "fail", "0.80 s from the bus's rear")],
        weather="wet",
    ),
    draw(
        "trailer_ahead",
        ROAD,
        [go("ego", 20, 50), go("l", 20, 68.5), go("tr", 20, 62.75, cls="trailer")],
        20,
        [("criticality.thw", "fail", "8 m to the trailer: 0.4 s"), ("ukhc.r126.thinking-gap", "fail", "8 m")],
    ),
    draw(
        "motorcycle_at_edge",
        ROAD,
        [go("ego", 20, 50), go("m", 20, 60.35, 2.8, cls="motorcycle")],
        15,
        [("criticality.thw", "fail", "7 m at 20 m/s"), ("ukhc.r126.thinking-gap", "fail", "7 m")],
        noise=0.02,
    ),
    draw(
        "bend_close",
        two_way(pieces=[(100, 0), (300, 0.005), (100, 0)]),
        [
            Actor("ego", Way(0, 1.75, EAST, [(100, 0), (297.375, 0.00504413619)]), 18, 60),
            Actor("l", Way(0, 1.75, EAST, [(100, 0), (297.375, 0.00504413619)]), 18, 71.5),
        ],
        18,
        [
            ("criticality.thw", "fail", "7 m at 18 m/s in a bend"),
            ("ukhc.r126.thinking-gap", "fail", "7 m, thinking takes 12 m"),
        ],
        moved=(-900, 400, 2.4),
    ),
    draw(
        "late_stop",
        ROAD,
        [go("ego", ((0, 20), (8, 20), (10.8571429, 0)), 50), go("l", 0, 247.07)],
        16,
        [
            ("criticality.ttc", "fail", "1.07 s"),
            ("criticality.drac", "fail", "6 m/s2"),
            ("criticality.ttb", "fail", "0.4 s"),
            ("comfort.decel-iso15622", "fail", "7 m/s2"),
        ],
    ),
    draw(
        "cut_and_stay",
        LONG_ROAD,
        [
            go("ego", 22, 50),
            go("p", ((0, 27), (9, 27), (11, 22)), 20, off=((0, -3.5), (8, -3.5), (10, 0)), seen_from=1),
        ],
        34,
        [("ukhc.r168.drop-back", "fail", "the gap stays 15.5 m at 22 m/s")],
        hz=5,
    ),
    draw(
        "cut_and_drop",
        LONG_ROAD,
        [
            go("ego", ((0, 22), (11, 22), (14, 17)), 50),
            go("p", ((0, 27), (9, 27), (11, 22)), 20, off=((0, -3.5), (8, -3.5), (10, 0))),
        ],
        34,
        [("ukhc.r168.drop-back", "pass", "two seconds after 17 s")],
    ),
    draw(
        "overtaken_creep",
        LONG_ROAD,
        [
            go("ego", ((0, 20), (3, 20), (13, 22.8)), 60),
            go("p", 24.4, 25, off=((0, 0), (1, 0), (3, -3.5), (16, -3.5), (19, 0))),
        ],
        24,
        [("ukhc.r168.when-overtaken", "fail", "0.28 m/s2 for 10 s, more than 1.5 m/s gained while it is beside")],
    ),
]
