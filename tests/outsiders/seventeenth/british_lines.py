"""Great Britain: middle lines, lane lines and the side of the road."""

from __future__ import annotations

from tests.outsiders.seventeenth.cast import ROAD, SOLID
from tests.outsiders.seventeenth.drive import Drive, draw, go
from tests.outsiders.seventeenth.maps import one_way, two_way

DRIVES: list[Drive] = [
    draw(
        "solid_fast_bicycle",
        SOLID,
        [go("ego", 12, 50, off=((4, 0), (7, -2.5), (14, -2.5), (17, 0))), go("c", 7, 105, 2.9, cls="bicycle")],
        22,
        [("ukhc.r129.no-cross-solid", "fail", "the bicycle goes 7 m/s, more than 10 mph")],
    ),
    draw(
        "solid_slow_bicycle",
        SOLID,
        [go("ego", 10, 50, off=((4, 0), (7, -2.5), (14, -2.5), (17, 0))), go("c", 3.2, 120, 2.9, cls="bicycle")],
        22,
        [("ukhc.r129.no-cross-solid", "not fail", "3.2 m/s, less than 10 mph")],
    ),
    draw(
        "solid_lorry_edge",
        SOLID,
        [go("ego", 18, 50, off=((5, 0), (8, -0.75), (11, -0.75), (14, 0)), cls="truck")],
        20,
        [("ukhc.r129.no-cross-solid", "fail", "0.25 m over it, its centre in the lane")],
        more={"vehicle_class": "goods_over_7t5"},
    ),
    draw(
        "double_near_solid",
        two_way(length=900, centre=((0, "solid broken"),)),
        [go("ego", 24, 50, off=((3, 0), (5, -3.5), (10, -3.5), (12, 0))), go("v", 14, 120)],
        20,
        [("ukhc.r129.no-cross-solid", "fail", "solid broken from left to right, ego on the left")],
    ),
    draw(
        "double_near_broken",
        two_way(length=900, centre=((0, "broken solid"),)),
        [go("ego", 24, 50, off=((3, 0), (5, -3.5), (10, -3.5), (12, 0))), go("v", 14, 120)],
        20,
        [("ukhc.r129.no-cross-solid", "not fail", "broken solid from left to right, ego on the left")],
    ),
    draw(
        "back_late",
        two_way(length=900, centre=((0, "broken solid"), (270, "solid solid"))),
        [go("ego", 22, 50, off=((2, 0), (4, -3.5), (9.5, -3.5), (11.5, 0))), go("v", 8, 100)],
        18,
        [("ukhc.r128.back-before-solid", "fail", "back at 303 m, solid from 270 m")],
        moved=(1, 2, -0.6),
    ),
    draw(
        "astride_long",
        one_way(n=2, kind="rural", shoulder=False),
        [go("ego", 20, 50, 5.475, off=((3, 0), (5, -1.8), (14, -1.8), (16, 0)))],
        24,
        [("ukhc.r131.keep-in-lane", "fail", "astride for 9 s and the way there")],
    ),
    draw(
        "wrong_side_drifts_back",
        ROAD,
        [go("ego", 18, 50, off=((3, 0), (6, -3.5), (21, -3.5), (24, 0)))],
        28,
        [("ukhc.r143.direction", "fail", "15 s in the opposing lane, nothing there")],
    ),
    draw(
        "reverse_fast",
        ROAD,
        [go("ego", ((0, 12), (10, 12), (14, 0), (15, 0), (19, -8), (25, -8), (29, 0)), 150)],
        32,
        [("ukhc.r143.direction", "fail", "reversing at 8 m/s")],
    ),
    draw(
        "past_standing_queue",
        two_way(kind="town", limit=(30, "mph")),
        [
            go("ego", 8, 50, off=((6, 0), (9, -3.3), (17, -3.3), (20, 0))),
            go("q0", 0, 140, 1.9),
            go("q1", 0, 147, 1.9),
            go("q2", 0, 154, 1.9),
            go("q3", 0, 161, 1.9),
        ],
        26,
        [("ukhc.r143.direction", "not fail", "standing vehicles close the lane")],
    ),
]
