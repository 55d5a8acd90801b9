"""Great Britain: motorways and dual carriageways."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    TRUCK,
    drive,
    ego,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    SHOULDER,
    lane_t,
    motorway,
)
from tests.outsiders.fifth.ways import Speed


def british_motorways() -> list[Drive]:
    found: list[Drive] = []
    world, road = motorway()
    found.append(
        draw(
            "gb_mway_shoulder_undertakes_g",
            "590 m along the hard shoulder past a queue, no emergency.",
            "fail r269.hard-shoulder",
            world,
            [
                ego(
                    road.path(
                        (30, lane_t(3)),
                        (150, lane_t(3)),
                        (220, SHOULDER),
                        (810, SHOULDER),
                        (880, lane_t(3)),
                        (1500, lane_t(3)),
                    ),
                    Speed(26),
                    36,
                    ind=((4, 8, "left"),),
                ),
                *[
                    drive(
                        f"q{i}",
                        "truck" if i % 2 else "car",
                        TRUCK if i % 2 else CAR,
                        road.along(lane_t(3)),
                        Speed(15, 230 + 28 * i),
                        36,
                    )
                    for i in range(4)
                ],
            ],
        )
    )
    world, road = motorway()
    found.append(
        draw(
            "gb_mway_breakdown_g",
            "Breaks down and stops there with hazard lights on.",
            "not fail r269.hard-shoulder r240.no-stopping",
            world,
            [
                ego(
                    road.path((30, lane_t(3)), (260, lane_t(3)), (330, SHOULDER), (1500, SHOULDER)),
                    Speed(25).hold(12).to(0, 2.6),
                    45,
                    ind=((8, 11, "left"), (11.5, 99, "hazard")),
                ),
                drive("car", "car", CAR, road.along(lane_t(2)), Speed(30, 0), 45),
            ],
        )
    )
    world, road = motorway()
    found.append(
        draw(
            "gb_mway_stops_in_lane_g",
            "Stands for 14 s on the middle lane with nothing ahead.",
            "fail r240.no-stopping",
            world,
            [
                ego(road.along(lane_t(2), 30), Speed(24).hold(6).to(0, 3).hold(14), 30),
                *[drive(f"c{i}", "car", CAR, road.along(lane_t(1)), Speed(30, 0), 30, t0=5.0 * i) for i in range(3)],
            ],
        )
    )
    world, road = motorway()
    found.append(
        draw(
            "gb_mway_queue_g",
            "Stands in a queue.",
            "not fail r240.no-stopping r116.hazards",
            world,
            [
                ego(
                    road.along(lane_t(2), 30),
                    Speed(24).at(90).to(8, 1.6).stop_at(403, 1.2).till(46).to(6, 1),
                    55,
                    hz=5,
                    ind=((9, 20, "hazard"),),
                ),
                *[
                    drive(
                        f"q{i}",
                        "car",
                        CAR,
                        road.along(lane_t(2)),
                        Speed(0, 30 + 410 + 8 * i).hold(45 - i).to(7, 1),
                        55,
                        hz=5,
                    )
                    for i in range(5)
                ],
                *[
                    drive(f"p{i}", "truck", TRUCK, road.along(lane_t(3)), Speed(0, 420 + 16 * i), 55, hz=5)
                    for i in range(3)
                ],
            ],
        )
    )
    world, road = motorway(exit_at=(250, 700))
    speed = Speed(20, 780).to(0, 2.5).hold(3)
    speed.to(-3.5, 1.0).hold(14).to(0, 1)
    found.append(
        draw(
            "gb_mway_reverses_to_exit_g",
            "Reverses at 3.5 m/s towards the exit that it missed.",
            "fail r263.no-reverse",
            world,
            [ego(road.along(SHOULDER, 0), speed, 38)],
        )
    )
    world, road = motorway()
    found.append(
        draw(
            "gb_mway_wrong_way_g",
            "660 m against the traffic in the left lane of a motorway.",
            "fail r143.direction",
            world,
            [
                ego(road.back(lane_t(3)), Speed(22, 60), 30),
                drive("a", "car", CAR, road.along(lane_t(2)), Speed(30, 0), 30),
                drive("b", None, CAR, road.along(lane_t(1)), Speed(31, 100), 30),
            ],
        )
    )
    return found
