"""Great Britain: speeds, lamps, horns, footways, parking."""

from __future__ import annotations

import math

import numpy as np

from tests.outsiders.seventh.cast import WINDING
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import Carriageway, Street, dual, town
from tests.outsiders.seventh.movement import Actor, Pace, ego
from tests.outsiders.seventh.ways import through


def _towing_56_single() -> Drive:
    m = Street(length=900)
    p = m.way
    return draw(
        "gb_towing_56_single_i",
        "A car with a caravan at 25 m/s (56 mph) on a single carriageway, where 50 holds.",
        "fail r124.speed-limit",
        m,
        [
            ego(p, Pace(25), start=30, size=(4.6, 1.85, 1.6)),
            Actor("caravan", p, Pace(25), start=23.6, kind="trailer", size=(6.2, 2.2, 2.6)),
        ],
        20,
        vehicle_class="car_towing",
    )


def _bus_57_dual() -> Drive:
    m = dual(both=True)
    return draw(
        "gb_bus_57_dual_i",
        "A bus may do 60 mph on a dual carriageway; it does 55.",
        "pass r124.speed-limit",
        m,
        [ego(m.on(2), Pace(24.6), start=30, kind="bus", size=(12, 2.55, 3.2))],
        20,
        carriageway="dual",
    )


def _bus_58_single() -> Drive:
    m = Street(pieces=WINDING)
    return draw(
        "gb_bus_58_single_i",
        "A bus does 26 m/s (58 mph) on a single carriageway, where 50 mph holds for it.",
        "fail r124.speed-limit",
        m,
        [ego(m.way, Pace(26), start=30, kind="bus", size=(12, 2.55, 3.2))],
        25,
        hertz=5,
    )


def _town_38mph_noise() -> Drive:
    m = town()
    return draw(
        "gb_town_38mph_noise_i",
        "17 m/s (38 mph) where 30 mph holds, with 5 cm noise.",
        "fail r124.speed-limit",
        m,
        [ego(m.way, Pace(17), start=30, noise=0.05)],
        20,
    )


def _hazards_moving_town() -> Drive:
    m = town()
    return draw(
        "gb_hazards_moving_town_i",
        "Hazard lights on at 11 m/s in a town street.",
        "fail r116.hazards",
        m,
        [ego(m.way, Pace(11), start=30, lamps=[(4, "hazard"), (12, "off")])],
        20,
    )


def _hazards_motorway_queue() -> Drive:
    m = Carriageway()
    p = m.on(2)
    return draw(
        "gb_hazards_motorway_queue_i",
        "Warns of a queue ahead on a motorway while slowing. It stands in a queue.",
        "not fail r116.hazards r240.no-stopping",
        m,
        [
            ego(p, Pace(28).hold(3).stop(520, 2.2).hold(15), start=50, lamps=[(16, "hazard")]),
            Actor("q1", p, Pace(0), start=581),
            Actor("q2", m.on(3), Pace(0), start=585),
            Actor("q3", m.on(1), Pace(0), start=579),
        ],
        38,
    )


def _pavement_drive() -> Drive:
    m = town()
    return draw(
        "gb_pavement_drive_i",
        "Two wheels on the footway at 11 m/s for 4 s to get past a turning car.",
        "fail r145.off-road",
        m,
        [ego(m.way, Pace(11), start=50, side=[(14, 0), (15.5, 1.9), (19.5, 1.9), (21, 0)])],
        36,
    )


def _pavement_to_drive() -> Drive:
    m = town()
    p = through(
        (40, 1.75),
        (100, 1.75),
        *[(100 + 7 * math.sin(a), 8.75 - 7 * math.cos(a)) for a in np.linspace(0.05, 1.57, 30)],
        (107, 22),
    )
    return draw(
        "gb_pavement_to_drive_i",
        "Over the footway at 2.5 m/s into a drive.",
        "not fail r145.off-road",
        m,
        [ego(p, Pace(9).slow(50, 2.5, 1.5).hold(9).to(0, 1).hold(20), start=5, lamps=[(2, "left")])],
        22,
    )


def _parked_against_flow_night() -> Drive:
    m = town(length=300)
    return draw(
        "gb_parked_against_flow_night_i",
        "Stands over 70 s on the wrong side, facing the traffic. And it is night.",
        "fail r239.parked-with-traffic r248.parked-at-night",
        m,
        [
            ego(
                m.way, Pace(6).hold(14).to(4, 1).until(140).stop(170, 1).hold(90), start=30, side=[(16, 0), (26, -3.6)]
            ),
            Actor("other", m.way, Pace(8), start=5, begin=60),
        ],
        118,
        hertz=2,
        light="night",
    )


def _parked_with_flow_night() -> Drive:
    m = town(length=300)
    return draw(
        "gb_parked_with_flow_night_i",
        "Faces the way its lane is driven. Likewise at night.",
        "pass r239.parked-with-traffic r248.parked-at-night",
        m,
        [ego(m.way, Pace(4).stop(30, 1).hold(90), start=80, side=[(0, 0.6)])],
        92,
        hertz=2,
        light="night",
    )


def _night_no_headlights() -> Drive:
    m = Street(pieces=WINDING)
    return draw(
        "gb_night_no_headlights_i",
        "Headlights off at night at 24 m/s on a rural road of 60 mph.",
        "fail r113.headlights",
        m,
        [ego(m.way, Pace(24), start=50)],
        25,
        events=[(0, "headlights", "on"), (8, "headlights", "off"), (16, "headlights", "on")],
        light="night",
    )


def _night_town_lamps() -> Drive:
    m = town()
    return draw(
        "gb_night_town_lamps_i",
        "In a street of 30 mph lamps may excuse. But headlights should be on there.",
        "pass r113.headlights | fail r115.dipped-headlights",
        m,
        [ego(m.way, Pace(11), start=50)],
        20,
        events=[(0, "headlights", "off")],
        light="night",
    )


def _horn_standing() -> Drive:
    m = town()
    return draw(
        "gb_horn_standing_i",
        "Sounds its horn while standing, nobody within 100 m.",
        "fail r112.horn",
        m,
        [ego(m.way, Pace(8).stop(40, 2).hold(20), start=50)],
        24,
        events=[(0, "horn", "off"), (12, "horn", "on"), (14, "horn", "off")],
    )


DRAWN = (
    _towing_56_single,
    _bus_57_dual,
    _bus_58_single,
    _town_38mph_noise,
    _hazards_moving_town,
    _hazards_motorway_queue,
    _pavement_drive,
    _pavement_to_drive,
    _parked_against_flow_night,
    _parked_with_flow_night,
    _night_no_headlights,
    _night_town_lamps,
    _horn_standing,
)
