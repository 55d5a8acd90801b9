"""One road and its furniture as OpenDRIVE text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

LaneSpec = tuple[str, float, str]  # kind, width, marking of its outer border


@dataclass
class Road:
    """One OpenDRIVE road; `own` and `other` are lanes from the reference line outwards, by who drives there."""

    number: int
    start: tuple[float, float, float]
    pieces: Sequence[tuple[float, float]]
    own: Sequence[LaneSpec]
    other: Sequence[LaneSpec] = ()
    middle: Sequence[tuple[float, str]] = ((0, "broken"),)
    kind: str = "rural"
    limits: Sequence[tuple[float, str, str]] = ()  # (s, highest speed, unit)
    junction: int = -1
    links: str = ""  # road link elements
    lane_links: dict[int, str] = field(default_factory=dict)
    objects: str = ""
    signals: str = ""
    height: float = 0.0

    def xml(self, hand: int) -> str:
        length = sum(piece[0] for piece in self.pieces)
        x, y, h = self.start
        plan, s = "", 0.0
        for piece, bend in self.pieces:
            shape = f'<arc curvature="{bend:.9f}"/>' if bend else "<line/>"
            place = f's="{s:.4f}" x="{x:.6f}" y="{y:.6f}" hdg="{h:.9f}" length="{piece:.6f}"'
            plan += f"<geometry {place}>{shape}</geometry>"
            s += piece
            if bend:
                x += (math.sin(h + bend * piece) - math.sin(h)) / bend
                y += (math.cos(h) - math.cos(h + bend * piece)) / bend
                h += bend * piece
            else:
                x, y = x + piece * math.cos(h), y + piece * math.sin(h)
        limits = self.limits or [(0, "", "")]
        types = "".join(
            f'<type s="{at}" type="{self.kind}">' + (f'<speed max="{top}" unit="{unit}"/>' if top else "") + "</type>"
            for at, top, unit in limits
        )
        right, left = (self.own, self.other) if hand > 0 else (self.other, self.own)
        marks = "".join(
            f'<roadMark sOffset="{at}" type="{mark}" weight="standard" color="white" width="0.12"/>'
            for at, mark in self.middle
        )
        section = f'<laneSection s="0"><left>{self.lanes(left, 1)}</left>' if left else '<laneSection s="0">'
        section += f'<center><lane id="0" type="none" level="false">{marks}</lane></center>'
        section += f"<right>{self.lanes(right, -1)}</right>" if right else ""
        rule = "RHT" if hand > 0 else "LHT"
        return (
            f'<road name="road {self.number}" length="{length:.6f}" id="{self.number}" junction="{self.junction}" '
            f'rule="{rule}"><link>{self.links}</link>{types}<planView>{plan}</planView><elevationProfile>'
            f'<elevation s="0" a="{self.height}" b="0" c="0" d="0"/></elevationProfile><lateralProfile/>'
            f"<lanes>{section}</laneSection></lanes><objects>{self.objects}</objects>"
            f"<signals>{self.signals}</signals></road>"
        )

    def lanes(self, specs: Sequence[LaneSpec], sign: int) -> str:
        text = [
            f'<lane id="{sign * n}" type="{kind}" level="false"><link>{self.lane_links.get(sign * n, "")}</link>'
            f'<width sOffset="0" a="{width}" b="0" c="0" d="0"/>'
            f'<roadMark sOffset="0" type="{mark}" weight="standard" color="white" width="0.12"/></lane>'
            for n, (kind, width, mark) in enumerate(specs, 1)
        ]
        return "".join(text[::-1] if sign > 0 else text)


def sign(  # noqa: PLR0917
    number: int, s: float, u: float, hand: int, kind: str, moving: bool = False, way: str = "+"
) -> str:
    """A traffic sign, light (1000001) or stop line (294) at the ego's side of the road."""
    country = "OpenDRIVE" if moving else "DE"
    return (
        f'<signal id="{number}" s="{s}" t="{u * hand}" dynamic="{"yes" if moving else "no"}" orientation="{way}" '
        f'zOffset="2" country="{country}" type="{kind}" subtype="-1" value="-1" name="{kind}" height="1" width="1"/>'
    )


def crossing(number: int, s: float, name: str = "zebra", half: float = 3.5, deep: float = 3.0) -> str:
    """A zebra crossing over the whole road."""
    corners = [(s - deep / 2, -half), (s - deep / 2, half), (s + deep / 2, half), (s + deep / 2, -half)]
    outline = "".join(f'<cornerRoad s="{a}" t="{b}" dz="0" height="0" id="{n}"/>' for n, (a, b) in enumerate(corners))
    return (
        f'<object id="{number}" type="crosswalk" name="{name}" s="{s}" t="0" zOffset="0" orientation="none" hdg="0" '
        f'pitch="0" roll="0" length="{deep}" width="{2 * half}" height="0">'
        f'<outlines><outline id="0" closed="true">{outline}</outline></outlines></object>'
    )


WALK: LaneSpec = ("sidewalk", 2.0, "none")
LANE: LaneSpec = ("driving", 3.5, "solid")
KERB: LaneSpec = ("driving", 3.5, "curb")
