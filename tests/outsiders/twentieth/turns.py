"""Turns across the way of others, and roundabouts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tests.outsiders.twentieth.drive import Drive, Expect
from tests.outsiders.twentieth.motion import Actor, Floats, Move, Way, when
from tests.outsiders.twentieth.roads import Lane, Pose
from tests.outsiders.twentieth.sites import Cross, Ring, along, cross, foot, ring

CLEAR = "ukhc.r180.right-turn-gap"
BIKE = "ukhc.h3.no-cut-across"
PASS = "ukhc.r182.no-pass-before-turn"
FOOT = "ukhc.h2.turn-pedestrian"


def meet(a: Way, b: Way) -> tuple[float, float]:
    """Stations at which two ways cross."""
    d = np.hypot(a.x[:, None] - b.x[None, ::2], a.y[:, None] - b.y[None, ::2])
    i, j = np.unravel_index(int(np.argmin(d)), d.shape)
    return float(a.s[i]), float(b.s[::2][j])


def far_turn(name: str, near: int, kind: str, arrive: float, expect: Sequence[Expect], **kw: Any) -> Drive:
    """The ego turns across the oncoming lane; the other reaches the crossing point `arrive` s after the ego does."""
    base: Pose = kw.pop("base", (0.0, 0.0, 0.0))
    c = cross(near, mph=30.0 if near > 0 else 50.0, base=base)
    mine, his = c.lane("A", "D"), c.lane("B", str(kw.pop("to", "A")))
    moves: list[Move] = [("to_s", 105), ("v", 5.0, 1.5)]
    v = float(kw.pop("speed", 12.0))
    i, j = meet(mine, his)
    t = when(85, 10, moves, i)
    brakes: list[Move] = []
    if kw.pop("brakes", False):
        brakes = [("hold", t - 0.6), ("v", 2.5, 4.0), ("hold", 2), ("v", 8, 1.0)]
    other = Actor("oncoming", kind, his, j - v * (t + arrive), v, brakes, seen=kw.pop("seen", (0.0, 1e9)))
    lat: Sequence[tuple[float, float]] = kw.pop("lat", ((0.0, 0.0),))
    a = Actor("ego", str(kw.pop("me", "car")), mine, 85, 10, moves, lat, lamp=[(0.5, t + 1.5, "far")])
    return Drive(
        name,
        str(kw.pop("what")),
        c.map,
        [a, other],
        list(expect),
        t + 9,
        hz=float(kw.pop("hz", 10.0)),
        nation="gb" if near > 0 else "de",
    )


def far_gaps() -> list[Drive]:
    """Turns across oncoming traffic: room enough or not."""
    return [
        far_turn(
            "far_close",
            1,
            "car",
            1.9,
            [(CLEAR, "fail", "under 2 s between"), ("criticality.pet", "fail", "under 1.5 s between")],
            what="turns right about 1 s before an oncoming car",
        ),
        far_turn(
            "far_room",
            1,
            "car",
            5.2,
            [(CLEAR, "pass", "over 3 s between"), ("ukhc.r180.corner-cut", "pass", "on its own side")],
            what="turns right well before an oncoming car",
            base=(900.0, 10.0, -0.7),
        ),
        far_turn(
            "far_braked",
            1,
            "car",
            1.6,
            [(CLEAR, "fail", "the oncoming car braked with 4 m/s2 for the ego")],
            what="the oncoming car brakes hard, so that the time left is long",
            brakes=True,
        ),
        far_turn(
            "far_both",
            1,
            "car",
            1.0,
            [(CLEAR, "not fail", "both turn right, their ways do not cross")],
            what="the oncoming car turns right too, passing offside to offside",
            to="C",
            speed=5.0,
        ),
    ]


def far_others() -> list[Drive]:
    """Turns across oncoming traffic: others than cars, and corners."""
    return [
        far_turn(
            "far_moto_lost",
            -1,
            "motorcycle",
            1.7,
            [(CLEAR, "not pass", "the track ends 0.5 s before it comes onto the ego's ground")],
            what="DE: turns left before an oncoming motorcycle whose track ends early",
            speed=13.0,
            seen=(0.0, 12.3),
        ),
        far_turn(
            "far_horse",
            1,
            "animal",
            1.9,
            [(BIKE, "fail", "under 2 s before a ridden horse going ahead")],
            what="turns right just before an oncoming ridden horse",
            speed=3.5,
        ),
        far_turn(
            "far_cut",
            -1,
            "car",
            9.0,
            [
                ("ukhc.r180.corner-cut", "fail", "1 m over the middle of the road entered"),
                (CLEAR, "pass", "7 s between"),
            ],
            what="DE: cuts the corner of the left turn",
            lat=[(140, 0.0), (158, -2.3), (172, -1.9), (195, 0.0)],
            base=(5.0, 5.0, 1.0),
        ),
        far_turn(
            "far_truck",
            1,
            "truck",
            3.1,
            [(CLEAR, "fail", "the tail is hardly gone when the oncoming lorry comes")],
            what="an 11 m bus turns right; its tail leaves late",
            me="bus",
            speed=11.0,
            hz=5.0,
        ),
    ]


def near_cross(near: int, **kw: Any) -> Cross:
    """A crossroads for turns to the near side."""
    return cross(near, mph=30.0 if near > 0 else 50.0, **kw)


def near_turn(name: str, kind: str | None, gap: float, v: float, expect: Sequence[Expect], **kw: Any) -> Drive:
    """The ego passes somebody going ahead at the near edge and turns; he reaches its way `gap` s after the ego."""
    near = int(kw.pop("near", 1))
    c = near_cross(near, width=4.0)
    mine = c.lane("A", "C")
    moves: list[Move] = list(kw.pop("moves", [("to_s", 128), ("v", 5.0, 2.0)]))
    his = c.lane("A", "B")
    shifted = along(c.arm["A"], 3.5)
    edge = Way(
        np.concatenate([np.c_[shifted.x, shifted.y], np.c_[his.at(his.s)[0], his.at(his.s)[1]][-1:] * 0 + _ahead(c)]),
        near,
    )
    i, j = meet(mine, edge)
    v0, s0 = float(kw.pop("v0", 11.0)), float(kw.pop("s0", 40.0))
    t = when(s0, v0, moves, i)
    other = Actor("other", kind, edge, j - v * (t + gap), v, size=kw.pop("size", None))
    lat: Sequence[tuple[float, float]] = kw.pop("lat", ((60.0, 0.0), (80.0, -1.2), (118.0, -1.2), (140.0, 0.0)))
    a = Actor("ego", "car", mine, s0, v0, moves, lat, lamp=[(t - 5, t + 2, "near")])
    return Drive(name, str(kw.pop("what")), c.map, [a, other], list(expect), t + 8, nation="gb" if near > 0 else "de")


def _ahead(c: Cross) -> Floats:
    """A point far along arm B at the near edge."""
    x, y, _ = c.arm["B"].pose(140.0, 3.5)
    return np.array([[x, y]])


def near_turns() -> list[Drive]:
    """Turns to the near side by cyclists and others."""
    wait: list[Move] = [("to_s", 118), ("v", 3.5, 2.0), ("hold", 4), ("v", 5.5, 1.0)]
    mid = ((0.0, 0.0),)
    return [
        near_turn(
            "hook_bike",
            "bicycle",
            1.9,
            5.0,
            [
                (BIKE, "fail", "under 2 s before the cyclist going ahead"),
                (PASS, "fail", "got ahead of him 2 s before the turn"),
            ],
            what="left hook across a cyclist",
        ),
        near_turn(
            "behind_bike",
            "bicycle",
            -4.0,
            5.5,
            [(BIKE, "not fail", "turns 3 s behind the cyclist"), (PASS, "not fail", "passed nobody")],
            what="lets the cyclist go ahead and turns behind him",
            moves=wait,
            v0=8.0,
            s0=70.0,
            lat=mid,
        ),
        near_turn(
            "hook_moto",
            "motorcycle",
            2.6,
            5.4,
            [(PASS, "fail", "got ahead of the motorcycle 3 s before the turn")],
            what="passes a slow motorcycle and turns left across it",
            size=(2.1, 0.8, 1.5),
        ),
        near_turn(
            "hook_unnamed",
            None,
            2.8,
            5.0,
            [(PASS, "fail", "got ahead of somebody moving on that side 3 s before the turn")],
            what="passes somebody of unknown class and turns left",
            size=(1.8, 0.6, 1.7),
        ),
    ]


def side_walker(name: str, v: float, arrive: float, stops: bool, expect: Sequence[Expect], **kw: Any) -> Drive:
    """The ego turns near; somebody crosses the side road; he reaches the ego's way `arrive` s after the ego does."""
    near = int(kw.pop("near", 1))
    c = near_cross(near, edge=[Lane("sidewalk", 2.0, "none")])
    mine = c.lane("A", "C")
    road = c.arm["C"]
    his = foot(road, 4.0, 5.0, -5.0)
    moves: list[Move] = list(kw.pop("moves", [("to_s", 120), ("v", 5.0, 1.5)]))
    i, j = meet(mine, his)
    t = when(80, 9, moves, i)
    s0 = j - v * (t + arrive)
    walk: list[Move] = [("stop", j - 1.5, 2.5), ("hold", 3), ("v", v, 1.0)] if stops else []
    ped = Actor("ped", "pedestrian", his, s0, v, walk)
    a = Actor("ego", "car", mine, 80, 9, moves, lamp=[(0.5, t + 1, "near")])
    return Drive(name, str(kw.pop("what")), c.map, [a, ped], list(expect), t + 8, nation="gb" if near > 0 else "de")


