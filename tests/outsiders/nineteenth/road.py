"""Roads in OpenDRIVE."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from tests.outsiders.nineteenth.path import Frame, Path

Marks = str | Sequence[tuple[float, str]]  # one mark, or (from, mark)
Limit = tuple[str, str] | None  # number and unit
Ends = dict[str, str | int]
_OTHER_WAY_ROUND = {"solid broken": "broken solid", "broken solid": "solid broken"}
_LANE_LINKS = ("predecessor", "successor")


@dataclass(frozen=True)
class Lane:
    """A lane, and the lanes before and after it."""

    type: str = "driving"
    width: float = 3.5
    mark: str = "broken"
    before: int | None = None
    after: int | None = None

    def xml(self, number: int, sign: int) -> str:
        pairs = zip(_LANE_LINKS, (self.before, self.after), strict=True)
        links = "".join(f'<{tag} id="{sign * lane}"/>' for tag, lane in pairs if lane is not None)
        return (
            f'<lane id="{number}" type="{self.type}" level="false"><link>{links}</link>'
            f'<width sOffset="0" a="{self.width}" b="0" c="0" d="0"/>{_marks(self.mark)}</lane>'
        )


@dataclass(frozen=True)
class Section:
    """The lanes from s on: those left and those right of the middle, from there outwards."""

    s: float
    left: Sequence[Lane]
    right: Sequence[Lane]

    def xml(self, middle: Marks, frame: Frame) -> Iterator[str]:
        left, right = (self.right, self.left) if frame.mirrored else (self.left, self.right)
        yield f'<laneSection s="{self.s}">'
        if left:
            yield "<left>" + "".join(left[i - 1].xml(i, frame.sign) for i in range(len(left), 0, -1)) + "</left>"
        marks = _marks(_swapped(middle) if frame.mirrored else middle)
        yield f'<center><lane id="0" type="none" level="false"><link/>{marks}</lane></center>'
        if right:
            yield "<right>" + "".join(lane.xml(-i, frame.sign) for i, lane in enumerate(right, 1)) + "</right>"
        yield "</laneSection>"


@dataclass(frozen=True)
class Sign:
    """A sign or a light, for a span of lanes if it says so."""

    id: str
    type: str
    s: float
    t: float
    name: str = ""
    country: str = "DE"
    orientation: str = "+"
    lanes: tuple[int, int] | None = None

    def xml(self, sign: int) -> str:
        span = sorted(sign * lane for lane in self.lanes or ())
        valid = f'<validity fromLane="{span[0]}" toLane="{span[1]}"/>' if span else ""
        return (
            f'<signal s="{self.s}" t="{sign * self.t}" id="{self.id}" name="{self.name}" '
            f'dynamic="{"yes" if self.lanes else "no"}" orientation="{self.orientation}" zOffset="2" '
            f'country="{self.country}" type="{self.type}" subtype="-1" value="-1" height="0.8" width="0.5">'
            f"{valid}</signal>"
        )


@dataclass(frozen=True)
class Thing:
    """A crossing or a stop line: a rectangle on the road."""

    id: str
    type: str
    name: str
    s: float
    t: float
    length: float
    width: float
    orientation: str = "none"

    def xml(self, sign: int) -> str:
        u, v = self.length / 2, self.width / 2
        corners = "".join(
            f'<cornerLocal u="{a}" v="{sign * b}" z="0" height="0"/>' for a, b in ((-u, -v), (u, -v), (u, v), (-u, v))
        )
        return (
            f'<object type="{self.type}" name="{self.name}" subtype="" id="{self.id}" s="{self.s}" t="{sign * self.t}" '
            f'zOffset="0" hdg="0" roll="0" pitch="0" orientation="{self.orientation}" length="{self.length}" '
            f'width="{self.width}" height="0.01"><outline>{corners}</outline></object>'
        )


@dataclass
class Road:
    """One road; a limit of None is not in the map."""

    id: int
    path: Path
    sections: Sequence[Section]
    middle: Marks = "broken"
    type: str = "rural"
    limit: Limit = None
    junction: int = -1
    before: Ends | None = None
    after: Ends | None = None
    signs: list[Sign] = field(default_factory=list)
    things: list[Thing] = field(default_factory=list)

    def xml(self, frame: Frame) -> Iterator[str]:
        rule = "LHT" if frame.mirrored else "RHT"
        yield (
            f'<road name="r{self.id}" length="{self.path.length:.12g}" id="{self.id}" junction="{self.junction}" '
            f'rule="{rule}"><link>'
        )
        for tag, end in zip(_LANE_LINKS, (self.before, self.after), strict=True):
            if end:
                yield f"<{tag} " + " ".join(f'{key}="{value}"' for key, value in end.items()) + "/>"
        limit = f'<speed max="{self.limit[0]}" unit="{self.limit[1]}"/>' if self.limit else ""
        yield f'</link><type s="0" type="{self.type}">{limit}</type>'
        yield from self._plan(frame)
        yield "<lanes>"
        for section in self.sections:
            yield from section.xml(self.middle, frame)
        yield "</lanes><objects>"
        yield from (thing.xml(frame.sign) for thing in self.things)
        yield "</objects><signals>"
        yield from (sign.xml(frame.sign) for sign in self.signs)
        yield "</signals></road>"

    def _plan(self, frame: Frame) -> Iterator[str]:
        yield "<planView>"
        for piece in self.path.pieces:
            x, y, h = (float(q[0]) for q in frame.place(*(np.array([q]) for q in piece[1:4])))
            k = piece.curvature
            shape = f'<arc curvature="{frame.sign * k:.12g}"/>' if abs(k) > 1e-12 else "<line/>"
            yield (
                f'<geometry s="{piece.s:.12g}" x="{x:.9f}" y="{y:.9f}" hdg="{h:.12f}" length="{piece.length:.12g}">'
                f"{shape}</geometry>"
            )
        yield "</planView><elevationProfile/><lateralProfile/>"


@dataclass(frozen=True)
class Connection:
    """A way through the junction: roads, and lanes (from, to)."""

    incoming: int
    connecting: int
    lanes: Sequence[tuple[int, int]]

    def xml(self, number: int, sign: int) -> str:
        links = "".join(f'<laneLink from="{sign * a}" to="{sign * b}"/>' for a, b in self.lanes)
        return (
            f'<connection id="{number}" incomingRoad="{self.incoming}" connectingRoad="{self.connecting}" '
            f'contactPoint="start">{links}</connection>'
        )


@dataclass
class Map:
    """Roads, and the ways through its one junction, if there are any."""

    roads: Sequence[Road]
    ways: Sequence[Connection] = ()

    def xml(self, frame: Frame) -> str:
        parts = ['<?xml version="1.0"?>\n<OpenDRIVE><header revMajor="1" revMinor="4" name="u" version="1.00"/>']
        for road in self.roads:
            parts.extend(road.xml(frame))
        if self.ways:
            parts.append('<junction id="100" name="j100">')
            parts.extend(way.xml(i, frame.sign) for i, way in enumerate(self.ways))
            parts.append("</junction>")
        return "\n".join([*parts, "</OpenDRIVE>"])


def to_road(number: int, contact: str) -> Ends:
    """Return a link to one end of a road."""
    return {"elementType": "road", "elementId": number, "contactPoint": contact}


def to_junction() -> Ends:
    """Return a link to the junction."""
    return {"elementType": "junction", "elementId": 100}


def _marks(marks: Marks) -> str:
    spans = [(0.0, marks)] if isinstance(marks, str) else marks
    return "".join(
        f'<roadMark sOffset="{s}" type="{mark}" weight="standard" color="white" width="0.12" '
        f'laneChange="{"none" if mark.startswith("solid") and mark != "solid broken" else "both"}"/>'
        for s, mark in spans
    )


def _swapped(marks: Marks) -> Marks:
    if isinstance(marks, str):
        return _OTHER_WAY_ROUND.get(marks, marks)
    return [(s, _OTHER_WAY_ROUND.get(mark, mark)) for s, mark in marks]
