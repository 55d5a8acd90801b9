"""Great Britain: zebras and signalled crossings."""

from __future__ import annotations

import math

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.ways import line
from tests.outsiders.eighth.worlds import lane, straight


def british_crossings() -> list[Drive]:
    return [
        draw(
            "gb_zebra_swept_j",
            "The ego drives onto a zebra while a pedestrian is in the middle of its half.",
            "fail r195.zebra-on criticality.pet",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, 10.5),
                who("p", "pedestrian", line((150, 6), (150, -6)), 0, [(0, 0), (6.5, 0), (6.6, 1.3)]),
            ],
            25,
        ),
        draw(
            "gb_zebra_stops_j",
            "The ego stops before a zebra and goes on when the pedestrian has left its half.",
            "pass r195.zebra-on | not fail r191.no-stopping",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, [(0, 10), (5, 10), (9.5, 0), (14, 0), (17, 8)]),
                who("p", "pedestrian", line((150, 6), (150, -6)), 0, [(0, 0), (6, 0), (6.1, 1.4)]),
            ],
            25,
        ),
        draw(
            "gb_zebra_gone_person_j",
            "A pedestrian on a zebra is lost from the log a second before the ego drives onto it.",
            "not pass r195.zebra-on",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, 10.5),
                who("p", "pedestrian", line((150, 6), (150, -6)), 0, [(0, 0), (6.5, 0), (6.6, 1.3)], gaps=[(8.6, 25)]),
            ],
            25,
        ),
        draw(
            "gb_zebra_late_person_j",
            "A pedestrian appears in the log in mid-crossing, just after the ego drove onto the zebra.",
            "not pass r195.zebra-on",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, 10.5),
                who(
                    "p",
                    "pedestrian",
                    line((150, 6), (150, -6)),
                    0,
                    [(0, 0), (6.5, 0), (6.6, 1.3)],
                    there=(9.6, math.inf),
                ),
            ],
            25,
        ),
        draw(
            "gb_zebra_null_walker_j",
            "Somebody of unknown class walks over the zebra in front of the ego.",
            "not pass r195.zebra-on",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, 10),
                who("p", None, line((150, 6), (150, -6)), 0, [(0, 0), (6.5, 0), (6.6, 1.3)], size=(0.5, 0.6, 1.75)),
            ],
            25,
        ),
        draw(
            "gb_zebra_walks_off_j",
            "The ego drives over a zebra that somebody crossed long before.",
            "pass r195.zebra-on",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, 9.5),
                who("p", "pedestrian", line((150, 5), (150, -9)), 0, 1.4),
            ],
            25,
        ),
        draw(
            "gb_zebra_far_side_walker_j",
            "The ego drives over a zebra while somebody is on its far half.",
            "not fail r195.zebra-on",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, 10),
                who("p", "pedestrian", line((150, -3.9), (150, 6)), 0, [(0, 0), (8.3, 0), (8.4, 1.2)]),
            ],
            25,
        ),
        draw(
            "gb_plain_crossing_walker_j",
            "The ego drives onto a crossing that may be a zebra while somebody is on its half.",
            "not pass r195.zebra-on",
            Map((straight(400, "town").crossing(150, "crosswalk"),)),
            [
                ego(lane(1), 50, 10.5),
                who("p", "pedestrian", line((150, 6), (150, -6)), 0, [(0, 0), (6.5, 0), (6.6, 1.3)]),
            ],
            25,
        ),
        draw(
            "gb_child_runs_stop_j",
            "The ego stops hard before a child that runs out, 16 m short of it.",
            "pass no-collision | not fail alks-r157.emergency",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, [(0, 11), (6.2, 11), (7.9, 0), (12, 0), (16, 8)]),
                who("p", "pedestrian", line((140, 7), (140, -7)), 0, [(0, 0), (5.6, 0), (5.7, 3), (7.5, 3), (7.6, 1)]),
            ],
            25,
        ),
        draw(
            "gb_child_hit_j",
            "The ego brakes too late for a child that runs out, and hits it.",
            "fail no-collision",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, [(0, 11), (8, 11), (8.6, 5), (9.2, 0)]),
                who("p", "pedestrian", line((140, 5.2), (140, -7)), 0, [(0, 0), (5.6, 0), (5.7, 1.9)]),
            ],
            25,
        ),
        draw(
            "gb_stood_on_zebra_j",
            "The ego stands on a zebra for ten seconds with nobody about.",
            "fail r191.no-stopping",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 55, [(0, 10), (8, 10), (11, 0), (21, 0), (24, 5)]),
                who("p", "pedestrian", line((50, 6), (90, 6)), 0, 1.4),
            ],
            28,
        ),
        draw(
            "gb_queue_on_zebra_j",
            "The ego stands on a zebra in a queue for eleven seconds.",
            "fail r192.keep-clear",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, [(0, 10), (8.2, 10), (11.5, 0), (23, 0), (26, 6)]),
                who("q", "van", lane(1), 88, [(0, 10), (5, 10), (8.6, 0), (22.5, 0), (25, 6)]),
            ],
            32,
        ),
        draw(
            "gb_queue_before_zebra_j",
            "The ego waits before a zebra until the queue has gone on.",
            "not fail r192.keep-clear r191.no-stopping",
            Map((straight(400, "town").crossing(150),)),
            [
                ego(lane(1), 50, [(0, 10), (6.5, 10), (11.5, 0), (23, 0), (26, 6)]),
                who("q", "van", lane(1), 97, [(0, 10), (5, 10), (8.6, 0), (20, 0), (23, 6)]),
            ],
            32,
        ),
        draw(
            "gb_zigzag_overtake_j",
            "The ego gets past a moving car just before a zebra.",
            "fail r191.crossing-overtake",
            Map((straight(500, "town", lanes=2).crossing(200, "zebra", 7.2),)),
            [
                ego(lane(1), 60, 11.5),
                car("v", lane(2), 84, 9.4),
            ],
            25,
        ),
        draw(
            "gb_passes_yielding_car_j",
            "The ego passes a car that has stopped at a zebra for somebody.",
            "fail r191.crossing-overtake",
            Map((straight(500, "town", lanes=2).crossing(200, "zebra", 7.2),)),
            [
                ego(lane(1), 60, 9),
                car("v", lane(2), 125, [(0, 9), (5, 9), (10, 0), (18, 0), (20, 5)]),
                who("p", "pedestrian", line((200, 11), (200, -11)), 0, [(0, 0), (10, 0), (10.1, 1.2)]),
            ],
            25,
        ),
        draw(
            "gb_passes_parked_near_zebra_j",
            "The ego passes a parked car just before a zebra.",
            "not fail r191.crossing-overtake r195.zebra-on",
            Map((straight(500, "town", lanes=2).crossing(200, "zebra", 7.2),)),
            [
                ego(lane(1), 60, 9),
                car("v", lane(2), 194, 0),
            ],
            25,
        ),
        draw(
            "gb_pelican_red_empty_j",
            "The ego drives over an empty crossing on red.",
            "fail r175.red r196.pelican",
            Map(
                (
                    straight(400, "town")
                    .crossing(150, "signal_crossing")
                    .light("t1", 146, 1)
                    .stop_line("s1", 146, 1)
                    .light("t2", 154, -1)
                    .stop_line("s2", 154, -1),
                )
            ),
            [
                ego(lane(1), 50, 10),
                who("p", "pedestrian", line((150, 6), (150, -6)), 0, 0),
            ],
            25,
            lights={
                "t1": [(0, "green"), (5, "amber"), (8, "red"), (16, "red_amber"), (18, "green")],
                "t2": [(0, "green"), (5, "amber"), (8, "red"), (16, "red_amber"), (18, "green")],
            },
        ),
        draw(
            "gb_pelican_amber_flash_walker_j",
            "The ego drives onto a crossing while amber flashes and somebody is on its half.",
            "fail r196.pelican",
            Map(
                (
                    straight(400, "town")
                    .crossing(150, "signal_crossing")
                    .light("t1", 146, 1)
                    .stop_line("s1", 146, 1)
                    .light("t2", 154, -1)
                    .stop_line("s2", 154, -1),
                )
            ),
            [
                ego(lane(1), 50, 10),
                who("p", "pedestrian", line((150, 6), (150, -6)), 0, [(0, 0), (6, 0), (6.1, 1.3)]),
            ],
            25,
            lights={
                "t1": [(0, "red"), (5, "flashing"), (14, "green")],
                "t2": [(0, "red"), (5, "flashing"), (14, "green")],
            },
        ),
        draw(
            "gb_pelican_green_straggler_j",
            "The light is green, but somebody is still on the ego's half of the crossing.",
            "fail r198.still-crossing",
            Map(
                (
                    straight(400, "town")
                    .crossing(150, "signal_crossing")
                    .light("t1", 146, 1)
                    .stop_line("s1", 146, 1)
                    .light("t2", 154, -1)
                    .stop_line("s2", 154, -1),
                )
            ),
            [
                ego(lane(1), 50, 10),
                who("p", "pedestrian", line((150, 6), (150, -6)), 0, [(0, 0), (6, 0), (6.1, 1.2)]),
            ],
            25,
            lights={"t1": [(0, "red"), (7, "green")], "t2": [(0, "red"), (7, "green")]},
        ),
        draw(
            "gb_pelican_waits_j",
            "The ego waits at a signalled crossing until it has green.",
            "not fail r175.red r196.pelican r198.still-crossing",
            Map(
                (
                    straight(400, "town")
                    .crossing(150, "signal_crossing")
                    .light("t1", 146, 1)
                    .stop_line("s1", 146, 1)
                    .light("t2", 154, -1)
                    .stop_line("s2", 154, -1),
                )
            ),
            [
                ego(lane(1), 50, [(0, 10), (5.5, 10), (10.2, 0), (17.5, 0), (20, 6)]),
                who("p", "pedestrian", line((150, 6), (150, -6)), 0, [(0, 0), (8, 0), (8.1, 1.5)]),
            ],
            25,
            lights={
                "t1": [(0, "green"), (4, "amber"), (7, "red"), (16, "green")],
                "t2": [(0, "green"), (4, "amber"), (7, "red"), (16, "green")],
            },
        ),
        draw(
            "gb_pelican_flash_free_j",
            "The ego drives over a crossing while amber flashes and nobody is near it.",
            "pass r196.pelican",
            Map(
                (
                    straight(400, "town")
                    .crossing(150, "signal_crossing")
                    .light("t1", 146, 1)
                    .stop_line("s1", 146, 1)
                    .light("t2", 154, -1)
                    .stop_line("s2", 154, -1),
                )
            ),
            [
                ego(lane(1), 50, 10),
                who("p", "pedestrian", line((80, 6), (40, 6)), 0, 1.4),
            ],
            25,
            lights={
                "t1": [(0, "red"), (5, "flashing"), (14, "green")],
                "t2": [(0, "red"), (5, "flashing"), (14, "green")],
            },
        ),
        draw(
            "gb_pelican_no_state_j",
            "The ego drives onto a crossing whose lights are dark while somebody is on its half.",
            "not fail r175.red | not pass r196.pelican",
            Map(
                (
                    straight(400, "town")
                    .crossing(150, "signal_crossing")
                    .light("t1", 146, 1)
                    .stop_line("s1", 146, 1)
                    .light("t2", 154, -1)
                    .stop_line("s2", 154, -1),
                )
            ),
            [
                ego(lane(1), 50, 10),
                who("p", "pedestrian", line((150, 6), (150, -6)), 0, [(0, 0), (6, 0), (6.1, 1.3)]),
            ],
            25,
            lights={"t1": [(0, "off")], "t2": [(0, "off")]},
        ),
    ]
