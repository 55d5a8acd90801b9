"""Great Britain: signalled crossings, and waiting at and overtaking before crossings."""

from __future__ import annotations

from tests.outsiders.seventh.cast import walker
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import city, town
from tests.outsiders.seventh.movement import Actor, Pace, ego


def _pelican_red() -> Drive:
    m = town()
    m.pelican(230)
    return draw(
        "gb_pelican_red_i",
        "Over a signalled crossing on red, nobody about. Over the stop line on red.",
        "fail r196.pelican r175.red",
        m,
        [ego(m.way, Pace(11), start=120)],
        18,
        lights={"P1": [(0, "green"), (4, "amber"), (7, "red")]},
    )


def _pelican_flashing_person() -> Drive:
    m = town()
    m.pelican(230)
    return draw(
        "gb_pelican_flashing_person_i",
        "Amber flashes and a walker is still on the ego's half.",
        "fail r196.pelican",
        m,
        [ego(m.way, Pace(5), start=180), walker("p", 230, 5.2, -6, wait=7.4)],
        18,
        lights={"P1": [(0, "red"), (5, "flashing"), (14, "green")]},
    )


def _pelican_flashing_clear() -> Drive:
    m = town()
    m.pelican(230)
    return draw(
        "gb_pelican_flashing_clear_i",
        "Amber flashes, nobody on or near the crossing.",
        "pass r196.pelican",
        m,
        [ego(m.way, Pace(5), start=180)],
        18,
        lights={"P1": [(0, "red"), (5, "flashing"), (14, "green")]},
    )


def _crossing_green_still_crossing() -> Drive:
    m = town()
    m.pelican(230)
    return draw(
        "gb_crossing_green_still_crossing_i",
        "Green, but an old man is still on the ego's half. The light is green.",
        "fail r198.still-crossing | pass r175.red",
        m,
        [ego(m.way, Pace(0).hold(6).to(6, 2).hold(20), start=222), walker("old", 230, -5.5, 6, speed=0.9, wait=0.1)],
        16,
        lights={"P1": [(0, "red"), (5, "green")]},
    )


def _zebra_overtake_lane2() -> Drive:
    m = city()
    m.road.area("crosswalk", "zebra", 250, 3.4, 3.0, 6.8, outline=True)
    return draw(
        "gb_zebra_overtake_lane2_i",
        "Gets past the moving car nearest the zebra within 15 m of it.",
        "fail r191.crossing-overtake",
        m,
        [ego(m.on(1), Pace(12), start=150), Actor("near", m.on(2), Pace(7), start=186.5)],
        15,
    )


def _zebra_past_stopped_car() -> Drive:
    m = city()
    m.road.area("crosswalk", "zebra", 250, 3.4, 3.0, 6.8, outline=True)
    return draw(
        "gb_zebra_past_stopped_car_i",
        "Passes a car that has stopped at the zebra to let a walker go. The walker is on the zebra, whose "
        "halves have no island, in front of the ego's lane.",
        "fail r191.crossing-overtake r195.zebra-on",
        m,
        [
            ego(m.on(1), Pace(9), start=165),
            Actor("kind", m.on(2), Pace(8).stop(44, 2.5).hold(20), start=200),
            walker("p", 250, 8.5, -2, wait=4.2, speed=1.3),
        ],
        15,
    )


def _zebra_past_parked_car() -> Drive:
    m = city()
    m.road.area("crosswalk", "zebra", 250, 3.4, 3.0, 6.8, outline=True)
    return draw(
        "gb_zebra_past_parked_car_i",
        "The car before the zebra is parked all the time.",
        "not fail r191.crossing-overtake",
        m,
        [ego(m.on(1), Pace(8), start=165), Actor("parked", m.on(2), Pace(0), start=236)],
        18,
    )


def _stands_on_zebra() -> Drive:
    m = town(zebra=230)
    return draw(
        "gb_stands_on_zebra_i",
        "Stands on the zebra for 12 s of its own accord.",
        "fail r191.no-stopping",
        m,
        [ego(m.way, Pace(9).stop(100, 2).hold(12).to(8, 1.5).hold(20), start=130, lamps=[(8, "hazard"), (24, "off")])],
        36,
    )


def _queue_on_zebra() -> Drive:
    m = town(zebra=230)
    p = m.way
    return draw(
        "gb_queue_on_zebra_i",
        "Stands on the zebra for 10 s, 2.5 m behind a standing car. It stands in a queue.",
        "fail r192.keep-clear | not fail r191.no-stopping",
        m,
        [
            ego(p, Pace(8).stop(100, 2).hold(10).to(7, 1.5).hold(20), start=130),
            Actor("a", p, Pace(0).hold(24).to(9, 1.5).hold(20), start=237),
        ],
        36,
    )


def _queue_left_clear() -> Drive:
    m = town(zebra=230)
    p = m.way
    return draw(
        "gb_queue_left_clear_i",
        "It waits before the zebra until the queue has moved on.",
        "pass r192.keep-clear",
        m,
        [
            ego(p, Pace(8).stop(95, 2).hold(12).to(7, 1.5).hold(20), start=130),
            Actor("a", p, Pace(0).hold(20).to(10, 2).hold(20), start=237),
        ],
        40,
    )


DRAWN = (
    _pelican_red,
    _pelican_flashing_person,
    _pelican_flashing_clear,
    _crossing_green_still_crossing,
    _zebra_overtake_lane2,
    _zebra_past_stopped_car,
    _zebra_past_parked_car,
    _stands_on_zebra,
    _queue_on_zebra,
    _queue_left_clear,
)
