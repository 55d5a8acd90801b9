"""CommonRoad scenarios (XML, 2018b and 2020a): their lanelets, signs, lights and stop lines.

Read with lxml: commonroad-io pins a protobuf of 2022, which cannot be installed beside today's.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from drivelint import markup
from drivelint.errors import MapError
from drivelint.maps.bounded import BoundedLane, build, crossings, side_driven_on, tables
from drivelint.maps.contract import Environment, MapSource, Request, environment_id
from drivelint.maps.quality import Quality
from drivelint.maps.signcodes import kind_of, turns_in_direction
from drivelint.maps.tables import from_rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lxml import etree
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_KINDS = {
    "sidewalk": "sidewalk", "busLane": "bus", "bicycleLane": "biking", "exitRamp": "exit", "accessRamp": "entry",
    "shoulder": "shoulder", "border": "border", "parking": "parking", "restricted": "restricted",
}  # fmt: skip
_NOT_DRIVEN = frozenset({"sidewalk", "biking", "shoulder", "border", "parking", "restricted"})
_ROADS = {"interstate": "motorway", "highway": "motorway", "country": "rural", "urban": "town"}
_MARKINGS = {
    "solid": "solid", "broad_solid": "solid", "dashed": "broken", "broad_dashed": "broken", "curb": "curb",
    "lowered_curb": "curb", "solid_solid": "solid_solid", "dashed_dashed": "broken_broken", "no_marking": "none",
}  # fmt: skip
"""Our words; of a mixed double line the file does not say which side is nearer: not known."""
_LEFT_DRIVEN = frozenset({
    "AUS", "BGD", "CYP", "GBR", "HKG", "IDN", "IND", "IRL", "JPN", "KEN", "LKA", "MLT", "MYS", "NPL", "NZL", "PAK", "SGP",
    "THA", "TZA", "UGA", "ZAF", "ZMB", "ZWE",
})  # fmt: skip


class CommonRoadReader:
    """CommonRoad XML."""

    format = "commonroad"

    def read(self, source: MapSource, request: Request) -> Environment:
        """Return the map's tables; `MapError` where the file is not XML or has no lanelet that can be built."""
        try:
            root = markup.parse(source.content)
        except markup.RefusedError as error:
            raise MapError(f"map {source.name} {error}") from None
        quality = Quality()
        signs = _signs(root)
        read: list[BoundedLane] = []
        walks: list[BoundedLane] = []
        for element in root.findall("lanelet"):
            try:
                kinds = [t.text or "" for t in element.findall("laneletType")]
                (walks if "crosswalk" in kinds else read).append(_lane(element, kinds, signs))
            except (ValueError, KeyError) as error:
                name = element.get("id") or f"in line {element.sourceline}"
                quality.add("invalid_lane", "error", name, f"lanelet {name} is left out: {error}")
        _junctions(root, read)
        lanes = build(read, request.offset, quality)
        if not lanes:
            first = next((row["message"] for row in quality.rows), "it has no <lanelet>")
            raise MapError(f"map {source.name} has no lane that can be built: {first}")
        handedness, how = _handedness(root, lanes, request, quality)
        name = environment_id(source, request.offset, handedness, guessed=how == "default")
        result = tables(name, lanes)
        rows: dict[str, list[dict[str, Any]]] = {
            "environment": [_environment(source, request, handedness, how)],
            "traffic_signal": _signals(root, lanes, request.offset),
            "stop_line": _stop_lines(root, lanes, request.offset),
            "road_object": [],
            "crossing": crossings(walks, lanes, request.offset),
        }
        result |= {table: from_rows(table, name, content) for table, content in rows.items()}
        result["map_quality"] = quality.table(name)
        return Environment(name, handedness, how, result)


def _environment(source: MapSource, request: Request, handedness: str, how: str) -> dict[str, object]:
    return {
        "name": source.name, "sha256": source.sha256, "format": CommonRoadReader.format,
        "offset_x_m": request.offset[0], "offset_y_m": request.offset[1],
        "handedness": handedness, "handedness_source": how, "geo_reference": None,
    }  # fmt: skip


