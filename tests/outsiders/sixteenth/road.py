"""Roads in OpenDRIVE. What is drawn keeps to the right; for Great Britain it is written as its mirror image."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from tests.outsiders.sixteenth.ways import Path

_HEADER = '<?xml version="1.0"?>\n<OpenDRIVE><header revMajor="1" revMinor="6" name="r" version="1"/>'


class Frame(NamedTuple):
    """How a map lies: mirrored or not, turned, and shifted."""

    mirrored: bool = False
    turned: float = 0.0
    x: float = 0.0
    y: float = 0.0

    def place(self, x: float, y: float, heading: float) -> tuple[float, float, float]:
        """Return a place and a heading as they are written."""
        y, heading = self.side * y, self.side * heading
        c, s = math.cos(self.turned), math.sin(self.turned)
        return x * c - y * s + self.x, x * s + y * c + self.y, heading + self.turned

    @property
    def side(self) -> int:
        """What the signs of lanes and places across are multiplied with."""
        return -1 if self.mirrored else 1


class Lane(NamedTuple):
    """A lane, named by its place from the middle outwards."""

    kind: str = "driving"
    width: float = 3.5
    mark: str = "broken"
    limit: float | None = None


class Stretch(NamedTuple):
    """The lanes from a place on: to the right, and to the left, of the middle."""

    s: float
    right: Sequence[Lane]
    left: Sequence[Lane] = ()

    def side(self, sign: int) -> Sequence[Lane]:
        """The lanes of the negative or the positive numbers."""
        return self.right if sign < 0 else self.left


class End(NamedTuple):
    """What a road is linked to."""

    kind: str
    id: str
    contact: str | None = None

    def xml(self, tag: str) -> str:
        contact = f' contactPoint="{self.contact}"' if self.contact else ""
        return f'<{tag} elementType="{self.kind}" elementId="{self.id}"{contact}/>'


class Sign(NamedTuple):
    """A sign or a light beside the road."""

    id: str
    s: float
    t: float
    type: str
    country: str
    lane: int | None = None
    orientation: str = "+"

    def xml(self, frame: Frame) -> str:
        lane = "" if self.lane is None else str(frame.side * self.lane)
        valid = f'<validity fromLane="{lane}" toLane="{lane}"/>' if lane else ""
        dynamic = "yes" if self.type.startswith("10000") else "no"
        return (
            f'<signal s="{self.s}" t="{frame.side * self.t}" id="{self.id}" name="" dynamic="{dynamic}" '
            f'orientation="{self.orientation}" zOffset="2" country="{self.country}" type="{self.type}" '
            f'subtype="-1">{valid}</signal>'
        )


class Thing(NamedTuple):
    """A stop line or a crossing on the road."""

    id: str
    type: str
    name: str
    s: float
    t: float
    length: float
    width: float
    orientation: str

    def xml(self, frame: Frame) -> str:
        return (
            f'<object type="{self.type}" name="{self.name}" id="{self.id}" s="{self.s}" t="{frame.side * self.t}" '
            f'zOffset="0" hdg="0" pitch="0" roll="0" orientation="{self.orientation}" length="{self.length}" '
            f'width="{self.width}" height="0">{self._outline()}</object>'
        )

    def _outline(self) -> str:
        if self.type != "crosswalk":
            return ""
        u, v = self.length / 2, self.width / 2
        corners = "".join(
            f'<cornerLocal u="{a}" v="{b}" z="0" height="0"/>' for a, b in ((-u, -v), (u, -v), (u, v), (-u, v))
        )
        return f"<outline>{corners}</outline>"


@dataclass
class Road:
    """One road; a limit of None is not in the map."""

    id: str
    path: Path
    stretches: Sequence[Stretch]
    kind: str
    limit: float | str | None
    middle: Sequence[tuple[str, float]] = (("broken", 0.0),)
    junction: str = "-1"
    before: End | None = None
    after: End | None = None
    links: dict[int, tuple[int, int]] = field(default_factory=dict)  # lane: those that it comes from and goes to
    signs: list[Sign] = field(default_factory=list)
    things: list[Thing] = field(default_factory=list)

    def xml(self, frame: Frame) -> str:
        rule = "LHT" if frame.mirrored else "RHT"
        limit = "" if self.limit is None else f'<speed max="{self.limit}" unit="m/s"/>'
        parts = [
            f'<road name="r{self.id}" length="{self.path.length:.6f}" id="{self.id}" junction="{self.junction}" rule="{rule}">',
            "<link>",
            self.before.xml("predecessor") if self.before else "",
            self.after.xml("successor") if self.after else "",
            f'</link><type s="0" type="{self.kind}">{limit}</type><planView>',
            *self._plan(frame),
            "</planView><lanes>",
            *(self._stretch(i, frame) for i in range(len(self.stretches))),
            "</lanes><objects>",
            *(thing.xml(frame) for thing in self.things),
            "</objects><signals>",
            *(sign.xml(frame) for sign in self.signs),
            "</signals></road>",
        ]
        return "\n".join(part for part in parts if part)

    def _plan(self, frame: Frame) -> list[str]:
        rows = []
        for piece in self.path.pieces:
            x, y, heading = frame.place(piece.x, piece.y, piece.heading)
            bend = frame.side * piece.curvature
            form = "<line/>" if abs(bend) < 1e-9 else f'<arc curvature="{bend:.9f}"/>'
            at = f's="{piece.s:.6f}" x="{x:.6f}" y="{y:.6f}" hdg="{heading:.9f}" length="{piece.length:.6f}"'
            rows.append(f"<geometry {at}>{form}</geometry>")
        return rows

    def _stretch(self, i: int, frame: Frame) -> str:
        lanes = sorted([*self._lanes(i, -1, frame), *self._lanes(i, 1, frame)], reverse=True)
        left = "".join(text for number, text in lanes if number > 0)
        right = "".join(text for number, text in lanes if number < 0)
        return "".join(
            (
                f'<laneSection s="{self.stretches[i].s}">',
                f"<left>{left}</left>" if left else "",
                f'<center><lane id="0" type="none" level="false">{self._middle(i, frame)}</lane></center>',
                f"<right>{right}</right>" if right else "",
                "</laneSection>",
            )
        )

    def _middle(self, i: int, frame: Frame) -> str:
        begin = self.stretches[i].s
        end = self.stretches[i + 1].s if i + 1 < len(self.stretches) else self.path.length
        marks = [(mark, max(s - begin, 0.0)) for mark, s in self.middle if s < end]
        first = max(k for k, (_, s) in enumerate(marks) if s <= 0)
        return "".join(
            f'<roadMark sOffset="{s}" type="{_seen(mark, frame)}" weight="standard" color="white" width="0.12"/>'
            for mark, s in marks[first:]
        )

    def _lanes(self, i: int, sign: int, frame: Frame) -> list[tuple[int, str]]:
        rows = []
        for k, lane in enumerate(self.stretches[i].side(sign)):
            number = sign * (k + 1)
            limit = "" if lane.limit is None else f'<speed sOffset="0" max="{lane.limit}" unit="m/s"/>'
            text = (
                f'<lane id="{frame.side * number}" type="{lane.kind}" level="false"><link>{self._links(i, number, frame)}'
                f'</link><width sOffset="0" a="{lane.width}" b="0" c="0" d="0"/><roadMark sOffset="0" '
                f'type="{lane.mark}" weight="standard" color="white" width="0.12"/>{limit}</lane>'
            )
            rows.append((frame.side * number, text))
        return rows

    def _links(self, i: int, number: int, frame: Frame) -> str:
        """Return the links of a lane: to the same one in the next stretch, at the ends as the road says."""
        before, after = self.links.get(number, (None, None))
        if i > 0:
            before = self._same(i - 1, number)
        if i + 1 < len(self.stretches):
            after = self._same(i + 1, number)
        pairs = (("predecessor", before), ("successor", after))
        return "".join(f'<{tag} id="{frame.side * lane}"/>' for tag, lane in pairs if lane is not None)

    def _same(self, i: int, number: int) -> int | None:
        return number if abs(number) <= len(self.stretches[i].side(number)) else None


def _seen(mark: str, frame: Frame) -> str:
    """Return a mark as it is named from left to right."""
    return " ".join(reversed(mark.split())) if frame.mirrored else mark


class Connection(NamedTuple):
    """A way through a junction: roads, and lanes (from, to)."""

    incoming: str
    connecting: str
    lanes: Sequence[tuple[int, int]]


@dataclass
class Map:
    """Roads, and at most one junction of them."""

    roads: Sequence[Road]
    junction: str = ""
    connections: Sequence[Connection] = ()

    def xml(self, frame: Frame) -> str:
        ways = []
        for i, way in enumerate(self.connections):
            links = "".join(f'<laneLink from="{frame.side * a}" to="{frame.side * b}"/>' for a, b in way.lanes)
            ways.append(
                f'<connection id="{i}" incomingRoad="{way.incoming}" connectingRoad="{way.connecting}" '
                f'contactPoint="start">{links}</connection>'
            )
        junction = [f'<junction id="{self.junction}" name="j">', *ways, "</junction>"] if ways else []
        return "\n".join([_HEADER, *(road.xml(frame) for road in self.roads), *junction, "</OpenDRIVE>"])
