"""Crossroads and roundabouts at the origin: arms of one lane each way at the angles k * 90 degrees, directed outwards."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any

from tests.outsiders.twelfth.road import (
    Connection,
    End,
    Frame,
    Lane,
    Map,
    Road,
    Sec,
    crosswalk,
    frame,
    light,
    signal,
    stop_line,
)
from tests.outsiders.twelfth.ways import Along, Moves, Path, Speeds

EDGE = 14.0  # a crossroads reaches so far from its middle


class Junction:
    """What the two kinds have in common."""

    def __init__(self, lht: bool, edge: float, length: float, width: float, limit: tuple[float, str]) -> None:
        self.lht, self.edge, self.arm, self.width = lht, edge, length, width
        self.limit, self.unit = limit
        self.half = width / 2
        self.near = 1 if lht else -1  # the near side: 1 is left

    def start(self, arm: int, radius: float) -> Path:
        """Begin a path on an arm's inbound lane."""
        a = math.radians(90 * arm)
        heading = math.radians(90 * arm + 180)
        across = self.near * self.half
        x, y = radius * math.cos(a), radius * math.sin(a)
        return Path(x - across * math.sin(heading), y + across * math.cos(heading), 90 * arm + 180)

    def through(self, begun: Path, i: int, j: int) -> Path:
        """Go on from arm i through the junction to arm j."""
        raise NotImplementedError

    def route(self, i: int, j: int) -> Path:
        """The way from the far end of an arm to that of another."""
        begun = self.start(i, self.edge + self.arm).fwd(self.arm)
        return self.through(begun, i, j).fwd(self.arm)

    def drive(self, i: int, j: int, s0: float, speeds: Speeds, off: float = 0.0, moves: Moves = ()) -> Along:  # noqa: PLR0917
        """Somebody on that way from s0 on; the junction begins at the arm's length."""
        return Along(self.route(i, j), s0, speeds, off, moves)

    def build(self, arms: Collection[int], roads: list[Road], tf: Frame) -> Map:
        """Join the arms."""
        inbound = -self.near
        connections = []
        for n, (i, j) in enumerate(((i, j) for i in arms for j in arms if i != j), 10):
            roads.append(
                Road(
                    str(n),
                    self.through(self.start(i, self.edge), i, j),
                    [Sec(0.0, [("driving", self.width)], [])],
                    self.lht,
                    "town",
                    self.limit,
                    self.unit,
                    mid=[(0.0, "none")],
                    junction="100",
                    pred=End("road", f"{i + 1}", "start"),
                    succ=End("road", f"{j + 1}", "start"),
                    lane_pred={self.near: inbound},
                    lane_succ={self.near: self.near},
                    offset=-self.near * self.half,
                )
            )
            connections.append(Connection(f"{i + 1}", str(n), [(inbound, self.near)]))
        return Map(roads, [("100", connections)], frame(tf))


class Cross(Junction):
    """A crossroads; stop lines are 1.5 m before it, or 8 m on an arm with a zebra."""

    def __init__(self, lht: bool, arms: Collection[int] = (0, 1, 2, 3), **more: Any) -> None:
        super().__init__(lht, EDGE, 150.0, more.get("w", 3.5), (more.get("limit", 30), more.get("unit", "mph")))
        lights, stops = more.get("lights", ()), more.get("stops", ())
        zebras: Mapping[int, str] = more.get("zebras", {})
        lanes: list[Lane] = [("driving", self.width), ("sidewalk", more.get("foot", 2.0))]
        across, inbound = -self.near * self.half, -self.near
        kind = ("gb", "601.1", "stop") if lht else ("de", "206", "stop")
        roads = []
        for k in arms:
            a = math.radians(90 * k)
            path = Path(EDGE * math.cos(a), EDGE * math.sin(a), 90 * k).fwd(150.0)
            behind = End("junction", "100")
            road = Road(f"{k + 1}", path, [Sec(0.0, lanes, lanes)], lht, "town", self.limit, self.unit, pred=behind)
            line = 8.0 if k in zebras else 1.5
            if k in zebras:
                road.objects.append(crosswalk(f"c{k}", 5.0, 0.0, 1.6, self.width + 0.1, zebras[k]))
            if k in lights:
                road.signals.append(light(f"L{k}", line - 0.5, across * 2.2, "-", f"traffic_light_{k}", inbound))
            if k in lights or k in stops:
                road.objects.append(stop_line(f"s{k}", line, across, self.width))
            if k in stops:
                road.signals.append(signal(f"S{k}", line + 0.5, across * 2.2, "-", kind, lanes=[inbound]))
            roads.append(road)
        self.map = self.build(arms, roads, more.get("tf", (0, 0, 0)))

    def through(self, begun: Path, i: int, j: int) -> Path:
        turned = (j - i) % 4
        if turned == 2:
            return begun.fwd(2 * EDGE)
        angle = 90 * turned - 180
        near = (angle > 0) == self.lht
        return begun.arc(EDGE - self.half if near else EDGE + self.half, angle)


class Ring(Junction):
    """A roundabout as one junction: into it and out of it along arcs of 10 m."""

    def __init__(self, lht: bool, ring: float = 14.0, tf: Frame = (0, 0, 0)) -> None:
        self.ring, self.bend = ring, 10.0
        edge = math.sqrt((ring + self.bend) ** 2 - (1.75 + self.bend) ** 2)
        super().__init__(lht, edge, 120.0, 3.5, (30, "mph"))
        self.lean = math.degrees(math.atan2(self.half + self.bend, edge))
        lanes: list[Lane] = [("driving", 3.5), ("sidewalk", 2.0)]
        roads = []
        for k in range(4):
            a = math.radians(90 * k)
            path = Path(edge * math.cos(a), edge * math.sin(a), 90 * k).fwd(120.0)
            behind = End("junction", "100")
            roads.append(Road(f"{k + 1}", path, [Sec(0.0, lanes, lanes)], lht, "town", 30, "mph", pred=behind))
        self.map = self.build(range(4), roads, tf)

    def through(self, begun: Path, i: int, j: int) -> Path:
        near, angle = self.near, 90 - self.lean
        quarters = (near * (i - j)) % 4 or 4
        path = begun.arc(self.bend, near * angle).arc(self.ring, -near * (90 * quarters - 2 * self.lean))
        return path.arc(self.bend, near * angle)

    def wrong(self, i: int, j: int) -> Path:
        """The way from arm i to arm j against the traffic of the ring."""
        near, bend = self.near, self.bend
        out = math.sqrt((self.ring + bend) ** 2 - (bend - self.half) ** 2)
        lean = math.degrees(math.atan2(bend - self.half, out))
        quarters = (near * (j - i)) % 4 or 4
        path = self.start(i, self.edge + self.arm).fwd(self.arm + self.edge - out)
        path.arc(bend, -near * (90 - lean)).arc(self.ring, near * (90 * quarters - 2 * lean))
        return path.arc(bend, -near * (90 - lean)).fwd(self.arm)
