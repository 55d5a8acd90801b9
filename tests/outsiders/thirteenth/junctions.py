"""Stop lines, lights, queues and roundabouts."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.thirteenth.crossroads import halt, junction, on
from tests.outsiders.thirteenth.drive import DE, FAR, TURNED, Drive, Lights

STOP = {"W": "stop"}
GIVE = {"W": "give"}
LIGHTS = dict.fromkeys("WESN", "light")
TURNS_RED = [(0, "green"), (4.5, "amber"), (7.5, "red")]
RED: Lights = {"LW": [(0, "red")], "LE": [(0, "red")], "LS": [(0, "green")], "LN": [(0, "green")]}


def west(states: list[tuple[float, str]]) -> Lights:
    """The ego's light, and that of those who come; red for the others."""
    return {"LW": states, "LE": states, "LS": [(0, "red")], "LN": [(0, "red")]}


def british_stop_signs() -> Iterator[Drive]:
    """Stop signs in Great Britain."""
    yield junction(
        "stop_good",
        "WE",
        halt(9, 60, 1.5, 2),
        [
            ("ukhc.r171.stop-sign", "pass", "stands 0.35 m before the line"),
            ("performance.precise-stop", "pass", "0.35 m"),
        ],
        signs=STOP,
    )
    yield junction(
        "stop_far",
        "WE",
        halt(9, 60, 3.0, 2),
        [
            ("ukhc.r171.stop-sign", "pass", "stands 1.85 m before the line"),
            ("performance.precise-stop", "fail", "1.85 m"),
        ],
        signs=STOP,
        frame=TURNED,
    )
    yield junction(
        "stop_roll",
        "WN",
        [(0, 9), (3, 9), (8, 1.2), (10, 1.2), (14, 6), (99, 6)],
        [("ukhc.r171.stop-sign", "fail", "never under 1.2 m/s")],
        signs=STOP,
    )
    yield junction(
        "stop_over",
        "WE",
        halt(9, 60, -0.3, 2),
        [
            ("ukhc.r171.stop-sign", "fail", "first halt 1.3 m over the line"),
            ("performance.precise-stop", "fail", "stopped over the line"),
        ],
        signs=STOP,
        frame=FAR,
    )
    yield junction(
        "stop_back_then_roll",
        "WE",
        [(0, 9), (2, 9), (5, 0), (7, 0), (9, 4), (99, 4)],
        [("ukhc.r171.stop-sign", "fail", "halted 25 m before the line, then went over it at 4 m/s")],
        signs=STOP,
    )
    yield junction(
        "x_stop_half_over",
        "WE",
        halt(9, 60, 0.45, 2),
        [("ukhc.r171.stop-sign", "fail", "first halt half a metre over the line")],
        signs={"W": "stop"},
        seconds=25,
    )


def german_stop_signs() -> Iterator[Drive]:
    """Stop signs in Germany."""
    yield junction(
        "stop_de_short",
        "WE",
        halt(9, 60, 1.5, 0.05),
        [("stvo.rin1", "fail", "halt of a fraction of a second")],
        lht=False,
        conditions=DE,
        signs=STOP,
        hz=20,
    )
    yield junction(
        "stop_de_good",
        "WE",
        halt(9, 60, 1.5, 2.5),
        [("stvo.rin1", "pass", "2.5 s")],
        lht=False,
        conditions=DE,
        signs=STOP,
        frame=TURNED,
    )
    yield junction(
        "stop_de_none",
        "WS",
        [(0, 7), (99, 7)],
        [("stvo.rin1", "fail", "drove through at 7 m/s"), ("ukhc.r171.stop-sign", "fail", "the same (no law asked)")],
        lht=False,
        conditions=DE,
        signs=STOP,
        seconds=20,
    )


