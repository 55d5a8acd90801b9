"""Germany: streets, country roads and junctions."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    BIKE,
    PED,
    TRUCK,
    drive,
    ego,
    jump,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    RIGHT,
    autobahn,
    german,
    german_street,
    german_tee,
    spur,
)
from tests.outsiders.fifth.ways import Speed


def german_roads() -> list[Drive]:
    found: list[Drive] = []
    place = german_tee()
    way = place.path(0, 2)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "de_stop_rolled_g",
            "Does not halt at the stop sign, 8 km/h.",
            "fail stvo.rin1 r171.stop-sign",
            place.world,
            [ego(way, Speed(10, 5).at(at - 34).to(2.2, 1.8).hold(6).to(9, 1.3), 30, ind=((7, 22, "right"),))],
        )
    )
    place = german_tee()
    way = place.path(0, 1)
    at = place.front(0, way, 1.0)
    found.append(
        draw(
            "de_stop_kept_g",
            "Halts for 2.5 s at the line.",
            "pass stvo.rin1",
            place.world,
            [
                ego(
                    way,
                    Speed(10, 5).stop_at(at - 2.2 - 0.4, 1.7).hold(2.5).to(6, 1.4).hold(4).to(9, 1),
                    34,
                    hz=20,
                    ind=((7, 24, "left"),),
                )
            ],
        )
    )
    world, road = autobahn()
    found.append(
        draw(
            "de_lorry_30m_g",
            "31 m behind another lorry at 79 km/h.",
            "fail stvo.s4-truck",
            world,
            [
                ego(road.along(spur(3), 40), Speed(22), 32, TRUCK, "truck"),
                drive("lorry", "truck", TRUCK, road.along(spur(3)), Speed(22, 40 + 11.5 + 31), 32),
            ],
            vehicle_class="goods_over_7t5",
        )
    )
    world, road = autobahn(n=2)
    found.append(
        draw(
            "de_lorry_queue_20m_g",
            "40 km/h: the 50 m are not asked for.",
            "not fail stvo.s4-truck",
            world,
            [
                ego(road.along(spur(2), 40), Speed(11), 32, TRUCK, "truck"),
                drive("lorry", "truck", TRUCK, road.along(spur(2)), Speed(11, 40 + 11.5 + 20), 32),
            ],
            vehicle_class="goods_over_7t5",
        )
    )
    world, road = german_street()
    found.append(
        draw(
            "de_cyclist_town_08_g",
            "0.35 m beside a cyclist in a town.",
            "fail stvo.s5-passing",
            world,
            [
                ego(road.along(-1.5, 20), Speed(12.5), 26),
                drive("rad", "bicycle", BIKE, road.along(-3.05), Speed(5, 100), 26),
            ],
        )
    )
    world, road = german()
    found.append(
        draw(
            "de_cyclist_open_17_g",
            "1.7 m beside a cyclist outside built-up areas, 2 m asked for.",
            "fail stvo.s5-passing",
            world,
            [
                ego(
                    road.path((20, RIGHT), (120, RIGHT), (165, 0.0), (300, 0.0), (345, RIGHT), (900, RIGHT)),
                    Speed(18),
                    28,
                ),
                drive("rad", "bicycle", BIKE, road.along(-2.9), Speed(6, 140), 28),
            ],
        )
    )
    world, road = german()
    found.append(
        draw(
            "de_walkers_open_wide_g",
            "2.15 m beside two walkers.",
            "pass stvo.s5-passing no-collision",
            world,
            [
                ego(
                    road.path((20, RIGHT), (120, RIGHT), (165, 0.9), (260, 0.9), (305, RIGHT), (900, RIGHT)),
                    Speed(13),
                    34,
                ),
                drive("w1", "pedestrian", PED, road.along(-3.0), Speed(1.3, 180), 34),
                drive("w2", "pedestrian", PED, road.along(-2.4), Speed(1.3, 178.6), 34),
            ],
        )
    )
    world, road = german_street()
    found.append(
        draw(
            "de_cyclist_teleports_g",
            "Passes a cyclist whose track once jumps 6 m ahead with 0.1 m to spare.",
            "fail stvo.s5-passing",
            world,
            [
                ego(road.along(-1.6, 20), Speed(12), 24),
                jump(drive("rad", "bicycle", BIKE, road.along(-2.9), Speed(5, 110), 24), 7.0, 6.0, 0.0),
            ],
        )
    )
    return found
