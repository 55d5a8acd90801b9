"""Great Britain: traffic lights and blocked junctions."""

from __future__ import annotations

from tests.outsiders.seventh.crossroads import Crossroads
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.movement import Actor, Pace, ego


def _red_two_heads() -> Drive:
    m = Crossroads()
    m.lit("w", "A", "B")
    return draw(
        "gb_red_two_heads_i",
        "Both heads are red when it drives through at 12 m/s.",
        "fail r175.red",
        m,
        [ego(m.way("w", "e"), Pace(12), start=20)],
        15,
        lights={"A": [(0, "amber"), (3, "red")], "B": [(0, "amber"), (3, "red")]},
    )


def _red_and_amber_start() -> Drive:
    m = Crossroads()
    m.lit("s", "A")
    return draw(
        "gb_red_and_amber_start_i",
        "It moves off over the line while the light shows red with amber.",
        "fail r175.red",
        m,
        [ego(m.way("s", "n"), Pace(0).hold(5.2).to(8, 2.5).hold(20), start=116)],
        16,
        lights={"A": [(0, "red"), (5, "red_amber"), (8, "green")]},
    )


def _stops_beyond_line_on_red() -> Drive:
    m = Crossroads()
    m.lit("e", "A")
    return draw(
        "gb_stops_beyond_line_on_red_i",
        "The front goes 2 m over the line on red, where it stands until green.",
        "fail r175.red",
        m,
        [ego(m.way("e", "w"), Pace(10).stop(119.4 + 2.0 - 2.25 - 40, 2).hold(8).to(9, 2).hold(20), start=40)],
        32,
        lights={"A": [(0, "amber"), (2.5, "red"), (20, "red_amber"), (22, "green")]},
    )


def _stops_at_red() -> Drive:
    m = Crossroads()
    m.lit("w", "A")
    return draw(
        "gb_stops_at_red_i",
        "Waits 0.3 m before the line until green. A quarter of a metre from the line. The exit is free.",
        "pass r175.red performance.precise-stop r176.green-exit-clear",
        m,
        [
            ego(
                m.way("w", "n"),
                Pace(10).stop(119.25 - 0.25 - 2.25 - 40, 2).hold(12).to(6, 1.5).hold(30),
                start=40,
                lamps=[(2, "left"), (30, "off")],
            )
        ],
        38,
        lights={"A": [(0, "green"), (2, "amber"), (5, "red"), (18, "red_amber"), (20, "green")]},
    )


def _red_for_other_arm() -> Drive:
    m = Crossroads()
    m.lit("w", "A")
    m.lit("n", "B")
    m.lit("s", "C")
    m.lit("e", "D")
    return draw(
        "gb_red_for_other_arm_i",
        "Only the crossing road's light is red; its own is green.",
        "pass r175.red",
        m,
        [ego(m.way("w", "e"), Pace(12), start=20)],
        18,
        lights={"A": [(0, "green")], "B": [(0, "red")], "C": [(0, "red")], "D": [(0, "green")]},
    )


def _red_signal_gap() -> Drive:
    m = Crossroads()
    m.lit("w", "A")
    return draw(
        "gb_red_signal_gap_i",
        "The record of the light is dark (off) while it crosses the line.",
        "not pass r175.red",
        m,
        [ego(m.way("w", "e"), Pace(12), start=20)],
        15,
        lights={"A": [(0, "red"), (6, "off"), (11, "red")]},
    )


def _exit_blocked_green() -> Drive:
    m = Crossroads()
    m.lit("w", "A")
    p = m.way("w", "e")
    return draw(
        "gb_exit_blocked_green_i",
        "Goes on green into the junction and stands in it for 12 s behind a queue.",
        "fail r176.green-exit-clear",
        m,
        [
            ego(p, Pace(8).stop(89, 2).hold(12).to(6, 1.5).hold(20), start=42),
            Actor("q", p, Pace(0).hold(24).to(7, 1.5).hold(20), start=138),
            Actor("q2", p, Pace(0).hold(23).to(7, 1.5).hold(20), start=145),
        ],
        42,
        lights={"A": [(0, "green")]},
    )


def _side_road_blocked() -> Drive:
    m = Crossroads(arms={"e": 0, "w": 180, "n": 90})
    p = m.way("w", "e")
    return draw(
        "gb_side_road_blocked_i",
        "In a queue it stands for 15 s across a side road's mouth.",
        "fail r151.side-roads-clear",
        m,
        [
            ego(p, Pace(5).stop(89, 1.5).hold(15).to(5, 1.5).hold(20), start=42),
            Actor("q", p, Pace(0).hold(32.5).to(7, 1.5).hold(20), start=144.5, kind="bus", size=(11, 2.5, 3.1)),
            Actor("wait", m.way("n", "e"), Pace(0), start=113),
        ],
        46,
    )


def _side_road_left_open() -> Drive:
    m = Crossroads(arms={"e": 0, "w": 180, "n": 90})
    p = m.way("w", "e")
    return draw(
        "gb_side_road_left_open_i",
        "It waits before the side road until there is room beyond.",
        "pass r151.side-roads-clear",
        m,
        [
            ego(p, Pace(5).stop(70, 1.5).hold(14).to(5, 1.5).hold(25), start=42),
            Actor("q", p, Pace(0).hold(24).to(7, 1.5).hold(20), start=146),
        ],
        52,
    )


def _red_skew_junction_lorry() -> Drive:
    m = Crossroads(arms={"e": 10, "w": 190, "n": 65, "s": 245}, edge=18)
    m.lit("s", "A", "B")
    m.lit("w", "C")
    return draw(
        "gb_red_skew_junction_lorry_i",
        "A lorry goes over the line of a skew junction on red.",
        "fail r175.red",
        m,
        [ego(m.way("s", "n"), Pace(10), start=40, kind="truck", size=(10.5, 2.5, 3.6))],
        18,
        hertz=5,
        lights={"A": [(0, "red")], "B": [(0, "red")], "C": [(0, "green")]},
        vehicle_class="goods_7t5",
    )


DRAWN = (
    _red_two_heads,
    _red_and_amber_start,
    _stops_beyond_line_on_red,
    _stops_at_red,
    _red_for_other_arm,
    _red_signal_gap,
    _exit_blocked_green,
    _side_road_blocked,
    _side_road_left_open,
    _red_skew_junction_lorry,
)
