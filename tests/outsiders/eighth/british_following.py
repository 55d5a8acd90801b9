"""Great Britain: following, queues, being overtaken."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.worlds import lane, straight


def british_following() -> list[Drive]:
    return [
        draw(
            "gb_tailgate_9m_j",
            "The ego follows a car 9 m behind it at 63 mph.",
            "fail r126.thinking-gap criticality.thw",
            Map((straight(1200, "dual"),)),
            [
                ego(lane(1), 60, 28),
                car("l", lane(1), 73.5, 28),
            ],
            25,
        ),
        draw(
            "gb_follow_2s_j",
            "The ego follows a car 65 m behind it at 60 mph.",
            "pass r126.thinking-gap criticality.thw",
            Map((straight(1200, "dual"),)),
            [
                ego(lane(1), 60, 27),
                car("l", lane(1), 130, 27),
            ],
            25,
        ),
        draw(
            "gb_tailgate_lead_turned_j",
            "The ego follows a car 9 m behind it at 63 mph; the car's heading is turned by pi.",
            "fail r126.thinking-gap",
            Map((straight(1200, "dual"),)),
            [
                ego(lane(1), 60, 28),
                car("l", lane(1), 73.5, 28, turned=True),
            ],
            25,
        ),
        draw(
            "gb_tailgate_lead_null_j",
            "The ego follows something of unknown class 9 m behind it at 63 mph.",
            "not pass r126.thinking-gap",
            Map((straight(1200, "dual"),)),
            [
                ego(lane(1), 60, 28),
                who("l", None, lane(1), 73.5, 28, size=(4.5, 1.8, None)),
            ],
            25,
        ),
        draw(
            "gb_tailgate_flicker_j",
            "The ego follows a car 9 m behind it; its track has a hole of 0.4 s each second.",
            "fail r126.thinking-gap",
            Map((straight(1200, "dual"),)),
            [
                ego(lane(1), 60, 28),
                car("l", lane(1), 73.5, 28, gaps=[(i + 0.35, i + 0.75) for i in range(25)]),
            ],
            25,
        ),
        draw(
            "gb_lead_teleports_j",
            "The car ahead jumps into the ego for 0.3 s and back: a fault of the recorder.",
            "not fail no-collision",
            Map((straight(1200, "dual"),)),
            [
                ego(lane(1), 60, 27),
                car("l", lane(1), 140, 27, jump=(9.0, 9.3, -77.0)),
            ],
            20,
        ),
        draw(
            "gb_cutin_no_drop_back_j",
            "A car moves in 9 m ahead, and the ego stays that near to it.",
            "fail r168.drop-back",
            Map((straight(1400, "dual"),)),
            [
                ego(lane(2), 60, 27),
                car("c", lane(1), 70, 27.4, [(4, 0), (7, 3.5)]),
            ],
            30,
            weather="dry",
        ),
        draw(
            "gb_cutin_drops_back_j",
            "A car moves in 10 m ahead and the ego drops back, but not far enough in ten seconds.",
            "fail r168.drop-back",
            Map((straight(1400, "dual"),)),
            [
                ego(lane(2), 60, [(0, 27), (7, 27), (10, 22.5), (30, 22.5)]),
                car("c", lane(1), 75, 27, [(4, 0), (7, 3.5)]),
            ],
            30,
            weather="dry",
        ),
        draw(
            "gb_accelerates_overtaken_j",
            "The ego speeds up while it is being overtaken.",
            "fail r168.when-overtaken",
            Map((straight(1400),)),
            [
                ego(lane(1), 100, [(0, 18), (6, 18), (12, 24.5), (25, 24.5)]),
                car(
                    "o",
                    lane(1),
                    60,
                    [(0, 18), (2, 22), (6, 23), (12, 26), (25, 26)],
                    [(2, 0), (4.5, -3.5), (18, -3.5), (20.5, 0)],
                ),
            ],
            25,
        ),
        draw(
            "gb_steady_overtaken_j",
            "The ego eases off while it is being overtaken.",
            "pass r168.when-overtaken",
            Map((straight(1400),)),
            [
                ego(lane(1), 100, [(0, 18), (8, 18), (12, 16), (25, 16)]),
                car("o", lane(1), 60, 25, [(2, 0), (4.5, -3.5), (11, -3.5), (14, 0)]),
            ],
            25,
        ),
    ]
