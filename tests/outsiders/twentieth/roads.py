"""Draws OpenDRIVE maps: roads of lines, arcs and cubics, their lanes, lines, signs, and junctions."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

Pose = tuple[float, float, float]


@dataclass
class Lane:
    """A lane of a cross section: its type, width, and the line at its outer border."""

    kind: str = "driving"
    width: float = 3.5
    mark: str = "broken"


@dataclass
class Section:
    """The cross section from s on: lanes of the own and of the other direction, from the middle out."""

    s: float
    own: list[Lane]
    opp: list[Lane]
    middle: str = "broken"


@dataclass
class Piece:
    """One geometry of the reference line."""

    s: float
    x: float
    y: float
    h: float
    length: float
    curv: float = 0.0
    poly: tuple[float, ...] = ()

    def at(self, ds: float) -> Pose:
        """Where the line is, ds after the piece's beginning."""
        if self.poly:
            return self._poly_at(ds)
        if abs(self.curv) < 1e-12:
            return (self.x + ds * math.cos(self.h), self.y + ds * math.sin(self.h), self.h)
        h1 = self.h + ds * self.curv
        x = self.x + (math.sin(h1) - math.sin(self.h)) / self.curv
        y = self.y - (math.cos(h1) - math.cos(self.h)) / self.curv
        return (x, y, h1)

    def _poly_at(self, ds: float) -> Pose:
        bu, cu, du, bv, cv, dv = self.poly
        p = min(max(ds / self.length, 0.0), 1.0)
        u = bu * p + cu * p * p + du * p**3
        v = bv * p + cv * p * p + dv * p**3
        h = self.h + math.atan2(bv + 2 * cv * p + 3 * dv * p * p, bu + 2 * cu * p + 3 * du * p * p)
        c, s = math.cos(self.h), math.sin(self.h)
        return (self.x + u * c - v * s, self.y + u * s + v * c, h)


