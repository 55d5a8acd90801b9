"""Great Britain: collisions of every kind, and what only looks like one."""

from __future__ import annotations

import math

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.ways import line
from tests.outsiders.eighth.worlds import lane, oncoming, straight


def british_collisions() -> list[Drive]:
    return [
        draw(
            "gb_rear_end_j",
            "The ego runs into a car that slows down ahead.",
            "fail no-collision criticality.ttc criticality.ttb",
            Map((straight(700, "town"),)),
            [
                ego(lane(1), 40, [(0, 12), (8, 12), (9, 9), (9.4, 3), (12, 0)]),
                car("l", lane(1), 78, [(0, 12), (4, 12), (7, 2), (20, 2)]),
            ],
            20,
        ),
        draw(
            "gb_touch_shunt_20hz_j",
            "The ego loses 5 m/s in a step a quarter of a metre behind a car that gains as much.",
            "fail contact-signature criticality.ttc",
            Map((straight(700, "town"),)),
            [
                ego(lane(1), 40, [(0, 12), (6, 12), (6.01, 7), (9, 5)], soft=0),
                car("l", lane(1), 86.8, [(0, 5), (6, 5), (6.01, 9.5), (12, 6)], soft=0),
            ],
            15,
            rate=20,
        ),
        draw(
            "gb_sideswipe_j",
            "The ego moves over into a van beside it.",
            "fail no-collision",
            Map((straight(900, "dual"),)),
            [
                ego(lane(2), 40, 27, [(6, 0), (9, -2.2), (11, -2.2), (13, 0)]),
                who("l", "van", lane(1), 43, 27.2),
            ],
            20,
        ),
        draw(
            "gb_swiped_by_other_j",
            "A lorry moves over into the ego, which keeps its lane.",
            "fail no-collision | pass r131.keep-in-lane",
            Map((straight(900, "dual"),)),
            [
                ego(lane(1), 40, 27),
                who("l", "truck", lane(2), 42, 27, [(6, 0), (9, -1.9), (11, -1.9), (13, 0)]),
            ],
            20,
        ),
        draw(
            "gb_tunnel_2hz_j",
            "The ego and a car that crosses meet between two steps of a log that has two a second.",
            "not pass no-collision",
            Map((straight(700),)),
            [
                ego(lane(1), 40, 24),
                car("x", line((311, 61), (311, -60)), 0, [(0, 0), (6, 0), (6.01, 11.75)], soft=0),
            ],
            20,
            rate=2,
        ),
        draw(
            "gb_reverses_into_j",
            "The ego reverses into the car behind it.",
            "fail no-collision",
            Map((straight(500, "town"),)),
            [
                ego(lane(1), 120, [(0, 6), (4, 6), (6, 0), (8, 0), (9, -2.2), (16, -2.2), (17, 0)]),
                car("b", lane(1), 95, [(0, 6), (5, 6), (7.5, 0)]),
            ],
            22,
        ),
        draw(
            "gb_lost_load_j",
            "The ego drives over something that lies in its lane.",
            "fail no-collision",
            Map((straight(500),)),
            [
                ego(lane(1), 30, [(0, 20), (10.5, 20), (14, 12), (20, 12)]),
                who("o", "object", line((245, 1.5), (246, 1.5)), 0, 0, there=(6, math.inf)),
            ],
            20,
        ),
        draw(
            "gb_own_trailer_j",
            "The ego tows a caravan whose box reaches 10 cm into its own.",
            "not fail no-collision | pass r124.speed-limit",
            Map((straight(900, "dual"),)),
            [
                ego(lane(2), 60, 24),
                who("tr", "trailer", lane(2), 55.2, 24, size=(5.3, 2.0, 2.2)),
            ],
            20,
            vehicle_class="car_towing",
        ),
        draw(
            "gb_bridge_crossing_j",
            "A lorry crosses on a bridge 7 m above the ego.",
            "pass no-collision",
            Map(
                (
                    straight(900),
                    straight(200, place=(400, -100, math.pi / 2), number=2, z=7.0),
                )
            ),
            [
                ego(lane(1), 40, 20),
                who("up", "truck", line((398.25, -100), (398.25, 100)), 11.5, 5, z=7.0),
            ],
            22,
        ),
        draw(
            "gb_no_width_overlap_j",
            "An oncoming car comes through the ego's lane; the ego's size is not known.",
            "not pass no-collision",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 18, size=(None, None, None)),
                car("on", oncoming(900), 300, 18, -3.2),
            ],
            20,
        ),
        draw(
            "gb_frozen_lead_j",
            "The track of the car ahead freezes for 5 s while its speed goes on: nobody stood there.",
            "not fail no-collision",
            Map((straight(900, "dual"),)),
            [
                ego(lane(2), 60, 24),
                car("l", lane(2), 110, 24, frozen=(8.0, 13.0)),
            ],
            20,
        ),
        draw(
            "gb_stationary_child_noise_j",
            "The ego passes somebody who stands on the pavement, positions with noise.",
            "pass no-collision",
            Map((straight(700, "town"),)),
            [
                ego(lane(1), 40, 10),
                who("p", "pedestrian", line((200, 4.6), (201, 4.6)), 0, 0, noise=0.05),
            ],
            20,
        ),
        draw(
            "gb_brush_pedestrian_j",
            "The ego's side touches somebody who stands in the gutter.",
            "fail no-collision",
            Map((straight(700, "town"),)),
            [
                ego(lane(1), 40, 10, [(12, 0), (14, 0.3), (18, 0.3)]),
                who("p", "pedestrian", line((200, 3.1), (201, 3.1)), 0, 0),
            ],
            20,
        ),
    ]
