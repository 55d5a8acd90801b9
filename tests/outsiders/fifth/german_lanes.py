"""Germany: lanes, queues and stops on motorways."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    TRUCK,
    drive,
    ego,
    turned,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    autobahn,
    spur,
)
from tests.outsiders.fifth.ways import Speed


def german_lanes() -> list[Drive]:
    found: list[Drive] = []
    world, road = autobahn()
    found.append(
        draw(
            "de_cuts_off_fast_car_g",
            "Pulls out some 40 m before a car that comes at 158 km/h, 50 km/h faster.",
            "fail stvo.rg6 | not fail no-collision",
            world,
            [
                ego(
                    road.path((30, spur(2)), (300, spur(2)), (360, spur(1)), (1500, spur(1))),
                    Speed(30, 120),
                    26,
                    ind=((4, 8, "left"),),
                ),
                drive("fast", "car", CAR, road.along(spur(1)), Speed(44, 30).hold(5.2).to(30, 6.5), 26),
                drive("truck", "truck", TRUCK, road.along(spur(2)), Speed(23, 260), 26),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_changes_with_room_g",
            "150 m and more to the car behind.",
            "pass stvo.rg6 stvo.rg3",
            world,
            [
                ego(
                    road.path((30, spur(2)), (300, spur(2)), (400, spur(1)), (1500, spur(1))),
                    Speed(33, 200),
                    26,
                    ind=((0, 6, "left"),),
                ),
                drive("behind", "car", CAR, road.along(spur(1)), Speed(34, 40), 26),
                drive("truck", "truck", TRUCK, road.along(spur(2)), Speed(23, 380), 26),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_stops_for_picture_g",
            "Comes to stand on the right lane with nobody ahead.",
            "fail stvo.ri1 r240.no-stopping",
            world,
            [
                ego(road.along(spur(3), 30), Speed(28).hold(6).to(0, 2.8).hold(10), 32),
                drive("car", None, CAR, road.along(spur(2)), Speed(34, 0), 32, t0=3, t1=21),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_stops_in_jam_g",
            "Comes to stand behind a jam.",
            "pass stvo.ri1 | not fail r240.no-stopping",
            world,
            [
                ego(road.along(spur(3), 30), Speed(16).hold(9).to(0, 1.3), 40),
                *[
                    drive(f"j{i}", "car", CAR, road.along(spur(3)), Speed(0, 30 + 144 + 98.5 + 7 + 8 * i), 40)
                    for i in range(4)
                ],
                *[drive(f"k{i}", "truck", TRUCK, road.along(spur(2)), Speed(0, 200 + 17 * i), 40) for i in range(6)],
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_passes_on_right_g",
            "Passes a car at 94 km/h on its right with 119.",
            "fail stvo.ri2",
            world,
            [
                ego(road.along(spur(3), 30), Speed(33), 28),
                drive("sleeper", "car", CAR, road.along(spur(2)), Speed(26, 120), 28),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_passes_jam_on_right_g",
            "11 km/h faster than two slow queues on its left.",
            "pass stvo.ri2",
            world,
            [
                ego(road.along(spur(3), 30), Speed(9), 40),
                *[drive(f"q{i}", "car", CAR, road.along(spur(2)), Speed(6, 60 + 12 * i), 40) for i in range(6)],
                *[drive(f"z{i}", "car", CAR, road.along(spur(1)), Speed(6.5, 55 + 13 * i), 40) for i in range(6)],
            ],
        )
    )
    world, road = autobahn(exit_at=(300, 800))
    speed = Speed(20, 820).to(0, 2.5).hold(2)
    speed.to(-4, 1.0).hold(16)
    found.append(
        draw(
            "de_reverses_g",
            "Reverses for 16 s on the motorway's shoulder.",
            "fail stvo.ri3 r263.no-reverse",
            world,
            [ego(road.along(-(3 * 3.75 + 1.5)), speed, 36, ind=((0, 40, "hazard"),))],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_ghost_driver_turned_g",
            "Moves against the traffic for 700 m, whatever its heading says.",
            "not pass stvo.ri3 r143.direction",
            world,
            [
                turned(ego(road.back(spur(1)), Speed(30, 100), 24)),
                drive("car", "car", CAR, road.along(spur(2)), Speed(34, 0), 24),
            ],
        )
    )
    return found
