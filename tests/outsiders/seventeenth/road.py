"""Roads, lanes, signs and objects as OpenDRIVE text."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from tests.outsiders.seventeenth.ways import Pairs, step

Moved = tuple[float, float, float]  # a map's shift along x and y, and its turn
Map = Callable[[Moved], str]
Marks = Sequence[tuple[float, str]]  # (from, kind)
HEAD = (
    '<?xml version="1.0"?>\n<OpenDRIVE><header revMajor="1" revMinor="6" name="" version="1.00"'
    ' north="0" south="0" east="0" west="0"/>\n'
)


@dataclass
class Lane:
    """A lane of one width all along."""

    id: int
    type: str = "driving"
    width: float = 3.5
    marks: Marks = ((0.0, "solid"),)
    link: tuple[int, int] | None = None

    def xml(self) -> str:
        link = f'<predecessor id="{self.link[0]}"/><successor id="{self.link[1]}"/>' if self.link else ""
        return (
            f'<lane id="{self.id}" type="{self.type}" level="false"><link>{link}</link>'
            f'<width sOffset="0" a="{self.width}" b="0" c="0" d="0"/>{_marks(self.marks)}</lane>'
        )


@dataclass
class Road:
    """A road with one lane section."""

    id: int
    start: Moved
    pieces: Pairs
    lanes: list[Lane]
    centre: Marks = ((0.0, "broken"),)
    kind: str = "rural"
    limit: tuple[float, str] | None = (60, "mph")
    gb: bool = True
    junction: int = -1
    before: tuple[str, int, str] | None = None
    after: tuple[str, int, str] | None = None
    objects: Sequence[str] = field(default_factory=list)
    signals: Sequence[str] = field(default_factory=list)

    def xml(self, moved: Moved) -> str:
        rule = "LHT" if self.gb else "RHT"
        length = sum(piece[0] for piece in self.pieces)
        links = _link("predecessor", self.before) + _link("successor", self.after)
        speed = f'<speed max="{self.limit[0]}" unit="{self.limit[1]}"/>' if self.limit else ""
        return (
            f'<road name="" id="{self.id}" junction="{self.junction}" length="{length:.9f}" rule="{rule}">'
            f'<link>{links}</link><type s="0" type="{self.kind}">{speed}</type>'
            f"<planView>{self._plan(moved)}</planView><elevationProfile/>"
            f'<lanes><laneSection s="0">{self._section()}</laneSection></lanes>'
            f"<objects>{''.join(self.objects)}</objects><signals>{''.join(self.signals)}</signals></road>\n"
        )

    def _plan(self, moved: Moved) -> str:
        c, s = math.cos(moved[2]), math.sin(moved[2])
        x, y, h = self.start
        out, at = "", 0.0
        for length, k in self.pieces:
            gx, gy = c * x - s * y + moved[0], s * x + c * y + moved[1]
            shape = f'<arc curvature="{k:.12f}"/>' if k else "<line/>"
            out += (
                f'<geometry s="{at:.9f}" x="{gx:.9f}" y="{gy:.9f}" hdg="{h + moved[2]:.12f}" '
                f'length="{length:.9f}">{shape}</geometry>'
            )
            x, y, h = step(x, y, h, k, length)
            at += length
        return out

    def _section(self) -> str:
        lanes = sorted(self.lanes, key=lambda lane: -lane.id)
        left = "".join(lane.xml() for lane in lanes if lane.id > 0)
        right = "".join(lane.xml() for lane in lanes if lane.id < 0)
        centre = f'<center><lane id="0" type="none" level="false">{_marks(self.centre)}</lane></center>'
        return (f"<left>{left}</left>" if left else "") + centre + (f"<right>{right}</right>" if right else "")


def _marks(marks: Marks) -> str:
    return "".join(
        f'<roadMark sOffset="{s}" type="{kind}" weight="standard" color="white" width="0.12"/>' for s, kind in marks
    )


def _link(tag: str, link: tuple[str, int, str] | None) -> str:
    if link is None:
        return ""
    point = f' contactPoint="{link[2]}"' if link[2] else ""
    return f'<{tag} elementType="{link[0]}" elementId="{link[1]}"{point}/>'


def sheet(roads: Sequence[Road], tail: str = "") -> Map:
    """Return a map that can be shifted and turned."""

    def made(moved: Moved) -> str:
        return HEAD + "".join(road.xml(moved) for road in roads) + tail + "</OpenDRIVE>\n"

    return made


def box(  # noqa: PLR0917
    name: str, kind: str, called: str, s: float, t: float, along: float, across: float
) -> str:
    """Return an object with an outline, such as a crossing or a stop line."""
    u, v = along / 2, across / 2
    corners = "".join(
        f'<cornerLocal u="{a}" v="{b}" z="0" height="0"/>' for a, b in ((-u, -v), (u, -v), (u, v), (-u, v))
    )
    return (
        f'<object id="{name}" type="{kind}" name="{called}" s="{s}" t="{t}" zOffset="0" hdg="0" pitch="0" roll="0" '
        f'orientation="none" length="{along}" width="{across}" height="0"><outline>{corners}</outline></object>'
    )


def sign(  # noqa: PLR0917
    name: str, country: str, kind: str, s: float, t: float, lane: int, called: str = "", *, dynamic: bool = False
) -> str:
    """Return a sign or a light for one lane, for those who drive along the road's direction."""
    return (
        f'<signal id="{name}" name="{called}" s="{s}" t="{t}" zOffset="2" hOffset="0" '
        f'dynamic="{"yes" if dynamic else "no"}" orientation="+" country="{country}" type="{kind}" subtype="-1" '
        f'value="-1" height="0.5" width="0.5"><validity fromLane="{lane}" toLane="{lane}"/></signal>'
    )