@dataclass
class Road:
    """A road; `near` is +1 where the left is driven on, else -1."""

    key: int
    near: int
    pieces: list[Piece]
    sections: list[Section]
    kind: str = "rural"
    mph: float | None = 60.0
    unit: str = "mph"
    junction: int = -1
    before: tuple[str, int, str] | None = None
    after: tuple[str, int, str] | None = None
    lane_before: dict[int, int] = field(default_factory=dict)
    lane_after: dict[int, int] = field(default_factory=dict)
    signs: list[str] = field(default_factory=list)
    things: list[str] = field(default_factory=list)

    @property
    def length(self) -> float:
        """Length of the reference line."""
        return self.pieces[-1].s + self.pieces[-1].length

    def pose(self, s: float, u: float = 0.0) -> Pose:
        """Point at s, u metres to the near side of the reference line."""
        piece = [p for p in self.pieces if p.s <= s + 1e-9][-1]
        x, y, h = piece.at(s - piece.s)
        t = self.near * u
        return (x - t * math.sin(h), y + t * math.cos(h), h)

    def middle_of(self, s: float, lane: int) -> float:
        """Near-side offset of the middle of a lane: 1, 2.. own direction, -1, -2.. the other."""
        sec = [c for c in self.sections if c.s <= s + 1e-9][-1]
        lanes = sec.own if lane > 0 else sec.opp
        inner = sum(w.width for w in lanes[: abs(lane) - 1])
        off = inner + lanes[abs(lane) - 1].width / 2
        return off if lane > 0 else -off

    def lane_id(self, lane: int) -> int:
        """OpenDRIVE's number of a lane."""
        return lane * self.near

    def sign(self, name: str, s: float, u: float, fwd: bool, **kw: str) -> None:
        """Adds a signal: type, country, and the lanes it holds for."""
        lanes = kw.get("lanes", "")
        valid = ""
        if lanes:
            ids = sorted(self.lane_id(int(v)) for v in lanes.split(","))
            valid = f'<validity fromLane="{ids[0]}" toLane="{ids[-1]}"/>'
        dyn = "yes" if kw["type"].startswith("10000") else "no"
        self.signs.append(
            f'<signal name="{kw.get("label", name)}" id="{name}" s="{s:.3f}" t="{u * self.near:.3f}" zOffset="3" '
            f'dynamic="{dyn}" orientation="{"+" if fwd else "-"}" country="{kw["country"]}" type="{kw["type"]}" '
            f'subtype="{kw.get("subtype", "-1")}" value="-1" height="0.8" width="0.4">{valid}</signal>'
        )

    def patch(self, name: str, kind: str, box: tuple[float, float, float, float], key: str) -> None:
        """Adds an object with an outline: s from, s to, u from, u to."""
        s0, s1, u0, u1 = box
        sm, um = (s0 + s1) / 2, (u0 + u1) / 2
        pts = [(s0, u0), (s1, u0), (s1, u1), (s0, u1)]
        rows = "".join(f'<cornerRoad s="{s:.3f}" t="{u * self.near:.3f}" dz="0" height="0"/>' for s, u in pts)
        self.things.append(
            f'<object id="{key}" name="{name}" type="{kind}" s="{sm:.3f}" t="{um * self.near:.3f}" zOffset="0" '
            f'hdg="0" pitch="0" roll="0" orientation="none" length="{s1 - s0:.3f}" width="{u1 - u0:.3f}" height="0">'
            f"<outline>{rows}</outline></object>"
        )

    def bar(self, s: float, u: float, width: float, fwd: bool, key: str) -> None:
        """Adds a stop line as an object without outline."""
        self.things.append(
            f'<object id="{key}" name="stopLine" type="stopLine" s="{s:.3f}" t="{u * self.near:.3f}" zOffset="0" '
            f'hdg="0" pitch="0" roll="0" orientation="{"+" if fwd else "-"}" length="0.3" width="{width:.3f}" height="0"/>'
        )

    def xml(self) -> str:
        """The road's element."""
        out = [
            (
                f'<road name="r{self.key}" length="{self.length:.6f}" id="{self.key}" junction="{self.junction}" '
                f'rule="{"LHT" if self.near > 0 else "RHT"}"><link>'
            )
        ]
        for tag, link in (("predecessor", self.before), ("successor", self.after)):
            if link:
                cp = f' contactPoint="{link[2]}"' if link[0] == "road" else ""
                out.append(f'<{tag} elementType="{link[0]}" elementId="{link[1]}"{cp}/>')
        out.append(f'</link><type s="0" type="{self.kind}">')
        if self.mph is not None:
            out.append(f'<speed max="{self.mph:g}" unit="{self.unit}"/>')
        out.append("</type><planView>" + "".join(_piece_xml(p) for p in self.pieces) + "</planView>")
        out.append("<elevationProfile/><lateralProfile/><lanes>")
        out.extend(self._section_xml(i) for i in range(len(self.sections)))
        out.append(f"</lanes><objects>{''.join(self.things)}</objects><signals>{''.join(self.signs)}</signals></road>")
        return "".join(out)

    def _section_xml(self, i: int) -> str:
        sec = self.sections[i]
        left, right = (sec.own, sec.opp) if self.near > 0 else (sec.opp, sec.own)
        out = [f'<laneSection s="{sec.s:.3f}">']
        if left:
            out.append(
                "<left>" + "".join(self._lane_xml(i, k, left[k - 1]) for k in range(len(left), 0, -1)) + "</left>"
            )
        out.append(f'<center><lane id="0" type="none" level="false">{_mark(sec.middle)}</lane></center>')
        if right:
            out.append(
                "<right>" + "".join(self._lane_xml(i, -k, right[k - 1]) for k in range(1, len(right) + 1)) + "</right>"
            )
        return "".join(out) + "</laneSection>"

    def _lane_xml(self, i: int, key: int, lane: Lane) -> str:
        link = ""
        prev = self.lane_before.get(key) if i == 0 else self._same(i - 1, key)
        nxt = self.lane_after.get(key) if i == len(self.sections) - 1 else self._same(i + 1, key)
        if prev is not None:
            link += f'<predecessor id="{prev}"/>'
        if nxt is not None:
            link += f'<successor id="{nxt}"/>'
        return (
            f'<lane id="{key}" type="{lane.kind}" level="false"><link>{link}</link>'
            f'<width sOffset="0" a="{lane.width:g}" b="0" c="0" d="0"/>{_mark(lane.mark)}</lane>'
        )

    def _same(self, i: int, key: int) -> int | None:
        sec = self.sections[i]
        left, right = (sec.own, sec.opp) if self.near > 0 else (sec.opp, sec.own)
        return key if abs(key) <= len(left if key > 0 else right) else None


def _mark(kind: str) -> str:
    return f'<roadMark sOffset="0" type="{kind}" weight="standard" color="standard" width="0.12" laneChange="both"/>'


def _piece_xml(p: Piece) -> str:
    head = f'<geometry s="{p.s:.6f}" x="{p.x:.6f}" y="{p.y:.6f}" hdg="{p.h:.9f}" length="{p.length:.6f}">'
    if p.poly:
        bu, cu, du, bv, cv, dv = (f"{v:.9f}" for v in p.poly)
        body = f'<paramPoly3 aU="0" bU="{bu}" cU="{cu}" dU="{du}" aV="0" bV="{bv}" cV="{cv}" dV="{dv}" pRange="normalized"/>'
    elif p.curv:
        body = f'<arc curvature="{p.curv:.9f}"/>'
    else:
        body = "<line/>"
    return head + body + "</geometry>"


