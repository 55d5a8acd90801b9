"""Maps of one road: streets, country roads, motorways, crossings for those on foot."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from tests.outsiders.tenth.road import Lane, Road, Section, xodr
from tests.outsiders.tenth.ways import Path, line

FOOT = Lane("sidewalk", 2.0, "none")


@dataclass
class Street:
    """One road with its own side and the other; `own` lanes from the middle outwards go along it."""

    road: Road
    side: int
    own: tuple[Lane, ...]
    other: tuple[Lane, ...] = ()

    def t(self, n: int) -> float:
        """The middle of lane n: 1, 2 .. of the road's direction, -1, -2 .. of the other."""
        lanes = self.own if n > 0 else self.other
        inner = sum(lane.width for lane in lanes[: abs(n) - 1])
        return math.copysign(inner + lanes[abs(n) - 1].width / 2, n) * self.side

    def way(self, n: int, *, wrong: bool = False) -> Path:
        """The way along lane n as it is driven, or against that."""
        return self.road.way(self.t(n), back=(n < 0) != wrong)

    def walk(self, s: float, t0: float, t1: float, s1: float | None = None) -> Path:
        """A way on foot, t measured to the kerb side of the road's own direction."""
        return line(self.road.point(s, t0 * self.side), self.road.point(s if s1 is None else s1, t1 * self.side))

    @property
    def xml(self) -> str:
        """Map with this road only."""
        return xodr([self.road])


def street(
    nation: str,
    own: tuple[Lane, ...],
    other: tuple[Lane, ...] = (),
    *,
    kind: str = "rural",
    speed: tuple[float, str] | None = None,
    length: float = 800.0,
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    pieces: list[tuple[float, float]] | None = None,
    middle: str = "broken",
    parts: Sequence[tuple[float, tuple[Lane, ...], tuple[Lane, ...], str]] | None = None,
) -> Street:
    """A street of one road; `parts` are further sections (s, own, other, middle line)."""
    side = 1 if nation == "gb" else -1
    every = [(0.0, own, other, middle), *(parts or ())]
    sections = [Section(s, a if side > 0 else b, b if side > 0 else a, m) for s, a, b, m in every]
    rule = "LHT" if nation == "gb" else "RHT"
    road = Road(1, start, pieces or [(length, 0.0)], sections, rule, kind, speed)
    return Street(road, side, own, other)


def town(
    width: float = 3.3,
    *,
    own: int = 1,
    other: int = 1,
    nation: str = "gb",
    length: float = 320.0,
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    speed: tuple[float, str] | None = None,
    pieces: list[tuple[float, float]] | None = None,
) -> Street:
    """A street of a town with footways."""
    lane = Lane("driving", width, "broken")
    last = Lane("driving", width, "none")
    mine = tuple([lane] * (own - 1) + [last, FOOT])
    yours = tuple([lane] * (other - 1) + [last, FOOT]) if other else (FOOT,)
    limit = speed or ((30.0, "mph") if nation == "gb" else (50.0, "km/h"))
    return street(nation, mine, yours, kind="town", speed=limit, length=length, start=start, pieces=pieces)


def zebra(at: float = 150.0, kind: str = "zebra", long: float = 3.0, **more: Any) -> Street:
    """A street with a crossing."""
    s = town(**more)
    wide = sum(x.width for x in (*s.own, *s.other) if x.kind == "driving")
    middle = sum(x.width for x in s.own if x.kind == "driving") - wide / 2
    s.road.crossing("c1", at, long, wide, kind=kind, t=s.side * middle)
    return s


def pelican(start: tuple[float, float, float], heads: int = 1, **more: Any) -> Street:
    """A crossing with lights at s=150, its stop line at 145.5."""
    s = zebra(kind="signal", start=start, **more)
    lanes = [k for k, x in enumerate(s.own, 1) if x.kind == "driving"]
    wide = sum(x.width for x in s.own if x.kind == "driving")
    for i in range(heads):
        s.road.light(
            f"P{i}",
            145.5 + 0.2 * i,
            s.side * (wide + 0.6 if i == 0 else -0.2),
            "+",
            (lanes[0], lanes[-1]) if s.side > 0 else (-lanes[-1], -lanes[0]),
        )
    s.road.stop_line("SP", 145.5, s.side * wide / 2, "+", wide - 0.1)
    return s


def lane_road(middle: str = "broken", width: float = 3.6, **more: Any) -> Street:
    """A country road of two lanes."""
    lane = Lane("driving", width, "solid")
    return street("gb", (lane,), (lane,), speed=(60, "mph"), length=1000, middle=middle, **more)


def gb_motorway(lanes: int = 3, *, shoulder: bool = True, **more: Any) -> Street:
    """One carriageway of a motorway."""
    own = tuple(Lane("driving", 3.65, "solid" if i == lanes - 1 else "broken") for i in range(lanes))
    own += (Lane("shoulder", 3.0, "solid"),) if shoulder else ()
    return street("gb", own, (), kind="motorway", speed=(70, "mph"), length=1800, middle="solid", **more)


def back(s: Street, n: int) -> Path:
    """Lane n the wrong way."""
    return s.way(n, wrong=True)


def bahn(lanes: int = 2, speed: tuple[float, str] | None = (120, "km/h"), **more: Any) -> Street:
    """One carriageway of an Autobahn."""
    own = tuple(Lane("driving", 3.75, "solid" if i == lanes - 1 else "broken") for i in range(lanes))
    return street(
        "de",
        (*own, Lane("shoulder", 2.5, "solid")),
        (),
        kind="motorway",
        speed=speed,
        length=1900,
        middle="solid",
        **more,
    )
