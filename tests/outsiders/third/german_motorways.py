"""Germany: motorways."""

from __future__ import annotations

import math

from tests.outsiders.third.cast import SLOW_1, SLOW_2
from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.maps import motorway
from tests.outsiders.third.movement import KMH, car, ego, who
from tests.outsiders.third.ways import EAST, WEST


def german_motorways() -> list[Drive]:
    left_queue = [car(EAST, (0, 40 + 14 * i), 10, SLOW_2, name=f"queue_{i}") for i in range(5)]
    row = [car(EAST, (0, 400 - 8 * i), 0, SLOW_2, name=f"queue_{i}") for i in range(3)]
    lorry = who("lorry", "truck", EAST, (0, 80), 12, SLOW_1)
    fast = 120 * KMH
    return [
        draw(
            "de_autobahn_150",
            "The ego drives 150 km/h on an empty motorway without a limit.",
            "pass stvo.rg3 stvo.ri3 | not fail stvo.rg4",
            motorway(2, math.inf),
            [ego(EAST, (0, -100), 150 * KMH, SLOW_1)],
            15,
        ),
        draw(
            "de_trailer_97",
            "The ego tows a trailer at 97 km/h on a motorway; it may be approved for 100.",
            "unknown stvo.rg3 | not fail no-collision stvo.rg1",
            motorway(2, math.inf),
            [ego(EAST, (0, 0), 97 * KMH, SLOW_1), who("trailer", "trailer", EAST, (0, -5.55), 97 * KMH, SLOW_1)],
            12,
            vehicle_class="car_towing",
        ),
        draw(
            "de_follows_45_m",
            "The ego follows a car at 108 km/h, 55 m behind it.",
            "pass stvo.rg1 criticality.thw criticality.ttc | not fail stvo.rg4",
            motorway(2, fast),
            [ego(EAST, (0, 0), 30, SLOW_1), car(EAST, (0, 59.5), 30, SLOW_1)],
            16,
        ),
        draw(
            "de_brake_test",
            "The ego brakes hard without a reason before a car behind it.",
            "fail stvo.rg2",
            motorway(2, fast),
            [
                ego(EAST, (0, 0), [(0, 30), (5, 30), (7.2, 18), (12, 25)], SLOW_2),
                car(EAST, (0, -60), [(0, 30), (5.5, 30), (9, 15), (14, 22)], SLOW_2),
            ],
            16,
        ),
        draw(
            "de_queue_end",
            "The ego brakes and stops behind the end of a queue.",
            "not fail stvo.rg2 stvo.ri1 stvo.rg4 stvo.rg1 | pass no-collision",
            motorway(2, fast),
            [
                ego(EAST, (18, 390), [(0, 30), (5, 30), (15, 0)], SLOW_1, blink=((5.0, 17.0, "hazard"),)),
                car(EAST, (0, 399), 0, SLOW_1),
                *row,
            ],
            26,
        ),
        draw(
            "de_crawls_3",
            "The ego drives 43 km/h on an empty motorway with a limit of 120.",
            "fail stvo.rg4",
            motorway(2, fast),
            [ego(EAST, (0, 0), 12, SLOW_1)],
            40,
        ),
        draw(
            "de_behind_slow_lorry",
            "The ego follows a lorry that does 43 km/h; the other lane is full.",
            "not fail stvo.rg4 stvo.rg1 stvo.ri2",
            motorway(2, fast),
            [
                ego(EAST, (0, 0), [(0, 16), (6, 16), (10, 12)], SLOW_1),
                lorry,
                *[car(EAST, (0, -150 + 45 * i), 27, SLOW_2, name=f"fast_{i}") for i in range(4)],
            ],
            30,
        ),
        draw(
            "de_stops_3",
            "The ego stops on a motorway for no reason.",
            "fail stvo.ri1 r240.no-stopping",
            motorway(2, fast),
            [ego(EAST, (0, 0), [(0, 25), (3, 25), (13, 0), (25, 0), (33, 20)], SLOW_1)],
            33,
        ),
        draw(
            "de_overtakes_on_the_right",
            "The ego passes a car in the left lane on its right.",
            "fail stvo.ri2",
            motorway(2, fast),
            [ego(EAST, (0, 0), 32, SLOW_1), car(EAST, (0, 50), 26, SLOW_2)],
            18,
        ),
        draw(
            "de_passes_queue_slowly",
            "The ego passes a slow queue in the left lane a little faster on its right.",
            "not fail stvo.ri2 stvo.rg4",
            motorway(2, fast),
            [ego(EAST, (0, 0), 13, SLOW_1), *left_queue, who("lorry", "truck", EAST, (0, 140), 10.5, SLOW_1)],
            20,
        ),
        draw(
            "de_enters",
            "The ego passes a car on the motorway while it is still in the lane for joining.",
            "not fail stvo.ri2 | pass stvo.ri3 no-collision",
            motorway(2, fast, extra="entry"),
            [
                ego(EAST, (0, 20), [(0, 22), (6, 30)], [(8, 10.75), (12, SLOW_1)], blink=((3.0, 12.0, "far"),)),
                car(EAST, (0, 35), 24, SLOW_1),
            ],
            16,
        ),
        draw(
            "de_reverses_3",
            "The ego reverses on the motorway.",
            "fail stvo.ri3",
            motorway(2, fast),
            [ego(EAST, (7, 100), [(0, 15), (6, 0), (8, 0), (10, -3), (20, -3)], SLOW_1)],
            20,
        ),
        draw(
            "de_wrong_way",
            "The ego drives against the traffic on a motorway.",
            "fail stvo.ri3",
            motorway(2, fast),
            [ego(WEST, (0, -600), 25, -SLOW_2), car(EAST, (7, 330), 30, SLOW_1)],
            15,
        ),
        draw(
            "de_lorry_close_3",
            "A lorry follows another at 80 km/h, 25 m behind it.",
            "fail stvo.s4-truck",
            motorway(2, math.inf),
            [ego(EAST, (0, 0), 80 * KMH, SLOW_1, kind="truck"), who("lead", "truck", EAST, (0, 37), 80 * KMH, SLOW_1)],
            15,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "de_lorry_in_slow_traffic",
            "A lorry follows another at 40 km/h, 22 m behind it.",
            "not fail stvo.s4-truck stvo.rg4 | pass stvo.rg1",
            motorway(2, math.inf),
            [ego(EAST, (0, 0), 40 * KMH, SLOW_1, kind="truck"), who("lead", "truck", EAST, (0, 34), 40 * KMH, SLOW_1)],
            15,
            vehicle_class="goods_over_7t5",
        ),
    ]
