"""Germany: limits, cyclists and a stop sign."""

from __future__ import annotations

import math

from tests.outsiders.fourth.drive import Drive
from tests.outsiders.fourth.movement import KMH, east, ego, slow, way
from tests.outsiders.fourth.places import V50, V100, L
from tests.outsiders.fourth.worlds import crossroads, two_lane


def german_roads() -> list[Drive]:
    rural, town = two_lane("rural", V100), two_lane("town", V50, walk=True)
    drop = two_lane("rural", None, types=((0.0, "rural", V100), (400.0, "rural", 60 * KMH)))
    stop = crossroads(V50, "wesn", "stop")
    return [
        Drive(
            "de_town_without_limit_sign",
            "A driver does 70 km/h in a town for which the map says no limit.",
            "fail stvo.rg3",
            two_lane("town", None, walk=True),
            [ego(way(50, L), 70 * KMH)],
        ),
        Drive(
            "de_town_51", "A driver does 51.5 km/h in a town.", "not fail stvo.rg3", town, [ego(way(50, L), 51.5 * KMH)]
        ),
        Drive(
            "de_slows_late_for_limit",
            "A driver has braked to 60 km/h only 100 m after the sign that asks for it.",
            "fail stvo.rg3 | pass comfort.decel-iso15622",
            drop,
            [ego(way(100, L), 27.0, 400 / 27, (16.0, 2.0))],
            30.0,
        ),
        Drive(
            "de_cyclist_rural_close",
            "A driver passes a cyclist outside towns with 1.1 m between.",
            "fail stvo.s5-passing | pass no-collision",
            rural,
            [
                ego(way(0, L, shifts=((60, 110, 0.95), (220, 270, -0.95))), 20.0),
                east("cyclist", "bicycle", 120, -3.1, 5.0),
            ],
        ),
        Drive(
            "de_cyclist_unclassed_close",
            "In town a driver passes somebody of a cyclist's size and unknown kind at 0.6 m.",
            "not pass stvo.s5-passing",
            town,
            [
                ego(way(0, L, shifts=((40, 70, 0.45),)), 12.0),
                east("somebody", None, 70, -3.1, 5.0, size=(1.8, 0.6, 1.7)),
            ],
        ),
        Drive(
            "de_stop_sign_rolled_4",
            "A driver rolls over the stop line of a stop sign at 2.5 m/s.",
            "fail stvo.rin1 r171.stop-sign",
            stop,
            [ego(way(1.75, -100, math.pi / 2), 11.0, *slow(83, 11.0, 2.5, 2.0), 2.0, (10.0, 2.0))],
            25.0,
        ),
        Drive(
            "de_cyclist_filters_past",
            "A cyclist rides past a car that stands in a queue, 0.7 m beside it.",
            "not fail stvo.s5-passing | pass no-collision",
            town,
            [
                ego(way(100, L), 0.0, 18.0, (3.0, 1.0)),
                east("lead", "car", 107, L, 0.0, 16.0, (6.0, 1.5)),
                east("cyclist", "bicycle", 60, -3.65, 4.0),
            ],
            24.0,
        ),
    ]
