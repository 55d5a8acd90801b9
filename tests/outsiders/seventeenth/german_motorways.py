"""Germany: motorways."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import DE3
from tests.outsiders.seventeenth.drive import Drive, draw, go

DRIVES: list[Drive] = [
    draw(
        "de_gap_8",
        DE3,
        [go("ego", 30, 50, -9.125), go("l", 30, 62.5, -9.125)],
        20,
        [("stvo.rg1", "fail", "8 m, 11.1 m needed"), ("criticality.thw", "fail", "0.27 s")],
        nation="de",
    ),
    draw(
        "de_brakes_for_nothing",
        DE3,
        [go("ego", ((0, 33), (6, 33), (9, 21), (20, 21)), 50, -9.125)],
        22,
        [("stvo.rg2", "fail", "4 m/s2, nobody there")],
        nation="de",
    ),
    draw(
        "de_brakes_behind",
        DE3,
        [
            go("ego", ((0, 30), (6.6, 30), (9.6, 18), (20, 18)), 50, -9.125),
            go("l", ((0, 30), (6, 30), (9, 18), (20, 18)), 89.5, -9.125),
        ],
        22,
        [("stvo.rg2", "not fail", "the one ahead brakes")],
        nation="de",
    ),
    draw(
        "de_creeps",
        DE3,
        [go("ego", 17, 50, -9.125)],
        30,
        [("stvo.rg4", "fail", "61 km/h where 130 are allowed")],
        nation="de",
        hz=5,
    ),
    draw(
        "de_lorry_22",
        DE3,
        [go("ego", 22, 50, -9.125, cls="truck")],
        30,
        [("stvo.rg4", "not fail", "lorry at 79 km/h"), ("stvo.rg3", "pass", "79 km/h")],
        nation="de",
        more={"vehicle_class": "goods_over_7t5"},
    ),
    draw(
        "de_pulls_out",
        DE3,
        [go("ego", 26, 250, -5.475, off=((6, 0), (9, 3.65))), go("f", ((0, 42), (6, 42), (8.1, 26)), 124, -1.825)],
        16,
        [("stvo.rg6", "fail", "30 m behind and 16 m/s faster"), ("stvo.rg3", "not fail", "26 m/s")],
        nation="de",
    ),
    draw(
        "de_stops",
        DE3,
        [go("ego", ((0, 25), (5, 25), (13, 0)), 50, -9.125)],
        28,
        [("stvo.ri1", "fail", "nobody ahead")],
        nation="de",
    ),
    draw(
        "de_reverses",
        DE3,
        [go("ego", ((0, 15), (6, 0), (8, 0), (10, -1.5), (16, -1.5), (18, 0)), 50, -9.125)],
        22,
        [("stvo.ri3", "fail", "1.5 m/s backwards"), ("ukhc.r263.no-reverse", "fail", "backwards on a motorway")],
        nation="de",
    ),
    draw(
        "de_past_queue",
        DE3,
        [
            go("ego", 14, 50, -5.475),
            go("q0", 10, 100, -1.825),
            go("q1", 10, 125, -1.825),
            go("q2", 10, 150, -1.825),
            go("q3", 10, 175, -1.825),
            go("q4", 10, 200, -1.825),
        ],
        34,
        [("stvo.ri2", "pass", "a queue at 36 km/h, 14 km/h faster")],
        nation="de",
    ),
    draw(
        "de_past_queue_fast",
        DE3,
        [
            go("ego", 18, 50, -5.475),
            go("q0", 10, 100, -1.825),
            go("q1", 10, 125, -1.825),
            go("q2", 10, 150, -1.825),
            go("q3", 10, 175, -1.825),
            go("q4", 10, 200, -1.825),
        ],
        24,
        [("stvo.ri2", "fail", "29 km/h faster than the queue")],
        nation="de",
        noise=0.02,
    ),
    draw(
        "de_lorry_40",
        DE3,
        [go("ego", 22, 50, -9.125, cls="truck"), go("l", 22, 104, -9.125, cls="truck")],
        20,
        [("stvo.s4-truck", "fail", "42 m at 79 km/h")],
        nation="de",
        more={"vehicle_class": "goods_over_7t5"},
    ),
]
