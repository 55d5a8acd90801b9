"""Great Britain: roundabouts and crossing ways."""

from __future__ import annotations

import math

import numpy as np

from tests.outsiders.seventh.cast import BICYCLE, NARROW
from tests.outsiders.seventh.crossroads import Crossroads
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.movement import Actor, Pace, ego
from tests.outsiders.seventh.roundabout import Roundabout
from tests.outsiders.seventh.ways import through


def _roundabout_wrong_way() -> Drive:
    m = Roundabout()
    a = m.arms[0]
    angles = math.atan2(a.start[1], a.start[0]) + np.linspace(0.25, 2.4, 60)
    ring = [(20.0 * math.cos(angle), 20.0 * math.sin(angle)) for angle in angles]
    p = through(a.at(70, -m.own)[:2], a.at(2, -m.own)[:2], *ring)
    return draw(
        "gb_roundabout_wrong_way_i",
        "Goes round the roundabout anticlockwise for 7 s at 6 m/s.",
        "fail r143.direction",
        m,
        [ego(p, Pace(6), start=5)],
        20,
    )


def _roundabout_straight_on() -> Drive:
    m = Roundabout()
    p = m.way(0, 2)
    return draw(
        "gb_roundabout_straight_on_i",
        "Clockwise, second exit. A cyclist follows 15 m behind, a car stands in another arm.",
        "pass r143.direction no-collision",
        m,
        [
            ego(p, Pace(7), start=8, lamps=[(20, "left"), (27, "off")]),
            Actor("b", p, Pace(6.5), start=-3 + 6 - 2.0, kind="bicycle", size=BICYCLE, begin=3),
            Actor("w", m.way(1, 1), Pace(0), start=80),
        ],
        30,
    )


def _roundabout_hits_car() -> Drive:
    m = Roundabout()
    p = m.way(0, 2)
    q = m.way(3, 2)
    meet = (m.ring[0].start[0], m.ring[0].start[1])
    d, e = (p.near(*meet), q.near(*meet))
    return draw(
        "gb_roundabout_hits_car_i",
        "Runs onto the ring into the side of a car that is there.",
        "fail no-collision",
        m,
        [ego(p, Pace(8), start=d - 80), Actor("c", q, Pace(8), start=e - 80 + 3.0)],
        15,
    )


def _crossing_paths_pet() -> Drive:
    m = Crossroads(arms=NARROW)
    p, q = (m.way("w", "e"), m.way("s", "n"))
    i, j = (p.near(-1.75, 1.75), q.near(-1.75, 1.75))
    return draw(
        "gb_crossing_paths_pet_i",
        "A car crosses 0.6 s behind the ego. It just misses.",
        "fail criticality.pet | pass no-collision",
        m,
        [ego(p, Pace(11), start=i - 88), Actor("c", q, Pace(10), start=j - 80 - 13)],
        14,
    )


DRAWN = (
    _roundabout_wrong_way,
    _roundabout_straight_on,
    _roundabout_hits_car,
    _crossing_paths_pet,
)
