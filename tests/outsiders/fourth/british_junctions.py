"""Great Britain: crossroads."""

from __future__ import annotations

import math

from tests.outsiders.fourth.drive import Drive
from tests.outsiders.fourth.faults import lost
from tests.outsiders.fourth.movement import MPH, Actor, east, ego, slow, walker, way, west
from tests.outsiders.fourth.places import L
from tests.outsiders.fourth.worlds import crossroads


def british_junctions() -> list[Drive]:
    stop = crossroads(30 * MPH, "wes", "stop")
    give_way = crossroads(30 * MPH, "wesn", "give_way")
    lit = crossroads(30 * MPH, "wesn", lights=True)
    near_turn, far_turn = (10.25 * math.pi / 2, -1 / 10.25), (13.75 * math.pi / 2, 1 / 13.75)
    left = way(-112, L, bends=((100, 0), near_turn))  # to the near side
    hook = way(-112, L, bends=((100, 0), near_turn), shifts=((15, 40, 0.9), (80, 100, -0.9)))
    right = way(-112, L, bends=((100, 0), far_turn))  # across the oncoming traffic
    cut = way(-112, L, bends=((95, 0), (15.5 * math.pi / 2, 1 / 15.5)), shifts=((122, 142, -3.25),))
    roll = [*slow(83, 11.0, 3.0, 2.0), 2.0, (10.0, 2.0)]
    into = slow(100, 11.0, 5.0, 1.5)  # down to turning speed where the turn begins
    turner = ego(left, 11.0, *into, lamp=((2.0, 14.0, "near"),))
    crosser = ego(right, 11.0, *into, lamp=((2.0, 14.0, "far"),))
    meets = crosser.when(100 + 11.0)  # when the ego is in the middle of the oncoming lane
    leaves = turner.when(116.1 + 4)  # when the ego goes over the walkers' way across the side road
    waits = [*slow(98, 11.0, 0.0, 2.0), 6.0, (5.0, 1.5)]
    return [
        Drive(
            "gb_stop_rolled_at_2hz",
            "A driver rolls over the line of a stop sign at 3 m/s; two steps a second are logged.",
            "fail r171.stop-sign",
            stop,
            [ego(way(1.75, -100, math.pi / 2, bends=((88, 0), near_turn)), 11.0, *roll, lamp=((2.0, 14.0, "near"),))],
            rate=2.0,
        ),
        Drive(
            "gb_stop_kept",
            "A driver halts 0.3 m before the line of a stop sign, and then turns out of the side road.",
            "pass r171.stop-sign performance.precise-stop | not fail r183.keep-in",
            stop,
            [
                ego(
                    way(1.75, -100, math.pi / 2, bends=((88, 0), near_turn)),
                    11.0,
                    *slow(84.3, 11.0, 0.0, 2.0),
                    4.0,
                    (5.0, 1.5),
                    lamp=((2.0, 20.0, "near"),),
                )
            ],
            26.0,
        ),
        Drive(
            "gb_stop_rolled_track_lost",
            "A driver rolls over a stop line; the ego's own track has a hole of 3 s there.",
            "not pass r171.stop-sign",
            stop,
            [ego(way(1.75, -100, math.pi / 2, bends=((88, 0), near_turn)), 11.0, *roll)],
            22.0,
            faults=[lost("ego", 9.5, 12.5)],
        ),
        Drive(
            "gb_red",
            "A driver goes over the line on a light that has been red for 9 s.",
            "fail r175.red",
            lit,
            [ego(way(-112, L), 11.0)],
            18.0,
            lights={f"light_{arm}": [(0.0, "red" if arm in "we" else "green")] for arm in "wesn"},
        ),
        Drive(
            "gb_red_states_missing",
            "A driver goes over the line of a light whose states are not in the log.",
            "not pass r175.red",
            lit,
            [ego(way(-112, L), 11.0)],
            18.0,
        ),
        Drive(
            "gb_amber_then_red",
            "The light turns amber 1.2 s before the line and red when the car is across.",
            "not fail r175.red",
            lit,
            [ego(way(-112, L), 11.0)],
            18.0,
            lights={
                f"light_{arm}": [(0.0, "green"), (7.6, "amber"), (10.6, "red")] if arm in "we" else [(0.0, "red")]
                for arm in "wesn"
            },
        ),
        Drive(
            "gb_green_exit_blocked",
            "On green a driver enters behind a queue and stands in the middle for 12 s.",
            "fail r176.green-exit-clear | pass r175.red",
            lit,
            [
                ego(way(-112, L), 9.0, *slow(116, 9.0, 0.0, 1.5), 12.0, (8.0, 1.5)),
                east("queue1", "car", 11.0, L, 0.0, 25.0, (8.0, 1.5)),
                east("queue2", "car", 17.5, L, 0.0, 24.0, (8.0, 1.5)),
            ],
            36.0,
            lights={f"light_{arm}": [(0.0, "green" if arm in "we" else "red")] for arm in "wesn"},
        ),
        Drive(
            "gb_right_turn_cuts_corner",
            "Turning right, a driver ends on the wrong side of the road that it enters.",
            "fail r180.corner-cut",
            give_way,
            [ego(cut, 11.0, *slow(95, 11.0, 5.0, 1.5), lamp=((2.0, 16.0, "far"),))],
        ),
        Drive(
            "gb_right_turn_before_oncoming_4",
            "A driver turns right and the oncoming car is there a second later.",
            "fail r180.right-turn-gap | pass r180.corner-cut no-collision",
            give_way,
            [crosser, west("oncoming", "car", 5.0 + 13 * (meets + 1.4), -L, 13.0)],
        ),
        Drive(
            "gb_right_turn_waits",
            "A driver waits for an oncoming car, and then turns right.",
            "not fail r180.right-turn-gap | pass r180.corner-cut no-collision",
            give_way,
            [ego(right, 11.0, *waits, lamp=((2.0, 25.0, "far"),)), west("oncoming", "car", 160, -L, 12.0)],
            28.0,
        ),
        Drive(
            "gb_right_turn_oncoming_flickers",
            "A driver turns right before an oncoming car that the log loses for 2 s.",
            "not pass r180.right-turn-gap",
            give_way,
            [crosser, west("oncoming", "car", 5.0 + 13 * (meets + 1.4), -L, 13.0)],
            faults=[lost("oncoming", meets - 0.5, meets + 2.5)],
        ),
        Drive(
            "gb_left_hook_4",
            "A driver overtakes a cyclist and turns left right in front, so that the cyclist must brake.",
            "fail h3.no-cut-across r182.no-pass-before-turn | pass no-collision",
            give_way,
            [
                ego(hook, 11.0, *into, lamp=((2.0, 14.0, "near"),)),
                Actor(
                    "cyclist", "bicycle", way(-70.5, -3.1), 5.0, (turner.when(99.0) - 0.6, (1.0, 4.0), 2.5, (5.0, 1.0))
                ),
            ],
        ),
        Drive(
            "gb_left_turn_cyclist_far_behind",
            "A driver turns left far ahead of a cyclist whose size is not logged.",
            "not fail h3.no-cut-across r182.no-pass-before-turn",
            give_way,
            [turner, east("cyclist", "bicycle", -112 - 5.0, -3.1, 5.0, size=(None, None, None))],
        ),
        Drive(
            "gb_left_turn_before_walker_4",
            "A driver turns left just before somebody who is walking across the side road.",
            "fail h2.turn-pedestrian | pass no-collision",
            give_way,
            [turner, walker(0.75 + 1.4 * leaves, -16.1, math.pi)],
        ),
    ]
