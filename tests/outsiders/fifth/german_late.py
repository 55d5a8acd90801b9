"""Germany, the second batch."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    MOTO,
    TRUCK,
    drive,
    ego,
    noisy,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    autobahn,
    single,
    spur,
)
from tests.outsiders.fifth.ways import Speed


def german_late() -> list[Drive]:
    found: list[Drive] = []
    world, road = autobahn()
    found.append(
        draw(
            "de_brake_test_g",
            "Brakes with 3.6 m/s2 before a car close behind, nothing ahead.",
            "fail stvo.rg2",
            world,
            [
                ego(road.along(spur(1), 150), Speed(33).hold(8).to(24, 3.6).hold(2).to(33, 1.5), 28),
                drive(
                    "pusher",
                    "car",
                    CAR,
                    road.along(spur(1)),
                    Speed(33, 150 - 24).hold(8.6).to(23, 4.6).hold(4).to(31, 1.2),
                    28,
                ),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_cut_in_never_restored_g",
            "8.6 m at 112 km/h for 25 s after the cut-in; 11.6 m asked for.",
            "fail stvo.rg1",
            world,
            [
                ego(road.along(spur(2), 30), Speed(31), 34),
                drive(
                    "car",
                    "car",
                    CAR,
                    road.path((0, spur(1)), (210, spur(1)), (290, spur(2)), (1500, spur(2))),
                    Speed(33, 30).hold(5.5).to(31, 1),
                    34,
                ),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_cuts_off_nameless_g",
            "Pulls out close before something fast of no class, of a motorcycle's size.",
            "not pass stvo.rg6",
            world,
            [
                ego(road.path((30, spur(2)), (300, spur(2)), (360, spur(1)), (1500, spur(1))), Speed(30, 120), 26),
                drive("x", None, MOTO, road.along(spur(1)), Speed(44, 30).hold(5.2).to(30, 6.5), 26),
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_lorry_behind_nameless_g",
            "26 m behind something of a lorry's size.",
            "not pass stvo.s4-truck",
            world,
            [
                noisy(ego(road.along(spur(3), 40), Speed(22), 32, TRUCK, "truck"), 5, 0.03),
                drive("x", None, (9, 2.5, 3.5), road.along(spur(3)), Speed(22, 40 + 10.25 + 26), 32),
            ],
            vehicle_class="goods_7t5",
        )
    )
    world, road = single(((900, 0.0),), lht=False, mph=100, unit="km/h")
    found.append(
        draw(
            "de_oncoming_appears_late_g",
            "A car comes into the log 230 m ahead in mid-overtake.",
            "not pass r162.safe-distance-ahead | fail rss.opposite",
            world,
            [
                ego(
                    road.path((20, -1.75), (150, -1.75), (195, 1.75), (290, 1.75), (335, -1.75), (900, -1.75)),
                    Speed(22),
                    24,
                ),
                drive("lorry", "truck", TRUCK, road.path((0, -1.75), (900, -1.75)), Speed(10, 125), 24),
                drive(
                    "car", "car", CAR, road.path((900, 1.75), (0, 1.75)), Speed(24, 235).hold(10.5).to(5, 5), 24, t0=9.0
                ),
            ],
        )
    )
    return found
