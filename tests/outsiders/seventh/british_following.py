"""Great Britain: distances."""

from __future__ import annotations

from tests.outsiders.seventh.cast import LORRY, WINDING
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import Street, dual, town
from tests.outsiders.seventh.movement import Actor, Pace, ego
from tests.outsiders.seventh.ways import through


def _tailgate_trailer() -> Drive:
    m = Street(pieces=WINDING)
    p = m.way
    return draw(
        "gb_tailgate_trailer_i",
        "5 m behind a lorry's trailer at 22 m/s. 0.25 s headway.",
        "fail r126.thinking-gap criticality.thw",
        m,
        [
            ego(p, Pace(21), start=80),
            Actor("tractor", p, Pace(21), start=104, kind="truck", size=(6, 2.5, 3.8)),
            Actor("trailer", p, Pace(21), start=93.5, kind="trailer", size=(12.5, 2.5, 3.9)),
        ],
        22,
    )


def _tailgate_null_lead() -> Drive:
    m = Street(length=900)
    p = m.way
    return draw(
        "gb_tailgate_null_lead_i",
        "6 m behind a vehicle of unknown class at 20 m/s.",
        "fail r126.thinking-gap",
        m,
        [ego(p, Pace(20), start=80), Actor("x", p, Pace(20), start=90.5, kind=None)],
        20,
    )


def _tailgate_sizeless_lead() -> Drive:
    m = Street(length=900)
    p = m.way
    return draw(
        "gb_tailgate_sizeless_lead_i",
        "Centres 7 m apart at 20 m/s; the leader's size is missing. Much less than 0.9 s, whatever its length.",
        "not pass r126.thinking-gap criticality.thw",
        m,
        [ego(p, Pace(20), start=80), Actor("x", p, Pace(20), start=87.5, kind="van", size=None)],
        20,
    )


def _tailgate_after_bend_flipped() -> Drive:
    m = Street(pieces=WINDING)
    p = m.way
    return draw(
        "gb_tailgate_after_bend_flipped_i",
        "5 m behind a car at 20 m/s, whose heading is written wrong by pi.",
        "not pass r126.thinking-gap",
        m,
        [ego(p, Pace(20), start=80), Actor("x", p, Pace(20), start=89.5, flipped=True)],
        24,
    )


def _cut_in_not_dropping_back() -> Drive:
    m = dual()
    return draw(
        "gb_cut_in_not_dropping_back_i",
        "A van pulls in 15 m ahead at 22 m/s; the ego stays at 0.7 s for 20 s.",
        "fail r168.drop-back",
        m,
        [
            ego(m.on(2), Pace(22), start=50),
            Actor(
                "van",
                m.on(2),
                Pace(24).hold(8.5).to(22, 1).hold(30),
                start=53,
                side=[(0, -3.65), (5.5, -3.65), (8.5, 0)],
                kind="van",
                size=(5.5, 2, 2.5),
                lamps=[(5, "left"), (9, "off")],
            ),
        ],
        32,
    )


def _cut_in_drops_back() -> Drive:
    m = dual()
    return draw(
        "gb_cut_in_drops_back_i",
        "Lets off and has over two seconds again within 7 s.",
        "pass r168.drop-back",
        m,
        [
            ego(m.on(2), Pace(22).hold(7).to(17.5, 1.5).hold(4).to(22, 1.0).hold(20), start=50),
            Actor(
                "van",
                m.on(2),
                Pace(26),
                start=45,
                side=[(0, -3.65), (5, -3.65), (8, 0)],
                kind="van",
                size=(5.5, 2, 2.5),
            ),
        ],
        28,
    )


def _box_missed_contact() -> Drive:
    m = town()
    p = m.way
    return draw(
        "gb_box_missed_contact_i",
        "The boxes stay 0.4 m apart, but the ego loses 7 m/s within 0.1 s while the other is knocked forwards.",
        "fail contact-signature",
        m,
        [
            ego(p, Pace(12).until(80).to(5, 70).to(0, 6).hold(20), start=100, smooth=0.0),
            Actor("v", p, Pace(0).hold(80 / 12).to(5, 70).to(0, 5).hold(20), start=185.5, smooth=0.0),
        ],
        14,
    )


