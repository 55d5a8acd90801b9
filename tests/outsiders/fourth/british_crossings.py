"""Great Britain: crossings for those on foot."""

from __future__ import annotations

import math

from tests.outsiders.fourth.drive import Drive
from tests.outsiders.fourth.faults import noise
from tests.outsiders.fourth.movement import MPH, east, ego, slow, walker, way
from tests.outsiders.fourth.places import L
from tests.outsiders.fourth.road import Sign, crossing, stop_line
from tests.outsiders.fourth.worlds import two_lane


def british_crossings() -> list[Drive]:
    zebra = two_lane("town", 30 * MPH, walk=True, areas=[crossing("z1", 150.0, -3.5, 3.5, "zebra")])
    pelican = two_lane(
        "town",
        30 * MPH,
        walk=True,
        signs=[Sign("light_1", 146.0, -4.0, "traffic_light", "1000001")],
        areas=[crossing("z1", 150.0, -3.5, 3.5, "signal crossing"), stop_line("l1", 146.0, -3.5, 0.0)],
    )
    stop_zebra = [*slow(144.0, 11.0, 0.0, 2.0), 7.0, (10.0, 1.5)]
    return [
        Drive(
            "gb_zebra_walker_on",
            "A driver goes over a zebra half a metre past somebody who has stepped onto it.",
            "fail r195.zebra-on | pass no-collision",
            zebra,
            [
                ego(way(0, L, shifts=((80, 120, 0.8),)), 11.0),
                walker(150, -5.5, math.pi / 2, 0.0, 10.0, (1.2, 2.0), 1.6, (0.0, 2.0)),
            ],
            18.0,
            faults=[noise(0.03, 5)],
        ),
        Drive(
            "gb_zebra_gives_way",
            "A driver stops for somebody on a zebra and goes on when they are across.",
            "pass r195.zebra-on r191.no-stopping no-collision",
            zebra,
            [ego(way(0, L), 11.0, *stop_zebra), walker(150, -5.0, math.pi / 2, 0.0, 12.5, (1.4, 2.0))],
            32.0,
        ),
        Drive(
            "gb_zebra_walker_unclassed",
            "A driver goes over a zebra close past somebody of whom the log does not say what they are.",
            "not pass r195.zebra-on",
            zebra,
            [
                ego(way(0, L, shifts=((80, 120, 0.8),)), 11.0),
                walker(
                    150, -5.5, math.pi / 2, 0.0, 10.0, (1.2, 2.0), 1.6, (0.0, 2.0), kind=None, size=(0.5, 0.5, 1.75)
                ),
            ],
            18.0,
        ),
        Drive(
            "gb_overtakes_at_zebra_4",
            "A driver overtakes a slow car 10 m before a zebra and goes over it first.",
            "fail r191.crossing-overtake",
            zebra,
            [ego(way(0, L, shifts=((75, 105, 3.5), (165, 195, -3.5))), 12.0), east("slower", "car", 70, L, 6.0)],
            20.0,
        ),
        Drive(
            "gb_stands_on_zebra_4",
            "A driver stops on a zebra for 15 s with nobody about.",
            "fail r191.no-stopping",
            zebra,
            [ego(way(0, L), 11.0, *slow(150, 11.0, 0.0, 2.0), 15.0, (8.0, 1.5))],
            40.0,
        ),
        Drive(
            "gb_queues_on_zebra_trembling",
            "A driver stands on a zebra behind a queue for 12 s; 3 cm of noise.",
            "fail r192.keep-clear | not fail r191.no-stopping",
            zebra,
            [
                ego(way(0, L), 9.0, *slow(150, 9.0, 0.0, 1.5), 12.0, (8.0, 1.5)),
                east("queue", "car", 156.5, L, 0.0, 31.0, (9.0, 1.5)),
            ],
            40.0,
            faults=[noise(0.03, 3)],
        ),
        Drive(
            "gb_pelican_red",
            "A driver goes over a signalled crossing on red before somebody who walks there.",
            "fail r196.pelican r175.red",
            pelican,
            [ego(way(0, L), 11.0), walker(150, 3.5 + 1.4 * 11.5, -math.pi / 2)],
            18.0,
            lights={"light_1": [(0.0, "green"), (5.0, "amber"), (8.0, "red")]},
        ),
    ]
