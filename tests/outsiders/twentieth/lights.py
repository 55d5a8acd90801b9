"""Lights, stop lines and stop signs, and queues beyond junctions."""

from __future__ import annotations

from typing import Any

from tests.outsiders.twentieth.drive import Drive
from tests.outsiders.twentieth.motion import Actor, Move, when
from tests.outsiders.twentieth.roads import Pose
from tests.outsiders.twentieth.sites import Cross, cross

LINE = 149.0


def ego(c: Cross, to: str, s0: float, v0: float, moves: list[Move], **kw: Any) -> Actor:
    """The ego on its way from arm A."""
    lane = int(kw.pop("lane", 1))
    return Actor("ego", kw.pop("kind", "car"), c.lane("A", to, lane), s0, v0, moves, **kw)


def lit(near: int = 1, **kw: Any) -> Cross:
    """A crossroads with a light and a stop line on every arm."""
    c = cross(near, **kw)
    n = int(kw.get("lanes", 1))
    for arm in c.arm:
        c.stop_line(arm, lanes=n)
        if n == 1:
            c.sign(arm, f"light{arm}", "1000001")
    return c


def cycle(t: float, red: float = 3.0) -> list[tuple[str, float, str]]:
    """Light A turns red at t, after amber of the given length; the side roads are green then."""
    rows = [("lightA", 0.0, "green"), ("lightA", t - red, "amber"), ("lightA", t, "red")]
    return rows + [(f"light{a}", 0.0, "red") for a in "CD"] + [(f"light{a}", t + 2, "green") for a in "CD"]


def red_late() -> Drive:
    """Over the line 0.4 s after red."""
    c = lit()
    t = (LINE - 2.25 - 60) / 11
    return Drive(
        "red_late",
        "front over the line 0.4 s after red at 11 m/s",
        c.map,
        [ego(c, "B", 60, 11, [])],
        [("ukhc.r175.red", "fail", "front over 0.4 s after red")],
        15,
        lights=cycle(t - 0.4),
    )


def just_amber() -> Drive:
    """Over the line 0.4 s before red."""
    c = lit()
    t = (LINE - 2.25 - 60) / 11
    return Drive(
        "just_amber",
        "front over the line 0.4 s before red",
        c.map,
        [ego(c, "B", 60, 11, [])],
        [("ukhc.r175.red", "pass", "front over 0.4 s before red, on amber")],
        15,
        lights=cycle(t + 0.4),
    )


def red_amber() -> Drive:
    """Starts on red with amber."""
    c = lit(base=(2000.0, -700.0, 1.1))
    moves: list[Move] = [("stop", LINE - 2.25 - 0.3, 2.0), ("hold", 4.0), ("v", 9.0, 2.0)]
    go = when(90, 9, moves, LINE - 2.25)
    rows = [("lightA", 0.0, "red"), ("lightA", go - 0.8, "red_amber"), ("lightA", go + 0.9, "green")]
    return Drive(
        "red_amber",
        "stands, starts on red and amber, front over before green",
        c.map,
        [ego(c, "B", 90, 9, moves)],
        [
            ("ukhc.r175.red", "fail", "front over on red and amber"),
            ("performance.precise-stop", "pass", "stands 0.3 m before"),
        ],
        25,
        lights=rows,
    )


def creep_over() -> Drive:
    """Stops at red with its front over the line."""
    c = lit()
    moves: list[Move] = [("stop", LINE - 2.25 + 0.5, 2.0), ("hold", 9.0), ("v", 9.0, 2.0)]
    t = when(90, 9, moves, LINE - 2.25 + 0.49)
    rows = [("lightA", 0.0, "red"), ("lightA", t + 7, "red_amber"), ("lightA", t + 8.5, "green")]
    return Drive(
        "creep_over",
        "stops at red with the front 0.5 m over the line",
        c.map,
        [ego(c, "B", 90, 9, moves)],
        [("ukhc.r175.red", "fail", "front 0.5 m over the line at red")],
        28,
        lights=rows,
    )


def stop_far() -> Drive:
    """Stops 1.3 m before the line and goes on green."""
    c = lit(-1, kind="town", mph=50.0)
    moves: list[Move] = [("stop", LINE - 2.25 - 1.3, 2.0), ("hold", 6.0), ("v", 9.0, 2.0)]
    t = when(90, 9, moves, LINE - 2.25 - 1.31)
    rows = [("lightA", 0.0, "red"), ("lightA", t + 4, "red_amber"), ("lightA", t + 5, "green")]
    return Drive(
        "stop_far",
        "stands 1.3 m before the line at red, goes on green",
        c.map,
        [ego(c, "B", 90, 9, moves)],
        [
            ("ukhc.r175.red", "pass", "crossed on green"),
            ("performance.precise-stop", "fail", "stands 1.3 m before the line"),
        ],
        25,
        nation="de",
        lights=rows,
    )


