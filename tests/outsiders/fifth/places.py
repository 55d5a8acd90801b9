"""The maps on which the drives go: a road, a motorway, a crossing, a junction."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from tests.outsiders.fifth.road import Lane, Marks, Road, World, area, signal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.outsiders.fifth.shapes import Shape
    from tests.outsiders.fifth.ways import Path

W = 3.5
OWN, OPPOSING = 1.75, -1.75  # the middle of the ego's lane and of the opposing one, where the left is driven on


def single(
    geo: Sequence[Shape] = ((900, 0.0),),
    *,
    mark: Marks = "broken",
    kind: str = "rural",
    mph: float | None = 60,
    lht: bool = True,
    w: float = W,
    walk: float = 0.0,
    unit: str = "mph",
    signals: Sequence[str] = (),
    n: int = 1,
) -> tuple[World, Road]:
    """A road with a lane each way (n lanes in its own direction), and footways of `walk` metres."""
    far: list[Lane] = [("sidewalk", walk, "none")] if walk else []
    one: list[Lane] = [("driving", w)]
    left, right = (one * n, one) if lht else (one, one * n)
    road = Road(1, 0, 0, 0, list(geo), left + far, right + far, mark, kind, mph, lht, unit)
    road.signals = list(signals)
    return World([road]), road


def german(length: float = 900, kmh: float | None = 100, **more: Any) -> tuple[World, Road]:
    """A country road in Germany."""
    return single(((length, 0.0),), lht=False, mph=kmh, unit="km/h", **more)


def german_street(length: float = 500, kmh: float | None = 50) -> tuple[World, Road]:
    """A street in a German town."""
    return single(((length, 0.0),), lht=False, mph=kmh, unit="km/h", kind="town", walk=2.0)


def motorway(
    *,
    length: float = 1500,
    lanes: int = 3,
    lht: bool = True,
    mph: float | None = 70,
    exit_at: tuple[float, float] | None = None,
    w: float = 3.65,
    unit: str = "mph",
    signals: Sequence[str] = (),
) -> tuple[World, Road]:
    """A carriageway with its shoulder, s along its inner edge; exit_at: a further lane outside, from and to."""
    shoulder: Lane = ("shoulder", 3.0, "none")
    main: list[Lane] = [("driving", w)] * lanes
    side = [*main, shoulder]
    later: list[tuple[float, list[Lane]]] = []
    if exit_at:
        a, b = exit_at
        later = [
            (a, [*main, ("exit", (0.2, w)), shoulder]),
            (a + 60, [*main, ("exit", w), shoulder]),
            (b, side),
        ]
    left, right = (side, []) if lht else ([], side)
    road = Road(1, 0, 0, 0, [(length, 0.0)], left, right, "solid", "motorway", mph, lht, unit)
    road.sections = [(s, lanes_, []) if lht else (s, [], lanes_) for s, lanes_ in later]
    road.signals = list(signals)
    return World([road]), road


def autobahn(n: int = 3, kmh: float | None = 130, **more: Any) -> tuple[World, Road]:
    """A motorway in Germany."""
    return motorway(lanes=n, lht=False, mph=kmh, unit="km/h", w=3.75, **more)


def lane_t(i: int, lht: bool = True, w: float = 3.65) -> float:
    """Place across of the middle of the i-th lane from the inner edge (1 is the innermost)."""
    return (i - 0.5) * w * (1 if lht else -1)


def spur(i: int) -> float:
    """The same in Germany: 1 is the left lane."""
    return lane_t(i, False, 3.75)


SHOULDER = 3 * 3.65 + 1.5  # the middle of the shoulder beside three British lanes


def zebra(
    *,
    n: int = 1,
    name: str = "zebra",
    mph: float = 30,
    light: bool = False,
    lht: bool = True,
    unit: str = "mph",
    length: float = 500,
) -> tuple[World, Road]:
    """A street with a crossing at s = 200, signalled or not."""
    world, road = single(((length, 0.0),), kind="town", mph=mph, walk=2.2, n=n, lht=lht, unit=unit)
    low, high = (-W, n * W) if lht else (-n * W, W)
    road.objects.append(area("cw", "crosswalk", name, 200, (low + high) / 2, 3.2, high - low))
    if light:
        side, orient, lanes = (1, "+", (1, n)) if lht else (-1, "+", (-n, -1))
        t, half = side * (n * W + 0.7), side * n * W / 2
        road.signals.append(signal("P1", "traffic_light", 196, t, orient, "1000001", "OpenDRIVE", lanes, True))
        road.signals.append(signal("sl", "stop_line", 196.5, half, orient, "294", "DE", lanes, width=n * W - 0.1))
    return world, road


class Cross:
    """Arms round a junction, each a road that runs outwards, and the ways from each to each other."""

    def __init__(
        self,
        angles: Sequence[float] = (180, 270, 0, 90),
        *,
        lht: bool = True,
        length: float = 120,
        mph: float = 30,
        unit: str = "mph",
        w: float = W,
        walk: float = 0.0,
    ) -> None:
        self.w, edge = w, 13.0
        far: list[Lane] = [("sidewalk", walk, "none")] if walk else []
        side: list[Lane] = [("driving", w), *far]
        self.into, self.out = (-1, 1) if lht else (1, -1)
        self.t_in, self.t_out = self.into * w / 2, self.out * w / 2
        self.arms: list[Road] = []
        for i, angle in enumerate(angles, 1):
            h = math.radians(angle)
            x, y, geo = edge * math.cos(h), edge * math.sin(h), [(length, 0.0)]
            self.arms.append(
                Road(i, x, y, h, geo, side, side, "broken", "town", mph, lht, unit, pred=("junction", 100))
            )
        self.ways: dict[tuple[int, int], Road] = {}
        links = []
        for i, j in ((i, j) for i in range(len(angles)) for j in range(len(angles)) if i != j):
            road = self._way(i, j, lht, mph, unit)
            self.ways[i, j] = road
            links.append((i + 1, road.id, self.into, self.out))
        self.world = World(self.arms + list(self.ways.values()), [(100, links)])

    def _way(self, i: int, j: int, lht: bool, mph: float, unit: str) -> Road:
        start, end = self.arms[i], self.arms[j]
        h0 = start.h + math.pi
        h1 = h0 + (end.h - h0 + math.pi) % (2 * math.pi) - math.pi
        lane: list[Lane] = [("driving", self.w, "none")]
        left, right = (lane, []) if lht else ([], lane)
        return Road(
            *(100 + 10 * i + j, start.x, start.y, h0, [(end.x, end.y, h1)], left, right),
            *("none", "town", mph, lht, unit),
            junction=100,
            pred=("road", i + 1, "start"),
            succ=("road", j + 1, "start"),
            lane_link=(self.out, self.into, self.out),
        )

    def path(self, i: int, j: int, din: float = 0.0, dout: float = 0.0, dmid: float | None = None) -> Path:
        """The way from arm i to arm j, so many metres further from its near edge than the lane's middle is."""
        way, start, end, out = self.ways[i, j], self.arms[i], self.arms[j], self.out
        ti, to = self.t_in - out * din, self.t_out + out * dout
        m0, m1 = out * (self.w / 2 + din), out * (self.w / 2 + dout)
        places = [(0, m0), (way.length, m1)]
        if dmid is not None:
            places.insert(1, (way.length / 2, out * (self.w / 2 + dmid)))
        return start.path((start.length, ti), (0.0, ti)) + way.path(*places) + end.path((0.0, to), (end.length, to))

    def line(self, i: int, kind: str = "signal") -> None:
        """Draw a stop line on arm i, a metre before the junction, as a signal or as an object."""
        arm = self.arms[i]
        if kind == "signal":
            lanes, width = (self.into, self.into), self.w - 0.1
            arm.signals.append(signal(f"sl{i}", "stop_line", 1.0, self.t_in, "-", "294", "DE", lanes, width=width))
        else:
            arm.objects.append(area(f"slo{i}", "stopLine", "stopline", 1.0, self.t_in, 0.3, self.w - 0.2, "-"))

    def light(self, i: int, ident: str, s: float = 0.5) -> None:
        lanes, t = (self.into, self.into), self.into * (self.w + 0.8)
        one = signal(ident, "traffic_light", s, t, "-", "1000001", "OpenDRIVE", lanes, True)
        self.arms[i].signals.append(one)

    def sign(self, i: int, name: str, kind: str, country: str) -> None:
        lanes, t = (self.into, self.into), self.into * (self.w + 0.8)
        self.arms[i].signals.append(signal(f"sg{i}{name}", name, 1.5, t, "-", kind, country, lanes))

    def front(self, i: int, path: Path, s: float) -> float:
        """How far along the path from arm i it is s metres before the junction."""
        return path.near(*self.arms[i].pose(s, self.t_in)[:2])

    def crossing(self, i: int, j: int, path: Path) -> float:
        """How far along a path it is nearest to the middle of the way from i to j."""
        way = self.ways[i, j]
        return path.near(*way.pose(way.length / 2, self.out * 1.75)[:2])


