"""Roads with markings and several lanes each way, and ways across them."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.opendrive import xodr
from tests.scenes import LANE, Actor, Road, derived, drive, limited, linked, plan

if TYPE_CHECKING:
    import duckdb
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def mark(kind: str) -> str:
    return f'<roadMark sOffset="0" type="{kind}" weight="standard" color="white" width="0.12" laneChange="both"/>'


@cache
def marked(hand: str, centre: str = "solid", lanes: int = 1, beyond: str | None = None, length: float = 600.0) -> Road:
    """Return a road of `lanes` lanes each way, its centre line marked so, its lane lines broken, its edges solid.

    `beyond`: a lane of that type beside both edges.
    """

    def lane(number: int) -> str:
        edge = abs(number) == lanes
        kind = "solid" if edge else "broken"
        return linked(number).replace("</lane>", mark(kind) + "</lane>")

    numbers = [*range(lanes, 0, -1), *(-n for n in range(1, lanes + 1))]
    shoulders = [linked(n, kind=beyond) for n in (lanes + 1, -lanes - 1)] if beyond else []
    section = xodr.section(0, *shoulders[:1], *(lane(n) for n in numbers), *shoulders[1:], centre=mark(centre))
    # the centre lane's id is 0: its marking is that between the directions
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((length, 0.0),)),
            lanes=section,
            length=length,
            attributes=f'rule="{hand.upper()}"',
            more=limited(60),
        )
    )
    return Road(load_map(MapSource(f"marked-{hand}-{centre}-{lanes}-{beyond}.xodr", text.encode())), ((length, 0.0),))


def ease(u: Floats) -> Floats:
    held: Floats = np.clip(u, 0.0, 1.0)
    return held * held * (3 - 2 * held)


def offsets(way: Road, t: Floats, begin: float, lasts: float = 4.0, *, to: float = 0.5, start: float = 1.5) -> Floats:
    """Return offsets of one that goes from the lane `start` (0.5: next to the centre line) to the lane `to`."""
    sign = 1 if way.ego_d > 0 else -1
    return sign * LANE * (start + (to - start) * ease((t - begin) / lasts))


LANES = ("lane_change", "line_step", "lane_crossing")


def tables(
    way: Road, *actors: Actor, egos: tuple[str, ...] = ("ego",), of: tuple[str, ...] = LANES
) -> duckdb.DuckDBPyConnection:
    """Return a database with these tables about lanes, and where the ego's lanes are."""
    return derived(drive(actors, way.environment, egos=egos), tables=[*of, "ego_corridor", "ego_state"])


@cache
def apart(hand: str, gap: float = 0.0, centre: str = "solid", kind: str = "rural", since: float = 0.0) -> Road:
    """Return a road whose two directions are roads of their own, as city maps often have them, `gap` metres apart.

    `since`: the one that comes the other way ends (begins, as it is driven) only there.
    """
    side = 1 if hand == "lht" else -1

    def numbered_road(number: str, pose: tuple[float, float, float], length: float) -> str:
        lane = linked(side).replace("</lane>", mark("solid") + "</lane>")
        text = limited(60).replace("rural", kind)
        section = xodr.section(0, lane, centre=mark(centre))
        rule = f'rule="{hand.upper()}"'
        return xodr.road(number, plan(((length, 0.0),), pose), section, length, attributes=rule, more=text)

    roads = [numbered_road("1", (0.0, 0.0, 0.0), 600.0)]
    if gap < 50.0:
        roads.append(numbered_road("2", (600.0, -side * gap, math.pi), 600.0 - since))
    text = xodr.xodr(*roads)
    name = f"apart-{hand}-{gap}-{centre}-{kind}-{since}.xodr"
    return Road(load_map(MapSource(name, text.encode()), handedness=hand), ((600.0, 0.0),))


@cache
def shouldered(hand: str, lanes: int = 1, length: float = 600.0, cuts: tuple[float, ...] = ()) -> Road:
    """Return one carriageway of a motorway: `lanes` lanes and a hard shoulder, in sections that begin at `cuts`."""
    side = 1 if hand == "lht" else -1
    numbers = [side * n for n in range(1, lanes + 2)]
    parts = [linked(n, kind="shoulder" if abs(n) > lanes else "driving") for n in sorted(numbers, reverse=True)]
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((length, 0.0),)),
            lanes="".join(xodr.section(s, *parts) for s in (0, *cuts)),
            length=length,
            attributes=f'rule="{hand.upper()}"',
            more=limited(70).replace("rural", "motorway"),
        )
    )
    name = f"shouldered-{hand}-{lanes}-{length}-{cuts}.xodr"
    return Road(load_map(MapSource(name, text.encode()), handedness=hand), ((length, 0.0),))
