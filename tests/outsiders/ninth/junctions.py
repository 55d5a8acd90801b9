"""Crossroads and roundabouts, with a way from each arm to each other."""

from __future__ import annotations

import math
from typing import Final

from tests.outsiders.ninth.road import Lane, Map, Road, Section, Signal
from tests.outsiders.ninth.ways import Piece, Way, along, cubic

ARMS: Final = {"W": 180.0, "E": 0.0, "N": 90.0, "S": 270.0}
ARM_M: Final = 160.0
WIDE_M: Final = 3.5
HALF_M: Final = 12.0  # from the middle of a junction to its arms
RING_M, LANE_M, REACH_M = 18.0, 5.0, 45.0  # the inner edge of a ring and the width of its lane; where arms begin
SPREAD: Final = math.radians(32.0)
NUMBER: Final = 900


def crossroads(
    kind: str = "town",
    limit: float = 30,
    unit: str = "mph",
    walk: float = 2.0,
    *,
    lights: str = "",
    stops: str = "",
) -> Map:
    """Return four arms with lights or stop signs; coming from W the near turn goes to S, the far one to N."""
    drawn = Map([_arm(10 + i, ARMS[a], HALF_M, kind, limit, unit, NUMBER, walk) for i, a in enumerate(ARMS)])
    arms = dict(zip(ARMS, drawn.roads, strict=True))
    links = []
    pairs = [(a, b) for a in ARMS for b in ARMS if a != b]
    for number, (a, b) in enumerate(pairs, 100):
        piece = _through(math.radians(ARMS[a]), math.radians(ARMS[b]))
        ends = ("road", arms[a].number, "start"), ("road", arms[b].number, "start")
        drawn.roads.append(_connecting(number, piece, (WIDE_M, WIDE_M), (1, -1), ends, (kind, limit, unit), NUMBER))
        links.append((arms[a].number, number, "start", 1, -1))
        way = along([_inbound(ARMS[a], HALF_M), piece, arms[b].pieces[0]], -WIDE_M / 2)
        drawn.routes[a + b] = (way, ARM_M, way.length - ARM_M)
    drawn.junctions[NUMBER] = links
    for a in [*lights, *stops]:
        arms[a].signals.append(Signal(1.0, WIDE_M / 2, "stop_line", "DE", "294", "-", lanes=(1, 1), width=WIDE_M))
        arms[a].signals.append(
            _head(a) if a in lights else Signal(2.0, WIDE_M + 1, "stop", "DE", "206", "-", lanes=(1, 1))
        )
    return drawn


def roundabout(limit: float, unit: str) -> Map:
    """Return a roundabout of one lane with four arms, driven against the clock (with it, where mirrored)."""
    order = sorted(ARMS, key=lambda a: ARMS[a])
    angles = [math.radians(ARMS[a]) for a in order]
    drawn = Map([_arm(10 + i, ARMS[a], REACH_M, "rural", limit, unit, NUMBER + i) for i, a in enumerate(order)])
    ring = [_ring(angle, angles[i + 1] if i < 3 else angles[0] + 2 * math.pi) for i, angle in enumerate(angles)]
    for i, piece in enumerate(ring):
        lane = Lane(-1, "driving", LANE_M, None, [(0, "solid")])
        ends = ("junction", NUMBER + i, "start"), ("junction", NUMBER + (i + 1) % 4, "start")
        drawn.roads.append(
            Road(50 + i, [piece], [Section(0, [lane], [(0, "solid")])], "rural", limit, unit, -1, ends[0], ends[1])
        )
    parts = [_parts(angle) for angle in angles]
    for i, (through, entry, leaving) in enumerate(parts):
        came, goes, arm = ("road", 50 + (i - 1) % 4, "end"), ("road", 50 + i, "start"), ("road", 10 + i, "start")
        says = ("rural", limit, unit)
        number = 100 + 10 * i
        drawn.roads += [
            _connecting(number, through, (LANE_M, LANE_M), (-1, -1), (came, goes), says, NUMBER + i),
            _connecting(number + 1, entry, (WIDE_M, LANE_M), (1, -1), (arm, goes), says, NUMBER + i),
            _connecting(number + 2, leaving, (LANE_M, WIDE_M), (-1, -1), (came, arm), says, NUMBER + i),
        ]
        drawn.junctions[NUMBER + i] = [
            (came[1], number, "start", -1, -1),
            (arm[1], number + 1, "start", 1, -1),
            (came[1], number + 2, "start", -1, -1),
        ]
    for i, a in enumerate(order):
        for exits in range(1, 5):
            way = _round(drawn, ring, parts, i, exits)
            drawn.routes[a + order[(i + exits) % 4]] = (way, ARM_M, way.length - ARM_M)
    return drawn