def red_lights() -> Iterator[Drive]:
    """Red lights."""
    yield junction(
        "red_run", "WE", 10, [("ukhc.r175.red", "fail", "red all the time")], signs=LIGHTS, lights=RED, seconds=16
    )
    yield junction(
        "red_amber_jump",
        "WE",
        halt(10, 60, 1.6, 3),
        [("ukhc.r175.red", "fail", "crossed on red and amber")],
        signs=LIGHTS,
        seconds=24,
        hz=20,
        lights=west([(0, "red"), (10.5, "red_amber"), (19, "green")]),
    )
    yield junction(
        "red_creep",
        "WE",
        [(0, 9), (4, 9), (7.0, 0), (12, 0), (13, 0.8), (15.5, 0.8), (16, 0), (25, 0)],
        [("ukhc.r175.red", "fail", "creeps over the line on red and stands there")],
        back=52.2,
        signs=LIGHTS,
        lights=RED,
        frame=TURNED,
    )
    yield junction(
        "green_ok",
        "WE",
        10,
        [("ukhc.r175.red", "pass", "green"), ("ukhc.no-collision", "not fail", "nobody")],
        signs=LIGHTS,
        lights=west([(0, "green")]),
        seconds=16,
    )
    yield junction(
        "red_wait",
        "WE",
        halt(10, 60, 1.4, 5),
        [
            ("ukhc.r175.red", "pass", "waits, goes on green"),
            ("performance.precise-stop", "pass", "0.25 m before the line"),
        ],
        signs=LIGHTS,
        lights=west([(0, "red"), (12, "red_amber"), (13, "green")]),
    )


def red_in_time() -> Iterator[Drive]:
    """Lights that change, and whose they are."""
    yield junction(
        "red_just_after_line",
        "WE",
        10,
        [("ukhc.r175.red", "pass", "front over the line at 5.9 s, red from 6.5 s")],
        signs=LIGHTS,
        lights=west([(0, "amber"), (6.5, "red")]),
        seconds=16,
    )
    yield junction(
        "red_just_before_line",
        "WE",
        10,
        [("ukhc.r175.red", "fail", "front over the line at 5.9 s, red from 5.5 s")],
        signs=LIGHTS,
        lights=west([(0, "amber"), (5.5, "red")]),
        seconds=16,
        hz=20,
        frame=TURNED,
    )
    yield junction(
        "red_other_light",
        "SN",
        10,
        [("ukhc.r175.red", "pass", "own light is green, the other road's red")],
        signs=LIGHTS,
        lights=RED,
        seconds=16,
        frame=FAR,
    )
    yield junction(
        "red_low_rate_truck",
        "NW",
        [(0, 8), (4, 8), (6, 4.5), (99, 4.5)],
        [("ukhc.r175.red", "fail", "front over the line half a second and more after red")],
        signs=LIGHTS,
        lights={"LS": TURNS_RED, "LN": TURNS_RED, "LW": [(0, "red")], "LE": [(0, "red")]},
        seconds=24,
        hz=5,
        cls="truck",
        frame=TURNED,
    )
    yield junction(
        "red_rear_only",
        "WE",
        6,
        [("ukhc.r175.red", "pass", "front over the line at 4.9 s, only the rear on red")],
        back=30,
        signs=LIGHTS,
        lights=west([(0, "green"), (5.0, "amber"), (6.0, "red")]),
        seconds=16,
        cls="truck",
        size=(16.5, 2.5, 4.0),
    )
    yield junction(
        "red_two_kinds",
        "WE",
        halt(10, 60, -2.5, 3, 5),
        [("ukhc.r175.red", "fail", "goes over the line on red, waits there for green")],
        signs=LIGHTS,
        lights=west([(0, "red"), (15, "green")]),
        seconds=26,
        noise=0.02,
    )


def queues() -> Iterator[Drive]:
    """Queues beyond the junction."""
    yield junction(
        "box_green",
        "WE",
        [(0, 8), (6, 8), (10, 0), (22, 0), (25, 5), (99, 5)],
        [("ukhc.r176.green-exit-clear", "fail", "stands 12 s in the junction behind a standing car")],
        on("q1", "car", "WE", -24.5, [(0, 0), (21, 0), (23, 5), (99, 5)]),
        back=50,
        signs=LIGHTS,
        lights=west([(0, "green")]),
        seconds=34,
    )
    yield junction(
        "box_nolight",
        "WE",
        [(0, 8), (6, 8), (10, 0), (22, 0), (25, 5), (99, 5)],
        [("ukhc.r151.side-roads-clear", "fail", "stands 12 s in the junction behind a standing car")],
        on("q1", "car", "WE", -24.5, [(0, 0), (21, 0), (23, 5), (99, 5)]),
        back=50,
        seconds=34,
        frame=TURNED,
    )
    yield junction(
        "box_waits",
        "WE",
        halt(8, 50, 1.6, 12),
        [
            ("ukhc.r176.green-exit-clear", "pass", "waits before the line until the exit is free"),
            ("ukhc.r175.red", "pass", "green"),
        ],
        on("q1", "car", "WE", -27, [(0, 0), (14, 0), (17, 6), (99, 6)]),
        back=50,
        signs=LIGHTS,
        lights=west([(0, "green")]),
        seconds=32,
    )


