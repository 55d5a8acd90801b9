"""Great Britain: crossings for those on foot."""

from __future__ import annotations

import numpy as np

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import actor, ego, line, track
from tests.outsiders.eleventh.places import near, says
from tests.outsiders.eleventh.road import GB, crossing, light, simple, stop_line


def british_crossings() -> list[Drive]:
    zebra, way = simple(GB, [(400.0, 0.0)], kind="town", speed=30, verge="sidewalk", objects=crossing("5", 200, 7))
    pelican, over = simple(
        GB,
        [(400.0, 0.0)],
        kind="town",
        speed=30,
        verge="sidewalk",
        signals=light("7", 195, 3.8) + light("77", 204, 3.8),
        objects=crossing("5", 200, 7, "pelican_signal") + stop_line("8", 195, 1.75),
    )
    return [
        Drive(
            "gb_zebra_good",
            zebra,
            [
                ego(track(way, 30, 109, 12, [(3, -1.6), (10.5, 0), (16, 1.5), (22, 0)], near(GB))),
                actor("w", "pedestrian", track(line(200, 7, -np.pi / 2), 30, -4, 1.3)),
            ],
            expect=[
                ("ukhc.r195.zebra-on", "pass", "waits until the walker is over"),
                ("ukhc.no-collision", "pass", "clear"),
                ("ukhc.r191.no-stopping", "not fail", "never stands on it"),
            ],
        ),
        Drive(
            "gb_zebra_parked",
            zebra,
            [ego(track(way, 34, 110, 11, [(3, -1.075), (13.3, 0), (28, 1.5)], near(GB), hz=5))],
            expect=[("ukhc.r191.no-stopping", "fail", "stands on the zebra for 14 s, for nobody")],
        ),
        Drive(
            "gb_pelican_red",
            pelican,
            [
                ego(track(over, 20, 90, 11.5, lat=near(GB))),
                actor("w", "pedestrian", track(line(200, 7, -np.pi / 2), 20, -13, 1.3)),
            ],
            lights=says("7", 20, (0, "amber"), (1.5, "red")) + says("77", 20, (0, "amber"), (1.5, "red")),
            expect=[
                ("ukhc.r196.pelican", "fail", "goes onto the crossing on red"),
                ("ukhc.r175.red", "fail", "over its line on red"),
            ],
        ),
    ]
