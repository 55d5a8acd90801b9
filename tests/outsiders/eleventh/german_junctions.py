"""Germany: a stop sign, a roundabout, a zebra."""

from __future__ import annotations

import numpy as np

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.junction import ARMS, Cross
from tests.outsiders.eleventh.motion import actor, ego, line, track, turned
from tests.outsiders.eleventh.places import near
from tests.outsiders.eleventh.road import DE, crossing, signal, simple, stop_line


def german_junctions() -> list[Drive]:
    stop = Cross(
        DE,
        ARMS,
        signals={"s": signal("6", 2.5, -4.0 * DE, "206", "de", "-")},
        objects={"s": stop_line("8", 1.0, 1.75, "-")},
        speed=50,
    )
    way = stop.route("s", "n", 100, 100)
    ring = Cross(DE, ARMS, ring=17.0, speed=50)
    zebra, over = simple(DE, [(420.0, 0.0)], kind="town", speed=50, verge="sidewalk", objects=crossing("5", 200, 7))
    return [
        Drive(
            "de_stop_rolls",
            stop.text(),
            [ego(track(way, 22, 20, 11, [(3, -1.5), (8, 0), (11, 1.2), (15, 0)]))],
            expect=[
                ("stvo.rin1", "fail", "rolls over the stop line at 3.5 m/s"),
                ("ukhc.r171.stop-sign", "fail", "never stands"),
            ],
        ),
        Drive(
            "de_stop_good",
            stop.text(),
            [ego(track(way, 26, 20, 11, [(2, -1.112), (14, 1.5), (19, 0)]))],
            expect=[
                ("stvo.rin1", "pass", "stands for two seconds close before the line"),
                ("ukhc.r171.stop-sign", "pass", "stands"),
            ],
        ),
        Drive(
            "de_ring_wrong_way",
            ring.text(),
            [
                ego(
                    track(
                        Cross(-DE, ARMS, ring=17.0).route("s", "n", 80, 80),
                        26,
                        5,
                        9.0,
                        [(3, -1.0), (6, 0)],
                        [(0, -3.5), (5, -3.5), (8, 0)],
                    )
                )
            ],
            expect=[("ukhc.r143.direction", "fail", "turns left into the roundabout, clockwise against its traffic")],
        ),
        Drive(
            "de_ring_good",
            ring.text(),
            [
                ego(track(ring.route("s", "w", 80, 80), 40, 5, 10, [(3, -1.2), (7, 0), (26, 1), (29, 0)])),
                actor("c", "bicycle", track(ring.route("e", "w", 80, 80), 40, -30, 5.0)),
            ],
            expect=[
                ("ukhc.r143.direction", "pass", "round it as it should be"),
                ("ukhc.no-collision", "pass", "alone"),
                ("stvo.rg3", "pass", "36 km/h"),
            ],
        ),
        Drive(
            "de_zebra",
            zebra,
            [
                ego(track(over, 18, 60, 12, lat=near(DE))),
                actor("w", "pedestrian", turned(track(line(200.3, -7, np.pi / 2), 18, -11.0, 1.3))),
            ],
            expect=[
                (
                    "ukhc.r195.zebra-on",
                    "fail",
                    "somebody walks on the ego's half of the zebra as its front comes onto it",
                ),
                ("ukhc.no-collision", "fail", "and is hit"),
            ],
        ),
    ]
