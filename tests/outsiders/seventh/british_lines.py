"""Great Britain: lines and sides of the road."""

from __future__ import annotations

from tests.outsiders.seventh.cast import BICYCLE, WINDING
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import Street, city, dual, town
from tests.outsiders.seventh.movement import Actor, Pace, ego


def _cross_near_solid() -> Drive:
    m = Street(length=1400, centre=[(0, "broken"), (220, "solid broken"), (900, "broken")])
    p = m.way
    return draw(
        "gb_cross_near_solid_i",
        "Crosses a middle line that is solid on its side to pass a car at 15 m/s.",
        "fail r129.no-cross-solid",
        m,
        [
            ego(p, Pace(18).to(24, 2).hold(20), start=200, side=[(3, 0), (5.5, -3.4), (9, -3.4), (11.5, 0)]),
            Actor("v", p, Pace(15), start=260, kind="van", size=(5.6, 2, 2.4)),
        ],
        16,
    )


def _solid_far_side_only() -> Drive:
    m = Street(length=1600, centre="broken solid")
    p = m.way
    return draw(
        "gb_solid_far_side_only_i",
        "The line nearer to the ego is broken; only the far one is solid. It is back long before anything changes.",
        "pass r129.no-cross-solid | not fail r128.back-before-solid",
        m,
        [
            ego(p, Pace(16).to(23, 2).hold(20), start=150, side=[(2, 0), (4.5, -3.4), (10, -3.4), (12.5, 0)]),
            Actor("v", p, Pace(12), start=215),
        ],
        18,
    )


def _back_after_solid_begins() -> Drive:
    m = Street(length=1400, centre=[(0, "broken solid"), (330, "solid solid")])
    p = m.way
    return draw(
        "gb_back_after_solid_begins_i",
        "Out over the broken line, still out 100 m after it has become solid on its side.",
        "fail r128.back-before-solid",
        m,
        [
            ego(p, Pace(20).to(24, 2).hold(20), start=180, side=[(2, 0), (4.5, -3.4), (10, -3.4), (12.5, 0)]),
            Actor("v", p, Pace(16), start=230),
        ],
        17,
    )


def _solid_past_slow_cyclist() -> Drive:
    m = Street(length=900, centre="solid solid")
    p = m.way
    return draw(
        "gb_solid_past_slow_cyclist_i",
        "A cyclist at 3.6 m/s (8 mph) may be passed over the solid line. About 2.7 m away at 13 m/s.",
        "not fail r129.no-cross-solid | pass r163.cyclist",
        m,
        [
            ego(p, Pace(12), start=50, side=[(4, 0), (7, -2.9), (13.5, -2.9), (16.5, 0)]),
            Actor("bike", p, Pace(3.6), start=130, side=[(0, 1.0)], kind="bicycle", size=BICYCLE),
        ],
        20,
    )


def _solid_past_fast_cyclist() -> Drive:
    m = Street(length=1200, centre="solid solid")
    p = m.way
    return draw(
        "gb_solid_past_fast_cyclist_i",
        "The cyclist rides at 8.5 m/s (19 mph): the exception for 10 mph does not hold.",
        "fail r129.no-cross-solid",
        m,
        [
            ego(p, Pace(16), start=50, side=[(4, 0), (7, -3.2), (14, -3.2), (17, 0)]),
            Actor("bike", p, Pace(8.5), start=125, side=[(0, 0.9)], kind="bicycle", size=BICYCLE),
        ],
        21,
    )


def _wrong_side_long() -> Drive:
    m = Street(pieces=WINDING)
    return draw(
        "gb_wrong_side_long_i",
        "25 s in the opposing lane at 15 m/s for no reason.",
        "fail r143.direction",
        m,
        [ego(m.way, Pace(15), start=60, side=[(3, 0), (6, -3.5), (32, -3.5), (35, 0)])],
        40,
    )


def _one_way_wrong_way() -> Drive:
    m = city(width=3.2, length=400)
    return draw(
        "gb_one_way_wrong_way_i",
        "Drives at 8 m/s against a one-way street.",
        "fail r143.direction",
        m,
        [ego(m.against(1), Pace(8), start=20), Actor("right", m.on(2), Pace(7), start=40)],
        22,
    )


def _one_way_heading_pi() -> Drive:
    m = city(width=3.2, length=400)
    return draw(
        "gb_one_way_heading_pi_i",
        "Heading written the wrong way round: it moves with the lane, but backwards by the heading, at 12 m/s.",
        "not pass r143.direction",
        m,
        [ego(m.on(2), Pace(12), start=20, flipped=True)],
        20,
    )


def _reverse_to_park() -> Drive:
    m = town()
    p = m.way
    return draw(
        "gb_reverse_to_park_i",
        "Reverses slowly into a gap at the kerb, 1.5 m/s.",
        "not fail r143.direction",
        m,
        [
            ego(
                p,
                Pace(6).stop(70, 1.5).hold(2).to(-1.5, 1).hold(4).to(0, 1).hold(10),
                start=80,
                side=[(16, 0), (21, 0.7)],
                lamps=[(6, "left")],
            ),
            Actor("k1", p, Pace(0), start=137, side=[(0, 2.1)]),
            Actor("k2", p, Pace(0), start=154, side=[(0, 2.1)]),
        ],
        30,
    )


def _reverse_fast() -> Drive:
    m = Street(length=500)
    return draw(
        "gb_reverse_fast_i",
        "Reverses along a rural road at 8 m/s for 8 s.",
        "fail r143.direction",
        m,
        [ego(m.way, Pace(12).hold(14).to(0, 2).hold(2).to(-8, 2).hold(8).to(0, 2).hold(5), start=60)],
        46,
    )


def _astride_dual() -> Drive:
    m = dual()
    return draw(
        "gb_astride_dual_i",
        "Astride the lane line of a dual carriageway for 18 s.",
        "fail r131.keep-in-lane",
        m,
        [ego(m.on(2), Pace(19), start=50, side=[(4, 0), (7, -1.8), (25, -1.8), (28, 0)])],
        58,
    )


def _reverse_7ms_short() -> Drive:
    m = Street(length=700)
    return draw(
        "gb_reverse_7ms_short_i",
        "Reverses along a rural road at 7 m/s, over 4.47 m/s for 6 s.",
        "fail r143.direction",
        m,
        [ego(m.way, Pace(12).hold(30).to(0, 2).hold(2).to(-7, 2.5).hold(4).to(0, 2.5).hold(3), start=60)],
        52,
    )


def _astride_centre_25s() -> Drive:
    m = Street(length=900)
    return draw(
        "gb_astride_centre_25s_i",
        "Astride the broken middle line of a road for 22 s of 55 with nobody there.",
        "not pass r131.keep-in-lane",
        m,
        [ego(m.way, Pace(14), start=50, side=[(15, 0), (18, -1.5), (40, -1.5), (43, 0)])],
        56,
    )


DRAWN = (
    _cross_near_solid,
    _solid_far_side_only,
    _back_after_solid_begins,
    _solid_past_slow_cyclist,
    _solid_past_fast_cyclist,
    _wrong_side_long,
    _one_way_wrong_way,
    _one_way_heading_pi,
    _reverse_to_park,
    _reverse_fast,
    _astride_dual,
    _reverse_7ms_short,
    _astride_centre_25s,
)
