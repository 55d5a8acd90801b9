"""Maps: roads drawn as OpenDRIVE, in a frame in which the ego drives along +x."""

import math
from dataclasses import dataclass, field

W = 3.5
"""Width of an ordinary lane, m."""
HALF = 12.0
"""Half of a junction, m."""


@dataclass(frozen=True)
class Place:
    """Where a map lies in the world: shifted by (x, y), turned by rot."""

    x: float = 0.0
    y: float = 0.0
    rot: float = 0.0

    def point(self, x: float, y: float) -> tuple[float, float]:
        c, s = math.cos(self.rot), math.sin(self.rot)
        return self.x + c * x - s * y, self.y + s * x + c * y


HOME = Place()


@dataclass
class Lane:
    """One lane, counted from the middle outwards."""

    kind: str = "driving"
    width: float = W
    mark: str = "broken"


@dataclass
class Road:
    """One road of one geometry; near lanes go along s, far ones against it."""

    id: int
    x: float
    y: float
    hdg: float
    length: float
    near: list[Lane]
    far: list[Lane] = field(default_factory=list)
    curv: float = 0.0
    middle: list[tuple[float, str]] = field(default_factory=lambda: [(0.0, "broken")])
    kind: str = "rural"
    speed: float | None = None
    junction: int = -1
    link: str = ""
    lane_link: tuple[int, int] | None = None
    objects: list[str] = field(default_factory=list)
    signals: list[str] = field(default_factory=list)
    late: tuple[float, float, list[Lane]] | None = None


@dataclass
class World:
    """A map: its side (+1 left-hand, -1 right-hand traffic), place, roads and junctions."""

    side: int
    place: Place
    roads: list[Road]
    junctions: list[str] = field(default_factory=list)

    def xml(self) -> str:
        body = "".join(road_xml(r, self.side, self.place) for r in self.roads)
        head = '<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE>\n<header revMajor="1" revMinor="6" name="fifteenth"/>\n'
        return head + body + "".join(self.junctions) + "</OpenDRIVE>\n"


def lane_xml(i: int, lane: Lane, link: tuple[int, int] | None) -> str:
    inner = ""
    if link:
        inner = f'<link><predecessor id="{link[0]}"/><successor id="{link[1]}"/></link>'
    return (
        f'<lane id="{i}" type="{lane.kind}" level="false">{inner}'
        f'<width sOffset="0" a="{lane.width}" b="0" c="0" d="0"/>'
        f'<roadMark sOffset="0" type="{lane.mark}" weight="standard" color="white" width="0.12"/></lane>\n'
    )


def section_xml(s: float, r: Road, side: int, near: list[Lane]) -> str:
    ns = [(side * (k + 1), lane) for k, lane in enumerate(near)]
    fs = [(-side * (k + 1), lane) for k, lane in enumerate(r.far)]
    both = sorted(ns + fs, key=lambda p: -p[0])
    left = "".join(lane_xml(i, lane, r.lane_link) for i, lane in both if i > 0)
    right = "".join(lane_xml(i, lane, r.lane_link) for i, lane in both if i < 0)
    marks = "".join(
        f'<roadMark sOffset="{max(0.0, m - s)}" type="{k}" weight="standard" color="white" width="0.12"/>'
        for m, k in r.middle
    )
    out = f'<laneSection s="{s}">\n'
    if left:
        out += f"<left>\n{left}</left>\n"
    out += f'<center><lane id="0" type="none" level="false">{marks}</lane></center>\n'
    if right:
        out += f"<right>\n{right}</right>\n"
    return out + "</laneSection>\n"


def road_xml(r: Road, side: int, place: Place) -> str:
    x, y = place.point(r.x, r.y)
    rule = "LHT" if side > 0 else "RHT"
    shape = f'<arc curvature="{r.curv}"/>' if r.curv else "<line/>"
    speed = f'<speed max="{r.speed}" unit="m/s"/>' if r.speed else ""
    sections = section_xml(0.0, r, side, r.near)
    if r.late:
        a, b, near = r.late
        sections += section_xml(a, r, side, near) + section_xml(b, r, side, r.near)
    return (
        f'<road name="" length="{r.length}" id="{r.id}" junction="{r.junction}" rule="{rule}">\n'
        f'<link>{r.link}</link>\n<type s="0" type="{r.kind}">{speed}</type>\n'
        f'<planView><geometry s="0" x="{x!r}" y="{y!r}" hdg="{r.hdg + place.rot!r}" length="{r.length!r}">{shape}'
        f"</geometry></planView>\n<lanes>\n{sections}</lanes>\n"
        f"<objects>{''.join(r.objects)}</objects>\n<signals>{''.join(r.signals)}</signals>\n</road>\n"
    )


def crosswalk(i: int, s: float, half: float, name: str = "zebra", deep: float = 3.0) -> str:
    """Return a crossing over the whole road, from s - deep/2 to s + deep/2."""
    pts = [(-deep / 2, -half), (deep / 2, -half), (deep / 2, half), (-deep / 2, half)]
    corners = "".join(f'<cornerLocal u="{u}" v="{v}" z="0" height="0"/>' for u, v in pts)
    return (
        f'<object id="{i}" name="{name}" type="crosswalk" s="{s}" t="0" zOffset="0" hdg="0" orientation="none" '
        f'length="{deep}" width="{2 * half}"><outline>{corners}</outline></object>\n'
    )