def _points(parent: etree._Element | None) -> Floats:
    """Return the points (n, 2) below an element. Errors: `ValueError` where one is not two finite numbers."""
    found = [] if parent is None else [(p.findtext("x"), p.findtext("y")) for p in parent.iterfind(".//point")]
    points = np.array([(float(x or "nan"), float(y or "nan")) for x, y in found], np.float64).reshape(-1, 2)
    if not np.isfinite(points).all():
        raise ValueError("a point without finite coordinates")
    return points


def _refs(element: etree._Element, name: str) -> list[str]:
    return [ref for child in element.findall(name) if (ref := child.get("ref")) is not None]


def _lane(
    element: etree._Element, kinds: Sequence[str], signs: dict[str, list[tuple[str, float | None]]]
) -> BoundedLane:
    kind = next((_KINDS[k] for k in kinds if k in _KINDS), "driving")
    limits = [
        value
        for ref in _refs(element, "trafficSignRef")
        for code, value in signs.get(ref, ())
        if code == "274" and value
    ]
    left, right = element.find("leftBound"), element.find("rightBound")
    lane = BoundedLane(
        str(element.attrib["id"]), _points(left), _points(right), kind, kind not in _NOT_DRIVEN,
        bidirectional=len(element.findall("userOneWay")) == 0 and len(element.findall("userBidirectional")) > 0,
        road_type=next((_ROADS[k] for k in kinds if k in _ROADS), None),
        successors=tuple(_refs(element, "successor")),
        left_marking=_marking(left), right_marking=_marking(right),
        limit_mps=min(limits) if limits else None, limit_known=bool(limits),
    )  # fmt: skip
    for side in ("Left", "Right"):
        beside = element.find(f"adjacent{side}")
        if beside is not None:
            against = beside.get("drivingDir") != "same"
            if side == "Left":
                lane.left_id, lane.left_against = beside.get("ref"), against
            else:
                lane.right_id, lane.right_against = beside.get("ref"), against
    return lane


def _marking(bound: etree._Element | None) -> str | None:
    said = None if bound is None else bound.findtext("lineMarking")
    return _MARKINGS.get(said or "")


def _signs(root: etree._Element) -> dict[str, list[tuple[str, float | None]]]:
    """Return sign id -> (code, value) of its elements; the value of a limit is in m/s."""
    found: dict[str, list[tuple[str, float | None]]] = {}
    for sign in root.findall("trafficSign"):
        parts = []
        for part in sign.findall("trafficSignElement"):
            value = part.findtext("additionalValue")
            parts.append(((part.findtext("trafficSignID") or "").strip(), _number(value)))
        found[sign.get("id", "")] = parts
    return found


def _number(text: str | None) -> float | None:
    try:
        value = float(text or "nan")
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _junctions(root: etree._Element, lanes: Sequence[BoundedLane]) -> None:
    """Mark what lies inside an intersection: the successors that it names, and lanelets of that type between its ways in."""
    inside: dict[str, str] = {}
    for crossing in root.findall("intersection"):
        for way in crossing.findall("incoming"):
            for name in ("successorsLeft", "successorsStraight", "successorsRight"):
                inside.update(dict.fromkeys(_refs(way, name), crossing.get("id", "")))
    ends = {to for lane in lanes for to in lane.successors}
    for lane in lanes:
        if lane.lanelet_id in inside and lane.lanelet_id in ends:
            lane.junction_id = inside[lane.lanelet_id]