def two_lanes(own_red: bool) -> Drive:
    """Two lanes with a light each; lane 1 is the inner one."""
    c = lit(lanes=2)
    c.sign("A", "inner", "1000001", lanes="1")
    c.sign("A", "outer", "1000001", lanes="2")
    rows = [("inner", 0.0, "red"), ("outer", 0.0, "green")]
    lane = 1 if own_red else 2
    want = ("fail", "its own lane's light is red") if own_red else ("pass", "its own lane's light is green")
    return Drive(
        f"lane_{'red' if own_red else 'green'}",
        f"two lanes, ego in lane {lane}; inner red, outer green",
        c.map,
        [ego(c, "B", 70, 10, [], lane=lane)],
        [("ukhc.r175.red", *want)],
        14,
        lights=rows,
    )


def into_red_lane() -> Drive:
    """Changes from the green into the red lane before the line."""
    c = lit(lanes=2)
    c.sign("A", "inner", "1000001", lanes="1")
    c.sign("A", "outer", "1000001", lanes="2")
    a = ego(c, "B", 40, 10, [], lane=2, lat=[(80, 0.0), (125, -3.5)], lamp=[(0.5, 9, "far")])
    return Drive(
        "into_red_lane",
        "from the outer (green) into the inner (red) lane 22 m before the line",
        c.map,
        [a],
        [("ukhc.r175.red", "fail", "in the inner lane at the line, whose light is red")],
        16,
        lights=[("inner", 0.0, "red"), ("outer", 0.0, "green")],
    )


def state_late() -> Drive:
    """The log of the light begins after the crossing."""
    c = lit()
    t = (LINE - 2.25 - 60) / 11
    return Drive(
        "state_late",
        "the light's first state is 3 s after the crossing",
        c.map,
        [ego(c, "B", 60, 11, [])],
        [("ukhc.r175.red", "unknown", "no state known at the crossing")],
        15,
        lights=[("lightA", t + 3, "red")],
    )


def long_tail() -> Drive:
    """A lorry whose front is over on green, its tail long after red."""
    c = lit()
    moves: list[Move] = [("v", 4.0, 1.0)]
    t = when(110, 6, moves, LINE - 8.25)
    a = ego(c, "B", 110, 6, moves, kind="truck", size=(16.5, 2.55, 3.9))
    rows = [("lightA", 0.0, "green"), ("lightA", t + 0.5, "amber"), ("lightA", t + 1.5, "red")]
    return Drive(
        "long_tail",
        "articulated lorry: front over on green, tail 4 s later on red",
        c.map,
        [a],
        [("ukhc.r175.red", "pass", "front over 0.5 s before amber")],
        20,
        lights=rows,
        env={"vehicle_class": "goods_over_7t5"},
    )


def turn_on_red() -> Drive:
    """Germany: stops, then turns right on red."""
    c = lit(-1, mph=50.0, base=(-300.0, 900.0, 2.3), arms="ABC")
    moves: list[Move] = [("stop", LINE - 2.25 - 0.2, 2.0), ("hold", 3.0), ("v", 5.0, 1.5)]
    a = ego(c, "C", 95, 8, moves, lamp=[(0, 99, "near")])
    return Drive(
        "turn_on_red",
        "DE: stops at the line, turns right on red, no arrow",
        c.map,
        [a],
        [("ukhc.r175.red", "fail", "over the line on red")],
        25,
        nation="de",
        lights=[("lightA", 0.0, "red")],
    )


def queue_beyond(name: str, kind: str, inside: float, lights: bool) -> Drive:
    """A queue beyond the junction; the ego stands in it with `inside` metres in the junction for 9 s."""
    c = lit() if lights else cross(1, mph=30.0)
    way = c.lane("A", "B")
    leave = 150 + c.ways["AB1"].length
    length = {"car": 4.5, "bus": 12.0}[kind]
    at = leave - inside + length / 2
    moves: list[Move] = [("stop", at, 1.5), ("hold", 9.0), ("v", 6.0, 1.2)]
    a = ego(c, "B", 95, 8, moves, kind=kind)
    free = when(95, 8, moves, at - 0.01) + 8.5
    ahead = at + length / 2 + 2.5 + 2.25
    lead = Actor("lead", "car", way, ahead, 0.0, [("hold", free), ("v", 7.0, 1.5)])
    further = Actor("further", "van", way, ahead + 8.0, 0.0, [("hold", free - 1), ("v", 7.0, 1.5)])
    rule = "ukhc.r176.green-exit-clear" if lights else "ukhc.r151.side-roads-clear"
    want = ("fail", "not fail")[inside < 2.5]
    return Drive(
        name,
        f"{kind} stands behind a queue with {inside} m in the junction for 9 s",
        c.map,
        [a, lead, further],
        [(rule, want, f"{inside} m of it in the junction for 9 s")],
        free + 12,
        lights=[("lightA", 0.0, "green")] if lights else (),
    )


