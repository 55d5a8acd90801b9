"""Germany: towns and country roads."""

from __future__ import annotations

from tests.outsiders.seventh.cast import BICYCLE, LORRY, PERSON, WINDING, coming
from tests.outsiders.seventh.crossroads import Crossroads
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import Street, autobahn, german_town
from tests.outsiders.seventh.movement import Actor, Pace, ego
from tests.outsiders.seventh.road import Bend, Line
from tests.outsiders.seventh.ways import along


def _town_67() -> Drive:
    m = german_town()
    return draw(
        "de_town_67_i",
        "18.5 m/s (67 km/h) in a town of 50.",
        "fail stvo.rg3",
        m,
        [ego(m.way, Pace(12).hold(3).to(18.5, 2).hold(20), start=20)],
        20,
    )


def _rural_lorry_78() -> Drive:
    m = Street("de", pieces=WINDING)
    return draw(
        "de_rural_lorry_78_i",
        "A lorry over 7.5 t does 78 km/h on a rural road: 60 hold for it.",
        "fail stvo.rg3",
        m,
        [ego(m.way, Pace(21.7), start=50, kind="truck", size=LORRY)],
        28,
        vehicle_class="goods_over_7t5",
    )


def _rural_no_sign_115() -> Drive:
    m = Street("de", pieces=WINDING, limit=0)
    return draw(
        "de_rural_no_sign_115_i",
        "32 m/s (115 km/h) on a rural road of one lane each way whose map names no limit: 100 hold.",
        "fail stvo.rg3",
        m,
        [ego(m.way, Pace(32), start=50)],
        22,
    )


def _stop_sign_brief() -> Drive:
    m = Crossroads("de")
    m.stop("s")
    return draw(
        "de_stop_sign_brief_i",
        "Slows to 2 m/s at the stop line and goes on. No halt.",
        "fail stvo.rin1 r171.stop-sign",
        m,
        [
            ego(
                m.way("s", "e"),
                Pace(9).slow(77, 2, 2).hold(2).to(7, 2).hold(20),
                start=40,
                lamps=[(2, "right"), (16, "off")],
            )
        ],
        22,
    )


def _stop_sign_kept() -> Drive:
    m = Crossroads("de")
    m.stop("s")
    return draw(
        "de_stop_sign_kept_i",
        "Halts 2.5 s with its front 0.3 m before the line. 0.3 m before the line.",
        "pass stvo.rin1 performance.precise-stop",
        m,
        [
            ego(
                m.way("s", "w"),
                Pace(9).stop(119.25 - 0.3 - 2.25 - 40, 2).hold(3.3).to(6, 1.5).hold(20),
                start=40,
                lamps=[(2, "left"), (24, "off")],
            )
        ],
        32,
    )


def _stop_line_far_short() -> Drive:
    m = Crossroads("de")
    m.stop("s")
    return draw(
        "de_stop_line_far_short_i",
        "Stands 2.4 m before the line. 2.4 m before the line is hardly close before it.",
        "fail performance.precise-stop | not pass stvo.rin1",
        m,
        [
            ego(
                m.way("s", "w"),
                Pace(9).stop(119.25 - 2.4 - 2.25 - 40, 2).hold(3.3).to(6, 1.5).hold(20),
                start=40,
                lamps=[(2, "left"), (24, "off")],
            )
        ],
        32,
    )


def _town_cyclist_1m() -> Drive:
    m = german_town()
    p = m.way
    return draw(
        "de_town_cyclist_1m_i",
        "1.0 m past a cyclist in a town. British law does not hold here.",
        "fail stvo.s5-passing | not fail r163.cyclist",
        m,
        [
            ego(p, Pace(11), start=30, side=[(1, 0), (4, 1.2)]),
            Actor("b", p, Pace(5), start=80, side=[(0, -1.0)], kind="bicycle", size=BICYCLE),
        ],
        18,
    )


def _rural_walker_17() -> Drive:
    m = Street("de", length=700)
    p = m.way
    return draw(
        "de_rural_walker_17_i",
        "1.6 m past somebody who walks along a rural road: 2 m are asked for.",
        "fail stvo.s5-passing",
        m,
        [
            ego(p, Pace(15), start=30, side=[(10, 0), (13, 1.6), (16, 1.6), (19, 0)]),
            Actor("w", p, Pace(1.3), start=230, side=[(0, -1.2)], kind="pedestrian", size=PERSON),
        ],
        34,
    )


def _rural_cyclist_wide() -> Drive:
    m = Street("de", length=900)
    p = m.way
    return draw(
        "de_rural_cyclist_wide_i",
        "3 m past a cyclist. Nobody is coming.",
        "pass stvo.s5-passing | not fail rss.opposite",
        m,
        [
            ego(p, Pace(20), start=30, side=[(2, 0), (5, 3.3), (10, 3.3), (13, 0)]),
            Actor("b", p, Pace(6), start=140, side=[(0, -0.9)], kind="bicycle", size=BICYCLE),
        ],
        18,
    )


