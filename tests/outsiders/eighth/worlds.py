"""The roads of the scenes: straight ones of every kind, a motorway's exit and slip road."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tests.outsiders.eighth.road import Lane, Map, Road, Section, Shape
from tests.outsiders.eighth.ways import Way, against, along

NONE: Final = ((0, "none"),)
SOLID: Final = ((0, "solid"),)
_MEDIAN: Final = Lane("median", 4.0)
_KINDS: Final = {"rural": "rural", "town": "town", "dual": "rural", "motorway": "motorway"}
_LIMITS: Final = {"rural": (60, 100), "town": (30, 50), "dual": (70, 100), "motorway": (70, 130)}
_WIDTH: Final = 3.5

Place = tuple[float, float, float]  # x, y, heading


def straight(
    length: float = 800,
    kind: str = "rural",
    *,
    gb: bool = True,
    lanes: int = 1,
    width: float = _WIDTH,
    limit: float | None = 0,
    unit: str = "",
    centre: str | Sequence[tuple[float, str]] = "broken",
    place: Place = (0.0, 0.0, 0.0),
    number: int = 1,
    z: float = 0.0,
) -> Road:
    """A straight road; a dual carriageway and a motorway have two lanes each way, or more. A limit of 0: the usual one."""
    dual = kind in {"dual", "motorway"}
    last = Lane("driving", width, "none" if kind == "town" else "solid")
    side = (*[Lane("driving", width, "broken")] * (max(lanes, 2 if dual else 1) - 1), last)
    if kind == "town":
        side += (Lane("sidewalk", 2.2, "none"),)
    if kind == "motorway":
        side += (Lane("shoulder", 3.3),)
    left, right = side, side
    if dual:
        left, right = (side, (_MEDIAN, *side)) if gb else ((_MEDIAN, *side), side)
        centre = "solid"
    return Road(
        number,
        Shape(*place, length),
        (Section(0, left, right),),
        gb,
        _KINDS[kind],
        _LIMITS[kind][0 if gb else 1] if limit == 0 else limit,
        unit or ("mph" if gb else "km/h"),
        ((0, centre),) if isinstance(centre, str) else centre,
        z=z,
    )


def lane(number: int) -> Way:
    """A lane of the carriageway that runs as the road does: 1 is beside the middle (1, 2 ... on the left, -1, -2 ... on the right)."""
    y = _WIDTH * (abs(number) - 0.5)
    return along(y if number > 0 else -y)


def oncoming(length: float, *, gb: bool = True) -> Way:
    """The other lane of a road with two."""
    return against(-_WIDTH / 2 if gb else _WIDTH / 2, length)


def wrong_way(number: int, length: float) -> Way:
    """A lane, as nobody should drive it."""
    y = _WIDTH * (abs(number) - 0.5)
    return against(y if number > 0 else -y, length)


def exit_map() -> Map:
    """A British motorway with an exit lane from 500 m to 850 m, and its sign at 420 m."""
    lanes = (Lane(mark="broken"),) * 3
    way_out = (*lanes, Lane("exit"))
    far = (_MEDIAN, *lanes)
    sections = (Section(0, lanes, far), Section(500, way_out, far), Section(850, lanes, far))
    road = Road(1, Shape(0, 0, 0, 1500), sections, kind="motorway", limit=70, centre=SOLID)
    return Map((road.sign("e1", 420, 3, ("exit_sign", "exit", "GB")),))


def entry_map(*, gb: bool) -> Map:
    """A motorway with a lane to join it from, up to 500 m."""
    lanes = (Lane(mark="broken"),) * 3
    joining, after = (*lanes, Lane("onRamp")), (*lanes[:2], Lane())
    far = (_MEDIAN, *after)
    sides = [(0, joining), (500, after)]
    sections = tuple(Section(s, side, far) if gb else Section(s, far, side) for s, side in sides)
    limit, unit = (70, "mph") if gb else (130, "km/h")
    return Map((Road(1, Shape(0, 0, 0, 1500), sections, gb, "motorway", limit, unit, SOLID),))
