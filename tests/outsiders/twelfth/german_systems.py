"""Germany: the automated driver (UN R157, R79)."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.twelfth.cast import (
    AL,
    DE,
    DL,
    DM,
    DR,
    ego,
)
from tests.outsiders.twelfth.drive import Actor, Drive, draw
from tests.outsiders.twelfth.maps import (
    bab,
)
from tests.outsiders.twelfth.ways import Straight


def german_systems() -> Iterator[Drive]:
    yield draw(
        "de_alks_kriecht_auf",
        bab(limit=100),
        [ego(Straight(50, DM, 13)), Actor("l", "van", Straight(63.5, DM, 13)), Actor("n", "car", Straight(45, DL, 13))],
        AL,
        20,
        [("alks-r157.follow-gap", "fail", "8.5 m behind at 47 km/h where about 19 m are due")],
    )
    yield draw(
        "de_alks_cut_in_hit",
        bab(limit=100),
        [
            ego(Straight(50, DM, [(0, 25), (5.7, 25), (5.8, 19), (12, 15)])),
            Actor(
                "c",
                "car",
                Straight(110, DR, [(0, 15), (5.65, 15), (5.75, 20), (12, 14)], moves=[(1.0, 5, DM)]),
                ind=[(0, "left")],
            ),
        ],
        AL,
        12,
        [
            ("alks-r157.cut-in", "fail", "a car cuts in with about 3 s to spare, the ego never brakes and hits it"),
            ("ukhc.no-collision", "fail", "touches it at 5.6 s"),
        ],
        hz=20,
    )
    yield draw(
        "de_alks_mrm_hart",
        bab(limit=100),
        [ego(Straight(50, DR, [(0, 24), (7, 24), (9.5, 10), (13, 0)]), ind=[])],
        DE,
        25,
        [
            ("alks-r157.mrm", "fail", "5.6 m/s2 for 2.5 s in a minimal risk manoeuvre"),
            ("alks-r157.mrm-hazards", "fail", "no hazard lights in it"),
        ],
        events=[
            (0, "engaged", "on"),
            (0, "minimal_risk_manoeuvre", "off"),
            (0, "emergency_manoeuvre", "off"),
            (6.5, "minimal_risk_manoeuvre", "on"),
        ],
    )
    yield draw(
        "de_alks_notbremse_verschwiegen",
        bab(limit=120),
        [
            ego(Straight(50, DM, [(0, 28), (8, 28), (8.4, 26.5), (11, 7.5), (20, 7.5)])),
            Actor("l", "car", Straight(120, DM, [(0, 27), (6.6, 27), (9.6, 6), (20, 7)])),
        ],
        DE,
        20,
        [
            ("alks-r157.emergency", "fail", "brakes with 7.3 m/s2, never declares an emergency manoeuvre"),
            ("stvo.rg2", "not fail", "the vehicle ahead braked"),
        ],
        events=[(0, "engaged", "on"), (0, "emergency_manoeuvre", "off")],
    )
    yield draw(
        "de_alks_schleichender_wechsel",
        bab(limit=100),
        [ego(Straight(50, DR, 24, moves=[(4, 24, DM)]), ind=[(0, "off"), (11.2, "left"), (24, "off")])],
        AL,
        32,
        [
            ("alks-r157.r79.lane-change", "fail", "the indicator comes on a second and a half before it crosses"),
            ("alks-r157.r79.lane-change-done", "fail", "over six seconds from the line to wholly across"),
        ],
        hz=10,
    )
