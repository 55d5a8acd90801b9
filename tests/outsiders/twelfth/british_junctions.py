"""Great Britain: crossroads and roundabouts."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.twelfth.cast import (
    ALL,
    GB,
    GREEN,
    ego,
)
from tests.outsiders.twelfth.drive import Actor, Drive, draw
from tests.outsiders.twelfth.junction import Cross, Ring
from tests.outsiders.twelfth.road import light
from tests.outsiders.twelfth.ways import Along, Path, Walk


def british_junctions() -> Iterator[Drive]:
    c = Cross(True, lights=ALL, tf=(12, 7, 12))
    yield draw(
        "gb_red_run",
        c.map,
        [ego(c.drive(0, 2, 60, 12)), Actor("x", "car", c.drive(3, 1, 20, [(0, 10), (6, 10), (10, 0)]))],
        GB,
        15,
        [("ukhc.r175.red", "fail", "over the line at 7 s, red since 3 s")],
        lights={
            "L0": [(0, "green"), (1, "amber"), (3, "red")],
            "L2": [(0, "green"), (1, "amber"), (3, "red")],
            "L1": [(0, "red"), (5, "green")],
            "L3": [(0, "red"), (5, "green")],
        },
    )
    c = Cross(True, lights=ALL, tf=(0, 0, 45))
    yield draw(
        "gb_red_amber_start",
        c.map,
        [ego(c.drive(0, 3, 145.6, [(0, 0), (6, 0), (9, 5)]), ind=[(0, "left")])],
        GB,
        16,
        [("ukhc.r175.red", "fail", "moves off over the line on red with amber")],
        lights={
            "L0": [(0, "red"), (5.5, "red_amber"), (11, "green")],
            "L1": [(0, "green"), (4, "red")],
            "L2": [(0, "red"), (11, "green")],
            "L3": [(0, "green"), (4, "red")],
        },
    )
    c = Cross(True, lights=ALL)
    c.map.roads[0].signals.append(light("L0b", 1.2, 4.0, "-", "traffic_light_0b", -1))
    yield draw(
        "gb_two_heads_disagree",
        c.map,
        [ego(c.drive(0, 2, 60, 11))],
        GB,
        15,
        [("ukhc.r175.red", "not pass", "one head says red, the other, for the same lane and line, green")],
        lights={"L0": [(0, "red")], "L0b": [(0, "green")], "L1": [(0, "red")], "L2": [(0, "red")], "L3": [(0, "red")]},
    )
    c = Cross(True, lights=ALL)
    yield draw(
        "gb_queue_beyond_green",
        c.map,
        [
            ego(c.drive(0, 2, 100, [(0, 9), (6.4, 9), (10, 0), (24, 0), (27, 6)])),
            Actor("q1", "bus", c.drive(0, 2, 186, [(0, 0), (23, 0), (27, 6)])),
            Actor("q2", "car", c.drive(0, 2, 197, [(0, 0), (21, 0), (25, 6)])),
        ],
        GB,
        30,
        [
            (
                "ukhc.r176.green-exit-clear",
                "fail",
                "goes in on green behind a bus that stands, stands 14 s in the middle",
            ),
            ("ukhc.r175.red", "pass", "green"),
        ],
        lights=GREEN,
    )
    c = Cross(True)
    yield draw(
        "gb_side_road_blocked",
        c.map,
        [
            ego(c.drive(0, 2, 100, [(0, 9), (6.2, 9), (9.6, 0), (22, 0), (25, 6)])),
            Actor("q1", "car", c.drive(0, 2, 181.5, [(0, 0), (21, 0), (25, 6)])),
            Actor("side", "van", c.drive(3, 1, 120, [(0, 6), (4, 0.0)])),
        ],
        GB,
        28,
        [("ukhc.r151.side-roads-clear", "fail", "stands 12 s in the junction behind a queue, a van wants across")],
    )
    c = Cross(True, lights=ALL)
    yield draw(
        "gb_right_turn_forced",
        c.map,
        [
            ego(c.drive(0, 1, 100, [(0, 7), (5, 7), (7, 6)]), ind=[(0, "right")]),
            Actor("o", "van", c.drive(2, 0, 58, 10)),
        ],
        GB,
        18,
        [
            ("ukhc.r180.right-turn-gap", "fail", "turns before an oncoming van that is there about a second later"),
            ("ukhc.r175.red", "pass", "green"),
        ],
        lights=GREEN,
    )
    c = Cross(True, arms=(0, 1, 2))
    yield draw(
        "gb_corner_cut",
        c.map,
        [
            ego(
                Along(
                    Path(164, -1.75, 180).fwd(150.8).arc(12.0, -90).fwd(150),
                    60,
                    [(0, 8), (9, 8), (11, 5)],
                    moves=[(17.5, 3, 2.95)],
                ),
                ind=[(0, "right")],
            )
        ],
        GB,
        26,
        [("ukhc.r180.corner-cut", "fail", "comes out of the right turn wholly on the wrong side of the side road")],
    )
    c = Cross(True, w=4.6, foot=1.5)
    yield draw(
        "gb_left_turn_wide",
        c.map,
        [ego(c.drive(0, 3, 90, [(0, 8), (6, 8), (8, 5)], off=-0.9), ind=[(0, "left")])],
        GB,
        22,
        [("ukhc.r183.keep-in", "fail", "2.3 m between it and the near edge after the left turn, nobody there")],
    )
    c = Cross(True, foot=2.0, lights=ALL)
    yield draw(
        "gb_left_hook",
        c.map,
        [
            ego(c.drive(0, 3, 90, [(0, 7), (7, 7), (8.5, 5)], off=-0.6), ind=[(0, "left")]),
            Actor("b", "bicycle", c.drive(0, 2, 106, [(0, 4.5), (8.8, 4.5), (10.3, 0.0), (13, 0)], off=1.35)),
        ],
        GB,
        20,
        [
            ("ukhc.h3.no-cut-across", "fail", "turns left across a cyclist going ahead who brakes with 3 m/s2"),
            ("ukhc.r182.no-pass-before-turn", "fail", "got past the cyclist 2 s before the turn"),
        ],
        lights=GREEN,
    )
    c = Cross(True)
    yield draw(
        "gb_turn_onto_walker",
        c.map,
        [
            ego(c.drive(0, 3, 100, 5.5), ind=[(0, "left")]),
            Actor("p", "pedestrian", Walk([(0, -4.5, -18), (10.6, -4.5, -18), (17.8, 4.9, -18), (30, 14, -18)])),
        ],
        GB,
        22,
        [
            (
                "ukhc.h2.turn-pedestrian",
                "fail",
                "turns left just before somebody who walks across the side road, half a second to spare",
            )
        ],
    )
    c = Cross(True)
    yield draw(
        "gb_turn_lets_walker",
        c.map,
        [
            ego(c.drive(0, 3, 100, [(0, 7), (5, 7), (8.5, 0), (17, 0), (20, 5)]), ind=[(0, "left")]),
            Actor("p", "pedestrian", Walk([(0, -4.5, -18), (7, -4.5, -18), (14.2, 4.9, -18), (30, 14, -18)])),
        ],
        GB,
        30,
        [("ukhc.h2.turn-pedestrian", "not fail", "waits until the walker is across")],
    )
    c = Cross(True, stops=(0,), tf=(60, 60, 160))
    yield draw(
        "gb_stop_rolled",
        c.map,
        [ego(c.drive(0, 2, 84, [(0, 9), (5, 9), (8, 3), (9.5, 3), (12, 9)]))],
        GB,
        18,
        [
            ("ukhc.r171.stop-sign", "fail", "rolls over the line at 3 m/s"),
            ("performance.precise-stop", "not fail", "it did not stop"),
        ],
    )
    c = Cross(True, stops=(0,))
    yield draw(
        "gb_stop_kept",
        c.map,
        [ego(c.drive(0, 3, 86, [(0, 9), (5, 9), (8.3333, 0), (11, 0), (15, 6)]), ind=[(0, "left")])],
        GB,
        22,
        [("ukhc.r171.stop-sign", "pass", "halts 0.3 m before the line"), ("performance.precise-stop", "pass", "0.3 m")],
    )
    c = Cross(True, stops=(0,))
    yield draw(
        "gb_stop_over_line",
        c.map,
        [ego(c.drive(0, 2, 88.0, [(0, 9), (5, 9), (8.3333, 0), (11, 0), (15, 8)]))],
        GB,
        22,
        [
            ("ukhc.r171.stop-sign", "fail", "comes to stand with its front 1.7 m over the line"),
            ("performance.precise-stop", "fail", "1.7 m over the line"),
        ],
    )
    r = Ring(True, tf=(3, 3, 31))
    yield draw(
        "gb_roundabout_wrong_way",
        r.map,
        [ego(Along(r.wrong(0, 2), 60, [(0, 8), (5, 8), (8, 5.5)]))],
        GB,
        26,
        [("ukhc.r143.direction", "fail", "goes round the roundabout anticlockwise, to the second exit")],
    )
    r = Ring(True, ring=18.0)
    yield draw(
        "gb_roundabout_third_exit",
        r.map,
        [
            ego(Along(r.route(0, 1), 60, [(0, 8), (5, 8), (8, 6)]), ind=[(0, "right"), (17, "left")]),
            Actor("o", "car", Along(r.route(2, 0), 20, [(0, 8), (9, 8), (12, 1), (16, 1), (20, 6)])),
        ],
        GB,
        30,
        [
            ("ukhc.r143.direction", "pass", "clockwise to the third exit"),
            ("ukhc.r145.off-road", "not fail", "stays on the road"),
        ],
    )
