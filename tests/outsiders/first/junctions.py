"""Junctions and roundabouts."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tests.outsiders.first.chapter import Spec, scene
from tests.outsiders.first.maps import crossroads, roundabout
from tests.outsiders.first.movement import Speed, car, line, route, to_stop


def junctions() -> Iterator[Spec]:
    m, stop, plain = crossroads(1, "lights"), crossroads(1, "stop"), crossroads(1, "give way")
    go = [100, 110, 120, 130]

    def lights(ns: list[tuple[float, str]], ew: str = "red") -> dict[int, list[tuple[float, str]]]:
        return {110: ns, 130: ns, 100: [(0.0, ew)], 120: [(0.0, ew)]}

    through = route(m, "S SN N", 100, 200)
    yield scene(
        "red_light",
        "The ego drives through a light that has been red for ten seconds.",
        "fail r175.red",
        m,
        [car(through, 10.0)],
        20,
        lights=lights([(0.0, "red")]),
    )
    yield scene(
        "amber_too_late_to_stop",
        "The light turns amber when the ego is three metres from the line; it goes on.",
        "not fail r175.red",
        m,
        [car(through, 10.0)],
        20,
        lights=lights([(0.0, "green"), (9.3, "amber"), (12.3, "red")]),
    )
    yield scene(
        "red_and_amber",
        "The ego moves off on red with amber and is over the line before green.",
        "fail r175.red",
        m,
        [car(through, to_stop(9, 96.2, 2.0, 2.0, 8, 2.0))],
        26,
        lights=lights([(0.0, "red"), (14.9, "red_amber"), (18.5, "green")]),
    )
    yield scene(
        "red_light_not_logged",
        "The ego drives on red (says the camera), but the log lacks its light.",
        "not pass r175.red",
        m,
        [car(through, 10.0)],
        20,
        lights={k: [(0.0, "green")] for k in go[:1]},
    )
    held = [
        car(route(m, "S SN N", 60, 200), to_stop(8, 81, 2.0, 14.5, 6)),
        car(route(m, "S SN N", 40, 200), to_stop(8, 68, 2.0, 15.3, 8)),
    ]
    yield scene(
        "blocks_junction_on_green",
        "The ego follows a queue into the junction on green and stands in it for 14 s.",
        "fail r176.green-exit-clear",
        m,
        held,
        36,
        lights=lights([(0.0, "green")]),
    )
    waits = [car(route(m, "S SN N", 60, 200), to_stop(8, 56.5, 2.0, 17, 6)), held[1]]
    yield scene(
        "waits_before_junction_on_green",
        "The light is green but the exit is full: the ego waits at the line until it is clear.",
        "not fail r176.green-exit-clear r175.red performance.precise-stop",
        m,
        waits,
        38,
        lights=lights([(0.0, "green")]),
    )
    queue = [
        car(route(plain, "W WE E", 60, 200), to_stop(8, 81, 2.0, 14.5, 6)),
        car(route(plain, "W WE E", 40, 200), to_stop(8, 68, 2.0, 15.3, 8)),
    ]
    yield scene(
        "blocks_side_roads",
        "On the main road the ego stops in a queue across the side roads for 14 s.",
        "fail r151.side-roads-clear",
        plain,
        queue,
        36,
    )
    over = route(stop, "S SN N", 100, 200)
    yield scene(
        "stop_sign_rolled",
        "The ego rolls over the stop line at 3 m/s.",
        "fail r171.stop-sign",
        stop,
        [car(over, [(0, 10), (7, 10), (10.5, 3), (14, 3), (17, 8)])],
        24,
    )
    yield scene(
        "stop_sign_kept",
        "The ego stops 0.4 m before the stop line, waits, and goes.",
        "pass r171.stop-sign performance.precise-stop",
        stop,
        [car(over, to_stop(10, 96.35, 2.0, 3.5, 8))],
        28,
    )
    right = route(plain, "W WS S", 60, 150)
    yield scene(
        "right_turn_across",
        "The ego turns right in front of an oncoming car, which passes behind it within a second.",
        "fail r180.right-turn-gap criticality.pet | pass no-collision",
        plain,
        [car(right, 6.0), car(route(plain, "E EW W", 146, 100), 12.0)],
        20,
    )
    yield scene(
        "right_turn_waited",
        "The ego waits in the mouth for an oncoming car and turns right behind it.",
        "not fail r180.right-turn-gap r180.corner-cut criticality.pet r151.side-roads-clear",
        plain,
        [car(right, to_stop(8, 60, 2.0, 7.0, 5)), car(route(plain, "E EW W", 120, 240), 12.0, until=31.0)],
        34,
    )
    corner = line([(-60, 1.75), (-14, 1.75), (-4, -3), (-1.6, -12), (-1.0, -22), (1.75, -45), (1.75, -120)], 5.0)
    yield scene(
        "right_turn_cut",
        "The ego cuts the corner: it enters the side road on its wrong side.",
        "fail r180.corner-cut",
        plain,
        [car(corner, [(0, 8), (3, 8), (5, 4.5)])],
        24,
    )
    wide = line([(-60, 1.75), (-12, 1.75), (0, 3), (1.5, 10), (1.0, 25), (-1.75, 45), (-1.75, 120)], 4.5)
    yield scene(
        "left_turn_wide",
        "The ego turns left and swings over to the wrong side of the side road.",
        "fail r183.keep-in",
        plain,
        [car(wide, [(0, 8), (3, 8), (5, 4.5)])],
        24,
    )
    left, inner = route(plain, "W WN N", 60, 150), route(plain, "W WN N", 60, 150, 1.2)
    yield scene(
        "left_hook",
        "The ego passes a cyclist closely and turns left across them.",
        "fail h3.no-cut-across r182.no-pass-before-turn r163.cyclist",
        plain,
        [
            car(inner, [(0, 10), (4.2, 10), (6.2, 5.5)], lamps=[(0.0, "left")]),
            car(route(plain, "W WE E", 42, 150, 3.1), 5.0, "bicycle"),
        ],
        18,
    )
    yield scene(
        "left_behind_cyclist",
        "The ego stays behind a cyclist and turns left when they are past.",
        "not fail h3.no-cut-across r182.no-pass-before-turn r183.keep-in criticality.pet",
        plain,
        [car(left, 5.0, lamps=[(0.0, "left")]), car(route(plain, "W WE E", 45, 150, 3.0), 5.5, "bicycle")],
        24,
    )
    across = line([(6, 15), (-40, 15)], 0)
    yield scene(
        "turn_before_walker",
        "The ego turns left just in front of somebody who has begun to cross the side road.",
        "fail h2.turn-pedestrian | pass no-collision",
        plain,
        [car(left, [(0, 8), (3, 8), (4.5, 5)]), car(across, [(0, 0), (6.2, 0), (7.2, 0.8)], "pedestrian")],
        20,
    )
    ring = roundabout()
    calm: Speed = [(0, 9), (6, 9), (9, 5)]
    twice = "S inS ringS byW ringW byN ringN byE ringE byS ringS byW ringW outN N"
    yield scene(
        "roundabout_twice",
        "The ego goes once and a half round, with somebody behind and another waiting at an entry.",
        "not fail r143.direction r180.corner-cut r180.right-turn-gap r131.keep-in-lane no-collision r151.side-roads-clear",
        ring,
        [
            car(route(ring, twice, 80, 120), calm),
            car(route(ring, twice, 110, 120), calm),
            car(route(ring, "E inE ringE byS ringS outW W", 60, 120), to_stop(6, 54)),
        ],
        48,
    )
    turn = [(19.75 * math.cos(a), 19.75 * math.sin(a)) for a in np.radians(np.linspace(-78, -12, 30))]
    yield scene(
        "roundabout_wrong_way",
        "The ego turns right at the entry and drives round against the traffic.",
        "fail r143.direction",
        ring,
        [car(line([(-1.75, -120), (-1.75, -42), *turn, (42, 1.75), (160, 1.75)], 5.0), 6.0)],
        28,
    )
