"""Crossroads and roundabouts."""

from __future__ import annotations

import math

from tests.outsiders.third.maps import PAVEMENT
from tests.outsiders.third.movement import MPH
from tests.outsiders.third.road import Area, Lane, Link, Map, Road, Section, Sign
from tests.outsiders.third.ways import Way

ARM = 250.0
EDGE = 10.0  # a crossroads reaches so far from its middle
COMPASS = {"W": 0.0, "S": math.pi / 2, "E": math.pi, "N": -math.pi / 2}  # heading of those who come from there
NUMBER = {arm: i for i, arm in enumerate("WNES", 1)}  # of the arms' roads


def turns(mode: str) -> dict[str, tuple[list[tuple[float, float]], float]]:
    """The three ways on from an arm, by where they lead: near side, ahead, far side; and the junction's edge."""
    if mode == "crossroads":
        quarter = EDGE * math.pi / 2
        return {
            "near": ([(quarter, 1 / EDGE)], EDGE),
            "ahead": ([(2 * EDGE, 0)], EDGE),
            "far": ([(quarter, -1 / EDGE)], EDGE),
        }
    ring, bend = 14.0, 12.0
    out = math.sqrt((ring + bend) ** 2 - bend**2)
    lean = math.asin(bend / (ring + bend))
    into = (bend * (math.pi / 2 - lean), 1 / bend)
    return {
        name: ([into, (ring * (sweep - 2 * lean), -1 / ring), into], out)
        for name, sweep in (("near", math.pi / 2), ("ahead", math.pi), ("far", 1.5 * math.pi))
    }


def _goes_to(arm: str, turn: str) -> str:
    order = "WNES"  # clockwise: the arm to the near side (left) of one who comes from W is N
    return order[(order.index(arm) + {"near": 1, "ahead": 2, "far": 3}[turn]) % 4]


def through(arm: str, turn: str, mode: str = "crossroads") -> Way:
    """The way from an arm through the junction; s = 0 where the junction begins."""
    parts, edge = turns(mode)[turn]
    heading = COMPASS[arm]
    far = ARM + edge
    x, y = -far * math.cos(heading), -far * math.sin(heading)
    return Way(x, y, heading, [(ARM, 0), *parts, (ARM, 0)], ARM)


def wrong_way_round() -> Way:
    """The way from the west into a roundabout and round it against its traffic."""
    parts, edge = turns("roundabout")["near"]
    return Way(-(ARM + edge), 0, 0, [(ARM, 0), *[(part, -bend) for part, bend in parts], (ARM, 0)], ARM)


def junction(
    mode: str = "crossroads",
    *,
    lights: str = "",
    stop: str = "",
    limit: float | None = 30 * MPH,
    country: str = "gb",
) -> Map:
    """A junction in the middle of the map, with lights or stop signs on the arms named."""
    lanes = (Lane("driving"), *PAVEMENT)
    roads, links = [], []
    for arm in "WNES":
        edge = turns(mode)["ahead"][1]
        heading = COMPASS[arm]
        way = Way(-(ARM + edge) * math.cos(heading), -(ARM + edge) * math.sin(heading), heading, [(ARM, 0)])
        things: list[Sign | Area] = []
        if arm in lights + stop:
            things.append(Area(f"line_{arm}", "stopLine", "stopLine", ARM - 1.3, ARM - 1.0, 0.1, 3.4))
        if arm in lights:
            things.append(Sign(f"light_{arm}", "traffic_light", ARM - 1, 4.0, "OpenDRIVE", "1000001"))
        if arm in stop:
            things.append(Sign(f"stop_{arm}", "stop", ARM - 1.2, 4.0, country, "601.1" if country == "gb" else "206"))
        join = (("successor", "junction", 9, ""),)
        section = Section(0, lanes, lanes)
        roads.append(Road(NUMBER[arm], way, (section,), "town", limit, joins=join, things=tuple(things)))
    for arm in "WNES":
        for turn, (parts, edge) in turns(mode).items():
            to = NUMBER[_goes_to(arm, turn)]
            heading = COMPASS[arm]
            me = 100 + 10 * NUMBER[arm] + to
            way = Way(-edge * math.cos(heading), -edge * math.sin(heading), heading, parts)
            joins = (("predecessor", "road", NUMBER[arm], "end"), ("successor", "road", to, "end"))
            one = (Section(0, (Lane("driving", 3.5, "none"),), (), ((0, "none"),)),)
            roads.append(Road(me, way, one, "town", limit, 9, joins, ((1, "predecessor", 1), (1, "successor", -1))))
            links.append(Link(9, NUMBER[arm], me, ((1, 1),)))
    return Map(tuple(roads), tuple(links))
