"""Great Britain: motorways."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import M3
from tests.outsiders.seventeenth.drive import Drive, draw, go
from tests.outsiders.seventeenth.maps import one_way
from tests.outsiders.seventeenth.road import sign

DRIVES: list[Drive] = [
    draw(
        "shoulder_along",
        M3,
        [go("ego", 25, 50, 9.125, off=((3, 0), (6, 3.5), (25, 3.5), (28, 0)))],
        40,
        [("ukhc.r269.hard-shoulder", "fail", "19 s along it at 25 m/s")],
        noise=0.05,
    ),
    draw(
        "shoulder_breakdown",
        M3,
        [
            go(
                "ego",
                ((0, 25), (4, 25), (14, 0)),
                50,
                9.125,
                off=((4, 0), (7, 3.5)),
                ind=((0, "off"), (4, "left"), (8, "hazard")),
            )
        ],
        30,
        [("ukhc.r269.hard-shoulder", "not fail", "stops there with hazard lights")],
    ),
    draw(
        "right_lane_lorry_looks",
        M3,
        [go("ego", 24, 50, 5.475, off=((4, 0), (7, -3.65), (9, -3.65), (12, 0)), cls="truck")],
        20,
        [("ukhc.r265.right-lane-ban", "fail", "in lane 3 for some seconds")],
        more={"vehicle_class": "goods_over_7t5"},
    ),
    draw(
        "stands_on_motorway",
        M3,
        [go("ego", ((0, 25), (5, 25), (13, 0)), 50, 9.125)],
        32,
        [("ukhc.r240.no-stopping", "fail", "stands 19 s, nobody there")],
    ),
    draw(
        "stands_in_queue",
        M3,
        [
            go("ego", ((0, 25), (5, 25), (13, 0)), 50, 9.125),
            go("q0", 0, 283, 9.125),
            go("q1", 0, 290, 9.125),
            go("q2", 0, 297, 9.125),
            go("q3", 0, 304, 9.125),
            go("r0", 0, 283, 5.475),
            go("r1", 0, 290, 5.475),
            go("r2", 0, 297, 5.475),
            go("r3", 0, 304, 5.475),
        ],
        32,
        [("ukhc.r240.no-stopping", "pass", "in a queue")],
    ),
    draw(
        "reverses_on_motorway",
        M3,
        [go("ego", ((0, 20), (8, 0), (10, 0), (12, -2), (18, -2), (20, 0)), 50, 9.125)],
        24,
        [
            ("ukhc.r263.no-reverse", "fail", "2 m/s backwards"),
            ("ukhc.r143.direction", "fail", "on a motorway nothing excuses it"),
        ],
    ),
    draw(
        "motorway_hazards",
        M3,
        [go("ego", 25, 50, 9.125, ind=((0, "off"), (5, "hazard"))), go("v", 15, 350, 9.125)],
        15,
        [("ukhc.r116.hazards", "not fail", "on a motorway")],
    ),
    draw(
        "exit_late_signal",
        one_way(n=2, length=1200, leaves=True, signals=[sign("x", "DE", "333", 300, 8, 2, "exit")]),
        [go("ego", 22, 50, 5.475, off=((15, 0), (19, 3.65)), ind=((0, "off"), (13.5, "left"), (21, "off")))],
        26,
        [("ukhc.exit-sign-signal", "fail", "sign passed at 11.3 s, indicator from 13.5 s")],
        moved=(5, 6, 1),
    ),
]
