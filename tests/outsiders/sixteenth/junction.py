"""A crossroads at the origin with arms to the west, east, south and north, one lane each way."""

from __future__ import annotations

import math

from tests.outsiders.sixteenth.road import Connection, End, Lane, Map, Road, Sign, Stretch, Thing
from tests.outsiders.sixteenth.ways import Path

ARM = 300.0  # from the middle to an arm's far end
EDGE = 12.0  # from the middle to the junction's edge
WIDTH = 3.5
_TURN = "WSEN"  # an arm's next but one is straight ahead
_NUMBER = {"W": "1", "E": "2", "S": "3", "N": "4"}
_INWARD = {"W": 0.0, "S": math.pi / 2, "E": math.pi, "N": -math.pi / 2}
_EDGES = {"W": (-EDGE, 0.0), "E": (EDGE, 0.0), "S": (0.0, -EDGE), "N": (0.0, EDGE)}
_TOWARDS = "WS"  # these arms' roads end at the junction, the others begin there


def _quarters(begin: str, end: str) -> int:
    """1: to the right, 2: straight on, 3: to the left."""
    return (_TURN.index(end) - _TURN.index(begin)) % 4


def through(begin: str, end: str) -> Path:
    """The middle of the lane from one arm's far end to that of another; the junction begins after 288 m."""
    heading = _INWARD[begin]
    x, y = {"W": (-ARM, 0.0), "S": (0.0, -ARM), "E": (ARM, 0.0), "N": (0.0, ARM)}[begin]
    x, y = x + WIDTH / 2 * math.sin(heading), y - WIDTH / 2 * math.cos(heading)
    near, far = EDGE - WIDTH / 2, EDGE + WIDTH / 2
    inside = {1: (math.pi / 2 * near, -1 / near), 2: (2 * EDGE, 0.0), 3: (math.pi / 2 * far, 1 / far)}
    return Path(x, y, heading, [(ARM - EDGE, 0.0), inside[_quarters(begin, end)], (ARM - EDGE, 0.0)])


def crossroads(limit: float = 13.41, lights: bool = False, stop: bool = False) -> Map:
    """Draw it; with lights on every arm, or a stop sign on the western one."""
    roads = [_arm(arm, limit, lights, stop and arm == "W") for arm in "WESN"]
    ways = []
    pairs = [(begin, end) for begin in "WESN" for end in "WESN" if begin != end]
    for i, (begin, end) in enumerate(pairs):
        road = _way(str(10 + i), begin, end, limit)
        roads.append(road)
        ways.append(Connection(_NUMBER[begin], road.id, [(road.links[-1][0], -1)]))
    return Map(roads, "100", ways)


def _arm(arm: str, limit: float, lights: bool, stop: bool) -> Road:
    length = ARM - EDGE
    towards = arm in _TOWARDS
    x, y = {"W": (-ARM, 0.0), "S": (0.0, -ARM)}.get(arm, _EDGES[arm])
    path = Path(x, y, math.pi / 2 if arm in "SN" else 0.0, [(length, 0.0)])
    lane = [Lane("driving", WIDTH, "solid")]
    road = Road(_NUMBER[arm], path, [Stretch(0.0, lane, lane)], "town", limit)
    if towards:
        road.after = End("junction", "100")
    else:
        road.before = End("junction", "100")
    side, orientation = (-1, "+") if towards else (1, "-")
    at = length - 1.0 if towards else 1.0
    line = Thing(f"sl{arm}", "stopLine", "stopLine", at, side * WIDTH / 2, 0.3, WIDTH, orientation)
    beside = side * (WIDTH + 1)
    if lights:
        road.signs.append(Sign(f"tl{arm}", at, beside, "1000001", "OpenDRIVE", side, orientation))
        road.things.append(line)
    if stop:
        road.signs.append(Sign("st", at, beside, "206", "DE", side, orientation))
        road.things.append(line)
    return road


def _way(number: str, begin: str, end: str, limit: float) -> Road:
    quarters = _quarters(begin, end)
    bend = {1: -1 / EDGE, 2: 0.0, 3: 1 / EDGE}[quarters]
    length = 2 * EDGE if quarters == 2 else math.pi / 2 * EDGE
    road = Road(
        number,
        Path(*_EDGES[begin], _INWARD[begin], [(length, bend)]),
        [Stretch(0.0, [Lane("driving", WIDTH, "none")])],
        "town",
        limit,
        (("none", 0.0),),
        "100",
        _end(begin),
        _end(end),
    )
    road.links[-1] = (-1 if begin in _TOWARDS else 1, 1 if end in _TOWARDS else -1)
    return road


def _end(arm: str) -> End:
    return End("road", _NUMBER[arm], "end" if arm in _TOWARDS else "start")
