"""Great Britain: motorways."""

from __future__ import annotations

import math

from tests.outsiders.seventh.cast import PERSON
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import Carriageway
from tests.outsiders.seventh.movement import Actor, Pace, ego
from tests.outsiders.seventh.road import Bend, Lane, Line, Road, Section
from tests.outsiders.seventh.ways import through


def _m_stop_for_nothing() -> Drive:
    m = Carriageway()
    return draw(
        "gb_m_stop_for_nothing_i",
        "Stands 12 s in lane 1 of a motorway with nobody near.",
        "fail r240.no-stopping",
        m,
        [ego(m.on(3), Pace(25).stop(250, 3).hold(12).to(20, 2).hold(20), start=50)],
        40,
    )


def _m_stop_for_deer() -> Drive:
    m = Carriageway()
    p = m.on(3)
    return draw(
        "gb_m_stop_for_deer_i",
        "Stops for an animal 8 m ahead. It does not touch it.",
        "not fail r240.no-stopping | pass no-collision",
        m,
        [
            ego(p, Pace(25).stop(200, 5).hold(16).to(20, 2).hold(20), start=50),
            Actor(
                "deer",
                through((261, 30), (261, -2)),
                Pace(0).hold(4).to(3, 2).until(21).to(0, 2).hold(7).to(4, 2).hold(9),
                kind="animal",
                size=(1.3, 0.5, 1.1),
                begin=4,
            ),
        ],
        40,
    )


def _m_reverse_to_exit() -> Drive:
    m = Carriageway(exit_=(500, 700))
    return draw(
        "gb_m_reverse_to_exit_i",
        "Reverses 30 m along the motorway towards a missed exit. Backwards on a motorway: nothing excuses it.",
        "fail r263.no-reverse r143.direction",
        m,
        [
            ego(
                m.on(3),
                Pace(20).stop(300, 3).hold(2).to(-4, 1.5).hold(7).to(0, 2).hold(5),
                start=410,
                lamps=[(0, "left")],
            )
        ],
        36,
    )


def _m_shoulder_undertake() -> Drive:
    m = Carriageway()
    p = m.on(3)
    return draw(
        "gb_m_shoulder_undertake_i",
        "Drives 18 s along the hard shoulder past a queue. At 20 m/s.",
        "fail r269.hard-shoulder | pass r124.speed-limit",
        m,
        [
            ego(p, Pace(20), start=50, side=[(3, 0), (7, 3.4), (25, 3.4), (29, 0)]),
            *(Actor(f"q{i}", p, Pace(5), start=280 + 14 * i) for i in range(3)),
        ],
        32,
    )


def _m_breakdown_shoulder() -> Drive:
    m = Carriageway()
    return draw(
        "gb_m_breakdown_shoulder_i",
        "Hazard lights on, slows and stands on the shoulder. A breakdown, off the lanes, with hazard lights.",
        "not fail r269.hard-shoulder r240.no-stopping",
        m,
        [
            ego(
                m.on(3),
                Pace(25).hold(4).stop(300, 2.6).hold(30),
                start=50,
                side=[(3, 0), (8, 3.4)],
                lamps=[(1, "left"), (6, "hazard")],
            )
        ],
        40,
    )


def _m_lorry_lane3() -> Drive:
    m = Carriageway()
    return draw(
        "gb_m_lorry_lane3_i",
        "A lorry over 7.5 t in the right-hand lane of three.",
        "fail r265.right-lane-ban",
        m,
        [
            ego(
                m.on(2),
                Pace(24),
                start=50,
                kind="truck",
                size=(12, 2.5, 3.9),
                side=[(4, 0), (9, -3.65), (22, -3.65), (27, 0)],
            )
        ],
        34,
        vehicle_class="goods_over_7t5",
    )