def _round(drawn: Map, ring: list[Piece], parts: list[tuple[Piece, Piece, Piece]], i: int, exits: int) -> Way:
    """Return the way from the arm i to so many arms on."""
    to = (i + exits) % 4
    pieces = [_inbound(sorted(ARMS.values())[i], REACH_M), parts[i][1]]
    left = [-WIDE_M / 2, -WIDE_M / 2, -LANE_M / 2]
    for q in range(exits):
        pieces.append(ring[(i + q) % 4])
        left.append(-LANE_M / 2)
        if q < exits - 1:
            pieces.append(parts[(i + q + 1) % 4][0])
            left.append(-LANE_M / 2)
    return along([*pieces, parts[to][2], drawn.roads[to].pieces[0]], [*left, -WIDE_M / 2, -WIDE_M / 2])


def _ring(angle: float, following: float) -> Piece:
    return Piece(*_spot(angle + SPREAD), RING_M * (following - angle - 2 * SPREAD), 1 / RING_M)


def _parts(angle: float) -> tuple[Piece, Piece, Piece]:
    """Return the ways past an arm, in from it, and out to it."""
    x, y = REACH_M * math.cos(angle), REACH_M * math.sin(angle)
    through = Piece(*_spot(angle - SPREAD), RING_M * 2 * SPREAD, 1 / RING_M)
    entry = cubic((x, y, angle + math.pi), _spot(angle + SPREAD))
    return through, entry, cubic(_spot(angle - SPREAD), (x, y, angle))


def _spot(angle: float) -> tuple[float, float, float]:
    return RING_M * math.cos(angle), RING_M * math.sin(angle), angle + math.pi / 2


def _arm(  # noqa: PLR0917
    number: int, degrees: float, start: float, kind: str, limit: float, unit: str, junction: int, walk: float = 0.0
) -> Road:
    angle = math.radians(degrees)
    lanes = [Lane(-1, "driving", WIDE_M, None, [(0, "solid")]), Lane(1, "driving", WIDE_M, None, [(0, "solid")])]
    if walk:
        lanes += [Lane(-2, "sidewalk", walk), Lane(2, "sidewalk", walk)]
    piece = Piece(start * math.cos(angle), start * math.sin(angle), angle, ARM_M)
    section = Section(0, lanes, [(0, "broken")])
    return Road(number, [piece], [section], kind, limit, unit, before=("junction", junction, "start"))


def _inbound(degrees: float, start: float) -> Piece:
    angle, far = math.radians(degrees), start + ARM_M
    return Piece(far * math.cos(angle), far * math.sin(angle), angle + math.pi, ARM_M)


def _through(one: float, other: float) -> Piece:
    turn = (other - one) % (2 * math.pi) - math.pi
    x, y = HALF_M * math.cos(one), HALF_M * math.sin(one)
    if abs(turn) < 1e-6:
        return Piece(x, y, one + math.pi, 2 * HALF_M)
    radius = HALF_M / math.tan(abs(turn) / 2)
    return Piece(x, y, one + math.pi, radius * abs(turn), math.copysign(1 / radius, turn))


def _connecting(  # noqa: PLR0917
    number: int,
    piece: Piece,
    widths: tuple[float, float],
    lanes: tuple[int, int],
    ends: tuple[tuple[str, int, str], tuple[str, int, str]],
    says: tuple[str, float, str],
    junction: int,
) -> Road:
    lane = Lane(-1, "driving", widths[0], widths[1], [(0, "none")], lanes[0], lanes[1])
    return Road(number, [piece], [Section(0, [lane], [(0, "none")])], *says, junction, *ends)


def _head(arm: str) -> Signal:
    name = f"traffic_light_{arm}"
    return Signal(1.0, WIDE_M + 1, name, "OpenDRIVE", "1000001", "-", f"L{arm}", (1, 1), dynamic=True)
