"""Roads without junctions, and places and ways on them."""

from __future__ import annotations

from collections.abc import Callable

from tests.outsiders.ninth.road import Crosswalk, Lane, Map, Marks, Road, Section, Signal
from tests.outsiders.ninth.ways import Way, chain

OnMap = Callable[[Map], Way]
BRITISH_M, GERMAN_M, MOTORWAY_M, AUTOBAHN_M = 3.6, 3.5, 3.65, 3.75  # widths of lanes


def road(
    width: float,
    limit: float,
    unit: str,
    length: float = 1000.0,
    *,
    kind: str = "rural",
    middle: Marks | None = None,
    walk: float = 0.0,
    bends: list[tuple[float, float]] | None = None,
) -> Map:
    """Return a road with one lane each way, and footways of that width."""
    lanes = [Lane(-1, "driving", width, None, [(0, "solid")]), Lane(1, "driving", width, None, [(0, "solid")])]
    if walk:
        lanes += [Lane(-2, "sidewalk", walk), Lane(2, "sidewalk", walk)]
    section = Section(0, lanes, middle or [(0, "broken")])
    return Map([Road(1, chain(0, 0, 0, bends or [(length, 0.0)]), [section], kind, limit, unit)])


def country(
    length: float = 1000.0,
    *,
    limit: float = 60,
    middle: Marks | None = None,
    bends: list[tuple[float, float]] | None = None,
) -> Map:
    """Return a British country road."""
    return road(BRITISH_M, limit, "mph", length, middle=middle, bends=bends)


def town(walk: float = 2) -> Map:
    """Return a British street of 30 mph."""
    return road(BRITISH_M, 30, "mph", kind="town", walk=walk)


def landstrasse(length: float = 1000.0) -> Map:
    """Return a German country road."""
    return road(GERMAN_M, 100, "km/h", length)


def ortsstrasse() -> Map:
    """Return a German street of 50 km/h."""
    return road(GERMAN_M, 50, "km/h", kind="town", walk=2)


def crossing(s: float, width: float, *, signalled: bool = False) -> Crosswalk:
    """Return a crossing over both lanes."""
    return Crosswalk(s, -width, width, "signal crossing" if signalled else "zebra")


def stop_and_light(width: float) -> tuple[Signal, Signal]:
    """Return a stop line 5 m before a crossing at 200 m, and its light P1."""
    line = Signal(195, -width / 2, "stop_line", "DE", "294", lanes=(-1, -1), width=width)
    return line, Signal(195.5, -4.4, "traffic_light", "OpenDRIVE", "1000001", "+", "P1", (-1, -1), dynamic=True)


def dual(
    length: float,
    *,
    lanes: int = 2,
    kind: str = "motorway",
    limit: float | None = 70,
    unit: str = "mph",
    width: float = MOTORWAY_M,
    shoulder: float = 3.3,
    exit_lane: tuple[float, float] | None = None,
) -> Map:
    """Return two carriageways with a reserve between them, and with an exit lane from one s to another."""
    starts = [0.0, *(exit_lane or ())]
    sections = [
        _carriageways(starts, i, lanes, width, shoulder, wide=exit_lane is not None and i == 1)
        for i in range(len(starts))
    ]
    return Map([Road(1, chain(0, 0, 0, [(length, 0.0)]), sections, kind, limit, unit)])


def dual_carriageway() -> Map:
    """Return a British dual carriageway that is no motorway."""
    return dual(1200, kind="rural", shoulder=0)


def autobahn(limit: float | None = None, lanes: int = 2) -> Map:
    """Return a German motorway."""
    return dual(1800.0, lanes=lanes, limit=limit, unit="km/h", width=AUTOBAHN_M, shoulder=2.5)


def own(drawn: Map) -> Way:
    """Return the way along the lane of the first road."""
    return drawn.way(-drawn.width() / 2)


def opposite(drawn: Map) -> Way:
    """Return the way along the other lane, towards the first."""
    return drawn.way(drawn.width() / 2).back()


def near(number: int, lanes: int, width: float) -> float:
    """Return where the middle of a lane of a carriageway is: 0 is at the near side."""
    return -(lanes - number - 0.5) * width


def lane(
    number: int, lanes: int = 2, width: float = AUTOBAHN_M, *, beside: float = 0.0, against: bool = False
) -> OnMap:
    """Return the way along such a lane, or against it."""

    def way(drawn: Map) -> Way:
        found = drawn.way(near(number, lanes, width) + beside)
        return found.back() if against else found

    return way


def route(name: str) -> OnMap:
    """Return the way through a junction from one arm to another."""
    return lambda drawn: drawn.routes[name][0]


def _carriageways(starts: list[float], i: int, count: int, width: float, shoulder: float, *, wide: bool) -> Section:
    before, after = i > 0, i + 1 < len(starts)

    def linked(number: int, kind: str, broad: float, mark: str) -> Lane:
        return Lane(number, kind, broad, None, [(0, mark)], number if before else None, number if after else None)

    ours = [linked(-j, "driving", width, "broken" if j < count or wide else "solid") for j in range(1, count + 1)]
    theirs = [linked(j, "driving", width, "broken" if j < count + 1 else "solid") for j in range(2, count + 2)]
    slip = [Lane(-count - 1, "exit", width, None, [(0, "solid")])] if wide else []
    hard = Lane(
        -count - 1 - int(wide),
        "shoulder",
        shoulder,
        None,
        [(0, "none")],
        (-count - 1 - int(i == 2)) if before else None,
        (-count - 1 - int(i == 0)) if after else None,
    )
    edge = [hard] if shoulder else []
    return Section(starts[i], [*ours, *slip, *edge, linked(1, "median", 4.0, "solid"), *theirs], [(0, "solid")])
