"""Germany: distances and lanes on motorways."""

from __future__ import annotations

from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import autobahn
from tests.outsiders.seventh.movement import Actor, Pace, ego


def _bab_tailgate() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_tailgate_i",
        "6 m behind a car at 33 m/s; even by the generous formula 12 m are needed. 0.2 s. British law "
        "does not hold here.",
        "fail stvo.rg1 criticality.thw | not fail r124.speed-limit",
        m,
        [ego(m.on(1), Pace(33), start=50), Actor("a", m.on(1), Pace(33), start=60.5)],
        25,
    )


def _bab_close_trailer_null() -> Drive:
    m = autobahn(2)
    return draw(
        "de_bab_close_trailer_null_i",
        "5 m behind a caravan (class NULL) at 26 m/s.",
        "fail stvo.rg1",
        m,
        [
            ego(m.on(2), Pace(26), start=50),
            Actor("k", m.on(2), Pace(26), start=58 + 2.25 + 1, kind=None, size=(7.5, 2.3, 2.6)),
            Actor("car", m.on(2), Pace(26), start=68.2),
        ],
        25,
    )


def _bab_cut_in_restored() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_cut_in_restored_i",
        "After the cut-in the distance is there again within two seconds.",
        "not fail stvo.rg1",
        m,
        [
            ego(m.on(2), Pace(30).hold(5.5).to(26, 2.5).hold(30), start=100),
            Actor(
                "c", m.on(2), Pace(31), start=113, side=[(0, 3.65), (4, 3.65), (7, 0)], lamps=[(2, "right"), (7, "off")]
            ),
        ],
        24,
    )


def _bab_cut_in_kept_close() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_cut_in_kept_close_i",
        "Five seconds and more after the cut-in the gap is still 4 m at 30 m/s.",
        "fail stvo.rg1",
        m,
        [
            ego(m.on(2), Pace(30), start=100),
            Actor("c", m.on(2), Pace(30), start=108.5, side=[(0, 3.65), (4, 3.65), (7, 0)]),
        ],
        26,
    )


def _bab_bus_112() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_bus_112_i",
        "A bus at 31 m/s (112 km/h) on a motorway, where 80 or at most 100 hold.",
        "fail stvo.rg3",
        m,
        [ego(m.on(3), Pace(31), start=50, kind="bus", size=(13, 2.55, 3.8))],
        25,
    )


def _bab_caravan_93() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_caravan_93_i",
        "A car with a trailer at 26 m/s (93 km/h): 80 hold, 100 only by exemption.",
        "not pass stvo.rg3",
        m,
        [
            ego(m.on(3), Pace(26), start=60),
            Actor("cv", m.on(3), Pace(26), start=53.5, kind="trailer", size=(6.4, 2.3, 2.6)),
        ],
        25,
        vehicle_class="car_towing",
    )


def _bab_crawler() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_crawler_i",
        "14 m/s (50 km/h) on a free motorway of 130 km/h for 40 s.",
        "fail stvo.rg4",
        m,
        [ego(m.on(3), Pace(14), start=50)],
        40,
        hertz=5,
    )


def _bab_lorry_79() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_lorry_79_i",
        "A lorry of 22 m/s is as fast as it may be. 79 km/h.",
        "not fail stvo.rg4 | pass stvo.rg3",
        m,
        [ego(m.on(3), Pace(22), start=50, kind="truck", size=(16, 2.5, 3.9))],
        30,
        vehicle_class="goods_over_7t5",
    )


def _bab_cuts_off() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_cuts_off_i",
        "Changes left 9 m before a car that is 14 m/s faster.",
        "fail stvo.rg6",
        m,
        [
            ego(m.on(2), Pace(25), start=180, side=[(5, 0), (8, 3.65)], lamps=[(4, "left"), (9, "off")]),
            Actor("f", m.on(1), Pace(39).hold(6).to(24, 8).hold(20), start=180 - 13.5 - 14 * 6),
        ],
        18,
    )


def _bab_changes_with_room() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_changes_with_room_i",
        "The car behind in the new lane is 120 m away and hardly faster. Indicator 3.6 s before it "
        "crosses. Over in 3 s or so.",
        "pass stvo.rg6 alks-r157.r79.lane-change alks-r157.r79.lane-change-done",
        m,
        [
            ego(m.on(3), Pace(30), start=180, side=[(6, 0), (10, 3.65)], lamps=[(3.9, "left"), (11, "off")]),
            Actor("f", m.on(2), Pace(31), start=55),
        ],
        18,
        engaged="yes",
    )


def _bab_lorry_28m() -> Drive:
    m = autobahn()
    p = m.on(3)
    return draw(
        "de_bab_lorry_28m_i",
        "A lorry 28 m behind another at 22 m/s. 28 m are more than the formula's distance.",
        "fail stvo.s4-truck | pass stvo.rg1",
        m,
        [
            ego(p, Pace(22), start=50, kind="truck", size=(16, 2.5, 3.9)),
            Actor("l", p, Pace(22), start=50 + 8 + 28 + 8, kind="truck", size=(16, 2.5, 3.9)),
        ],
        28,
        vehicle_class="goods_over_7t5",
    )


def _bab_coach_35m_5hz() -> Drive:
    m = autobahn()
    p = m.on(3)
    return draw(
        "de_bab_coach_35m_5hz_i",
        "A coach 35 m behind a car at 24 m/s.",
        "fail stvo.s4-truck",
        m,
        [
            ego(p, Pace(21.5), start=50, kind="bus", size=(13, 2.55, 3.8)),
            Actor("l", p, Pace(21.5), start=50 + 6.5 + 35 + 2.25),
        ],
        28,
        hertz=5,
    )


def _bab_lead_changes_id() -> Drive:
    m = autobahn()
    return draw(
        "de_bab_lead_changes_id_i",
        "The car 5 m ahead at 33 m/s has another id every two seconds, with half a second of nothing "
        "between. 5 m at 33 m/s.",
        "not pass stvo.rg1 r126.thinking-gap",
        m,
        [ego(m.on(2), Pace(33), start=50)]
        + [Actor(f"x{i}", m.on(2), Pace(33), start=59.5, begin=2.5 * i, end=2.5 * i + 2) for i in range(8)],
        20,
    )


DRAWN = (
    _bab_tailgate,
    _bab_close_trailer_null,
    _bab_cut_in_restored,
    _bab_cut_in_kept_close,
    _bab_bus_112,
    _bab_caravan_93,
    _bab_crawler,
    _bab_lorry_79,
    _bab_cuts_off,
    _bab_changes_with_room,
    _bab_lorry_28m,
    _bab_coach_35m_5hz,
    _bab_lead_changes_id,
)
