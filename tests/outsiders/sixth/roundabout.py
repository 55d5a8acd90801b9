"""A British roundabout of four arms, and the ways round it."""

from __future__ import annotations

import math

from tests.outsiders.sixth.crossroads import ARMS, IDS
from tests.outsiders.sixth.lines import Geom, Pose, back, join
from tests.outsiders.sixth.road import Lane, Map, Road

INNER, WIDTH, FAR, HALF = 13.0, 4.0, 120.0, 0.6  # HALF: the ring goes so far (rad) to both sides of an arm's junction
OUTER = INNER + WIDTH + 12.0
ORDER = "swne"  # clockwise

Lines = dict[str, list[Geom]]


def ring() -> tuple[Map, Lines]:
    """Return the map and the pieces of line through it: 'in-s', 'seg-s' (after arm s), 'past-s', 'out-s'."""
    lane, plain = Lane("driving", WIDTH, "solid"), Lane("driving", WIDTH, "none")
    common = (1, "town", 30, "mph")
    roads, junctions = [], []
    pieces: Lines = {}
    for k, a in enumerate(ORDER):
        after, before = IDS[ORDER[(k + 1) % 4]], "5" + IDS[ORDER[k - 1]]
        h, i = ARMS[a], IDS[a]
        outer = (OUTER * math.cos(h), OUTER * math.sin(h), h)
        arm = Road(i, [Geom(outer, FAR)], [lane], [lane], *common, "broken", pred=("junction", "90" + i, ""))
        around_it = Geom(_on(h - HALF), INNER * (math.pi / 2 - 2 * HALF), -1 / INNER)
        seg = Road("5" + i, [around_it], [lane], [], *common, "solid")
        seg.pred, seg.succ = ("junction", "90" + i, ""), ("junction", "90" + after, "")
        entry = join((outer[0], outer[1], h + math.pi), _on(h - HALF))
        leave = join(_on(h + HALF), outer)
        past = Geom(_on(h + HALF), INNER * 2 * HALF, -1 / INNER)
        ways = (
            ("6", entry, (i, "start"), ("5" + i, "start"), -1),
            ("7", leave, (before, "end"), (i, "start"), 1),
            ("8", past, (before, "end"), ("5" + i, "start"), 1),
        )
        text = ""
        for digit, line, source, target, lane_from in ways:
            road = Road(digit + i, [line], [plain], [], *common, "none", junction="90" + i, links=(lane_from, 1))
            road.pred, road.succ = ("road", *source), ("road", *target)
            roads.append(road)
            text += (
                f'<connection id="{digit}{i}" incomingRoad="{source[0]}" connectingRoad="{digit}{i}" '
                f'contactPoint="start"><laneLink from="{lane_from}" to="1"/></connection>'
            )
        junctions.append(f'<junction id="90{i}" name="rb{a}">{text}</junction>')
        roads += [arm, seg]
        pieces |= {
            "in-" + a: [*back(arm.geoms), entry],
            "seg-" + a: seg.geoms,
            "past-" + a: [past],
            "out-" + a: [leave, *arm.geoms],
        }
    return Map(roads, junctions), pieces


def around(pieces: Lines, a: str, b: str) -> list[Geom]:
    """Way from arm a round to arm b."""
    out = [*pieces["in-" + a], *pieces["seg-" + a]]
    k = (ORDER.index(a) + 1) % 4
    while ORDER[k] != b:
        out += [*pieces["past-" + ORDER[k]], *pieces["seg-" + ORDER[k]]]
        k = (k + 1) % 4
    return out + pieces["out-" + b]


def wrong_way(drawn: Map) -> list[Geom]:
    """Way from the south to the north, against the traffic of the ring."""
    r, first, last = 15.0, -math.pi / 2 + 0.6, math.pi / 2 - 0.6
    arc = Geom((r * math.cos(first), r * math.sin(first), first + math.pi / 2), r * (last - first), 1 / r)
    coming, going = back(drawn["1"].geoms), drawn["3"].geoms
    return [*coming, join(coming[-1].end(), arc.start), arc, join(arc.end(), going[0].start), *going]


def _on(angle: float) -> Pose:
    """A place on the inner edge of the ring, and the way round from there."""
    return INNER * math.cos(angle), INNER * math.sin(angle), angle - math.pi / 2
