"""Reads what a signal means from the `<semantics>` of OpenDRIVE 1.8, and which signs hold only at times, for some or not at all.

A sign of a country whose codes are not known is recognised by its semantics.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from lxml import etree

_KIND_BY_MEANING: Final = {
    ("speed", "maximum"): "speed_limit", ("speed", "maximumEnd"): "speed_limit_end", ("speed", "minimum"): "minimum_speed",
    ("speed", "zone"): "speed_zone", ("speed", "zoneEnd"): "speed_zone_end",
    ("lane", "noOvertakeCars"): "no_overtaking", ("lane", "noOvertakeCarsEnd"): "no_overtaking_end",
    ("lane", "noOvertakeTrucks"): "no_overtaking_trucks", ("lane", "noOvertakeTrucksEnd"): "no_overtaking_trucks_end",
    ("lane", "priorityOverOncoming"): "priority_over_oncoming", ("lane", "yieldForOncoming"): "give_way_to_oncoming",
    ("lane", "roundabout"): "roundabout",
    ("priority", "stop"): "stop", ("priority", "yield"): "give_way", ("priority", "trafficLight"): "traffic_light",
    ("priority", "stopLine"): "stop_line", ("priority", "priorityRoad"): "priority_road",
    ("priority", "priorityRoadEnd"): "priority_road_end",
}  # fmt: skip
"""Element and type of OpenDRIVE's semantics -> the kind of the signal."""
_RESTRICTIONS: Final = frozenset({
    "supplementaryTime", "supplementaryAllows", "supplementaryProhibits", "supplementaryEnvironment",
})  # fmt: skip

CHANGING_BOARD_TYPES: Final = frozenset({"vmsBoard", "multiBoard"})
"""The types of signals of OpenDRIVE 1.8 that are boards of which a part changes: it may show a limit or a ban at any time."""
BOARD_TYPES: Final = CHANGING_BOARD_TYPES | {"staticBoard"}


def signs_on_board(signal: etree._Element) -> list[etree._Element]:
    """Return the signs on a static board (OpenDRIVE 1.8), each with the attributes of a signal; none if the signal is no board."""
    return [sign for sign in signal.iterfind("staticBoard/sign") if not is_crossed_out(sign)]


def is_crossed_out(signal: etree._Element) -> bool:
    """Return whether a signal is there but does not apply, as in road works (OpenDRIVE 1.9)."""
    return signal.get("invalidated") in {"true", "1"}


def kind_by_semantics(signal: etree._Element) -> str | None:
    """Return the kind of a signal by the first of its meanings that is a kind; None: it has none."""
    kinds = (_KIND_BY_MEANING.get((str(part.tag), part.get("type", ""))) for part in signal.iterfind("semantics/*"))
    return next((kind for kind in kinds if kind is not None), None)


def element_with_value(signal: etree._Element) -> etree._Element | None:
    """Return the element with the value and the unit of a signal: the speed of its semantics, else itself.

    None: its semantics are a speed that is no limit, such as a recommended one.
    """
    speed = signal.find("semantics/speed")
    if speed is None:
        return signal
    if ("speed", speed.get("type", "")) not in _KIND_BY_MEANING:
        return None
    return signal if speed.get("value") is None else speed


def restricted_sign_ids(signals: Iterable[etree._Element], kind_by_id: Mapping[str, str | None]) -> set[str]:
    """Return the ids of the signs that hold only at times, in some weather or for some vehicles.

    They state this in their semantics, or they and a sign of no known kind, such as a plate below them, depend on each other.
    """
    ids: set[str] = set()
    for signal in signals:
        name = signal.get("id", "")
        if any(part.tag in _RESTRICTIONS for part in signal.iterfind("semantics/*")):
            ids.add(name)
        for dependency in signal.findall("dependency"):
            pair = {name, dependency.get("id", "")}
            if any(kind_by_id.get(signal_id) is None for signal_id in pair):
                ids |= pair
    return ids
