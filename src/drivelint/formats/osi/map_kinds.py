"""OSI's numbers for lanes, boundaries, signs and lights in the words of the map's tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Sequence

LANE_KINDS: Final = {
    2: "driving", 3: "biking", 4: "sidewalk", 5: "parking", 6: "stop", 7: "restricted", 8: "border", 9: "shoulder",
    10: "exit", 11: "entry", 12: "onRamp", 13: "offRamp", 14: "connectingRamp", 15: "median", 16: "curb", 17: "rail", 18: "tram",
}  # fmt: skip
"""`LogicalLane.Type`; `Lane.Classification.Subtype` has the same numbers up to 14."""
DRIVABLE: Final = frozenset({"driving", "exit", "entry", "onRamp", "offRamp", "connectingRamp"})
INTERSECTION: Final = 4
"""`Lane.Classification.Type` of an area where ways meet."""
CURB: Final = 16
"""`LogicalLane.Type` of a kerb stone: it has no width."""
INCREASING, DECREASING, BOTH = 2, 3, 4
"""`LogicalLane.MoveDirection`: along the reference line, against it, both; of any other it is not known."""
_MARKINGS: Final = {2: "none", 3: "solid", 4: "broken", 5: "botts_dots", 8: "grass", 12: "curb"}
_UNSAID: Final = frozenset({0, 1})  # UNKNOWN, OTHER
_LINES: Final = frozenset({"solid", "broken", "botts_dots"})
_DOUBLE: Final = frozenset({"solid", "broken"})
LANE_CHANGES: Final = {2: "none", 3: "increase", 4: "decrease", 5: "both"}
"""`LogicalLaneBoundary.PassingRule` as `lane_change`."""
STOP_SIGN: Final = 17
"""`TrafficSign.MainSign.Classification.Type` of a stop sign, and of the line at which one stops if it is painted as a symbol."""
ZEBRA: Final = 87
SYMBOL_MARKING: Final = 3
"""`RoadMarking.Classification.Type` of a line or symbol painted on the road."""
SIGN_KINDS: Final = {
    16: "give_way", 17: "stop", 18: "give_way_to_oncoming", 19: "give_way_to_oncoming", 29: "roundabout", 30: "one_way",
    31: "one_way", 37: "no_vehicles", 44: "no_entry", 52: "speed_limit", 53: "speed_zone", 54: "speed_zone_end",
    55: "minimum_speed", 56: "no_overtaking", 57: "no_overtaking_trucks", 58: "speed_limit_end", 60: "no_overtaking_end",
    61: "no_overtaking_trucks_end", 62: "restrictions_end", 63: "no_stopping", 64: "no_parking", 67: "priority_here",
    68: "priority_road", 69: "priority_road_end", 70: "priority_over_oncoming", 71: "priority_over_oncoming",
    72: "town_entrance", 73: "town_exit", 82: "motorway", 83: "motorway_end", 84: "expressway", 85: "expressway_end",
    86: "exit", 87: "crossing", 88: "exit", 183: "exit", 184: "exit", 185: "exit", 186: "exit", 187: "one_way",
}  # fmt: skip
VARIABLE_SIGN: Final = frozenset({3, 5, 6})
"""`TrafficSign.Variability` of a sign that shows now this, now that."""
UNITS: Final = {3: "km/h", 4: "mph", 5: "m", 6: "km", 7: "ft", 8: "mi"}
SPEED_UNITS_MPS: Final = {"km/h": 1 / 3.6, "mph": 0.44704}
_ALL_TURNS: Final = ("left", "straight", "right", "u_turn")
TURNS: Final[dict[int, tuple[str, ...]]] = {
    2: _ALL_TURNS, 3: ("straight",), 4: ("left",), 5: ("left",), 6: ("left", "straight"), 7: ("right",), 8: ("right",),
    9: ("straight", "right"), 10: ("left", "right"),
}  # fmt: skip
"""`TrafficLight.Classification.Icon` -> the turns that the light holds for; of a full light all."""
FULL_LIGHT_ICON: Final = 2
LIGHT_KINDS: Final = {
    **dict.fromkeys(TURNS, "traffic_light"),
    **dict.fromkeys((0, 1), "traffic_light"),  # of an icon that is not known it may be one for vehicles
    **dict.fromkeys((15, 16, 17, 19), "pedestrian_light"),
    18: "bicycle_light",
}


def marking(types: Sequence[int | None]) -> str | None:
    """Return the marking that boundaries make, the one nearest to the lane first; None in `types`: it is not in the log.

    An edge, rail or wall beside a line is no marking of its own. None: not known.
    """
    if not types or any(kind is None or kind in _UNSAID for kind in types):
        return None
    words = [_MARKINGS.get(kind) for kind in types if kind is not None]
    lines = [word for word in words if word in _LINES]
    if len(lines) == 2 and set(lines) <= _DOUBLE:
        return f"{lines[0]}_{lines[1]}"
    if lines:
        return lines[0] if len(lines) == 1 else None
    return words[0] if len(set(words)) == 1 else None
