"""Great Britain, the second batch: short breaches in longer drives, late and thin tracks."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    BIKE,
    CAR,
    HORSE,
    TRUCK,
    VAN,
    drive,
    ego,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    OPPOSING,
    OWN,
    lane_t,
    motorway,
    overtaking,
    single,
)
from tests.outsiders.fifth.ways import Path, Speed


def british_late() -> list[Drive]:
    found: list[Drive] = []
    world, road = single(((700, 0.0),), kind="town", mph=30, walk=2.6)
    found.append(
        draw(
            "gb_footway_burst_g",
            "Past a van along the footway at 18 mph.",
            "fail r145.off-road",
            world,
            [
                ego(road.path((20, OWN), (150, OWN), (172, 4.4), (205, 4.4), (227, OWN), (700, OWN)), Speed(8.2), 50),
                drive("van", "van", VAN, road.along(1.3), Speed(0, 192), 50),
            ],
        )
    )
    world, road = single(((300, 0.0), (250, -1 / 420), (350, 0.0)))
    found.append(
        draw(
            "gb_drifts_to_wrong_side_g",
            "25 s on the wrong side of an empty road.",
            "fail r143.direction",
            world,
            [
                ego(
                    road.path((20, OWN), (240, OWN), (300, OPPOSING), (700, OPPOSING), (760, OWN), (900, OWN)),
                    Speed(16),
                    50,
                )
            ],
        )
    )
    world, road = motorway()
    found.append(
        draw(
            "gb_mway_astride_awhile_g",
            "Astride a line for 12 s and back, no lane change.",
            "fail r131.keep-in-lane",
            world,
            [
                ego(
                    road.path(
                        (30, lane_t(3)),
                        (450, lane_t(3)),
                        (500, 2 * 3.65),
                        (830, 2 * 3.65),
                        (880, lane_t(3)),
                        (1500, lane_t(3)),
                    ),
                    Speed(27),
                    50,
                )
            ],
        )
    )
    world, road = single(((1300, 0.0),))
    found.append(
        draw(
            "gb_squeezes_between_g",
            "17 m between the two cars: 4.4 m for itself leaves less than thinking distance before and behind.",
            "fail r162.return-gap | pass no-collision",
            world,
            [
                ego(overtaking(road, 170, 315, 40), Speed(22).at(300).to(15, 2.5), 34),
                drive("c0", "car", CAR, road.along(OWN), Speed(15, 110), 34),
                drive("c1", "car", CAR, road.along(OWN), Speed(15, 110 + 4.4 + 17), 34),
            ],
        )
    )
    world, road = single(((1400, 0.0),))
    found.append(
        draw(
            "gb_no_shoulder_look_g",
            "The look over the shoulder was 8 s before it pulled out and before the mirrors.",
            "fail declared.r163.checks-before-pull-out",
            world,
            [
                ego(overtaking(road, 170, 400), Speed(20), 30, ind=((6, 10, "right"),)),
                drive("lorry", "truck", TRUCK, road.along(OWN), Speed(11, 155), 30),
            ],
            events=[
                (0.3, "blind_spot_check", None),
                (5.2, "mirror_check", None),
                (6.1, "overtake_go", None),
                (6.0, "confidence", "0.95"),
            ],
        )
    )
    world, road = single(((900, 0.0),))
    found.append(
        draw(
            "gb_floors_it_g",
            "3.3 m/s2 from 13 to 25 m/s.",
            "fail comfort.accel-iso15622 | pass r124.speed-limit",
            world,
            [ego(road.along(OWN, 20), Speed(13).hold(4).to(25, 3.3), 22)],
        )
    )
    world, road = single(((900, 0.0),))
    found.append(
        draw(
            "gb_crash_between_samples_g",
            "The two go through each other between two samples at 2 Hz.",
            "not pass no-collision",
            world,
            [
                ego(road.along(OWN, 20), Speed(20, 0.0), 20, hz=2),
                drive("cross", "car", CAR, Path([(225, -260), (225, 300)]), Speed(20, 261.75 - 205), 20, hz=2),
            ],
        )
    )
    world, road = single(((900, 0.0),))
    found.append(
        draw(
            "gb_cyclist_thin_samples_g",
            "0.5 m beside a cyclist at 49 mph, between two samples.",
            "not pass r163.cyclist",
            world,
            [
                ego(road.along(1.3, 20), Speed(22, 0), 20, hz=2),
                drive("bike", "bicycle", BIKE, road.along(3.0), Speed(5, 20 + 17 * 8.25), 20, hz=2),
            ],
        )
    )
    world, road = single(((700, 0.0),))
    found.append(
        draw(
            "gb_cyclist_vanishes_g",
            "Closes on a cyclist in its lane with 0.4 m to the side, whose track ends 1 m before it.",
            "not pass r163.cyclist",
            world,
            [
                ego(road.along(1.4, 20), Speed(16), 24),
                drive("bike", "bicycle", BIKE, road.along(3.0), Speed(5, 120), 24, t1=8.7),
            ],
        )
    )
    world, road = single(((700, 0.0),), w=3.0)
    found.append(
        draw(
            "gb_horse_oncoming_g",
            "0.8 m past an oncoming horse at 34 mph.",
            "not pass r215.horse",
            world,
            [
                ego(road.along(1.2, 20), Speed(15), 24),
                drive("horse", "animal", HORSE, road.path((700, -0.9), (0, -0.9)), Speed(2.5, 480), 24),
            ],
        )
    )
    return found
