"""Great Britain: horses and cyclists."""

from __future__ import annotations

from tests.outsiders.seventh.cast import BICYCLE, HORSE, coming
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import Street
from tests.outsiders.seventh.movement import Actor, Pace, ego
from tests.outsiders.seventh.roundabout import Roundabout


def _horse_fast() -> Drive:
    m = Street(length=600, width=3.2)
    p = m.way
    return draw(
        "gb_horse_fast_i",
        "Passes a horse at 10 m/s, 0.75 m away.",
        "fail r215.horse",
        m,
        [
            ego(p, Pace(10), start=30, side=[(3, 0), (5, -1.1), (16, -1.1), (18, 0)]),
            Actor("horse", p, Pace(1.7), start=120, side=[(0, 0.9)], kind="animal", size=HORSE),
        ],
        22,
    )


def _horse_slow_wide() -> Drive:
    m = Street(length=500)
    p = m.way
    return draw(
        "gb_horse_slow_wide_i",
        "Passes at 3.6 m/s with 2.6 m or more. Round a horse, slowly, with nobody coming.",
        "pass r215.horse | not fail r143.direction",
        m,
        [
            ego(p, Pace(9).slow(60, 3.6, 1.5).hold(40), start=30, side=[(7, 0), (12, -3.2), (28, -3.2), (32, 0)]),
            Actor("horse", p, Pace(1.3), start=118, side=[(0, 1.0)], kind="animal", size=HORSE),
        ],
        36,
    )


def _horse_towards() -> Drive:
    m = Street(length=500, width=3.0)
    p = m.way
    return draw(
        "gb_horse_towards_i",
        "Passes a horse that comes towards it at 15 m/s with 1 m between.",
        "not pass r215.horse",
        m,
        [ego(p, Pace(15), start=30), coming(m, "horse", Pace(1.5), 250, side=[(0, -0.75)], kind="animal", size=HORSE)],
        18,
    )


def _cyclist_close() -> Drive:
    m = Street(length=500, kind="town", limit=30, footway=True)
    p = m.way
    return draw(
        "gb_cyclist_close_i",
        "0.7 m past a cyclist at 11 m/s.",
        "fail r163.cyclist",
        m,
        [
            ego(p, Pace(11), start=30, side=[(1, 0), (4, -0.9)]),
            Actor("b", p, Pace(5), start=90, side=[(0, 1.0)], kind="bicycle", size=BICYCLE),
        ],
        18,
        hertz=25,
    )


def _cyclist_fast_17() -> Drive:
    m = Street(length=800)
    p = m.way
    return draw(
        "gb_cyclist_fast_17_i",
        "Passes at 21 m/s (47 mph) with 1.65 m: more than 1.5 m is asked for there, 2 m by default.",
        "fail r163.cyclist",
        m,
        [
            ego(p, Pace(21), start=30, side=[(9, 0), (11, -1.95), (14, -1.95), (16, 0)]),
            Actor("b", p, Pace(6), start=220, side=[(0, 0.9)], kind="bicycle", size=BICYCLE),
        ],
        30,
    )


def _cyclist_null_class() -> Drive:
    m = Street(length=500, kind="town", limit=30)
    p = m.way
    return draw(
        "gb_cyclist_null_class_i",
        "Somebody of unknown class, 1.8 m long and 0.6 m wide, passed at 0.6 m. 0.6 m apart.",
        "not pass r163.cyclist | pass no-collision",
        m,
        [
            ego(p, Pace(11.5), start=30, side=[(1, 0), (4, -0.7)]),
            Actor("b", p, Pace(5), start=90, side=[(0, 1.1)], kind=None, size=BICYCLE),
        ],
        16,
    )


def _cyclist_2hz() -> Drive:
    m = Street(length=500, kind="town", limit=30)
    p = m.way
    return draw(
        "gb_cyclist_2hz_i",
        "0.6 m past a cyclist at 12 m/s, seen at 2 Hz.",
        "fail r163.cyclist",
        m,
        [
            ego(p, Pace(12), start=30, side=[(1, 0), (4, -0.7)]),
            Actor("b", p, Pace(8.5), start=70, side=[(0, 1.1)], kind="bicycle", size=BICYCLE),
        ],
        24,
        hertz=2,
    )


def _cyclist_cut_off_at_exit() -> Drive:
    m = Roundabout(width=5.0, radius=22)
    p = m.way(0, 3)
    meet = m.ring[1].at(1, 0)
    d = p.near(meet[0], meet[1])
    return draw(
        "gb_cyclist_cut_off_at_exit_i",
        "Passes a cyclist 0.5 m away in the ring of a roundabout.",
        "not pass r163.cyclist",
        m,
        [
            ego(p, Pace(8), start=d - 40, side=[(0, -0.8)]),
            Actor("b", p, Pace(4.5), start=d - 22, side=[(0, 0.9)], kind="bicycle", size=BICYCLE),
        ],
        12,
    )


def _hill_cyclist_z_one_sided() -> Drive:
    m = Street(length=600, z=(0, 0.04, 0))
    p = m.way
    return draw(
        "gb_hill_cyclist_z_one_sided_i",
        "0.7 m past a cyclist on a hill; only the ego's track has heights.",
        "fail r163.cyclist",
        m,
        [
            ego(p, Pace(12), start=50, z=6.0),
            Actor("b", p, Pace(5), start=110, side=[(0, 1.9)], kind="bicycle", size=(1.8, 0.6, 1.7)),
        ],
        16,
    )


def _motorbike_past_cyclist() -> Drive:
    m = Street(length=500, kind="town", limit=30)
    p = m.way
    return draw(
        "gb_motorbike_past_cyclist_i",
        "The ego, a motorcycle, passes a cyclist 0.5 m away at 13 m/s.",
        "fail r163.cyclist",
        m,
        [
            ego(p, Pace(12.5), start=40, side=[(0, 0.3)], kind="motorcycle", size=(2.2, 0.8, 1.5)),
            Actor("b", p, Pace(4), start=100, side=[(0, 1.5)], kind="bicycle", size=BICYCLE),
        ],
        16,
    )


DRAWN = (
    _horse_fast,
    _horse_slow_wide,
    _horse_towards,
    _cyclist_close,
    _cyclist_fast_17,
    _cyclist_null_class,
    _cyclist_2hz,
    _cyclist_cut_off_at_exit,
    _hill_cyclist_z_one_sided,
    _motorbike_past_cyclist,
)
