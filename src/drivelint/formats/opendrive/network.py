"""The road network as the file records it: roads, lane sections, lanes, junctions. No geometry is evaluated here."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from drivelint.formats.opendrive.access import lane_type_and_unread
from drivelint.formats.opendrive.junctions import END, START, connections, cross_paths
from drivelint.formats.opendrive.planview import Cubics, PlanView, cubics, planview
from drivelint.formats.opendrive.roadtypes import road_types, type_stretches
from drivelint.formats.opendrive.xml import MalformedError, integer_attribute, number_attribute, required_attribute
from drivelint.road.countries import only_nation
from drivelint.road.geo_reference import GeoFrame

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from lxml import etree

    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.junctions import Connection, CrossPath
    from drivelint.formats.opendrive.roadtypes import RoadType
    from drivelint.road.quality import MapQuality

MAX_ROAD_LENGTH_M = 1e6  # a longer road is a unit mistake, and would be millions of points
DYNAMIC_TYPE, DYNAMIC_DIRECTION = "dynamicLaneType", "dynamicLaneDirection"

# Types of lanes on which motor vehicles may drive (ASAM OpenDRIVE e_laneType, with the names of older versions). Not
# among them: the hard shoulder ("stop"), parking, biking, tram and everything beside the carriageway.
DRIVABLE_LANE_TYPES = frozenset({
    "driving", "entry", "exit", "onRamp", "offRamp", "connectingRamp", "slipLane", "bidirectional",
    "bus", "taxi", "HOV", "carpool", "shared", "mwyEntry", "mwyExit",
})  # fmt: skip


@dataclass(frozen=True)
class RoadMark:
    """A road mark from `start_m` (road station) to the start of the next mark."""

    start_m: float
    marking: str | None
    color: str | None
    lane_change: str | None


@dataclass(frozen=True)
class SpeedLimit:
    """A limit from `start_m` (road station) to the start of the next limit; `limit_mps` None: no limit.

    `is_stated` False: the file states no limit; `readable` False: the file states a limit that cannot be read.
    """

    start_m: float
    limit_mps: float | None
    is_stated: bool
    readable: bool = True


@dataclass(frozen=True, eq=False)
class Lane:
    """One lane of one section; `invalid` says why it cannot be built."""

    number: int
    kind: str
    predecessors: tuple[int, ...] = ()
    successors: tuple[int, ...] = ()
    widths: Cubics | None = None
    borders: Cubics | None = None
    marks: tuple[RoadMark, ...] = ()
    speeds: tuple[SpeedLimit, ...] = ()
    travel: str | None = None  # RoadRunner's userData: forward, backward, undirected
    direction: str | None = None  # OpenDRIVE 1.8: standard, reversed, both
    is_access_unread: bool = False  # see `lane_type_and_unread`
    varies: tuple[str, ...] = ()  # the attributes by which OpenDRIVE 1.8 states that type or direction may change
    invalid: str | None = None


@dataclass(frozen=True, eq=False)
class LaneSection:
    """Lanes that begin and end together, on one type of road: a lane section or a part of it.

    A part is one side of a section whose sides are divided differently, or the part on one type of road.
    """

    section: int
    start_m: float
    end_m: float
    lanes: tuple[Lane, ...]  # ascending by number, lane 0 left out
    centre_marks: tuple[RoadMark, ...]
    road_type: str | None = None  # None: the file does not state it


@dataclass(frozen=True)
class RoadLink:
    """The road or junction at one end of a road."""

    is_junction: bool
    element_id: str
    contact: str | None  # start or end of the other road; None: not stated


@dataclass(frozen=True, eq=False)
class Road:
    """One road and everything that is needed to build its lanes."""

    road_id: str
    length_m: float  # the part of the stated length that its geometries cover
    stated_length_m: float
    junction_id: str | None
    rule: str | None  # lht, rht
    links: dict[str, RoadLink]  # start or end of this road -> link
    speeds: tuple[SpeedLimit, ...]
    plan: PlanView
    elevation: Cubics
    offset: Cubics
    lane_sections: tuple[LaneSection, ...]
    element: etree._Element = field(repr=False)

    @property
    def lane_keys(self) -> list[tuple[str, int, int]]:
        """Road, section and number of each lane."""
        return [(self.road_id, part.section, lane.number) for part in self.lane_sections for lane in part.lanes]

    def sections_on_side(self, lane_no: int) -> list[LaneSection]:
        """Return the lane sections with lanes on the same side as lane `lane_no`, in order of station."""
        return [s for s in self.lane_sections if any((lane.number > 0) == (lane_no > 0) for lane in s.lanes)]

    def xy_and_heading(self, s: Floats, t: Floats, offset: tuple[float, float]) -> tuple[Floats, Floats, Floats]:
        """Return x, y (m) and the road's heading (rad) at road coordinates, each (n,); `s` is limited to the road."""
        inside = np.clip(s, 0.0, self.length_m)
        order = np.argsort(inside, kind="stable")
        at = np.clip(inside[order], 0.0, max(self.length_m - 1e-6, 0.0))
        line = self.plan.evaluate(inside[order], at)
        back = np.argsort(order, kind="stable")
        x, y = (line.x - line.sin * t[order])[back] + offset[0], (line.y + line.cos * t[order])[back] + offset[1]
        return x, y, np.arctan2(line.sin, line.cos)[back]


