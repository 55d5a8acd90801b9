"""Great Britain: cyclists, horses, parked cars, and keeping to the road."""

from __future__ import annotations

import math

from tests.outsiders.third.cast import FAR_BLINK, PARKED
from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.maps import PARKING, straight, town
from tests.outsiders.third.movement import MPH, F, N, car, ego, who
from tests.outsiders.third.ways import EAST, WEST, Way


def british_roads() -> list[Drive]:
    solid = "solid solid"
    uturn = Way(-60, 4.8, 0, [(60, 0), (math.pi * 4.9, -1 / 4.9), (100, 0)], 60)
    drive = Way(-100, 1.75, 0, [(100, 0), (6 * math.pi / 2, 1 / 6), (14, 0)], 100)
    dog = who("dog", "animal", EAST, (0, 50), 1.0, 5.0, size=(0.8, 0.3, 0.6))
    horse = who("horse", "animal", EAST, (5, 30), 1.7, 2.6)
    return [
        draw(
            "gb_cyclist_over_double_white",
            "The ego crosses a double white line to pass a slow cyclist with 2 m between.",
            "not fail r129.no-cross-solid r126.thinking-gap r143.direction | pass r163.cyclist",
            straight(solid),
            [
                ego(EAST, (0, -40), 10, [(4.5, N), (7.5, -0.3), (11, -0.3), (14, N)], blink=((3.0, 7.0, "far"),)),
                who("cyclist", "bicycle", EAST, (0, 20), 3.5, 2.9),
            ],
            16,
        ),
        draw(
            "gb_cyclist_close",
            "The ego passes a cyclist in a town at 28 mph with 60 cm to spare.",
            "fail r163.cyclist | pass no-collision",
            town(),
            [
                ego(EAST, (0, -40), 12.5, [(3, N), (5, 0.8), (11, 0.8), (13, N)]),
                who("cyclist", "bicycle", EAST, (0, 30), 4, 2.6),
            ],
            15,
        ),
        draw(
            "gb_horse_fast",
            "The ego passes a horse at 34 mph.",
            "fail r215.horse",
            straight(),
            [ego(EAST, (5, -25), 15, [(3, N), (6, -1.1), (11, -1.1), (14, N)]), horse],
            17,
        ),
        draw(
            "gb_horse_slow",
            "The ego passes a horse at 9 mph with more than 2 m between.",
            "pass r215.horse no-collision | not fail r143.direction",
            straight(),
            [ego(EAST, (0, -4), 4.0, [(2, N), (7, -1.1), (18, -1.1), (23, N)]), horse._replace(at=(0, 24))],
            26,
        ),
        draw(
            "gb_dog_on_pavement",
            "The ego drives past a small dog on the pavement at 29 mph.",
            "not fail r215.horse | pass r124.speed-limit r145.off-road no-collision",
            town(),
            [ego(EAST, (0, 0), 12.9), dog],
            12,
        ),
        draw(
            "gb_parked_car_forces_oncoming_3",
            "The ego passes a parked car and makes an oncoming car brake to a halt.",
            "fail r163.obstruction-give-way | not fail r143.direction",
            town(),
            [
                ego(EAST, (0, 0), 9, [(2, N), (4.5, -0.4), (8, -0.4), (10, N)]),
                PARKED,
                car(WEST, (4, -129), [(0, 12), (4, 12), (8, 0), (11, 0), (14, 8)]),
            ],
            15,
        ),
        draw(
            "gb_waits_behind_parked_car",
            "The ego waits behind a parked car until the oncoming car is past.",
            "pass r163.obstruction-give-way no-collision | not fail r143.direction r126.thinking-gap",
            town(),
            [
                ego(
                    EAST,
                    (0, -8),
                    [(0, 9), (2, 9), (6, 0), (12, 0), (15, 7)],
                    [(12.8, N), (16, -0.4), (20, -0.4), (23, N)],
                    blink=((10.0, 16.0, "far"),),
                ),
                PARKED,
                car(WEST, (9, -60), 12),
            ],
            25,
        ),
        draw(
            "gb_wrong_side_3",
            "The ego drives on the right for twenty seconds without a reason.",
            "fail r143.direction",
            straight(),
            [ego(EAST, (0, 0), 15, [(2, N), (5, F)])],
            26,
        ),
        draw(
            "gb_u_turn",
            "The ego turns round in a wide street at walking pace.",
            "not fail r143.direction r145.off-road",
            town(beside=PARKING),
            [
                ego(
                    uturn,
                    (0, -3),
                    [(0, 0), (2, 0), (4, 2.5), (13, 2.5), (16, 7)],
                    [(10, 0), (15, -3.25)],
                    blink=((0.5, 9.0, "far"),),
                )
            ],
            20,
        ),
        draw(
            "gb_reverse_parks",
            "The ego reverses between two parked cars.",
            "not fail r143.direction r145.off-road | pass no-collision "
            "| not pass declared.r202.checks-before-reversing",
            town(beside=PARKING),
            [
                ego(
                    EAST,
                    (7.5, 60),
                    [(0, 6), (3, 6), (6, 0), (9, 0), (9.8, -1.2), (17.5, -1.2), (18.7, 0)],
                    [(10.5, N), (17.6, 4.7)],
                    blink=((4.0, 18.0, "near"),),
                ),
                car(EAST, (0, 40), 0, 4.7, name="behind"),
                car(EAST, (0, 59), 0, 4.7, name="ahead"),
            ],
            22,
        ),
        draw(
            "gb_over_the_pavement",
            "The ego passes a standing car on the near side with its wheels on the pavement.",
            "fail r145.off-road",
            town(),
            [ego(EAST, (0, 0), 8, [(2, N), (4.5, 3.9), (10, 3.9), (12.5, N)]), car(EAST, (0, 60), 0, blink=FAR_BLINK)],
            15,
        ),
        draw(
            "gb_into_driveway",
            "The ego crosses the pavement slowly into a drive.",
            "not fail r145.off-road r143.direction",
            town(),
            [ego(drive, (4, -3), [(0, 8), (4, 2.5), (9.5, 2.5), (12, 0)], 0, blink=((0.0, 10.0, "near"),))],
            14,
        ),
        draw(
            "gb_towing_58_mph",
            "The ego tows a trailer at 58 mph on a single carriageway.",
            "fail r124.speed-limit | not fail no-collision",
            straight(),
            [ego(EAST, (0, 0), 58 * MPH), who("trailer", "trailer", EAST, (0, -5.55), 58 * MPH)],
            12,
            vehicle_class="car_towing",
        ),
        draw(
            "gb_night_without_headlights",
            "The ego drives at night on a country road without headlights.",
            "fail r113.headlights",
            straight(),
            [ego(EAST, (0, 0), 20)],
            12,
            events=[(0, "headlights", "off")],
            light="night",
        ),
        draw(
            "gb_creeping_queue",
            "The ego creeps along in a queue with 3 m to the car ahead.",
            "not fail r126.thinking-gap criticality.thw r168.drop-back | pass criticality.ttc no-collision",
            town(),
            [
                ego(EAST, (0, 0), [(0, 2), (6, 2), (9, 0), (13, 0), (16, 2)]),
                car(EAST, (0, 7.7), [(0, 2), (5.5, 2), (8.5, 0), (12, 0), (15, 2)]),
            ],
            20,
        ),
        draw(
            "gb_rear_end_3",
            "The ego drives into the back of a car that has stopped.",
            "fail no-collision criticality.ttc criticality.drac criticality.ttb criticality.mttc",
            town(),
            [ego(EAST, (0, 0), 13), car(EAST, (0, 40), [(0, 13), (3, 13), (6.5, 0)])],
            7.8,
        ),
        draw(
            "gb_sideswipe",
            "The ego scrapes along a parked lorry and loses 36 mph in less than a second.",
            "fail contact-signature",
            town(beside=PARKING),
            [ego(EAST, (5, 50), [(0, 18), (4.98, 18), (5.0, 2)], 2.4), who("lorry", "truck", EAST, (0, 54), 0, 4.8)],
            8,
        ),
    ]
