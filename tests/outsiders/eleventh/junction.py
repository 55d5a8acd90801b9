"""Junctions: crossroads, and roundabouts as one junction."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tests.outsiders.eleventh.road import GB, Lane, Path, Section, W, road, whole

ARMS = {"s": -np.pi / 2, "w": np.pi, "n": np.pi / 2, "e": 0.0}


@dataclass
class Cross:
    """A junction: arms around the origin by their outward angle; ways through it by name of arm."""

    side: int
    arms: dict[str, float]
    reach: float = 12.0
    arm: float = 120.0
    kind: str = "town"
    speed: float = 30.0
    ring: float = 0.0
    verge: str = ""
    w: float = W
    signals: dict[str, str] = field(default_factory=dict)
    objects: dict[str, str] = field(default_factory=dict)

    def ways(self, a: str, b: str) -> list[tuple[float, float]]:
        """The segments through the junction from arm a to arm b."""
        if self.ring:
            return self.round_ways(a, b)
        turn = (self.arms[b] - self.arms[a] - np.pi + 5 * np.pi) % (2 * np.pi) - np.pi
        if abs(turn) < 1e-6:
            return [(2 * self.reach, 0.0)]
        left = 1 if turn > 0 else -1
        r = self.reach - left * self.side * self.w / 2
        return [(r * np.pi / 2, left / r)]

    def round_ways(self, a: str, b: str) -> list[tuple[float, float]]:
        """The segments round a roundabout: in, round, out."""
        r, big = 14.0, self.ring
        phi = np.arccos((self.w / 2 + r) / (big + r))
        inward = phi
        back = np.pi / 2 - phi
        gap = (self.arms[a] - self.arms[b]) * self.side % (2 * np.pi)
        gap = gap or 2 * np.pi
        return [(r * inward, self.side / r), (big * (gap - 2 * back), -self.side / big), (r * inward, self.side / r)]

    def entry(self) -> float:
        """How far from the middle an arm of a roundabout ends."""
        r = 14.0
        return float(np.sqrt((self.ring + r) ** 2 - (self.w / 2 + r) ** 2))

    @property
    def edge(self) -> float:
        """How far from the middle an arm ends."""
        return self.entry() if self.ring else self.reach

    def route(self, a: str, b: str, before: float = 0.0, after: float = 0.0) -> Path:
        """The way that a vehicle goes from arm a to arm b; s is counted from `before` metres before the junction."""
        before = before or self.arm
        t = self.arms[a]
        far = self.edge + before
        off = -self.side * self.w / 2
        x, y = far * np.cos(t) - off * np.sin(t), far * np.sin(t) + off * np.cos(t)
        return Path(x, y, t + np.pi, [(before, 0.0), *self.ways(a, b), (after or self.arm, 0.0)])

    def text(self) -> str:
        """The map."""
        unit = "mph" if self.side == GB else "km/h"
        out, links = "", ""
        ids = {a: i + 1 for i, a in enumerate(self.arms)}
        for a, t in self.arms.items():
            path = Path(self.edge * np.cos(t), self.edge * np.sin(t), t, [(self.arm, 0.0)])
            lanes = [Lane("driving", self.w, "solid")]
            if self.verge:
                lanes.append(Lane(self.verge, 2.0, "none"))
            out += road(
                ids[a],
                path,
                [Section(0.0, lanes, lanes)],
                self.side,
                self.kind,
                self.speed,
                unit,
                pred='<predecessor elementType="junction" elementId="100"/>',
                signals=self.signals.get(a, ""),
                objects=self.objects.get(a, ""),
            )
        cid = 200
        for a in self.arms:
            for b in self.arms:
                if a == b:
                    continue
                cid += 1
                way = self.route(a, b, 1.0, 1.0)
                x, y, h = way.at(np.array([1.0]), np.array([0.0]))
                path = Path(float(x[0]), float(y[0]), float(h[0]), self.ways(a, b))
                lane = Lane("driving", self.w, "none", pred=-self.side, succ=self.side)
                none = [(0.0, "none")]
                sec = Section(0.0, [lane], [], none) if self.side == GB else Section(0.0, [], [lane], none)
                out += road(
                    cid,
                    path,
                    [sec],
                    self.side,
                    self.kind,
                    self.speed,
                    unit,
                    junction=100,
                    pred=f'<predecessor elementType="road" elementId="{ids[a]}" contactPoint="start"/>',
                    succ=f'<successor elementType="road" elementId="{ids[b]}" contactPoint="start"/>',
                    offset=-self.side * self.w / 2,
                )
                links += (
                    f'<connection id="{cid}" incomingRoad="{ids[a]}" connectingRoad="{cid}" contactPoint="start">'
                    f'<laneLink from="{-self.side}" to="{self.side}"/></connection>'
                )
        return whole(out, f'<junction id="100" name="j" type="default">{links}</junction>\n')
