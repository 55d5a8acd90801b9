"""Germany: R157, R79 and what is declared."""

from __future__ import annotations

from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import Street, autobahn, german_town
from tests.outsiders.seventh.movement import Actor, Pace, ego


def _alks_cut_in_hit() -> Drive:
    m = autobahn()
    return draw(
        "de_alks_cut_in_hit_i",
        "A car cuts in slowly 30 m ahead and 4 m/s slower; the system does nothing and hits it. It runs into it.",
        "fail alks-r157.cut-in no-collision",
        m,
        [
            ego(m.on(3), Pace(16), start=100),
            Actor(
                "c",
                m.on(3),
                Pace(12),
                start=100 + 34 + 4 * 6 - 20,
                side=[(0, 3.65), (4, 3.65), (8, 0)],
                lamps=[(2, "right")],
            ),
        ],
        20,
        engaged="yes",
    )


def _alks_cut_in_gap_kept_small() -> Drive:
    m = autobahn()
    return draw(
        "de_alks_cut_in_gap_kept_small_i",
        "A van cuts in and the ego follows at 9 m at 14 m/s for 15 s (over 20 m are asked for). 9 m is "
        "less than the table's 21 m.",
        "fail alks-r157.cut-in-gap | not pass alks-r157.follow-gap",
        m,
        [
            ego(m.on(3), Pace(14), start=100),
            Actor(
                "c", m.on(3), Pace(14), start=114, side=[(0, 3.65), (4, 3.65), (8, 0)], kind="van", size=(5.5, 2, 2.4)
            ),
        ],
        30,
        engaged="yes",
    )


def _alks_follow_4m() -> Drive:
    m = autobahn()
    return draw(
        "de_alks_follow_4m_i",
        "4 m behind at 11 m/s all along; the table asks for 15 m.",
        "fail alks-r157.follow-gap",
        m,
        [ego(m.on(2), Pace(11), start=100), Actor("c", m.on(2), Pace(11), start=108.5)],
        25,
        engaged="yes",
    )


def _alks_emergency_undeclared() -> Drive:
    m = autobahn()
    return draw(
        "de_alks_emergency_undeclared_i",
        "Brakes with 7.5 m/s2 and declares nothing.",
        "fail alks-r157.emergency",
        m,
        [
            ego(m.on(2), Pace(16).hold(6).to(2, 7.5).hold(10), start=100),
            Actor("c", m.on(2), Pace(16).hold(5).to(1.5, 8).hold(12), start=130),
        ],
        20,
        events=[(0, "engaged", "on"), (0, "emergency_manoeuvre", "off")],
    )


def _alks_emergency_declared() -> Drive:
    m = autobahn()
    return draw(
        "de_alks_emergency_declared_i",
        "Declared from the start of the braking to its end.",
        "pass alks-r157.emergency",
        m,
        [
            ego(m.on(2), Pace(16).hold(6).to(2, 7.5).hold(10), start=100),
            Actor("c", m.on(2), Pace(16).hold(5).to(1.5, 8).hold(12), start=130),
        ],
        20,
        events=[
            (0, "engaged", "on"),
            (0, "emergency_manoeuvre", "off"),
            (5.6, "emergency_manoeuvre", "on"),
            (9.2, "emergency_manoeuvre", "off"),
        ],
    )


def _alks_mrm_hard_dark() -> Drive:
    m = autobahn()
    return draw(
        "de_alks_mrm_hard_dark_i",
        "Brakes with 5.5 m/s2 for over 2 s in a minimal risk manoeuvre. No hazard lights.",
        "fail alks-r157.mrm alks-r157.mrm-hazards",
        m,
        [ego(m.on(3), Pace(16).hold(6).to(0, 5.5).hold(12), start=100, lamps=[(0, "off")])],
        20,
        events=[(0, "engaged", "on"), (0, "minimal_risk_manoeuvre", "off"), (5.5, "minimal_risk_manoeuvre", "on")],
    )


