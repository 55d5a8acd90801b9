"""The maps: roads with a lane each way, carriageways, crossroads, a roundabout.

Everything goes along x from the origin; in Great Britain the near side is at y > 0, in Germany at y < 0. The middle of a junction is
the origin.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from tests.outsiders.seventeenth.road import Lane, Map, Marks, Road, sheet
from tests.outsiders.seventeenth.ways import EAST, NORTH, SOUTH, WEST, Pairs, Way

Limit = tuple[float, str]
Things = tuple[Sequence[str], Sequence[str]]  # objects and signs

HALF = 12.0  # from the middle of the crossroads to its arms
ARM = 150.0  # their length
FAR = 40.0  # from the middle of the roundabout to its arms
HEADINGS = {"W": EAST, "E": WEST, "N": SOUTH, "S": NORTH}  # of an arm towards the middle
IDS = {"W": 1, "E": 2, "N": 3, "S": 4}
RIGHT = ((ARM, 0.0), (13.75 * math.pi / 2, -1 / 13.75))  # from an arm in Great Britain
LEFT = ((ARM, 0.0), (10.25 * math.pi / 2, 1 / 10.25))


def two_way(
    *,
    gb: bool = True,
    length: float = 700.0,
    kind: str = "rural",
    limit: Limit = (60, "mph"),
    centre: Marks = ((0.0, "broken"),),
    walk: float = 0.0,
    objects: Sequence[str] = (),
    signals: Sequence[str] = (),
    pieces: Pairs = (),
) -> Map:
    """Return a road with one lane each way, with footways if wanted."""
    lanes = [Lane(1), Lane(-1)]
    if walk:
        lanes += [Lane(i, "sidewalk", walk, ((0.0, "none"),)) for i in (2, -2)]
    drawn = pieces or [(length, 0.0)]
    return sheet([Road(1, (0, 0, 0), drawn, lanes, centre, kind, limit, gb, objects=objects, signals=signals)])


def one_way(
    *,
    gb: bool = True,
    n: int = 3,
    length: float = 1500.0,
    limit: Limit = (70, "mph"),
    kind: str = "motorway",
    shoulder: bool = True,
    leaves: bool = False,
    objects: Sequence[str] = (),
    signals: Sequence[str] = (),
) -> Map:
    """Return a carriageway whose reference line is its offside edge; lane 1 is nearest to it; leaves: with an exit lane."""
    g = 1 if gb else -1
    width = 3.65
    lanes = [
        Lane(g * i, width=width, marks=((0.0, "broken" if i < n or leaves else "solid"),)) for i in range(1, n + 1)
    ]
    if leaves:
        lanes.append(Lane(g * (n + 1), "exit", width))
    if shoulder:
        lanes.append(Lane(g * (n + 1 + leaves), "shoulder", 3.3, ((0.0, "none"),)))
    solid = ((0.0, "solid"),)
    road = Road(1, (0, 0, 0), [(length, 0.0)], lanes, solid, kind, limit, gb, objects=objects, signals=signals)
    return sheet([road])


def cross(*, gb: bool = True, walk: float = 0.0, west: Things = ((), ())) -> Map:
    """Return crossroads whose arms' roads run towards the middle; west: what stands on the western arm."""
    limit: Limit = (30, "mph") if gb else (50, "km/h")
    roads = [_arm(arm, HALF, ARM, limit, gb, walk, west if arm == "W" else ((), ())) for arm in "WENS"]
    ways = []
    for a in "WENS":
        for b in (other for other in "WENS" if other != a):
            turn = HEADINGS[b] + math.pi - HEADINGS[a]
            turn = math.atan2(math.sin(turn), math.cos(turn))
            ways.append((a, b, [(2 * HALF, 0.0)] if abs(turn) < 0.1 else [_bend(turn)]))
    return _junction(roads, ways, HALF, limit, gb)


def roundabout() -> Map:
    """Return a British roundabout: one junction whose ways go round an island, from every arm to the next three."""
    order = "WNES"
    limit: Limit = (30, "mph")
    roads = [_arm(arm, FAR, 120.0, limit, True, 0.0, ((), ())) for arm in order]
    ways = []
    for i, a in enumerate(order):
        for k in (1, 2, 3):
            pieces = [(length * (1 + 1.75 * c), c / (1 + 1.75 * c)) for length, c in ring(True, k)]
            ways.append((a, order[(i + k) % 4], pieces))
    return _junction(roads, ways, FAR, limit, True)


def ring(gb: bool, quarters: int) -> list[tuple[float, float]]:
    """Return the way of a lane's middle from an arm round the ring, in Great Britain clockwise, else the other way."""
    g = 1.0 if gb else -1.0
    inner, entry = 16.0, 14.0
    up = 1.75 + entry
    x = -math.sqrt((inner + entry) ** 2 - up**2)
    phi = math.atan2(up, -x)
    first = (entry * (math.pi / 2 - phi), g / entry)
    return [(FAR + x, 0.0), first, (inner * (quarters * math.pi / 2 - 2 * phi), -g / inner), first, (FAR + x, 0.0)]


def round_way(gb: bool, quarters: int) -> Way:
    """Return a way from the western arm round the ring."""
    first, *rest = ring(gb, quarters)
    return Way(-160, 1.75 if gb else -1.75, EAST, [(120.0 + first[0], 0.0), *rest])


def _bend(turn: float) -> tuple[float, float]:
    return HALF * math.pi / 2, math.copysign(1 / HALF, turn)


def _arm(arm: str, half: float, length: float, limit: Limit, gb: bool, walk: float, things: Things) -> Road:  # noqa: PLR0917
    h = HEADINGS[arm]
    lanes = [Lane(1), Lane(-1)]
    if walk:
        lanes += [Lane(2, "sidewalk", walk), Lane(-2, "sidewalk", walk)]
    return Road(
        IDS[arm],
        (-(half + length) * math.cos(h), -(half + length) * math.sin(h), h),
        [(length, 0.0)],
        lanes,
        kind="town",
        limit=limit,
        gb=gb,
        after=("junction", 100, ""),
        objects=things[0],
        signals=things[1],
    )


def _junction(roads: list[Road], ways: Sequence[tuple[str, str, Pairs]], half: float, limit: Limit, gb: bool) -> Map:
    """Return the map of arms and the ways between them."""
    g = 1 if gb else -1
    tail = '<junction id="100" name="">'
    inner = []
    for n, (a, b, pieces) in enumerate(ways):
        h = HEADINGS[a]
        inner.append(
            Road(
                200 + n,
                (-half * math.cos(h), -half * math.sin(h), h),
                pieces,
                [Lane(g, marks=((0.0, "none"),), link=(g, -g))],
                ((0.0, "none"),),
                "town",
                limit,
                gb,
                100,
                ("road", IDS[a], "end"),
                ("road", IDS[b], "end"),
            )
        )
        tail += (
            f'<connection id="{n}" incomingRoad="{IDS[a]}" connectingRoad="{200 + n}" contactPoint="start">'
            f'<laneLink from="{g}" to="{g}"/></connection>'
        )
    return sheet([*roads, *inner], tail + "</junction>")
