"""Germany: stopping, braking, passing and reversing on motorways."""

from __future__ import annotations

from tests.outsiders.seventh.cast import LORRY
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import autobahn
from tests.outsiders.seventh.movement import Actor, Pace, ego
from tests.outsiders.seventh.ways import through


def _bab_brake_test() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_brake_test_i",
        "Brakes with 5 m/s2 on a free motorway. Nobody is ahead.",
        "fail stvo.rg2 | not fail criticality.ttc",
        m,
        [
            ego(m.on(2), Pace(32).hold(6).to(17, 5).hold(3).to(30, 1.2).hold(9), start=150),
            Actor("behind", m.on(2), Pace(32).hold(6.8).to(16, 5.5).hold(3).to(30, 1.2).hold(9), start=95),
        ],
        22,
    )


def _bab_brakes_for_dog() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_brakes_for_dog_i",
        "A dog stands in the lane. It stops for the dog.",
        "not fail stvo.rg2 stvo.ri1",
        m,
        [
            ego(m.on(3), Pace(28).stop(200, 5.5).hold(10), start=100, lamps=[(4, "hazard")]),
            Actor(
                "dog",
                through((311, -30), (311, -9.0)),
                Pace(2).until(21).to(0, 4),
                start=0,
                kind="animal",
                size=(0.9, 0.35, 0.7),
            ),
        ],
        22,
    )


def _bab_stops() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_stops_i",
        "Stops in the right lane of a free motorway, no hazard lights.",
        "fail stvo.ri1",
        m,
        [ego(m.on(3), Pace(25).stop(250, 3).hold(14), start=80)],
        30,
    )


def _bab_queue() -> Drive:
    m = autobahn()
    p = m.on(3)
    return draw(
        "de_bab_queue_i",
        "Comes to stand 4 m behind a standing queue. It brakes with 1.8 m/s2 for a standing vehicle.",
        "pass stvo.ri1 | not fail stvo.rg2",
        m,
        [
            ego(p, Pace(25).stop(300, 1.8).hold(14), start=80),
            Actor("q", p, Pace(0), start=391.3, kind="truck", size=LORRY),
            Actor("q2", m.on(2), Pace(0), start=385),
        ],
        34,
    )


def _bab_passes_right() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_passes_right_i",
        "Gets past a car of 27 m/s in the lane to its left at 34 m/s.",
        "fail stvo.ri2",
        m,
        [ego(m.on(3), Pace(34), start=50), Actor("m", m.on(2), Pace(27), start=110)],
        22,
        hertz=25,
    )


def _bab_queue_left_slow() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_queue_left_slow_i",
        "Passes a queue of four at 8 m/s with 11 m/s.",
        "pass stvo.ri2",
        m,
        [ego(m.on(3), Pace(11), start=50)]
        + [Actor(f"q{i}", m.on(2), Pace(8), start=60 + 13 * i) for i in range(4)]
        + [Actor(f"r{i}", m.on(1), Pace(8), start=64 + 12 * i) for i in range(4)],
        32,
    )


def _bab_queue_left_too_fast() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_queue_left_too_fast_i",
        "Passes a queue of 8 m/s with 19 m/s.",
        "fail stvo.ri2",
        m,
        [ego(m.on(3), Pace(19), start=50)]
        + [Actor(f"q{i}", m.on(2), Pace(8), start=90 + 13 * i) for i in range(4)]
        + [Actor(f"r{i}", m.on(1), Pace(8), start=94 + 12 * i) for i in range(4)],
        24,
    )


def _bab_ghost_driver() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_ghost_driver_i",
        "Drives against the traffic at 25 m/s. Against its lane's direction.",
        "fail stvo.ri3 r143.direction",
        m,
        [ego(m.against(1), Pace(25), start=50), Actor("a", m.on(3), Pace(28), start=100)],
        25,
    )


def _bab_reverses() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_reverses_i",
        "Reverses with 3 m/s for 8 s. Backwards on a motorway.",
        "fail stvo.ri3 r263.no-reverse",
        m,
        [ego(m.on(3), Pace(0).hold(3).to(-3, 1.5).hold(8).to(0, 2).hold(4), start=600)],
        20,
    )


def _bab_reverse_6ms() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_reverse_6ms_i",
        "Reverses at 6.5 m/s for 4 s on a motorway.",
        "fail stvo.ri3",
        m,
        [ego(m.on(3), Pace(26).hold(20).to(0, 3).hold(2).to(-6.5, 2.5).hold(3).to(0, 2.5).hold(3), start=50)],
        42,
    )


DRAWN = (
    _bab_brake_test,
    _bab_brakes_for_dog,
    _bab_stops,
    _bab_queue,
    _bab_passes_right,
    _bab_queue_left_slow,
    _bab_queue_left_too_fast,
    _bab_ghost_driver,
    _bab_reverses,
    _bab_reverse_6ms,
)
