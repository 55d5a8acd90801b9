"""Germany: logs and maps that lack something."""

from __future__ import annotations

import math

from tests.outsiders.third.cast import SLOW_1, SLOW_2
from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.maps import motorway, town
from tests.outsiders.third.movement import KMH, SIZES, N, car, ego, who
from tests.outsiders.third.ways import EAST


def german_oddities() -> list[Drive]:
    fast = 120 * KMH
    near, ahead = ego(EAST, (0, 0), 30, SLOW_2), car(EAST, (0, 9.5), 30, SLOW_2)
    odd = who("cyclist", "bicycle", EAST, (0, 30), 4, 2.6, size=None)
    return [
        draw(
            "de_class_unknown",
            "Something as long as a lorry, of unknown class, follows a lorry 25 m behind it.",
            "not pass stvo.s4-truck",
            motorway(2, math.inf),
            [
                who("ego", None, EAST, (0, 0), 80 * KMH, SLOW_1, size=SIZES["truck"]),
                who("lead", "truck", EAST, (0, 37), 80 * KMH, SLOW_1),
            ],
            15,
        ),
        draw(
            "de_tailgates_turned",
            "The ego tails a car whose heading the log has turned round.",
            "not pass stvo.rg1 criticality.thw",
            motorway(2, fast),
            [near, ahead._replace(flipped=True)],
            15,
        ),
        draw(
            "de_tailgates_2_hz",
            "The ego follows a car at 108 km/h, 5 m behind it; the log has two steps a second.",
            "fail stvo.rg1 criticality.thw",
            motorway(2, fast),
            [near, ahead],
            16,
            0.5,
        ),
        draw(
            "de_lead_vanishes",
            "The ego closes in on a car, which vanishes from the log 4 m ahead of it.",
            "fail stvo.rg1 criticality.ttc criticality.drac",
            motorway(2, fast),
            [ego(EAST, (0, 0), 32, SLOW_2), car(EAST, (0, 80), 22, SLOW_2, there=(0, 7.2))],
            12,
        ),
        draw(
            "de_road_type_unknown",
            "The ego tails a car on a road whose kind the map does not say.",
            "not pass stvo.rg1 stvo.s4-truck",
            motorway(2, None, None),
            [near, ahead],
            15,
        ),
        draw(
            "de_cyclist_size_unknown",
            "The ego passes close by a cyclist of unknown size.",
            "not pass stvo.s5-passing",
            town(50 * KMH),
            [ego(EAST, (0, -40), 12.5, [(3, N), (5, 0.8), (11, 0.8), (13, N)]), odd],
            15,
            area="built_up",
        ),
        draw(
            "de_indicator_unknown",
            "The ego changes lane on a motorway; whether it signals is not known.",
            "unknown alks-r157.r79.lane-change | pass stvo.rg3 | not fail stvo.rg6",
            motorway(2, fast),
            [ego(EAST, (0, 0), 30, [(6, SLOW_1), (10, SLOW_2)], blink=None)],
            14,
            engaged="yes",
        ),
    ]
