"""Great Britain, the second batch: junctions, solid lines and systems."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    BIKE,
    BUS,
    CAR,
    drive,
    ego,
    walk,
)
from tests.outsiders.fifth.drive import Drive, draw, light
from tests.outsiders.fifth.places import (
    OPPOSING,
    OWN,
    SHOULDER,
    Cross,
    lane_t,
    lit,
    motorway,
    single,
    zebra,
)
from tests.outsiders.fifth.ways import Speed


def british_latest() -> list[Drive]:
    found: list[Drive] = []
    place = lit(False, walk=2.0)
    way = place.path(0, 1)
    other = place.path(2, 0, din=0.9, dout=0.9)
    mid = place.ways[0, 1]
    spot = mid.pose(mid.length / 2, 1.75)
    here, there = (way.near(*spot[:2]), other.near(*spot[:2]))
    found.append(
        draw(
            "gb_right_turn_cyclist_g",
            "Turns right just before an oncoming cyclist, who brakes hard.",
            "fail r180.right-turn-gap | not pass h3.no-cut-across",
            place.world,
            [
                ego(way, Speed(6, here - 6 * 12), 24, ind=((6, 15, "right"),)),
                drive(
                    "bike",
                    "bicycle",
                    BIKE,
                    other,
                    Speed(6.5, there - 2 - 6.5 * 13.3).hold(11.2).to(2.5, 3).hold(3).to(6, 1),
                    24,
                ),
            ],
        )
    )
    place = Cross((270, 180, 0), walk=0)
    place.line(0, kind="object")
    place.sign(0, "Stop", "601.1", "GB")
    way = place.path(0, 1)
    at = place.front(0, way, 1.0)
    speed = Speed(8, 5).at(at - 22).to(0.4, 1.75).at(at + 1)
    speed.to(5, 1.2).hold(6)
    found.append(
        draw(
            "gb_stop_creeps_g",
            "Creeps over the line at 0.4 m/s and never halts.",
            "fail r171.stop-sign",
            place.world,
            [ego(way, speed, 42, ind=((8, 40, "left"),))],
        )
    )
    place = lit(walk=2.0)
    way = place.path(0, 2)
    found.append(
        draw(
            "gb_red_fast_2hz_g",
            "Straight over on red at 29 mph, at 2 Hz.",
            "fail r175.red",
            place.world,
            [ego(way, Speed(13, 5), 16, hz=2)],
            lights=light("L0", (0, "green"), (2.2, "amber"), (5.2, "red")),
        )
    )
    world, road = zebra()
    found.append(
        draw(
            "gb_zebra_late_walker_g",
            "A walker, seen by the log only just before, is on its half.",
            "not pass r195.zebra-on",
            world,
            [ego(road.along(1.5, 50), Speed(10), 25), walk([(200, 5), (200, 3.05)], 1.4, 11.5, t0=14.3)],
        )
    )
    world, road = motorway()
    found.append(
        draw(
            "gb_shoulder_hazards_on_g",
            "Drives 40 s along the shoulder at 49 mph with hazard lights on and never stops.",
            "fail r269.hard-shoulder",
            world,
            [
                ego(
                    road.path((30, lane_t(3)), (120, lane_t(3)), (190, SHOULDER), (1500, SHOULDER)),
                    Speed(22),
                    44,
                    ind=((4, 60, "hazard"),),
                )
            ],
        )
    )
    world, road = single(mark="solid solid")
    found.append(
        draw(
            "gb_solid_slow_car_g",
            "Crosses a double solid line to overtake a car that moves at 8 mph, which is no cyclist, "
            "horse or works vehicle.",
            "fail r129.no-cross-solid",
            world,
            [
                ego(
                    road.path((20, OWN), (80, OWN), (115, OPPOSING), (190, OPPOSING), (225, OWN), (900, OWN)),
                    Speed(9),
                    40,
                ),
                drive("old", "car", CAR, road.along(OWN), Speed(3.6, 85), 40),
            ],
        )
    )
    world, road = single(mark="solid solid")
    found.append(
        draw(
            "gb_solid_standing_bus_g",
            "A standing bus may be passed.",
            "not fail r129.no-cross-solid",
            world,
            [
                ego(road.path((20, OWN), (120, OWN), (150, -1.6), (185, -1.6), (215, OWN), (900, OWN)), Speed(9), 36),
                drive("bus", "bus", BUS, road.along(2.0), Speed(0, 167), 36),
            ],
        )
    )
    world, road = single(((1400, 0.0),))
    found.append(
        draw(
            "gb_overtaken_drifts_g",
            "Drifts 1.5 m towards the car that is beside it.",
            "fail r168.when-overtaken",
            world,
            [
                ego(road.path((0, OWN), (190, OWN), (235, 0.2), (330, OWN), (1400, OWN)), Speed(19, 120), 20),
                drive(
                    "rival",
                    "car",
                    CAR,
                    road.path((0, OWN), (110, OWN), (150, OPPOSING), (620, OPPOSING), (670, OWN), (1400, OWN)),
                    Speed(25, 85),
                    20,
                ),
            ],
        )
    )
    world, road = motorway(lanes=2)
    found.append(
        draw(
            "gb_alks_crawls_close_g",
            "4.2 m at 20 km/h, where 6.7 m are asked for.",
            "fail alks-r157.follow-gap",
            world,
            [
                ego(road.along(lane_t(2), 30), Speed(5.6), 40),
                drive("car", "car", CAR, road.along(lane_t(2)), Speed(5.6, 30 + 4.4 + 4.2), 40),
            ],
            engaged="yes",
        )
    )
    world, road = motorway(lanes=3)
    found.append(
        draw(
            "gb_r79_left_lamp_g",
            "Indicates left and changes right.",
            "fail alks-r157.r79.lane-change",
            world,
            [
                ego(
                    road.path((30, lane_t(2)), (260, lane_t(2)), (335, lane_t(1)), (1500, lane_t(1))),
                    Speed(23),
                    30,
                    ind=((7.2, 13, "left"),),
                )
            ],
            engaged="yes",
        )
    )
    return found
