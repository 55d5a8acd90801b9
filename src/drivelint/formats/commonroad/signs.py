"""Signs, lights and stop lines of a CommonRoad map: their kinds, the lanelets that refer to them, and their limits.

A sign or light applies to the lanelets that refer to it, on their whole length. Codes of signs depend on the country: commonroad-io lists
MUTCD codes for the USA, codes of Spanish law for Spain, and StVO numbers for Germany and, as a stand-in, for every other country.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from drivelint.formats import safe_xml
from drivelint.road.boundary_lanes import signal_row
from drivelint.road.lane_geometry import LARGEST_COORDINATE_M
from drivelint.road.sign_conditions import KINDS_WITH_UNREAD_CONDITIONS, add_unread_condition
from drivelint.road.signcodes import signal_kind, turns_of_light_direction

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from lxml import etree

    from drivelint.arrays import Floats
    from drivelint.road.boundary_lanes import BoundedLane
    from drivelint.road.quality import MapQuality
    from drivelint.road.tables import Rows


_CATALOGUE_BY_COUNTRY = {"USA": "us", "ESP": "es"}  # codes of other countries: StVO numbers
_LIGHT_CODE = "1000001"
_LIMIT_KINDS = frozenset({"speed_limit", "speed_zone"})
_KINDS_AT_LANE_END = frozenset({"traffic_light", "stop", "give_way"})  # these hold where the traffic of a lanelet waits
_SPEED_KINDS = _LIMIT_KINDS | {"minimum_speed"}
_STVO_NUMBER = re.compile(r"1?\d{3}(\.\d)?(-\d+)?")  # an StVO number: all those that limit the speed are known
_MAX_CREDIBLE_SPEED_LIMIT_MPS = 45.0  # 160 km/h: no sign allows more, so a greater number is not in m/s
# additional plates that give a direction or a reason; other plates restrict the sign above them
_UNRESTRICTIVE_PLATES = frozenset({"1000", "1002", "1006", "1007", "1010", "1012"})


class SignElement(NamedTuple):
    """One of the signs on a post, with the first number on it."""

    code: str
    kind: str | None
    value: float | None


@dataclass
class MapSigns:
    """The signs of a map by their id; unreadable parts are rows of `quality`.

    `codes`: the catalogue of their codes, as in `traffic_signal`.
    """

    country: str
    codes: str
    quality: MapQuality
    elements: dict[str, list[SignElement]] = field(default_factory=dict)

    def speed_limit(self, lanelet: etree._Element) -> tuple[float | None, str]:
        """Return the lowest limit in m/s of a lanelet's signs and of the lanelet itself (2018b), and its source, sign or lane.

        None: the map gives no certain limit. If a lower limit holds only under the condition of a plate, the limit is not certain.
        """
        own_limit = _finite_number(lanelet.findtext("speedLimit"))
        if own_limit is not None and (trouble := _why_implausible(own_limit)):
            name = lanelet.get("id")
            self.quality.add("invalid_speed", "warning", name, f"the limit of lanelet {name} is not used: {trouble}")
            own_limit = None
        sure = [own_limit] if own_limit is not None else []
        perhaps: list[float] = []
        for ref in referenced_ids(lanelet, "trafficSignRef"):
            on_post = self.elements.get(ref, [])
            limits = [
                e.value
                for e in on_post
                if e.kind in _LIMIT_KINDS and e.value is not None and not _why_implausible(e.value)
            ]
            (perhaps if any(_is_restrictive_plate(e) for e in on_post) else sure).extend(limits)
        least = min(sure, default=None)
        if perhaps and (least is None or min(perhaps) < least):
            least = None
        return least, "lane" if least is not None and least == own_limit else "sign"

    def report_problems(self, lanelets: Sequence[etree._Element], light_ids: Iterable[str]) -> None:
        """Report signs that are not read, references to missing signs or lights, and signs or lights without a lanelet."""
        self._report_unknown_codes()
        self._report_unusable_limits()
        known_ids = {*self.elements, *light_ids}
        lacking = Counter(ref for lanelet in lanelets for ref in signal_refs(lanelet) if ref not in known_ids)
        if lacking:
            message = f"lanelets refer to signs or lights that the map does not contain: {_counts_text(lacking)}"
            self.quality.add("missing_signal", "warning", None, message, lacking.total())
        refs = {ref for lanelet in lanelets for ref in signal_refs(lanelet)}
        if idle := sorted(known_ids - refs):
            message = f"signs and lights to which no lanelet refers apply to no lane: {', '.join(idle)}"
            self.quality.add("signal_without_lane", "info", None, message, len(idle))

    def _report_unknown_codes(self) -> None:
        unread = [e for on_post in self.elements.values() for e in on_post if e.kind is None]
        numbered = Counter(e.code for e in unread if e.value is not None and not _STVO_NUMBER.fullmatch(e.code))
        plain = Counter(e.code for e in unread) - numbered
        if numbered:
            message = (
                f"signs with a number and a code that is not known ({self.country}): {_counts_text(numbered)}: "
                "whether they limit the speed is not known"
            )
            self.quality.add("unknown_sign", "warning", None, message, numbered.total())
        if plain:
            message = f"signs that no rule reads ({self.country}): {_counts_text(plain)}"
            self.quality.add("unknown_sign", "info", None, message, plain.total())

    def _report_unusable_limits(self) -> None:
        for name, on_post in self.elements.items():
            for element in on_post:
                if element.kind not in _LIMIT_KINDS:
                    continue
                trouble = "it has no number" if element.value is None else _why_implausible(element.value)
                if trouble is None and any(_is_restrictive_plate(e) for e in on_post):
                    trouble = f"it applies only as its plates state ({', '.join(e.code for e in on_post if _is_restrictive_plate(e))})"
                if trouble:
                    self.quality.add(
                        "invalid_speed", "warning", None, f"the limit of sign {name} is not used: {trouble}"
                    )


def read_signs(root: etree._Element, country: str, quality: MapQuality) -> MapSigns:
    """Return the signs of a map. `country`: the country in its name, by ISO 3166 (three letters)."""
    signs = MapSigns(country or "no country", _CATALOGUE_BY_COUNTRY.get(country, "de"), quality)
    for sign in root.findall("trafficSign"):
        on_post = []
        for part in sign.findall("trafficSignElement"):
            code = (part.findtext("trafficSignID") or "").strip()
            values = [_finite_number(v.text) for v in part.findall("additionalValue")]
            kind = signal_kind(signs.codes, code, "") or signal_kind("de", code, "")
            on_post.append(SignElement(code, kind, next((v for v in values if v is not None), None)))
        signs.elements[sign.get("id", "")] = on_post
    return signs


def referenced_ids(element: etree._Element, name: str) -> list[str]:
    """Return the ids to which an element's children of this name refer, in their order."""
    return [ref for child in element.findall(name) if (ref := child.get("ref")) is not None]


