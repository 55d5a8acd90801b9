"""Roads of lines and arcs, what stands beside them, and how they are written as OpenDRIVE.

A road is driven along its reference line on the near side: u is the distance from that line to the near side, which is the left in
Great Britain (lanes 1, 2, ...) and the right in Germany (lanes -1, -2, ...).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Frame = tuple[float, float, float]  # turned by, moved in x, moved in y
Links = list[tuple[str, int]]
NOWHERE_ELSE: Frame = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Lane:
    """A lane, and the line at its outer edge."""

    kind: str = "driving"
    width: float = 3.5
    mark: str = "broken"

    def xml(self, number: int, links: Links) -> str:
        """Write it."""
        linked = "".join(f'<{kind} id="{other}"/>' for kind, other in links)
        return (
            f'<lane id="{number}" type="{self.kind}" level="false"><link>{linked}</link>'
            f'<width sOffset="0" a="{_f(self.width)}" b="0" c="0" d="0"/>{_marks([(0.0, self.mark)])}</lane>'
        )


@dataclass
class Section:
    """The lanes from s on: those on the near side, and those of the other direction, inner ones first."""

    s: float
    own: Sequence[Lane]
    opposing: Sequence[Lane]


@dataclass
class Road:
    """A road of pieces (length, curvature)."""

    id: int
    pieces: Sequence[tuple[float, float]]
    start: tuple[float, float, float]
    lht: bool
    kind: str
    limit: float | None
    sections: Sequence[Section]
    middle: Sequence[tuple[float, str]] = ((0.0, "broken"),)
    junction: int = -1
    link: str = ""
    links: dict[int, Links] = field(default_factory=dict)
    types: Sequence[tuple[float, str, float | None]] = ()
    objects: list[str] = field(default_factory=list)
    signals: list[str] = field(default_factory=list)

    @property
    def side(self) -> int:
        return 1 if self.lht else -1

    @property
    def length(self) -> float:
        return sum(length for length, _ in self.pieces)

    def pose(self, s: Floats) -> tuple[Floats, Floats, Floats]:
        """Return x, y and heading of the reference line; beyond its ends it goes on."""
        x, y, h, begin = *self.start, 0.0
        out = np.empty((3, len(s)))
        for i, (length, curve) in enumerate(self.pieces):
            first, last = i == 0, i == len(self.pieces) - 1
            here = (s >= (-np.inf if first else begin)) & (s < (np.inf if last else begin + length))
            out[:, here] = _advance((x, y, h), s[here] - begin, curve)
            x, y, h = (float(v[0]) for v in _advance((x, y, h), np.array([length]), curve))
            begin += length
        return out[0], out[1], out[2]

    def at(self, s: Floats, u: float) -> tuple[Floats, Floats]:
        """Return the points at s, u to the near side."""
        x, y, h = self.pose(s)
        return x - self.side * u * np.sin(h), y + self.side * u * np.cos(h)

    def add_crosswalk(self, s: float, half: float, name: str) -> None:
        """Paint a crossing of three metres from edge to edge."""
        corners = "".join(
            f'<cornerLocal u="{_f(u)}" v="{_f(v)}" z="0" height="0"/>'
            for u, v in ((-1.5, -half), (1.5, -half), (1.5, half), (-1.5, half))
        )
        self.objects.append(
            f'<object id="{self._next()}" type="crosswalk" name="{name}" s="{_f(s)}" t="0.000000" zOffset="0" hdg="0" '
            f'orientation="none" length="3.0" width="{2 * half}"><outline>{corners}</outline></object>'
        )

    def add_stop_line(self, s: float, u: float, width: float) -> None:
        """Paint a stop line."""
        self.objects.append(
            f'<object id="{self._next()}" type="stopLine" name="StopLine" s="{_f(s)}" t="{_f(self.side * u)}" zOffset="0" '
            f'hdg="0" orientation="+" length="0.3" width="{_f(width)}"/>'
        )

    def add_sign(self, s: float, u: float, number: str, name: str = "sign") -> None:
        """Put up a German sign."""
        self.signals.append(
            f'<signal id="{self._next()}" name="{name}" s="{_f(s)}" t="{_f(self.side * u)}" zOffset="2" hOffset="0" '
            f'orientation="+" dynamic="no" country="DE" type="{number}" subtype="-1" value="-1"></signal>'
        )

    def add_light(self, s: float, u: float, name: str, lane: int) -> None:
        """Put up a traffic light for a lane of the near side; 1: the innermost."""
        held = self.side * lane
        self.signals.append(
            f'<signal id="{name}" name="light" s="{_f(s)}" t="{_f(self.side * u)}" zOffset="2" hOffset="0" '
            f'orientation="+" dynamic="yes" country="OpenDRIVE" type="1000001" subtype="-1" value="-1">'
            f'<validity fromLane="{held}" toLane="{held}"/></signal>'
        )

    def _next(self) -> int:
        return 1000 * self.id + len(self.objects) + len(self.signals)

    def xml(self, frame: Frame) -> str:
        """Write it, turned and moved."""
        types = self.types or [(0.0, self.kind, self.limit)]
        return (
            f'<road name="r{self.id}" length="{self.length:.8f}" id="{self.id}" junction="{self.junction}" '
            f'rule="{"LHT" if self.lht else "RHT"}"><link>{self.link}</link>'
            f"{''.join(_type(*one) for one in types)}<planView>{self._plan(frame)}</planView>"
            f"<lanes>{''.join(self._section(i) for i in range(len(self.sections)))}</lanes>"
            f"<objects>{''.join(self.objects)}</objects><signals>{''.join(self.signals)}</signals></road>"
        )

    def _plan(self, frame: Frame) -> str:
        turned, dx, dy = frame
        c, s = math.cos(turned), math.sin(turned)
        x, y, h, begin = *self.start, 0.0
        parts = []
        for length, curve in self.pieces:
            shape = "<line/>" if abs(curve) < 1e-9 else f'<arc curvature="{curve:.10f}"/>'
            parts.append(
                f'<geometry s="{_f(begin)}" x="{c * x - s * y + dx:.8f}" y="{s * x + c * y + dy:.8f}" '
                f'hdg="{h + turned:.10f}" length="{length:.8f}">{shape}</geometry>'
            )
            x, y, h = (float(v[0]) for v in _advance((x, y, h), np.array([length]), curve))
            begin += length
        return "".join(parts)

    def _section(self, i: int) -> str:
        section = self.sections[i]
        middle = self.middle if len(self.sections) == 1 else [(0.0, self.middle[0][1])]
        own = self._side(i, self.side, lambda one: one.own)
        opposing = self._side(i, -self.side, lambda one: one.opposing)
        left, right = (own, opposing) if self.lht else (opposing, own)
        return (
            f'<laneSection s="{_f(section.s)}">'
            + (f"<left>{left}</left>" if left else "")
            + f'<center><lane id="0" type="none" level="false">{_marks(middle)}</lane></center>'
            + (f"<right>{right}</right>" if right else "")
            + "</laneSection>"
        )

    def _side(self, i: int, sign: int, of: Callable[[Section], Sequence[Lane]]) -> str:
        written = []
        for j, lane in enumerate(of(self.sections[i])):
            number = sign * (j + 1)
            beside = (("predecessor", i - 1), ("successor", i + 1))
            along = [
                (kind, number)
                for kind, other in beside
                if 0 <= other < len(self.sections) and j < len(of(self.sections[other]))
            ]
            written.append((number, lane.xml(number, self.links.get(number, along))))
        return "".join(text for _, text in sorted(written, reverse=True))


@dataclass
class Map:
    """Roads, the ways through their junction (from road, by road, from lane, to lane), and where it lies."""

    roads: Sequence[Road]
    connections: Sequence[tuple[int, int, int, int]] = ()
    frame: Frame = NOWHERE_ELSE

    def xml(self) -> str:
        """Write it."""
        ways = "".join(
            f'<connection id="{n}" incomingRoad="{a}" connectingRoad="{b}" contactPoint="start">'
            f'<laneLink from="{c}" to="{d}"/></connection>'
            for n, (a, b, c, d) in enumerate(self.connections)
        )
        junction = f'<junction id="900" name="j900" type="default">{ways}</junction>' if ways else ""
        roads = "".join(road.xml(self.frame) for road in self.roads)
        return (
            '<?xml version="1.0"?><OpenDRIVE><header revMajor="1" revMinor="6" name="m" version="1" date="2026-01-01" '
            f'north="9999" south="-9999" east="9999" west="-9999"/>{roads}{junction}</OpenDRIVE>'
        )


def _advance(start: tuple[float, float, float], d: Floats, curve: float) -> tuple[Floats, Floats, Floats]:
    x, y, h = start
    if abs(curve) < 1e-9:
        return x + d * math.cos(h), y + d * math.sin(h), h + 0 * d
    return (
        x + (np.sin(h + curve * d) - math.sin(h)) / curve,
        y - (np.cos(h + curve * d) - math.cos(h)) / curve,
        h + curve * d,
    )


def _type(s: float, kind: str, limit: float | None) -> str:
    speed = f'<speed max="{_f(limit)}" unit="m/s"/>' if limit else ""
    return f'<type s="{_f(s)}" type="{kind}">{speed}</type>'


def _marks(marks: Iterable[tuple[float, str]]) -> str:
    return "".join(
        f'<roadMark sOffset="{_f(s)}" type="{kind}" weight="standard" color="white" width="0.12"/>' for s, kind in marks
    )


def _f(value: Any) -> str:
    return f"{float(value):.6f}"