def straight_on() -> Iterator[Drive]:
    """Others cross."""
    yield junction(
        "cross_pet",
        "WE",
        10,
        [("criticality.pet", "fail", "crossing car follows within about a second")],
        on("c", "car", "SN", 64, 10),
        back=50,
        seconds=16,
    )
    yield junction(
        "cross_hit",
        "WE",
        9,
        [("ukhc.no-collision", "fail", "boxes meet in the middle"), ("criticality.pet", "fail", "both at once")],
        on("c", "van", "SN", 52, 9),
        back=50,
        seconds=16,
        hz=5,
        frame=TURNED,
    )
    yield junction(
        "cross_ok",
        "WE",
        10,
        [("criticality.pet", "pass", "over 4 s"), ("ukhc.no-collision", "pass", "apart")],
        on("c", "car", "SN", 110, 10),
        back=50,
        seconds=16,
    )
    yield junction(
        "x_cross_tunnel",
        "WE",
        15,
        [("ukhc.no-collision", "fail", "boxes meet between two steps at 2 Hz")],
        on("c", "car", "SN", 61.5, 15),
        back=60,
        seconds=12,
        hz=2,
        limit=17.88,
    )


def roundabouts() -> Iterator[Drive]:
    """Roundabouts, both ways round."""
    yield junction(
        "ring_ok",
        "WE",
        [(0, 9), (4, 9), (6, 5.5), (99, 5.5)],
        [
            ("ukhc.r143.direction", "not fail", "clockwise in Britain"),
            ("ukhc.no-collision", "not fail", "alone"),
            ("ukhc.r145.off-road", "not fail", "stays in its lane"),
        ],
        back=50,
        seconds=28,
        ring=True,
        signs=GIVE,
    )
    yield junction(
        "ring_ok_de",
        "SW",
        [(0, 9), (4, 9), (6, 5.5), (99, 5.5)],
        [("ukhc.r143.direction", "not fail", "anticlockwise in Germany"), ("ukhc.no-collision", "not fail", "alone")],
        back=50,
        seconds=32,
        ring=True,
        signs={"S": "give"},
        lht=False,
        conditions=DE,
        frame=FAR,
    )
    yield junction(
        "ring_wrong_way",
        "WE",
        [(0, 9), (4, 9), (6, 5.5), (99, 5.5)],
        [("ukhc.r143.direction", "fail", "anticlockwise round a British roundabout")],
        back=50,
        seconds=28,
        ring=True,
        off=[(0, 3.5), (5, 3.5), (7.5, 0), (17, 0), (19, 3.5)],
        mirrored=True,
    )
    yield junction(
        "ring_wrong_way_de",
        "WE",
        [(0, 9), (4, 9), (6, 5.5), (99, 5.5)],
        [("ukhc.r143.direction", "fail", "clockwise round a German roundabout")],
        back=50,
        seconds=28,
        ring=True,
        off=[(0, 3.5), (5, 3.5), (7.5, 0), (17, 0), (19, 3.5)],
        mirrored=True,
        lht=False,
        conditions=DE,
        frame=TURNED,
    )
    yield junction(
        "ring_hit",
        "WE",
        [(0, 9), (4, 9), (6, 5.5), (99, 5.5)],
        [("ukhc.no-collision", "fail", "runs into one on the ring")],
        on("c", "car", "SE", 22, 6),
        back=50,
        seconds=20,
        ring=True,
        signs=GIVE,
    )