def waits_on_green() -> Drive:
    """Waits before the line on green until there is room."""
    c = lit()
    way = c.lane("A", "B")
    moves: list[Move] = [("stop", LINE - 2.25 - 0.3, 2.0), ("hold", 8.0), ("v", 8.0, 1.5)]
    a = ego(c, "B", 100, 8, moves)
    lead = Actor("lead", "bus", way, 183, 0.0, [("hold", 12), ("v", 9.0, 1.5)])
    return Drive(
        "waits_on_green",
        "waits before the line on green until the exit is clear",
        c.map,
        [a, lead],
        [("ukhc.r176.green-exit-clear", "not fail", "never stood in the junction"), ("ukhc.r175.red", "pass", "green")],
        28,
        lights=[("lightA", 0.0, "green")],
    )


def stop_sign(name: str, near: int, moves: list[Move], expect: list[tuple[str, str, str]], **kw: Any) -> Drive:
    """A crossroads with a stop sign and line on the ego's arm."""
    base: Pose = kw.pop("base", (0.0, 0.0, 0.0))
    c = cross(near, mph=30.0 if near > 0 else 50.0, base=base)
    c.stop_line("A", as_signal=bool(kw.pop("as_signal", False)))
    if near > 0:
        c.sign("A", "stopsign", "601.1", country="GB")
    else:
        c.sign("A", "stopsign", "206")
    others = []
    if kw.pop("first", False):
        ahead: list[Move] = [("stop", LINE - 2.25 - 0.3, 2.0), ("hold", 3.0), ("v", 8.0, 2.0)]
        others.append(Actor("first", "car", c.lane("A", "B"), 112, 8, ahead))
    a = ego(c, "B", 100, 8, moves, noise=float(kw.pop("noise", 0.0)))
    return Drive(
        name,
        str(kw.pop("what")),
        c.map,
        [a, *others],
        expect,
        25,
        hz=float(kw.pop("hz", 10.0)),
        nation="gb" if near > 0 else "de",
    )


def stop_signs() -> list[Drive]:
    """Stop signs, kept and not."""
    to = LINE - 2.25
    r171, rin1, neat = "ukhc.r171.stop-sign", "stvo.rin1", "performance.precise-stop"
    return [
        stop_sign(
            "stop_rolls",
            -1,
            [("to_s", 120), ("v", 0.5, 1.5), ("to_s", to + 0.5), ("v", 8, 1.5)],
            [(r171, "fail", "never below 0.5 m/s"), (rin1, "fail", "no halt")],
            what="DE: rolls over the line at 0.5 m/s",
        ),
        stop_sign(
            "stop_kept",
            1,
            [("stop", to - 0.3, 2), ("hold", 2.5), ("v", 8, 1.5)],
            [(r171, "pass", "stood 2.5 s 0.3 m before"), (neat, "pass", "0.3 m before")],
            what="stands 2.5 s at the line, noisy",
            noise=0.02,
            as_signal=True,
        ),
        stop_sign(
            "stop_beyond",
            1,
            [("stop", to + 1.5, 2), ("hold", 2.5), ("v", 8, 1.5)],
            [(r171, "fail", "halts 1.5 m beyond the line only")],
            what="halts with its front 1.5 m beyond the line",
            base=(50.0, 80.0, -2.0),
        ),
        stop_sign(
            "stop_early",
            1,
            [("stop", to - 22, 2), ("hold", 2.5), ("v", 8, 1.5)],
            [(r171, "fail", "halts 22 m before the line, crosses at 8 m/s")],
            what="halts 22 m before the line, then drives over it",
        ),
        stop_sign(
            "stop_brief",
            -1,
            [("stop", to - 0.3, 2), ("hold", 0.3), ("v", 8, 1.5)],
            [(r171, "pass", "came to a halt at the line"), (rin1, "fail", "stood 0.4 s")],
            what="DE: halts for 0.3 s",
            hz=20.0,
        ),
        stop_sign(
            "stop_second",
            -1,
            [("stop", to - 6.5, 2), ("hold", 3.2), ("v", 6, 1.5)],
            [
                (r171, "fail", "halted second in the queue only, 6.5 m before the line"),
                (rin1, "fail", "no halt close before the line"),
            ],
            what="DE: stands behind the first car, then follows it over the line without halting",
            first=True,
        ),
    ]


def drives() -> list[Drive]:
    """All of them."""
    return [
        red_late(),
        just_amber(),
        red_amber(),
        creep_over(),
        stop_far(),
        two_lanes(True),
        two_lanes(False),
        into_red_lane(),
        state_late(),
        long_tail(),
        turn_on_red(),
        queue_beyond("queue_bus_lit", "bus", 5.0, True),
        queue_beyond("queue_tail_lit", "car", 1.9, True),
        queue_beyond("queue_bus_unlit", "bus", 4.5, False),
        waits_on_green(),
        *stop_signs(),
    ]
