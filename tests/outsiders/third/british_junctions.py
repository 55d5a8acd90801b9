"""Great Britain: crossroads and roundabouts."""

from __future__ import annotations

from tests.outsiders.third.cast import NEAR_BLINK
from tests.outsiders.third.crossroads import junction, through, wrong_way_round
from tests.outsiders.third.drive import Drive, draw
from tests.outsiders.third.movement import N, car, ego, who
from tests.outsiders.third.ways import line


def british_junctions() -> list[Drive]:
    red = {f"light_{arm}": [(0, "red" if arm in "WE" else "green")] for arm in "WNES"}
    green = {f"light_{arm}": [(0, "green" if arm in "WE" else "red")] for arm in "WNES"}
    turn_speed = [(0, 9), (4, 4.2), (10, 4.2), (13, 9)]
    ring = "roundabout"
    wrong = wrong_way_round()
    return [
        draw(
            "gb_red_light",
            "The ego drives across a junction on red, before a car that has green.",
            "fail r175.red | pass no-collision",
            junction(lights="WNES"),
            [ego(through("W", "ahead"), (5, -2), 11), car(through("S", "ahead"), (9, 10), 9)],
            12,
            lights=red,
        ),
        draw(
            "gb_green_light",
            "The ego drives across a junction on green.",
            "pass r175.red r176.green-exit-clear no-collision r143.direction",
            junction(lights="WNES"),
            [
                ego(through("W", "ahead"), (5, -2), 11),
                car(through("S", "ahead"), (5, -6), 0),
                car(through("E", "ahead"), (6, 0), 11, name="oncoming"),
            ],
            12,
            lights=green,
        ),
        draw(
            "gb_stop_sign_rolled",
            "The ego rolls past a stop sign at 8 mph.",
            "fail r171.stop-sign",
            junction(stop="SN"),
            [ego(through("S", "near"), (6, -1), [(0, 9), (5, 3.5), (9, 3.5), (12, 9)], blink=NEAR_BLINK)],
            14,
        ),
        draw(
            "gb_stop_sign_kept_3",
            "The ego stops at the line and goes on when a car has passed.",
            "pass r171.stop-sign performance.precise-stop no-collision",
            junction(stop="SN"),
            [
                ego(through("S", "near"), (6, -3.95), [(0, 9), (5, 0), (9, 0), (12, 4.5), (16, 8)], blink=NEAR_BLINK),
                car(through("E", "ahead"), (6, 0), 11),
            ],
            18,
        ),
        draw(
            "gb_turns_before_oncoming",
            "The ego turns right half a second before an oncoming car.",
            "fail r180.right-turn-gap criticality.pet",
            junction(),
            [
                ego(through("W", "far"), (5, 0), turn_speed, blink=((0.0, 8.0, "far"),)),
                car(through("E", "ahead"), (9.1, 11.6), 12),
            ],
            14,
        ),
        draw(
            "gb_waits_to_turn",
            "The ego waits in the middle of the junction for an oncoming car and turns right.",
            "pass r180.right-turn-gap r180.corner-cut no-collision | not fail r151.side-roads-clear",
            junction(),
            [
                ego(
                    through("W", "far"),
                    (6.5, 1),
                    [(0, 9), (5, 0), (9, 0), (12, 4.2), (18, 4.2)],
                    blink=((0.0, 15.0, "far"),),
                ),
                car(through("E", "ahead"), (7.5, 11.6), 12),
            ],
            27,
        ),
        draw(
            "gb_left_hook",
            "The ego overtakes a cyclist and turns left across its path.",
            "fail h3.no-cut-across r182.no-pass-before-turn r163.cyclist",
            junction(),
            [
                ego(through("W", "near"), (8, 5.35), [(0, 10), (4, 10), (7, 4.2)], 1.2, blink=((3.0, 11.0, "near"),)),
                who(
                    "cyclist",
                    "bicycle",
                    through("W", "ahead"),
                    (10.5, 4.2),
                    [(0, 5), (6.5, 5), (8.3, 1.5), (10.3, 1.5), (12, 4)],
                    3.1,
                ),
            ],
            14,
        ),
        draw(
            "gb_turns_before_walker",
            "The ego turns left close before somebody who is crossing the side road.",
            "fail h2.turn-pedestrian",
            junction(),
            [
                ego(through("W", "near"), (8, 5.35), [(0, 10), (4, 10), (7, 4.2)], blink=((3.0, 11.0, "near"),)),
                who("walker", "pedestrian", line(6, 13, 180), (12.1, 6.55), 1.4, 0),
            ],
            15,
        ),
        draw(
            "gb_roundabout",
            "The ego takes the third exit of a roundabout.",
            "not fail r143.direction criticality.pet r131.keep-in-lane | pass no-collision",
            junction(ring),
            [
                ego(
                    through("W", "far", ring),
                    (8, 0),
                    [(0, 10), (7, 4.8), (26, 4.8), (30, 9)],
                    blink=((2.0, 18.0, "far"), (18.0, 24.0, "near")),
                ),
                car(through("W", "far", ring), (2, 0), [(0, 4.8), (20, 4.8), (24, 9)], name="ahead"),
                car(through("S", "ahead", ring), (14, -6), [(0, 5), (4, 5), (8, 0), (17, 0), (20, 4.5)], name="waits"),
            ],
            30,
        ),
        draw(
            "gb_roundabout_wrong_way",
            "The ego turns right into a roundabout and goes round it the wrong way.",
            "fail r143.direction",
            junction(ring),
            [ego(wrong, (8, 0), [(0, 9), (6, 5.5), (30, 5.5)], [(4, N), (8, -1.75), (14, -1.75), (17, N)])],
            18,
        ),
    ]