def signal_refs(lanelet: etree._Element) -> list[str]:
    """Return the ids of the signs and lights to which a lanelet or its stop line refers."""
    return list(
        dict.fromkeys(
            ref for element in (lanelet, *lanelet.findall("stopLine")) for ref in _signal_refs_of_element(element)
        )
    )


def _signal_refs_of_element(element: etree._Element) -> list[str]:
    return referenced_ids(element, "trafficSignRef") + referenced_ids(element, "trafficLightRef")


def signal_rows(
    root: etree._Element,
    signs: MapSigns,
    lanes: Sequence[BoundedLane],
    offset: tuple[float, float],
    stop_line_s_m: Mapping[str, float],
) -> Rows:
    """Return rows of `traffic_signal`: one for each pair of a sign or light and a lanelet that refers to it.

    A stop or give-way sign holds at the lanelet's stop line if the line refers to it. A light always holds at the stop line or, without a
    line, at the lanelet's end: its own place may be beyond the junction. `stop_line_s_m`: lanelet -> station of its stop line.
    """
    by_id = {lane.lanelet_id: lane for lane in lanes}
    holds: dict[str, list[tuple[BoundedLane, float | None]]] = {}
    for lanelet in root.findall("lanelet"):
        lane = by_id.get(lanelet.get("id", ""))
        if lane is None:
            continue
        at_line = {ref for line in lanelet.findall("stopLine") for ref in _signal_refs_of_element(line)}
        at_line |= set(referenced_ids(lanelet, "trafficLightRef"))
        for ref in signal_refs(lanelet):
            holds.setdefault(ref, []).append((lane, stop_line_s_m.get(lane.lanelet_id) if ref in at_line else None))
    rows = []
    for element in [*root.findall("trafficSign"), *root.findall("trafficLight")]:
        light = element.tag == "trafficLight"
        name = element.get("id", "")
        elements = [SignElement(_LIGHT_CODE, "traffic_light", None)] if light else signs.elements[name]
        place = points(element.find("position"))
        stands = place[0] + offset if len(place) else None
        turns = turns_of_light_direction((element.findtext("direction") or "").strip()) if light else None
        plates = [element_on_post.code for element_on_post in elements if _is_restrictive_plate(element_on_post)]
        for lane, line_s_m in holds.get(name, ()):
            if plates and any(part.kind in KINDS_WITH_UNREAD_CONDITIONS for part in elements):
                add_unread_condition(signs.quality, lane.lanelet_id, f"sign {name}", ", ".join(plates))
            for part in elements:
                s = _signal_station(lane, part.kind, stands, line_s_m)
                unit = "m/s" if part.kind in _SPEED_KINDS and part.value is not None else None
                where = stands if stands is not None else lane.line.centre[-1 if s > lane.line.length / 2 else 0]
                rows.append(signal_row(
                    lane, s, where, signal_id=name, kind=part.kind, country=signs.codes, type=part.code, value=part.value,
                    unit=unit, dynamic=light, turns=turns,
                ))  # fmt: skip
    return sorted(rows, key=lambda r: (r["signal_id"], r["type"], r["lanelet_id"]))


