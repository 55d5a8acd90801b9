"""Germany: junctions and crossings."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    TRUCK,
    VAN,
    drive,
    ego,
    frozen,
    walk,
)
from tests.outsiders.fifth.drive import Drive, draw, light
from tests.outsiders.fifth.places import (
    ONCOMING,
    RIGHT,
    german,
    lit,
    motorway,
    spur,
    zebra,
)
from tests.outsiders.fifth.ways import Speed


def german_junctions() -> list[Drive]:
    found: list[Drive] = []
    place = lit(lht=False, walk=2.0, mph=50, unit="km/h")
    way = place.path(0, 3)
    found.append(
        draw(
            "de_red_left_turn_g",
            "Over the line 6 s after red.",
            "fail r175.red",
            place.world,
            [ego(way, Speed(8, 10), 28, ind=((6, 20, "left"),))],
            lights=light("L0", (0, "green"), (4, "amber"), (7, "red")),
        )
    )
    place = lit(False, lht=False, walk=2.0, mph=50, unit="km/h")
    way = place.path(0, 3)
    other = place.path(2, 0)
    mid = place.ways[0, 3]
    spot = mid.pose(mid.length / 2, -1.75)
    here, there = (way.near(*spot[:2]), other.near(*spot[:2]))
    found.append(
        draw(
            "de_left_turn_forces_g",
            "Turns left about a second before an oncoming car, which has to brake hard.",
            "fail r180.right-turn-gap",
            place.world,
            [
                ego(way, Speed(6.5, here - 6.5 * 12), 24, ind=((5, 15, "left"),)),
                drive(
                    "car",
                    "car",
                    CAR,
                    other,
                    Speed(13, there - 3 - 13 * 13.6).hold(11.4).to(6, 4.2).hold(4).to(10, 1),
                    24,
                ),
            ],
        )
    )
    world, road = zebra(lht=False, mph=50, unit="km/h")
    found.append(
        draw(
            "de_zebra_hasty_g",
            "Drives over the zebra in front of somebody on it.",
            "fail r195.zebra-on",
            world,
            [ego(road.along(-1.45, 50), Speed(12), 24), walk([(200.3, -5), (200.3, -3.05)], 1.4, 10.5, until=24)],
        )
    )
    world, road = zebra(lht=False, mph=50, unit="km/h")
    found.append(
        draw(
            "de_zebra_patient_g",
            "Waits for both.",
            "pass r195.zebra-on",
            world,
            [
                ego(road.along(RIGHT, 50), Speed(11).stop_at(143, 2).till(25).to(10, 1.4), 36),
                walk([(199.5, 5), (199.5, -5)], 1.1, 12, until=36),
                walk([(200.5, 5.6), (200.5, -5)], 1.1, 12.6, until=36, name="w2"),
            ],
        )
    )
    world, road = german(length=1000)
    found.append(
        draw(
            "de_overtakes_blind_frozen_g",
            "400 m to a car at 90 km/h, whose track sticks later.",
            "not pass r162.safe-distance-ahead rss.opposite",
            world,
            [
                ego(
                    road.path((20, RIGHT), (150, RIGHT), (195, ONCOMING), (330, ONCOMING), (375, RIGHT), (1000, RIGHT)),
                    Speed(22),
                    24,
                ),
                drive("lorry", "truck", TRUCK, road.along(RIGHT), Speed(13, 125), 24),
                frozen(drive("car", "car", CAR, road.back(ONCOMING), Speed(25, 240), 24), 11.5),
            ],
        )
    )
    world, road = motorway(lht=False, lanes=2, mph=100, unit="km/h", w=3.75)
    found.append(
        draw(
            "de_alks_follows_40_g",
            "9.5 m at 40 km/h, where the table asks for 15.4 m, behind something of the size of a van.",
            "not pass alks-r157.follow-gap",
            world,
            [
                ego(road.along(spur(2), 30), Speed(11), 40),
                drive("van", None, VAN, road.along(spur(2)), Speed(11, 30 + 5 + 9.5), 40),
            ],
            engaged="yes",
        )
    )
    return found
