"""Makes the roads of a layout: the roads in its text, the roads of a crossing or roundabout, and the turns through junctions."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final

import msgspec

from drivelint.errors import UsageError
from drivelint.phrases import hint
from drivelint.scene.road import DRIVABLE_KINDS, Lane, LinePiece, Pose, Road, Turn, connecting_piece

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.scene.document import Crossroads, LaneEntry, RoadEntry, RoadLayout, Roundabout

_ANGLE_BY_COMPASS_POINT: Final = {"east": 0.0, "north": math.pi / 2, "west": math.pi, "south": 3 * math.pi / 2}
_ROAD_AND_LANE_NUMBER: Final = re.compile(r"(.+) (-?\d+)")
_KINDS_OF_THINGS: Final = ("light", "stop line", "zebra", "signalled crossing", "crossing", "sign")
_FORMS_OF_NAMED_THINGS: Final = {"light": "light NAME", "sign": "sign COUNTRY CODE, or sign NAME"}
_LANE_KINDS: Final = (
    *DRIVABLE_KINDS,
    "shoulder",
    "sidewalk",
    "median",
    "parking",
    "biking",
    "border",
    "restricted",
    "stop",
    "none",
)
_MARK_WORDS: Final = ("none", "solid", "broken", "curb", "grass", "botts")
_SPEED_LIMIT: Final = re.compile(r"(\d+(?:\.\d+)?) (mph|km/h|m/s)|no limit")


def roads_of(layout: RoadLayout) -> dict[str, Road]:
    """Return name -> road of a layout, including the roads through its junctions. Errors: `UsageError`."""
    texts = dict(layout.roads)
    turns: str | Sequence[str] = layout.turns
    if layout.crossing:
        texts |= _arm_entries(layout.crossing)
        turns = turns or "all"
    ring: list[tuple[str, int, str, int]] = []
    if layout.roundabout:
        texts |= _arm_and_ring_entries(layout.roundabout)
        ring = _ring_turns(layout.roundabout)
    if not texts:
        raise UsageError("a layout has roads, a crossing or a roundabout")
    roads: dict[str, Road] = {}
    for name in _road_names_each_after_its_predecessor(texts):
        roads[name] = _road(name, texts[name], roads)
    for name in ("crossing", "roundabout"):
        if name in roads:
            raise UsageError(f"road {name}: this name is reserved: choose another name")
    pairs = _all_turns(roads) if turns == "all" else [_lanes_of_turn(text, roads) for text in turns]
    return roads | _junction_roads(roads, [*pairs, *ring])


def road_and_lane_number(text: str, roads: Mapping[str, Road]) -> tuple[str, int]:
    """Return the name of the road and the number of the lane in a text such as `main -1`. Errors: `UsageError`."""
    if (match := _ROAD_AND_LANE_NUMBER.fullmatch(text.strip())) is None:
        raise UsageError(f"{text!r} is no lane: write the name of a road and a number, such as {next(iter(roads))} 1")
    name, number = match[1], int(match[2])
    if name not in roads:
        raise UsageError(f"no road {name!r}: {hint(name, roads)}")
    roads[name].lane(number)
    return name, number


def _road_names_each_after_its_predecessor(texts: Mapping[str, RoadEntry]) -> list[str]:
    """Return the names of the roads, each after the road that it continues."""
    order: list[str] = []
    for name in texts:
        chain: list[str] = []
        here: str | None = name
        while here is not None and here not in order:
            if here not in texts:
                raise UsageError(
                    f"road {chain[-1]}: `after` names the road {here}, which does not exist; {hint(here, texts)}"
                )
            if here in chain:
                raise UsageError(f"road {here} comes after itself")
            chain.append(here)
            here = texts[here].after
        order += reversed(chain)
    return order


def _road(name: str, text: RoadEntry, roads: Mapping[str, Road]) -> Road:
    if text.start is not None:
        x, y, heading = text.start
        start = Pose(x, y, math.radians(heading))
    else:
        start = roads[text.after].end_pose() if text.after else Pose(0.0, 0.0, 0.0)
    pieces = [
        LinePiece(float(part)) if isinstance(part, int | float) else LinePiece(float(part[0]), 1 / part[1])
        for part in text.line
    ]
    length = sum(piece.length for piece in pieces)
    lanes = [*_lanes(text.lanes, 1, length), *_lanes(text.against, -1, length)]
    limits = [(0.0, text.limit)] if isinstance(text.limit, str) else text.limit or []
    for _, limit in limits:
        if _SPEED_LIMIT.fullmatch(limit) is None:
            raise UsageError(f"road {name}: limit {limit!r}: write a number and mph, km/h or m/s, or 'no limit'")
    _refuse_unknown_words(name, text, lanes)
    return Road(
        name,
        start,
        pieces,
        lanes,
        text.kind,
        limits,
        [(0.0, text.middle)] if isinstance(text.middle, str) else text.middle,
        [(0.0, float(text.height))] if isinstance(text.height, int | float) else [(s, z) for s, z in text.height],
        text.things,
        text.after,
    )


def _refuse_unknown_words(name: str, text: RoadEntry, lanes: Sequence[Lane]) -> None:
    """Raise `UsageError` for unknown words of things, lanes and marks."""
    for thing in text.things:
        word, _, rest = thing.kind.partition(" ")
        if word in _FORMS_OF_NAMED_THINGS and not rest:
            raise UsageError(f"road {name}: what: {thing.kind!r}: write {_FORMS_OF_NAMED_THINGS[word]}")
        if word not in _FORMS_OF_NAMED_THINGS and thing.kind not in _KINDS_OF_THINGS:
            raise UsageError(f"road {name}: what: {thing.kind!r}: {hint(thing.kind, _KINDS_OF_THINGS)}")
    for lane in lanes:
        if lane.kind not in _LANE_KINDS:
            raise UsageError(f"road {name}: lane {lane.number}: {lane.kind!r}: {hint(lane.kind, _LANE_KINDS)}")
    middle = [(0.0, text.middle)] if isinstance(text.middle, str) else text.middle
    for _, mark in [*middle, *(mark for lane in lanes for mark in lane.marks)]:
        for word in mark.split():
            if word not in _MARK_WORDS:
                raise UsageError(f"road {name}: mark {mark!r}: {hint(word, _MARK_WORDS)}")


def _lanes(texts: Iterable[str | LaneEntry], sign: int, length: float) -> list[Lane]:
    texts = list(texts)
    drivable = [n for n, text in enumerate(texts) if _lane_kind(text) in DRIVABLE_KINDS]
    lanes = []
    for n, text in enumerate(texts):
        usual = "broken" if n in drivable and n != drivable[-1] else "solid" if n in drivable else "none"
        if isinstance(text, str):
            kind, width, mark = _kind_width_mark(text)
            marks, start, end = [(0.0, mark or usual)], 0.0, length
        else:
            kind, width = text.kind, text.width
            marks = [(0.0, text.mark or usual)] if not isinstance(text.mark, list) else text.mark
            start, end = text.from_, length if text.to is None else text.to
        lanes.append(Lane(sign * (n + 1), kind, width, marks, start, end))
    return lanes


def _lane_kind(text: str | LaneEntry) -> str:
    return text.split()[0] if isinstance(text, str) else text.kind


def _kind_width_mark(text: str) -> tuple[str, float, str | None]:
    kind, width, *mark = text.split()
    try:
        return kind, float(width), " ".join(mark) or None
    except ValueError as error:
        raise UsageError(f"lane {text!r}: write kind, width and mark, such as 'driving 3.5 solid'") from error


def _lanes_of_turn(text: str, roads: Mapping[str, Road]) -> tuple[str, int, str, int]:
    before, arrow, behind = text.partition(" > ")
    if not arrow:
        raise UsageError(f"turn {text!r}: write two lanes, such as 'west -1 > north 1'")
    return (*road_and_lane_number(before, roads), *road_and_lane_number(behind, roads))


def _all_turns(roads: Mapping[str, Road]) -> list[tuple[str, int, str, int]]:
    """Return the turns from each driving lane that ends at the junction (number < 0) to each that begins there on another road."""
    ends = [(road.name, lane.number) for road in roads.values() for lane in road.lanes if lane.kind == "driving"]
    arriving = [(name, number) for name, number in ends if number < 0]
    leaving = [(name, number) for name, number in ends if number > 0]
    return [(*entry, *exit_) for entry in arriving for exit_ in leaving if entry[0] != exit_[0]]


def _junction_roads(roads: Mapping[str, Road], turns: Sequence[tuple[str, int, str, int]]) -> dict[str, Road]:
    """Return a road for each turn; turns that share an end of a road belong to the same junction."""
    group: dict[tuple[str, bool], int] = {}
    for a, n, b, m in turns:
        first, second = (a, n > 0), (b, m < 0)
        number = min(group.get(first, len(group) + 1), group.get(second, len(group) + 1))
        numbers = {group[end] for end in (first, second) if end in group}
        group |= {end: number for end, old in group.items() if old in numbers}
        group |= {first: number, second: number}
    turn_roads = {}
    for a, n, b, m in turns:
        before, behind = roads[a], roads[b]
        lane = before.lane(n)
        start, end = (
            before.lane_exit_or_entry_pose(lane, is_exit=True),
            behind.lane_exit_or_entry_pose(behind.lane(m), is_exit=False),
        )
        width = min(lane.width, behind.lane(m).width)
        aside = width / 2  # the line is the lane's left border
        start, end = (
            Pose(p.x - aside * math.sin(p.heading), p.y + aside * math.cos(p.heading), p.heading) for p in (start, end)
        )
        name = f"{a} {n} to {b} {m}"
        z0, z1 = before.heights[-1 if n > 0 else 0][1], behind.heights[0 if m > 0 else -1][1]
        piece = connecting_piece(start, end)
        turn_roads[name] = Road(
            name,
            start,
            [piece],
            [Lane(1, "driving", width, [(0.0, "none")], 0.0, piece.length)],
            before.kind,
            before.limits[-1:] and [(0.0, before.limits[-1][1])],
            heights=[(0.0, z0), (piece.length, z1)] if z0 != z1 else [(0.0, z0)],
            turn=Turn(900 + group[a, n > 0], a, n, b, m),
        )
    return turn_roads


def _arm_entries(crossroads: Crossroads) -> dict[str, RoadEntry]:
    arms: dict[str, RoadEntry] = {}
    for arm in crossroads.arms:
        angle = _ANGLE_BY_COMPASS_POINT[arm]
        start = [crossroads.half * math.cos(angle), crossroads.half * math.sin(angle), math.degrees(angle)]
        things = [*crossroads.road.things, *crossroads.things.get(arm, ())]
        arms[arm] = msgspec.structs.replace(crossroads.road, start=start, things=things)
    if unknown := next((arm for arm in crossroads.things if arm not in arms), None):
        raise UsageError(f"crossing: no arm {unknown!r}: {hint(unknown, arms)}")
    return arms


def _arm_and_ring_entries(roundabout: Roundabout) -> dict[str, RoadEntry]:
    """Return the arms, and for each arm the part of the ring that begins after it; the ring is driven anticlockwise."""
    ring: dict[str, RoadEntry] = {}
    gap = 10.0 / roundabout.radius  # half of the part of the ring that an arm's junction occupies, as an angle
    angles = sorted((_ANGLE_BY_COMPASS_POINT[arm], arm) for arm in roundabout.arms)
    lane = next(iter(roundabout.road.lanes))
    width = _kind_width_mark(lane)[1] if isinstance(lane, str) else lane.width
    inner = roundabout.radius - width / 2
    for n, (angle, arm) in enumerate(angles):
        away = roundabout.radius + 15.0
        start = [away * math.cos(angle), away * math.sin(angle), math.degrees(angle)]
        ring[arm] = msgspec.structs.replace(roundabout.road, start=start)
        until = angles[(n + 1) % len(angles)][0]
        turn = until - angle + (0.0 if until > angle else 2 * math.pi) - 2 * gap
        begin = angle + gap
        ring[f"ring {arm}"] = msgspec.structs.replace(
            roundabout.road,
            line=[[turn * inner, inner]],
            start=[inner * math.cos(begin), inner * math.sin(begin), math.degrees(begin) + 90],
            lanes=[lane],
            against=[],
            middle="curb",
            things=[],
        )
    return ring


def _ring_turns(roundabout: Roundabout) -> list[tuple[str, int, str, int]]:
    arms = [arm for _, arm in sorted((_ANGLE_BY_COMPASS_POINT[arm], arm) for arm in roundabout.arms)]
    turns = []
    for n, arm in enumerate(arms):
        before = arms[n - 1]
        turns += [
            (f"ring {before}", 1, f"ring {arm}", 1),
            (arm, -1, f"ring {arm}", 1),
            (f"ring {before}", 1, arm, 1),
        ]
    return turns
