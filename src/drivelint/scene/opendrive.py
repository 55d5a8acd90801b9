"""Writes the roads of a scene as OpenDRIVE 1.7; for left-hand traffic, the drawing is mirrored."""

from __future__ import annotations

from collections import defaultdict
from itertools import pairwise
from typing import TYPE_CHECKING, Final
from xml.sax.saxutils import quoteattr

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.scene.document import RoadThing
    from drivelint.scene.road import Lane, Road, Turn

_ORIENTATIONS: Final = {"along": "+", "against": "-", "both": "none"}
_NO_CODE: Final = "-1"
_LIGHT_COUNTRY_AND_CODE: Final = ("OpenDRIVE", "1000001")


def opendrive_text(roads: Mapping[str, Road], *, left: bool) -> str:
    """Return the text of the map. `left`: mirror the drawing for left-hand traffic."""
    return _Writer(roads, left=left).map_text()


class _Writer:
    def __init__(self, roads: Mapping[str, Road], *, left: bool) -> None:
        self.roads = roads
        self.hand = -1 if left else 1
        """The factor of lateral values: -1 mirrors the drawing for left-hand traffic."""
        self.numbers = {name: n for n, name in enumerate(roads, 1)}
        self.after = {road.after: road.name for road in roads.values() if road.after}
        self.things = 0

    def map_text(self) -> str:
        head = '<header revMajor="1" revMinor="7" name="scene" version="1"/>'
        roads = "".join(map(self.road_element, self.roads.values()))
        return (
            f'<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE>{head}{roads}{self.junction_elements()}</OpenDRIVE>\n'
        )

    def road_element(self, road: Road) -> str:
        plan, pose, s = "", road.start, 0.0
        for piece in road.pieces:
            if piece.curve:
                bu, cu, du, bv, cv, dv = piece.curve
                m = self.hand
                cubic = (
                    f'aU="0" bU="{bu!r}" cU="{cu!r}" dU="{du!r}" aV="0" bV="{m * bv!r}" cV="{m * cv!r}" dV="{m * dv!r}"'
                )
                shape = f'<paramPoly3 pRange="normalized" {cubic}/>'
            else:
                shape = f'<arc curvature="{self.hand * piece.curvature!r}"/>' if piece.curvature else "<line/>"
            place = f'x="{pose.x!r}" y="{self.hand * pose.y!r}" hdg="{self.hand * pose.heading!r}"'
            plan += f'<geometry s="{s!r}" {place} length="{piece.length!r}">{shape}</geometry>'
            x, y, heading = (float(v) for v in road.poses_at(np.array(s + piece.length)))
            pose, s = type(pose)(x, y, heading), s + piece.length
        kinds = "".join(self.type_element(road, at, limit) for at, limit in road.limits or [(0.0, "")])
        junction = road.turn.junction if road.turn else -1
        objects = "".join(self.object_element(road, thing) for thing in road.things)
        signals = "".join(self.signal_element(thing) for thing in road.things)
        return (
            f'<road name={quoteattr(road.name)} id="{self.numbers[road.name]}" length="{road.length!r}" junction="{junction}" '
            f'rule="{"LHT" if self.hand < 0 else "RHT"}"><link>{self.link_elements(road)}</link>{kinds}<planView>{plan}</planView>'
            f"<elevationProfile>{self.elevation_elements(road)}</elevationProfile><lateralProfile/><lanes>{self.section_elements(road)}</lanes>"
            f"<objects>{objects}</objects><signals>{signals}</signals></road>"
        )

    @staticmethod
    def type_element(road: Road, at: float, limit: str) -> str:
        value, _, unit = (limit, "", "") if limit == "no limit" else limit.partition(" ")
        speed = f'<speed max="{value}" unit="{unit}"/>' if unit else f'<speed max="{value}"/>' if value else ""
        return f'<type s="{at!r}" type="{road.kind}">{speed}</type>'

    @staticmethod
    def elevation_elements(road: Road) -> str:
        heights = list(road.heights)
        slopes = [(z1 - z0) / (s1 - s0) for (s0, z0), (s1, z1) in pairwise(heights)]
        rows = zip(heights, [*slopes, 0.0], strict=True)
        return "".join(f'<elevation s="{s!r}" a="{z!r}" b="{slope!r}" c="0" d="0"/>' for (s, z), slope in rows)

    def section_elements(self, road: Road) -> str:
        starts = road.section_starts()
        there = [[lane for lane in road.lanes if lane.start <= s < lane.end] for s in starts]
        numbers = [_numbers_without_gaps(lanes) for lanes in there]
        text = ""
        for n, (s, lanes) in enumerate(zip(starts, there, strict=True)):
            end = starts[n + 1] if n + 1 < len(starts) else road.length
            before = numbers[n - 1] if n else self.lane_numbers_beyond_end(road, "predecessor")
            behind = numbers[n + 1] if n + 1 < len(starts) else self.lane_numbers_beyond_end(road, "successor")
            sides: dict[int, list[tuple[int, str]]] = {1: [], -1: []}
            for lane in lanes:
                number = numbers[n][lane.number]
                links = (("predecessor", before.get(lane.number)), ("successor", behind.get(lane.number)))
                link = "".join(f'<{end_} id="{-self.hand * neighbour}"/>' for end_, neighbour in links if neighbour)
                lane_id = -self.hand * number
                sides[1 if lane_id > 0 else -1].append((lane_id, self.lane_element(lane, lane_id, link, (s, end))))
            left, right = ("".join(text for _, text in sorted(sides[side], reverse=True)) for side in (1, -1))
            middle = self.mark_elements([(at, self.mirrored_mark(mark)) for at, mark in road.middle], (s, end))
            text += f'<laneSection s="{s!r}">' + (f"<left>{left}</left>" if left else "")
            text += f'<center><lane id="0" type="none" level="false">{middle}</lane></center>'
            text += (f"<right>{right}</right>" if right else "") + "</laneSection>"
        return text

    def mirrored_mark(self, mark: str) -> str:
        """Return the mark of the road's middle; the parts of a double mark are listed from left to right, so mirroring swaps them."""
        return mark if self.hand > 0 else " ".join(reversed(mark.split()))

    def lane_element(self, lane: Lane, lane_id: int, link: str, span: tuple[float, float]) -> str:
        width = f'<width sOffset="0" a="{lane.width!r}" b="0" c="0" d="0"/>'
        marks = self.mark_elements(lane.marks, span)
        return f'<lane id="{lane_id}" type="{lane.kind}" level="false"><link>{link}</link>{width}{marks}</lane>'

    @staticmethod
    def mark_elements(marks: Sequence[tuple[float, str]], span: tuple[float, float]) -> str:
        begin, end = span
        first = max((n for n, (at, _) in enumerate(marks) if at <= begin), default=0)
        return "".join(
            f'<roadMark sOffset="{max(at - begin, 0.0)!r}" type="{mark}" weight="standard" color="white" width="0.12"/>'
            for at, mark in marks[first:]
            if at < end
        )

    def lane_numbers_beyond_end(self, road: Road, end: str) -> dict[int, int]:
        """Return lane number -> number, in the neighbouring road, of the lane that continues it beyond `end`."""
        if road.turn:
            turn = road.turn
            return {1: turn.from_lane if end == "predecessor" else turn.to_lane}
        name = road.after if end == "predecessor" else self.after.get(road.name)
        if name is None:
            return {}
        road_beyond = self.roads[name]
        station = road_beyond.length - 1e-6 if end == "predecessor" else 0.0
        return _numbers_without_gaps([lane for lane in road_beyond.lanes if lane.start <= station < lane.end])

    def link_elements(self, road: Road) -> str:
        if turn := road.turn:
            from_end = "end" if turn.from_lane > 0 else "start"
            to_end = "start" if turn.to_lane > 0 else "end"
            return self.road_link_element("predecessor", turn.from_road, from_end) + self.road_link_element(
                "successor", turn.to_road, to_end
            )
        text = ""
        for end, road_beyond, contact in (
            ("predecessor", road.after, "end"),
            ("successor", self.after.get(road.name), "start"),
        ):
            if road_beyond:
                text += self.road_link_element(end, road_beyond, contact)
            elif junction := self.junction_at(road, end):
                text += f'<{end} elementType="junction" elementId="{junction}"/>'
        return text

    def road_link_element(self, end: str, name: str, contact: str) -> str:
        return f'<{end} elementType="road" elementId="{self.numbers[name]}" contactPoint="{contact}"/>'

    def roads_with_turns(self) -> Iterable[tuple[Road, Turn]]:
        return [(road, road.turn) for road in self.roads.values() if road.turn]

    def junction_at(self, road: Road, end: str) -> int | None:
        leaving = 1 if end == "successor" else -1
        for _, turn in self.roads_with_turns():
            if (turn.from_road == road.name and turn.from_lane * leaving > 0) or (
                turn.to_road == road.name and turn.to_lane * leaving < 0
            ):
                return turn.junction
        return None

    def junction_elements(self) -> str:
        connections: dict[int, str] = defaultdict(str)
        for n, (road, turn) in enumerate(self.roads_with_turns()):
            link = f'<laneLink from="{-self.hand * turn.from_lane}" to="{-self.hand}"/>'
            ends = f'incomingRoad="{self.numbers[turn.from_road]}" connectingRoad="{self.numbers[road.name]}" contactPoint="start"'
            connections[turn.junction] += f'<connection id="{n}" {ends}>{link}</connection>'
        return "".join(
            f'<junction id="{number}" name="junction">{text}</junction>' for number, text in connections.items()
        )

    def new_id(self) -> int:
        self.things += 1
        return 5000 + self.things

    def signal_element(self, thing: RoadThing) -> str:
        word, _, rest = thing.kind.partition(" ")
        if word == "light":
            number, (country, code), dynamic = rest, _LIGHT_COUNTRY_AND_CODE, "yes"
        elif word == "sign":
            country, _, code = rest.partition(" ") if " " in rest else ("", "", _NO_CODE)
            number, dynamic = str(self.new_id()), "no"
        else:
            return ""
        name = rest if code == _NO_CODE else code
        lanes = "".join(
            f'<validity fromLane="{-self.hand * lane}" toLane="{-self.hand * lane}"/>' for lane in thing.lanes or ()
        )
        return (
            f'<signal id={quoteattr(number)} name={quoteattr(name)} s="{thing.at!r}" t="{self.hand * thing.off!r}" dynamic="{dynamic}" '
            f'orientation="{_ORIENTATIONS[thing.facing]}" zOffset="2" country={quoteattr(country)} type={quoteattr(code)} subtype="-1" '
            f'value="-1" height="1" width="1">{lanes}</signal>'
        )

    def object_element(self, road: Road, thing: RoadThing) -> str:
        if thing.kind.startswith(("light ", "sign ")):
            return ""
        number = self.new_id()
        if thing.kind == "stop line":
            width = 3.5 if thing.width is None else thing.width
            box = f'length="0.3" width="{width!r}" height="0" hdg="0" pitch="0" roll="0"'
            return (
                f'<object type="stopLine" id="{number}" name="stopLine" s="{thing.at!r}" t="{self.hand * thing.off!r}" zOffset="0" '
                f'orientation="{_ORIENTATIONS[thing.facing]}" {box}/>'
            )
        width = _symmetric_width_without_sidewalks_m(road) if thing.width is None else thing.width
        deep, off = thing.deep / 2, self.hand * thing.off
        corners = [(-deep, -width / 2), (-deep, width / 2), (deep, width / 2), (deep, -width / 2)]
        outline = "".join(
            f'<cornerRoad s="{thing.at + ds!r}" t="{off + dt!r}" dz="0" height="0" id="{n}"/>'
            for n, (ds, dt) in enumerate(corners)
        )
        return (
            f'<object type="crosswalk" id="{number}" name={quoteattr(thing.kind)} s="{thing.at!r}" t="{off!r}" zOffset="0" '
            f'orientation="none" hdg="0" pitch="0" roll="0" length="{thing.deep!r}" width="{width!r}" height="0"><outlines>'
            f'<outline id="0" closed="true">{outline}</outline></outlines></object>'
        )


def _symmetric_width_without_sidewalks_m(road: Road) -> float:
    """Return twice the width of the wider side of the road, without sidewalks."""
    halves = [
        sum(lane.width for lane in road.lanes if lane.number * side > 0 and lane.kind != "sidewalk") for side in (1, -1)
    ]
    return 2 * max(halves) if all(halves) else sum(halves) * 2


def _numbers_without_gaps(lanes: Sequence[Lane]) -> dict[int, int]:
    """Return lane number -> number without gaps among the given lanes: 1, 2, ... or -1, -2, ... from the middle outwards."""
    number_by_lane: dict[int, int] = {}
    for side in (1, -1):
        numbers = sorted((lane.number for lane in lanes if lane.number * side > 0), key=abs)
        number_by_lane |= {number: side * n for n, number in enumerate(numbers, 1)}
    return number_by_lane
