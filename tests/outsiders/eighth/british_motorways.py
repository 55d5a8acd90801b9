"""Great Britain: motorways."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.worlds import exit_map, lane, straight


def british_motorways() -> list[Drive]:
    return [
        draw(
            "gb_mway_coned_stop_j",
            "The ego stands in the left lane of a motorway for 13 s with nobody in its way.",
            "fail r240.no-stopping",
            Map((straight(1600, "motorway", lanes=3),)),
            [
                ego(lane(3), 60, [(0, 25), (5, 25), (15, 0), (28, 0), (38, 12)]),
            ],
            40,
        ),
        draw(
            "gb_mway_queue_stop_j",
            "The ego stands in a queue on a motorway.",
            "not fail r240.no-stopping",
            Map((straight(1600, "motorway", lanes=3),)),
            [
                ego(lane(3), 60, [(0, 25), (5, 25), (15, 0), (28, 0), (38, 8)]),
                car("q", lane(3), 321, [(0, 0), (27, 0), (36, 8)]),
            ],
            40,
        ),
        draw(
            "gb_shoulder_jam_j",
            "The ego drives along the hard shoulder past a jam.",
            "fail r269.hard-shoulder",
            Map((straight(1600, "motorway", lanes=3),)),
            [
                ego(lane(3), 60, 8, [(4, 0), (7, 3.4)]),
                car("q1", lane(3), 160, 1.5),
                car("q2", lane(2), 100, 1.5),
            ],
            35,
        ),
        draw(
            "gb_shoulder_breakdown_j",
            "The ego breaks down and stops on the hard shoulder with its hazard lights on.",
            "not fail r269.hard-shoulder r240.no-stopping",
            Map((straight(1600, "motorway", lanes=3),)),
            [
                ego(
                    lane(3),
                    60,
                    [(0, 26), (6, 24), (20, 0), (40, 0)],
                    [(7, 0), (11, 3.4)],
                    blink=[(0, "off"), (4, "left"), (11, "hazard")],
                ),
            ],
            40,
        ),
        draw(
            "gb_coachlane_lorry_j",
            "A lorry over 7.5 t moves into the third lane of a motorway.",
            "fail r265.right-lane-ban",
            Map((straight(1800, "motorway", lanes=3),)),
            [
                ego(lane(2), 60, 24.5, [(5, 0), (9, -3.5)], kind="truck"),
                who("s", "truck", lane(2), 180, 22),
            ],
            30,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "gb_mway_reverse_j",
            "The ego reverses 20 m on a motorway.",
            "fail r263.no-reverse",
            Map((straight(1600, "motorway", lanes=3),)),
            [
                ego(lane(3), 300, [(0, 6), (3, 6), (6, 0), (8, 0), (10, -3), (16, -3), (18, 0)]),
            ],
            25,
        ),
        draw(
            "gb_mway_reverse_yaw_fault_j",
            "The ego's heading is turned by pi all along at 60 mph on a motorway.",
            "not pass r263.no-reverse | not fail r124.speed-limit",
            Map((straight(1600, "motorway", lanes=3),)),
            [
                ego(lane(3), 100, 27, turned=True),
            ],
            20,
        ),
        draw(
            "gb_exit_unsignalled_j",
            "The ego leaves a motorway and signals only 120 m after the exit sign.",
            "fail exit-sign-signal",
            exit_map(),
            [
                ego(lane(3), 100, 26, [(17, 0), (21, 3.5)], blink=[(0, "off"), (17, "left"), (23, "off")]),
            ],
            27,
        ),
        draw(
            "gb_exit_signalled_j",
            "The ego leaves a motorway and signals from before the exit sign on.",
            "pass exit-sign-signal",
            exit_map(),
            [
                ego(lane(3), 100, 26, [(17, 0), (21, 3.5)], blink=[(0, "off"), (9, "left"), (23, "off")]),
            ],
            27,
        ),
        draw(
            "gb_exit_signal_stays_j",
            "The ego signals left beside an exit lane and stays on the motorway.",
            "fail signal-then-leaves",
            exit_map(),
            [
                ego(lane(3), 100, 26, blink=[(0, "off"), (14, "left"), (24, "off")]),
            ],
            32,
        ),
    ]
