"""Great Britain: overtaking."""

from __future__ import annotations

from tests.outsiders.seventh.cast import LORRY, WINDING, coming
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import Street, dual, town
from tests.outsiders.seventh.movement import Actor, Pace, ego


def _bend_overtake_blind() -> Drive:
    m = Street(pieces=WINDING)
    p = m.way
    return draw(
        "gb_bend_overtake_blind_i",
        "Pulls out on a bend with an oncoming car 150 m away at 24 m/s; the overtake needs far more. Head "
        "on in one lane some 40 m apart at 20 and 24 m/s: neither could stop. No room at all to spare.",
        "fail r162.safe-distance-ahead rss.opposite overtake-zone",
        m,
        [
            ego(
                p,
                Pace(16).hold(4).to(23, 2.5).hold(20),
                start=200,
                side=[(4, 0), (6.5, -3.5), (10, -3.5), (12, 0)],
                lamps=[(3, "right"), (6, "off"), (9.5, "left"), (12, "off")],
            ),
            Actor("slow", p, Pace(13), start=235),
            coming(m, "onc", Pace(24).hold(5).to(12, 6).hold(9), 545),
        ],
        16,
    )


def _straight_overtake_ample() -> Drive:
    m = Street(length=2200)
    p = m.way
    return draw(
        "gb_straight_overtake_ample_i",
        "The oncoming car is over 1200 m away when the ego pulls out. The opposing lane is used for a "
        "quick overtake only. Nobody is near.",
        "pass r162.safe-distance-ahead no-collision | not fail r143.direction",
        m,
        [
            ego(
                p,
                Pace(14).hold(2).to(23, 2).hold(30),
                start=100,
                side=[(3, 0), (6, -3.5), (11, -3.5), (14, 0)],
                lamps=[(0.5, "right"), (6, "off"), (10.5, "left"), (14, "off")],
            ),
            Actor("tractor", p, Pace(10), start=165, kind="vehicle", size=(5, 2.2, 3)),
            coming(m, "onc", 20, 1500),
        ],
        22,
    )


def _speeds_up_when_overtaken() -> Drive:
    m = Street(length=1500)
    p = m.way
    return draw(
        "gb_speeds_up_when_overtaken_i",
        "Accelerates from 15 to 22 m/s while a car is beside it in the opposing lane.",
        "fail r168.when-overtaken",
        m,
        [
            ego(p, Pace(15).hold(6).to(22, 1.2).hold(20), start=100),
            Actor(
                "o",
                p,
                Pace(20).hold(5).to(25, 1).hold(20),
                start=65,
                side=[(1, 0), (3.5, -3.5), (15, -3.5), (18, 0)],
                lamps=[(0, "right"), (14, "left"), (18, "off")],
            ),
        ],
        24,
    )


def _parked_car_oncoming_near() -> Drive:
    m = town()
    p = m.way
    return draw(
        "gb_parked_car_oncoming_near_i",
        "Goes round a parked van into the path of an oncoming car, which has to brake hard.",
        "fail r163.obstruction-give-way",
        m,
        [
            ego(
                p,
                Pace(10),
                start=100,
                side=[(4, 0), (6.5, -2.6), (9.5, -2.6), (11.5, 0)],
                lamps=[(3, "right"), (8, "left"), (12, "off")],
            ),
            Actor("parked", p, Pace(0), start=178, side=[(0, 0.6)], kind="van", size=(5.2, 2, 2.3)),
            coming(m, "onc", Pace(11).hold(5).to(1.5, 5).hold(3).to(9, 2).hold(9), 290),
        ],
        18,
    )


def _parked_car_nobody_coming() -> Drive:
    m = town(length=600)
    p = m.way
    return draw(
        "gb_parked_car_nobody_coming_i",
        "Round a parked van with the oncoming car 250 m away. The lane is closed by a parked van.",
        "not fail r163.obstruction-give-way | pass r143.direction",
        m,
        [
            ego(p, Pace(10), start=100, side=[(4, 0), (6.5, -2.9), (9.5, -2.9), (11.5, 0)]),
            Actor("parked", p, Pace(0), start=178, side=[(0, 0.6)], kind="van", size=(5.2, 2, 2.3)),
            coming(m, "onc", Pace(9), 440),
        ],
        18,
    )


