"""The roads on which the drives go."""

from __future__ import annotations

import math
from dataclasses import replace

from tests.outsiders.first.road import Lane, Map, Road, crosswalk, joining, sign


def rural(
    side: int,
    centre: list[tuple[float, str]] | None = None,
    signs: list[str] | None = None,
    bend: float = 0.0,
    length: float = 2000.0,
) -> Map:
    shape = [(200.0, 0.0), (length - 200.0, bend)] if bend else [(length, 0.0)]
    limit = (60.0, "mph") if side > 0 else (100.0, "km/h")
    verge = [Lane(3.5), Lane(1.5, "shoulder", "none")]
    road = Road(1, side, (0.0, 0.0, 0.0), shape, verge, list(verge), centre or [(0.0, "broken")], "rural", limit)
    road.signals = signs or []
    return Map({"main": road})


def urban(side: int, beside: Lane | None = None, crossing: str = "") -> Map:
    """A street with footways, and if asked for parking or cycle lanes, a zebra, or a crossing with lights, at s = 200."""
    lanes = [Lane(3.5), *([beside] if beside else []), Lane(2.0, "sidewalk", "none")]
    limit = (30.0, "mph") if side > 0 else (50.0, "km/h")
    road = Road(1, side, (0.0, 0.0, 0.0), [(400.0, 0.0)], lanes, list(lanes), kind="town", limit=limit)
    if crossing:
        road.objects = [
            crosswalk(50, 200.0, 3.5 + (beside.width if beside else 0.0), "zebra" if crossing == "zebra" else "")
        ]
    if crossing == "lights":
        for number, s, facing, lane in ((60, 195.0, "+", side), (70, 205.0, "-", -side)):
            road.signals.append(sign(number, s, lane * 4.0, facing, "1000001", "OpenDRIVE", lane, "yes"))
            road.signals.append(sign(number + 1, s, lane * 1.75, facing, "294", "OpenDRIVE", lane))
    return Map({"main": road})


def motorway(side: int, limit: tuple[float, str] | None, lanes: int = 3, entry: bool = False) -> Map:
    inner = [Lane(3.65, "driving", "broken")] * (lanes - 1) + [Lane(3.65)]
    outer = [Lane(3.65, "entry")] if entry else []
    road = Road(1, side, (0.0, 0.0, 0.0), [(2500.0, 0.0)], [*inner, *outer, Lane(3.3, "shoulder", "none")])
    road.centre, road.kind, road.limit = [(0.0, "solid")], "motorway", limit
    return Map({"main": road})


ANGLE = {"E": 0.0, "N": math.pi / 2, "W": math.pi, "S": -math.pi / 2}


def arms(side: int, reach: float, kind: str, limit: tuple[float, str]) -> dict[str, Road]:
    """Four roads that leave a junction; their s grows outwards."""
    verge = [Lane(3.5), Lane(1.5, "sidewalk", "none")]
    roads = {}
    for i, (name, h) in enumerate(ANGLE.items()):
        roads[name] = Road(
            i + 1, side, (reach * math.cos(h), reach * math.sin(h), h), [(250.0, 0.0)], verge, list(verge)
        )
        roads[name].kind, roads[name].limit = kind, limit
    return roads


def connector(  # noqa: PLR0917
    rid: int,
    side: int,
    junction: int,
    came: tuple[Road, str, int],
    goes: tuple[Road, str, int],
    pose: list[tuple[float, float, float]],
) -> Road:
    road = Road(
        rid, side, pose[0], joining(*pose), [Lane(3.5, "driving", "none")], [], [(0.0, "none")], "town", came[0].limit
    )
    road.junction = junction
    road.link = (
        f'<predecessor elementType="road" elementId="{came[0].rid}" contactPoint="{came[1]}"/>'
        f'<successor elementType="road" elementId="{goes[0].rid}" contactPoint="{goes[1]}"/>'
    )
    road.lane_link = f'<predecessor id="{came[2]}"/><successor id="{goes[2]}"/>'
    return road