def _alks_mrm_gentle() -> Drive:
    m = autobahn()
    return draw(
        "de_alks_mrm_gentle_i",
        "Brakes with 2.5 m/s2. Hazard lights from the start.",
        "pass alks-r157.mrm alks-r157.mrm-hazards",
        m,
        [ego(m.on(3), Pace(16).hold(6).to(0, 2.5).hold(12), start=100, lamps=[(5.2, "hazard")])],
        22,
        events=[(0, "engaged", "on"), (0, "minimal_risk_manoeuvre", "off"), (5.2, "minimal_risk_manoeuvre", "on")],
    )


def _r79_late_signal_slow_change() -> Drive:
    m = autobahn()
    return draw(
        "de_r79_late_signal_slow_change_i",
        "Crosses the line 1.2 s after the indicator came on. Takes 9 s over the line.",
        "fail alks-r157.r79.lane-change alks-r157.r79.lane-change-done",
        m,
        [
            ego(
                m.on(3),
                Pace(25),
                start=100,
                side=[(4, 0), (7, 1.5), (15, 2.3), (18, 3.65)],
                lamps=[(4.2, "left"), (19, "off")],
            )
        ],
        26,
        engaged="yes",
    )


def _declared_speed_broken() -> Drive:
    m = german_town()
    return draw(
        "de_declared_speed_broken_i",
        "Chose 12 m/s and drives 15. The second choice names no reason.",
        "fail declared.r125.chosen-speed-kept declared.r152.speed-reason",
        m,
        [ego(m.way, Pace(11).hold(8).to(15, 1.2).hold(15), start=20)],
        24,
        events=[(0, "chosen_speed", "12; town"), (6, "chosen_speed", "12.2")],
    )


def _declared_overtake_unsure() -> Drive:
    m = Street("de", length=2000)
    p = m.way
    return draw(
        "de_declared_overtake_unsure_i",
        "0.55 only when it pulls out. Its last decision was not to go. No blind spot check. Mirror check "
        "a second before the signal.",
        "fail declared.r166.confidence-at-commit declared.r162.go-before-overtaking "
        "declared.r163.checks-before-pull-out | pass declared.r161.mirrors-before-signal",
        m,
        [
            ego(
                p,
                Pace(16).hold(6).to(24, 2).hold(20),
                start=100,
                side=[(8, 0), (10.5, 3.5), (15, 3.5), (18, 0)],
                lamps=[(6, "left"), (11, "off"), (14.5, "right"), (18, "off")],
            ),
            Actor("v", p, Pace(12), start=185),
        ],
        24,
        events=[
            (2, "overtake_go", None),
            (5, "mirror_check", "left"),
            (5.2, "overtake_no_go", None),
            (7, "confidence", "0.55"),
            (13.5, "mirror_check", "right"),
            (14.2, "blind_spot_check", "right"),
        ],
    )


def _declared_reverse_blind() -> Drive:
    m = german_town(length=300)
    p = m.way
    return draw(
        "de_declared_reverse_blind_i",
        "Reverses with a mirror check only.",
        "fail declared.r202.checks-before-reversing",
        m,
        [ego(p, Pace(5).stop(40, 1.5).hold(3).to(-1.5, 1).hold(4).to(0, 1).hold(9), start=80)],
        26,
        events=[(1, "mirror_check", None), (1.5, "blind_spot_check", None), (11, "mirror_check", None)],
    )


DRAWN = (
    _alks_cut_in_hit,
    _alks_cut_in_gap_kept_small,
    _alks_follow_4m,
    _alks_emergency_undeclared,
    _alks_emergency_declared,
    _alks_mrm_hard_dark,
    _alks_mrm_gentle,
    _r79_late_signal_slow_change,
    _declared_speed_broken,
    _declared_overtake_unsure,
    _declared_reverse_blind,
)
