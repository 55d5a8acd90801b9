"""Bicycles, horses and people on foot along the road, in both countries."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import ROAD
from tests.outsiders.seventeenth.drive import Drive, draw, go
from tests.outsiders.seventeenth.maps import two_way

DRIVES: list[Drive] = [
    draw(
        "bicycle_fast_170",
        ROAD,
        [
            go("ego", 20, 50, off=((0.333333333, 0), (3.33333333, -1.75), (7.33333333, -1.75), (10.3333333, 0))),
            go("c", 5, 130, 2.9, cls="bicycle"),
        ],
        13.3333333,
        [("ukhc.r163.cyclist", "fail", "1.7 m at 20 m/s")],
    ),
    draw(
        "bicycle_142_turned",
        ROAD,
        [
            go("ego", 11, 50, off=((6.42857143, 0), (9.42857143, -1.47), (13.4285714, -1.47), (16.4285714, 0))),
            go("c", 4, 130, 2.9, cls="bicycle"),
        ],
        19.4285714,
        [("ukhc.r163.cyclist", "fail", "1.42 m at 11 m/s")],
        moved=(50000, 20000, -2),
    ),
    draw(
        "truck_two_bicycles",
        ROAD,
        [
            go("ego", 12, 50, off=((4, 0), (7, -2.3), (13, -2.3), (16, -1.3), (19.5, -1.3), (22, 0)), cls="truck"),
            go("c1", 5, 120, 2.9, cls="bicycle"),
            go("c2", 5, 170, 2.9, cls="bicycle"),
        ],
        26,
        [("ukhc.r163.cyclist", "not pass", "the second one at 0.9 m")],
        more={"vehicle_class": "goods_over_7t5"},
    ),
    draw(
        "de_bicycle_rural",
        two_way(gb=False, kind="rural", limit=(100, "km/h")),
        [
            go("ego", 12, 50, -1.75, off=((6.42857143, 0), (9.42857143, 1.75), (13.4285714, 1.75), (16.4285714, 0))),
            go("c", 5, 130, -2.9, cls="bicycle"),
        ],
        19.4285714,
        [("stvo.s5-passing", "fail", "1.7 m, rural")],
        nation="de",
        moved=(0, 0, 0.4),
    ),
    draw(
        "de_bicycle_town",
        two_way(gb=False, kind="town", limit=(50, "km/h")),
        [go("ego", 12, 50, -1.75, off=((5, 0), (8, 1.65), (12, 1.65), (15, 0))), go("c", 4, 130, -2.9, cls="bicycle")],
        18,
        [("stvo.s5-passing", "pass", "1.6 m, town")],
        nation="de",
        moved=(0, 0, 0.4),
    ),
    draw(
        "de_walker_rural",
        two_way(gb=False, kind="rural", limit=(100, "km/h")),
        [
            go("ego", 12, 50, -1.75, off=((2.54716981, 0), (5.54716981, 1.55), (9.54716981, 1.55), (12.5471698, 0))),
            go("c", 1.4, 130, -2.9, cls="pedestrian"),
        ],
        15.5471698,
        [("stvo.s5-passing", "fail", "1.5 m, rural")],
        nation="de",
        moved=(0, 0, 0.4),
        noise=0.02,
    ),
    draw(
        "horse_150",
        ROAD,
        [go("ego", 4.2, 50, off=((6.5, 0), (9.5, -1.7), (15.5, -1.7), (18.5, 0))), go("h", 1.8, 80, 2.8, cls="animal")],
        20.5,
        [("ukhc.r215.horse", "fail", "1.5 m at 4.2 m/s")],
        nation="gb-wls",
        weather="wet",
    ),
]