def _pulls_out_before_faster() -> Drive:
    m = dual()
    p = m.on(2)
    return draw(
        "gb_pulls_out_before_faster_i",
        "Pulls out with a car 20 m behind in the passing lane, 10 m/s faster: 2 s.",
        "fail r162.not-being-overtaken",
        m,
        [
            ego(p, Pace(20), start=150, side=[(5, 0), (8, -3.65), (16, -3.65), (20, 0)]),
            Actor("slow", p, Pace(15), start=230),
            Actor("fast", m.on(1), Pace(31).hold(5.2).to(19.5, 5).hold(20), start=65),
        ],
        24,
    )


def _no_gap_to_return() -> Drive:
    m = Street(length=2000)
    p = m.way
    return draw(
        "gb_no_gap_to_return_i",
        "It squeezes in between two lorries that are 9 m apart: no thinking distance before or behind. "
        "Pulls out 9 m behind at 17 m/s.",
        "fail r162.return-gap r163.pull-out-separation",
        m,
        [
            ego(
                p,
                Pace(17).hold(4).to(22, 2).hold(2.91).to(17, 2.5).hold(20),
                start=100,
                side=[(4, 0), (6.5, -3.5), (10.9, -3.5), (13.5, 0)],
            ),
            Actor("l1", p, Pace(17), start=116.3, kind="truck", size=LORRY),
            Actor("l2", p, Pace(17), start=135.3, kind="truck", size=LORRY),
        ],
        26,
    )


def _no_overtaking_sign() -> Drive:
    m = Street(length=1500)
    m.road.sign("n1", 150, 4.5, "632", "no_overtaking", "gb", lane=1)
    p = m.way
    return draw(
        "gb_no_overtaking_sign_i",
        "Pulls out 120 m after a no-overtaking sign past a car at 12 m/s.",
        "fail r165.no-overtaking-sign",
        m,
        [
            ego(p, Pace(16).hold(6).to(23, 2).hold(30), start=120, side=[(8, 0), (10.5, -3.5), (15, -3.5), (18, 0)]),
            Actor("v", p, Pace(12), start=220),
        ],
        24,
    )


def _overtaking_after_sign_end() -> Drive:
    m = Street(length=1800)
    m.road.sign("n1", 130, 4.5, "632", "no_overtaking", "gb", lane=1)
    m.road.sign("n2", 190, 4.5, "280", "overtaking_end", lane=1)
    p = m.way
    return draw(
        "gb_overtaking_after_sign_end_i",
        "The ban is cancelled 100 m before it pulls out.",
        "pass r165.no-overtaking-sign",
        m,
        [
            ego(p, Pace(16).hold(6).to(23, 2).hold(30), start=100, side=[(10, 0), (12.5, -3.5), (19, -3.5), (22, 0)]),
            Actor("v", p, Pace(12), start=220),
        ],
        30,
    )


def _overtake_oncoming_appears_late() -> Drive:
    m = Street(length=1200)
    p = m.way
    return draw(
        "gb_overtake_oncoming_appears_late_i",
        "The oncoming car is first seen 90 m off, when the ego is already out. Then both are far too near to stop.",
        "not pass r162.safe-distance-ahead | fail rss.opposite",
        m,
        [
            ego(p, Pace(16).hold(3).to(23, 2).hold(30), start=100, side=[(3, 0), (5.5, -3.5), (9.4, -3.5), (11, 0)]),
            Actor("v", p, Pace(13), start=132),
            coming(m, "onc", Pace(24), 264 + 92 + 24 * 8 - 24 * 0.5, begin=8),
        ],
        16,
    )


DRAWN = (
    _bend_overtake_blind,
    _straight_overtake_ample,
    _speeds_up_when_overtaken,
    _parked_car_oncoming_near,
    _parked_car_nobody_coming,
    _pulls_out_before_faster,
    _no_gap_to_return,
    _no_overtaking_sign,
    _overtaking_after_sign_end,
    _overtake_oncoming_appears_late,
)
