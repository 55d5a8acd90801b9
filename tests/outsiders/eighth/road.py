"""Roads with their lanes, lines, crossings, signs and lights, as OpenDRIVE text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from tests.outsiders.eighth.ways import Array, Way

_HEAD: Final = """<?xml version="1.0" encoding="UTF-8"?>
<OpenDRIVE><header revMajor="1" revMinor="6" name="j" version="1" north="2000" south="-2000" east="4000" west="-4000"/>"""

End = tuple[str, int, str]  # road or junction, its number, the end of a road that is met


class Lane(NamedTuple):
    """A lane, from the middle of the road outwards; the mark is that of its outer edge."""

    kind: str = "driving"
    width: float = 3.5
    mark: str = "solid"


class Section(NamedTuple):
    """From s on the road has these lanes to the left and to the right."""

    s: float
    left: tuple[Lane, ...]
    right: tuple[Lane, ...]


class Shape(NamedTuple):
    """A straight, an arc, or a curve through points with the factors of its cubics."""

    x: float
    y: float
    heading: float
    length: float
    curvature: float = 0.0
    points: Array | None = None
    end_heading: float = 0.0
    cubics: tuple[tuple[str, float], ...] = ()

    def way(self) -> Way:
        """Points along it."""
        if self.points is not None:
            way = Way(self.points)
            way.heading[0] = self.heading
            way.heading[-1] += (self.end_heading - way.heading[-1] + math.pi) % (2 * math.pi) - math.pi
            return way
        q = np.linspace(0, self.length, max(2, int(self.length / 0.5) + 1))
        h, k = self.heading, self.curvature
        if k:
            x = self.x + (np.sin(h + k * q) - math.sin(h)) / k
            y = self.y - (np.cos(h + k * q) - math.cos(h)) / k
        else:
            x, y = self.x + q * math.cos(h), self.y + q * math.sin(h)
        return Way(np.column_stack([x, y]), h + k * q)

    def xml(self) -> str:
        """Return its planView."""
        if self.points is not None:
            factors = " ".join(f'{name}="{value:.8f}"' for name, value in self.cubics)
            shape = f'<paramPoly3 pRange="normalized" {factors}/>'
        else:
            shape = f'<arc curvature="{self.curvature:.10f}"/>' if self.curvature else "<line/>"
        return (
            f'<planView>\n<geometry s="{0.0:.8f}" x="{self.x:.8f}" y="{self.y:.8f}" hdg="{self.heading:.8f}" '
            f'length="{self.length:.8f}">\n{shape}\n</geometry>\n</planView>'
        )


@dataclass
class Road:
    """A road of one shape; lanes with positive numbers are on its left."""

    number: int
    shape: Shape
    sections: tuple[Section, ...]
    gb: bool = True
    kind: str = "rural"
    limit: float | None = None
    unit: str = "mph"
    centre: Sequence[tuple[float, str]] = ((0, "broken"),)
    junction: int = -1
    before: End | None = None
    after: End | None = None
    z: float = 0.0
    flare: float = 0.0  # so much wider its lanes are at its end
    joins: dict[int, tuple[int, int]] = field(default_factory=dict)
    objects: list[str] = field(default_factory=list)
    signals: list[str] = field(default_factory=list)

    def offset(self, lane: int) -> float:
        """Return where the middle of a lane is, to the left of the road's middle."""
        lanes = self.sections[0].left if lane > 0 else self.sections[0].right
        at = sum(other.width for other in lanes[: abs(lane) - 1]) + lanes[abs(lane) - 1].width / 2
        return at if lane > 0 else -at

    def way(self, lane: int) -> Way:
        """The middle of a lane, as it is driven."""
        middle = self.shape.way()
        wider = self.flare * middle.s / middle.length * (1 if lane > 0 else -1) / 2
        way = middle.beside(self.offset(lane) + wider)
        return way if self._with(lane) else way.back()

    def crossing(self, at: float, name: str = "zebra", half: float = 3.6) -> Road:
        """Lay a crossing of three metres over it."""
        corners = ((-1.5, -half), (1.5, -half), (1.5, half), (-1.5, half))
        outline = "".join(f'<cornerLocal u="{u}" v="{v}" z="0" height="0"/>' for u, v in corners)
        self.objects.append(
            f'<object id="{900 + len(self.objects)}" type="crosswalk" name="{name}" s="{at}" t="0" zOffset="0" '
            f'orientation="none" hdg="0" pitch="0" roll="0" length="3.0" width="{2 * half}" height="0">'
            f"<outline>{outline}</outline></object>"
        )
        return self

    def sign(self, ident: str, at: float, lane: int, what: tuple[str, str, str], t: float | None = None) -> Road:
        """Put up a sign (name, type, country) for those who drive in a lane."""
        name, kind, country = what
        dynamic = "yes" if kind == "1000001" else "no"
        self.signals.append(
            f'<signal s="{at}" t="{self.offset(lane) if t is None else t}" id="{ident}" name="{name}" '
            f'dynamic="{dynamic}" orientation="{"+" if self._with(lane) else "-"}" zOffset="0" country="{country}" '
            f'type="{kind}" subtype="-1" value="-1" height="0.5" width="0.5">'
            f'<validity fromLane="{lane}" toLane="{lane}"/></signal>'
        )
        return self

    def light(self, ident: str, at: float, lane: int, t: float | None = None) -> Road:
        """Put up a traffic light."""
        return self.sign(ident, at, lane, ("traffic_light", "1000001", "OpenDRIVE"), t)

    def stop_line(self, ident: str, at: float, lane: int) -> Road:
        """Paint a stop line."""
        return self.sign(ident, at, lane, ("stop_line", "294", "DE"))

    def xml(self) -> str:
        """Return it as OpenDRIVE."""
        name = f'name="r{self.number}" length="{self.shape.length:.8f}" id="{self.number}"'
        out = [f'<road rule="{"LHT" if self.gb else "RHT"}" {name} junction="{self.junction}">', "<link>"]
        for how, end in (("predecessor", self.before), ("successor", self.after)):
            if end:
                point = f' contactPoint="{end[2]}"' if end[2] else ""
                out.append(f'<{how} elementType="{end[0]}" elementId="{end[1]}"{point}/>')
        speed = f'<speed max="{self.limit}" unit="{self.unit}"/>' if self.limit else ""
        out += ["</link>", f'<type s="0" type="{self.kind}">{speed}</type>', self.shape.xml()]
        out.append(f'<elevationProfile><elevation s="0" a="{self.z}" b="0" c="0" d="0"/></elevationProfile>')
        out.append("<lateralProfile/><lanes>")
        out += [self._section(index) for index in range(len(self.sections))]
        out.append(f"</lanes><objects>{''.join(self.objects)}</objects>")
        return "\n".join([*out, f"<signals>{''.join(self.signals)}</signals></road>"])

    def _with(self, lane: int) -> bool:
        """Whether a lane is driven as the road runs."""
        return (lane > 0) == self.gb

    def _section(self, index: int) -> str:
        section = self.sections[index]
        left = "".join(self._lane(index, n) for n in range(len(section.left), 0, -1))
        right = "".join(self._lane(index, -n) for n in range(1, len(section.right) + 1))
        centre = "".join(_mark(max(s - section.s, 0), mark) for s, mark in self.centre)
        return "\n".join(
            [
                f'<laneSection s="{section.s}">',
                f"<left>{left}</left>" if left else "",
                f'<center><lane id="0" type="none" level="false">{centre}</lane></center>',
                f"<right>{right}</right>" if right else "",
                "</laneSection>",
            ]
        )

    def _lane(self, index: int, number: int) -> str:
        lane = self._lanes(index, number)[abs(number) - 1]
        links: dict[str, int] = {}
        if number in self.joins:
            links = dict(zip(("predecessor", "successor"), self.joins[number], strict=True))
        for how, other in (("predecessor", index - 1), ("successor", index + 1)):
            if 0 <= other < len(self.sections) and len(self._lanes(other, number)) >= abs(number):
                links[how] = number
        link = "".join(f'<{how} id="{other}"/>' for how, other in links.items())
        slope = self.flare / self.shape.length
        return (
            f'<lane id="{number}" type="{lane.kind}" level="false"><link>{link}</link>'
            f'<width sOffset="0" a="{lane.width}" b="{slope:.8f}" c="0" d="0"/>{_mark(0, lane.mark)}</lane>'
        )

    def _lanes(self, index: int, number: int) -> tuple[Lane, ...]:
        """Return the lanes of a section on the side of a lane of that number."""
        return self.sections[index].left if number > 0 else self.sections[index].right


def _mark(s: float, kind: str) -> str:
    return f'<roadMark sOffset="{s}" type="{kind}" weight="standard" color="white" width="0.12"/>'


class Link(NamedTuple):
    """A way through a junction: from a lane of a road to a lane of a connecting road."""

    incoming: int
    connecting: int
    lanes: tuple[int, int]


class Map(NamedTuple):
    """Roads and the ways through their junctions."""

    roads: tuple[Road, ...]
    junctions: tuple[tuple[int, tuple[Link, ...]], ...] = ()

    def xml(self) -> str:
        """Return the map as OpenDRIVE."""
        out = [_HEAD, *(road.xml() for road in self.roads)]
        for number, links in self.junctions:
            out.append(f'<junction id="{number}" name="j{number}">')
            for index, link in enumerate(links):
                lanes = f'<laneLink from="{link.lanes[0]}" to="{link.lanes[1]}"/>'
                out.append(
                    f'<connection id="{index}" incomingRoad="{link.incoming}" '
                    f'connectingRoad="{link.connecting}" contactPoint="start">{lanes}</connection>'
                )
            out.append("</junction>")
        return "\n".join([*out, "</OpenDRIVE>"]) + "\n"
