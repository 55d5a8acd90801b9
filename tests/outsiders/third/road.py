"""Roads, junctions and what stands beside them, as OpenDRIVE text."""

from __future__ import annotations

import math
from typing import NamedTuple

from tests.outsiders.third.movement import MPH
from tests.outsiders.third.ways import Way

Marks = tuple[tuple[float, str], ...]  # from s on, kind of line


class Lane(NamedTuple):
    """A lane, from the middle of the road outwards; the mark is that of its outer edge."""

    kind: str
    width: float = 3.5
    mark: str = "solid"


class Section(NamedTuple):
    """From s on the road has these lanes on its near and its far side."""

    s: float
    near: tuple[Lane, ...]
    far: tuple[Lane, ...]
    centre: Marks = ((0.0, "broken"),)


class Sign(NamedTuple):
    """A sign or light at s, t to the near side, for those who go along the road."""

    ident: str
    name: str
    s: float
    t: float
    country: str = ""
    kind: str = "-1"

    def moved(self, by: float) -> Sign:
        return self._replace(s=self.s + by)

    def xml(self, hand: int) -> str:
        dynamic = "yes" if self.kind == "1000001" else "no"
        return (
            f'<signal s="{self.s}" t="{self.t * hand}" id="{self.ident}" name="{self.name}" '
            f'dynamic="{dynamic}" orientation="+" zOffset="2" country="{self.country}" '
            f'type="{self.kind}" subtype="-1" value="-1" height="1" width="0.5"/>'
        )


class Area(NamedTuple):
    """An object that covers a rectangle of the road, such as a crossing or a stop line."""

    ident: str
    kind: str
    name: str
    s0: float
    s1: float
    t0: float
    t1: float

    def moved(self, by: float) -> Area:
        return self._replace(s0=self.s0 + by, s1=self.s1 + by)

    def xml(self, hand: int) -> str:
        s0, s1, t0, t1 = (float(value) for value in self[3:])
        corners = "".join(
            f'<cornerRoad s="{s}" t="{t * hand}" dz="0" height="0" id="{i}"/>'
            for i, (s, t) in enumerate(((s0, t0), (s1, t0), (s1, t1), (s0, t1)))
        )
        return (
            f'<object id="{self.ident}" type="{self.kind}" name="{self.name}" s="{(s0 + s1) / 2}" '
            f't="{(t0 + t1) / 2 * hand}" zOffset="0" hdg="0" pitch="0" roll="0" orientation="none" height="0" '
            f'length="{s1 - s0}" width="{abs(t1 - t0)}"><outlines><outline id="0" closed="true">{corners}</outline>'
            f"</outlines></object>"
        )


