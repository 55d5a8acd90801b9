"""Great Britain: people, contacts, footways, lamps and limits in towns."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    VAN,
    drive,
    ego,
    gap,
    walk,
)
from tests.outsiders.fifth.drive import Drive, draw
from tests.outsiders.fifth.places import (
    OWN,
    single,
)
from tests.outsiders.fifth.road import Road
from tests.outsiders.fifth.ways import Speed


def british_streets() -> list[Drive]:
    found: list[Drive] = []
    world, road = single(((400, 0.0),), kind="town", mph=30, walk=2.2)
    found.append(
        draw(
            "gb_child_emergency_stop_g",
            "Stops 5 m before the child.",
            "pass no-collision | not fail contact-signature | not pass comfort.decel-iso15622",
            world,
            [
                ego(road.along(OWN, 20), Speed(12.5).hold(7.2).to(0, 7.5).hold(6).to(8, 1.2), 26, hz=20),
                drive("parked", "van", VAN, road.along(-2.3), Speed(0, 126), 26, hz=20),
                walk([(130, -4.5), (130, 5)], 2.2, 6.4, size=(0.4, 0.4, 1.1), until=26, name="child", hz=20),
            ],
        )
    )
    world, road = single(((400, 0.0),), kind="town", mph=30, walk=2.2)
    found.append(
        draw(
            "gb_child_hit_g",
            "Runs into the child at some 8 m/s.",
            "fail no-collision",
            world,
            [
                ego(road.along(OWN, 20), Speed(12.5).hold(8.2).to(0, 7.0), 20, hz=5),
                walk([(131, -4.5), (131, 2.1)], 2.2, 6.2, size=(0.4, 0.4, 1.1), until=20, name="child", hz=5),
            ],
        )
    )
    world, road = single(((500, 0.0),), kind="town", mph=40, walk=2.2)
    hits = ego(road.along(OWN, 20), Speed(13).hold(7.95).acc(-45, 0.16).to(0, 3), 16, hz=25)
    hit = 13 * 8.0 + 20
    found.append(
        draw(
            "gb_shunt_thin_boxes_g",
            "Loses 7 m/s within 0.16 s, a hand's breadth behind a car that jumps forward.",
            "fail contact-signature | pass no-collision",
            world,
            [
                hits,
                drive(
                    "car",
                    "car",
                    (4.0, 1.7, 1.5),
                    road.along(OWN),
                    Speed(3, hit + 4.5 - 3 * 8.0).hold(7.95).acc(40, 0.12).to(0, 2),
                    16,
                    hz=25,
                ),
            ],
        )
    )
    world, road = single(((500, 0.0),), kind="town", mph=30, walk=2.6)
    found.append(
        draw(
            "gb_footway_passes_queue_g",
            "Drives along the footway at 19 mph past a queue.",
            "fail r145.off-road",
            world,
            [
                ego(road.path((20, OWN), (90, OWN), (115, 4.5), (190, 4.5), (215, OWN), (500, OWN)), Speed(8.5), 40),
                *[drive(f"q{i}", "car", CAR, road.along(1.2), Speed(0, 130 + 7 * i), 40) for i in range(7)],
            ],
        )
    )
    world, road = single(((300, 0.0),), kind="town", mph=30, walk=2.6)
    way = road.path((20, OWN), (120, OWN))
    other = Road(0, *road.pose(120, OWN), [(130, 9.5, 1.1)], [], [])
    found.append(
        draw(
            "gb_footway_to_drive_g",
            "Crosses the footway at 6 mph to a property.",
            "not fail r145.off-road",
            world,
            [
                ego(
                    way + other.path((0, 0), (other.length, 0)),
                    Speed(8).at(60).to(2.6, 0.9).stop_at(109, 1),
                    45,
                    ind=((5, 28, "left"),),
                )
            ],
        )
    )
    world, road = single(((500, 0.0),), kind="town", mph=30, walk=2)
    found.append(
        draw(
            "gb_hazards_driving_g",
            "Hazard lights on for 14 s at 25 mph in a town.",
            "fail r116.hazards",
            world,
            [ego(road.along(OWN, 20), Speed(11), 25, ind=((6, 20, "hazard"),))],
        )
    )
    world, road = single(((500, 0.0),), kind="town", mph=30, walk=2)
    found.append(
        draw(
            "gb_horn_standing_g",
            "Hoots while standing, nobody within sight.",
            "fail r112.horn",
            world,
            [ego(road.along(OWN, 20), Speed(8).stop_at(90, 2).hold(12).to(8, 2), 36)],
            events=[(0, "horn", "off"), (18, "horn", "on"), (20, "horn", "off")],
        )
    )
    world, road = single(((700, 0.0),), kind="town", mph=30, walk=2)
    found.append(
        draw(
            "gb_town_37mph_2hz_g",
            "37 mph in a 30.",
            "fail r124.speed-limit",
            world,
            [ego(road.along(OWN, 20), Speed(12).hold(4).to(16.6, 1).hold(12).to(12, 1), 36, hz=2)],
        )
    )
    world, road = single(((700, 0.0),), kind="town", mph=20, walk=2)
    found.append(
        draw(
            "gb_zone20_gap_in_track_g",
            "27 mph in a 20, before and after the hole in the log.",
            "fail r124.speed-limit",
            world,
            [gap(ego(road.along(OWN, 20), Speed(8).hold(4).to(12, 1).hold(12).to(8, 1), 36), 10.0, 12.5)],
        )
    )
    return found
