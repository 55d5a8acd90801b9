"""This module reads the right of way in a SUMO network: lights by connection, signs by junction.

A connection's `state` is its right of way: M (major) or m (minor). A turn across oncoming traffic from a major road is minor, too: an edge
is a minor road, with signs, only if none of its connections is major. Source: SUMO's documentation of "SUMO Road Networks".
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any, Final

from drivelint.formats.safe_xml import number_or_nan
from drivelint.road.boundary_lanes import signal_row
from drivelint.road.tables import Rows, stop_line_row

if TYPE_CHECKING:
    from collections.abc import Mapping

    from lxml import etree

    from drivelint.road.boundary_lanes import BoundedLane

_TURNS_BY_DIRECTION: Final = {
    "s": ("straight",), "l": ("left",), "r": ("right",), "t": ("u_turn",), "L": ("left", "straight"), "R": ("right", "straight"),
}  # fmt: skip
_JUNCTION_TYPES_WITH_SIGNS: Final = frozenset({"priority", "priority_stop", "allway_stop"})
"""Types of junctions with signs on the minor roads. At other types, right goes before left, lights decide, or the rule is not known."""
_SIGN_OF_LINK_STATE: Final = {"s": "stop", "w": "stop", "m": "give_way"}
_U_TURN_DIRECTION: Final = "t"
_CAR: Final = "passenger"


def signal_and_stop_line_rows(root: etree._Element, lanes: Mapping[str, BoundedLane]) -> tuple[Rows, Rows]:
    """Return rows of `traffic_signal` and of `stop_line`.

    A stop line is at the end of each lane with a light or a stop sign, or before it by the `<stopOffset>` for cars.
    """
    links = [link for link in root.iterfind("connection") if not link.get("from", "").startswith(":")]
    signals, lines = _light_rows_and_lanes_ending_at_lights(links, lanes)
    signed, stops = _sign_rows_and_lanes_ending_at_stop_signs(root, links, lanes)
    lines |= stops
    offsets = _stop_offsets_m(root)
    rows = [
        stop_line_row(f"end of {name}", name, max(lanes[name].line.length - offsets.get(name, 0.0), 0.0), "connection")
        for name in sorted(lines)
    ]
    return sorted([*signals, *signed], key=lambda row: (row["signal_id"], row["lanelet_id"])), rows


def _stop_offsets_m(root: etree._Element) -> dict[str, float]:
    """Return lane -> how far before its end cars stop (m); the offset of a lane takes precedence over that of its edge."""
    offsets: dict[str, float] = {}
    for edge in root.iterfind("edge"):
        for lane in edge.iterfind("lane"):
            offset = next(
                (item for item in (*lane.iterfind("stopOffset"), *edge.iterfind("stopOffset")) if _is_for_cars(item)),
                None,
            )
            metres = number_or_nan(None if offset is None else offset.get("value"))
            if metres > 0.0:
                offsets[lane.get("id", "")] = metres
    return offsets


def _is_for_cars(offset: etree._Element) -> bool:
    """Return whether a stop offset is for cars: `vClasses` names who stops there, `exceptions` who does not."""
    if (exceptions := offset.get("exceptions")) is not None:
        return _CAR not in exceptions.split()
    return bool({_CAR, "all"} & set(offset.get("vClasses", "all").split()))


def _light_rows_and_lanes_ending_at_lights(
    links: list[etree._Element], lanes: Mapping[str, BoundedLane]
) -> tuple[Rows, set[str]]:
    """Return a row for each signal head and lanelet in the junction to which it applies, and the lanes that end at a head.

    A head's id is `<light>_<link index>`, as SUMO writes it into OpenDRIVE.
    """
    turns: dict[tuple[str, str, float], set[str]] = defaultdict(set)
    ends = set()
    for link in links:
        light, source = link.get("tl"), f"{link.get('from')}_{link.get('fromLane')}"
        if light is None or source not in lanes:
            continue
        via = link.get("via")
        at, s = (via, 0.0) if via in lanes else (source, lanes[source].line.length)
        turns[f"{light}_{link.get('linkIndex')}", str(at), s].update(_TURNS_BY_DIRECTION.get(link.get("dir", ""), ()))
        if lanes[source].drivable:
            ends.add(source)
    rows = [
        _signal_row(name, "traffic_light", lanes[at], s, turns=sorted(turns_of_light) or None)
        for (name, at, s), turns_of_light in sorted(turns.items())
        if lanes[at].drivable
    ]
    return rows, ends


def _sign_rows_and_lanes_ending_at_stop_signs(
    root: etree._Element, links: list[etree._Element], lanes: Mapping[str, BoundedLane]
) -> tuple[Rows, set[str]]:
    kinds = {junction.get("id"): junction.get("type") for junction in root.iterfind("junction")}
    ends = {edge.get("id"): kinds.get(edge.get("to")) for edge in root.iterfind("edge") if edge.get("to")}
    states: dict[str, set[str]] = defaultdict(set)
    for link in links:
        if (
            link.get("tl") is None
            and link.get("dir") != _U_TURN_DIRECTION
            and ends.get(link.get("from")) in _JUNCTION_TYPES_WITH_SIGNS
        ):
            states[link.get("from", "")].add(link.get("state", ""))
    rows: Rows = []
    stops = set()
    for edge, link_states in sorted(states.items()):
        signs = {_SIGN_OF_LINK_STATE.get(state) for state in link_states}
        if None in signs or not signs:
            continue
        kind = "stop" if "stop" in signs else "give_way"
        for name, lane in sorted(lanes.items()):
            if lane.drivable and name.rpartition("_")[0] == edge:
                rows.append(_signal_row(f"{kind} {edge}", kind, lane, lane.line.length, turns=None))
                if kind == "stop":
                    stops.add(name)
    return rows, stops


def _signal_row(name: str, kind: str, lane: BoundedLane, s: float, *, turns: list[str] | None) -> dict[str, Any]:
    place = lane.line.centre[0 if s == 0.0 else -1]
    return signal_row(lane, s, place, signal_id=name, kind=kind, dynamic=kind == "traffic_light", turns=turns)
