"""Vehicles that are in many scenes, and places across a motorway."""

from __future__ import annotations

from typing import Any

from tests.outsiders.third.maps import lane_of
from tests.outsiders.third.movement import Actor, F, N, car, ego, who
from tests.outsiders.third.ways import EAST

ON_1, ON_2, ON_3 = lane_of(1, 3), lane_of(2, 3), lane_of(3, 3)  # lanes of a motorway that has three
SLOW_1, SLOW_2 = lane_of(1, 2), lane_of(2, 2)  # and of one that has two
OVER_BLINK = ((0.0, 5.0, "far"), (12.0, 16.0, "near"))
FAR_BLINK, NEAR_BLINK = ((0.0, 99.0, "far"),), ((0.0, 99.0, "near"),)
VAN = who("van", "van", EAST, (0, 60), 14)
PARKED = car(EAST, (0, 60), 0, 2.6, name="parked")


def overtaker(**more: Any) -> Actor:
    """The ego that overtakes: it takes 14 s, out at 2 s and back at 16 s."""
    speed, d = [(0, 15), (3, 15), (7, 23)], [(2, N), (5, F), (13, F), (16, N)]
    return ego(EAST, (0, 15), speed, d, blink=OVER_BLINK, **more)
