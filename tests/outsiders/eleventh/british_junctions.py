"""Great Britain: crossroads and a roundabout."""

from __future__ import annotations

import numpy as np

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.junction import ARMS, Cross
from tests.outsiders.eleventh.motion import actor, ego, line, still, track
from tests.outsiders.eleventh.places import says
from tests.outsiders.eleventh.road import DE, GB, light, stop_line


def british_junctions() -> list[Drive]:
    lit = Cross(
        GB,
        ARMS,
        signals={"s": light("71", 1.0, -3.8, "-") + light("72", 1.5, 3.8, "-")},
        objects={"s": stop_line("8", 1.0, -1.75, "-")},
    )
    ahead = lit.route("s", "n")
    cross = Cross(GB, ARMS)
    right = track(cross.route("s", "e", 60, 80), 20, 10, 7)
    ring = Cross(GB, ARMS, ring=18.0)
    return [
        Drive(
            "gb_red_two_heads",
            lit.text(),
            [ego(track(lit.route("s", "n"), 20, 20, 11))],
            lights=says("71", 20, (0, "green"), (3.5, "amber"), (6.5, "red"))
            + says("72", 20, (0, "green"), (3.5, "amber"), (6.5, "red")),
            expect=[("ukhc.r175.red", "fail", "over the line 2.3 s after the light turned red; two heads say so")],
        ),
        Drive(
            "gb_green_blocked",
            lit.text(),
            [ego(track(ahead, 26, 60, 10, [(4.0, -1.43), (12, 0)])), actor("a", "van", still(ahead, 143.5, 0, 26))],
            lights=says("71", 26, (0, "green")) + says("72", 26, (0, "green")),
            expect=[
                (
                    "ukhc.r176.green-exit-clear",
                    "fail",
                    "stands in the junction for over ten seconds behind a van at its exit",
                ),
                ("ukhc.r175.red", "pass", "green"),
            ],
        ),
        Drive(
            "gb_right_turn",
            cross.text(),
            [ego(right), actor("o", "car", track(cross.route("n", "s", 120, 80), 20, 16, 12))],
            expect=[
                ("ukhc.r180.right-turn-gap", "fail", "turns right half a second before an oncoming car at 12 m/s"),
                ("criticality.pet", "fail", "0.6 s"),
            ],
        ),
        Drive(
            "gb_right_turn_good",
            cross.text(),
            [ego(right.copy()), actor("o", "car", track(cross.route("n", "s", 120, 80), 20, -60, 12))],
            expect=[
                ("ukhc.r180.right-turn-gap", "not fail", "six seconds of room"),
                ("ukhc.r180.corner-cut", "pass", "well round the corner"),
                ("criticality.pet", "not fail", "six seconds"),
            ],
        ),
        Drive(
            "gb_left_hook",
            cross.text(),
            [
                ego(
                    track(
                        cross.route("s", "w", 80, 80), 20, 10, 9, [(3, -1), (6, 0)], [(0, -1.2), (8, -1.2), (9.6, -0.3)]
                    )
                ),
                actor("c", "bicycle", track(cross.route("s", "n", 80, 80), 20, 32.4, 4.5, lat=[(0, 0.9)])),
            ],
            expect=[
                ("ukhc.h3.no-cut-across", "fail", "turns left 0.7 s before a cyclist who goes ahead"),
                ("ukhc.r182.no-pass-before-turn", "fail", "gets ahead of the cyclist three seconds before it turns"),
            ],
        ),
        Drive(
            "gb_turn_walker",
            cross.text(),
            [
                ego(track(cross.route("s", "w", 80, 80), 20, 10, 9, [(3, -1), (6, 0)])),
                actor("w", "pedestrian", track(line(-15, 6, -np.pi / 2), 20, -11.4, 1.3)),
            ],
            expect=[("ukhc.h2.turn-pedestrian", "fail", "turns left 0.8 s before somebody who crosses the side road")],
        ),
        Drive(
            "gb_corner_cut",
            cross.text(),
            [
                ego(
                    track(
                        cross.route("s", "e", 60, 80), 20, 15, 6, lat=[(0, 0), (7, 0), (9, -3.0), (12.5, -3.0), (15, 0)]
                    )
                )
            ],
            expect=[("ukhc.r180.corner-cut", "fail", "comes out of the right turn on the other side of the road")],
        ),
        Drive(
            "gb_left_wide",
            cross.text(),
            [
                ego(
                    track(
                        cross.route("s", "w", 60, 80), 22, 15, 5, lat=[(0, 0), (8, 0), (10, -1.1), (16, -1.1), (18, 0)]
                    )
                )
            ],
            expect=[("ukhc.r183.keep-in", "fail", "1.95 m between it and the kerb after a left turn")],
        ),
        Drive(
            "gb_ring_wrong_way",
            ring.text(),
            [
                ego(
                    track(
                        Cross(DE, ARMS, ring=18.0).route("s", "n", 80, 80),
                        26,
                        5,
                        9.0,
                        [(3, -1.0), (6, 0)],
                        [(0, 3.5), (5, 3.5), (8, 0)],
                    )
                ),
                actor("o", "car", track(ring.route("w", "s", 80, 80), 26, -60, 8)),
            ],
            expect=[
                (
                    "ukhc.r143.direction",
                    "fail",
                    "goes the wrong way round the roundabout, and leaves it on the wrong side",
                )
            ],
        ),
    ]
