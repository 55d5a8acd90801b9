"""OSI's numbers for types of lanes, boundaries, signs and lights, and the words for them in the map's tables (`map_kinds.toml`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from drivelint.facts import toml_beside

if TYPE_CHECKING:
    from collections.abc import Sequence


def _words_by_number(table: str) -> dict[int, Any]:
    return {int(number): word for number, word in toml_beside(__file__, "map_kinds.toml")[table].items()}


LANE_KINDS: Final[dict[int, str]] = _words_by_number("lane_kinds")
DRIVABLE_LANE_KINDS: Final = frozenset({"driving", "exit", "entry", "onRamp", "offRamp", "connectingRamp"})
INTERSECTION_LANE_TYPE: Final = 4
"""The `Lane.Classification.Type` of an intersection."""
CURB_LANE_TYPE: Final = 16
"""The `LogicalLane.Type` of a kerb."""
INCREASING, DECREASING, BOTH_WAYS = 2, 3, 4
"""Values of `LogicalLane.MoveDirection`: along the reference line, against it, both. With any other value it is unknown."""
_MARKINGS: Final[dict[int, str]] = _words_by_number("markings")
_UNKNOWN_BOUNDARY_TYPES: Final = frozenset({0, 1})  # UNKNOWN, OTHER
_LINE_MARKINGS: Final = frozenset({"solid", "broken", "botts_dots"})
_DOUBLE_LINE_PARTS: Final = frozenset({"solid", "broken"})
LANE_CHANGE_BY_PASSING_RULE: Final[dict[int, str]] = _words_by_number("lane_changes")
STOP_SIGN_TYPE: Final = 17
"""The `TrafficSign.MainSign.Classification.Type` of a stop sign, and of a painted symbol that marks a stop line."""
ZEBRA_SIGN_TYPE: Final = 87
SYMBOL_MARKING_TYPE: Final = 3
"""The `RoadMarking.Classification.Type` of a painted line or symbol."""
SIGN_KINDS: Final[dict[int, str]] = _words_by_number("sign_kinds")
CHANGING_VARIABILITIES: Final = frozenset({3, 5, 6})
"""Values of `TrafficSign.Variability` for signs whose content changes."""
NO_PLATE_TYPE: Final = 2
"""The `TrafficSign.SupplementarySign.Classification.Type` of a plate that shows nothing."""
UNITS: Final[dict[int, str]] = _words_by_number("units")
SPEED_UNITS_MPS: Final = {"km/h": 1 / 3.6, "mph": 0.44704}
TURNS_BY_LIGHT_ICON: Final[dict[int, list[str]]] = _words_by_number("turns")
LIGHT_ICON_WITHOUT_SYMBOL: Final = 2
LIGHT_KIND_BY_ICON: Final[dict[int, str]] = _words_by_number("light_kinds")


def combined_marking(boundary_types: Sequence[int | None]) -> str | None:
    """Return the marking that the boundaries on one side of a lane make together; None if it is unknown.

    `boundary_types`: the boundaries' types, nearest to the lane first; None for a boundary that is not in the log. An edge, rail or wall
    beside a line is ignored.
    """
    if not boundary_types or any(kind is None or kind in _UNKNOWN_BOUNDARY_TYPES for kind in boundary_types):
        return None
    words = [_MARKINGS.get(kind) for kind in boundary_types if kind is not None]
    lines = [word for word in words if word in _LINE_MARKINGS]
    if len(lines) == 2 and set(lines) <= _DOUBLE_LINE_PARTS:
        return f"{lines[0]}_{lines[1]}"
    if lines:
        return lines[0] if len(lines) == 1 else None
    return words[0] if len(set(words)) == 1 else None
