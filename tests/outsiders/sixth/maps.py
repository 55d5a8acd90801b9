"""Streets, country roads and motorways."""

from __future__ import annotations

from functools import partial

from tests.outsiders.sixth.lines import chain
from tests.outsiders.sixth.road import Lane, Map, Road

WALK = Lane("sidewalk", 2.0, "none")
OWN, OPP = 1.75, -1.75  # middle of the own lane, and of the opposing one
MEDIAN, WIDE, HARD = 1.5, 3.6, 3.0  # strips of a motorway

Pieces = tuple[tuple[float, float], ...]


def side(nation: str) -> int:
    """1 where the left is driven on, else -1."""
    return 1 if nation.startswith("gb") else -1


def unit(nation: str) -> str:
    return "mph" if nation.startswith("gb") else "km/h"


def street(  # noqa: PLR0917
    nation: str,
    length: float = 600,
    kind: str = "rural",
    speed: float | None = 60,
    width: float = 3.5,
    own: int = 1,
    centre: str = "broken",
    walk: bool = False,
    bend: Pieces = (),
    marks: tuple[tuple[float, str], ...] = (),
) -> Map:
    """One road with as many lanes one way as the other."""
    lanes = [Lane("driving", width, "broken" if i < own - 1 else "solid") for i in range(own)] + (
        [WALK] if walk else []
    )
    geoms = chain((0, 0, 0), *(bend or ((length, 0.0),)))
    hand = side(nation)
    return Map([Road("1", geoms, lanes, list(lanes), hand, kind, speed, unit(nation), centre, marks=list(marks))])


def motorway(  # noqa: PLR0917
    nation: str,
    length: float = 1500,
    lanes: int = 3,
    speed: float | None = 70,
    shoulder: bool = True,
    slip: tuple[float, float, str] | None = None,
    bend: Pieces = (),
    kind: str = "motorway",
) -> Map:
    """Two carriageways with a median; `slip`: a lane of that kind from s to s beside the own one."""
    median = [Lane("median", MEDIAN, "solid")]
    main = [Lane("driving", WIDE, "broken" if i < lanes - 1 else "solid") for i in range(lanes)]
    hard = [Lane("shoulder", HARD, "solid")] if shoulder else []
    whole = median + main + hard
    more: list[tuple[float, list[Lane]]] = []
    if slip:
        beside_it = [*main[:-1], Lane("driving", WIDE, "broken"), Lane(slip[2], WIDE, "solid")]
        more = [(slip[0], median + beside_it + hard), (slip[1], whole)]
    geoms = chain((0, 0, 0), *(bend or ((length, 0.0),)))
    hand = side(nation)
    return Map([Road("1", geoms, whole, list(whole), hand, kind, speed, unit(nation), "solid", more=more)])


def beside(number: int, lanes: int = 3) -> float:
    """Middle of a strip of a motorway: 1 is the median, 2 the lane next to it, the last one the shoulder."""
    widths = [MEDIAN, *[WIDE] * lanes, HARD]
    return sum(widths[: number - 1]) + widths[number - 1] / 2


british_motorway = partial(motorway, "gb")
autobahn = partial(motorway, "de", length=1600, speed=130)
country_road = partial(street, "gb", length=1000)
british_town = partial(street, "gb", length=1000, kind="town", speed=30, walk=True)
german_town = partial(street, "de", length=700, kind="town", speed=50, walk=True)
