"""Germany: oncoming traffic, and recorder faults."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.worlds import lane, oncoming, straight


def german_others() -> list[Drive]:
    return [
        draw(
            "de_ot_near_miss_j",
            "The ego overtakes a lorry and is just back when the oncoming car comes by.",
            "fail rss.opposite | pass no-collision",
            Map((straight(1700, gb=False),)),
            [
                ego(
                    lane(-1),
                    60,
                    24,
                    [(2.5, 0), (5, 3.5), (13, 3.5), (15.5, 0)],
                    blink=[(0, "off"), (1, "left"), (5, "off"), (12.5, "right"), (15.5, "off")],
                ),
                who("t", "truck", lane(-1), 160, 14),
                car("on", oncoming(1700, gb=False), 850, 27),
            ],
            28,
        ),
        draw(
            "de_ot_safe_j",
            "The ego overtakes a lorry and is back long before the oncoming car comes.",
            "pass rss.opposite no-collision",
            Map((straight(1700, gb=False),)),
            [
                ego(
                    lane(-1),
                    60,
                    24,
                    [(2.5, 0), (5, 3.5), (13, 3.5), (15.5, 0)],
                    blink=[(0, "off"), (1, "left"), (5, "off"), (12.5, "right"), (15.5, "off")],
                ),
                who("t", "truck", lane(-1), 160, 14),
                car("on", oncoming(1700, gb=False), 140, 20),
            ],
            28,
        ),
        draw(
            "de_ot_oncoming_blinks_j",
            "As in de_ot_near_miss, but the oncoming car is not in the log for six seconds.",
            "not pass rss.opposite",
            Map((straight(1700, gb=False),)),
            [
                ego(
                    lane(-1),
                    60,
                    24,
                    [(2.5, 0), (5, 3.5), (13, 3.5), (15.5, 0)],
                    blink=[(0, "off"), (1, "left"), (5, "off"), (12.5, "right"), (15.5, "off")],
                ),
                who("t", "truck", lane(-1), 160, 14),
                car("on", oncoming(1700, gb=False), 850, 27, gaps=[(8.0, 14.0)]),
            ],
            28,
        ),
        draw(
            "de_brakes_late_j",
            "The ego comes up to a slow car and brakes late with 8 m/s2.",
            "fail criticality.drac comfort.decel-iso15622 | pass no-collision",
            Map((straight(1200, gb=False),)),
            [
                ego(lane(-1), 60, [(0, 24), (7.2, 24), (9.6, 5), (22, 5)]),
                car("l", lane(-1), 230, 5),
            ],
            22,
        ),
        draw(
            "de_two_cars_one_gap_j",
            "The ego moves right into a car that is beside it.",
            "fail no-collision | not pass stvo.rg6",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 150, 30, [(6, 0), (9, -3.5)], blink=[(0, "off"), (3, "right"), (10, "off")]),
                car("o", lane(-3), 147, 30.2),
            ],
            25,
        ),
        draw(
            "de_map_ends_j",
            "The ego follows a car 6.5 m behind it at 112 km/h and leaves the end of the map.",
            "fail stvo.rg1",
            Map((straight(900, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 400, 31),
                car("l", lane(-2), 411, 31),
            ],
            30,
        ),
        draw(
            "de_frozen_lead_speed_j",
            "The track of a car 65 m ahead freezes for 1.2 s.",
            "pass no-collision stvo.rg2",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, 30),
                car("l", lane(-2), 130, 30, frozen=(8, 9.2)),
            ],
            20,
        ),
    ]
