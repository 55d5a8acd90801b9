"""Roads of the drives, as OpenDRIVE."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Segment = tuple[float, float]  # length, curvature


@dataclass(frozen=True)
class Path:
    """A way made of straight pieces and arcs; it goes on straight beyond its ends."""

    x: float
    y: float
    heading: float
    segments: tuple[Segment, ...]

    @property
    def length(self) -> float:
        return sum(length for length, _ in self.segments)

    def poses(self) -> list[tuple[float, float, float, float, float, float]]:
        """Start s, x, y, heading, length and curvature of every piece."""
        found = []
        s, x, y, h = 0.0, self.x, self.y, self.heading
        for length, k in self.segments:
            found.append((s, x, y, h, length, k))
            if k == 0:
                x, y = x + length * math.cos(h), y + length * math.sin(h)
            else:
                x += (math.sin(h + k * length) - math.sin(h)) / k
                y -= (math.cos(h + k * length) - math.cos(h)) / k
                h += k * length
            s += length
        return found

    def at(self, s: Array) -> tuple[Array, Array, Array]:
        """Where the way is at s, and its heading."""
        x, y, h = np.zeros_like(s), np.zeros_like(s), np.zeros_like(s)
        pieces = self.poses()
        for i, (s0, x0, y0, h0, length, k) in enumerate(pieces):
            here = (s >= s0) if i else np.ones_like(s, dtype=bool)
            d = s[here] - s0
            curved = np.clip(d, 0.0, length) if k else d * 0.0
            straight = d - curved
            hh = h0 + k * curved
            if k:
                x[here] = x0 + (np.sin(hh) - math.sin(h0)) / k + straight * np.cos(hh)
                y[here] = y0 - (np.cos(hh) - math.cos(h0)) / k + straight * np.sin(hh)
            else:
                x[here] = x0 + straight * math.cos(h0)
                y[here] = y0 + straight * math.sin(h0)
            h[here] = hh
        return x, y, h


@dataclass(frozen=True)
class Frame:
    """How a whole drive is turned and shifted."""

    dx: float = 0.0
    dy: float = 0.0
    turn: float = 0.0

    def point(self, x: Array, y: Array) -> tuple[Array, Array]:
        c, s = math.cos(self.turn), math.sin(self.turn)
        return c * x - s * y + self.dx, s * x + c * y + self.dy


@dataclass(frozen=True)
class Lane:
    kind: str = "driving"
    width: float = 3.5
    mark: str = "broken"


@dataclass
class Road:
    number: int
    path: Path
    left: list[Lane]
    right: list[Lane]
    rule: str
    kind: str = "rural"
    speeds: list[tuple[float, str]] = field(default_factory=list)  # from s: km/h or mph, with unit
    middle: list[tuple[float, str]] = field(default_factory=lambda: [(0.0, "broken")])
    extra: str = ""  # signals and objects
    junction: int = -1
    link: str = ""
    lane_links: dict[int, str] = field(default_factory=dict)

    def xml(self, frame: Frame) -> str:
        name = f'name="r{self.number}" length="{self.path.length:.6f}" id="{self.number}"'
        rows = [
            f'<road {name} junction="{self.junction}" rule="{self.rule}">',
            f"<link>{self.link}</link>",
        ]
        for s, speed in self.speeds:
            value, unit = speed.split()
            rows.append(f'<type s="{s}" type="{self.kind}"><speed max="{value}" unit="{unit}"/></type>')
        if not self.speeds:
            rows.append(f'<type s="0" type="{self.kind}"/>')
        rows.append("<planView>")
        for s, x, y, h, length, k in self.path.poses():
            px, py = frame.point(np.array([x]), np.array([y]))
            shape = f'<arc curvature="{k:.10f}"/>' if k else "<line/>"
            rows.append(
                f'<geometry s="{s:.6f}" x="{px[0]:.6f}" y="{py[0]:.6f}" '
                f'hdg="{h + frame.turn:.9f}" length="{length:.6f}">{shape}</geometry>'
            )
        rows.append("</planView><elevationProfile/><lateralProfile/><lanes>")
        rows.append('<laneSection s="0">')
        if self.left:
            rows.append(
                "<left>" + "".join(self._lane(i, self.left[i - 1]) for i in range(len(self.left), 0, -1)) + "</left>"
            )
        marks = "".join(
            f'<roadMark sOffset="{s}" type="{m}" weight="standard" color="white" width="0.12"/>' for s, m in self.middle
        )
        rows.append(f'<center><lane id="0" type="none" level="false">{marks}</lane></center>')
        if self.right:
            rows.append(
                "<right>"
                + "".join(self._lane(-i, self.right[i - 1]) for i in range(1, len(self.right) + 1))
                + "</right>"
            )
        rows.append(f"</laneSection></lanes>{self.extra}</road>")
        return "\n".join(rows)

    def _lane(self, number: int, lane: Lane) -> str:
        return (
            f'<lane id="{number}" type="{lane.kind}" level="false">'
            f"<link>{self.lane_links.get(number, '')}</link>"
            f'<width sOffset="0" a="{lane.width}" b="0" c="0" d="0"/>'
            f'<roadMark sOffset="0" type="{lane.mark}" weight="standard" color="white" width="0.12"/></lane>'
        )


@dataclass
class Map:
    roads: list[Road]
    junction: str = ""

    def xml(self, frame: Frame) -> str:
        body = "\n".join(road.xml(frame) for road in self.roads)
        return (
            '<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE>'
            '<header revMajor="1" revMinor="6" name="t" version="1" date="2024-01-01T00:00:00" '
            'north="0" south="0" east="0" west="0"/>\n'
            f"{body}\n{self.junction}</OpenDRIVE>\n"
        )


def side(nation: str) -> int:
    """+1 where the left is driven on, -1 where the right is: t of one's own side."""
    return -1 if nation == "de" else 1


