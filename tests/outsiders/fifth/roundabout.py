"""A roundabout with four arms: a ring in four parts, joined by four small junctions."""

from __future__ import annotations

import math

from tests.outsiders.fifth.road import Lane, Road, World
from tests.outsiders.fifth.ways import Path

RING, WIDE, WA = 16.0, 4.5, 3.5  # radius of the inner edge, width of the ring's lane and of the arms' lanes
_HALF = math.radians(26)
_TOWN = ("town", 30, True, "mph")


def _near(h0: float, h1: float) -> float:
    return h0 + (h1 - h0 + math.pi) % (2 * math.pi) - math.pi


class Round:
    """A British one: traffic goes clockwise. Arm 0 is in the east, 1 in the north."""

    def __init__(self) -> None:
        lane: list[Lane] = [("driving", WIDE, "none")]
        edge = RING + WIDE + 12
        arm: list[Lane] = [("driving", WA)]
        self.t_in, self.t_out = -WA / 2, WA / 2
        self.arms = [
            Road(
                *(i + 1, edge * math.cos(h), edge * math.sin(h), h, [(90, 0.0)], arm, arm, "broken", *_TOWN),
                pred=("junction", 100 + i),
            )
            for i, h in enumerate(i * math.pi / 2 for i in range(4))
        ]
        self.ring = []
        for i in range(4):
            a = i * math.pi / 2 - _HALF
            geo = [((math.pi / 2 - 2 * _HALF) * RING, -1 / RING)]
            x, y = RING * math.cos(a), RING * math.sin(a)
            self.ring.append(
                Road(
                    *(20 + i, x, y, a - math.pi / 2, geo, lane, [], "solid", *_TOWN),
                    pred=("junction", 100 + i),
                    succ=("junction", 100 + (i - 1) % 4),
                )
            )
        self.ways = [self._joined(i, lane) for i in range(4)]
        links = []
        for i, (through, enters, leaves) in enumerate(self.ways):
            before = self.ring[(i + 1) % 4].id
            links.append((100 + i, [(before, through.id, 1, 1), (i + 1, enters.id, -1, 1), (before, leaves.id, 1, 1)]))
        self.world = World(self.arms + self.ring + [road for three in self.ways for road in three], links)

    def _joined(self, i: int, lane: list[Lane]) -> tuple[Road, Road, Road]:
        """The ways through the junction at arm i: on round the ring, into it, and out of it."""
        arm, before, after = self.arms[i], self.ring[(i + 1) % 4], self.ring[i]
        x, y, h = before.end
        wider: list[Lane] = [("driving", (WA, WIDE), "none")]
        closer: list[Lane] = [("driving", (WIDE, WA), "none")]
        inward = arm.h + math.pi
        through = Road(
            *(200 + i, x, y, h, [(2 * _HALF * RING, -1 / RING)], lane, [], "none", *_TOWN, 100 + i),
            *(("road", before.id, "end"), ("road", after.id, "start")),
            lane_link=(1, 1, 1),
        )
        into = [(after.x, after.y, _near(inward, after.h))]
        enters = Road(
            *(210 + i, arm.x, arm.y, inward, into, wider, [], "none", *_TOWN, 100 + i),
            *(("road", i + 1, "start"), ("road", after.id, "start")),
            lane_link=(1, -1, 1),
        )
        leaves = Road(
            *(220 + i, x, y, h, [(arm.x, arm.y, _near(h, arm.h))], closer, [], "none", *_TOWN, 100 + i),
            *(("road", before.id, "end"), ("road", i + 1, "start")),
            lane_link=(1, 1, 1),
        )
        return through, enters, leaves

    def path(self, i: int, j: int) -> Path:
        """The way from arm i clockwise to arm j."""
        start, end, enters, leaves = self.arms[i], self.arms[j], self.ways[i][1], self.ways[j][2]
        way = start.path((start.length, self.t_in), (0, self.t_in))
        way += enters.path((0, WA / 2), (enters.length, WIDE / 2))
        at = i
        while True:
            ring = self.ring[at]
            way += ring.path((0, WIDE / 2), (ring.length, WIDE / 2))
            at = (at - 1) % 4
            if at == j:
                break
            through = self.ways[at][0]
            way += through.path((0, WIDE / 2), (through.length, WIDE / 2))
        way += leaves.path((0, WIDE / 2), (leaves.length, WA / 2))
        return way + end.path((0, self.t_out), (end.length, self.t_out))

    def wrong_way(self, i: int, j: int) -> Path:
        """The way from arm i to arm j against the traffic."""
        start, end = self.arms[i], self.arms[j]
        radius = RING + WIDE / 2
        a0, a1 = i * math.pi / 2 + 0.5, j * math.pi / 2 - 0.5
        while a1 < a0:
            a1 += 2 * math.pi
        angles = [a0 + (a1 - a0) * n / 60 for n in range(61)]
        ring = [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
        x0, y0, _ = start.pose(0, self.t_in)
        x1, y1, _ = end.pose(0, self.t_out)
        h1 = a1 + math.pi / 2
        enters = Road(0, x0, y0, start.h + math.pi, [(*ring[0], a0 + math.pi / 2)], [], [])
        leaves = Road(0, *ring[-1], h1, [(x1, y1, _near(h1, end.h))], [], [])
        way = start.path((start.length, self.t_in), (0, self.t_in)) + enters.along(0) + Path(ring)
        return way + leaves.along(0) + end.path((0, self.t_out), (end.length, self.t_out))