@dataclass(frozen=True, eq=False)
class Network:
    """The road network of a file."""

    roads: dict[str, Road]
    connections: tuple[Connection, ...]
    cross_paths: tuple[CrossPath, ...]
    geo: GeoFrame | None
    nation: str | None  # the only country of its roads and signals, as two letters; None: not known


def road_network(root: etree._Element, quality: MapQuality) -> Network:
    """Return the road network of a file; roads that cannot be read are left out and reported in `quality`."""
    roads: dict[str, Road] = {}
    for element in root.findall("road"):
        name = element.get("id") or f"in line {element.sourceline}"
        try:
            road = _road(element, roads, quality)
        except MalformedError as error:
            lanes = sum(1 for lane in element.iterfind("lanes/laneSection//lane") if lane.get("id") != "0")
            message = f"road {name} is left out with its {lanes} lanes: {error}"
            quality.add("invalid_road", "error", name, message, max(lanes, 1))
        else:
            roads[road.road_id] = road
    countries = [element.get("country") for element in root.iterfind("road/type")]
    countries += [element.get("country") for element in root.iterfind("road/signals/signal")]
    return Network(
        roads, tuple(connections(root, quality)), cross_paths(root), _geo_frame(root, quality), only_nation(countries)
    )


def _geo_frame(root: etree._Element, quality: MapQuality) -> GeoFrame | None:
    """Return the geodetic frame of the file's coordinates; None if it is not stated or cannot be read."""
    reference = (root.findtext("header/geoReference") or "").strip()
    offset = root.find("header/offset")
    if not reference:
        return None
    if offset is None:
        return GeoFrame(reference)
    try:
        return GeoFrame(reference, *(number_attribute(offset, name, 0.0) for name in ("x", "y", "z", "hdg")))
    except MalformedError as error:
        quality.add_unusable_geo_reference(reference, error)
        return None


def _road(element: etree._Element, earlier_roads: dict[str, Road], quality: MapQuality) -> Road:
    if element.get("id") in earlier_roads:
        raise MalformedError("another road has the same id")
    if any(lanes.get("layer", "permanent") != "permanent" for lanes in element.findall("lanes")):
        raise MalformedError(
            "it has temporary lanes (a layer of OpenDRIVE 1.9), which are driven on first and are not read"
        )
    length = number_attribute(element, "length")
    if not 0.0 < length <= MAX_ROAD_LENGTH_M:
        raise MalformedError(f"its length is {length:g} m")
    junction = element.get("junction", "-1")
    rule = (element.get("rule") or "").lower()
    plan = planview(element.find("planView"))
    return Road(
        road_id=required_attribute(element, "id"),
        length_m=min(length, plan.end),
        stated_length_m=length,
        junction_id=None if junction in {"-1", ""} else junction,
        rule=rule if rule in {"lht", "rht"} else None,
        links=_road_links(element),
        speeds=_speed_limits(element.findall("type"), "s", 0.0, quality, child="speed"),
        plan=plan,
        elevation=cubics(element.findall("elevationProfile/elevation"), "s"),
        offset=cubics(element.findall("lanes/laneOffset"), "s"),
        lane_sections=_divide_at_road_types(
            _lane_sections(element, min(length, plan.end), quality), road_types(element, quality)
        ),
        element=element,
    )


