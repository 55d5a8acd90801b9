"""Driving systems on motorways of both nations."""

from __future__ import annotations

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import actor, ego, track
from tests.outsiders.eleventh.places import INNER, bahn, motorway, on

ON: list[tuple[float, str, str | None]] = [
    (0.0, "engaged", "on"),
    (0.0, "emergency_manoeuvre", "off"),
    (0.0, "minimal_risk_manoeuvre", "off"),
]


def systems() -> list[Drive]:
    plain, way = bahn()
    british, left = motorway()
    return [
        Drive(
            "de_alks_near",
            plain,
            [ego(track(way, 26, 100, 13.5, lat=on(1))), actor("a", "truck", track(way, 26, 116.7, 13.5, lat=on(1)))],
            events=[*ON],
            expect=[("alks-r157.follow-gap", "fail", "9 m at 48.6 km/h, about 20 m are due")],
        ),
        Drive(
            "de_alks_cut_in",
            plain,
            [
                ego(track(way, 30, 100, 13, lat=on(1))),
                actor("a", "van", track(way, 30, 112, 13, lat=[(0, -INNER[0]), (5, -INNER[0]), (8, -INNER[1])])),
            ],
            events=[*ON],
            expect=[
                (
                    "alks-r157.cut-in-gap",
                    "fail",
                    "a van cuts in 7 m ahead at 13 m/s, and the ego stays as near for 22 s",
                ),
                ("criticality.thw", "fail", "half a second for 20 s"),
            ],
        ),
        Drive(
            "de_alks_mrm",
            plain,
            [ego(track(way, 24, 100, 24, [(8, -5.6), (10.5, -2), (15.5, 0)], on(2)), lamps=[(19, 24, "hazard")])],
            events=[*ON, (7.5, "minimal_risk_manoeuvre", "on")],
            expect=[
                ("alks-r157.mrm", "fail", "5.6 m/s2 for two seconds and a half"),
                ("alks-r157.mrm-hazards", "fail", "its hazard lights are off"),
            ],
        ),
        Drive(
            "de_alks_silent",
            plain,
            [
                ego(track(way, 20, 100, 25, [(8, -7.2), (10.2, 0)], on(2))),
                actor("a", "car", track(way, 20, 140, 25, [(7, -7), (9.6, 0), (10.5, 1.0)], on(2))),
            ],
            events=[*ON],
            expect=[("alks-r157.emergency", "fail", "brakes with 7.2 m/s2 and declares nothing")],
        ),
        Drive(
            "gb_alks_slow_change",
            british,
            [
                ego(
                    track(left, 30, 100, 26, lat=[(0, INNER[2]), (4, INNER[2]), (26, INNER[1])]),
                    lamps=[(10.0, 22, "right")],
                ),
                actor("b", "car", track(left, 30, 300, 25, lat=[(0, INNER[2])])),
            ],
            events=[*ON],
            expect=[
                (
                    "alks-r157.r79.lane-change",
                    "fail",
                    "the indicator came on about two seconds before the tyres reached the line",
                ),
                (
                    "alks-r157.r79.lane-change-done",
                    "fail",
                    "over six seconds from the line to being wholly in the new lane",
                ),
            ],
        ),
        Drive(
            "gb_alks_good_change",
            british,
            [
                ego(
                    track(left, 24, 100, 26, lat=[(0, INNER[2]), (8, INNER[2]), (12, INNER[1])]),
                    lamps=[(5.2, 12.4, "right")],
                ),
                actor("b", "car", track(left, 24, 330, 24, lat=[(0, INNER[2])])),
            ],
            events=[*ON],
            expect=[
                ("alks-r157.r79.lane-change", "pass", "the indicator is on for 4 s before the line"),
                ("alks-r157.r79.lane-change-done", "pass", "two or three seconds"),
                ("alks-r157.emergency", "not fail", "never brakes"),
            ],
        ),
    ]
