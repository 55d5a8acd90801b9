"""The roads of a story: OpenDRIVE written along the way that the ego takes, stretch by stretch, junction by junction.

Stations `s` run along the ego's way from 0. Offsets `n` are metres from the reference line to the **nearside** (the side
that is driven on), so a story reads the same in Britain and in Germany. On a two-way road the reference line is the
centre line; a carriageway of one direction lies on the nearside of it, its lane nearest to the edge in line with the
lane of a two-way road.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from tests.demo.line import Line, Piece, Pose
from tests.formats.opendrive import xodr
from tests.scenes import plan

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

LANE = 3.5
BESIDE = {"sidewalk": 2.0, "shoulder": 3.0}
RADIUS = 10.0  # of the corners of junctions: their arms end so far from the middle
STUB = 150.0  # length of the roads that lead away from the ego's way
SIGNS = {
    "stop": {"lht": ("gb", "601.1"), "rht": ("de", "206")},
    "no_overtaking": {"lht": ("gb", "632"), "rht": ("de", "276")},
    "no_overtaking_end": {"lht": ("OpenDRIVE", "280"), "rht": ("de", "280")},
}


@dataclass(frozen=True)
class Kind:
    """What a stretch of road is like. `marks`: of the centre line and of the lines between lanes."""

    type: str = "rural"
    limit: tuple[float, str] = (60.0, "mph")
    lanes: int = 1
    oncoming: int = 1
    centre: str = "broken"
    beside: str = "sidewalk"


@dataclass
class _Part:
    """A road that is being built: from station `s0` of the way on, or away from it (`s0` None)."""

    number: int
    kind: Kind
    pieces: tuple[Piece, ...]
    pose: Pose
    s0: float | None
    ends: dict[str, str] = field(default_factory=dict)
    signals: list[str] = field(default_factory=list)
    objects: list[str] = field(default_factory=list)
    junction: int = -1
    before: int = 1
    after: int = 1

    @property
    def line(self) -> Line:
        return Line(self.pieces, self.pose)

    @property
    def length(self) -> float:
        return sum(piece.length_m for piece in self.pieces)


@dataclass(frozen=True)
class Arm:
    """A road at a junction: the pose at which one drives into it from there, and which end of the road that is."""

    part: _Part
    entry: Pose
    by_its_end: bool


@dataclass(frozen=True)
class Junction:
    """A junction on the ego's way: stations of its beginning and end, and its other arms by the side they lie on."""

    s_in: float
    s_out: float
    arms: dict[str, Arm]
    hand: int

    def across(self, start: str, goal: str) -> tuple[Line, float]:
        """Return the reference line of the way from one arm to another, and the station on it at which the junction begins.

        It begins `STUB` before the junction; who drives along it keeps to its nearside.
        """
        a, b = self.arms[start], self.arms[goal]
        back = Pose(
            a.entry.x - STUB * math.cos(a.entry.heading), a.entry.y - STUB * math.sin(a.entry.heading), a.entry.heading
        )
        return Line((Piece(STUB), _corner(a.entry, _out(b)), Piece(STUB)), back), STUB


