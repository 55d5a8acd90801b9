"""Germany: motorways."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    TRUCK,
    drive,
    ego,
    noisy,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    ONCOMING,
    RIGHT,
    autobahn,
    german,
    german_street,
    spur,
)
from tests.outsiders.fifth.ways import Speed


def german_motorways() -> list[Drive]:
    found: list[Drive] = []
    world, road = autobahn()
    found.append(
        draw(
            "de_gap_five_metres_g",
            "5 m at 130 km/h: 0.14 s, less than its reaction time and the lead's advantage.",
            "fail stvo.rg1 criticality.thw",
            world,
            [
                ego(road.along(spur(1), 30), Speed(36), 30),
                drive("car", "car", CAR, road.along(spur(1)), Speed(36, 30 + 4.4 + 5.2), 30),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_gap_wide_g",
            "58 m at 119 km/h.",
            "pass stvo.rg1 stvo.rg3",
            world,
            [
                ego(road.along(spur(2), 30), Speed(33), 30),
                drive("car", "car", CAR, road.along(spur(2)), Speed(33, 30 + 62), 30),
                drive("wide", "truck", TRUCK, road.along(spur(3)), Speed(24, 150), 30),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_brakes_for_nothing_g",
            "Brakes with 4.2 m/s2 for 3 s on an empty lane.",
            "fail stvo.rg2",
            world,
            [
                ego(road.along(spur(2), 30), Speed(34).hold(9).to(22, 4.2).hold(4).to(30, 1.2), 28),
                drive("car", "car", CAR, road.along(spur(1)), Speed(36, 0), 28),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_brakes_behind_braker_g",
            "The car ahead brakes with 5 m/s2.",
            "pass stvo.rg2 no-collision",
            world,
            [
                ego(road.along(spur(2), 30), Speed(34).hold(9.6).to(21, 4.6).hold(3).to(28, 1.0), 28),
                drive(
                    "car", "car", CAR, road.along(spur(2)), Speed(34, 30 + 52).hold(9).to(20, 5).hold(3).to(28, 1.0), 28
                ),
            ],
        )
    )
    world, road = german_street()
    found.append(
        draw(
            "de_town_64_noise_g",
            "64 km/h in a street of 50.",
            "fail stvo.rg3",
            world,
            [noisy(ego(road.along(RIGHT, 20), Speed(12).hold(3).to(17.8, 1.5).hold(8).to(12, 1.5), 26), 11)],
        )
    )
    world, road = german(kmh=None)
    found.append(
        draw(
            "de_country_119_g",
            "119 km/h on a country road without a sign, where 100 is the most.",
            "fail stvo.rg3",
            world,
            [
                ego(road.along(RIGHT, 20), Speed(33), 24),
                drive("car", "car", CAR, road.back(ONCOMING), Speed(26, 0), 24, t0=3.3),
            ],
        )
    )
    world, road = autobahn(kmh=None)
    found.append(
        draw(
            "de_lorry_104_g",
            "104 km/h in a lorry on a motorway, 80 allowed.",
            "fail stvo.rg3 | pass stvo.s4-truck",
            world,
            [
                ego(road.along(spur(3), 40), Speed(29), 30, TRUCK, "truck"),
                drive("front", "car", CAR, road.along(spur(3)), Speed(30, 40 + 120), 30),
            ],
            vehicle_class="goods_over_7t5",
        )
    )
    world, road = german(length=1000, kmh=100)
    found.append(
        draw(
            "de_lorry_country_78_g",
            "77 km/h in a lorry over 7.5 t on a country road, 60 allowed.",
            "fail stvo.rg3",
            world,
            [
                ego(road.along(RIGHT, 40), Speed(21.5), 26, TRUCK, "truck"),
                drive("trailer", "trailer", (7, 2.5, 3.5), road.along(RIGHT, 29.5), Speed(21.5), 26),
            ],
            vehicle_class="goods_over_7t5",
        )
    )
    world, road = german(length=1000, kmh=100)
    found.append(
        draw(
            "de_caravan_country_76_g",
            "74 km/h with a caravan on a country road, 80 allowed.",
            "pass stvo.rg3",
            world,
            [
                ego(road.along(RIGHT, 40), Speed(20.5), 26),
                drive("caravan", "trailer", (6.2, 2.3, 2.6), road.along(RIGHT, 33.4), Speed(20.5), 26),
            ],
            vehicle_class="car_towing",
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_crawls_on_motorway_g",
            "54 km/h in the middle lane of a free motorway with a limit of 130, for no reason.",
            "fail stvo.rg4",
            world,
            [
                ego(road.along(spur(2), 30), Speed(15), 40),
                drive("car", "car", CAR, road.along(spur(1)), Speed(36, 0), 40),
                drive("car2", "car", CAR, road.along(spur(3)), Speed(30, 0), 40),
            ],
        )
    )
    world, road = autobahn(kmh=120)
    found.append(
        draw(
            "de_slow_behind_slow_g",
            "Slow because of the slow vehicle ahead.",
            "not fail stvo.rg4",
            world,
            [
                ego(road.along(spur(3), 30), Speed(15.5), 40, hz=5),
                drive("harvester", "truck", (9, 3.0, 3.8), road.along(spur(3)), Speed(15.5, 30 + 45), 40, hz=5),
            ],
        )
    )
    return found
