"""Germany: automated driving (R157 and R79)."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.worlds import lane, straight


def german_systems() -> list[Drive]:
    return [
        draw(
            "de_alks_follow_j",
            "An automated ego follows 15 m behind a lorry at 52 km/h.",
            "fail alks-r157.follow-gap",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, 14.5),
                who("l", "truck", lane(-2), 82, 14.5),
            ],
            30,
            engaged="yes",
        ),
        draw(
            "de_alks_follow_ok_j",
            "An automated ego follows 33 m behind a lorry at 52 km/h.",
            "pass alks-r157.follow-gap | not fail alks-r157.emergency",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, 14.5),
                who("l", "truck", lane(-2), 100, 14.5),
            ],
            30,
            engaged="yes",
        ),
        draw(
            "de_alks_cut_in_hit_j",
            "A car moves in ahead of an automated ego and is run into without braking.",
            "fail no-collision",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, [(0, 16), (7.9, 16), (8.5, 9), (22, 9)]),
                car("c", lane(-3), 95, [(0, 14), (4, 14), (5.5, 9), (22, 9)], [(3.5, 0), (6, 3.5)]),
            ],
            22,
            engaged="yes",
        ),
        draw(
            "de_alks_cut_in_saved_j",
            "A car moves in ahead of an automated ego, which brakes in time.",
            "pass alks-r157.cut-in no-collision | not fail alks-r157.emergency",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, [(0, 16), (6.5, 16), (9.5, 8.5), (25, 8.5)]),
                car("c", lane(-3), 110, [(0, 14), (5, 14), (7.5, 9), (25, 9)], [(3.5, 0), (6.5, 3.5)]),
            ],
            25,
            events=[(0, "emergency_manoeuvre", "off")],
            engaged="yes",
        ),
        draw(
            "de_alks_gap_never_back_j",
            "A car moves in 4 m ahead of an automated ego, which stays that near.",
            "fail alks-r157.cut-in-gap",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, 15.5),
                car("c", lane(-3), 68, 15.6, [(4, 0), (7, 3.5)]),
            ],
            30,
            engaged="yes",
        ),
        draw(
            "de_alks_undeclared_emergency_j",
            "An automated ego brakes with 6.7 m/s2 for nobody and declares no emergency.",
            "fail alks-r157.emergency stvo.rg2",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-2), 60, [(0, 27), (8, 27), (11, 7), (22, 7)]),
            ],
            22,
            events=[(0, "emergency_manoeuvre", "off")],
            engaged="yes",
        ),
        draw(
            "de_mrm_hard_j",
            "An automated ego brakes with 5.5 m/s2 in a minimal risk manoeuvre, hazard lights on.",
            "fail alks-r157.mrm | pass alks-r157.mrm-hazards",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, [(0, 25), (8, 25), (12.4, 1), (13, 0), (28, 0)], blink=[(0, "off"), (7.1, "hazard")]),
            ],
            28,
            events=[(0, "minimal_risk_manoeuvre", "off"), (7, "minimal_risk_manoeuvre", "on")],
            engaged="yes",
        ),
        draw(
            "de_mrm_dark_j",
            "An automated ego's hazard lights come on five seconds into a minimal risk manoeuvre.",
            "fail alks-r157.mrm-hazards | pass alks-r157.mrm",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, [(0, 22), (8, 22), (17, 0), (35, 0)], blink=[(0, "off"), (12, "hazard")]),
            ],
            35,
            events=[(0, "minimal_risk_manoeuvre", "off"), (7, "minimal_risk_manoeuvre", "on")],
            engaged="yes",
        ),
        draw(
            "de_r79_good_j",
            "An automated ego crosses the line some four seconds after its signal.",
            "pass alks-r157.r79.lane-change alks-r157.r79.lane-change-done",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, 26, [(8, 0), (11.5, 3.5)], blink=[(0, "off"), (5.2, "left"), (12.5, "off")]),
            ],
            25,
            engaged="yes",
        ),
        draw(
            "de_r79_signal_9s_j",
            "An automated ego crosses the line nearly nine seconds after its signal.",
            "fail alks-r157.r79.lane-change",
            Map((straight(1800, "motorway", gb=False, lanes=3),)),
            [
                ego(lane(-3), 60, 26, [(12, 0), (15.5, 3.5)], blink=[(0, "off"), (4.5, "left"), (16.5, "off")]),
            ],
            28,
            engaged="yes",
        ),
    ]