def _gas_hard() -> Drive:
    m = autobahn()
    return draw(
        "de_gas_hard_i",
        "3.4 m/s2 at over 20 m/s. More than 2.4 m/s2.",
        "fail comfort.accel-iso15622 comfort.nuplan",
        m,
        [ego(m.on(2), Pace(18).hold(3).to(35, 3.4).hold(9), start=50)],
        18,
    )


def _bend_fast() -> Drive:
    m = Street("de", pieces=[Line(200), Bend(180, 1 / 90), Line(300)])
    return draw(
        "de_bend_fast_i",
        "23 m/s in a bend of radius 90 m: 5.9 m/s2. More than 4.89 m/s2.",
        "fail comfort.lateral comfort.nuplan",
        m,
        [ego(m.way, Pace(23), start=50)],
        22,
    )


def _hard_stop_at_nothing() -> Drive:
    m = Street("de", length=800)
    return draw(
        "de_hard_stop_at_nothing_i",
        "6 m/s2 over two seconds from 22 m/s. Braking grows by 6 m/s2 within a second.",
        "fail comfort.decel-iso15622 comfort.jerk-iso15622",
        m,
        [ego(m.way, Pace(22).hold(5).to(0, 6).hold(6), start=50, smooth=0.3)],
        16,
    )


def _closing_fast() -> Drive:
    m = Street("de", pieces=WINDING)
    p = m.way
    return draw(
        "de_closing_fast_i",
        "0.9 s from a slow tractor before it brakes hard. More than 6 m/s2 needed. No second left. Below 1.5 s.",
        "fail criticality.ttc criticality.drac criticality.ttb criticality.mttc",
        m,
        [
            ego(p, Pace(22).hold(5).to(5, 9).hold(9), start=50),
            Actor("t", p, Pace(6), start=50 + 16 * 5 + 4.75 + 17.5, kind="vehicle", size=(5, 2.4, 3)),
        ],
        14,
        hertz=20,
    )


def _overtake_into_oncoming_bend() -> Drive:
    m = Street("de", pieces=WINDING)
    p = m.way
    return draw(
        "de_overtake_into_oncoming_bend_i",
        "In the opposing lane 60 m before a car at 22 m/s each. The distance is far too short.",
        "fail rss.opposite r162.safe-distance-ahead",
        m,
        [
            ego(p, Pace(17).hold(3).to(23, 2).hold(30), start=240, side=[(3, 0), (5.5, 3.5), (9.2, 3.5), (11, 0)]),
            Actor("v", p, Pace(14), start=275),
            coming(m, "onc", Pace(22).hold(5).to(9, 6).hold(9), 560),
        ],
        15,
    )


def _red_light_truck() -> Drive:
    m = Crossroads("de")
    m.lit("w", "A", "B")
    return draw(
        "de_red_light_truck_i",
        "A lorry goes over the line on red, 4 s after it came.",
        "fail r175.red",
        m,
        [ego(m.way("w", "e"), Pace(11), start=20, kind="truck", size=LORRY)],
        16,
        lights={"A": [(0, "green"), (2, "amber"), (4, "red")], "B": [(0, "green"), (2, "amber"), (4, "red")]},
        vehicle_class="goods_7t5",
    )


def _map_ends_soon() -> Drive:
    m = german_town(length=170)
    return draw(
        "de_map_ends_soon_i",
        "19 m/s in a town of 50 km/h for the 8 s that the map goes on. Nobody near.",
        "fail stvo.rg3 | pass no-collision",
        m,
        [ego(m.way, Pace(19), start=10), Actor("x", along(m.road, -m.own), Pace(0), start=150, flipped=True)],
        8.6,
    )


def _cyclists_abreast() -> Drive:
    m = Street("de", pieces=WINDING)
    p = m.way
    return draw(
        "de_cyclists_abreast_i",
        "Passes two cyclists abreast, 0.9 m from the outer one, at 17 m/s out of town.",
        "fail stvo.s5-passing",
        m,
        [
            ego(p, Pace(17), start=60, side=[(9, 0), (12, 2.0), (16, 2.0), (19, 0)]),
            Actor("b1", p, Pace(6), start=210, side=[(0, -1.2)], kind="bicycle", size=BICYCLE),
            Actor("b2", p, Pace(6), start=211, side=[(0, -0.1)], kind="bicycle", size=BICYCLE),
        ],
        40,
        hertz=5,
    )


DRAWN = (
    _town_67,
    _rural_lorry_78,
    _rural_no_sign_115,
    _stop_sign_brief,
    _stop_sign_kept,
    _stop_line_far_short,
    _town_cyclist_1m,
    _rural_walker_17,
    _rural_cyclist_wide,
    _gas_hard,
    _bend_fast,
    _hard_stop_at_nothing,
    _closing_fast,
    _overtake_into_oncoming_bend,
    _red_light_truck,
    _map_ends_soon,
    _cyclists_abreast,
)
