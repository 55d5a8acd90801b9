"""Maps: a road of two lanes, a motorway, one with an exit, a crossroads, a roundabout; and what stands on them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tests.outsiders.nineteenth.path import Bend, Path, line
from tests.outsiders.nineteenth.road import (
    Connection,
    Lane,
    Limit,
    Map,
    Marks,
    Road,
    Section,
    Sign,
    Thing,
    to_junction,
    to_road,
)

WIDTH = 3.5
MOTORWAY_WIDTH = 3.75
MPH_30, MPH_60, MPH_70 = ("30", "mph"), ("60", "mph"), ("70", "mph")
KMH_50, KMH_60, KMH_100, KMH_130 = ("50", "km/h"), ("60", "km/h"), ("100", "km/h"), ("130", "km/h")
ARMS = (180, 0, 90, 270)  # where a junction's arms come from, in degrees
LONG, STREET, NEAR_CROSSING = line(3000), line(500), line(400)


def two_lanes(
    path: Path,
    middle: Marks = "broken",
    kind: str = "rural",
    limit: Limit = None,
    *,
    width: float = WIDTH,
    footway: float = 0.0,
    number: int = 1,
) -> Road:
    """Return a road with a lane each way."""
    lanes = [Lane("driving", width, "solid")] + [Lane("sidewalk", footway, "none")] * bool(footway)
    return Road(number, path, [Section(0.0, lanes, lanes)], middle, kind, limit)


def country(middle: Marks = "broken", limit: Limit = MPH_60, signs: Sequence[Sign] = ()) -> Map:
    """Return a long straight road through open country."""
    road = two_lanes(LONG, middle, "rural", limit)
    road.signs += signs
    return Map([road])


def street() -> Map:
    """Return a straight street with footways."""
    return Map([two_lanes(STREET, "broken", "town", MPH_30, footway=2.0)])


def carriageway(
    path: Path,
    lanes: int,
    kind: str = "motorway",
    limit: Limit = None,
    *,
    width: float = MOTORWAY_WIDTH,
    shoulder: bool = True,
) -> Road:
    """Return a road of one direction."""
    row = [Lane("driving", width, "broken" if i < lanes - 1 else "solid") for i in range(lanes)]
    row += [Lane("shoulder", 2.5, "none")] * shoulder
    return Road(1, path, [Section(0.0, [], row)], "solid", kind, limit)


def middle_of(lane: int) -> float:
    """Return where the middle of a motorway's lane is; 1 is the fastest."""
    return -(lane - 0.5) * MOTORWAY_WIDTH


def stop_line(name: str, s: float) -> Thing:
    """Return a stop line across the lane that goes along the road."""
    return Thing(name, "stopLine", "stopline", s, -WIDTH / 2, 0.3, WIDTH, "+")


def light(name: str, s: float) -> Sign:
    """Return a light for the lane that goes along the road."""
    return Sign(name, "1000001", s, -(WIDTH + 1), "Signal_3Light", "OpenDRIVE", lanes=(-1, -1))


class Exit:
    """A motorway of two lanes, with an exit lane from 500 m to 750 m, where it parts."""

    def __init__(self, signs: Sequence[Sign] = ()) -> None:
        width, begin, part, end, limit = MOTORWAY_WIDTH, 500.0, 750.0, 1200.0, None
        shoulder = Lane("shoulder", 2.5, "none")
        before = [Lane("driving", width, "broken" if k < 2 else "solid", None, -k) for k in (1, 2)]
        beside = [Lane("driving", width, "broken", -k, None) for k in (1, 2)]
        through = [Lane("driving", width, "broken", -k, -k) for k in (1, 2)]
        behind = [Lane("driving", width, "broken" if k < 2 else "solid", -k) for k in (1, 2)]
        main = Road(
            1,
            line(part),
            [Section(0.0, [], [*before, shoulder]), Section(begin, [], [*beside, Lane("exit", width, "solid")])],
            "solid",
            "motorway",
            limit,
            after=to_junction(),
            signs=list(signs),
        )
        on = Road(
            2,
            Path(part + 30, 0, 0, [(end - part - 30, 0)]),
            [Section(0.0, [], [*behind, shoulder])],
            "solid",
            "motorway",
            limit,
            before=to_junction(),
        )
        parting = Path(part, -2 * width, 0, [(30, -1 / 150)])
        slip = Road(
            3,
            Path(*parting.end, [(80, -1 / 150), (200, 0)]),
            [Section(0.0, [], [Lane("driving", width, "solid", -1)])],
            "solid",
            "motorway",
            limit,
            before=to_junction(),
        )
        ways = [
            _through(10, Path(part, 0, 0, [(30, 0)]), through, 2),
            _through(11, parting, [Lane("driving", width, "solid", -3, -1)], 3),
        ]
        self.map = Map(
            [main, on, slip, *ways], [Connection(1, 10, [(-1, -1), (-2, -2)]), Connection(1, 11, [(-3, -1)])]
        )
        self.on = line(end)
        self.off = Path(0, -2 * width, 0, [(part, 0), (110, -1 / 150), (200, 0)])


