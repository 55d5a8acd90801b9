"""Maps: roads as for traffic on the right, written mirrored where it drives on the left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from tests.outsiders.ninth.ways import Piece, Way, along

Marks = Sequence[tuple[float, str]]
Links = dict[int, list[tuple[int, int, str, int, int]]]


class Lane(NamedTuple):
    """A lane of a section, with its width at both ends, the marks at its outer side, and the lanes before and after it."""

    number: int
    kind: str
    width: float
    until: float | None = None
    marks: Marks = ()
    before: int | None = None
    after: int | None = None


class Section(NamedTuple):
    """The lanes from s on, and the marks of the middle."""

    s: float
    lanes: list[Lane]
    middle: Marks


class Signal(NamedTuple):
    """A sign, a light or a line."""

    s: float
    t: float
    name: str = ""
    country: str = ""
    kind: str = "-1"
    orientation: str = "+"
    ident: str = ""
    lanes: tuple[int, ...] = ()
    dynamic: bool = False
    width: float = 0.8

    def xml(self, ident: str, side: int) -> str:
        """Return it as OpenDRIVE."""
        ends = sorted(side * lane for lane in self.lanes)
        validity = f'<validity fromLane="{ends[0]}" toLane="{ends[-1]}"/>' if ends else ""
        country = f' country="{self.country}"' if self.country else ""
        return (
            f'<signal id="{ident}" name="{self.name}" s="{self.s}" t="{side * self.t}" zOffset="0" orientation="{self.orientation}" '
            f'dynamic="{"yes" if self.dynamic else "no"}"{country} type="{self.kind}" subtype="-1" value="-1" width="{self.width}" '
            f'height="0.8">{validity}</signal>'
        )


class Crosswalk(NamedTuple):
    """A crossing for people on foot, from one t to another."""

    s: float
    left: float
    right: float
    name: str = "zebra"

    def xml(self, ident: str, side: int) -> str:
        """Return it as OpenDRIVE."""
        d, w = 1.5, abs(self.right - self.left) / 2
        corners = "".join(
            f'<cornerLocal u="{u}" v="{v}" z="0" height="0.01"/>' for u, v in ((-d, -w), (d, -w), (d, w), (-d, w))
        )
        return (
            f'<object id="{ident}" name="{self.name}" type="crosswalk" s="{self.s}" t="{side * (self.left + self.right) / 2}" '
            f'zOffset="0" hdg="0" pitch="0" roll="0" orientation="none" length="3.0" width="{2 * w}"><outlines>'
            f'<outline id="0" closed="true">{corners}</outline></outlines></object>'
        )


@dataclass
class Road:
    """A road of pieces and sections; before and after it: kind of element, its number, and which end of it."""

    number: int
    pieces: list[Piece]
    sections: list[Section]
    kind: str
    limit: float | None
    unit: str = "km/h"
    junction: int = -1
    before: tuple[str, int, str] | None = None
    after: tuple[str, int, str] | None = None
    signals: list[Signal] = field(default_factory=list)
    crosswalks: list[Crosswalk] = field(default_factory=list)
    bridge: tuple[float, float] | None = None
    level: float = 0.0

    @property
    def length(self) -> float:
        """Its length."""
        return sum(piece.length for piece in self.pieces)

    def xml(self, side: int) -> list[str]:
        """Return its lines of OpenDRIVE."""
        rule = "LHT" if side < 0 else "RHT"
        speed = f'<speed max="{self.limit:g}" unit="{self.unit}"/>' if self.limit else ""
        level = f'<elevationProfile><elevation s="0" a="{self.level}" b="0" c="0" d="0"/></elevationProfile>'
        ends = [*(section.s for section in self.sections[1:]), self.length]
        return [
            f'<road name="" length="{self.length:.6f}" id="{self.number}" junction="{self.junction}" rule="{rule}">',
            "<link>",
            *_linked("predecessor", self.before),
            *_linked("successor", self.after),
            "</link>",
            f'<type s="0" type="{self.kind}">{speed}</type><planView>',
            *self._plan(side),
            "</planView>",
            *([level] if self.level else []),
            "<lanes>",
            *(line for section, end in zip(self.sections, ends, strict=True) for line in _section(section, end, side)),
            "</lanes><objects>",
            *(crosswalk.xml(f"{self.number}{i:02d}", side) for i, crosswalk in enumerate(self.crosswalks)),
            *self._bridge(),
            "</objects><signals>",
            *(signal.xml(signal.ident or f"{self.number}{i:02d}", side) for i, signal in enumerate(self.signals)),
            "</signals></road>",
        ]

    def _bridge(self) -> list[str]:
        if self.bridge is None:
            return []
        return [f'<bridge id="b{self.number}" s="{self.bridge[0]}" length="{self.bridge[1]}" type="concrete"/>']

    def _plan(self, side: int) -> list[str]:
        lines = []
        s = 0.0
        for piece in self.pieces:
            lines.append(
                f'<geometry s="{s:.6f}" x="{piece.x:.6f}" y="{side * piece.y:.6f}" hdg="{side * piece.heading:.9f}" '
                f'length="{piece.length:.6f}">{_shape(piece, side)}</geometry>'
            )
            s += piece.length
        return lines


@dataclass
class Map:
    """Roads, links of junctions (road, connecting road, its end, lane, lane), and routes: a way, where junctions begin and end on it."""

    roads: list[Road]
    junctions: Links = field(default_factory=dict)
    routes: dict[str, tuple[Way, float, float]] = field(default_factory=dict)

    def way(self, left: float, road: int = 0) -> Way:
        """Return the way along one of the roads, so far to its left."""
        return along(self.roads[road].pieces, left)

    def width(self) -> float:
        """Return how wide the first lane is."""
        return self.roads[0].sections[0].lanes[0].width

    def having(self, *things: Signal | Crosswalk) -> Map:
        """Put signals and crossings on the first road."""
        for thing in things:
            (self.roads[0].signals if isinstance(thing, Signal) else self.roads[0].crosswalks).append(thing)  # type: ignore[arg-type]
        return self

    def xml(self, side: int) -> str:
        """Return it as OpenDRIVE; side: -1 where traffic drives on the left."""
        lines = [
            '<?xml version="1.0" encoding="UTF-8"?>',
            "<OpenDRIVE>",
            '<header revMajor="1" revMinor="6" name="" version="1.00" date="2026-11-23T00:00:00"/>',
            *(line for road in self.roads for line in road.xml(side)),
        ]
        for number, links in self.junctions.items():
            lines.append(f'<junction id="{number}" name="">')
            lines += [
                f'<connection id="{i}" incomingRoad="{road}" connectingRoad="{through}" contactPoint="{end}">'
                f'<laneLink from="{side * lane}" to="{side * to}"/></connection>'
                for i, (road, through, end, lane, to) in enumerate(links)
            ]
            lines.append("</junction>")
        return "\n".join([*lines, "</OpenDRIVE>"]) + "\n"


def _linked(tag: str, to: tuple[str, int, str] | None) -> list[str]:
    if to is None:
        return []
    end = f' contactPoint="{to[2]}"' if to[0] == "road" else ""
    return [f'<{tag} elementType="{to[0]}" elementId="{to[1]}"{end}/>']


def _shape(piece: Piece, side: int) -> str:
    if piece.poly:
        bu, cu, du, cv, dv = piece.poly
        return (
            f'<paramPoly3 aU="0" bU="{bu:.9f}" cU="{cu:.9f}" dU="{du:.9f}" aV="0" bV="0" cV="{side * cv:.9f}" '
            f'dV="{side * dv:.9f}" pRange="normalized"/>'
        )
    return f'<arc curvature="{side * piece.curvature:.10f}"/>' if piece.curvature else "<line/>"


def _section(section: Section, end: float, side: int) -> list[str]:
    lanes = [(side * lane.number, _lane(lane, end - section.s, side)) for lane in section.lanes]
    left = [text for number, text in sorted(lanes, reverse=True) if number > 0]
    right = [text for number, text in sorted(lanes, reverse=True) if number < 0]
    middle = "".join(_mark(s, kind, side) for s, kind in section.middle)
    return [
        f'<laneSection s="{section.s:.6f}">',
        *(["<left>" + "".join(left) + "</left>"] if left else []),
        f'<center><lane id="0" type="none" level="false">{middle}</lane></center>',
        *(["<right>" + "".join(right) + "</right>"] if right else []),
        "</laneSection>",
    ]


def _lane(lane: Lane, length: float, side: int) -> str:
    links = (("predecessor", lane.before), ("successor", lane.after))
    link = "".join(f'<{tag} id="{side * number}"/>' for tag, number in links if number is not None)
    slope = ((lane.width if lane.until is None else lane.until) - lane.width) / length
    marks = "".join(_mark(s, kind, side) for s, kind in lane.marks)
    return (
        f'<lane id="{side * lane.number}" type="{lane.kind}" level="false"><link>{link}</link>'
        f'<width sOffset="0" a="{lane.width:.6f}" b="{slope:.9f}" c="0" d="0"/>{marks}</lane>'
    )


def _mark(s: float, kind: str, side: int) -> str:
    kind = " ".join(reversed(kind.split())) if side < 0 else kind
    return f'<roadMark sOffset="{s}" type="{kind}" weight="standard" color="white" width="0.12" laneChange="both"/>'