def _handedness(
    root: etree._Element, lanes: Sequence[BoundedLane], request: Request, quality: Quality
) -> tuple[str, str]:
    """Return the side driven on and how it was found: option, lanes beside each other, country, default."""
    country = (root.get("benchmarkID") or "").removeprefix("C-")[:3].upper()
    by_country = None if country in {"", "ZAM", "TES"} else "lht" if country in _LEFT_DRIVEN else "rht"
    said = [
        (how, side)
        for how, side in (
            ("option", None if request.handedness == "auto" else request.handedness),
            ("lanes", side_driven_on(lanes)),
            ("attribute", by_country),
        )
        if side is not None
    ]
    if len({side for _, side in said}) > 1:
        opinions = ", ".join(f"{how}: {side}" for how, side in said)
        quality.add(
            "handedness_disagrees", "warning", None, f"{opinions}; the first is taken: give --handedness if it is wrong"
        )
    if not said:
        message = "nothing in the map says which side is driven on: right-hand traffic is a guess; give --handedness"
        quality.add("handedness_default", "warning", None, message)
        return "rht", "default"
    return said[0][1], said[0][0]


def _signals(root: etree._Element, lanes: Sequence[BoundedLane], offset: tuple[float, float]) -> list[dict[str, Any]]:
    """Return a row for each lanelet that refers to a sign or light."""
    holds: dict[str, list[BoundedLane]] = {}
    refs: dict[str, list[str]] = {}
    for element in root.findall("lanelet"):
        refs[element.get("id", "")] = _refs(element, "trafficSignRef") + _refs(element, "trafficLightRef")
    for lane in lanes:
        for ref in refs.get(lane.lanelet_id, ()):
            holds.setdefault(ref, []).append(lane)
    rows = []
    for element in [*root.findall("trafficSign"), *root.findall("trafficLight")]:
        light = element.tag == "trafficLight"
        codes = (
            ["1000001"]
            if light
            else [part.findtext("trafficSignID") or "" for part in element.findall("trafficSignElement")]
        )
        said = [_number(part.text) for part in element.iterfind(".//additionalValue")]
        value = next((v for v in said if v), None)
        stands = _points(element.find("position"))
        turns = turns_in_direction((element.findtext("direction") or "").strip()) if light else None
        for lane in holds.get(element.get("id", ""), ()):
            end = float(lane.line.s[-1])
            where = stands[0] + offset if len(stands) else lane.line.centre[-1]
            s = (
                float(shapely.line_locate_point(shapely.LineString(lane.line.centre), shapely.Point(where)))
                if len(stands)
                else end
            )
            rows += [
                {
                    "signal_id": element.get("id", ""), "kind": kind_of("de", code.strip(), ""), "country": "de",
                    "type": code.strip(), "subtype": None, "value": value, "unit": "m/s" if value is not None else None,
                    "dynamic": light, "turns": turns, "road_id": lane.road_id, "road_s_m": s if lane.along > 0 else end - s,
                    "lanelet_id": lane.lanelet_id, "lane_s_m": s, "x_m": float(where[0]), "y_m": float(where[1]),
                }
                for code in codes
            ]  # fmt: skip
    return sorted(rows, key=lambda r: (r["signal_id"], r["type"], r["lanelet_id"]))


def _stop_lines(
    root: etree._Element, lanes: Sequence[BoundedLane], offset: tuple[float, float]
) -> list[dict[str, Any]]:
    by_id = {lane.lanelet_id: lane for lane in lanes}
    rows = []
    for element in root.findall("lanelet"):
        line, lane = element.find("stopLine"), by_id.get(element.get("id", ""))
        if line is None or lane is None:
            continue
        points = _points(line)
        s = float(lane.line.s[-1])
        if len(points):  # without points it lies at the lanelet's end
            s = float(
                np.mean(
                    shapely.line_locate_point(shapely.LineString(lane.line.centre), shapely.points(points + offset))
                )
            )
        rows.append(
            {
                "stop_line_id": f"{lane.lanelet_id}.stop",
                "lanelet_id": lane.lanelet_id,
                "lane_s_m": s,
                "source": "object",
            }
        )
    return sorted(rows, key=lambda r: r["stop_line_id"])
