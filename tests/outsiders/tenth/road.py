"""Roads of lanes, and the OpenDRIVE text of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tests.outsiders.tenth.ways import Path, along, path


@dataclass(frozen=True)
class Lane:
    """One lane: its type, width, the line at its far side, its own limit in m/s."""

    kind: str = "driving"
    width: float = 3.5
    mark: str = "broken"
    grow: float = 0.0
    limit: float | None = None


@dataclass(frozen=True)
class Section:
    """The lanes from s on: of both sides from the middle outwards."""

    s: float
    left: tuple[Lane, ...]
    right: tuple[Lane, ...]
    middle: str = "broken"


@dataclass
class Road:
    """A road: where it begins, its pieces (length, curvature), and its lanes."""

    id: int
    start: tuple[float, float, float]
    pieces: list[tuple[float, float]]
    sections: list[Section]
    rule: str
    kind: str = "rural"
    speed: tuple[float, str] | None = None
    junction: int = -1
    links: str = ""
    signals: list[str] = field(default_factory=list)
    objects: list[str] = field(default_factory=list)
    z: float = 0.0
    ends: tuple[Callable[[int], int], Callable[[int], int]] = (int, int)
    """Of a road in a junction: the lanes that it comes from and goes to, by its own."""

    @property
    def length(self) -> float:
        """How long it is."""
        return sum(length for length, _ in self.pieces)

    def starts(self) -> list[tuple[float, float, float, float, float, float]]:
        """Every piece: s, x, y, heading, length, curvature."""
        x, y, h = self.start
        s, out = 0.0, []
        for length, k in self.pieces:
            out.append((s, x, y, h, length, k))
            x, y, h = along(x, y, h, length, k)
            s += length
        return out

    def at(self, s: float, t: float = 0.0) -> tuple[float, float, float]:
        """World point and heading at s, t to the left."""
        for s0, x0, y0, h0, _, k in reversed(self.starts()):
            if s >= s0 or s0 == 0.0:
                x, y, h = along(x0, y0, h0, s - s0, k)
                return x - t * math.sin(h), y + t * math.cos(h), h
        raise ValueError(s)

    def way(self, t: float, s0: float = 0.0, s1: float | None = None, *, back: bool = False) -> Path:
        """The path at t to the left; against the road if `back`."""
        s1 = self.length if s1 is None else s1
        n = max(2, int((s1 - s0) / 0.5) + 1) if any(k for _, k in self.pieces) else 2
        points = [self.at(float(s), t) for s in np.linspace(s0, s1, n)]
        if back:
            points = [(x, y, h + math.pi) for x, y, h in reversed(points)]
        return path(points)

    def point(self, s: float, t: float) -> tuple[float, float]:
        """World point only."""
        return self.at(s, t)[:2]

    def xml(self) -> str:
        """The road in OpenDRIVE."""
        geo = "".join(
            f'<geometry s="{s:.6f}" x="{x:.6f}" y="{y:.6f}" hdg="{h:.9f}" length="{n:.6f}">'
            + (f'<arc curvature="{k:.9f}"/>' if k else "<line/>")
            + "</geometry>"
            for s, x, y, h, n, k in self.starts()
        )
        limit = f'<speed max="{self.speed[0]}" unit="{self.speed[1]}"/>' if self.speed else ""
        text = "".join(self._section(i) for i in range(len(self.sections)))
        profile = f'<elevationProfile><elevation s="0" a="{self.z}" b="0" c="0" d="0"/></elevationProfile>'
        return (
            f'<road id="{self.id}" name="r{self.id}" length="{self.length:.6f}" junction="{self.junction}"'
            f' rule="{self.rule}"><link>{self.links}</link><type s="0" type="{self.kind}">{limit}</type>'
            f"<planView>{geo}</planView>{profile}<lanes>{text}</lanes>"
            f"<objects>{''.join(self.objects)}</objects><signals>{''.join(self.signals)}</signals></road>\n"
        )

    def _section(self, i: int) -> str:
        sec = self.sections[i]
        before = self.sections[i - 1] if i else None
        after = self.sections[i + 1] if i + 1 < len(self.sections) else None

        def lane(n: int, lane: Lane) -> str:
            link = ""
            for other, word in ((before, "predecessor"), (after, "successor")):
                if other and abs(n) <= len(other.left if n > 0 else other.right):
                    link += f'<{word} id="{n}"/>'
            if self.junction >= 0:
                link = f'<predecessor id="{self.ends[0](n)}"/><successor id="{self.ends[1](n)}"/>'
            limit = f'<speed sOffset="0" max="{lane.limit}" unit="m/s"/>' if lane.limit else ""
            return (
                f'<lane id="{n}" type="{lane.kind}" level="false"><link>{link}</link>'
                f'<width sOffset="0" a="{lane.width}" b="{lane.grow}" c="0" d="0"/>'
                f'<roadMark sOffset="0" type="{lane.mark}" weight="standard" color="white" width="0.12"/>'
                f"{limit}</lane>"
            )

        left = "".join(lane(n, sec.left[n - 1]) for n in range(len(sec.left), 0, -1))
        right = "".join(lane(-n, sec.right[n - 1]) for n in range(1, len(sec.right) + 1))
        return (
            f'<laneSection s="{sec.s}">'
            + (f"<left>{left}</left>" if left else "")
            + '<center><lane id="0" type="none" level="false"><roadMark sOffset="0"'
            f' type="{sec.middle}" weight="standard" color="white" width="0.12"/></lane></center>'
            + (f"<right>{right}</right>" if right else "")
            + "</laneSection>"
        )

    def light(self, name: str, s: float, t: float, toward: str, lanes: tuple[int, int]) -> None:
        """Set up a traffic light; `toward` is + for traffic along the road."""
        self.sign(name, "1000001", "OpenDRIVE", s, t, toward, lanes, dynamic="yes")

    def sign(  # noqa: PLR0917
        self,
        name: str,
        kind: str,
        country: str,
        s: float,
        t: float,
        toward: str,
        lanes: tuple[int, int] | None = None,
        *,
        dynamic: str = "no",
        size: tuple[float, float] = (0.6, 0.6),
    ) -> None:
        """Set up a sign."""
        valid = f'<validity fromLane="{lanes[0]}" toLane="{lanes[1]}"/>' if lanes else ""
        self.signals.append(
            f'<signal id="{name}" name="{name}" s="{s}" t="{t}" zOffset="2" orientation="{toward}"'
            f' dynamic="{dynamic}" country="{country}" type="{kind}" subtype="-1" value="-1"'
            f' width="{size[0]}" height="{size[1]}" hOffset="0">{valid}</signal>'
        )

    def stop_line(self, name: str, s: float, t: float, toward: str, width: float = 3.4) -> None:
        """Paint a stop line."""
        self.objects.append(
            f'<object id="{name}" name="stop_line" type="stopLine" s="{s}" t="{t}" zOffset="0" hdg="0"'
            f' orientation="{toward}" length="0.3" width="{width}" height="0"/>'
        )

    def crossing(self, name: str, s: float, long: float, wide: float, *, kind: str = "zebra", t: float = 0.0) -> None:
        """Paint a crossing: `long` along the road, `wide` across it."""
        a, b = long / 2, wide / 2
        corners = "".join(
            f'<cornerLocal u="{u}" v="{v}" z="0" height="0"/>' for u, v in ((-a, -b), (a, -b), (a, b), (-a, b))
        )
        self.objects.append(
            f'<object id="{name}" name="{kind}_{name}" type="crosswalk" subtype="{kind}" s="{s}" t="{t}" zOffset="0"'
            f' hdg="0" orientation="none" length="{long}" width="{wide}" height="0"><outline>{corners}</outline></object>'
        )


def xodr(roads: list[Road], junctions: str = "") -> str:
    """The whole map."""
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE><header revMajor="1" revMinor="6" name="tenth"'
        ' version="1" north="2000" south="-2000" east="2000" west="-2000"/>\n'
        + "".join(r.xml() for r in roads)
        + junctions
        + "</OpenDRIVE>\n"
    )
