"""Roads as OpenDRIVE text, and ways along them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from tests.outsiders.fifth.shapes import Arc, Curve, Pose, Shape, curve
from tests.outsiders.fifth.ways import Path

Lane = tuple[str, float | tuple[float, float]] | tuple[str, float | tuple[float, float], str]  # kind, width, line
Marks = str | Sequence[tuple[float, str]]
Section = tuple[float, list[Lane], list[Lane]]


@dataclass
class Road:
    """A road; its lanes are given from the middle outwards."""

    id: int
    x: float
    y: float
    h: float
    geo: Sequence[Shape]
    left: list[Lane]
    right: list[Lane]
    mark: Marks = "broken"
    kind: str = "rural"
    limit: float | None = 60
    lht: bool = True
    unit: str = "mph"
    junction: int = -1
    pred: tuple[str, int] | tuple[str, int, str] | None = None
    succ: tuple[str, int] | tuple[str, int, str] | None = None
    objects: list[str] = field(default_factory=list)
    signals: list[str] = field(default_factory=list)
    sections: list[Section] = field(default_factory=list)
    lane_link: tuple[int, int, int] | None = None  # of a road through a junction: lane, the one before, the one after

    def __post_init__(self) -> None:
        self.parts: list[Arc | Curve] = []
        self.length, self.end = 0.0, (self.x, self.y, self.h)
        for shape in self.geo:
            if len(shape) == 3:
                self.parts.append(curve(self.length, self.end, shape))
                self.end = shape
            else:
                self.parts.append(Arc(self.length, shape[0], self.end, shape[1]))
                self.end = self.parts[-1].pose(self.length + shape[0])
            self.length += self.parts[-1].length

    def pose(self, s: float, t: float = 0.0) -> Pose:
        """Return position and heading at s, t metres to the left."""
        part = next((part for part in reversed(self.parts) if s >= part.s - 1e-9), self.parts[0])
        x, y, h = part.pose(s)
        return x - t * math.sin(h), y + t * math.cos(h), h

    def path(self, *places: tuple[float, float]) -> Path:
        """Return the way through places (s, t), gently from one t to the next."""
        points = []
        for (s0, t0), (s1, t1) in itertools.pairwise(places):
            steps = max(3, int(abs(s1 - s0) / 0.5))
            for i in range(steps + 1):
                f = i / steps
                g = f**3 * (10 - 15 * f + 6 * f * f)
                points.append(self.pose(s0 + f * (s1 - s0), t0 + g * (t1 - t0))[:2])
        return Path(points)

    def along(self, t: float, a: float = 0.0) -> Path:
        """Return the way along the road, t metres to the left, from a on."""
        return self.path((a, t), (self.length, t))

    def back(self, t: float) -> Path:
        """Return the way against the road's direction."""
        return self.path((self.length, t), (0, t))

    def xml(self) -> str:
        hand = "LHT" if self.lht else "RHT"
        head = f'<road name="r{self.id}" id="{self.id}" length="{self.length:.6f}" junction="{self.junction}" rule="{hand}">'
        speed = f'<speed max="{self.limit}" unit="{self.unit}"/>' if self.limit else ""
        out = [head, self._links(), f'<type s="0" type="{self.kind}">{speed}</type><planView>']
        for part in self.parts:
            x, y, h = part.start
            out.append(
                f'<geometry s="{part.s:.6f}" x="{x:.6f}" y="{y:.6f}" hdg="{h:.8f}" length="{part.length:.6f}">'
                f"{part.xml()}</geometry>"
            )
        every: list[Section] = [(0.0, self.left, self.right), *self.sections]
        out += ["</planView><lanes>", *(self._section(every, n) for n in range(len(every))), "</lanes>"]
        for tag, things in (("objects", self.objects), ("signals", self.signals)):
            if things:
                out += [f"<{tag}>", *things, f"</{tag}>"]
        return "".join([*out, "</road>"])

    def _links(self) -> str:
        found = ""
        for name, met in (("predecessor", self.pred), ("successor", self.succ)):
            if met:
                end = f' contactPoint="{met[2]}"' if len(met) == 3 else ""
                found += f'<{name} elementType="{met[0]}" elementId="{met[1]}"{end}/>'
        return f"<link>{found}</link>" if found else ""

    def _section(self, every: list[Section], n: int) -> str:
        s, left, right = every[n]
        end = every[n + 1][0] if n + 1 < len(every) else self.length
        marks = [(0.0, self.mark)] if isinstance(self.mark, str) else self.mark
        here = [
            (max(a, s), mark)
            for j, (a, mark) in enumerate(marks)
            if a < end and (j + 1 == len(marks) or marks[j + 1][0] > s)
        ]
        lefts = "".join(self._lane(every, n, i, end - s) for i in range(len(left), 0, -1))
        rights = "".join(self._lane(every, n, -i, end - s) for i in range(1, len(right) + 1))
        return (
            f'<laneSection s="{s:.4f}">'
            + (f"<left>{lefts}</left>" if left else "")
            + '<center><lane id="0" type="none" level="false">'
            + "".join(_mark(f"{a - s:.3f}", mark) for a, mark in here)
            + "</lane></center>"
            + (f"<right>{rights}</right>" if right else "")
            + "</laneSection>"
        )

    def _lane(self, every: list[Section], n: int, number: int, length: float) -> str:
        side, i = (1 if number > 0 else 2), abs(number)
        lanes: list[Lane] = every[n][side]  # type: ignore[assignment]
        lane = lanes[i - 1]
        inner = lane[0] == "driving" and i < len(lanes) and lanes[i][0] == "driving"
        mark = lane[2] if len(lane) == 3 else "broken" if inner else "solid"
        a, b = lane[1] if isinstance(lane[1], tuple) else (lane[1], lane[1])
        if self.lane_link:
            links = f'<predecessor id="{self.lane_link[1]}"/><successor id="{self.lane_link[2]}"/>'
        else:
            links = "".join(
                f'<{name} id="{number}"/>'
                for name, m in (("predecessor", n - 1), ("successor", n + 1))
                if 0 <= m < len(every) and len(every[m][side]) >= i  # type: ignore[arg-type]
            )
        return (
            f'<lane id="{number}" type="{lane[0]}" level="false"><link>{links}</link>'
            f'<width sOffset="0" a="{a}" b="{(b - a) / length:.8f}" c="0" d="0"/>{_mark("0", mark)}</lane>'
        )