def pieces_of(start: Pose, parts: list[tuple[float, float]]) -> list[Piece]:
    """Lines and arcs one after the other: (length, curvature)."""
    out: list[Piece] = []
    (x, y, h), s = start, 0.0
    for length, curv in parts:
        piece = Piece(s, x, y, h, length, curv)
        out.append(piece)
        x, y, h = piece.at(length)
        s += length
    return out


def cubic(a: Pose, b: Pose) -> Piece:
    """A cubic from one pose to another, nearly an arc where an arc fits."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    turn = abs(math.remainder(b[2] - a[2], math.tau))
    chord = math.hypot(dx, dy)
    reach = chord / 3 if turn < 0.05 else 4 / 3 * math.tan(turn / 4) * chord / (2 * math.sin(turn / 2))
    c, s = math.cos(a[2]), math.sin(a[2])
    ex, ey = dx * c + dy * s, -dx * s + dy * c
    p1 = (reach, 0.0)
    p2 = (ex - reach * math.cos(b[2] - a[2]), ey - reach * math.sin(b[2] - a[2]))
    poly: list[float] = []
    for q1, q2, q3 in ((p1[0], p2[0], ex), (p1[1], p2[1], ey)):
        poly += [3 * q1, 3 * q2 - 6 * q1, q3 - 3 * q2 + 3 * q1]
    piece = Piece(0.0, a[0], a[1], a[2], 1.0, 0.0, tuple(poly))
    pts = [piece.at(i / 400) for i in range(401)]
    piece.length = sum(math.hypot(q[0] - p[0], q[1] - p[1]) for p, q in pairwise(pts))
    return piece


@dataclass
class Map:
    """A map: its roads and junctions."""

    near: int
    version: int = 4
    roads: list[Road] = field(default_factory=list)
    junctions: dict[int, list[str]] = field(default_factory=dict)

    def road(self, start: Pose, parts: list[tuple[float, float]], sections: list[Section], **kw: Any) -> Road:
        """Adds a road of lines and arcs."""
        made = Road(len(self.roads) + 1, self.near, pieces_of(start, parts), sections, **kw)
        self.roads.append(made)
        return made

    def join(self, jid: int, a: tuple[Road, bool], la: int, b: tuple[Road, bool], lb: int) -> Road:
        """A connecting road of one lane, from lane la of a to lane lb of b; True: that road's end is at the junction."""
        (ra, ea), (rb, eb) = a, b
        sa, sb = (ra.length if ea else 0.0), (rb.length if eb else 0.0)
        da, db = (1 if ea else -1), (-1 if eb else 1)
        width = ra.sections[0].own[0].width if ra.sections[0].own else ra.sections[0].opp[0].width
        pa = ra.pose(sa, ra.middle_of(sa, da * la) - da * width / 2)
        pb = rb.pose(sb, rb.middle_of(sb, db * lb) - db * width / 2)
        pa = (pa[0], pa[1], pa[2] + (0.0 if da > 0 else math.pi))
        pb = (pb[0], pb[1], pb[2] + (0.0 if db > 0 else math.pi))
        lane = Lane(width=width, mark="none")
        made = Road(len(self.roads) + 1, self.near, [cubic(pa, pb)], [Section(0.0, [lane], [], "none")])
        made.kind, made.mph, made.unit, made.junction = ra.kind, ra.mph, ra.unit, jid
        made.before = ("road", ra.key, "end" if ea else "start")
        made.after = ("road", rb.key, "end" if eb else "start")
        made.lane_before = {self.near: ra.lane_id(da * la)}
        made.lane_after = {self.near: rb.lane_id(db * lb)}
        self.roads.append(made)
        rows = self.junctions.setdefault(jid, [])
        rows.append(
            f'<connection id="{len(rows)}" incomingRoad="{ra.key}" connectingRoad="{made.key}" contactPoint="start">'
            f'<laneLink from="{ra.lane_id(da * la)}" to="{self.near}"/></connection>'
        )
        for road, end in (a, b):
            if end:
                road.after = ("junction", jid, "")
            else:
                road.before = ("junction", jid, "")
        return made

    def xml(self) -> str:
        """The whole file."""
        body = "".join(r.xml() for r in self.roads)
        for jid, rows in self.junctions.items():
            body += f'<junction name="j{jid}" id="{jid}">{"".join(rows)}</junction>'
        head = f'<header revMajor="1" revMinor="{self.version}" name="" version="1.00" date="2026-01-01T00:00:00"/>'
        return f'<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE>{head}{body}</OpenDRIVE>\n'