def _road_links(element: etree._Element) -> dict[str, RoadLink]:
    joins = {}
    for end, name in ((START, "predecessor"), (END, "successor")):
        link = element.find(f"link/{name}")
        if link is not None and (element_id := link.get("elementId")) is not None:
            contact = link.get("contactPoint") if link.get("contactPoint") in {START, END} else None
            joins[end] = RoadLink(link.get("elementType") == "junction", element_id, contact)
    return joins


def _lane_sections(element: etree._Element, length: float, quality: MapQuality) -> tuple[LaneSection, ...]:
    sections = sorted(enumerate(element.findall("lanes/laneSection")), key=lambda item: number_attribute(item[1], "s"))
    if not sections:
        raise MalformedError("it has no <laneSection>")
    lane_sections = []
    ends = {side: _section_ends([s for _, s in sections], side, length) for side in ("left", "right")}
    for index, section in sections:
        if _has_numbers_of_other_side(section):
            quality.count_section_under_wrong_side()
        sides = [side for side in ("left", "right") if section in ends[side]]
        start = number_attribute(section, "s")
        marks = tuple(m for centre in section.findall("center/lane") for m in _road_marks(centre, start, quality))
        together = len({ends[side][section] for side in sides}) == 1
        groups = [sides] if together else [[side] for side in sides]
        for group in groups:
            end = ends[group[0]][section]
            lanes = [
                _lane_or_invalid_lane(lane, start, quality)
                for side in group
                for lane in section.findall(f"{side}/lane")
            ]
            numbers = [lane.number for lane in lanes]
            if len(set(numbers)) < len(numbers):
                raise MalformedError(f"section {index} has the same lane twice")
            lane_sections.append(
                LaneSection(index, start, end, tuple(sorted(lanes, key=lambda lane: lane.number)), marks)
            )
    return tuple(lane_sections)


def _section_ends(sections: list[etree._Element], side: str, length: float) -> dict[etree._Element, float]:
    """Return the end of each section that describes this side of the road; a `singleSide` section may describe only the other side."""
    other_side = "left" if side == "right" else "right"
    of_side = [
        s for s in sections if s.get("singleSide") != "true" or s.find(side) is not None or s.find(other_side) is None
    ]
    ends = [min(number_attribute(s, "s"), length) for s in of_side[1:]] + [length]
    return dict(zip(of_side, ends, strict=True))


def _divide_at_road_types(sections: Sequence[LaneSection], types: Sequence[RoadType]) -> tuple[LaneSection, ...]:
    """Return the lane sections in their order, each with the type of its road.

    The first part of a divided section keeps its number, the others have numbers after the last section of the road. Lanes of one number
    continue each other.
    """
    first_free = 1 + max((section.section for section in sections), default=-1)
    # The two sides of a section may be divided into sections of their own: their parts share numbers.
    number_by_part: dict[tuple[int, float], int] = {}
    parts = []
    for section in sections:
        stretches = type_stretches(types, section.start_m, section.end_m)
        for k, (kind, start, end) in enumerate(stretches):
            number = section.section
            if k > 0:
                number = number_by_part.setdefault((section.section, start), first_free + len(number_by_part))
            is_last = k == len(stretches) - 1
            lanes = tuple(
                replace(
                    lane,
                    predecessors=(lane.number,) if k > 0 else lane.predecessors,
                    successors=lane.successors if is_last else (lane.number,),
                )
                for lane in section.lanes
            )
            parts.append(replace(section, section=number, start_m=start, end_m=end, lanes=lanes, road_type=kind))
    return tuple(parts)


def _lane_or_invalid_lane(element: etree._Element, section_start: float, quality: MapQuality) -> Lane:
    lane_no = integer_attribute(element, "id")
    kind = quality.known_word("lane_type", element.get("type", "none")) or "unknown"
    try:
        return _valid_lane(element, lane_no, kind, section_start, quality)
    except MalformedError as error:
        return Lane(lane_no, kind, invalid=str(error))


