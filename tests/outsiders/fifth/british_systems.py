"""Great Britain: systems of UN R157 and R79."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    MOTO,
    TRUCK,
    VAN,
    drive,
    ego,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    lane_t,
    motorway,
)
from tests.outsiders.fifth.ways import Speed


def british_systems() -> list[Drive]:
    found: list[Drive] = []
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_alks_queue_too_close_g",
            "7.6 m at 36 km/h, where the table asks for about 13.8 m.",
            "fail alks-r157.follow-gap",
            world,
            [
                ego(road.along(lane_t(2), 30), Speed(10), 40),
                drive("car", "car", CAR, road.along(lane_t(2)), Speed(10, 30 + 4.4 + 7.6), 40),
                drive("far", "truck", TRUCK, road.along(lane_t(1)), Speed(9, 60), 40),
            ],
            engaged="yes",
        )
    )
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_alks_queue_tidy_g",
            "15 m at 29 km/h, stops with some 8 m.",
            "pass alks-r157.follow-gap no-collision",
            world,
            [
                ego(
                    road.along(lane_t(2), 30), Speed(8).hold(8.5).to(0, 1.1).till(28).to(5, 0.8).hold(8).to(8, 0.6), 50
                ),
                drive(
                    "car",
                    "car",
                    CAR,
                    road.along(lane_t(2)),
                    Speed(8, 30 + 4.4 + 15).hold(8).to(0, 1.2).till(26).to(6, 1).hold(7).to(9, 0.8),
                    50,
                ),
            ],
            engaged="yes",
        )
    )
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_alks_stops_too_near_g",
            "10.4 m at 25 km/h and 20 km/h, where about 8.8 and 6.7 m are asked for.",
            "not fail alks-r157.follow-gap",
            world,
            [
                ego(road.along(lane_t(2), 30), Speed(7).hold(20).to(5.5, 0.4).hold(20), 50, hz=5),
                drive(
                    "van",
                    "van",
                    VAN,
                    road.along(lane_t(2)),
                    Speed(7, 30 + 5 + 10.4).hold(20).to(5.5, 0.4),
                    50,
                    hz=5,
                    t0=0.0,
                ),
                drive("late", "motorcycle", MOTO, road.along(lane_t(2)), Speed(5.5, 30 + 140 + 110), 50, hz=5, t0=46),
            ],
            engaged="yes",
        )
    )
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_alks_cut_in_hit_g",
            "Runs into the slower car that cut in.",
            "fail no-collision alks-r157.cut-in",
            world,
            [
                ego(road.along(lane_t(2), 30), Speed(16).hold(13.2).to(7, 2.0), 22),
                drive(
                    "car",
                    "car",
                    CAR,
                    road.path((60, lane_t(1)), (213, lane_t(1)), (243, lane_t(2)), (1500, lane_t(2))),
                    Speed(9, 75),
                    22,
                ),
            ],
            engaged="yes",
        )
    )
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_alks_cut_in_not_restored_g",
            "Stays 12 m behind the car that cut in at 50 km/h, for over 25 s.",
            "fail alks-r157.cut-in-gap alks-r157.follow-gap",
            world,
            [
                ego(road.along(lane_t(2), 30), Speed(14), 40),
                drive(
                    "car",
                    "car",
                    CAR,
                    road.path((0, lane_t(1)), (150, lane_t(1)), (205, lane_t(2)), (1500, lane_t(2))),
                    Speed(15.5, 32).hold(9).to(14, 1),
                    40,
                ),
            ],
            engaged="yes",
        )
    )
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_alks_cut_in_restored_g",
            "Some 24 m within 10 s of the cut-in.",
            "pass alks-r157.cut-in-gap | not fail alks-r157.cut-in",
            world,
            [
                ego(road.along(lane_t(2), 30), Speed(14).hold(11).to(11, 1).hold(2.5).to(14, 0.7), 40),
                drive(
                    "car",
                    "car",
                    CAR,
                    road.path((0, lane_t(1)), (150, lane_t(1)), (205, lane_t(2)), (1500, lane_t(2))),
                    Speed(15.5, 32).hold(9).to(14, 1),
                    40,
                ),
            ],
            engaged="yes",
        )
    )
    for name, ev, exp, why in (
        (
            "undeclared",
            [(0, "emergency_manoeuvre", "off")],
            "fail",
            "brakes with 7 m/s2 for 2.3 s without declaring an emergency manoeuvre",
        ),
        (
            "declared",
            [(0, "emergency_manoeuvre", "off"), (9.0, "emergency_manoeuvre", "on"), (14, "emergency_manoeuvre", "off")],
            "pass",
            "declares the emergency manoeuvre as it brakes",
        ),
    ):
        world, road = motorway(lanes=2)
        found.append(
            draw(
                f"gb_alks_emergency_{name}_g",
                f"{why}.",
                f"{exp} alks-r157.emergency",
                world,
                [
                    ego(road.along(lane_t(2), 30), Speed(18).hold(9).to(2, 7).hold(4).to(8, 1), 26),
                    drive("tyre", "object", (0.8, 0.8, 0.4), road.along(lane_t(2)), Speed(0, 30 + 162 + 42), 15),
                ],
                events=ev,
                engaged="yes",
            )
        )
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_alks_mrm_rough_g",
            "5.2 m/s2 for nearly 4 s in a minimal risk manoeuvre.",
            "fail alks-r157.mrm alks-r157.mrm-hazards",
            world,
            [ego(road.along(lane_t(2), 30), Speed(20).hold(10).to(0, 5.2), 30, ind=((13, 40, "hazard"),))],
            events=[(0, "minimal_risk_manoeuvre", "off"), (8.5, "minimal_risk_manoeuvre", "on")],
            engaged="yes",
        )
    )
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_alks_mrm_gentle_g",
            "2.4 m/s2.",
            "pass alks-r157.mrm alks-r157.mrm-hazards | not fail r240.no-stopping",
            world,
            [ego(road.along(lane_t(2), 30), Speed(20).hold(10).to(0, 2.4), 32, ind=((8.5, 40, "hazard"),))],
            events=[(0, "minimal_risk_manoeuvre", "off"), (8.5, "minimal_risk_manoeuvre", "on")],
            engaged="yes",
        )
    )
    for name, a, b, ind, exp in (
        ("hasty", 260, 335, ((9.6, 13, "right"),), "fail alks-r157.r79.lane-change"),
        ("proper", 260, 335, ((7.2, 13, "right"),), "pass alks-r157.r79.lane-change alks-r157.r79.lane-change-done"),
        ("endless", 260, 900, ((16.0, 29, "right"),), "fail alks-r157.r79.lane-change-done"),
    ):
        world, road = motorway(lanes=3)
        found.append(
            draw(
                f"gb_r79_{name}_g",
                f"A lane change by the system, {name}.",
                exp,
                world,
                [
                    ego(
                        road.path((30, lane_t(3)), (a, lane_t(3)), (b, lane_t(2)), (1500, lane_t(2))),
                        Speed(23),
                        36,
                        ind=ind,
                    ),
                    drive("slow", "truck", TRUCK, road.along(lane_t(3)), Speed(20, 700), 36),
                ],
                engaged="yes",
            )
        )
    return found