def _through(number: int, path: Path, lanes: Sequence[Lane], to: int) -> Road:
    """Return a way of the motorway's junction."""
    return Road(
        number,
        path,
        [Section(0.0, [], lanes)],
        "solid",
        "motorway",
        None,
        100,
        to_road(1, "end"),
        to_road(to, "start"),
    )


class Junction:
    """Four arms, each a road that begins far out and ends at the junction, and a way from each to each."""

    edge: float  # from the middle to where an arm ends
    length: float  # of an arm
    beyond: float  # how far routes go on

    def __init__(self, width: float) -> None:
        self.width = width
        self.arms = {}
        for i, arm in enumerate(ARMS):
            angle, far = math.radians(arm), self.edge + self.length
            path = Path(far * math.cos(angle), far * math.sin(angle), angle + math.pi, [(self.length, 0)])
            road = two_lanes(path, "broken", "town", KMH_50, width=width, number=i + 1)
            road.after = to_junction()
            self.arms[arm] = road
        self.ways: dict[tuple[int, int], Path] = {}
        roads, connections = list(self.arms.values()), []
        pairs = [(i, j) for i in range(4) for j in range(4) if i != j]
        for number, (i, j) in enumerate(pairs, 10):
            way = self.ways[ARMS[i], ARMS[j]] = self._way(ARMS[i], ARMS[j])
            roads.append(
                Road(
                    number,
                    way.offset(width / 2),
                    [Section(0.0, [], [Lane("driving", width, "none", -1, 1)])],
                    "none",
                    "town",
                    KMH_50,
                    100,
                    to_road(i + 1, "end"),
                    to_road(j + 1, "end"),
                )
            )
            connections.append(Connection(i + 1, number, [(-1, -1)]))
        self.map = Map(roads, connections)

    def route(self, come: int, go: int) -> Path:
        """Return the middle of the lane in by one arm and out by another; the junction begins where the arm ends."""
        lane = self.arms[come].path.offset(-self.width / 2)
        return Path(lane.x, lane.y, lane.heading, lane.bends + self.ways[come, go].bends + [(self.beyond, 0)])

    def _corner(self, arm: int, heading: float) -> tuple[float, float]:
        """Return where the middle of the lane of that heading meets the junction's edge."""
        angle = math.radians(arm)
        return (
            self.edge * math.cos(angle) + self.width / 2 * math.sin(heading),
            self.edge * math.sin(angle) - self.width / 2 * math.cos(heading),
        )

    def _way(self, come: int, go: int) -> Path:
        raise NotImplementedError


class Cross(Junction):
    """A crossroads; arms may have a stop line with a stop sign or with a light."""

    edge, length, beyond = 12.0, 150.0, 200.0

    def __init__(self, signed: Sequence[int] = (), lit: Sequence[int] = ()) -> None:
        super().__init__(WIDTH)
        for arm in (*signed, *lit):
            self.arms[arm].things.append(stop_line(f"sl{arm}", self.length - 1.0))
        for arm in signed:
            self.arms[arm].signs.append(Sign(f"sg{arm}", "206", self.length - 2.0, -4.5))
        for arm in lit:
            self.arms[arm].signs.append(light(f"tl{arm}", self.length - 1.0))

    def _way(self, come: int, go: int) -> Path:
        h0, h1 = math.radians(come) + math.pi, math.radians(go)
        (x0, y0), (x1, y1) = self._corner(come, h0), self._corner(go, h1)
        turned = (h1 - h0 + math.pi) % (2 * math.pi) - math.pi
        if abs(turned) < 1e-6:
            return Path(x0, y0, h0, [(math.hypot(x1 - x0, y1 - y0), 0)])
        # as far to where the two lanes' middles would meet
        det = math.cos(h0) * math.sin(h1) - math.sin(h0) * math.cos(h1)
        before = ((x1 - x0) * math.sin(h1) - (y1 - y0) * math.cos(h1)) / det
        radius = before / math.tan(abs(turned) / 2)
        return Path(x0, y0, h0, [(abs(turned) * radius, math.copysign(1 / radius, turned))])


class Roundabout(Junction):
    """A ring of one lane; its ways in and out are arcs that touch the ring."""

    ring, curb, length, beyond = 16.0, 12.0, 120.0, 120.0

    def __init__(self) -> None:
        half = 2.0
        self.edge = math.sqrt((self.ring + self.curb) ** 2 - (half + self.curb) ** 2)
        self.sector = math.asin((half + self.curb) / (self.ring + self.curb))
        super().__init__(2 * half)

    def _way(self, come: int, go: int) -> Path:
        h0 = math.radians(come) + math.pi
        side: Bend = (self.curb * (math.pi / 2 - self.sector), -1 / self.curb)
        around = math.radians((go - come) % 360) - 2 * self.sector
        return Path(*self._corner(come, h0), h0, [side, (self.ring * around, 1 / self.ring), side])
