"""Roads with lanes, signals and objects, written as OpenDRIVE.

The own side of a road is the one that goes along it: left (positive lanes) where the left is driven on, else right. Lanes are
counted 1, 2, ... outwards on the own side and -1, -2, ... on the other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from tests.outsiders.sixth.lines import Geom


@dataclass(frozen=True)
class Lane:
    type: str = "driving"
    width: float = 3.5
    mark: str = "broken"


@dataclass
class Road:
    id: str
    geoms: list[Geom]
    own: list[Lane]
    opp: list[Lane] = field(default_factory=list)
    hand: int = -1
    type: str = "rural"
    speed: float | None = None
    unit: str = "mph"
    centre: str = "broken"
    more: list[tuple[float, list[Lane]]] = field(default_factory=list)
    marks: list[tuple[float, str]] = field(default_factory=list)
    junction: str = "-1"
    pred: tuple[str, str, str] | None = None
    succ: tuple[str, str, str] | None = None
    links: tuple[int, int] | None = None
    z: float = 0.0
    signals: list[str] = field(default_factory=list)
    objects: list[str] = field(default_factory=list)

    @property
    def length(self) -> float:
        return sum(g.length for g in self.geoms)

    def middle(self, lane: int, s: float = 0.0) -> float:
        """Return how far the middle of a lane is on the own side of the reference line."""
        lanes, n = (self._own_at(s), lane) if lane > 0 else (self.opp, -lane)
        return (1 if lane > 0 else -1) * (sum(x.width for x in lanes[: n - 1]) + lanes[n - 1].width / 2)

    def signal(  # noqa: PLR0917
        self, ident: str, s: float, lane: int, kind: str, country: str = "OpenDRIVE", name: str = "", out: float = 0.0
    ) -> Road:
        """Set a sign or light for a lane, beside it, or `out` metres from its middle."""
        t = self.hand * (self.middle(lane, s) + (out or math.copysign(2.5, lane)))
        dynamic = "yes" if country == "OpenDRIVE" else "no"
        self.signals.append(
            f'<signal s="{s:.3f}" t="{t:.3f}" id="{ident}" name="{name}" dynamic="{dynamic}" '
            f'orientation="{_way(lane)}" zOffset="2.5" country="{country}" type="{kind}" subtype="-1" '
            f'value="-1" height="0.9" width="0.6">{self._validity(lane)}</signal>'
        )
        return self

    def stopline(self, ident: str, s: float, lane: int) -> Road:
        """Draw a stop line across a lane."""
        t, w = self.hand * self.middle(lane, s), (self.own[lane - 1] if lane > 0 else self.opp[-lane - 1]).width
        self.objects.append(
            f'<object s="{s:.3f}" t="{t:.3f}" zOffset="0" id="{ident}" name="stop_line" type="stopLine" '
            f'orientation="{_way(lane)}" hdg="0" pitch="0" roll="0" length="0.3" width="{w:.2f}" height="0.01">'
            f"{self._validity(lane)}</object>"
        )
        return self

    def crossing(self, ident: str, s: float, name: str = "zebra", across: float = 7.0) -> Road:
        """Draw a pedestrian crossing, 3 m wide."""
        self.objects.append(
            f'<object s="{s:.3f}" t="0.000" zOffset="0" id="{ident}" name="{name}" type="crosswalk" orientation="none" '
            f'hdg="0" pitch="0" roll="0" length="3.00" width="{across:.2f}" height="0.01"/>'
        )
        return self

    def xml(self) -> str:
        rule = "LHT" if self.hand > 0 else "RHT"
        out = [
            f'<road id="{self.id}" name="r{self.id}" length="{self.length:.6f}" junction="{self.junction}" rule="{rule}">',
            f"<link>{self._link('predecessor', self.pred)}{self._link('successor', self.succ)}</link>",
        ]
        limit = "" if self.speed is None else f'<speed max="{self.speed:g}" unit="{self.unit}"/>'
        out.append(f'<type s="0" type="{self.type}">{limit}</type><planView>')
        s = 0.0
        for g in self.geoms:
            out.append(g.xml(s))
            s += g.length
        out.append(
            f'</planView><elevationProfile><elevation s="0" a="{self.z:g}" b="0" c="0" d="0"/></elevationProfile><lanes>'
        )
        out += [self._section(k) for k in range(len(self.more) + 1)]
        out.append("</lanes>")
        if self.objects:
            out.append("<objects>" + "".join(self.objects) + "</objects>")
        if self.signals:
            out.append("<signals>" + "".join(self.signals) + "</signals>")
        return "".join([*out, "</road>"])

    def _own_at(self, s: float) -> list[Lane]:
        own = self.own
        for begin, lanes in self.more:
            if s >= begin:
                own = lanes
        return own

    def _validity(self, lane: int) -> str:
        return f'<validity fromLane="{self.hand * lane}" toLane="{self.hand * lane}"/>'

    @staticmethod
    def _link(tag: str, ref: tuple[str, str, str] | None) -> str:
        if not ref:
            return ""
        kind, ident, contact = ref
        return f'<{tag} elementType="{kind}" elementId="{ident}"' + (
            f' contactPoint="{contact}"/>' if contact else "/>"
        )

    def _section(self, k: int) -> str:
        sections = [(0.0, self.own), *self.more]
        s, own = sections[k]
        sides = {self.hand: own, -self.hand: self.opp}
        kinds = [(s, self.centre)] + [x for x in self.marks if x[0] > s]
        centre = "".join(_mark(f"{m - s:.3f}", kind) for m, kind in kinds)
        out = f'<laneSection s="{s:.3f}">'
        if sides[1]:
            out += "<left>" + "".join(self._lane(k, i, 1) for i in range(len(sides[1]), 0, -1)) + "</left>"
        out += f'<center><lane id="0" type="none" level="false">{centre}</lane></center>'
        if sides[-1]:
            out += "<right>" + "".join(self._lane(k, i, -1) for i in range(1, len(sides[-1]) + 1)) + "</right>"
        return out + "</laneSection>"

    def _lane(self, k: int, i: int, side: int) -> str:
        sections = (
            [self.own, *(lanes for _, lanes in self.more)] if side == self.hand else [self.opp] * (len(self.more) + 1)
        )
        lane, link = sections[k][i - 1], ""
        if self.links and i == 1:
            link = f'<predecessor id="{self.links[0]}"/><successor id="{self.links[1]}"/>'
        else:
            for tag, other in (("predecessor", k - 1), ("successor", k + 1)):
                if 0 <= other < len(sections) and (number := _same(sections[other], sections[k], i)):
                    link += f'<{tag} id="{side * number}"/>'
        return (
            f'<lane id="{side * i}" type="{lane.type}" level="false"><link>{link}</link>'
            f'<width sOffset="0" a="{lane.width:g}" b="0" c="0" d="0"/>{_mark("0", lane.mark)}</lane>'
        )


@dataclass
class Map:
    roads: list[Road]
    junctions: list[str] = field(default_factory=list)

    def __getitem__(self, ident: str) -> Road:
        return next(r for r in self.roads if r.id == ident)

    def xml(self) -> str:
        return (
            '<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE><header revMajor="1" revMinor="6" name="h" version="1" '
            'north="0" south="0" east="0" west="0"/>'
            + "\n".join(r.xml() for r in self.roads)
            + "".join(self.junctions)
            + "</OpenDRIVE>\n"
        )


def _mark(offset: str, kind: str) -> str:
    return f'<roadMark sOffset="{offset}" type="{kind}" weight="standard" color="standard" width="0.12"/>'


def _way(lane: int) -> str:
    return "+" if lane > 0 else "-"


def _same(there: list[Lane], here: list[Lane], i: int) -> int:
    """Which lane of the other section goes on as lane i of this: of its kind, and as many before it; 0: none."""
    kind = here[i - 1].type
    rank = sum(x.type == kind for x in here[:i])
    same = [j for j, x in enumerate(there, 1) if x.type == kind]
    return same[rank - 1] if len(same) >= rank else 0