def rule_of(nation: str) -> str:
    return "RHT" if nation == "de" else "LHT"


def motorway(nation: str = "de", lanes: int = 3, limit: str = "130 km/h") -> Map:
    """One carriageway of a motorway with a hard shoulder; o = 0 is the border to the middle."""
    row = [Lane("driving", 3.75) for _ in range(lanes - 1)] + [Lane("driving", 3.75, "solid")]
    row.append(Lane("shoulder", 3.0, "none"))
    path = Path(0, 0, 0, ((3000.0, 0.0),))
    left, right = (row, []) if nation != "de" else ([], row)
    return Map(
        [Road(1, path, left, right, rule_of(nation), "motorway", [(0.0, limit)] if limit else [], [(0.0, "solid")])]
    )


def single(
    nation: str = "de",
    kind: str = "rural",
    limit: str = "100 km/h",
    *,
    segments: tuple[Segment, ...] = (),
    footway: bool = False,
    middle: list[tuple[float, str]] | None = None,
    extra: str = "",
    speeds: list[tuple[float, str]] | None = None,
) -> Map:
    """A road of one lane each way."""
    row = [Lane("driving", 3.5, "solid")]
    if footway:
        row.append(Lane("sidewalk", 2.0, "none"))
    path = Path(0, 0, 0, segments or ((1500.0, 0.0),))
    return Map(
        [
            Road(
                1,
                path,
                list(row),
                list(row),
                rule_of(nation),
                kind,
                speeds or [(0.0, limit)],
                middle or [(0.0, "broken")],
                extra,
            )
        ]
    )


def crossing(s: float, width: float = 3.5, deep: float = 3.0, name: str = "zebra") -> str:
    """The object of a crossing over both lanes at s."""
    corners = "".join(
        f'<cornerRoad s="{a}" t="{b}" dz="0" height="0"/>'
        for a, b in ((s - deep / 2, -width), (s + deep / 2, -width), (s + deep / 2, width), (s - deep / 2, width))
    )
    return (
        f'<object type="crosswalk" subtype="{name}" id="900" name="{name}" s="{s}" t="0" zOffset="0" '
        f'validLength="0" orientation="none" length="{deep}" width="{2 * width}" hdg="0" pitch="0" roll="0">'
        f"<outline>{corners}</outline></object>"
    )


def stop_line(s: float, t: float, number: int, width: float = 3.5, orientation: str = "-") -> str:
    return (
        f'<object type="stopLine" id="{number}" name="stopLine" s="{s}" t="{t}" zOffset="0" validLength="0" '
        f'orientation="{orientation}" length="0.3" width="{width}" hdg="0" pitch="0" roll="0"/>'
    )


def sign(
    s: float,
    t: float,
    number: int,
    kind: str,
    orientation: str,
    *,
    country: str = "DE",
    lane: int | None = None,
    name: str = "",
) -> str:
    valid = f'<validity fromLane="{lane}" toLane="{lane}"/>' if lane is not None else ""
    dynamic = "yes" if kind == "1000001" else "no"
    return (
        f'<signal s="{s}" t="{t}" id="{number}" name="{name}" dynamic="{dynamic}" orientation="{orientation}" '
        f'zOffset="2" country="{country}" type="{kind}" subtype="-1" value="-1" height="0.9" width="0.9">'
        f"{valid}</signal>"
    )


