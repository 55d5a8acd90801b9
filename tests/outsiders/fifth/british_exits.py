"""Great Britain: motorway lanes and exits."""

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
    lane_t,
    motorway,
    single,
)
from tests.outsiders.fifth.road import signal
from tests.outsiders.fifth.ways import Speed


def british_exits() -> list[Drive]:
    found: list[Drive] = []
    world, road = motorway(lanes=3)
    found.append(
        draw(
            "gb_mway_lorry_lane_three_g",
            "A lorry over 7.5 t overtakes in the third of three lanes.",
            "fail r265.right-lane-ban",
            world,
            [
                ego(
                    road.path(
                        (30, lane_t(2)),
                        (120, lane_t(2)),
                        (200, lane_t(1)),
                        (700, lane_t(1)),
                        (780, lane_t(2)),
                        (1500, lane_t(2)),
                    ),
                    Speed(24.5),
                    36,
                    TRUCK,
                    "truck",
                ),
                drive("slow", "truck", TRUCK, road.along(lane_t(2)), Speed(17, 130), 36),
            ],
            vehicle_class="goods_over_7t5",
        )
    )
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_mway_lorry_two_lanes_g",
            "The motorway has but two lanes.",
            "not fail r265.right-lane-ban | pass r124.speed-limit",
            world,
            [
                ego(
                    road.path(
                        (30, lane_t(2)),
                        (120, lane_t(2)),
                        (200, lane_t(1)),
                        (700, lane_t(1)),
                        (780, lane_t(2)),
                        (1500, lane_t(2)),
                    ),
                    Speed(24.5),
                    36,
                    TRUCK,
                    "truck",
                ),
                drive("slow", "truck", TRUCK, road.along(lane_t(2)), Speed(17, 130), 36),
            ],
            vehicle_class="goods_over_7t5",
        )
    )
    world, road = motorway(lanes=3)
    found.append(
        draw(
            "gb_mway_caravan_lane_three_g",
            "A car with a caravan in the third of three lanes.",
            "fail r265.right-lane-ban | pass r124.speed-limit",
            world,
            [
                ego(road.path((40, lane_t(1)), (900, lane_t(1)), (980, lane_t(2)), (1500, lane_t(2))), Speed(25.5), 40),
                drive(
                    "caravan",
                    "trailer",
                    (6.4, 2.2, 2.6),
                    road.path((33.3, lane_t(1)), (900, lane_t(1)), (980, lane_t(2)), (1500, lane_t(2))),
                    Speed(25.5),
                    40,
                ),
            ],
            vehicle_class="car_towing",
        )
    )
    for name, ind, leave, exp in (
        ("silent", (), True, "fail exit-sign-signal"),
        ("signalled", ((14, 27, "left"),), True, "pass exit-sign-signal"),
        ("misleads", ((23.5, 42, "left"),), False, "fail signal-then-leaves"),
    ):
        world, road = motorway(
            exit_at=(600, 1000), signals=[signal("e1", "exit", 560, 3 * 3.65 + 4, "+", "-1", "", (3, 3))]
        )
        way = (
            road.path((30, lane_t(3)), (640, lane_t(3)), (730, lane_t(4)), (1000, lane_t(4)))
            if leave
            else road.along(lane_t(3), 30)
        )
        found.append(
            draw(
                f"gb_exit_{name}_g",
                f"An exit from a motorway, {name}.",
                exp,
                world,
                [ego(way, Speed(26), 36 if leave else 50, ind=ind)],
            )
        )
    world, road = motorway()
    found.append(
        draw(
            "gb_mway_tailgates_g",
            "9 m at 68 mph, less than half of the thinking distance.",
            "fail r126.thinking-gap criticality.thw",
            world,
            [
                noisy(ego(road.along(lane_t(1), 30), Speed(30.5), 30), 3, 0.04),
                drive("car", "car", CAR, road.along(lane_t(1)), Speed(30.5, 30 + 4.4 + 9), 30, hz=10),
            ],
        )
    )
    world, road = motorway()
    found.append(
        draw(
            "gb_mway_astride_g",
            "Astride the line between two lanes for 26 s.",
            "fail r131.keep-in-lane",
            world,
            [ego(road.along(2 * 3.65, 30), Speed(27), 26)],
        )
    )
    world, road = motorway(length=500)
    found.append(
        draw(
            "gb_mway_map_ends_g",
            "8 m at 65 mph on the map's 500 m; after them there is no road to tell.",
            "not pass r126.thinking-gap | not fail r124.speed-limit",
            world,
            [
                ego(road.along(lane_t(2), 30), Speed(29), 30),
                drive("car", "car", CAR, road.along(lane_t(2)), Speed(29, 30 + 4.4 + 8), 30),
            ],
        )
    )
    world, road = single(((1500, 0.0),), kind="rural", mph=70, n=2)
    found.append(
        draw(
            "gb_dual_towing_67_g",
            "67 mph with a trailer on a dual carriageway, 60 allowed.",
            "fail r124.speed-limit",
            world,
            [
                ego(road.path((40, 5.25), (1500, 5.25)), Speed(30), 30),
                drive("horsebox", "trailer", (4.5, 2.1, 2.6), road.path((34, 5.25), (1500, 5.25)), Speed(30), 30),
            ],
            vehicle_class="car_towing",
            carriageway="dual",
        )
    )
    return found
