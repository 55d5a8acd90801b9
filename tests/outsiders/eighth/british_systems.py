"""Great Britain: automated driving and comfort."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.ways import line
from tests.outsiders.eighth.worlds import lane, straight


def british_systems() -> list[Drive]:
    return [
        draw(
            "gb_alks_close_j",
            "An automated ego follows 11.5 m behind a car at 30 mph.",
            "fail alks-r157.follow-gap",
            Map((straight(1400, "motorway", lanes=3),)),
            [
                ego(lane(2), 60, 13.5),
                car("l", lane(2), 76, 13.5),
            ],
            30,
            engaged="yes",
        ),
        draw(
            "gb_r79_late_signal_j",
            "An automated ego crosses the line 1.4 s after its signal.",
            "fail alks-r157.r79.lane-change | pass alks-r157.r79.lane-change-done",
            Map((straight(1400, "motorway", lanes=3),)),
            [
                ego(lane(3), 60, 26, [(8, 0), (11, -3.5)], blink=[(0, "off"), (7.6, "right"), (12, "off")]),
            ],
            25,
            engaged="yes",
        ),
        draw(
            "gb_r79_drift_j",
            "An automated ego takes more than five seconds to cross the line.",
            "fail alks-r157.r79.lane-change-done",
            Map((straight(1400, "motorway", lanes=3),)),
            [
                ego(lane(3), 60, 26, [(6, 0), (21, -3.5)], blink=[(0, "off"), (6.5, "right"), (22, "off")]),
            ],
            30,
            engaged="yes",
        ),
        draw(
            "gb_hard_start_j",
            "The ego speeds up with 4.5 m/s2.",
            "fail comfort.accel-iso15622 comfort.nuplan",
            Map((straight(900, "dual"),)),
            [
                ego(lane(2), 40, [(0, 6), (4, 6), (8, 24), (20, 24)]),
            ],
            20,
        ),
        draw(
            "gb_slalom_j",
            "The ego swerves with up to 5 m/s2 to the side.",
            "fail comfort.lateral",
            Map((straight(900, "dual"),)),
            [
                ego(lane(2), 40, 27, [(5, 0), (6.3, -1.7), (7.6, 0), (8.9, -1.7), (10.2, 0)]),
            ],
            22,
        ),
        draw(
            "gb_emergency_brake_deer_j",
            "An automated ego declares an emergency manoeuvre and stops before a deer.",
            "pass no-collision alks-r157.emergency | fail comfort.decel-iso15622",
            Map((straight(900),)),
            [
                ego(lane(1), 40, [(0, 22), (8, 22), (11, 1), (13, 0), (20, 0)]),
                who(
                    "deer",
                    "animal",
                    line((255, 9), (255, -14)),
                    0,
                    [(0, 0), (7.4, 0), (7.8, 3.5)],
                    size=(1.7, 0.5, 1.3),
                ),
            ],
            20,
            events=[
                (0, "emergency_manoeuvre", "off"),
                (8, "emergency_manoeuvre", "on"),
                (12.5, "emergency_manoeuvre", "off"),
            ],
            engaged="yes",
        ),
    ]
