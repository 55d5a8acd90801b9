"""Great Britain: cyclists, horses, walkers and those who come the wrong way, on country roads."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    BIKE,
    CAR,
    DOG,
    HORSE,
    PED,
    drive,
    ego,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    OPPOSING,
    OWN,
    single,
)
from tests.outsiders.fifth.ways import Speed


def british_passing() -> list[Drive]:
    found: list[Drive] = []
    world, road = single(walk=0)
    found.append(
        draw(
            "gb_wrong_way_driver_g",
            "The one that came in its lane swerves back at the last moment.",
            "pass no-collision r143.direction",
            world,
            [
                ego(road.path((20, OWN), (170, OWN), (200, 2.5), (400, 2.5)), Speed(18).hold(7.5).to(0, 4.5), 20),
                drive(
                    "ghost",
                    "car",
                    CAR,
                    road.path((900, OPPOSING), (560, OPPOSING), (520, 1.2), (330, 1.0), (285, OPPOSING), (0, OPPOSING)),
                    Speed(20, 900 - 520),
                    20,
                ),
            ],
        )
    )
    world, road = single(((1000, 0.0),))
    found.append(
        draw(
            "gb_keeps_right_g",
            "Drives 40 s on the right in Britain, with nothing to pass.",
            "fail r143.direction",
            world,
            [ego(road.along(OPPOSING, 15), Speed(15), 40, hz=5)],
        )
    )
    world, road = single(((400, 0.0), (300, -1 / 500), (300, 0.0)))
    found.append(
        draw(
            "gb_keeps_right_for_walker_g",
            "Moves over for a walker, with care.",
            "not fail r143.direction | pass no-collision",
            world,
            [
                ego(road.path((20, OWN), (150, OWN), (190, -0.6), (230, -0.6), (270, OWN), (900, OWN)), Speed(8), 35),
                drive("walker", "pedestrian", PED, road.along(3.1), Speed(1.3, 190), 35),
            ],
        )
    )
    for name, v, t, exp, why in (
        ("fast", 11.5, -0.9, "fail", "26 mph past a horse"),
        ("near", 3.9, 0.25, "fail", "1.0 m from a horse"),
        ("good", 3.9, -1.1, "pass", "8.7 mph and 2.4 m away"),
    ):
        world, road = single(mark="broken")
        way = road.path((20, OWN), (70, OWN), (100, t), (170, t), (200, OWN), (800, OWN))
        speed = Speed(v) if v > 5 else Speed(12).hold(1).to(v, 1.4)
        found.append(
            draw(
                f"gb_horse_{name}_g",
                f"{why}.",
                f"{exp} r215.horse | pass no-collision",
                world,
                [
                    ego(way, speed, 20 if v > 5 else 45),
                    drive("horse", "animal", HORSE, road.along(2.6), Speed(1.6, 105), 20 if v > 5 else 45),
                ],
            )
        )
    world, road = single()
    found.append(
        draw(
            "gb_small_dog_g",
            "A dog of 0.8 m is no horse.",
            "not fail r215.horse | pass no-collision",
            world,
            [
                ego(road.along(OWN, 20), Speed(13), 20),
                drive("dog", "animal", DOG, road.along(3.6), Speed(1.2, 120), 20),
            ],
        )
    )
    world, road = single()
    found.append(
        draw(
            "gb_cyclist_squeezed_g",
            "0.6 m at 41 mph.",
            "fail r163.cyclist | pass no-collision",
            world,
            [
                ego(road.along(1.35, 20), Speed(18.5), 22, hz=25),
                drive("bike", "bicycle", BIKE, road.along(3.15), Speed(6, 150), 22, hz=25),
            ],
        )
    )
    world, road = single()
    found.append(
        draw(
            "gb_cyclist_fast_pass_g",
            "1.7 m at 49 mph: 'more' is due above 30 mph, here 2 m.",
            "fail r163.cyclist",
            world,
            [
                ego(road.path((20, OWN), (120, OWN), (160, 0.05), (300, 0.05), (340, OWN), (800, OWN)), Speed(22), 22),
                drive("bike", "bicycle", BIKE, road.along(2.95), Speed(6, 140), 22),
            ],
        )
    )
    world, road = single(kind="town", mph=30, walk=2.2)
    found.append(
        draw(
            "gb_cyclist_town_good_g",
            "2.1 m at 26 mph.",
            "pass r163.cyclist r145.off-road",
            world,
            [
                ego(road.path((20, OWN), (60, OWN), (95, -0.4), (220, -0.4), (255, OWN), (800, OWN)), Speed(11.5), 28),
                drive("bike", "bicycle", BIKE, road.along(2.9), Speed(5, 80), 28, lamps=False),
            ],
        )
    )
    world, road = single()
    found.append(
        draw(
            "gb_cyclist_nameless_g",
            "What it passes at 0.35 m has no class, and may be a cyclist.",
            "not pass r163.cyclist | pass no-collision",
            world,
            [ego(road.along(1.5, 20), Speed(17), 22), drive("x", None, BIKE, road.along(3.05), Speed(5.5, 130), 22)],
        )
    )
    world, road = single()
    found.append(
        draw(
            "gb_cyclist_no_size_g",
            "0.7 m from the bicycle's middle line to the car's side: less than 1.5 m whatever its width.",
            "fail r163.cyclist",
            world,
            [
                ego(road.along(1.3, 20), Speed(12), 26),
                drive("bike", "bicycle", None, road.along(2.9), Speed(5, 110), 26),
            ],
        )
    )
    return found