def stop_line(i: int, s: float, side: int, width: float = W) -> str:
    """Return a stop line over the lane nearest to the middle, as an object."""
    return (
        f'<object id="{i}" name="stopLine" type="stopLine" s="{s}" t="{side * width / 2}" zOffset="0" hdg="0" '
        f'orientation="+" length="0.3" width="{width}"/>\n'
    )


def sign(i: int, s: float, side: int, kind: str, country: str = "DE", *, lanes: int = 1) -> str:
    """Return a sign (or a light, OpenDRIVE 1000001) for the near lanes 1 to lanes."""
    dyn = "yes" if country == "OpenDRIVE" else "no"
    a, b = sorted((side, side * lanes))
    return (
        f'<signal id="{i}" name="" s="{s}" t="{side * (W * lanes + 1)}" dynamic="{dyn}" orientation="+" zOffset="2" '
        f'country="{country}" type="{kind}" subtype="-1" value="-1" width="0.6" height="0.6">'
        f'<validity fromLane="{a}" toLane="{b}"/></signal>\n'
    )


def straight(
    side: int,
    length: float = 800.0,
    speed: float | None = 26.82,
    kind: str = "rural",
    *,
    middle: list[tuple[float, str]] | None = None,
    lanes: int = 1,
    walk: bool = False,
    place: Place = HOME,
    curv: float = 0.0,
) -> World:
    """Return one road with lanes each way, from x = -100 on."""
    edge = [Lane("sidewalk", 2.0, "none")] if walk else []
    near = [Lane(mark="solid" if k == lanes - 1 else "broken") for k in range(lanes)] + edge
    far = [Lane(mark="solid" if k == lanes - 1 else "broken") for k in range(lanes)] + edge
    road = Road(1, -100.0, 0.0, 0.0, length, near, far, curv, middle or [(0.0, "broken")], kind, speed)
    return World(side, place, [road])


def motorway(
    side: int, lanes: int = 3, length: float = 1800.0, speed: float | None = None, place: Place = HOME
) -> World:
    """Return one carriageway with a hard shoulder; lane 1 is nearest to the middle."""
    near = [Lane(mark="solid" if k == lanes - 1 else "broken") for k in range(lanes)] + [Lane("shoulder", 3.0, "none")]
    road = Road(1, -100.0, 0.0, 0.0, length, near, [], 0.0, [(0.0, "solid")], "motorway", speed)
    return World(side, place, [road])


ARMS = {"W": math.pi, "E": 0.0, "N": math.pi / 2, "S": -math.pi / 2}
"""Directions in which the arms of a junction go out."""


def junction(
    side: int,
    *,
    speed: float = 13.41,
    place: Place = HOME,
    extra: dict[str, tuple[list[str], list[str]]] | None = None,
) -> World:
    """Return a junction at the origin; every arm's s runs towards it and ends half a junction before the middle."""
    arms, half, reach = "WENS", HALF, 200.0
    roads, conns = [], []
    for n, a in enumerate(arms):
        d = ARMS[a]
        x, y = (half + reach) * math.cos(d), (half + reach) * math.sin(d)
        r = Road(n + 1, x, y, d + math.pi, reach, [Lane(mark="solid")], [Lane(mark="solid")], kind="town", speed=speed)
        r.link = '<successor elementType="junction" elementId="100"/>'
        if extra and a in extra:
            r.objects, r.signals = extra[a]
        roads.append(r)
    i = 200
    for n, a in enumerate(arms):
        for m, b in enumerate(arms):
            if a != b:
                roads.append(connecting(i, side, (n + 1, ARMS[a]), (m + 1, ARMS[b]), speed))
                conns.append(
                    f'<connection id="{i}" incomingRoad="{n + 1}" connectingRoad="{i}" contactPoint="start">'
                    f'<laneLink from="{side}" to="{side}"/></connection>'
                )
                i += 1
    return World(side, place, roads, [f'<junction id="100" name="">{"".join(conns)}</junction>\n'])


def connecting(i: int, side: int, a: tuple[int, float], b: tuple[int, float], speed: float) -> Road:
    """Return the way from one arm to another: an arc of a quarter, or a line."""
    half, h = HALF, a[1] + math.pi
    turn = math.remainder(b[1] - h, 2 * math.pi)
    length, curv = (2 * half, 0.0) if abs(turn) < 0.1 else (half * math.pi / 2, math.copysign(1 / half, turn))
    r = Road(i, half * math.cos(a[1]), half * math.sin(a[1]), h, length, [Lane(mark="none")], curv=curv)
    r.middle, r.kind, r.speed, r.junction, r.lane_link = [(0.0, "none")], "town", speed, 100, (side, -side)
    r.link = (
        f'<predecessor elementType="road" elementId="{a[0]}" contactPoint="end"/>'
        f'<successor elementType="road" elementId="{b[0]}" contactPoint="end"/>'
    )
    return r
