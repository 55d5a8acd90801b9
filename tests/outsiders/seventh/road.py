"""Roads and what stands beside them, as OpenDRIVE text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

Pose = tuple[float, float, float]
Marks = Sequence[tuple[float, str]]


class Line(NamedTuple):
    """A straight piece of a road."""

    length: float

    def pose(self, start: Pose, s: float) -> Pose:
        """Return the pose after so many metres."""
        x, y, heading = start
        return x + s * math.cos(heading), y + s * math.sin(heading), heading

    def xml(self) -> str:
        """Return the shape."""
        return "<line/>"


class Bend(NamedTuple):
    """An arc; its curvature is positive to the left."""

    length: float
    curvature: float

    def pose(self, start: Pose, s: float) -> Pose:
        """Return the pose after so many metres."""
        (x, y, heading), k = start, self.curvature
        then = heading + k * s
        return x + (math.sin(then) - math.sin(heading)) / k, y - (math.cos(then) - math.cos(heading)) / k, then

    def xml(self) -> str:
        """Return the shape."""
        return f'<arc curvature="{self.curvature:.10f}"/>'


class Cubic(NamedTuple):
    """A cubic whose parameter goes from 0 to 1."""

    length: float
    u: tuple[float, float, float, float]
    v: tuple[float, float, float, float]

    def pose(self, start: Pose, s: float) -> Pose:
        """Return the pose after so many metres, as if the parameter grew with them."""
        p = s / self.length
        u, v = (sum(c * p**i for i, c in enumerate(curve)) for curve in (self.u, self.v))
        du, dv = (sum(i * c * p ** (i - 1) for i, c in enumerate(curve) if i) for curve in (self.u, self.v))
        x, y, heading = start
        cos, sin = math.cos(heading), math.sin(heading)
        return x + u * cos - v * sin, y + u * sin + v * cos, heading + math.atan2(dv, du)

    def xml(self) -> str:
        """Return the shape."""
        both = ((axis, curve) for axis, curve in (("U", self.u), ("V", self.v)))
        numbers = " ".join(f'{n}{axis}="{c:.10f}"' for axis, curve in both for n, c in zip("abcd", curve, strict=True))
        return f'<paramPoly3 {numbers} pRange="normalized"/>'


Piece = Line | Bend | Cubic


def between(a: Pose, b: Pose) -> Cubic:
    """Return the cubic from one pose to another."""
    away = math.hypot(b[0] - a[0], b[1] - a[1])
    turn = abs((b[2] - a[2] + math.pi) % (2 * math.pi) - math.pi)
    m = away * (1 + 0.12 * turn * turn) if turn else away
    dx, dy = b[0] - a[0], b[1] - a[1]
    c, s = math.cos(a[2]), math.sin(a[2])
    u, v = dx * c + dy * s, -dx * s + dy * c
    e = b[2] - a[2]
    tu, tv = m * math.cos(e), m * math.sin(e)
    us, vs = (0.0, m, 3 * u - 2 * m - tu, -2 * u + m + tu), (0.0, 0.0, 3 * v - tv, -2 * v + tv)
    p = np.linspace(0, 1, 400)
    x, y = (sum((k * p**i for i, k in enumerate(curve)), np.zeros_like(p)) for curve in (us, vs))
    return Cubic(float(np.hypot(np.diff(x), np.diff(y)).sum()), us, vs)


class Lane(NamedTuple):
    """A lane; the mark is that of its outer edge."""

    kind: str
    width: float
    mark: str = "solid"

    def xml(self, number: int, before: int | None, after: int | None) -> str:
        """Return the lane with its links."""
        links = (("predecessor", before), ("successor", after))
        link = "".join(f'<{how} id="{other}"/>' for how, other in links if other is not None)
        return (
            f'<lane id="{number}" type="{self.kind}" level="false"><link>{link}</link>'
            f'<width sOffset="0" a="{self.width}" b="0" c="0" d="0"/>{_mark(0, self.mark)}</lane>'
        )


class Section(NamedTuple):
    """From s on the road has these lanes, from its middle outwards."""

    s: float
    left: Sequence[Lane]
    right: Sequence[Lane]
    centre: Marks = ((0, "broken"),)


class Kind(NamedTuple):
    """What the map says of a road: its type and limit (0: not known), and the hand that it is driven on."""

    name: str
    limit: float
    unit: str
    rule: str


@dataclass
class Road:
    """A road of the map; `joins`: kind, id and, of a road, the end that is met."""

    number: int
    start: Pose
    pieces: Sequence[Piece]
    sections: Sequence[Section]
    kind: Kind
    junction: int = -1
    joins: dict[str, tuple[str | int, ...]] = field(default_factory=dict)
    lane_joins: dict[str, int] = field(default_factory=dict)  # of the only lane
    z: tuple[float, float, float] | None = None
    things: list[str] = field(default_factory=list)
    signs: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.starts: list[tuple[float, Pose, Piece]] = []
        pose, s = self.start, 0.0
        for piece in self.pieces:
            self.starts.append((s, pose, piece))
            pose = piece.pose(pose, piece.length)
            s += piece.length
        self.length, self.end = s, pose

    def at(self, s: float, t: float = 0.0) -> Pose:
        """Return the pose at s, t."""
        here = self.starts[0]
        for start in self.starts:
            if s >= start[0] - 1e-9:
                here = start
        x, y, heading = here[2].pose(here[1], s - here[0])
        return x - t * math.sin(heading), y + t * math.cos(heading), heading

    def area(  # noqa: PLR0917
        self, kind: str, name: str, s: float, t: float, length: float, width: float, outline: bool = False
    ) -> None:
        """Lay a rectangle on the road, such as a crossing or a stop line."""
        u, v = length / 2, width / 2
        corners = "".join(
            f'<cornerLocal u="{a}" v="{b}" z="0" height="0"/>' for a, b in ((-u, -v), (u, -v), (u, v), (-u, v))
        )
        self.things.append(
            f'<object id="o{self.number}_{len(self.things)}" type="{kind}" name="{name}" s="{s}" t="{t}" zOffset="0" '
            f'hdg="0" pitch="0" roll="0" orientation="none" length="{length}" width="{width}" height="0">'
            f"{f'<outline>{corners}</outline>' if outline else ''}</object>"
        )

    def sign(  # noqa: PLR0917
        self,
        ident: str,
        s: float,
        t: float,
        kind: str,
        name: str,
        country: str = "OpenDRIVE",
        orientation: str = "+",
        lane: int = 0,
    ) -> None:
        """Put up a sign or light, for one lane."""
        dynamic = "yes" if kind == "1000001" else "no"
        self.signs.append(
            f'<signal s="{s}" t="{t}" id="{ident}" name="{name}" dynamic="{dynamic}" orientation="{orientation}" '
            f'zOffset="2.5" country="{country}" type="{kind}" subtype="-1" value="-1" width="0.5" height="0.8">'
            f'<validity fromLane="{lane}" toLane="{lane}"/></signal>'
        )

    def xml(self) -> str:
        """Return the road as OpenDRIVE."""
        name = f'name="r{self.number}" length="{self.length:.6f}" id="{self.number}"'
        out = [f'<road {name} junction="{self.junction}" rule="{self.kind.rule}">', "<link>"]
        for how in ("predecessor", "successor"):
            if join := self.joins.get(how):
                end = f' contactPoint="{join[2]}"' if join[2:] else ""
                out.append(f'<{how} elementType="{join[0]}" elementId="{join[1]}"{end}/>')
        out.append("</link>")
        speed = f'<speed max="{self.kind.limit}" unit="{self.kind.unit}"/>' if self.kind.limit else ""
        out += [f'<type s="0" type="{self.kind.name}">{speed}</type>', "<planView>"]
        for s, (x, y, heading), piece in self.starts:
            length = f'length="{piece.length:.6f}"'
            out.append(f'<geometry s="{s:.6f}" x="{x:.6f}" y="{y:.6f}" hdg="{heading:.8f}" {length}>')
            out += [piece.xml(), "</geometry>"]
        out.append("</planView>")
        if self.z is not None:
            a, b, c = self.z
            rise = f'<elevation s="0" a="{a}" b="{b}" c="{c}" d="0"/>'
            out.append(f"<elevationProfile>{rise}</elevationProfile>")
        out.append("<lanes>")
        for index in range(len(self.sections)):
            out += self._section(index)
        out.append("</lanes>")
        for tag, things in (("objects", self.things), ("signals", self.signs)):
            if things:
                out.append(f"<{tag}>" + "".join(things) + f"</{tag}>")
        return "\n".join([*out, "</road>"])

    def _section(self, index: int) -> list[str]:
        section = self.sections[index]
        left = [self._lane(index, n) for n in range(len(section.left), 0, -1)]
        right = [self._lane(index, -n) for n in range(1, len(section.right) + 1)]
        centre = "".join(_mark(s, kind) for s, kind in section.centre)
        out = [f'<laneSection s="{section.s:.4f}">']
        if left:
            out.append("<left>" + "".join(left) + "</left>")
        out.append(f'<center><lane id="0" type="none" level="false">{centre}</lane></center>')
        if right:
            out.append("<right>" + "".join(right) + "</right>")
        return [*out, "</laneSection>"]

    def _lane(self, index: int, number: int) -> str:
        """Return a lane; it goes on in the lane of its kind and rank in the sections before and after."""
        before = self._same(index, index - 1, number) if index else self.lane_joins.get("predecessor")
        last = index == len(self.sections) - 1
        after = self.lane_joins.get("successor") if last else self._same(index, index + 1, number)
        return self._lanes(index, number)[abs(number) - 1].xml(number, before, after)

    def _same(self, index: int, other: int, number: int) -> int | None:
        here, there = self._lanes(index, number), self._lanes(other, number)
        kind = here[abs(number) - 1].kind
        rank = sum(lane.kind == kind for lane in here[: abs(number)])
        found = [n for n, lane in enumerate(there, 1) if lane.kind == kind]
        return (found[rank - 1] if number > 0 else -found[rank - 1]) if len(found) >= rank else None

    def _lanes(self, index: int, number: int) -> Sequence[Lane]:
        return self.sections[index].left if number > 0 else self.sections[index].right


def _mark(s: float, kind: str) -> str:
    return f'<roadMark sOffset="{s}" type="{kind}" weight="standard" color="standard" width="0.12"/>'
