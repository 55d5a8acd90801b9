"""Great Britain: crossings for those on foot."""

from __future__ import annotations

from tests.outsiders.fifth.cast import (
    CAR,
    VAN,
    drive,
    ego,
    walk,
)
from tests.outsiders.fifth.drive import Drive, draw, light
from tests.outsiders.fifth.places import (
    OWN,
    zebra,
)
from tests.outsiders.fifth.ways import Speed


def british_crossings() -> list[Drive]:
    found: list[Drive] = []
    world, road = zebra()
    found.append(
        draw(
            "gb_zebra_hasty_g",
            "The walker is on the zebra, in front of it, when it drives over.",
            "fail r195.zebra-on | pass no-collision",
            world,
            [ego(road.along(1.5, 50), Speed(10.5), 25), walk([(200, 5), (200, 3.05)], 1.4, 11.5)],
        )
    )
    world, road = zebra(length=420)
    found.append(
        draw(
            "gb_zebra_stops_g",
            "Waits until the walker is across.",
            "pass r195.zebra-on | not fail r191.no-stopping",
            world,
            [
                ego(road.along(OWN, 50), Speed(10).stop_at(150 - 5, 2).till(24).to(9, 1.4), 34),
                walk([(200, -5), (200, 5)], 1.2, 12, until=34),
            ],
        )
    )
    world, road = zebra()
    found.append(
        draw(
            "gb_zebra_nameless_g",
            "Something the size of a person, of no class, walks on the zebra in front of it.",
            "not pass r195.zebra-on",
            world,
            [
                ego(road.along(1.5, 50), Speed(9), 28, hz=5),
                walk([(200.4, 5), (200.4, 3.1)], 1.3, 14.2, cls=None, name="blob"),
            ],
        )
    )
    world, road = zebra(name="crosswalk")
    found.append(
        draw(
            "gb_crossing_unnamed_g",
            "Somebody is in front of it on a crossing of unknown kind.",
            "not pass r195.zebra-on",
            world,
            [ego(road.along(1.5, 50), Speed(10), 25), walk([(199.6, 5), (199.6, 3.05)], 1.4, 12.0)],
        )
    )
    world, road = zebra(n=2)
    found.append(
        draw(
            "gb_zebra_overtakes_g",
            "Drives past a van that has stopped for somebody on foot, over the zebra.",
            "fail r191.crossing-overtake | not pass r195.zebra-on",
            world,
            [
                ego(road.along(1.75, 40), Speed(9.5), 30),
                drive("van", "van", VAN, road.along(5.25, 40), Speed(9, 30).stop_at(192 - 40, 2).till(27).to(5, 1), 30),
                walk([(200, 8.5), (200, -5)], 1.3, 15.2),
            ],
        )
    )
    world, road = zebra()
    found.append(
        draw(
            "gb_zebra_queue_on_it_g",
            "Stands on the zebra behind a queue for 20 s.",
            "fail r192.keep-clear | not fail r191.no-stopping",
            world,
            [
                ego(road.along(OWN, 50), Speed(7).stop_at(150.5, 1.5).till(44).to(6, 1.2), 54, hz=5),
                *[
                    drive(
                        f"q{i}",
                        "car",
                        CAR,
                        road.along(OWN),
                        Speed(0, 207 + 6.4 * i).hold(42 - 1.5 * i).to(6, 1.2),
                        54,
                        hz=5,
                    )
                    for i in range(3)
                ],
            ],
        )
    )
    world, road = zebra()
    found.append(
        draw(
            "gb_zebra_parks_on_it_g",
            "Stands on the zebra for 14 s with nobody near.",
            "fail r191.no-stopping",
            world,
            [ego(road.along(OWN, 50), Speed(8).stop_at(149.7, 1.5).hold(14).to(8, 1.5), 48, ind=((18, 38, "hazard"),))],
        )
    )
    world, road = zebra(name="signal_crossing", light=True)
    found.append(
        draw(
            "gb_pelican_red_g",
            "Drives over the crossing on red.",
            "fail r196.pelican r175.red",
            world,
            [ego(road.along(OWN, 50), Speed(11), 24), walk([(200, 5), (200, -5)], 1.4, 5.5)],
            lights=light("P1", (0, "green"), (1, "amber"), (4, "red"), (18, "flashing"), (22, "green")),
        )
    )
    world, road = zebra(name="signal_crossing", light=True)
    found.append(
        draw(
            "gb_pelican_flashing_g",
            "Amber flashes and the walker is on its half when it goes.",
            "fail r196.pelican",
            world,
            [
                ego(road.along(1.5, 50), Speed(10).at(115).to(5, 2.4).hold(6).to(9, 1), 32),
                walk([(200, 5), (200, 3.05)], 1.3, 14.3, until=32),
            ],
            lights=light("P1", (0, "red"), (11, "flashing"), (23, "green")),
        )
    )
    world, road = zebra(name="signal_crossing", light=True)
    found.append(
        draw(
            "gb_pelican_flashing_empty_g",
            "Flashing amber, and nobody left on the crossing.",
            "pass r196.pelican | not fail r175.red",
            world,
            [
                ego(road.along(OWN, 50), Speed(9).stop_at(140, 1.7).till(24).to(8, 1.3), 36),
                walk([(200, 5), (200, -5)], 1.3, 11, until=36),
            ],
            lights=light("P1", (0, "green"), (5, "amber"), (8, "red"), (19, "flashing"), (30, "green")),
        )
    )
    world, road = zebra(name="signal_crossing", light=True)
    found.append(
        draw(
            "gb_green_still_crossing_g",
            "Green, and a slow walker still on its half.",
            "fail r198.still-crossing | pass no-collision",
            world,
            [ego(road.along(1.5, 50), Speed(9), 28, hz=20), walk([(200, -5), (200, 5)], 0.8, 6.1, until=28, hz=20)],
            lights=light("P1", (0, "red"), (12, "flashing"), (14, "green")),
        )
    )
    return found