def walkers() -> list[Drive]:
    """People on foot who cross the side road."""
    wait: list[Move] = [("stop", 146, 2.0), ("hold", 4), ("v", 5, 1.5)]
    return [
        side_walker(
            "walk_close",
            1.5,
            2.0,
            False,
            [(FOOT, "fail", "under 2 s before the walker on the side road")],
            what="turns left just before a walker",
        ),
        side_walker(
            "walk_stops",
            1.8,
            0.3,
            True,
            [(FOOT, "fail", "the walker stopped within 0.8 s on the road for the ego")],
            what="the walker stops dead on the road for the ego",
        ),
        side_walker(
            "walk_waits",
            1.4,
            -4.5,
            False,
            [(FOOT, "not fail", "came 3 s behind the walker")],
            what="DE: waits until the walker is across",
            moves=wait,
            near=-1,
        ),
    ]


def wide(name: str, off: float, want: str) -> Drive:
    """A near turn into a wide lane, kept in or wide."""
    c = near_cross(1, width=5.0)
    mine = c.lane("A", "C")
    moves: list[Move] = [("to_s", 120), ("v", 5.0, 1.5)]
    end = 150 + c.ways["AC1"].length
    lat = [(130, 0.0), (end - 2, off), (end + 25, off), (end + 60, 0.0)]
    room = 2.5 - off - 0.9
    a = Actor("ego", "car", mine, 80, 9, moves, lat, lamp=[(2, 13, "near")])
    return Drive(
        name,
        f"turns left leaving {room:.1f} m to the near edge",
        c.map,
        [a],
        [("ukhc.r183.keep-in", want, f"{room:.1f} m to the near edge")],
        20,
    )


