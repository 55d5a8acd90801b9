"""Roads in OpenDRIVE: lanes are named from the middle outwards, those that go along the road and those that come."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from tests.outsiders.twelfth.ways import Path

Lane = tuple[str, float]  # type, width
Frame = tuple[float, float, float]  # where the map's origin is, and how it is turned
_UNMARKED = ("sidewalk", "shoulder", "median", "border", "verge")
_HEADER = (
    '<?xml version="1.0" standalone="yes"?><OpenDRIVE><header revMajor="1" revMinor="6" name="n" version="1" '
    'date="2026-11-23" north="2000" south="-2000" east="2000" west="-2000" vendor="n"/>'
)


class Sec(NamedTuple):
    """A stretch of a road from s on."""

    s: float
    fwd: Sequence[Lane]
    opp: Sequence[Lane]


class End(NamedTuple):
    """What a road is linked to."""

    kind: str
    id: str
    contact: str | None = None


class Connection(NamedTuple):
    """A way through a junction: roads, and lanes (from, to)."""

    incoming: str
    connecting: str
    lanes: Sequence[tuple[int, int]]


@dataclass
class Road:
    """One road; a limit of None is not in the map."""

    id: str
    path: Path
    secs: Sequence[Sec]
    lht: bool
    type: str
    limit: float | str | None
    unit: str = "mph"
    mid: Sequence[tuple[float, str]] = ((0.0, "broken"),)
    junction: str = "-1"
    pred: End | None = None
    succ: End | None = None
    lane_pred: dict[int, int] = field(default_factory=dict)
    lane_succ: dict[int, int] = field(default_factory=dict)
    offset: float = 0.0
    objects: list[str] = field(default_factory=list)
    signals: list[str] = field(default_factory=list)
    elev: float = 0.0

    def xml(self, frame: Frame) -> str:
        """Return the element `road`."""
        rule = "LHT" if self.lht else "RHT"
        out = [
            f'<road name="{self.id}" length="{self.path.length:.6f}" id="{self.id}" junction="{self.junction}" rule="{rule}"><link>',
            *(_end(tag, end) for tag, end in (("predecessor", self.pred), ("successor", self.succ)) if end),
            "</link>",
        ]
        speed = "" if self.limit is None else f'<speed max="{self.limit}" unit="{self.unit}"/>'
        if self.type:
            out.append(f'<type s="0" type="{self.type}">{speed}</type>')
        out += ["<planView>", *self._geometry(frame), "</planView>", self._elevation(), "<lateralProfile/><lanes>"]
        if self.offset:
            out.append(f'<laneOffset s="0" a="{self.offset}" b="0" c="0" d="0"/>')
        out += [self._section(i) for i in range(len(self.secs))]
        out += ["</lanes><objects>", *self.objects, "</objects><signals>", *self.signals, "</signals></road>"]
        return "".join(out)

    def _geometry(self, frame: Frame) -> list[str]:
        x0, y0, turned = frame
        out, s = [], 0.0
        for x, y, h, length, k in self.path.pieces:
            gx = x0 + x * math.cos(turned) - y * math.sin(turned)
            gy = y0 + x * math.sin(turned) + y * math.cos(turned)
            shape = "<line/>" if k == 0 else f'<arc curvature="{k:.9f}"/>'
            where = f'x="{gx:.6f}" y="{gy:.6f}" hdg="{h + turned:.9f}" length="{length:.6f}"'
            out.append(f'<geometry s="{s:.6f}" {where}>{shape}</geometry>')
            s += length
        return out

    def _elevation(self) -> str:
        if not self.elev:
            return "<elevationProfile/>"
        return f'<elevationProfile><elevation s="0" a="{self.elev}" b="0" c="0" d="0"/></elevationProfile>'

    def _section(self, i: int) -> str:
        sec, last = self.secs[i], i == len(self.secs) - 1
        left, right = (sec.fwd, sec.opp) if self.lht else (sec.opp, sec.fwd)
        out = [f'<laneSection s="{sec.s:.3f}">']
        if left:
            out += ["<left>", *(self._lane(left, j, 1, i) for j in range(len(left) - 1, -1, -1)), "</left>"]
        until = 1e9 if last else self.secs[i + 1].s
        ends = [s for s, _ in self.mid[1:]] + [1e9]
        marks = [
            _mark(kind, max(0.0, s - sec.s))
            for (s, kind), end in zip(self.mid, ends, strict=True)
            if end > sec.s and s < until
        ]
        out += ['<center><lane id="0" type="none" level="false"><link/>', *marks, "</lane></center>"]
        if right:
            out += ["<right>", *(self._lane(right, j, -1, i) for j in range(len(right))), "</right>"]
        return "".join([*out, "</laneSection>"])

    def _lane(self, lanes: Sequence[Lane], j: int, side: int, i: int) -> str:
        number, (kind, width) = side * (j + 1), lanes[j]
        before = number if i else self.lane_pred.get(number)
        after = number if i < len(self.secs) - 1 else self.lane_succ.get(number)
        link = "" if before is None else f'<predecessor id="{before}"/>'
        link += "" if after is None else f'<successor id="{after}"/>'
        return (
            f'<lane id="{number}" type="{kind}" level="false"><link>{link}</link>'
            f'<width sOffset="0" a="{width}" b="0.0" c="0" d="0"/>{_mark(self._line(lanes, j))}</lane>'
        )

    def _line(self, lanes: Sequence[Lane], j: int) -> str:
        if self.junction != "-1" or lanes[j][0] in _UNMARKED:
            return "none"
        beyond = lanes[j + 1][0] if j + 1 < len(lanes) else ""
        return "broken" if beyond in {"driving", "exit"} else "solid"


@dataclass
class Map:
    """Roads and junctions, and where they lie."""

    roads: list[Road]
    junctions: Sequence[tuple[str, Sequence[Connection]]] = ()
    frame: Frame = (0.0, 0.0, 0.0)

    def xml(self) -> str:
        """Return the file."""
        out = [_HEADER, *(road.xml(self.frame) for road in self.roads)]
        for name, connections in self.junctions:
            out.append(f'<junction name="j{name}" id="{name}">')
            out += [_connection(n, connection) for n, connection in enumerate(connections)]
            out.append("</junction>")
        return "\n".join([*out, "</OpenDRIVE>"])


def frame(tf: Frame) -> Frame:
    """Return a frame whose angle is in degrees in radians."""
    return tf[0], tf[1], math.radians(tf[2])


def crosswalk(name: str, s: float, t: float, along: float, across: float, kind: str = "zebra", sub: str = "") -> str:  # noqa: PLR0917
    """A crossing; along and across: half of its extent."""
    points = [(-along, -across), (along, -across), (along, across), (-along, across)]
    corners = "".join(f'<cornerLocal u="{u}" v="{v}" z="0"/>' for u, v in points)
    return (
        f'<object type="crosswalk" id="{name}" name="{kind}" subtype="{sub}" s="{s}" t="{t}" zOffset="0" orientation="none" '
        f'length="{2 * along}" width="{2 * across}" hdg="0" pitch="0" roll="0"><outline>{corners}</outline></object>'
    )


def stop_line(name: str, s: float, t: float, width: float) -> str:
    """A stop line across a lane."""
    return (
        f'<object type="stopLine" id="{name}" name="stopline" s="{s}" t="{t}" zOffset="0" orientation="none" length="0.3" '
        f'width="{width}" hdg="0" pitch="0" roll="0"/>'
    )


def signal(name: str, s: float, t: float, toward: str, kind: tuple[str, str, str], **more: Any) -> str:
    """A sign or light; kind: country, type and name; lanes: for which it holds; dynamic: yes or no."""
    country, number, called = kind
    lanes = more.get("lanes")
    holds = f'<validity fromLane="{min(lanes)}" toLane="{max(lanes)}"/>' if lanes else ""
    return (
        f'<signal s="{s}" t="{t}" id="{name}" name="{called}" dynamic="{more.get("dynamic", "no")}" orientation="{toward}" '
        f'zOffset="2.5" country="{country}" type="{number}" subtype="-1" value="-1" height="0.9" width="0.6" hOffset="0" '
        f'pitch="0" roll="0">{holds}</signal>'
    )


def light(name: str, s: float, t: float, toward: str, called: str, lane: int) -> str:  # noqa: PLR0917
    """A traffic light for one lane."""
    return signal(name, s, t, toward, ("OpenDRIVE", "1000001", called), lanes=[lane], dynamic="yes")


def _end(tag: str, end: End) -> str:
    contact = f' contactPoint="{end.contact}"' if end.contact else ""
    return f'<{tag} elementType="{end.kind}" elementId="{end.id}"{contact}/>'


def _mark(kind: str, s: float = 0.0) -> str:
    return f'<roadMark sOffset="{s:.3f}" type="{kind}" weight="standard" color="white" width="0.12"/>'


def _connection(n: int, connection: Connection) -> str:
    links = "".join(f'<laneLink from="{a}" to="{b}"/>' for a, b in connection.lanes)
    roads = f'incomingRoad="{connection.incoming}" connectingRoad="{connection.connecting}"'
    return f'<connection id="{n}" {roads} contactPoint="start">{links}</connection>'
