"""Great Britain: what the ego declares, lamps, horn and parking."""

from __future__ import annotations

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.movement import ego, who
from tests.outsiders.eighth.road import Map
from tests.outsiders.eighth.worlds import lane, straight


def british_declared() -> list[Drive]:
    return [
        draw(
            "gb_declared_speed_j",
            "The ego drives 3.5 m/s faster than the speed that it said it had chosen, with a reason.",
            "fail declared.r125.chosen-speed-kept | pass declared.r152.speed-reason",
            Map((straight(900),)),
            [
                ego(lane(1), 40, [(0, 15), (8, 15), (12, 19.5), (25, 19.5)]),
            ],
            25,
            events=[(0, "chosen_speed", "16.0; rain")],
        ),
        draw(
            "gb_declared_no_reason_j",
            "The ego declares a speed that it chose without a reason, and keeps below it.",
            "fail declared.r152.speed-reason | pass declared.r125.chosen-speed-kept",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 16),
            ],
            20,
            events=[(0, "chosen_speed", "18.0")],
        ),
        draw(
            "gb_declared_no_go_j",
            "The ego overtakes although it declared not to, with a confidence of 0.55 and no look over the shoulder.",
            "fail declared.r162.go-before-overtaking declared.r166.confidence-at-commit | not pass "
            "declared.r163.checks-before-pull-out",
            Map((straight(1600),)),
            [
                ego(
                    lane(1),
                    60,
                    22,
                    [(2.5, 0), (5, -3.5), (13.5, -3.5), (16, 0)],
                    blink=[(0, "off"), (1.5, "right"), (5, "off")],
                ),
                who("slow", "truck", lane(1), 170, 12),
            ],
            30,
            events=[(0.5, "mirror_check", "right"), (1, "overtake_no_go", None), (1.2, "confidence", "0.55")],
            weather="dry",
        ),
        draw(
            "gb_declared_signal_first_j",
            "The ego signals, and looks into the right mirror and over the shoulder a second later.",
            "fail declared.r161.mirrors-before-signal | pass declared.r163.checks-before-pull-out",
            Map((straight(900, "dual"),)),
            [
                ego(lane(2), 40, 24, [(10, 0), (14, -3.5)], blink=[(0, "off"), (8, "right"), (15, "off")]),
            ],
            25,
            events=[(1, "mirror_check", "left"), (9, "mirror_check", "right"), (9.6, "blind_spot_check", "right")],
        ),
        draw(
            "gb_declared_reverse_j",
            "The ego reverses; it looked into its mirrors nine seconds before and not over the shoulder.",
            "not pass declared.r202.checks-before-reversing",
            Map((straight(400, "town"),)),
            [
                ego(lane(1), 120, [(0, 0), (10, 0), (12, -1.5), (18, -1.5), (19, 0)]),
            ],
            22,
            events=[(1, "mirror_check", None)],
        ),
        draw(
            "gb_night_dark_j",
            "The ego drives at night on a road of 60 mph with its headlights off.",
            "fail r113.headlights",
            Map((straight(900),)),
            [
                ego(lane(1), 40, 20),
            ],
            20,
            events=[(0, "headlights", "off")],
            light="night",
        ),
        draw(
            "gb_night_town_off_late_j",
            "The ego switches its headlights off at night in a town.",
            "fail r115.dipped-headlights | not fail r113.headlights",
            Map((straight(900, "town"),)),
            [
                ego(lane(1), 40, 11),
            ],
            20,
            events=[(0, "headlights", "on"), (9, "headlights", "off")],
            light="night",
        ),
        draw(
            "gb_horn_standing_j",
            "The ego sounds its horn while it stands alone in the street.",
            "fail r112.horn",
            Map((straight(500, "town"),)),
            [
                ego(lane(1), 40, [(0, 10), (5, 10), (10, 0), (19, 0), (22, 6)]),
            ],
            25,
            events=[(0, "horn", "off"), (14, "horn", "on"), (15, "horn", "off")],
        ),
        draw(
            "gb_parked_facing_night_j",
            "The ego stands for 69 s at night on the wrong side, facing the traffic.",
            "fail r239.parked-with-traffic r248.parked-at-night",
            Map((straight(500, "town"),)),
            [
                ego(lane(-1), 40, [(0, 4), (2, 4), (5, 0), (80, 0)]),
            ],
            74,
            rate=5,
            events=[(0, "headlights", "on")],
            light="night",
        ),
    ]
