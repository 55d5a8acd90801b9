"""Great Britain: stop signs and turns."""

from __future__ import annotations

from tests.outsiders.seventh.cast import BICYCLE, PERSON, STAGGERED
from tests.outsiders.seventh.crossroads import Crossroads
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.movement import Actor, Pace, ego
from tests.outsiders.seventh.ways import arc, through


def _stop_sign_rolled() -> Drive:
    m = Crossroads(arms={"e": 0, "w": 180, "s": 270})
    m.stop("s")
    return draw(
        "gb_stop_sign_rolled_i",
        "Rolls over the line at 3 m/s.",
        "fail r171.stop-sign",
        m,
        [
            ego(
                m.way("s", "w"),
                Pace(9).slow(76, 3, 2).hold(5).to(8, 1.5).hold(10),
                start=40,
                lamps=[(2, "left"), (18, "off")],
            )
        ],
        24,
    )


def _stop_sign_staggered_halt() -> Drive:
    m = Crossroads(arms=STAGGERED)
    m.stop("s")
    return draw(
        "gb_stop_sign_staggered_halt_i",
        "Halts for 3 s some 0.6 m before the line of a staggered junction.",
        "pass r171.stop-sign",
        m,
        [
            ego(
                m.way("s", "w"),
                Pace(9).stop(119.4 - 2.25 - 0.75 - 40, 2).hold(3).to(6, 1.5).hold(20),
                start=40,
                lamps=[(2, "left"), (22, "off")],
            )
        ],
        32,
    )


def _stop_sign_behind_other() -> Drive:
    m = Crossroads(arms={"e": 0, "w": 180, "s": 270})
    m.stop("s")
    p = m.way("s", "w")
    return draw(
        "gb_stop_sign_behind_other_i",
        "Halts 14 m back behind another and then follows it over the line at 5 m/s without a halt of its own.",
        "fail r171.stop-sign",
        m,
        [
            ego(p, Pace(8).stop(60, 2).hold(3).to(5, 1.2).hold(20), start=40, lamps=[(2, "left")]),
            Actor("first", p, Pace(0).hold(9).to(7, 1.5).hold(20), start=116),
        ],
        26,
    )


def _right_turn_before_oncoming() -> Drive:
    m = Crossroads()
    p = m.way("w", "s")
    return draw(
        "gb_right_turn_before_oncoming_i",
        "Turns right across a car that is 25 m off at 13 m/s and has to brake hard.",
        "fail r180.right-turn-gap",
        m,
        [
            ego(p, Pace(9).slow(70, 6, 2).hold(30), start=40, lamps=[(1, "right"), (14, "off")]),
            Actor("onc", m.way("e", "w"), Pace(13).hold(8.2).to(4, 6).hold(3).to(9, 2).hold(9), start=0.5),
        ],
        22,
    )


def _right_turn_motorbike_no_brake() -> Drive:
    m = Crossroads(lengths={"e": 260})
    p = m.way("w", "s")
    q = m.way("e", "w")
    return draw(
        "gb_right_turn_motorbike_no_brake_i",
        "A motorcycle at 16 m/s comes through a second after the ego has gone.",
        "fail r180.right-turn-gap",
        m,
        [
            ego(p, Pace(7), start=50, lamps=[(1, "right"), (14, "off")]),
            Actor("mc", q, Pace(16), start=260 + 8 - 16 * 13.2, kind="motorcycle", size=(2.2, 0.8, 1.5)),
        ],
        24,
    )


def _right_turn_waits() -> Drive:
    m = Crossroads()
    p = m.way("w", "s")
    return draw(
        "gb_right_turn_waits_i",
        "Waits in the middle until the oncoming car has passed. Turns into its own side.",
        "not fail r180.right-turn-gap | pass r180.corner-cut",
        m,
        [
            ego(p, Pace(8).stop(83, 2).hold(4).to(5, 1.5).hold(30), start=40, lamps=[(1, "right"), (24, "off")]),
            Actor("onc", m.way("e", "w"), Pace(12), start=10),
        ],
        34,
    )


