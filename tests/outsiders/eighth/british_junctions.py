"""Great Britain: lights, stop signs and turning."""

from __future__ import annotations

import math

from tests.outsiders.eighth.drive import Drive, draw
from tests.outsiders.eighth.junctions import crossroads, cut_corner, second_head, through
from tests.outsiders.eighth.movement import car, ego, who
from tests.outsiders.eighth.ways import line


def british_junctions() -> list[Drive]:
    return [
        draw(
            "gb_red_two_seconds_j",
            "The ego drives over the stop line nearly three seconds after the light turned red.",
            "fail r175.red",
            crossroads(lights=True),
            [
                ego(through(180, 0), 50, 11),
            ],
            25,
            lights={
                "l180": [(0, "green"), (3, "amber"), (6, "red")],
                "l0": [(0, "green"), (3, "amber"), (6, "red")],
                "l90": [(0, "red")],
                "l270": [(0, "red")],
            },
        ),
        draw(
            "gb_red_amber_jump_j",
            "The ego stops at a red light and moves off before it is green.",
            "fail r175.red",
            crossroads(lights=True),
            [
                ego(through(180, 0), 63, [(0, 10), (4, 10), (12.5, 0), (15, 0), (17, 7)]),
            ],
            30,
            lights={
                "l180": [(0, "red"), (17.9, "red_amber"), (20.4, "green")],
                "l0": [(0, "red"), (17.9, "red_amber"), (20.4, "green")],
                "l90": [(0, "red")],
                "l270": [(0, "red")],
            },
        ),
        draw(
            "gb_red_waits_green_j",
            "The ego waits for green and lets the cross traffic pass.",
            "pass r175.red no-collision",
            crossroads(lights=True),
            [
                ego(through(180, 0), 64, [(0, 10), (4, 10), (12.3, 0), (20.4, 0), (23.5, 8)]),
                car("x", through(90, 270), 60, 10),
            ],
            35,
            lights={
                "l180": [(0, "red"), (18, "red_amber"), (20, "green")],
                "l0": [(0, "red"), (18, "red_amber"), (20, "green")],
                "l90": [(0, "green"), (15, "amber"), (18, "red")],
                "l270": [(0, "green"), (15, "amber"), (18, "red")],
            },
        ),
        draw(
            "gb_two_heads_disagree_j",
            "The ego's lane has two heads, one green and one red.",
            "not pass r175.red",
            second_head(crossroads(lights=True)),
            [
                ego(through(180, 0), 50, 11),
            ],
            25,
            lights={
                "l180": [(0, "green")],
                "l0": [(0, "green")],
                "l90": [(0, "red")],
                "l270": [(0, "red")],
                "extra": [(0, "red")],
            },
        ),
        draw(
            "gb_tbone_j",
            "The ego has green and is hit by a car that runs its red light.",
            "fail no-collision | pass r175.red",
            crossroads(lights=True),
            [
                ego(through(180, 0), 50, 11),
                car("x", through(90, 270), 57, 10, there=(0, 12)),
            ],
            20,
            lights={"l180": [(0, "green")], "l0": [(0, "green")], "l90": [(0, "red")], "l270": [(0, "red")]},
        ),
        draw(
            "gb_blocks_junction_j",
            "The ego enters on green and stands in the junction behind a lorry for ten seconds.",
            "fail r176.green-exit-clear",
            crossroads(lights=True),
            [
                ego(through(180, 0), 60, [(0, 9), (9, 9), (12, 0), (24, 0), (27, 7)]),
                who("q", "truck", through(180, 0), 106, [(0, 8), (6, 8), (10, 0), (23, 0), (26, 7)]),
            ],
            35,
            lights={"l180": [(0, "green")], "l0": [(0, "green")], "l90": [(0, "red")], "l270": [(0, "red")]},
        ),
        draw(
            "gb_side_road_blocked_j",
            "The ego stands in a junction without lights behind a lorry for ten seconds.",
            "fail r151.side-roads-clear",
            crossroads(),
            [
                ego(through(180, 0), 60, [(0, 9), (9, 9), (12, 0), (24, 0), (27, 7)]),
                who("q", "truck", through(180, 0), 106, [(0, 8), (6, 8), (10, 0), (23, 0), (26, 7)]),
            ],
            35,
        ),
        draw(
            "gb_stop_rolled_j",
            "The ego rolls over the line of a stop sign at 2.5 m/s.",
            "fail r171.stop-sign",
            crossroads(stop=True),
            [
                ego(through(180, 0), 60, [(0, 10), (6, 10), (10, 2.5), (12, 2.5), (16, 9)]),
            ],
            25,
        ),
        draw(
            "gb_stop_halts_j",
            "The ego stands 1.6 m before the line of a stop sign for two seconds.",
            "pass r171.stop-sign",
            crossroads(stop=True),
            [
                ego(through(180, 0), 62.7, [(0, 10), (4, 10), (12.4, 0), (15, 0), (19, 7)]),
            ],
            30,
        ),
        draw(
            "gb_stop_far_short_j",
            "The ego halts 25 m before the line of a stop sign and drives over it at 7 m/s.",
            "not pass r171.stop-sign",
            crossroads(stop=True),
            [
                ego(through(180, 0), 40, [(0, 10), (4, 10), (12, 0), (14, 0), (17, 7), (27, 7)]),
            ],
            30,
        ),
        draw(
            "gb_right_turn_short_j",
            "The ego turns right less than a second before the oncoming car.",
            "fail r180.right-turn-gap criticality.pet",
            crossroads(),
            [
                ego(through(180, 270), 50, [(0, 10), (8, 10), (11, 5)], blink=[(0, "off"), (4, "right"), (18, "off")]),
                car("on", through(0, 180), 36, 9),
            ],
            25,
        ),
        draw(
            "gb_right_turn_forced_j",
            "The ego turns right and makes the oncoming car brake hard.",
            "fail r180.right-turn-gap | pass no-collision",
            crossroads(),
            [
                ego(through(180, 270), 50, [(0, 10), (8, 10), (11, 5)], blink=[(0, "off"), (4, "right"), (18, "off")]),
                car("on", through(0, 180), 27, [(0, 11), (9.6, 11), (12.2, 2), (14, 2), (16, 9)]),
            ],
            25,
        ),
        draw(
            "gb_right_turn_waits_j",
            "The ego lets the oncoming car pass before it turns right.",
            "not fail r180.right-turn-gap | pass no-collision",
            crossroads(),
            [
                ego(
                    through(180, 270),
                    50,
                    [(0, 10), (6, 10), (14, 0), (16.5, 0), (19, 5)],
                    blink=[(0, "off"), (4, "right"), (24, "off")],
                ),
                car("on", through(0, 180), 50, 9),
            ],
            30,
        ),
        draw(
            "gb_right_turn_moto_null_j",
            "The ego turns right a second before somebody of unknown class, whom the log has from 8 s on.",
            "not pass r180.right-turn-gap",
            crossroads(),
            [
                ego(through(180, 270), 50, [(0, 10), (8, 10), (11, 5)], blink=[(0, "off"), (4, "right"), (18, "off")]),
                who("on", None, through(0, 180), 36, 9, size=(2.1, 0.8, None), there=(8, math.inf)),
            ],
            25,
        ),
        draw(
            "gb_corner_cut_j",
            "The ego turns right and enters the side road on its wrong side.",
            "fail r180.corner-cut",
            crossroads(),
            [
                ego(cut_corner(), 60, [(0, 9), (7, 9), (10, 5)], blink=[(0, "off"), (3, "right"), (18, "off")]),
            ],
            25,
        ),
        draw(
            "gb_left_hook_j",
            "The ego passes a cyclist and turns left across their way a second before they come.",
            "fail h3.no-cut-across r182.no-pass-before-turn",
            crossroads(),
            [
                ego(
                    through(180, 90),
                    50,
                    [(0, 10), (7, 10), (9.5, 6)],
                    [(2, 0), (4, -1.9), (8.2, -1.9), (10.4, 0)],
                    blink=[(0, "off"), (6, "left"), (18, "off")],
                ),
                who("c", "bicycle", through(180, 0), 86, 5, 1.2),
            ],
            25,
        ),
        draw(
            "gb_left_turn_behind_cyclist_j",
            "The ego stays behind a cyclist and turns left after them.",
            "not fail h3.no-cut-across r182.no-pass-before-turn",
            crossroads(),
            [
                ego(
                    through(180, 90),
                    50,
                    [(0, 10), (4, 10), (7, 4.5), (25, 4.5)],
                    blink=[(0, "off"), (8, "left"), (24, "off")],
                ),
                who("c", "bicycle", through(180, 0), 95, 5, 1.2),
            ],
            30,
        ),
        draw(
            "gb_right_turn_oncoming_rider_j",
            "The ego turns right a second before an oncoming cyclist.",
            "not pass h3.no-cut-across r180.right-turn-gap",
            crossroads(),
            [
                ego(through(180, 270), 50, [(0, 10), (8, 10), (11, 5)], blink=[(0, "off"), (4, "right"), (18, "off")]),
                who("c", "bicycle", through(0, 180), 89, 5.2, 0.9),
            ],
            25,
        ),
        draw(
            "gb_turn_before_walker_j",
            "The ego turns left a second before somebody who is crossing the side road.",
            "fail h2.turn-pedestrian",
            crossroads(),
            [
                ego(through(180, 90), 50, [(0, 10), (7, 10), (9.5, 6)], blink=[(0, "off"), (6, "left"), (18, "off")]),
                who("p", "pedestrian", line((5, 20), (-6, 20)), 0, [(0, 0), (12.2, 0), (12.5, 1.3)]),
            ],
            25,
        ),
        draw(
            "gb_turn_waits_walker_j",
            "The ego turns left and waits until a pedestrian is across the side road.",
            "not fail h2.turn-pedestrian | pass no-collision",
            crossroads(),
            [
                ego(
                    through(180, 90),
                    50,
                    [(0, 10), (6, 10), (12, 3.5), (14, 3.5), (16, 0), (19, 0), (22, 6)],
                    blink=[(0, "off"), (6, "left"), (26, "off")],
                ),
                who("p", "pedestrian", line((-5, 24), (8, 24)), 0, [(0, 0), (9, 0), (9.2, 1.3)]),
            ],
            32,
        ),
        draw(
            "gb_left_turn_wide_j",
            "The ego turns left out to the far side of a wide lane.",
            "fail r183.keep-in",
            crossroads(wide=5.5),
            [
                ego(
                    through(180, 90, wide=5.5),
                    50,
                    [(0, 10), (7, 10), (9.5, 6)],
                    [(9, 0), (13.5, -1.5), (22, -1.5)],
                    blink=[(0, "off"), (6, "left"), (18, "off")],
                ),
            ],
            25,
        ),
        draw(
            "gb_unlit_cross_forced_j",
            "A motorcyclist brakes and goes behind the ego at a crossroads without signs.",
            "not fail no-collision",
            crossroads(),
            [
                ego(through(180, 0), 50, 9),
                who("x", "motorcycle", through(90, 270), 42, [(0, 10), (9, 10), (10.6, 3), (13, 3), (15, 9)]),
            ],
            22,
        ),
    ]