def _m_caravan_two_lanes() -> Drive:
    m = Carriageway(lanes=2, entry=(200, 500))
    p = m.on(1)
    return draw(
        "gb_m_caravan_two_lanes_i",
        "Only two lanes are open, the third beside them is a slip road. 25.5 m/s, 57 mph, with a trailer "
        "on a motorway.",
        "not fail r265.right-lane-ban | pass r124.speed-limit",
        m,
        [
            ego(p, Pace(25.5), start=50),
            Actor("caravan", p, Pace(25.5), start=43.5, kind="trailer", size=(6.3, 2.2, 2.6)),
        ],
        24,
        vehicle_class="car_towing",
    )


def _m_83mph() -> Drive:
    m = Carriageway(pieces=[Line(300), Bend(500, 1 / 900), Line(400)])
    return draw(
        "gb_m_83mph_i",
        "37 m/s (83 mph) on a motorway.",
        "fail r124.speed-limit",
        m,
        [ego(m.on(1), Pace(31).hold(3).to(37, 1.0).hold(30), start=50)],
        26,
        hertz=20,
    )


def _m_exit_no_signal() -> Drive:
    m = Carriageway(exit_=(500, 760))
    m.exit_sign("x", 420, "333")
    m.exit_sign("x2", 498, "450")
    return draw(
        "gb_m_exit_no_signal_i",
        "Leaves by the exit and never signals.",
        "fail exit-sign-signal",
        m,
        [ego(m.on(3), Pace(25), start=250, side=[(11.5, 0), (15.5, 3.65)], lamps=[(0, "off")])],
        20,
    )


def _m_exit_signal_good() -> Drive:
    m = Carriageway(exit_=(500, 760))
    m.exit_sign("x", 420, "333")
    return draw(
        "gb_m_exit_signal_good_i",
        "Signals left from 300 m before to the exit lane.",
        "pass exit-sign-signal",
        m,
        [ego(m.on(3), Pace(25), start=150, side=[(15.5, 0), (19.5, 3.65)], lamps=[(1, "left"), (21, "off")])],
        24,
    )


def _m_signals_exit_stays() -> Drive:
    m = Carriageway(exit_=(400, 650))
    m.exit_sign("x", 380, "333")
    return draw(
        "gb_m_signals_exit_stays_i",
        "Signals left all along the exit lane and stays on the motorway.",
        "fail signal-then-leaves",
        m,
        [ego(m.on(3), Pace(25), start=150, lamps=[(5, "left"), (22, "off")])],
        30,
    )


def _m_bridge_walker_above() -> Drive:
    m = Carriageway(length=700)
    section = Section(0, [Lane("driving", 3.5)], [Lane("driving", 3.5)])
    m.roads.append(Road(2, (350, -60, math.pi / 2), [Line(140)], [section], m.kind("rural", 60), z=(6.5, 0, 0)))
    return draw(
        "gb_m_bridge_walker_above_i",
        "The walker is on a bridge 6 m above. Not on the same level.",
        "not fail no-collision criticality.pet",
        m,
        [
            ego(m.on(2), Pace(27), start=80, z=0.75),
            Actor("w", through((350, -20), (350, 40)), Pace(1.5), start=10.5, kind="pedestrian", size=PERSON, z=7.4),
        ],
        18,
    )


def _m_reverse_8ms() -> Drive:
    m = Carriageway()
    return draw(
        "gb_m_reverse_8ms_i",
        "Reverses at 8 m/s for 4 s on a motorway after a normal drive. Backwards on a motorway.",
        "fail r263.no-reverse r143.direction",
        m,
        [ego(m.on(3), Pace(24).hold(22).to(0, 3).hold(2).to(-8, 2.5).hold(3).to(0, 2.5).hold(3), start=50)],
        44,
    )


DRAWN = (
    _m_stop_for_nothing,
    _m_stop_for_deer,
    _m_reverse_to_exit,
    _m_shoulder_undertake,
    _m_breakdown_shoulder,
    _m_lorry_lane3,
    _m_caravan_two_lanes,
    _m_83mph,
    _m_exit_no_signal,
    _m_exit_signal_good,
    _m_signals_exit_stays,
    _m_bridge_walker_above,
    _m_reverse_8ms,
)
