"""The roads of this outsider but for crossroads: along x from the origin, own lanes to the right (y < 0)."""

from __future__ import annotations

from collections.abc import Sequence

from tests.outsiders.sixteenth.road import Connection, End, Lane, Map, Road, Sign, Stretch, Thing
from tests.outsiders.sixteenth.ways import Bends, Path

SHOULDER = Lane("shoulder", 3.0, "none")
FOOTWAY = Lane("sidewalk", 2.0, "none")
SOLID = (("solid", 0.0),)


def _carriageway(n: int, width: float, limits: Sequence[float | None] | None = None) -> list[Lane]:
    """Lanes from the fastest to the slowest, the last with a solid edge."""
    said = limits or [None] * n
    return [Lane("driving", width, "broken" if i < n - 1 else "solid", said[i]) for i in range(n)]


def motorway(
    lanes: int = 3,
    length: float = 3000.0,
    limit: float | str | None = 33.33,
    width: float = 3.75,
    limits: Sequence[float | None] | None = None,
) -> Map:
    """One carriageway and its hard shoulder."""
    right = [*_carriageway(lanes, width, limits), SHOULDER]
    shown = "no limit" if limit == "none" else limit
    return Map([Road("1", Path(0, 0, 0, [(length, 0.0)]), [Stretch(0.0, right)], "motorway", shown, SOLID)])


def rural(
    limit: float = 26.82,
    length: float = 2000.0,
    middle: Sequence[tuple[str, float]] = (("broken", 0.0),),
    bends: Bends = (),
    sign: Sign | None = None,
) -> Map:
    """One lane each way outside towns."""
    lanes = [Lane(mark="solid")]
    path = Path(0, 0, 0, bends or [(length, 0.0)])
    return Map([Road("1", path, [Stretch(0.0, lanes, lanes)], "rural", limit, middle, signs=[sign] if sign else [])])


def town(limit: float = 13.41, length: float = 2000.0, footways: bool = True, lanes: int = 1) -> Map:
    """A street with as many lanes each way."""
    side = [*_carriageway(lanes, 3.5), *([FOOTWAY] if footways else [])]
    return Map([Road("1", Path(0, 0, 0, [(length, 0.0)]), [Stretch(0.0, side, side)], "town", limit)])


def zebra(lanes: int = 1) -> Map:
    """A street with a zebra crossing at 300 m."""
    drawn = town(length=600.0, lanes=lanes)
    drawn.roads[0].things.append(Thing("cw", "crosswalk", "zebra crossing", 300.0, 0.0, 3.0, 2 * lanes * 3.5, "none"))
    return drawn


def pelican() -> Map:
    """A street with a signalled crossing at 300 m, its stop line 4 m before."""
    drawn = town(length=600.0)
    road = drawn.roads[0]
    road.things.append(Thing("cw", "crosswalk", "signal crossing", 300.0, 0.0, 3.0, 7.0, "none"))
    road.things.append(Thing("sl", "stopLine", "stopLine", 296.0, -1.75, 0.3, 3.5, "+"))
    road.signs.append(Sign("tl", 296.0, -4.5, "1000001", "OpenDRIVE", -1))
    return drawn


def exit_road(limit: float = 31.29, width: float = 3.65) -> Map:
    """A motorway of two lanes with an exit lane from 500 to 900 m, where a slip road begins; the sign is at 480 m."""
    fork, begin = 900.0, 920.0
    two = _carriageway(2, width)
    beside = [Lane("driving", width), Lane("driving", width), Lane("exit", width, "solid")]
    one = [Stretch(0.0, [Lane("driving", width, "solid")])]
    into, out = End("road", "1", "end"), End("junction", "50")
    main = Road(
        "1",
        Path(0, 0, 0, [(fork, 0)]),
        [Stretch(0.0, [*two, SHOULDER]), Stretch(500.0, beside)],
        "motorway",
        limit,
        SOLID,
        after=out,
        signs=[Sign("ex", 480.0, -2 * width - 4, "333", "DE", -2)],
    )
    straight = Path(fork, 0, 0, [(20, 0)])
    on = Road("10", straight, [Stretch(0.0, two)], "motorway", limit, SOLID, "50", into, End("road", "2", "start"))
    on.links = {-1: (-1, -1), -2: (-2, -2)}
    aside = Path(fork, -2 * width, 0, [(20, 0)])
    off = Road("11", aside, one, "motorway", limit, SOLID, "50", into, End("road", "3", "start"), {-1: (-3, -1)})
    further = Road("2", Path(begin, 0, 0, [(800, 0)]), [Stretch(0.0, two)], "motorway", limit, SOLID, before=out)
    slip = Road("3", Path(begin, -2 * width, 0, [(200, -1 / 250)]), one, "motorway", limit, SOLID, before=out)
    ways = [Connection("1", "10", [(-1, -1), (-2, -2)]), Connection("1", "11", [(-3, -1)])]
    return Map([main, on, off, further, slip], "50", ways)
