"""Signs, lights and painted signals: one row for each signal and each lanelet to which it applies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from drivelint.formats.opendrive.semantics import (
    BOARD_TYPES,
    element_with_value,
    is_crossed_out,
    kind_by_semantics,
    restricted_sign_ids,
    signs_on_board,
)
from drivelint.formats.opendrive.xml import MalformedError, integer_attribute, number_attribute
from drivelint.phrases import escape_invisible, name_list
from drivelint.road.quality import SIGNS_UNMAPPED_CHECK
from drivelint.road.sign_conditions import KINDS_WITH_UNREAD_CONDITIONS, add_unread_condition
from drivelint.road.signcodes import has_codes_of, signal_kind, turns_of_light_code
from drivelint.road.tables import Rows, stop_line_row

if TYPE_CHECKING:
    from lxml import etree

    from drivelint.formats.opendrive.lanelet import Lanelet
    from drivelint.formats.opendrive.network import Network, Road
    from drivelint.road.quality import MapQuality

MIN_STOP_LINE_WIDTH_M = 1.0  # the stated width of a stop line shorter than this does not show which lanes it crosses
MIN_SAME_DIRECTION_SHARE = 0.25  # of a stop line's width on lanes of its orientation: less is on opposite lanes
OFF_ROAD_M = 1.0  # a signal further beyond its road's end than this is a mistake worth a warning


def signal_and_stop_line_rows(
    net: Network, lanes: list[Lanelet], offset: tuple[float, float], quality: MapQuality
) -> tuple[Rows, Rows]:
    """Return rows of `traffic_signal`, and rows of `stop_line` for signals that are painted stop lines (StVO 294)."""
    reader = _SignalReader(net, offset, quality)
    for lane in lanes:
        if lane.drivable:
            reader.lanes.setdefault(lane.road.road_id, []).append(lane)
    for road in net.roads.values():
        for listing in road.element.iterfind("signals/*"):
            if listing.tag in {"signal", "signalReference"}:
                reader.read(road, listing)
    reader.report_problems()
    signals = _unique_rows(reader.signals, ("signal_id", "road_id", "road_s_m", "lanelet_id", "type", "subtype"))
    return signals, _unique_rows(reader.stop_lines, ("stop_line_id", "lanelet_id", "lane_s_m"))


def _unique_rows(rows: Rows, key: tuple[str, ...]) -> Rows:
    """Return the rows ordered by their key, each once."""
    row_by_key = {tuple("" if row[k] is None else row[k] for k in key): row for row in rows}
    return [row_by_key[k] for k in sorted(row_by_key)]


class _SignalReader:
    """Collects signals; a signal that cannot be placed is reported in `quality`."""

    def __init__(self, net: Network, offset: tuple[float, float], quality: MapQuality) -> None:
        self.offset, self.quality = offset, quality
        self.lanes: dict[str, list[Lanelet]] = {}  # drivable lanelets by road
        self.defined = {
            signal.get("id", ""): (road, signal)
            for road in net.roads.values()
            for signal in road.element.iterfind("signals/signal")
        }
        self.signs = [
            sign
            for _, signal in self.defined.values()
            if not is_crossed_out(signal)
            for sign in (signal, *signs_on_board(signal))
        ]
        self.restricted_ids = restricted_sign_ids(self.signs, {sign.get("id", ""): _kind(sign) for sign in self.signs})
        self.signals: Rows = []
        self.stop_lines: Rows = []
        self.contradictions: list[str] = []

    def read(self, road: Road, listing: etree._Element) -> None:
        """Read a `<signal>`, or a `<signalReference>` to a signal that is defined elsewhere; a crossed-out signal does not apply."""
        name = listing.get("id", "")
        home, signal = (road, listing) if listing.tag == "signal" else self.defined.get(name, (road, None))
        if signal is not None and is_crossed_out(signal):
            return
        try:
            self._add_signal(road, listing, home, signal)
        except MalformedError as error:
            message = f"{listing.tag} {name} of road {road.road_id} is left out: {error}"
            self.quality.add("invalid_signal", "error", road.road_id, message)

    def _add_signal(self, road: Road, listing: etree._Element, home: Road, signal: etree._Element | None) -> None:
        if signal is None:
            raise MalformedError("it refers to a signal that is not defined")
        listed_s = number_attribute(listing, "s")
        s = min(max(listed_s, 0.0), road.length_m)
        if abs(listed_s - s) > OFF_ROAD_M:
            message = f"signal {listing.get('id')} is listed at {listed_s:.1f} m of a road of {road.length_m:.1f} m"
            self.quality.add("signal_off_road", "warning", road.road_id, message)
        lanes = [lane for lane in self.lanes.get(road.road_id, []) if _contains_station(lane, s)]
        x, y = _position(home, signal, self.offset)
        place = {"road_id": road.road_id, "road_s_m": s, "x_m": x, "y_m": y}
        for sign in (signal, *signs_on_board(signal)):
            name = (listing if sign is signal else sign).get("id", "")
            columns = {"signal_id": name, **self._signal_columns(sign), **place}
            # A sign on a board may apply to other lanes than the board; a reference to the board states the lanes of all its signs.
            lanelets = self._lanelets_of_signal(listing, lanes, sign if listing is signal else listing)
            self.signals += [
                {**columns, "lanelet_id": lane.lanelet_id, "lane_s_m": lane.station_at(s)} for lane in lanelets
            ]
            if sign.get("id") in self.restricted_ids and columns["kind"] in KINDS_WITH_UNREAD_CONDITIONS:
                for lane in lanelets:
                    add_unread_condition(self.quality, lane.lanelet_id, f"signal {name}", "semantics or dependency")
        if _kind(signal) == "stop_line":
            self.stop_lines += [
                stop_line_row(listing.get("id", ""), lane.lanelet_id, lane.station_at(s), "signal")
                for lane in self._lanelets_of_stop_line(listing, signal, s, lanes)
            ]

    def _signal_columns(self, signal: etree._Element) -> dict[str, Any]:
        """Return the columns of `traffic_signal` that a signal states, wherever it stands."""
        kind = _kind(signal)
        source = element_with_value(signal)
        text = None if source is None or signal.get("id") in self.restricted_ids else source.get("value")
        value = 0.0 if source is None or text in {None, "", "None"} else number_attribute(source, "value")
        return {
            "kind": kind, "country": (signal.get("country") or "").lower() or None,
            "type": signal.get("type"), "subtype": signal.get("subtype"),
            "value": value if value > 0.0 else None,  # writers use -1 or 0 for no value
            "unit": (signal if source is None else source).get("unit"), "dynamic": signal.get("dynamic") == "yes",
            "turns": turns_of_light_code(signal.get("type", ""), signal.get("subtype", "")) if kind == "traffic_light" else None,
        }  # fmt: skip

    def _lanelets_of_signal(
        self, listing: etree._Element, lanes: list[Lanelet], sign: etree._Element | None = None
    ) -> list[Lanelet]:
        """Return the lanelets to which a signal applies; `sign`: the sign on it if it is a board.

        These are the lanes of its validity, if it has any, whose direction is its orientation (+ along, - against the
        reference line). If validity and orientation contradict each other, the validity decides, since it names the lanes.
        In RoadRunner's files they always do: the orientation is the direction in which the sign faces.
        """
        validities = (listing if sign is None else sign).findall("validity") or listing.findall("validity")
        valid = [sorted((integer_attribute(v, "fromLane"), integer_attribute(v, "toLane"))) for v in validities]
        if valid:
            lanes = [lane for lane in lanes if any(low <= lane.lane.number <= high for low, high in valid)]
        along = {"+": 1, "-": -1}.get(listing.get("orientation", "none"))
        lanelets = [lane for lane in lanes if along is None or lane.along == along or lane.bidirectional]
        if valid and lanes and not lanelets:
            self.contradictions.append(listing.get("id", ""))
            return lanes
        return lanelets

    def _lanelets_of_stop_line(
        self, listing: etree._Element, signal: etree._Element, s: float, lanes: list[Lanelet]
    ) -> list[Lanelet]:
        """Return the lanelets to which a painted stop line applies.

        These are the lanes of its validity, if it has any; else the lanes in the direction of its orientation that it
        crosses, by its place and width. If it crosses none of these, it applies to all lanes of that direction: many lines
        are placed on the reference line and drawn beside it. A line that crosses only lanes of the other direction applies
        to those: its orientation is then the direction in which it faces.
        """
        lanelets = self._lanelets_of_signal(listing, lanes)
        width = number_attribute(signal, "width", 0.0)
        oriented = listing.get("orientation") in {"+", "-"}
        if listing.find("validity") is not None or (oriented and width < MIN_STOP_LINE_WIDTH_M):
            return lanelets
        t, half = number_attribute(listing, "t", 0.0), max(0.5 * width, 1e-3)
        ranges = [(lane, *lane.lateral_range(s)) for lane in lanes]
        shared = [(lane, min(high, t + half) - max(low, t - half), high - low) for lane, low, high in ranges]
        across = [lane for lane, common, wide in shared if common > min(0.5 * wide, half)]
        if not across or any(lane in lanelets for lane in across):
            return [lane for lane in across if lane in lanelets] or lanelets
        same_way_m = sum(common for lane, common, _ in shared if lane in lanelets and common > 0.0)
        if same_way_m > MIN_SAME_DIRECTION_SHARE * width:
            return lanelets
        self.contradictions.append(listing.get("id", ""))
        return across

    def report_problems(self) -> None:
        """Report contradictions, and signals that apply to no lane, neither directly nor by a reference."""
        if self.contradictions:
            message = f"the orientation of signals contradicts their lanes (the first: {self.contradictions[0]}): the lanes are used"
            self.quality.add("signal_orientation", "warning", None, message, len(self.contradictions))
        self._report_signs_of_unknown_codes()
        ids_with_lane = {row["signal_id"] for row in self.signals}
        for name, (road, signal) in self.defined.items():
            if name not in ids_with_lane and not is_crossed_out(signal):
                message = f"signal {name} of road {road.road_id} applies to no lane that vehicles drive on"
                self.quality.add("signal_without_lane", "info", road.road_id, message)

    def _report_signs_of_unknown_codes(self) -> None:
        """Report signs of countries whose codes are not known: any of them may be a stop or give-way sign."""
        codes = sorted({
            f"{signal.get('country', '')} {signal.get('type', '')}"
            for signal in self.signs
            if _kind(signal) is None and signal.find("semantics") is None and signal.get("dynamic") != "yes"
            and signal.get("type") not in {None, "", "-1", "none", *BOARD_TYPES} and not has_codes_of(signal.get("country", ""))
        })  # fmt: skip
        if codes:
            names = name_list([escape_invisible(code[:40]) for code in codes])
            message = f"signs with codes that are not known ({names}): whether a junction without another sign has one is not known"
            self.quality.add(SIGNS_UNMAPPED_CHECK, "info", None, message, len(codes))


def _kind(signal: etree._Element) -> str | None:
    """Return the kind of a signal: by its semantics, else by its code, else by its name."""
    country, code, subtype = (signal.get(name, "") for name in ("country", "type", "subtype"))
    return kind_by_semantics(signal) or signal_kind(country, code, signal.get("name", ""), subtype)


def _position(road: Road, signal: etree._Element, offset: tuple[float, float]) -> tuple[float, float]:
    """Return where the signal stands: its own inertial position, if it has one, else beside its road."""
    inertial = signal.find("positionInertial")
    if inertial is not None:
        return number_attribute(inertial, "x") + offset[0], number_attribute(inertial, "y") + offset[1]
    x, y, _ = road.xy_and_heading(
        np.array([number_attribute(signal, "s")]), np.array([number_attribute(signal, "t", 0.0)]), offset
    )
    return float(x[0]), float(y[0])


def _contains_station(lane: Lanelet, s: float) -> bool:
    """Return whether the lanelet contains a road station; where two lanelets meet, only the later one does."""
    end = lane.lane_section.end_m
    return lane.lane_section.start_m <= s < end or (s >= end >= lane.road.length_m - 1e-3)
