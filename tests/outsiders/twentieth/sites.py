"""The places: straight roads, crossroads, roundabouts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.outsiders.twentieth.motion import Way
from tests.outsiders.twentieth.roads import Lane, Map, Pose, Road, Section

Leg = tuple[Road, int, int]
MPH = 0.44704


def turned(base: Pose, x: float, y: float, h: float) -> Pose:
    """A pose given in the frame of another one."""
    c, s = math.cos(base[2]), math.sin(base[2])
    return (base[0] + x * c - y * s, base[1] + x * s + y * c, base[2] + h)


def way(legs: Sequence[Leg]) -> Way:
    """A way along the middles of lanes: (road, +1 or -1 along s, lane counted from the middle)."""
    pts: list[tuple[float, float]] = []
    for road, go, lane in legs:
        n = max(int(road.length / 0.25), 2)
        for s in np.linspace(0, road.length, n)[:: 1 if go > 0 else -1]:
            x, y, _ = road.pose(float(s), road.middle_of(float(s), go * lane))
            pts.append((x, y))
    return Way(np.array(pts), legs[0][0].near)


def foot(road: Road, s: float, u0: float, u1: float) -> Way:
    """A way straight across a road at s."""
    a, b = road.pose(s, u0), road.pose(s, u1)
    return Way(np.array([a[:2], b[:2]]), road.near)


def along(road: Road, u: float, back: bool = False) -> Way:
    """A way along a road at an offset to the near side."""
    ss = np.linspace(0, road.length, max(int(road.length / 0.5), 2))
    pts = [road.pose(float(s), u)[:2] for s in ss]
    return Way(np.array(pts[::-1] if back else pts), road.near)


@dataclass
class Straight:
    """One road."""

    map: Map
    road: Road

    def lane(self, lane: int, go: int = 1) -> Way:
        """The way along a lane counted from the middle; go -1: the other direction's."""
        return way([(self.road, go, lane)])


def straight(near: int, length: float, kind: str, mph: float | None, **kw: Any) -> Straight:
    """A road with lanes own and opp, outer lanes such as footways, and its bends."""
    own, opp = int(kw.get("own", 1)), int(kw.get("opp", 1))
    width = float(kw.get("width", 3.5))
    edge: list[Lane] = list(kw.get("edge", []))
    middle = kw.get("middle", "broken")
    steps: list[tuple[float, str]] = [(0.0, middle)] if isinstance(middle, str) else list(middle)
    parts: list[tuple[float, float]] = list(kw.get("parts", [(length, 0.0)]))
    start: Pose = kw.get("start", (0.0, 0.0, 0.0))

    def lanes(n: int) -> list[Lane]:
        return [Lane(width=width, mark="broken" if i < n - 1 else "solid") for i in range(n)] + (edge if n else [])

    net = Map(near, int(kw.get("version", 4)))
    secs = [Section(s, lanes(own), lanes(opp), mark) for s, mark in steps]
    road = net.road(start, parts, secs, kind=kind, mph=mph, unit="mph" if near > 0 else "km/h")
    return Straight(net, road)


@dataclass
class Cross:
    """A crossroads: arm A comes in, B goes straight on, C to the near side, D to the far side."""

    map: Map
    arm: dict[str, Road]
    ways: dict[str, Road]
    size: float

    def lane(self, frm: str, to: str, lane: int = 1) -> Way:
        """The way from one arm to another."""
        key = f"{frm}{to}{lane}"
        return way(
            [
                (self.arm[frm], 1 if frm == "A" else -1, lane),
                (self.ways[key], 1, 1),
                (self.arm[to], -1 if to == "A" else 1, lane),
            ]
        )

    def inlet(self, arm: str) -> float:
        """Station on a way at which it comes into the junction."""
        return self.arm[arm].length

    def stop_line(self, arm: str, back: float = 1.0, lanes: int = 1, as_signal: bool = False) -> None:
        """A stop line on an arm."""
        road = self.arm[arm]
        fwd = arm == "A"
        s = road.length - back if fwd else back
        width = road.sections[0].own[0].width * lanes
        u = width / 2 if fwd else -width / 2
        if as_signal:
            road.sign(f"line{arm}", s, u, fwd, country="DE", type="294")
        else:
            road.bar(s, u, width, fwd, f"line{arm}")

    def sign(self, arm: str, name: str, kind: str, back: float = 1.0, **kw: str) -> None:
        """A sign or light beside an arm, for those who come in."""
        road = self.arm[arm]
        fwd = arm == "A"
        lanes = kw.get("lanes", "1")
        signed = ",".join(v if fwd else f"-{v}" for v in lanes.split(","))
        more = {k: v for k, v in kw.items() if k != "lanes"}
        country = more.pop("country", "OpenDRIVE" if kind.startswith("10000") else "DE")
        s = road.length - back if fwd else back
        road.sign(name, s, 5.0 if fwd else -5.0, fwd, type=kind, country=country, lanes=signed, **more)


