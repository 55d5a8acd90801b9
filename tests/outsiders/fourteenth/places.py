"""Places to drive: plain roads, motorways and junctions."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

from tests.outsiders.fourteenth.lines import Course
from tests.outsiders.fourteenth.maps import Lane, Road, map_xml

DEFAULT_SPEED = {"gb": "60 mph", "de": "100 km/h"}


@dataclass
class Place:
    """A map with the line along which it is driven."""

    roads: list[Road]
    course: Course
    nation: str
    junctions: str = ""

    @property
    def road(self) -> Road:
        return self.roads[0]

    def xml(self) -> str:
        return map_xml(self.roads, self.junctions)


def near_of(nation: str) -> int:
    return 1 if nation.startswith("gb") else -1


def country_of(nation: str) -> str:
    return "GB" if nation.startswith("gb") else "DE"


def street(
    nation: str,
    *,
    length: float = 900.0,
    bends: tuple[tuple[float, float], ...] | None = None,
    kind: str = "rural",
    speed: str | None = None,
    own: tuple[Lane, ...] = (Lane(mark="solid"),),
    other: tuple[Lane, ...] = (Lane(mark="solid"),),
    centre: tuple[tuple[float, str], ...] = ((0.0, "broken"),),
    at: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Place:
    """A road with lanes of both directions; bends are positive to the near side."""
    k = near_of(nation)
    parts = ((length, 0.0),) if bends is None else tuple((n, k * b) for n, b in bends)
    course = Course(at[0], at[1], at[2], parts, k)
    limit = speed or DEFAULT_SPEED["gb" if k > 0 else "de"]
    road = Road(1, course, [(0.0, list(own), list(other))], kind, limit, country_of(nation))
    road.centre = list(centre)
    return Place([road], course, nation)


FAST, MID, SLOW, SHOULDER = 1.8 + 1.5, 5.4 + 1.5, 9.0 + 1.5, 12.1 + 1.5


def motorway(
    nation: str,
    *,
    length: float = 2500.0,
    bends: tuple[tuple[float, float], ...] | None = None,
    speed: str | None = None,
    lanes: int = 3,
    exit_at: tuple[float, float] | None = None,
    exit_kind: str = "exit",
    at: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Place:
    """Both directions of a motorway round a central reserve of 3 m, with hard shoulders.

    Lane centres: 3.3, 6.9 and 10.5 m from the line, the hard shoulder's 13.6 m. Between the two
    places of `exit_at` a further lane lies where the hard shoulder was.
    """
    limit = speed or ("70 mph" if nation.startswith("gb") else "130 km/h")
    through = [Lane(1.5, "median", "solid")]
    through += [Lane(3.6) for _ in range(lanes - 1)] + [Lane(3.6, mark="solid")]
    plain = [*through, Lane(2.6, "shoulder", "none")]
    sections = [(0.0, plain, plain)]
    if exit_at is not None:
        wide = [*through[:-1], Lane(3.6), Lane(3.6, exit_kind, "solid")]
        sections.append((exit_at[0], wide, plain))
        if exit_at[1] < length:
            sections.append((exit_at[1], plain, plain))
    place = street(nation, length=length, bends=bends, kind="motorway", speed=limit, at=at)
    place.road.sections = sections
    place.road.centre = [(0.0, "solid")]
    return place


TURN = {"S": pi / 2, "W": 0.0, "N": -pi / 2, "E": pi}


@dataclass
class Cross(Place):
    """Arms of `reach` metres that meet in a junction of half width `r`."""

    reach: float = 120.0
    r: float = 12.0
    arms: str = "SENW"

    def way(self, a: str, b: str) -> Course:
        """The line from outside on arm `a` through the junction and out on arm `b`."""
        first = self.arm(a).course
        turn = (TURN[b] + pi) - TURN[a]
        turn = (turn + pi) % (2 * pi) - pi
        middle = (2 * self.r, 0.0) if abs(turn) < 0.1 else (self.r * pi / 2, turn / (self.r * pi / 2))
        return Course(first.x, first.y, first.h, ((self.reach, 0.0), middle, (self.reach, 0.0)), first.near)

    def arm(self, a: str) -> Road:
        return next(r for r in self.roads if r.key == 10 + "SENW".index(a))


def crossroads(
    nation: str,
    *,
    arms: str = "SENW",
    kind: str = "town",
    speed: str | None = None,
    reach: float = 120.0,
    r: float = 12.0,
    sidewalk: bool = False,
    at: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Cross:
    """A crossroads, or a T where an arm is left out."""
    k = near_of(nation)
    limit = speed or ("30 mph" if k > 0 else "50 km/h")
    lanes = [Lane(mark="solid")] + ([Lane(2.0, "sidewalk", "none")] if sidewalk else [])
    place = Cross([], Course(0, 0, 0, ((1.0, 0.0),), k), nation, reach=reach, r=r, arms=arms)
    far = reach + r
    for a in arms:
        h = TURN[a]
        x, y = -far * cos(h), -far * sin(h)
        turned = at[2]
        course = Course(
            at[0] + x * cos(turned) - y * sin(turned),
            at[1] + x * sin(turned) + y * cos(turned),
            h + turned,
            ((reach, 0.0),),
            k,
        )
        road = Road(10 + "SENW".index(a), course, [(0.0, lanes, lanes)], kind, limit)
        road.country = country_of(nation)
        road.links = '<successor elementType="junction" elementId="1"/>'
        place.roads.append(road)
    connect(place, kind, limit)
    place.course = place.way(arms[0], next(b for b in "NEW" if b in arms and b != arms[0]))
    return place


def connect(place: Cross, kind: str, limit: str) -> None:
    """Lay the ways through the junction."""
    rows = []
    k = place.road.course.near
    number = 100
    for a in place.arms:
        for b in place.arms:
            if a == b:
                continue
            whole = place.way(a, b)
            _, x, y, h, n, bend = whole.starts()[1]
            course = Course(x, y, h, ((n, bend),), k)
            road = Road(number, course, [(0.0, [Lane(mark="none")], [])], kind, limit)
            road.country = country_of(place.nation)
            road.centre = [(0.0, "none")]
            road.junction = 1
            into, out = place.arm(a).key, place.arm(b).key
            road.links = (
                f'<predecessor elementType="road" elementId="{into}" contactPoint="end"/>'
                f'<successor elementType="road" elementId="{out}" contactPoint="end"/>'
            )
            road.lane_links = {k: f'<predecessor id="{k}"/><successor id="{-k}"/>'}
            place.roads.append(road)
            rows.append(
                f'<connection id="{number - 100}" incomingRoad="{into}" connectingRoad="{number}" '
                f'contactPoint="start"><laneLink from="{k}" to="{k}"/></connection>'
            )
            number += 1
    place.junctions = f'<junction id="1" name="j1">{"".join(rows)}</junction>'


OWN, OPP = 1.75, -1.75  # two lanes: the own one, and the opposing one
EDGE, LINE = 120.0, 117.0  # along an arm of a crossroads: its end, and the stop line
ON = {"engaged": "yes"}
OVER = {"vehicle_class": "goods_over_7t5"}


def lit(nation: str) -> Cross:
    """A crossroads with a light for those from the south."""
    place = crossroads(nation, at=(60.0, -20.0, 0.35))
    place.arm("S").sign("tl", LINE + 1.0, "1000001", country="OpenDRIVE", dynamic=True)
    place.arm("S").line("sl", LINE, width=3.4)
    return place


def stop_arm(nation: str) -> Cross:
    """A crossroads with a stop sign for those from the south."""
    place = crossroads(nation, at=(-7.0, 70.0, -1.1))
    place.arm("S").sign("st", LINE + 0.5, "206")
    if nation == "de":
        place.arm("S").sign("sl", LINE, "294", width=3.4, t=1.75)
    else:
        place.arm("S").line("sl", LINE, width=3.4)
    return place


def crossing_street(name: str, *, light: bool = False) -> Place:
    """A street with a crossing at 220 m, with lights and a stop line or without."""
    place = street("gb", kind="town", speed="30 mph", at=(8.0, 8.0, -0.2))
    place.road.crossing("zc", 220.0, name)
    if light:
        place.road.sign("pl", 217.0, "1000001", country="OpenDRIVE", dynamic=True)
        place.road.sign("pl2", 223.0, "1000001", country="OpenDRIVE", dynamic=True, against=True)
        place.road.line("ps", 215.5, width=3.4)
    return place
