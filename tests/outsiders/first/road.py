"""A road of lines and arcs, and the OpenDRIVE text of a map of such roads."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Pose = tuple[float, float, float]  # x, y, heading
Piece = tuple[float, float, float, float, float, float]  # s, x, y, heading at its start, length, curvature


class Lane(NamedTuple):
    width: float
    kind: str = "driving"
    mark: str = "solid"


@dataclass
class Road:
    """A road of lines and arcs; `own` lanes are driven with growing s, `other` lanes against it, both from the middle out."""

    rid: int
    side: int  # +1: the left is driven on, -1: the right
    start: tuple[float, float, float]
    shape: list[tuple[float, float]]  # length and curvature of each piece
    own: list[Lane]
    other: list[Lane] = field(default_factory=list)
    centre: list[tuple[float, str]] = field(default_factory=lambda: [(0.0, "broken")])
    kind: str = "rural"
    limit: tuple[float, str] | None = None
    junction: int = -1
    link: str = ""
    lane_link: str = ""
    signals: list[str] = field(default_factory=list)
    objects: list[str] = field(default_factory=list)
    height: float = 0.0

    @property
    def length(self) -> float:
        return sum(piece for piece, _ in self.shape)

    def pieces(self) -> list[Piece]:
        rows, s, (x, y, h) = [], 0.0, self.start
        for length, bend in self.shape:
            rows.append((s, x, y, h, length, bend))
            x, y, h = step(x, y, h, bend, length)
            s += length
        return rows

    def places(self, stations: Iterable[tuple[float, float]]) -> list[tuple[float, float, float]]:
        """Return x, y, z of places (s, n)."""
        rows = self.pieces()
        return [self._at(rows, s, n) for s, n in stations]

    def _at(self, rows: Sequence[Piece], s: float, n: float) -> tuple[float, float, float]:
        row = next((r for r in reversed(rows) if r[0] <= s), rows[0])
        x, y, h = step(*row[1:4], row[5], s - row[0])
        t = self.side * n
        return x - t * math.sin(h), y + t * math.cos(h), self.height

    def along(self, *knots: tuple[float, float]) -> Array:
        """The way through places (s, n), changing sides smoothly between them."""
        stations: list[tuple[float, float]] = []
        for (s0, n0), (s1, n1) in pairwise(knots):
            steps = max(2, int(abs(s1 - s0) / (1.0 if n0 == n1 else 0.25)))
            stations += [
                (s0 + (s1 - s0) * u, n0 + (n1 - n0) * u**3 * (10 - 15 * u + 6 * u * u))
                for u in np.linspace(0.0, 1.0, steps, endpoint=False).tolist()
            ]
        return np.array(self.places([*stations, knots[-1]]))

    def lanes_xml(self) -> str:
        def lane(number: int, one: Lane) -> str:
            link = f"<link>{self.lane_link}</link>" if self.lane_link else ""
            return (
                f'<lane id="{number}" type="{one.kind}" level="false">{link}<width sOffset="0" a="{one.width}" b="0" c="0" d="0"/>'
                f'<roadMark sOffset="0" type="{one.mark}" weight="standard" color="standard" width="0.12"/></lane>'
            )

        own = [(self.side * (i + 1), one) for i, one in enumerate(self.own)]
        other = [(-self.side * (i + 1), one) for i, one in enumerate(self.other)]
        both = sorted(own + other, key=lambda pair: -pair[0])
        left = "".join(lane(*pair) for pair in both if pair[0] > 0)
        right = "".join(lane(*pair) for pair in both if pair[0] < 0)
        marks = "".join(
            f'<roadMark sOffset="{s}" type="{mark}" weight="standard" color="standard" width="0.12"/>'
            for s, mark in self.centre
        )
        return (
            '<lanes><laneSection s="0">'
            + (f"<left>{left}</left>" if left else "")
            + f'<center><lane id="0" type="none" level="false">{marks}</lane></center>'
            + (f"<right>{right}</right>" if right else "")
            + "</laneSection></lanes>"
        )

    def xml(self) -> str:
        plan = "".join(
            f'<geometry s="{s:.6f}" x="{x:.9f}" y="{y:.9f}" hdg="{h:.12f}" length="{length:.9f}">'
            + (f'<arc curvature="{bend:.12f}"/>' if bend else "<line/>")
            + "</geometry>"
            for s, x, y, h, length, bend in self.pieces()
        )
        speed = f'<speed max="{self.limit[0]}" unit="{self.limit[1]}"/>' if self.limit else ""
        return (
            f'<road name="" length="{self.length:.9f}" id="{self.rid}" junction="{self.junction}" '
            f'rule="{"LHT" if self.side > 0 else "RHT"}"><link>{self.link}</link>'
            f'<type s="0" type="{self.kind}">{speed}</type><planView>{plan}</planView>'
            f'<elevationProfile><elevation s="0" a="{self.height}" b="0" c="0" d="0"/></elevationProfile>'
            f"{self.lanes_xml()}<objects>{''.join(self.objects)}</objects><signals>{''.join(self.signals)}</signals></road>"
        )


def step(x: float, y: float, h: float, bend: float, length: float) -> tuple[float, float, float]:
    if not bend:
        return x + length * math.cos(h), y + length * math.sin(h), h
    turned = h + bend * length
    return x + (math.sin(turned) - math.sin(h)) / bend, y - (math.cos(turned) - math.cos(h)) / bend, turned


def joining(a: tuple[float, float, float], b: tuple[float, float, float]) -> list[tuple[float, float]]:
    """Line, arc and line from one place and heading to another."""
    turn = math.remainder(b[2] - a[2], math.tau)
    if abs(turn) < 1e-6:
        return [(math.hypot(b[0] - a[0], b[1] - a[1]), 0.0)]
    across = math.sin(b[2] - a[2])
    dx, dy = b[0] - a[0], b[1] - a[1]
    first = (dx * math.sin(b[2]) - dy * math.cos(b[2])) / across
    last = (math.cos(a[2]) * dy - math.sin(a[2]) * dx) / across
    tangent = min(first, last)
    radius = tangent / math.tan(abs(turn) / 2)
    pieces = [(first - tangent, 0.0), (radius * abs(turn), math.copysign(1 / radius, turn)), (last - tangent, 0.0)]
    return [piece for piece in pieces if piece[0] > 1e-6]


def sign(  # noqa: PLR0917
    number: int, s: float, t: float, facing: str, kind: str, country: str, lane: int = 0, dynamic: str = "no"
) -> str:
    valid = f'<validity fromLane="{lane}" toLane="{lane}"/>' if lane else ""
    return (
        f'<signal id="{number}" name="" s="{s}" t="{t}" zOffset="2" hOffset="0" dynamic="{dynamic}" orientation="{facing}" '
        f'country="{country}" type="{kind}" subtype="-1" value="-1" height="0.6" width="0.6">{valid}</signal>'
    )


def crosswalk(number: int, s: float, half_width: float, name: str) -> str:
    corners = [(-1.5, -half_width), (1.5, -half_width), (1.5, half_width), (-1.5, half_width)]
    outline = "".join(f'<cornerLocal u="{u}" v="{v}" z="0" height="0"/>' for u, v in corners)
    return (
        f'<object id="{number}" type="crosswalk" name="{name}" s="{s}" t="0" zOffset="0" hdg="0" pitch="0" roll="0" '
        f'orientation="none" length="3" width="{2 * half_width}" height="0"><outline>{outline}</outline></object>'
    )


@dataclass
class Map:
    roads: dict[str, Road]
    junctions: str = ""

    def xml(self) -> str:
        return (
            '<?xml version="1.0" encoding="UTF-8"?><OpenDRIVE><header revMajor="1" revMinor="7" name="" version="1"/>'
            + "".join(road.xml() for road in self.roads.values())
            + f"{self.junctions}</OpenDRIVE>"
        )

    def along(self, *knots: tuple[float, float]) -> Array:
        return self.roads["main"].along(*knots)