def _has_numbers_of_other_side(section: etree._Element) -> bool:
    """Return whether all lanes of a section are listed under one side and have numbers of the other side.

    netconvert 1.28.0 does this for the roads in junctions of its left-hand nets; their lanes lie on the side of their numbers.
    """
    left, right = (
        [integer_attribute(lane, "id") for lane in section.findall(f"{side}/lane")] for side in ("left", "right")
    )
    return bool(left) != bool(right) and all(no < 0 for no in left) and all(no > 0 for no in right)


def _valid_lane(element: etree._Element, lane_no: int, kind: str, section_start: float, quality: MapQuality) -> Lane:
    parent = element.getparent()
    side = "" if parent is None else str(parent.tag)
    fits = (side == "left") == (lane_no > 0)
    section = None if parent is None else parent.getparent()
    if lane_no == 0 or not (fits or (section is not None and _has_numbers_of_other_side(section))):
        raise MalformedError(f"lane {lane_no} is listed on the wrong side, under <{side}>")
    widths, borders = element.findall("width"), element.findall("border")
    if not widths and not borders:
        raise MalformedError("it has neither <width> nor <border>")
    user = next(iter(element.iterfind("userData//vectorLane")), None)
    kind, is_access_unread = lane_type_and_unread(element, kind)
    return Lane(
        number=lane_no,
        kind=kind,
        predecessors=tuple(integer_attribute(e, "id") for e in element.findall("link/predecessor")),
        successors=tuple(integer_attribute(e, "id") for e in element.findall("link/successor")),
        widths=cubics(widths, "sOffset", section_start) if widths else None,
        borders=None if widths else cubics(borders, "sOffset", section_start),
        marks=tuple(_road_marks(element, section_start, quality)),
        speeds=_speed_limits(element.findall("speed"), "sOffset", section_start, quality),
        travel=None if user is None else user.get("travelDir"),
        direction=element.get("direction"),
        is_access_unread=is_access_unread,
        varies=tuple(name for name in (DYNAMIC_TYPE, DYNAMIC_DIRECTION) if element.get(name) in {"true", "1"}),
    )


def _road_marks(lane: etree._Element, section_start: float, quality: MapQuality) -> list[RoadMark]:
    marks = [
        RoadMark(
            section_start + number_attribute(mark, "sOffset", 0.0),
            quality.known_word("marking", "_".join(mark.get("type", "none").split())),
            _known_attribute(mark, "color", "marking_color", quality),
            _known_attribute(mark, "laneChange", "lanes_changed", quality),
        )
        for mark in lane.findall("roadMark")
    ]
    return sorted(marks, key=lambda mark: mark.start_m)


def _known_attribute(mark: etree._Element, name: str, vocabulary: str, quality: MapQuality) -> str | None:
    word = mark.get(name)
    return quality.known_word(vocabulary, word) if word else None


SPEED_UNITS_MPS = {"m/s": 1.0, "km/h": 1.0 / 3.6, "mph": 0.44704}


def _speed_limits(
    elements: Iterable[etree._Element], s_attribute: str, origin: float, quality: MapQuality, child: str | None = None
) -> tuple[SpeedLimit, ...]:
    """Read speed limits. With `child`, the limit is in a child element; an element without it is a record that states no limit."""
    speeds = []
    for element in elements:
        start = origin + number_attribute(element, s_attribute, 0.0)
        speed = element.find(child) if child else element
        word = "undefined" if speed is None else speed.get("max", "undefined").strip().lower()
        if speed is None or word == "undefined":
            speeds.append(SpeedLimit(start, None, is_stated=False))
        elif word in {"no limit", "nolimit", "unlimited"}:
            speeds.append(SpeedLimit(start, None, is_stated=True))
        else:
            limit = _limit_mps(speed)
            posted = None if limit is None else quality.limit_unless_placeholder(limit)
            speeds.append(SpeedLimit(start, posted, is_stated=True, readable=posted is not None))
            if limit is None:
                text = f"{word[:20]} {speed.get('unit', 'm/s')[:20]}"
                message = f"line {speed.sourceline}: {text} is not a speed limit: treated as unknown"
                quality.add("invalid_speed", "warning", None, message)
    return tuple(sorted(speeds, key=lambda s: s.start_m))


def _limit_mps(speed: etree._Element) -> float | None:
    try:
        limit = number_attribute(speed, "max") * SPEED_UNITS_MPS[speed.get("unit", "m/s")]
    except (MalformedError, KeyError):
        return None
    return limit if limit > 0.0 else None
