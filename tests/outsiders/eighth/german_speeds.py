"""Germany: speeds, gaps and braking on motorways."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.ways import line
from tests.outsiders.eighth.worlds import lane, straight


def german_speeds() -> list[Drive]:
    return [
        draw(
            "de_150_of_130_j",
            "The ego drives at 149 km/h where 130 is posted.",
            "fail stvo.rg3",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-1), 60, 41.5),
            ],
            25,
        ),
        draw(
            "de_102_tolerated_j",
            "The ego drives at 97 km/h where 100 is posted.",
            "pass stvo.rg3",
            Map((straight(1800, "motorway", gb=False, lanes=3, limit=100),)),
            [
                ego(lane(-2), 60, 26.9),
            ],
            25,
        ),
        draw(
            "de_lorry_96_j",
            "A lorry drives at 96 km/h on a motorway.",
            "fail stvo.rg3",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, 26.7, kind="truck"),
            ],
            25,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "de_lorry_rural_75_j",
            "A lorry over 7.5 t drives at 75 km/h outside towns.",
            "fail stvo.rg3",
            Map((straight(900, gb=False),)),
            [
                ego(lane(-1), 60, 20.8, kind="truck"),
            ],
            25,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "de_town_59_noise_j",
            "The ego drives at 59 km/h in a town, positions with noise.",
            "fail stvo.rg3",
            Map((straight(700, "town", gb=False),)),
            [
                ego(lane(-1), 40, 16.4, noise=0.05),
            ],
            25,
        ),
        draw(
            "de_zone30_j",
            "The ego speeds up to 41 km/h in a zone of 30.",
            "fail stvo.rg3",
            Map((straight(700, "town", gb=False, limit=30),)),
            [
                ego(lane(-1), 40, [(0, 8), (8, 8), (12, 11.5), (16, 8)]),
            ],
            25,
            rate=5,
        ),
        draw(
            "de_tailgate_8m_j",
            "The ego follows a car 7.5 m behind it at 122 km/h.",
            "fail stvo.rg1 criticality.thw",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-1), 60, 34),
                car("l", lane(-1), 72, 34),
            ],
            25,
        ),
        draw(
            "de_follow_safe_j",
            "The ego follows a van 67 m behind it at 119 km/h.",
            "pass stvo.rg1 stvo.rg4",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, 33),
                who("l", "van", lane(-2), 132, 33),
            ],
            25,
        ),
        draw(
            "de_cut_in_on_ego_j",
            "A car moves in 1.5 m ahead; the ego drops back, but not within three seconds.",
            "fail stvo.rg1 | not fail stvo.rg2 | pass no-collision",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, [(0, 31), (6.5, 31), (9.5, 27), (25, 27)]),
                car("c", lane(-3), 66, 31, [(3.5, 0), (6, 3.5)]),
            ],
            25,
        ),
        draw(
            "de_cut_in_stays_near_j",
            "A car moves in 5 m ahead, and the ego stays near it at 112 km/h.",
            "fail stvo.rg1",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, 31),
                car("c", lane(-3), 69, 31.3, [(3.5, 0), (6, 3.5)]),
            ],
            25,
        ),
        draw(
            "de_brake_test_j",
            "The ego brakes with 4.7 m/s2 before a car that follows it, the road ahead free.",
            "fail stvo.rg2",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-1), 60, [(0, 34), (7, 34), (10, 20), (14, 20), (20, 30)]),
                car("b", lane(-1), 25, [(0, 34), (7.5, 34), (10.5, 20), (14, 20), (20, 29)]),
            ],
            22,
        ),
        draw(
            "de_brakes_with_lead_j",
            "The ego brakes as hard as the car ahead.",
            "pass stvo.rg2 no-collision",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-1), 60, [(0, 34), (7.4, 34), (10.4, 20), (22, 20)]),
                car("l", lane(-1), 125, [(0, 34), (7, 34), (10, 20), (22, 20)]),
            ],
            22,
        ),
        draw(
            "de_brakes_for_walker_j",
            "The ego brakes hard for somebody who crosses the motorway on foot.",
            "not fail stvo.rg2 | pass no-collision",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, [(0, 32), (6, 32), (11, 4), (24, 4)]),
                who("p", "pedestrian", line((380, -2), (380, -13)), 0, [(0, 0), (4, 0), (4.2, 0.9)]),
            ],
            24,
        ),
        draw(
            "de_creeps_j",
            "The ego drives at 50 km/h on an empty motorway of 120.",
            "fail stvo.rg4",
            Map((straight(1800, "motorway", gb=False, lanes=3, limit=120),)),
            [
                ego(lane(-2), 60, 14),
            ],
            30,
        ),
        draw(
            "de_creeps_behind_slow_j",
            "The ego drives at 50 km/h behind a slow lorry on a motorway of 120.",
            "not fail stvo.rg4",
            Map((straight(1800, "motorway", gb=False, lanes=3, limit=120),)),
            [
                ego(lane(-3), 60, 14),
                who("l", "truck", lane(-3), 110, 13.9),
            ],
            30,
        ),
    ]
