"""Roundabouts, merging, and several things at once."""

from __future__ import annotations

import math

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.junctions import round_the_wrong_way, round_to, roundabout
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.ways import line
from tests.outsiders.eighth.worlds import entry_map, lane, oncoming, straight


def roundabouts_and_more() -> list[Drive]:
    return [
        draw(
            "gb_roundabout_right_j",
            "The ego drives clockwise round a roundabout; a car enters it just ahead.",
            "pass r143.direction r124.speed-limit",
            roundabout(),
            [
                ego(round_to(180, 270), 40, [(0, 10), (5, 10), (8, 5.5), (30, 5.5)]),
                car("o", round_to(0, 180), 10, [(0, 10), (5, 10), (8, 5.5), (30, 5.5)]),
            ],
            32,
        ),
        draw(
            "gb_roundabout_wrong_j",
            "The ego drives anticlockwise round most of a roundabout at 12 mph.",
            "fail r143.direction",
            roundabout(),
            [
                ego(round_the_wrong_way(), 40, [(0, 10), (5, 10), (8, 5.5), (30, 5.5)]),
            ],
            26,
        ),
        draw(
            "gb_roundabout_barges_j",
            "The ego drives onto a roundabout into a car that is on it.",
            "not pass no-collision",
            roundabout(),
            [
                ego(round_to(180, 0), 30, [(0, 10), (5, 10), (9, 6), (30, 6)]),
                car("o", round_to(270, 0), 53.5, [(0, 10), (4, 10), (8, 5.5), (30, 5.5)]),
            ],
            26,
        ),
        draw(
            "gb_roundabout_cyclist_j",
            "The ego overtakes a cyclist on a roundabout with 1 m between.",
            "not pass r163.cyclist",
            roundabout(),
            [
                ego(round_to(180, 0), 40, [(0, 10), (5, 10), (8, 6), (30, 6)], [(7, 0), (10, -1), (18, -1), (20, 0)]),
                who("c", "bicycle", round_to(180, 0), 96, 3.4, 1.4),
            ],
            30,
        ),
        draw(
            "de_merge_forces_j",
            "The ego joins a motorway some 30 m before a car that is 11 m/s faster.",
            "fail stvo.rg6 | pass no-collision",
            entry_map(gb=False),
            [
                ego(
                    lane(-4),
                    120,
                    [(0, 18), (4, 20), (12, 27), (25, 27)],
                    [(8, 0), (11.5, 3.5)],
                    blink=[(0, "off"), (4, "left"), (13, "off")],
                ),
                car("f", lane(-3), -40, [(0, 35), (8.6, 35), (11.5, 24), (25, 24)]),
            ],
            25,
        ),
        draw(
            "de_merge_room_j",
            "The ego joins a motorway 60 m before a car that is no faster.",
            "pass stvo.rg6 | not fail stvo.ri2",
            entry_map(gb=False),
            [
                ego(
                    lane(-4),
                    120,
                    [(0, 20), (3, 22), (10, 30), (25, 30)],
                    [(8, 0), (11.5, 3.5)],
                    blink=[(0, "off"), (4, "left"), (13, "off")],
                ),
                car("f", lane(-3), 10, 29),
            ],
            25,
        ),
        draw(
            "gb_merge_beside_j",
            "The ego joins a motorway into a lorry beside it.",
            "fail no-collision",
            entry_map(gb=True),
            [
                ego(
                    lane(4),
                    120,
                    [(0, 24), (25, 24)],
                    [(8, 0), (11, -3.5)],
                    blink=[(0, "off"), (4, "right"), (13, "off")],
                ),
                who("f", "truck", lane(3), 117, 24.2),
            ],
            25,
        ),
        draw(
            "gb_cutter_brakes_j",
            "A car moves in and brakes hard; the ego brakes as hard.",
            "pass no-collision | fail comfort.decel-iso15622",
            Map((straight(1200, "dual"),)),
            [
                ego(lane(2), 60, [(0, 27), (6.2, 27), (9.2, 9), (22, 9)]),
                car("c", lane(1), 82, [(0, 27), (5.5, 27), (8.5, 10), (22, 10)], [(3, 0), (5, 3.5)]),
            ],
            22,
        ),
        draw(
            "gb_crash_ahead_j",
            "Two others collide head on ahead, and the ego stops short of them.",
            "pass no-collision | not fail stvo.rg2",
            Map((straight(900),)),
            [
                ego(lane(1), 40, [(0, 20), (5, 20), (9.5, 0), (25, 0)]),
                car("a", lane(1), 130, [(0, 18), (4, 18), (5, 6), (5.5, 0)]),
                who("b", "truck", oncoming(900), 590, [(0, 20), (4.4, 20), (6.3, 0)], [(3, 0), (4.8, -3.4)]),
            ],
            25,
        ),
        draw(
            "gb_two_horses_j",
            "The ego gives one horse room and passes the next with 0.7 m between.",
            "fail r215.horse",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 3.9, [(4, 0), (9, -3), (17, -3), (21, -1), (33, -1), (37, 0)]),
                who("h1", "animal", lane(1), 78, 1.2, 1),
                who("h2", "animal", lane(1), 106, 1.2, 1),
            ],
            40,
        ),
        draw(
            "gb_steps_out_parked_j",
            "The ego stops before somebody who steps out between parked vans.",
            "pass no-collision | not fail r195.zebra-on",
            Map((straight(400, "town"),)),
            [
                ego(lane(1), 40, [(0, 9), (8.1, 9), (9.5, 0), (14, 0), (17, 7)]),
                who("v1", "van", lane(1), 126, 0, 2.6),
                who("v2", "van", lane(1), 136, 0, 2.6),
                who(
                    "p", "pedestrian", line((131, 6), (131, -7)), 0, [(0, 0), (7, 0), (7.1, 1.8)], there=(7.4, math.inf)
                ),
            ],
            22,
        ),
        draw(
            "gb_cuts_into_trailer_j",
            "The ego returns from an overtake too early, into a trailer and its lorry.",
            "fail no-collision",
            Map((straight(1600),)),
            [
                ego(lane(1), 60, 23, [(2.5, 0), (5, -3.5), (9.2, -3.5), (11.2, 0)]),
                who("tk", "truck", lane(1), 165, 14),
                who("tr", "trailer", lane(1), 153.5, 14, size=(12.0, 2.5, 3.8)),
            ],
            28,
        ),
        draw(
            "gb_ego_track_frozen_j",
            "The ego's positions freeze for nine seconds while its speed stays at 60 mph.",
            "not fail r240.no-stopping",
            Map((straight(1500, "motorway", lanes=3),)),
            [
                ego(lane(2), 60, 27, frozen=(8.0, 17.0)),
            ],
            25,
            rate=20,
        ),
        draw(
            "de_town_no_limit_posted_j",
            "The ego drives at 62 km/h in a town whose limit the map does not say.",
            "fail stvo.rg3",
            Map((straight(700, "town", gb=False, limit=None),)),
            [
                ego(lane(-1), 40, 17.2),
            ],
            25,
        ),
        draw(
            "gb_limit_in_kmh_j",
            "The ego drives at 37 mph where the map says 50 km/h.",
            "fail r124.speed-limit",
            Map((straight(700, "town", limit=50, unit="km/h"),)),
            [
                ego(lane(1), 40, 16.6),
            ],
            25,
        ),
    ]