def crossing(name: str, arrive: float, want: str, **kw: Any) -> Drive:
    """Straight over a crossroads in front of somebody from the far side."""
    c = cross(1, skew=float(kw.get("skew", 0.0)))
    mine, his = c.lane("A", "B"), c.lane("D", "C")
    i, j = meet(mine, his)
    t = (i - 70) / 10
    kind = str(kw.get("kind", "car"))
    v = float(kw.get("v", 10.0))
    other = Actor("cross", kind, his, j - v * (t + arrive), v)
    return Drive(
        name,
        f"a {kind} crosses {arrive} s after the ego's middle",
        c.map,
        [Actor("ego", "car", mine, 70, 10), other],
        [("criticality.pet", want, "by the gap between the two boxes"), ("ukhc.no-collision", "pass", "clear")],
        t + 6,
    )


def wrong_way_round() -> Drive:
    """The wrong way round a roundabout."""
    r = ring(1)
    arm_in, arm_out = r.arm[0], r.arm[3]
    pts = [arm_in.pose(s, arm_in.middle_of(s, 1))[:2] for s in np.linspace(0, arm_in.length - 2, 200)]
    ang = np.linspace(math.pi + 0.30, 1.5 * math.pi - 0.30, 60)
    pts += [(21.75 * math.cos(a), 21.75 * math.sin(a)) for a in ang]
    pts += [arm_out.pose(s, -arm_out.middle_of(s, 1))[:2] for s in np.linspace(arm_out.length - 2, 0, 200)]
    path = Way(np.array(pts), 1)
    smooth_x = np.convolve(np.pad(path.x, 40, "edge"), np.ones(81) / 81, "valid")
    smooth_y = np.convolve(np.pad(path.y, 40, "edge"), np.ones(81) / 81, "valid")
    a = Actor("ego", "car", Way(np.c_[smooth_x, smooth_y], 1), 30, 6.0)
    return Drive(
        "ring_wrong",
        "GB: turns right at a roundabout by going round it the wrong way",
        r.map,
        [a],
        [("ukhc.r143.direction", "fail", "4 s against the ring's traffic")],
        25,
    )