def _corner_cut() -> Drive:
    m = Crossroads()
    p = through(
        (-100, 1.75),
        (-16.5, 1.75),
        *arc((-16.5, -14.55), 16.3, 1.57),
        (-0.2, -16),
        (-0.2, -36),
        (1.75, -60),
        (1.75, -125),
    )
    return draw(
        "gb_corner_cut_i",
        "Cuts the corner and enters the side road wholly on its wrong side.",
        "fail r180.corner-cut",
        m,
        [ego(p, Pace(7), start=5, lamps=[(4, "right"), (20, "off")])],
        27,
    )


def _left_turn_past_cyclist() -> Drive:
    m = Crossroads()
    p = m.way("w", "n")
    return draw(
        "gb_left_turn_past_cyclist_i",
        "Gets past a cyclist two seconds before it turns left. And turns left right before it: the "
        "cyclist has to brake hard.",
        "fail r182.no-pass-before-turn h3.no-cut-across",
        m,
        [
            ego(
                p,
                Pace(10).slow(75, 6, 2).hold(20),
                start=40,
                side=[(0, -0.9), (7.2, -0.9), (8.6, 0)],
                lamps=[(4, "left"), (14, "off")],
            ),
            Actor(
                "b",
                m.way("w", "e"),
                Pace(6).hold(8).to(0.3, 4).hold(4).to(5, 1).hold(9),
                start=62,
                side=[(0, 1.2)],
                kind="bicycle",
                size=BICYCLE,
            ),
        ],
        22,
    )


def _left_turn_behind_cyclist() -> Drive:
    m = Crossroads()
    p = m.way("w", "n")
    return draw(
        "gb_left_turn_behind_cyclist_i",
        "Stays behind the cyclist and turns after it. The cyclist has gone ahead long before.",
        "pass r182.no-pass-before-turn | not fail h3.no-cut-across",
        m,
        [
            ego(p, Pace(8).slow(45, 4, 1.5).hold(30), start=40, lamps=[(4, "left"), (26, "off")]),
            Actor("b", m.way("w", "e"), Pace(5), start=80, side=[(0, 1.1)], kind="bicycle", size=BICYCLE),
        ],
        32,
    )


def _turn_into_walker() -> Drive:
    m = Crossroads(footway=True)
    p = m.way("w", "n")
    return draw(
        "gb_turn_into_walker_i",
        "Turns left one second before somebody who is crossing the side road.",
        "fail h2.turn-pedestrian",
        m,
        [
            ego(p, Pace(8).slow(72, 5, 1.5).hold(30), start=40, lamps=[(4, "left"), (17, "off")]),
            Actor(
                "p", through((6, 16), (-7, 16)), Pace(0).hold(11.6).to(1.5, 2).hold(8), kind="pedestrian", size=PERSON
            ),
        ],
        24,
    )


def _turn_waits_for_walker() -> Drive:
    m = Crossroads(footway=True)
    p = m.way("w", "n")
    return draw(
        "gb_turn_waits_for_walker_i",
        "Waits in the mouth until the walker is over. It keeps 3 m away.",
        "not fail h2.turn-pedestrian | pass no-collision",
        m,
        [
            ego(p, Pace(8).stop(84, 2).hold(8).to(4, 1.5).hold(30), start=40, lamps=[(4, "left"), (26, "off")]),
            Actor(
                "p",
                through((7, 17), (-8, 17)),
                Pace(0).hold(9).to(1.5, 2).hold(30),
                kind="pedestrian",
                size=PERSON,
                end=19,
            ),
        ],
        34,
    )


def _left_turn_wide() -> Drive:
    m = Crossroads(width=5.0, edge=14)
    p = m.way("w", "n")
    return draw(
        "gb_left_turn_wide_i",
        "Turns left and runs on 2.9 m from the near edge of a 5 m lane with nobody there.",
        "fail r183.keep-in",
        m,
        [
            ego(
                p,
                Pace(8).slow(75, 6, 2).hold(20),
                start=40,
                side=[(9, 0), (11, -1.2), (15, -1.2), (19, 0)],
                lamps=[(4, "left"), (15, "off")],
            )
        ],
        24,
    )


DRAWN = (
    _stop_sign_rolled,
    _stop_sign_staggered_halt,
    _stop_sign_behind_other,
    _right_turn_before_oncoming,
    _right_turn_motorbike_no_brake,
    _right_turn_waits,
    _corner_cut,
    _left_turn_past_cyclist,
    _left_turn_behind_cyclist,
    _turn_into_walker,
    _turn_waits_for_walker,
    _left_turn_wide,
)
