"""A small writer of OpenDRIVE maps."""

from __future__ import annotations

from dataclasses import dataclass, field

from tests.outsiders.fourteenth.lines import Course

MPH = 0.44704
KMH = 1 / 3.6


@dataclass(frozen=True)
class Lane:
    """A lane, and the mark on its outer side."""

    width: float = 3.5
    kind: str = "driving"
    mark: str = "broken"


@dataclass
class Road:
    """A road; `own` lanes are driven along the line, `other` against it."""

    key: int
    course: Course
    sections: list[tuple[float, list[Lane], list[Lane]]]
    kind: str = "rural"
    speed: str = "60 mph"
    country: str = "GB"
    centre: list[tuple[float, str]] = field(default_factory=lambda: [(0.0, "broken")])
    signals: list[str] = field(default_factory=list)
    objects: list[str] = field(default_factory=list)
    junction: int = -1
    links: str = ""
    lane_links: dict[int, str] = field(default_factory=dict)

    def sign(
        self,
        key: str,
        s: float,
        kind: str,
        *,
        country: str = "DE",
        name: str = "",
        against: bool = False,
        dynamic: bool = False,
        width: float = 0.6,
        t: float | None = None,
        lanes: tuple[int, int] | None = None,
    ) -> None:
        """Put up a signal for those who drive along the line, or against it."""
        k = self.course.near * (-1 if against else 1)
        low, high = (k, k) if lanes is None else (min(k * n for n in lanes), max(k * n for n in lanes))
        self.signals.append(
            f'<signal s="{s:.3f}" t="{k * 5.0 if t is None else k * t:.3f}" id="{key}" name="{name}" '
            f'dynamic="{"yes" if dynamic else "no"}" orientation="{"-" if against else "+"}" '
            f'zOffset="2.0" country="{country}" type="{kind}" subtype="-1" value="-1" '
            f'height="0.8" width="{width}"><validity fromLane="{low}" toLane="{high}"/></signal>'
        )

    def line(self, key: str, s: float, *, against: bool = False, width: float = 3.5) -> None:
        """Paint a stop line across the first lane."""
        k = self.course.near * (-1 if against else 1)
        self.objects.append(
            f'<object type="stopLine" id="{key}" name="stopline" s="{s:.3f}" t="{k * width / 2:.3f}" '
            f'zOffset="0" hdg="0" pitch="0" roll="0" length="0.3" width="{width}" height="0.01" '
            f'orientation="{"-" if against else "+"}"/>'
        )

    def crossing(self, key: str, s: float, name: str, *, half: float = 3.5, deep: float = 3.0) -> None:
        """Paint a crossing across the road."""
        d = deep / 2
        corners = [(-d, -half), (d, -half), (d, half), (-d, half)]
        outline = "".join(f'<cornerLocal u="{u:.3f}" v="{v:.3f}" z="0" height="0"/>' for u, v in corners)
        self.objects.append(
            f'<object type="crosswalk" id="{key}" name="{name}" s="{s:.3f}" t="0" zOffset="0" '
            f'hdg="0" pitch="0" roll="0" length="{deep}" width="{2 * half}" height="0.01" '
            f'orientation="none"><outline>{outline}</outline></object>'
        )


def lane_xml(key: int, lane: Lane, link: str) -> str:
    return (
        f'<lane id="{key}" type="{lane.kind}" level="false"><link>{link}</link>'
        f'<width sOffset="0" a="{lane.width}" b="0" c="0" d="0"/>'
        f'<roadMark sOffset="0" type="{lane.mark}" weight="standard" color="standard" width="0.12" '
        f'laneChange="{"none" if lane.mark == "solid" else "both"}"/></lane>'
    )


def link_of(road: Road, key: int, i: int) -> str:
    """Link a lane to the one of the same number in the sections before and after."""
    out = road.lane_links.get(key, "")
    k = road.course.near

    def has(j: int) -> bool:
        if not 0 <= j < len(road.sections):
            return False
        _, own, other = road.sections[j]
        return abs(key) <= len(own if key * k > 0 else other)

    if has(i - 1):
        out = f'<predecessor id="{key}"/>' + out
    if has(i + 1):
        out += f'<successor id="{key}"/>'
    return out


def section_xml(road: Road, i: int) -> str:
    s, own, other = road.sections[i]
    k = road.course.near
    lanes = {k * (n + 1): lane for n, lane in enumerate(own)}
    lanes |= {-k * (n + 1): lane for n, lane in enumerate(other)}
    end = road.sections[i + 1][0] if i + 1 < len(road.sections) else road.course.length

    def part(name: str, keys: list[int]) -> str:
        if not keys:
            return ""
        rows = "".join(lane_xml(key, lanes[key], link_of(road, key, i)) for key in keys)
        return f"<{name}>{rows}</{name}>"

    marks = [(0.0, m) for a, m in road.centre if a <= s][-1:]
    marks += [(a - s, m) for a, m in road.centre if s < a < end]
    centre = "".join(
        f'<roadMark sOffset="{a:.3f}" type="{m}" weight="standard" color="standard" width="0.12"/>' for a, m in marks
    )
    left = part("left", sorted((key for key in lanes if key > 0), reverse=True))
    right = part("right", sorted((key for key in lanes if key < 0), reverse=True))
    return (
        f'<laneSection s="{s:.3f}">{left}<center><lane id="0" type="none" level="false">{centre}'
        f"</lane></center>{right}</laneSection>"
    )


def road_xml(road: Road) -> str:
    plan = "".join(
        f'<geometry s="{s:.9f}" x="{x:.9f}" y="{y:.9f}" hdg="{h:.12f}" length="{n:.9f}">'
        + (f'<arc curvature="{b:.12f}"/>' if b else "<line/>")
        + "</geometry>"
        for s, x, y, h, n, b in road.course.starts()
    )
    limit, unit = road.speed.split()
    sections = "".join(section_xml(road, i) for i in range(len(road.sections)))
    rule = "LHT" if road.course.near > 0 else "RHT"
    return (
        f'<road name="r{road.key}" length="{road.course.length:.9f}" id="{road.key}" '
        f'junction="{road.junction}" rule="{rule}"><link>{road.links}</link>'
        f'<type s="0" type="{road.kind}" country="{road.country}">'
        f'<speed max="{limit}" unit="{unit}"/></type><planView>{plan}</planView>'
        '<elevationProfile/><lateralProfile/><lanes><laneOffset s="0" a="0" b="0" c="0" d="0"/>'
        f"{sections}</lanes><objects>{''.join(road.objects)}</objects>"
        f"<signals>{''.join(road.signals)}</signals></road>"
    )


def map_xml(roads: list[Road], junctions: str = "", minor: int = 6) -> str:
    body = "".join(road_xml(r) for r in roads)
    return (
        f'<?xml version="1.0" encoding="UTF-8"?><OpenDRIVE><header revMajor="1" revMinor="{minor}" '
        f'name="drawn" version="1.00"/>{body}{junctions}</OpenDRIVE>\n'
    )