def rounds() -> list[Drive]:
    """Roundabouts."""
    out = [wrong_way_round()]
    for name, near, to, kind in (("ring_right", 1, 3, "car"), ("ring_truck", -1, 2, "truck")):
        r: Ring = ring(near, mph=30.0 if near > 0 else 50.0, base=(400.0, -200.0, 0.8))
        moves: list[Move] = [("to_s", 70), ("v", 5.5, 1.0)]
        a = Actor("ego", kind, r.lane(0, to), 40, 9, moves, lamp=[(2, 20, "near")])
        env = {"vehicle_class": "goods_over_7t5"} if kind == "truck" else {}
        want: list[Expect] = [("ukhc.r143.direction", "pass", "the right way round")]
        out.append(
            Drive(
                name,
                f"{kind} the right way round to arm {to}",
                r.map,
                [a],
                want,
                34,
                nation="gb" if near > 0 else "de",
                env=env,
            )
        )
    out.append(ring_zebra())
    return out


def ring_zebra() -> Drive:
    """Leaves a roundabout over a zebra with somebody on it."""
    r = ring(1)
    out = r.arm[1]
    s1 = out.length - 8
    out.patch("zebra", "crosswalk", (s1 - 3, s1, -3.5, 3.5), "z1")
    mine = r.lane(0, 1)
    spot = out.pose(s1, -1.75)
    at = mine.station(spot[0], spot[1])
    t = (at - 2.25 - 40) / 6.0
    ped = Actor("ped", "pedestrian", foot(out, s1 - 1.5, -7.0, 5.0), 7.0 - 0.5 - 1.4 * t, 1.4)
    a = Actor("ego", "car", mine, 40, 6.0, lamp=[(4, 30, "near")])
    return Drive(
        "ring_zebra",
        "leaves the roundabout over a zebra with somebody on the ego's half",
        r.map,
        [a, ped],
        [("ukhc.r195.zebra-on", "fail", "walker 0.5 m from the middle, still on the ego's half")],
        t + 6,
    )


def drives() -> list[Drive]:
    """All of them."""
    return [
        *far_gaps(),
        *far_others(),
        *near_turns(),
        *walkers(),
        wide("turn_wide", -0.9, "fail"),
        wide("turn_in", 1.0, "pass"),
        crossing("cross_close", 1.3, "fail"),
        crossing("cross_skew", -1.35, "fail", skew=0.35, kind="motorcycle", v=16.0),
        *rounds(),
    ]