def cross(near: int, kind: str = "town", mph: float = 30.0, **kw: Any) -> Cross:
    """A crossroads with arms of the given lengths; `arms` leaves some out, `skew` turns C and D."""
    base: Pose = kw.get("base", (0.0, 0.0, 0.0))
    size, long = float(kw.get("size", 12.0)), float(kw.get("long", 150.0))
    arms = str(kw.get("arms", "ABCD"))
    n = int(kw.get("lanes", 1))
    width = float(kw.get("width", 3.5))
    skew = float(kw.get("skew", 0.0))
    edge: list[Lane] = list(kw.get("edge", []))
    net = Map(near, int(kw.get("version", 4)))

    def section() -> list[Section]:
        side = [Lane(width=width, mark="broken" if i < n - 1 else "solid") for i in range(n)] + edge
        return [Section(0.0, side, list(side), str(kw.get("middle", "broken")))]

    made: dict[str, Road] = {}
    turn = {"B": 0.0, "C": near * (math.pi / 2 + skew), "D": near * (-math.pi / 2 + skew)}
    for arm in arms:
        if arm == "A":
            start = turned(base, -size - long, 0.0, 0.0)
        else:
            a = turn[arm]
            start = turned(base, size * math.cos(a), size * math.sin(a), a)
        made[arm] = net.road(start, [(long, 0.0)], section(), kind=kind, mph=mph, unit="mph" if near > 0 else "km/h")
    ways: dict[str, Road] = {}
    for f in arms:
        for t in arms:
            for k in range(1, n + 1):
                if f != t:
                    ways[f"{f}{t}{k}"] = net.join(900, (made[f], f == "A"), k, (made[t], t == "A"), k)
    return Cross(net, made, ways, size)


@dataclass
class Ring:
    """A roundabout with four arms, numbered in the direction of the traffic; arm 0 is where the ego comes from."""

    map: Map
    arm: list[Road]
    seg: list[Road]
    enter: list[Road]
    leave: list[Road]
    past: list[Road]

    def lane(self, frm: int, to: int) -> Way:
        """The way from one arm round to another."""
        legs: list[Leg] = [(self.arm[frm], 1, 1), (self.enter[frm], 1, 1), (self.seg[frm], 1, 1)]
        k = (frm + 1) % 4
        while k != to:
            legs += [(self.past[k], 1, 1), (self.seg[k], 1, 1)]
            k = (k + 1) % 4
        legs += [(self.leave[to], 1, 1), (self.arm[to], -1, 1)]
        return way(legs)


def ring(near: int, radius: float = 20.0, **kw: Any) -> Ring:
    """A roundabout: in LHT it is driven clockwise, in RHT the other way."""
    base: Pose = kw.get("base", (0.0, 0.0, 0.0))
    long = float(kw.get("long", 100.0))
    kind, mph = str(kw.get("kind", "town")), float(kw.get("mph", 30.0))
    net = Map(near, int(kw.get("version", 5)))
    unit = "mph" if near > 0 else "km/h"
    gap = 18.0
    half = math.asin(gap / 2 / radius) * 1.6
    arms, segs = [], []
    for k in range(4):
        a = math.pi - near * k * math.pi / 2
        far = radius + 12.0 + long
        start = turned(base, far * math.cos(a), far * math.sin(a), a + math.pi)
        lane = [Lane(mark="solid")]
        arms.append(net.road(start, [(long, 0.0)], [Section(0.0, lane, list(lane))], kind=kind, mph=mph, unit=unit))
    for k in range(4):
        a0 = math.pi - near * (k * math.pi / 2 + half)
        sweep = math.pi / 2 - 2 * half
        start = turned(base, radius * math.cos(a0), radius * math.sin(a0), a0 - near * math.pi / 2)
        part = [(radius * sweep, -near / radius)]
        segs.append(
            net.road(
                start, part, [Section(0.0, [Lane(width=3.5, mark="solid")], [], "solid")], kind=kind, mph=mph, unit=unit
            )
        )
    enter, leave, past = [], [], []
    for k in range(4):
        prev = segs[(k + 3) % 4]
        enter.append(net.join(900 + k, (arms[k], True), 1, (segs[k], False), 1))
        leave.append(net.join(900 + k, (prev, True), 1, (arms[k], True), 1))
        past.append(net.join(900 + k, (prev, True), 1, (segs[k], False), 1))
    return Ring(net, arms, segs, enter, leave, past)


def rural(near: int = 1, length: float = 700.0, **kw: Any) -> Straight:
    """A country road."""
    kind = str(kw.pop("kind", "rural"))
    mph = kw.pop("mph", 60.0 if near > 0 else 100.0)
    return straight(near, length, kind, mph, **kw)