def _hit_between_steps_2hz() -> Drive:
    m = town()
    return draw(
        "gb_hit_between_steps_2hz_i",
        "At 2 Hz a child runs through the ego's way; the boxes meet between two samples.",
        "fail no-collision",
        m,
        [
            ego(m.way, Pace(13), start=101),
            Actor(
                "c",
                through((200, 12), (200, -12)),
                Pace(3.5),
                start=12 - 3.1 - 3.5 * 7.5,
                kind="pedestrian",
                size=(0.4, 0.4, 1.2),
            ),
        ],
        14,
        hertz=2,
    )


def _ghost_teleports_through() -> Drive:
    m = dual()
    return draw(
        "gb_ghost_teleports_through_i",
        "A car's track jumps 5 m sideways onto the ego's place for 0.4 s and back.",
        "not pass no-collision",
        m,
        [ego(m.on(2), Pace(24), start=80), Actor("g", m.on(1), Pace(24), start=81, jump=(6, 6.4, 0, 3.65))],
        14,
    )


def _frozen_lead() -> Drive:
    m = Street(length=900)
    p = m.way
    return draw(
        "gb_frozen_lead_i",
        "The track of the car ahead freezes at speed 18 m/s and the ego drives up to it and through it. "
        "The boxes overlap.",
        "not pass criticality.ttc no-collision",
        m,
        [ego(p, Pace(18), start=80), Actor("f", p, Pace(18), start=120, freeze=6)],
        14,
    )


def _two_lorries_abreast_squeeze() -> Drive:
    m = dual()
    return draw(
        "gb_two_lorries_abreast_squeeze_i",
        "Drifts 1.7 m over into a lorry beside it. Astride for about 3 s only.",
        "fail no-collision | not fail r131.keep-in-lane",
        m,
        [
            ego(m.on(2), Pace(22), start=80, side=[(5, 0), (7, -1.7), (8.5, -1.7), (10, 0)]),
            Actor("l", m.on(1), Pace(22), start=82, kind="truck", size=(14, 2.5, 3.9)),
        ],
        16,
    )


def _tailgate_noise_25hz() -> Drive:
    m = dual()
    p = m.on(2)
    return draw(
        "gb_tailgate_noise_25hz_i",
        "5 m behind a van at 22 m/s with 5 cm of noise on both tracks at 25 Hz.",
        "fail r126.thinking-gap",
        m,
        [
            ego(p, Pace(22), start=60, noise=0.05),
            Actor("v", p, Pace(22), start=70, kind="van", size=(5.5, 2, 2.4), noise=0.05),
        ],
        15,
        hertz=25,
    )


def _lead_vanishes_in_tailgate() -> Drive:
    m = Street(pieces=WINDING)
    p = m.way
    return draw(
        "gb_lead_vanishes_in_tailgate_i",
        "4 m behind a car at 19 m/s for 8 s, whose track ends then. It is never touched.",
        "fail r126.thinking-gap | not fail no-collision",
        m,
        [ego(p, Pace(19), start=60), Actor("v", p, Pace(19), start=68.5, begin=2, end=10)],
        20,
        hertz=20,
    )


def _queue_lorry_brakes_hard_good() -> Drive:
    m = Street(length=900)
    p = m.way
    return draw(
        "gb_queue_lorry_brakes_hard_good_i",
        "It stops 5 m behind. The gap is 50 m at 22 m/s and never too short for the speed. Never under 1.5 s.",
        "pass no-collision r126.thinking-gap criticality.ttc",
        m,
        [
            ego(p, Pace(22).hold(5.8).to(0, 4.5).hold(20), start=60),
            Actor("l", p, Pace(22).hold(5).to(0, 5.5).hold(20), start=60 + 2.25 + 45 + 5, kind="truck", size=LORRY),
        ],
        20,
    )


DRAWN = (
    _tailgate_trailer,
    _tailgate_null_lead,
    _tailgate_sizeless_lead,
    _tailgate_after_bend_flipped,
    _cut_in_not_dropping_back,
    _cut_in_drops_back,
    _box_missed_contact,
    _hit_between_steps_2hz,
    _ghost_teleports_through,
    _frozen_lead,
    _two_lorries_abreast_squeeze,
    _tailgate_noise_25hz,
    _lead_vanishes_in_tailgate,
    _queue_lorry_brakes_hard_good,
)