RADIUS = 14.0
HEADINGS = {"e": 0.0, "n": math.pi / 2, "w": math.pi, "s": -math.pi / 2}
NUMBERS = {"e": 1, "n": 2, "w": 3, "s": 4}


def arms_meet(
    nation: str,
    arms: str = "wens",
    signs: dict[str, str] | None = None,
    *,
    limit: str = "50 km/h",
    kind: str = "town",
) -> Map:
    """A junction at the origin; each arm begins 14 m from it and leads outwards for 200 m.

    signs: by arm, "stop", "give_way" or "light" (signal id 70 + the arm's number).
    Stop lines 1 m before the junction, 15 m from the origin.
    """
    g = side(nation)
    come, go = -g, g  # lane ids on an arm: towards the junction, and away from it
    signs = signs or {}
    roads = [_arm(arm, nation, signs.get(arm, ""), limit, kind) for arm in arms]
    connections: list[str] = []
    number = 10
    for a in arms:
        for b in arms:
            if a == b:
                continue
            roads.append(_through(number, a, b, nation, limit, kind, come, go))
            connections.append(
                f'<connection id="{number}" incomingRoad="{NUMBERS[a]}" connectingRoad="{number}" '
                f'contactPoint="start"><laneLink from="{come}" to="{go}"/></connection>'
            )
            number += 1
    return Map(roads, f'<junction id="100" name="j">{"".join(connections)}</junction>\n')


def _arm(arm: str, nation: str, what: str, limit: str, kind: str) -> Road:
    """One arm, with its stop line and what stands there."""
    g = side(nation)
    h = HEADINGS[arm]
    extra = ""
    if what:
        code, country = {"stop": ("206", "DE"), "give_way": ("205", "DE"), "light": ("1000001", "OpenDRIVE")}[what]
        name = "traffic_light" if what == "light" else what
        shown = sign(1.5, -g * 4.0, 70 + NUMBERS[arm], code, "-", country=country, lane=-g, name=name)
        line = stop_line(1.0, -g * 1.75, 50 + NUMBERS[arm])
        extra = f"<objects>{line}</objects><signals>{shown}</signals>"
    row = [Lane("driving", 3.5, "solid")]
    return Road(
        NUMBERS[arm],
        Path(RADIUS * math.cos(h), RADIUS * math.sin(h), h, ((200.0, 0.0),)),
        list(row),
        list(row),
        rule_of(nation),
        kind,
        [(0.0, limit)],
        [(0.0, "broken")],
        extra,
        link='<predecessor elementType="junction" elementId="100"/>',
    )


def turn_path(a: str, b: str, before: float = 200.0, after: float = 200.0) -> Path:
    """From arm a, through the junction, into arm b, along the middle lines."""
    h = HEADINGS[a]
    far = RADIUS + before
    turn = (HEADINGS[b] - (h + math.pi) + math.pi) % (2 * math.pi) - math.pi
    if abs(turn) < 1e-6:
        middle: Segment = (2 * RADIUS, 0.0)
    else:
        middle = (RADIUS * math.pi / 2, math.copysign(1 / RADIUS, turn))
    return Path(far * math.cos(h), far * math.sin(h), h + math.pi, ((before, 0.0), middle, (after, 0.0)))


def _through(  # noqa: PLR0917
    number: int, a: str, b: str, nation: str, limit: str, kind: str, come: int, go: int
) -> Road:
    whole = turn_path(a, b, 0.0, 0.0)
    path = Path(whole.x, whole.y, whole.heading, (whole.segments[1],))
    lane = [Lane("driving", 3.5, "none")]
    left, right = (lane, []) if nation != "de" else ([], lane)
    link = (
        f'<predecessor elementType="road" elementId="{NUMBERS[a]}" contactPoint="start"/>'
        f'<successor elementType="road" elementId="{NUMBERS[b]}" contactPoint="start"/>'
    )
    return Road(
        number,
        path,
        left,
        right,
        rule_of(nation),
        kind,
        [(0.0, limit)],
        [(0.0, "none")],
        "",
        100,
        link,
        {go: f'<predecessor id="{come}"/><successor id="{go}"/>'},
    )