class Route:
    """Builds the roads, in the order in which the ego drives them."""

    def __init__(self, hand: str) -> None:
        self.hand = hand
        self.h = 1 if hand == "lht" else -1
        self.pieces: list[Piece] = []
        self.length = 0.0
        self._parts: list[_Part] = []
        self._junctions: list[str] = []
        self._on_way: list[_Part] = []
        self._open: tuple[int, str, Junction, Kind] | None = None

    @property
    def line(self) -> Line:
        """Return the way's reference line."""
        return Line(tuple(self.pieces))

    def offset(self, lane: int = 1) -> float:
        """Return the nearside offset of the middle of a lane: 1 is the one in line with a two-way road's, -1 the oncoming one.

        2 is the lane beside 1 towards the offside on a carriageway of more lanes.
        """
        return LANE / 2 if lane == 1 else -LANE * (abs(lane) - 1.5) if lane > 1 else LANE * (lane + 0.5)

    def road(self, length: float, kind: Kind, *, radius: float | None = None) -> float:
        """Lay a stretch of road; return the station at which it begins. `radius`: a bend, to the left positive."""
        pose = self.line.pose(self.length) if self.pieces else Pose()
        piece = Piece(length, 1 / radius if radius else 0.0)
        part = self._part(kind, (piece,), pose, self.length)
        if self._on_way and not self._open:
            last = self._on_way[-1]
            part.ends["predecessor"] = f'elementType="road" elementId="{last.number}" contactPoint="end"'
            last.ends["successor"] = f'elementType="road" elementId="{part.number}" contactPoint="start"'
        self._finish_junction(part)
        start = self.length
        self.pieces.append(piece)
        self.length += length
        self._on_way.append(part)
        return start

    def junction(self, turn: str, sides: Sequence[str], kind: Kind) -> Junction:
        """Lay a junction after the last road: the ego turns `left`, `right` or goes `straight`; the way goes on there.

        `sides`: which arms there are (left, right, straight), that of the ego's way among them. `kind`: of the arms.
        """
        entry = self.line.pose(self.length)
        came = Arm(self._on_way[-1], entry, by_its_end=True)
        number = 1000 + len(self._junctions)
        came.part.ends["successor"] = f'elementType="junction" elementId="{number}"'
        middle = Pose(
            entry.x + RADIUS * math.cos(entry.heading), entry.y + RADIUS * math.sin(entry.heading), entry.heading
        )
        arms = {"came": came}
        turns = {"left": math.pi / 2, "right": -math.pi / 2, "straight": 0.0}
        for side in sides:
            heading = entry.heading + turns[side]
            pose = Pose(middle.x + RADIUS * math.cos(heading), middle.y + RADIUS * math.sin(heading), heading)
            if side != turn:
                part = self._part(kind, (Piece(STUB),), pose, None)
                part.ends["predecessor"] = f'elementType="junction" elementId="{number}"'
                arms[side] = Arm(part, Pose(pose.x, pose.y, heading + math.pi), by_its_end=False)
            else:
                exit_pose = pose
        piece = _corner(entry, exit_pose)
        s_in = self.length
        self.pieces.append(piece)
        self.length += piece.length_m
        found = Junction(s_in, self.length, arms, self.h)
        self._open = (number, turn, found, kind)
        return found

    def _finish_junction(self, onward: _Part) -> None:
        """Connect every arm of the junction before this road with every other one."""
        if self._open is None:
            return
        number, turn, junction, kind = self._open
        self._open = None
        onward.ends["predecessor"] = f'elementType="junction" elementId="{number}"'
        pose = onward.pose
        junction.arms[turn] = Arm(onward, Pose(pose.x, pose.y, pose.heading + math.pi), by_its_end=False)
        connections: list[str] = []
        arms = list(junction.arms.values())
        for i, a in enumerate(arms):
            for b in arms[i + 1 :]:
                part = self._part(kind, (_corner(a.entry, _out(b)),), a.entry, None)
                part.junction = number
                part.before, part.after = (1 if a.by_its_end else -1), (-1 if b.by_its_end else 1)
                for end, arm in (("predecessor", a), ("successor", b)):
                    contact = "end" if arm.by_its_end else "start"
                    part.ends[end] = f'elementType="road" elementId="{arm.part.number}" contactPoint="{contact}"'
                for arm, contact, lane, factor in ((a, "start", 1, part.before), (b, "end", -1, part.after)):
                    links = f'<laneLink from="{lane * factor * self.h}" to="{lane * self.h}"/>'
                    head = f'incomingRoad="{arm.part.number}" connectingRoad="{part.number}" contactPoint="{contact}"'
                    connections.append(f'<connection id="{len(connections)}" {head}>{links}</connection>')
        self._junctions.append(f'<junction id="{number}" name="j{number}">{"".join(connections)}</junction>')

    def stop_line(self, s: float, control: str = "", *, light: str = "") -> None:
        """Paint a line across the ego's lane, with a sign (stop) or a light (its signal id) beside it."""
        part, at = self._holding(s)
        t = sorted((0.1 * self.h, (LANE - 0.1) * self.h))
        part.objects.append(_area(f"line{s:.0f}", "", "StopLine", at, at + 0.3, *t))
        if control:
            country, code = SIGNS[control][self.hand]
            part.signals.append(self._signal(f"sign{s:.0f}", at, code, country))
        if light:
            part.signals.append(self._signal(light, at, "1000001", "OpenDRIVE", dynamic="yes"))

    def sign(self, s: float, kind: str) -> None:
        """Put a sign beside the ego's lane."""
        part, at = self._holding(s)
        country, code = SIGNS[kind][self.hand]
        text = self._signal(f"{kind}{s:.0f}", at, code, country)
        if text not in part.signals:
            part.signals.append(text)

    def crossing(self, s: float, kind: str, *, light: str = "") -> None:
        """Paint a pedestrian crossing, 3 m wide, right across the road from station s on."""
        part, at = self._holding(s)
        part.objects.append(_area(f"crossing{s:.0f}", f'crosswalk" subtype="{kind}', kind, at, at + 3.0, -LANE, LANE))
        if light:
            part.signals.append(self._signal(light, at - 1.0, "1000001", "OpenDRIVE", dynamic="yes"))

    def _signal(self, name: str, at: float, code: str, country: str, dynamic: str = "no") -> str:
        place = f's="{at!r}" t="{self.h * (LANE + 1)}" zOffset="2" orientation="+"'
        return (
            f'<signal id="{name}" name="" {place} dynamic="{dynamic}" country="{country}" type="{code}" subtype="-1"/>'
        )

    def _holding(self, s: float) -> tuple[_Part, float]:
        part = next(p for p in reversed(self._on_way) if p.s0 is not None and p.s0 <= s)
        return part, s - (part.s0 or 0.0)

    def _part(self, kind: Kind, pieces: tuple[Piece, ...], pose: Pose, s0: float | None) -> _Part:
        part = _Part(len(self._parts) + 1, kind, pieces, pose, s0)
        self._parts.append(part)
        return part

    def text(self) -> str:
        """Return the map."""
        return xodr.xodr(*(self._element(part) for part in self._parts), *self._junctions)

    def _element(self, part: _Part) -> str:
        kind, (limit, unit) = part.kind, part.kind.limit
        speed = f'<speed max="{limit}" unit="{unit}"/>' if limit else ""
        more = f'<type s="0" type="{kind.type}">{speed}</type>'
        shape = plan([(p.length_m, p.curvature) for p in part.pieces], (part.pose.x, part.pose.y, part.pose.heading))
        text = xodr.road(
            str(part.number), shape, self._lanes(part),
            part.length, "".join(f"<{end} {what}/>" for end, what in part.ends.items()), f'rule="{self.hand.upper()}"', more,
            str(part.junction),
        )  # fmt: skip
        things = f"<objects>{''.join(part.objects)}</objects><signals>{''.join(part.signals)}</signals>"
        return text.replace("</road>", f"{things}</road>")

    def _lanes(self, part: _Part) -> str:
        kind, inside = part.kind, part.junction >= 0
        lanes = []
        for sign, n in ((1, kind.lanes), (-1, kind.oncoming)):
            for k in range(1, n + 1):
                number = sign * k * self.h
                # of a carriageway the lane nearest to the edge goes on as the lane of a two-way road
                ends = self._ends(part, sign, k, n)
                mark = "none" if inside else "solid" if k == n else "broken"
                body = f'<link>{ends}</link><width sOffset="0" a="{LANE}" b="0" c="0" d="0"/>{_mark(mark)}'
                lanes.append(xodr.lane(number, body))
            if n and kind.beside and not inside:
                body = f'<width sOffset="0" a="{BESIDE[kind.beside]}" b="0" c="0" d="0"/>'
                lanes.append(xodr.lane(sign * (n + 1) * self.h, body, kind.beside))
        lanes.sort(key=lambda text: -int(text.split('"')[1]))
        shift = self.h * LANE * (kind.lanes - 1)
        offset = f'<laneOffset s="0" a="{-shift}" b="0" c="0" d="0"/>' if shift else ""
        return offset + xodr.section(0, *lanes, centre=_mark("none" if inside else kind.centre))

    def _ends(self, part: _Part, sign: int, k: int, n: int) -> str:
        if part.junction >= 0:
            return f'<predecessor id="{sign * self.h * part.before}"/><successor id="{sign * self.h * part.after}"/>'
        if part.s0 is None:
            return ""
        here = self._on_way.index(part)
        ends = ""
        for tag, step in (("predecessor", -1), ("successor", 1)):
            at = here + step
            beside = self._on_way[at] if 0 <= at < len(self._on_way) else None
            if beside is None or "junction" in part.ends.get(tag, ""):
                continue
            m = beside.kind.lanes if sign > 0 else beside.kind.oncoming
            other = k + (m - n)
            if 1 <= other <= m:
                ends += f'<{tag} id="{sign * other * self.h}"/>'
        return ends


