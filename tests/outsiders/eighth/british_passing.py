"""Great Britain: cyclists and horses."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.worlds import lane, oncoming, straight


def british_passing() -> list[Drive]:
    return [
        draw(
            "gb_cyclist_close_j",
            "The ego passes a cyclist with 0.9 m between.",
            "fail r163.cyclist",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 13, [(7.75, 0), (10.75, -1), (16.75, -1), (19.75, 0)]),
                who("c", "bicycle", lane(1), 150, 5, 1.1),
            ],
            25,
        ),
        draw(
            "gb_cyclist_room_j",
            "The ego passes a cyclist at 28 mph with 2.1 m between.",
            "pass r163.cyclist",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 12.4, [(8.864865, 0), (11.864865, -2.2), (17.864865, -2.2), (20.864865, 0)]),
                who("c", "bicycle", lane(1), 150, 5, 1.1),
            ],
            25,
        ),
        draw(
            "gb_cyclist_fast_165_j",
            "The ego passes a cyclist at 47 mph with 1.65 m between.",
            "fail r163.cyclist",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 21, [(0.875, 0), (3.875, -1.75), (9.875, -1.75), (12.875, 0)]),
                who("c", "bicycle", lane(1), 150, 5, 1.1),
            ],
            25,
        ),
        draw(
            "gb_cyclist_turned_yaw_j",
            "The ego passes a cyclist with 0.8 m between; the cyclist's heading is turned by pi.",
            "fail r163.cyclist",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 13, [(7.75, 0), (10.75, -0.9), (16.75, -0.9), (19.75, 0)]),
                who("c", "bicycle", lane(1), 150, 5, 1.1, turned=True),
            ],
            25,
        ),
        draw(
            "gb_null_class_thin_j",
            "The ego passes something thin of unknown class at cycling speed with 0.7 m between.",
            "not pass r163.cyclist",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 13, [(7.75, 0), (10.75, -0.8), (16.75, -0.8), (19.75, 0)]),
                who("c", None, lane(1), 150, 5, 1.1, size=(1.8, 0.6, 1.7)),
            ],
            25,
        ),
        draw(
            "gb_cyclist_lost_beside_j",
            "The ego passes a cyclist with 0.8 m between, who is lost from the log meanwhile.",
            "not pass r163.cyclist",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 13, [(7.75, 0), (10.75, -0.9), (16.75, -0.9), (19.75, 0)]),
                who("c", "bicycle", lane(1), 150, 5, 1.1, gaps=[(12.6, 15.2)]),
            ],
            25,
        ),
        draw(
            "gb_cyclist_2hz_fast_j",
            "The ego passes a cyclist at 54 mph with 0.6 m between; the log has two steps a second.",
            "not pass r163.cyclist",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 24, [(0, 0), (2.789474, -0.7), (8.789474, -0.7), (11.789474, 0)]),
                who("c", "bicycle", lane(1), 150, 5, 1.1),
            ],
            25,
            rate=2,
        ),
        draw(
            "gb_horse_fast_j",
            "The ego passes a horse at 20 mph.",
            "fail r215.horse",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 9, [(8.864865, 0), (11.864865, -2.9), (17.864865, -2.9), (20.864865, 0)]),
                who("c", "animal", lane(1), 150, 1.6, 1.1),
            ],
            25,
        ),
        draw(
            "gb_horse_near_j",
            "The ego passes a horse slowly with 1 m between.",
            "fail r215.horse",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 3.9, [(10.666667, 0), (13.666667, -1.2), (19.666667, -1.2), (22.666667, 0)]),
                who("c", "animal", lane(1), 85, 1.2, 1.1),
            ],
            35,
        ),
        draw(
            "gb_horse_kind_j",
            "The ego passes a horse at 8.7 mph with nearly 3 m between.",
            "pass r215.horse",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 3.9, [(10.666667, 0), (13.666667, -3.1), (19.666667, -3.1), (22.666667, 0)]),
                who("c", "animal", lane(1), 85, 1.2, 1.1),
            ],
            35,
        ),
        draw(
            "gb_dog_by_road_j",
            "The ego passes a dog at 20 mph.",
            "not fail r215.horse",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 9, [(8.864865, 0), (11.864865, -1.6), (17.864865, -1.6), (20.864865, 0)]),
                who("c", "animal", lane(1), 150, 1.6, 1.1, size=(0.8, 0.3, 0.6)),
            ],
            25,
        ),
        draw(
            "gb_two_riders_abreast_j",
            "The ego stays behind two cyclists who ride abreast.",
            "not fail r163.cyclist | pass no-collision criticality.drac",
            Map((straight(900),)),
            [
                ego(lane(1), 40, [(0, 14), (5, 14), (9, 5.5), (30, 5.5)]),
                who("c1", "bicycle", lane(1), 125, 5.5, 1),
                who("c2", "bicycle", lane(1), 126, 5.5, -0.2),
            ],
            30,
        ),
        draw(
            "gb_cyclist_meets_j",
            "The ego meets a cyclist in the other lane, 3 m away.",
            "not fail r163.cyclist",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 13),
                who("c", "bicycle", oncoming(900), 600, 6, 1),
            ],
            25,
        ),
    ]
