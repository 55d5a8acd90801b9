"""Germany: the automated driver (UN R157, R79)."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.sixteenth.cast import DE, ENGAGED, FAST, MIDDLE, SLOW, ego
from tests.outsiders.sixteenth.drive import Actor, Drive, draw
from tests.outsiders.sixteenth.maps import motorway
from tests.outsiders.sixteenth.ways import along


def _distances() -> Iterator[Drive]:
    yield draw(
        "alks-gap-creep",
        motorway(limit=22.22),
        [ego(along(MIDDLE, 2, 50)), Actor("a", "car", along(MIDDLE, 2, 56))],
        ENGAGED,
        20,
        [("alks-r157.follow-gap", "fail", "1.5 m at 2.0 m/s")],
    )
    yield draw(
        "alks-cut-in-kept-short",
        motorway(limit=22.22),
        [
            ego(along(MIDDLE, 14, 50), noise=0.02),
            Actor(
                "a",
                "car",
                along([(0, FAST), (4, FAST), (8, MIDDLE)], 14, 63.5),
                ind=[(0, "off"), (2, "right"), (8, "off")],
                noise=0.02,
            ),
        ],
        ENGAGED,
        30,
        [("alks-r157.cut-in-gap", "fail", "9 m at 14 m/s for 20 s"), ("alks-r157.cut-in", "not fail", "no touch")],
    )


def _cut_ins() -> Iterator[Drive]:
    yield draw(
        "alks-cut-in-restored",
        motorway(limit=22.22),
        [
            ego(along(MIDDLE, [(0, 14), (6, 14), (8, 11.5), (16, 11.5), (18, 14)], 50)),
            Actor(
                "a",
                "car",
                along([(0, FAST), (4, FAST), (8, MIDDLE)], 14, 63.5),
                ind=[(0, "off"), (2, "right"), (8, "off")],
            ),
        ],
        ENGAGED,
        30,
        [
            ("alks-r157.cut-in-gap", "pass", "back to 25 m in 9 s"),
            ("alks-r157.follow-gap", "not fail", "time to restore"),
        ],
    )
    yield draw(
        "alks-cut-in-hit",
        motorway(limit=22.22),
        [
            ego(along(MIDDLE, [(0, 16), (10.2, 16), (12, 9)], 50)),
            Actor(
                "a",
                "car",
                along([(0, FAST), (3, FAST), (7, MIDDLE)], 10, 102.5),
                ind=[(0, "off"), (1, "right"), (7, "off")],
            ),
        ],
        ENGAGED,
        20,
        [
            ("alks-r157.cut-in", "fail", "seen for 2 s, more than 3 s left, still hit"),
            ("ukhc.no-collision", "fail", "runs into it"),
            ("criticality.ttc", "fail", "hits"),
        ],
    )


def _manoeuvres() -> Iterator[Drive]:
    yield draw(
        "alks-emergency-silent",
        motorway(limit=33.33),
        [
            ego(along(MIDDLE, [(0, 20), (6, 20), (8.5, 3), (16, 3)], 50)),
            Actor("a", "car", along(MIDDLE, [(0, 20), (5.5, 20), (7.5, 3), (16, 3)], 74.5)),
        ],
        DE,
        16,
        [("alks-r157.emergency", "fail", "6.8 m/s2 without emergency manoeuvre")],
        hz=20,
        events=[(0, "engaged", "on"), (0, "emergency_manoeuvre", "off")],
    )
    yield draw(
        "mrm-soft-late-lights",
        motorway(limit=33.33),
        [ego(along(SLOW, [(0, 25), (6, 25), (7, 24), (15, 0), (30, 0)], 50), ind=[(0, "off"), (8.2, "hazard")])],
        DE,
        30,
        [("alks-r157.mrm", "pass", "3 m/s2"), ("alks-r157.mrm-hazards", "fail", "2.2 s late")],
        events=[(0, "engaged", "on"), (0, "minimal_risk_manoeuvre", "off"), (6, "minimal_risk_manoeuvre", "on")],
    )
    yield draw(
        "mrm-lights-out-at-end",
        motorway(limit=33.33),
        [
            ego(
                along(SLOW, [(0, 25), (6, 25), (7, 24), (15, 0), (30, 0)], 50),
                ind=[(0, "off"), (6.1, "hazard"), (20, "off")],
            )
        ],
        DE,
        30,
        [("alks-r157.mrm-hazards", "fail", "off again while the manoeuvre lasts")],
        events=[(0, "engaged", "on"), (0, "minimal_risk_manoeuvre", "off"), (6, "minimal_risk_manoeuvre", "on")],
    )


def _lane_changes() -> Iterator[Drive]:
    yield draw(
        "r79-early",
        motorway(),
        [ego(along([(0, SLOW), (8.5, SLOW), (12.5, MIDDLE)], 28, 50), ind=[(0, "off"), (0.5, "left"), (13, "off")])],
        ENGAGED,
        20,
        [("alks-r157.r79.lane-change", "fail", "left on since 0.5 s, crosses the line at 9.9 s")],
    )
    yield draw(
        "r79-wrong",
        motorway(),
        [ego(along([(0, SLOW), (8.5, SLOW), (12.5, MIDDLE)], 28, 50), ind=[(0, "off"), (5.5, "right"), (13, "off")])],
        ENGAGED,
        20,
        [("alks-r157.r79.lane-change", "fail", "right on since 5.5 s, crosses the line at 9.9 s")],
    )
    yield draw(
        "r79-slow",
        motorway(),
        [
            ego(
                along([(0, SLOW), (4, SLOW), (8, -7.5), (14, -7.5), (18, MIDDLE)], 28, 50),
                ind=[(0, "off"), (2, "left"), (18, "off")],
            )
        ],
        ENGAGED,
        30,
        [("alks-r157.r79.lane-change-done", "fail", "astride from 6 to 16 s")],
    )


def german_systems() -> Iterator[Drive]:
    yield from _distances()
    yield from _cut_ins()
    yield from _manoeuvres()
    yield from _lane_changes()