def connection(number: int, came: tuple[Road, str, int], road: Road) -> str:
    return (
        f'<connection id="{number}" incomingRoad="{came[0].rid}" connectingRoad="{road.rid}" contactPoint="start">'
        f'<laneLink from="{came[2]}" to="{road.side}"/></connection>'
    )


def crossroads(side: int, control: str) -> Map:
    """Four arms; `control` is lights on all of them, or stop or give-way signs on those from north and south ('' for none)."""
    limit = (30.0, "mph") if side > 0 else (50.0, "km/h")
    roads = arms(side, 12.0, "town", limit)
    for i, name in enumerate(ANGLE):
        arm, number = roads[name], 100 + 10 * i
        arm.link = '<predecessor elementType="junction" elementId="900"/>'
        t = -side * 1.75
        if control == "lights":
            arm.signals.append(sign(number, 1.0, -side * 4.0, "-", "1000001", "OpenDRIVE", -side, "yes"))
        elif control and name in "NS":
            arm.signals.append(sign(number, 1.0, -side * 4.0, "-", "206" if control == "stop" else "205", "DE", -side))
        if control == "lights" or (control == "stop" and name in "NS"):
            arm.signals.append(sign(number + 1, 1.0, t, "-", "294", "DE", -side))
    links, rid = [], 20
    for a in ANGLE:
        for b in ANGLE:
            if a == b:
                continue
            came, goes = (roads[a], "start", -side), (roads[b], "start", side)
            x, y, h = roads[a].start
            road = connector(rid, side, 900, came, goes, [(x, y, h + math.pi), roads[b].start])
            roads[a + b] = road
            links.append(connection(rid, came, road))
            rid += 1
    return Map(roads, f'<junction id="900" name="">{"".join(links)}</junction>')


def roundabout() -> Map:
    """A British roundabout of one lane, driven clockwise, with four arms."""
    roads = arms(1, 40.0, "town", (30.0, "mph"))
    cut, inner, text, rid = math.radians(25), 18.0, "", 20

    def ring(angle: float) -> tuple[float, float, float]:
        return inner * math.cos(angle), inner * math.sin(angle), angle - math.pi / 2

    order = "SWNE"
    for i, name in enumerate(order):
        road = Road(
            10 + i, 1, ring(ANGLE[name] - cut), [(inner * (math.pi / 2 - 2 * cut), -1 / inner)], [Lane(3.5)], []
        )
        road.centre, road.kind, road.limit = [(0.0, "solid")], "town", (30.0, "mph")
        roads["ring" + name] = road
    for i, name in enumerate(order):
        arm, away, here = roads[name], roads["ring" + name], roads["ring" + order[i - 1]]
        arm.link = f'<predecessor elementType="junction" elementId="{900 + i}"/>'
        after = 900 + (i + 1) % 4
        away.link = f'<predecessor elementType="junction" elementId="{900 + i}"/><successor elementType="junction" elementId="{after}"/>'
        x, y, h = arm.start
        links = ""
        for kind, came, goes, pose in (
            ("in", (arm, "start", -1), (away, "start", 1), [(x, y, h + math.pi), ring(ANGLE[name] - cut)]),
            ("out", (here, "end", 1), (arm, "start", 1), [ring(ANGLE[name] + cut), arm.start]),
            ("by", (here, "end", 1), (away, "start", 1), []),
        ):
            road = connector(rid, 1, 900 + i, came, goes, pose or [ring(ANGLE[name] + cut), ring(ANGLE[name] - cut)])
            if not pose:
                road.shape = [(inner * 2 * cut, -1 / inner)]
            roads[kind + name] = road
            links += connection(rid, came, road)
            rid += 1
        text += f'<junction id="{900 + i}" name="">{links}</junction>'
    return Map(roads, text)


def bridge() -> Map:
    """A country road under a bridge that carries another one, seven metres up, at s = 500."""
    below = rural(1, length=1000.0).roads["main"]
    above = replace(below, rid=2, start=(500.0, -500.0, math.pi / 2), height=7.0, shape=[(1000.0, 0.0)])
    return Map({"main": below, "above": above})


RURAL = rural(1)