def lit(lamps: bool = True, kind: str = "signal", **more: Any) -> Cross:
    """A crossroads, with a stop line and the light L0 on arm 0 if it has lamps."""
    cross = Cross(**more)
    if lamps:
        cross.line(0, kind)
        cross.light(0, "L0")
    return cross


def tee() -> Cross:
    """A road that ends at another, with a stop sign."""
    cross = Cross((270, 180, 0))
    cross.line(0, "object")
    cross.sign(0, "Stop", "601.1", "GB")
    return cross


def german_tee() -> Cross:
    """The same in Germany."""
    cross = Cross((270, 180, 0), lht=False, mph=50, unit="km/h")
    cross.line(0)
    cross.sign(0, "Haltgebot", "206", "DE")
    return cross


WEST, SOUTH, EAST, NORTH = range(4)  # the arms of a crossroads
RIGHT, ONCOMING = -1.75, 1.75  # the lanes of a German road


def overtaking(
    road: Road,
    a: float,
    b: float,
    over: float = 45.0,
    t1: float = OPPOSING,
) -> Path:
    """The way of one that begins to leave its lane at a and to come back at b, and takes so many metres for each."""
    return road.path((20.0, OWN), (a, OWN), (a + over, t1), (b, t1), (b + over, OWN), (road.length, OWN))