def _mark(kind: str) -> str:
    return f'<roadMark sOffset="0" type="{kind.replace("_", " ")}" weight="standard" color="white" width="0.12"/>'


def _out(arm: Arm) -> Pose:
    """Return the pose at which one leaves a junction by this arm."""
    return Pose(arm.entry.x, arm.entry.y, arm.entry.heading + math.pi)


def _corner(start: Pose, end: Pose) -> Piece:
    turn = (end.heading - start.heading + math.pi) % (2 * math.pi) - math.pi
    if abs(turn) < 1e-6:
        return Piece(math.hypot(end.x - start.x, end.y - start.y))
    return Piece(abs(turn) * RADIUS, math.copysign(1 / RADIUS, turn))


def _area(name: str, kind: str, label: str, s0: float, s1: float, t0: float, t1: float) -> str:  # noqa: PLR0917
    corners: Iterable[tuple[float, float]] = ((s0, t0), (s1, t0), (s1, t1), (s0, t1))
    text = "".join(f'<cornerRoad s="{s!r}" t="{t!r}" dz="0" height="0"/>' for s, t in corners)
    head = f'<object id="{name}" name="{label}" type="{kind}" s="{s0!r}" t="0" zOffset="0" hdg="0">'
    return f'{head}<outlines><outline id="0">{text}</outline></outlines></object>'
