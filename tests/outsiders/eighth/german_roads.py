"""Germany: cyclists and people on foot, stop signs and lights."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.junctions import crossroads, through
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.worlds import lane, straight


def german_roads() -> list[Drive]:
    return [
        draw(
            "de_cyclist_town_close_j",
            "The ego passes a cyclist in a town with 1.1 m between.",
            "fail stvo.s5-passing",
            Map((straight(900, "town", gb=False),)),
            [
                ego(lane(-1), 40, 12.5, [(8.666667, 0), (11.666667, 1.2), (17.666667, 1.2), (20.666667, 0)]),
                who("c", "bicycle", lane(-1), 150, 5, -1.1),
            ],
            25,
        ),
        draw(
            "de_cyclist_town_room_j",
            "The ego passes a cyclist in a town with 1.8 m between.",
            "pass stvo.s5-passing",
            Map((straight(900, "town", gb=False),)),
            [
                ego(lane(-1), 40, 12, [(9.714286, 0), (12.714286, 1.9), (18.714286, 1.9), (21.714286, 0)]),
                who("c", "bicycle", lane(-1), 150, 5, -1.1),
            ],
            25,
        ),
        draw(
            "de_cyclist_open_175_j",
            "The ego passes a cyclist outside a town with 1.75 m between.",
            "fail stvo.s5-passing",
            Map((straight(900, gb=False),)),
            [
                ego(lane(-1), 40, 19, [(1.857143, 0), (4.857143, 1.85), (10.857143, 1.85), (13.857143, 0)]),
                who("c", "bicycle", lane(-1), 150, 5, -1.1),
            ],
            25,
        ),
        draw(
            "de_cyclist_open_room_j",
            "The ego passes a cyclist outside a town with 2.4 m between.",
            "pass stvo.s5-passing",
            Map((straight(900, gb=False),)),
            [
                ego(lane(-1), 40, 18, [(2.461538, 0), (5.461538, 2.5), (11.461538, 2.5), (14.461538, 0)]),
                who("c", "bicycle", lane(-1), 150, 5, -1.1),
            ],
            25,
        ),
        draw(
            "de_walker_open_j",
            "The ego passes somebody who walks along the road with 1 m between.",
            "fail stvo.s5-passing",
            Map((straight(900, gb=False),)),
            [
                ego(lane(-1), 40, 15, [(2.088235, 0), (5.088235, 1.1), (11.088235, 1.1), (14.088235, 0)]),
                who("c", "pedestrian", lane(-1), 150, 1.4, -1.1),
            ],
            25,
        ),
        draw(
            "de_null_rider_j",
            "The ego passes something thin of unknown class with 0.8 m between.",
            "not pass stvo.s5-passing",
            Map((straight(900, "town", gb=False),)),
            [
                ego(lane(-1), 40, 12.5, [(8.666667, 0), (11.666667, 0.9), (17.666667, 0.9), (20.666667, 0)]),
                who("c", None, lane(-1), 150, 5, -1.1, size=(1.8, 0.6, 1.7)),
            ],
            25,
        ),
        draw(
            "de_scooter_vehicle_j",
            "The ego passes a small thing of class vehicle with 0.8 m between.",
            "not pass stvo.s5-passing",
            Map((straight(900, "town", gb=False),)),
            [
                ego(lane(-1), 40, 12.5, [(8.666667, 0), (11.666667, 0.9), (17.666667, 0.9), (20.666667, 0)]),
                who("c", "vehicle", lane(-1), 150, 5, -1.1, size=(1.2, 0.6, 1.7)),
            ],
            25,
        ),
        draw(
            "de_stop_rolls_j",
            "The ego rolls over the line of a stop sign at 8 km/h.",
            "fail stvo.rin1",
            crossroads(gb=False, stop=True),
            [
                ego(through(180, 0, gb=False), 60, [(0, 10), (6, 10), (10, 2.2), (12, 2.2), (16, 9)]),
            ],
            28,
        ),
        draw(
            "de_stop_halts_j",
            "The ego stands 1.2 m before the line of a stop sign for two seconds.",
            "pass stvo.rin1",
            crossroads(gb=False, stop=True),
            [
                ego(through(180, 0, gb=False), 63.1, [(0, 10), (4, 10), (12.4, 0), (15, 0), (19, 7)]),
            ],
            28,
        ),
        draw(
            "de_left_turn_forces_j",
            "The ego turns left on green less than a second before the oncoming car.",
            "fail criticality.pet | pass r175.red",
            crossroads(gb=False, lights=True),
            [
                ego(
                    through(180, 90, gb=False),
                    50,
                    [(0, 10), (8, 10), (11, 5)],
                    blink=[(0, "off"), (4, "left"), (18, "off")],
                ),
                car("on", through(0, 180, gb=False), 36, 9),
            ],
            25,
            lights={"l180": [(0, "green")], "l0": [(0, "green")], "l90": [(0, "red")], "l270": [(0, "red")]},
        ),
        draw(
            "de_red_bus_j",
            "A bus drives over the stop line four seconds after the light turned red.",
            "fail r175.red",
            crossroads(gb=False, lights=True),
            [
                ego(through(180, 0, gb=False), 50, 10.5, kind="bus"),
            ],
            25,
            lights={
                "l180": [(0, "green"), (2, "amber"), (5, "red")],
                "l0": [(0, "green"), (2, "amber"), (5, "red")],
                "l90": [(0, "red")],
                "l270": [(0, "red")],
            },
        ),
    ]
