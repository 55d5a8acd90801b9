"""Roads with a junction as OpenDRIVE text, drawn for right-hand traffic and mirrored for left-hand traffic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

Kinds = Sequence[tuple[float, str, float | None]]  # s, kind of road, limit in m/s
Sections = Sequence[tuple[float, Sequence["Lane"], Sequence["Lane"]]]  # s, left, right


class Lane(NamedTuple):
    """A lane, counted outwards from the reference line; `mark` is the line at its outer border."""

    kind: str = "driving"
    width: float = 3.5
    mark: str = "solid"
    pred: int | None = None
    succ: int | None = None

    def xml(self, number: int, flip: int) -> str:
        links = f'<predecessor id="{self.pred * flip}"/>' if self.pred is not None else ""
        links += f'<successor id="{self.succ * flip}"/>' if self.succ is not None else ""
        return (
            f'<lane id="{number}" type="{self.kind}" level="false"><link>{links}</link>'
            f'<width sOffset="0" a="{self.width}" b="0" c="0" d="0"/>'
            f'<roadMark sOffset="0" type="{self.mark}" weight="standard" color="standard" width="0.12"/></lane>'
        )


class Sign(NamedTuple):
    """A sign or light."""

    ident: str
    s: float
    t: float
    name: str
    kind: str

    def xml(self, flip: int) -> str:
        dynamic = "yes" if "light" in self.name else "no"
        return (
            f'<signal id="{self.ident}" name="{self.name}" s="{self.s!r}" t="{self.t * flip!r}" orientation="+" '
            f'dynamic="{dynamic}" country="OpenDRIVE" type="{self.kind}" subtype="-1" zOffset="2" height="0.6" '
            'width="0.6" value="-1"/>'
        )


class Area(NamedTuple):
    """A crossing or stop line over the road between t0 and t1, `depth` metres along it."""

    ident: str
    kind: str
    name: str
    s: float
    t0: float
    t1: float
    depth: float

    def xml(self, flip: int) -> str:
        t, half, deep = (self.t0 * flip + self.t1 * flip) / 2, abs(self.t1 - self.t0) / 2, self.depth / 2
        corners = ((-deep, -half), (deep, -half), (deep, half), (-deep, half))
        outline = "".join(
            f'<cornerLocal id="{i}" u="{u!r}" v="{v!r}" z="0" height="0"/>' for i, (u, v) in enumerate(corners)
        )
        return (
            f'<object id="{self.ident}" type="{self.kind}" name="{self.name}" s="{self.s!r}" t="{t!r}" zOffset="0" '
            f'hdg="0" orientation="none" length="{self.depth!r}" width="{2 * half!r}">'
            f'<outlines><outline id="0" closed="true" outer="true">{outline}</outline></outlines></object>'
        )


def crossing(ident: str, s: float, t0: float, t1: float, name: str) -> Area:
    return Area(ident, "crosswalk", name, s, t0, t1, 3.0)


def stop_line(ident: str, s: float, t0: float, t1: float) -> Area:
    return Area(ident, "stopLine", "stop_line", s, t0, t1, 0.3)


@dataclass
class Road:
    """A road as drawn for right-hand traffic: `right` lanes are driven along s, `left` lanes against it."""

    ident: int
    start: tuple[float, float, float]  # x, y, heading
    geometry: Sequence[tuple[float, float]]  # length, curvature
    sections: Sections
    centre: str = "broken"
    types: Kinds = ()
    junction: int = -1
    pred: tuple[str, int, str] | None = None  # road or junction, id, contact point
    succ: tuple[str, int, str] | None = None
    height: float = 0.0
    signs: list[Sign] = field(default_factory=list)
    areas: list[Area] = field(default_factory=list)

    def xml(self, flip: int) -> str:
        """Return the road; mirrored at the x axis where flip is -1."""
        types = "".join(
            f'<type s="{at}" type="{kind}">' + (f'<speed max="{limit!r}" unit="m/s"/>' if limit else "") + "</type>"
            for at, kind, limit in self.types
        )
        sections = "".join(self._section(at, left, right, flip) for at, left, right in self.sections)
        objects, signals = (
            "".join(area.xml(flip) for area in self.areas),
            "".join(sign.xml(flip) for sign in self.signs),
        )
        length = sum(piece for piece, _ in self.geometry)
        return (
            f'<road name="" length="{length!r}" id="{self.ident}" junction="{self.junction}" '
            f'rule="{"LHT" if flip < 0 else "RHT"}">'
            f"<link>{self._links()}</link>{types}<planView>{self._plan(flip)}</planView>"
            f'<elevationProfile><elevation s="0" a="{self.height}" b="0" c="0" d="0"/></elevationProfile>'
            f"<lanes>{sections}</lanes><objects>{objects}</objects><signals>{signals}</signals></road>\n"
        )

    def _links(self) -> str:
        links = ""
        for word, link in (("predecessor", self.pred), ("successor", self.succ)):
            if link is not None:
                contact = f' contactPoint="{link[2]}"' if link[0] == "road" else ""
                links += f'<{word} elementType="{link[0]}" elementId="{link[1]}"{contact}/>'
        return links

    def _plan(self, flip: int) -> str:
        plan, s, (x, y, h) = "", 0.0, self.start
        for piece, curvature in self.geometry:
            shape = f'<arc curvature="{curvature * flip!r}"/>' if curvature else "<line/>"
            plan += f'<geometry s="{s!r}" x="{x!r}" y="{y * flip!r}" hdg="{h * flip!r}" length="{piece!r}">'
            plan += f"{shape}</geometry>"
            if curvature:
                x += (math.sin(h + curvature * piece) - math.sin(h)) / curvature
                y -= (math.cos(h + curvature * piece) - math.cos(h)) / curvature
                h += curvature * piece
            else:
                x, y = x + piece * math.cos(h), y + piece * math.sin(h)
            s += piece
        return plan

    def _section(self, at: float, left: Sequence[Lane], right: Sequence[Lane], flip: int) -> str:
        up, down = _lanes(left, flip, flip), _lanes(right, -flip, flip)
        if flip < 0:
            up, down = down, up
        return (
            f'<laneSection s="{at!r}">'
            + (f"<left>{up}</left>" if up else "")
            + f'<center><lane id="0" type="none" level="false"><roadMark sOffset="0" type="{self.centre}" '
            + 'weight="standard" color="standard" width="0.12"/></lane></center>'
            + (f"<right>{down}</right>" if down else "")
            + "</laneSection>"
        )


def _lanes(lanes: Sequence[Lane], sign: int, flip: int) -> str:
    """Return the lanes of one side, the highest number first; `sign` is that of their numbers."""
    parts = [(sign * number, lane.xml(sign * number, flip)) for number, lane in enumerate(lanes, 1)]
    return "".join(text for _, text in sorted(parts, reverse=True))


@dataclass
class World:
    """A map: roads and the connections (incoming road, connecting road, lane links) of its one junction."""

    roads: list[Road]
    connections: list[tuple[int, int, list[tuple[int, int]]]] = field(default_factory=list)

    def xml(self, flip: int) -> str:
        """Return the map as OpenDRIVE."""
        junction = ""
        for number, (incoming, connecting, links) in enumerate(self.connections):
            pairs = "".join(f'<laneLink from="{a * flip}" to="{b * flip}"/>' for a, b in links)
            junction += f'<connection id="{number}" incomingRoad="{incoming}" connectingRoad="{connecting}" '
            junction += f'contactPoint="start">{pairs}</connection>'
        if junction:
            junction = f'<junction id="100" name="">{junction}</junction>'
        roads = "".join(road.xml(flip) for road in self.roads)
        header = '<header revMajor="1" revMinor="7" name="drawn" version="1" north="0" south="0" east="0" west="0"/>'
        return f'<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE>{header}\n{roads}{junction}</OpenDRIVE>\n'