def _mark(s: str, kind: str) -> str:
    return f'<roadMark sOffset="{s}" type="{kind}" weight="standard" color="standard" width="0.12"/>'


def area(  # noqa: PLR0917
    ident: str, kind: str, name: str, s: float, t: float, ds: float, dt: float, orient: str = "none"
) -> str:
    """Return an object that covers ds by dt metres, such as a crossing or a stop line."""
    corners = "".join(
        f'<cornerLocal u="{u}" v="{v}" z="0" height="0" id="{i}"/>'
        for i, (u, v) in enumerate(((-ds / 2, -dt / 2), (ds / 2, -dt / 2), (ds / 2, dt / 2), (-ds / 2, dt / 2)))
    )
    return (
        f'<object id="{ident}" type="{kind}" name="{name}" s="{s}" t="{t}" zOffset="0" orientation="{orient}" hdg="0" '
        f'pitch="0" roll="0" length="{ds}" width="{dt}" height="0"><outlines><outline id="0" outer="true" closed="true">'
        f"{corners}</outline></outlines></object>"
    )


def signal(  # noqa: PLR0917
    ident: str,
    name: str,
    s: float,
    t: float,
    orient: str,
    kind: str = "-1",
    country: str = "",
    lanes: tuple[int, int] | None = None,
    dynamic: bool = False,
    width: float = 0.4,
) -> str:
    """Return a sign, a light or a stop line."""
    valid = f'<validity fromLane="{lanes[0]}" toLane="{lanes[1]}"/>' if lanes else ""
    whose = f' country="{country}"' if country else ""
    return (
        f'<signal id="{ident}" s="{s}" t="{t}" name="{name}" dynamic="{"yes" if dynamic else "no"}" '
        f'orientation="{orient}" zOffset="3"{whose} type="{kind}" subtype="-1" height="0.8" width="{width}">'
        f"{valid}</signal>"
    )


@dataclass
class World:
    """Roads, and the ways through their junctions: incoming road, connecting road, its lane, the lane there."""

    roads: list[Road]
    junctions: list[tuple[int, list[tuple[int, int, int, int]]]] = field(default_factory=list)

    def xml(self) -> str:
        head = (
            '<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE><header revMajor="1" revMinor="6" name="g" version="1" '
            'date="2026-11-22" north="2000" south="-2000" east="3000" west="-3000"/>'
        )
        out = [head, *(road.xml() for road in self.roads)]
        for junction, ways in self.junctions:
            out.append(f'<junction id="{junction}" name="j{junction}">')
            out += [
                f'<connection id="{n}" incomingRoad="{i}" connectingRoad="{c}" contactPoint="start">'
                f'<laneLink from="{a}" to="{b}"/></connection>'
                for n, (i, c, a, b) in enumerate(ways)
            ]
            out.append("</junction>")
        return "\n".join(out) + "\n</OpenDRIVE>\n"