class Road(NamedTuple):
    """A road of the map."""

    number: int
    way: Way
    sections: tuple[Section, ...]
    kind: str | None = "rural"
    limit: float | None = 60 * MPH  # m/s; infinite: none is in force; None: the map does not say
    junction: int = -1
    joins: tuple[tuple[str, str, int, str], ...] = ()  # predecessor or successor, kind, id, its end that is met
    lane_joins: tuple[tuple[int, str, int], ...] = ()  # lane, predecessor or successor, the other's lane
    things: tuple[Sign | Area, ...] = ()
    z: float = 0.0

    def xml(self, hand: int) -> str:
        length = sum(part[3] for part in self.way.geometry)
        joins = "".join(
            f'<{how} elementType="{kind}" elementId="{number}"' + (f' contactPoint="{end}"' if end else "") + "/>"
            for how, kind, number, end in self.joins
        )
        out = [
            f'<road name="r{self.number}" length="{length:.6f}" id="{self.number}" junction="{self.junction}" ',
            f'rule="{"LHT" if hand == 1 else "RHT"}"><link>{joins}</link>',
        ]
        if self.kind:
            limit = "no limit" if self.limit == math.inf else self.limit
            speed = f'<speed max="{limit}" unit="m/s"/>' if limit else ""
            out.append(f'<type s="0" type="{self.kind}">{speed}</type>')
        out.append("<planView>")
        done = 0.0
        for x, y, heading, part, curvature in self.way.geometry:
            shape = f'<arc curvature="{curvature * hand:.9f}"/>' if curvature else "<line/>"
            out.append(f'<geometry s="{done:.6f}" x="{x:.6f}" y="{y * hand:.6f}" hdg="{heading * hand:.9f}" ')
            out.append(f'length="{part:.6f}">{shape}</geometry>')
            done += part
        out.append(f'</planView><elevationProfile><elevation s="0" a="{self.z}" b="0" c="0" d="0"/></elevationProfile>')
        out += ["<lanes>", *(self._section(i, hand) for i in range(len(self.sections))), "</lanes>"]
        for tag, kind in (("objects", Area), ("signals", Sign)):
            out.append(f"<{tag}>" + "".join(t.xml(hand) for t in self.things if isinstance(t, kind)) + f"</{tag}>")
        return "".join([*out, "</road>"])

    def _section(self, index: int, hand: int) -> str:
        section = self.sections[index]
        near = [(n, self._lane(index, n, hand)) for n in range(1, len(section.near) + 1)]
        far = [(-n, self._lane(index, -n, hand)) for n in range(1, len(section.far) + 1)]
        sides = sorted(((number * hand, xml) for number, xml in near + far), reverse=True)
        centre = "".join(_mark(s, mark) for s, mark in section.centre)
        left = "".join(xml for number, xml in sides if number > 0)
        right = "".join(xml for number, xml in sides if number < 0)
        return (
            f'<laneSection s="{section.s}">'
            + (f"<left>{left}</left>" if left else "")
            + f'<center><lane id="0" type="none" level="false">{centre}</lane></center>'
            + (f"<right>{right}</right>" if right else "")
            + "</laneSection>"
        )

    def _lane(self, index: int, number: int, hand: int) -> str:
        """Return a lane; it goes on in the lane of its kind and rank in the sections before and after."""
        lanes = self._lanes(index, number)
        lane = lanes[abs(number) - 1]
        rank = sum(other.kind == lane.kind for other in lanes[: abs(number)])
        link = "".join(f'<{how} id="{other * hand}"/>' for mine, how, other in self.lane_joins if mine == number)
        for how, other in (("predecessor", index - 1), ("successor", index + 1)):
            if 0 <= other < len(self.sections):
                same = [i for i, one in enumerate(self._lanes(other, number), 1) if one.kind == lane.kind]
                if len(same) >= rank:
                    link += f'<{how} id="{same[rank - 1] * (1 if number > 0 else -1) * hand}"/>'
        return (
            f'<lane id="{number * hand}" type="{lane.kind}" level="false"><link>{link}</link>'
            f'<width sOffset="0" a="{lane.width}" b="0" c="0" d="0"/>{_mark(0, lane.mark)}</lane>'
        )

    def _lanes(self, index: int, number: int) -> tuple[Lane, ...]:
        """Return the lanes of a section on the side of a lane of that number."""
        return self.sections[index].near if number > 0 else self.sections[index].far


def _mark(s: float, kind: str) -> str:
    return f'<roadMark sOffset="{s}" type="{kind}" weight="standard" color="white" width="0.12"/>'


class Link(NamedTuple):
    """A way through a junction."""

    junction: int
    incoming: int
    connecting: int
    lanes: tuple[tuple[int, int], ...]


class Map(NamedTuple):
    """Roads and the ways through their junctions."""

    roads: tuple[Road, ...]
    links: tuple[Link, ...] = ()

    def xml(self, hand: int) -> str:
        """Return the map as OpenDRIVE; hand is 1 where the left is driven on and -1 where it is mirrored."""
        out = ['<?xml version="1.0" encoding="UTF-8"?><OpenDRIVE><header revMajor="1" revMinor="7" name="drawn"/>']
        out += [road.xml(hand) for road in self.roads]
        for number in sorted({link.junction for link in self.links}):
            out.append(f'<junction id="{number}" name="j{number}">')
            for index, link in enumerate(x for x in self.links if x.junction == number):
                lanes = "".join(f'<laneLink from="{a * hand}" to="{b * hand}"/>' for a, b in link.lanes)
                out.append(f'<connection id="{index}" incomingRoad="{link.incoming}" ')
                out.append(f'connectingRoad="{link.connecting}" contactPoint="start">{lanes}</connection>')
            out.append("</junction>")
        return "".join([*out, "</OpenDRIVE>"])