def _signal_station(lane: BoundedLane, kind: str | None, sign_place: Floats | None, line_s_m: float | None) -> float:
    """Return the station on a lanelet from which a sign or light applies: the stop line, its own position, or an end of the lanelet."""
    if kind in _KINDS_AT_LANE_END and line_s_m is not None:
        return line_s_m
    if kind == "traffic_light":
        return lane.line.length
    if sign_place is not None:
        return lane.line.station(sign_place)
    return lane.line.length if kind in _KINDS_AT_LANE_END else 0.0


def stop_line_stations(
    root: etree._Element, lanes: Sequence[BoundedLane], offset: tuple[float, float]
) -> dict[str, float]:
    """Return lanelet -> station of its stop line: the mean of the line's points, else the lanelet's end."""
    by_id = {lane.lanelet_id: lane for lane in lanes}
    station_by_lanelet = {}
    for lanelet in root.findall("lanelet"):
        line, lane = lanelet.find("stopLine"), by_id.get(lanelet.get("id", ""))
        if line is None or lane is None:
            continue
        place = points(line)
        s = shapely.line_locate_point(shapely.LineString(lane.line.centre), shapely.points(place + offset))
        station_by_lanelet[lane.lanelet_id] = float(np.mean(s)) if len(place) else lane.line.length
    return station_by_lanelet


def points(parent: etree._Element | None) -> Floats:
    """Return the points (n, 2) below an element. Errors: `ValueError` with the line of a point without possible x and y."""
    elements = [] if parent is None else list(parent.iterfind(".//point"))
    xy = np.array([[safe_xml.number_or_nan(p.findtext(axis)) for axis in "xy"] for p in elements], np.float64).reshape(
        -1, 2
    )
    bad = np.flatnonzero(~(np.abs(xy) < LARGEST_COORDINATE_M).all(axis=1))
    if len(bad):
        raise ValueError(f"the point in line {elements[bad[0]].sourceline} has impossible values of x and y")
    return xy


def _finite_number(text: str | None) -> float | None:
    value = safe_xml.number_or_nan(text)
    return value if math.isfinite(value) else None


def _why_implausible(limit_mps: float) -> str | None:
    """Return why a number cannot be a speed limit in m/s, or None if it can."""
    if limit_mps <= 0:
        return f"{limit_mps:g} m/s is not a speed limit"
    if limit_mps > _MAX_CREDIBLE_SPEED_LIMIT_MPS:
        return f"{limit_mps:g} m/s is more than any sign allows: the value may be in km/h"
    return None


def _is_restrictive_plate(element: SignElement) -> bool:
    """Return whether an additional plate (StVO, 1000 to 1099) restricts the time, place or vehicles of the sign above it."""
    number = element.code.partition("-")[0]
    return element.kind is None and bool(re.fullmatch(r"10\d\d", number)) and number not in _UNRESTRICTIVE_PLATES


def _counts_text(code_counts: Counter[str]) -> str:
    return ", ".join(f"{code or 'no code'} ({n})" for code, n in sorted(code_counts.items()))
