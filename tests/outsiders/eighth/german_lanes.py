"""Germany: changing lane, stopping and passing on motorways."""

from __future__ import annotations

import math

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.worlds import lane, straight, wrong_way


def german_lanes() -> list[Drive]:
    return [
        draw(
            "de_pulls_out_before_fast_j",
            "The ego changes lane some 40 m before a car that comes at 160 km/h.",
            "fail stvo.rg6",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 200, 27, [(6, 0), (10, 3.5)], blink=[(0, "off"), (4.5, "left"), (11, "off")]),
                car("f", lane(-1), 25, [(0, 45), (7, 45), (10, 26), (25, 26)]),
            ],
            25,
        ),
        draw(
            "de_change_ample_j",
            "The ego changes lane 190 m before a car that is hardly faster.",
            "pass stvo.rg6 stvo.rg3",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 260, 30, [(6, 0), (10, 3.5)], blink=[(0, "off"), (2.5, "left"), (11, "off")]),
                car("f", lane(-2), 60, 31),
                who("l", "truck", lane(-3), 420, 22),
            ],
            25,
        ),
        draw(
            "de_pulls_out_follower_appears_j",
            "As in de_pulls_out_before_fast, but the fast car is in the log only after the change began.",
            "not pass stvo.rg6",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 200, 27, [(6, 0), (10, 3.5)]),
                car("f", lane(-1), 25, [(0, 45), (7, 45), (10, 26), (25, 26)], there=(8.2, math.inf)),
            ],
            25,
        ),
        draw(
            "de_change_follower_turned_j",
            "As in de_pulls_out_before_fast, but the fast car's heading is turned by pi.",
            "not pass stvo.rg6",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 200, 27, [(6, 0), (10, 3.5)]),
                car("f", lane(-1), 25, [(0, 45), (7, 45), (10, 26), (25, 26)], turned=True),
            ],
            25,
        ),
        draw(
            "de_stops_for_nothing_j",
            "The ego stands ten seconds on a motorway lane without cause.",
            "fail stvo.ri1 r240.no-stopping",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, [(0, 24), (4, 24), (14, 0), (24, 0), (36, 14)]),
            ],
            40,
        ),
        draw(
            "de_stops_at_queue_j",
            "The ego stops 14 m behind a standing lorry; all lanes of the motorway stand.",
            "pass stvo.ri1 | not fail stvo.rg1",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, [(0, 24), (4, 24), (14, 0), (35, 0)]),
                who("q", "truck", lane(-2), 297, 0),
                car("q2", lane(-1), 300, 0),
                car("q3", lane(-3), 290, 0),
            ],
            35,
        ),
        draw(
            "de_undertake_j",
            "The ego passes a car on its left at 122 against 97 km/h.",
            "fail stvo.ri2",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, 34),
                car("l", lane(-2), 160, 27),
            ],
            25,
        ),
        draw(
            "de_passes_queue_right_j",
            "The ego passes a queue of 29 km/h on the right with 11 km/h more.",
            "pass stvo.ri2",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, 11),
                car("a", lane(-2), 100, 8),
                who("b", "van", lane(-2), 118, 8),
                car("c", lane(-1), 105, 8),
                car("e", lane(-2), 134, 8),
            ],
            30,
        ),
        draw(
            "de_passes_queue_fast_j",
            "The ego passes a queue of 43 km/h on the right with 36 km/h more.",
            "fail stvo.ri2",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 40, 22),
                car("a", lane(-2), 120, 12),
                who("b", "van", lane(-2), 142, 12),
                car("c", lane(-1), 125, 12),
                car("e", lane(-2), 164, 12),
            ],
            25,
        ),
        draw(
            "de_reverses_j",
            "The ego reverses 20 m on a motorway.",
            "fail stvo.ri3 r263.no-reverse",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 300, [(0, 6), (3, 6), (6, 0), (8, 0), (10, -3), (16, -3), (18, 0)]),
            ],
            25,
        ),
        draw(
            "de_ghost_driver_ego_j",
            "The ego drives the wrong way on a motorway.",
            "fail stvo.ri3",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(wrong_way(-1, 1800), 100, 28),
                car("a", lane(-2), 300, 33),
            ],
            20,
        ),
        draw(
            "de_ghost_driver_other_j",
            "A wrong-way driver comes towards the ego, which changes lane in time.",
            "pass stvo.ri3 no-collision | not fail stvo.rg6",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-1), 60, 31, [(3.5, 0), (6, -3.5)]),
                car("g", wrong_way(-1, 1800), 900, 30),
            ],
            20,
        ),
        draw(
            "de_truck_30m_j",
            "A lorry follows another 29 m behind it at 79 km/h.",
            "fail stvo.s4-truck",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, 22, kind="truck"),
                who("l", "truck", lane(-3), 98, 22),
            ],
            25,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "de_bus_80m_j",
            "A bus follows a lorry 79 m behind it at 77 km/h.",
            "pass stvo.s4-truck",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, 21.5, kind="bus"),
                who("l", "truck", lane(-3), 150, 21.5),
            ],
            25,
            vehicle_class="bus",
        ),
        draw(
            "de_truck_follows_trailer_j",
            "A lorry of at most 7.5 t follows a trailer 33 m behind it at 78 km/h.",
            "not pass stvo.s4-truck",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, 21.8, kind="truck"),
                who("tr", "trailer", lane(-3), 103, 21.8),
                who("tk", "truck", lane(-3), 114, 21.8),
            ],
            25,
            vehicle_class="goods_7t5",
        ),
    ]
