"""OSI's numbers for types of lanes, boundaries, signs and lights, and the words for them in the map's tables (`map_kinds.toml`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from drivelint.facts import toml_beside

if TYPE_CHECKING:
    from collections.abc import Sequence


def _words(table: str) -> dict[int, Any]:
    return {int(number): word for number, word in toml_beside(__file__, "map_kinds.toml")[table].items()}


LANE_KINDS: Final[dict[int, str]] = _words("lane_kinds")
DRIVABLE: Final = frozenset({"driving", "exit", "entry", "onRamp", "offRamp", "connectingRamp"})
INTERSECTION: Final = 4
"""The `Lane.Classification.Type` of an intersection."""
CURB: Final = 16
"""The `LogicalLane.Type` of a kerb."""
INCREASING, DECREASING, BOTH = 2, 3, 4
"""Values of `LogicalLane.MoveDirection`: along the reference line, against it, both. With any other value it is unknown."""
_MARKINGS: Final[dict[int, str]] = _words("markings")
_UNSAID: Final = frozenset({0, 1})  # UNKNOWN, OTHER
_LINES: Final = frozenset({"solid", "broken", "botts_dots"})
_DOUBLE: Final = frozenset({"solid", "broken"})
LANE_CHANGES: Final[dict[int, str]] = _words("lane_changes")
STOP_SIGN: Final = 17
"""The `TrafficSign.MainSign.Classification.Type` of a stop sign, and of a painted symbol that marks a stop line."""
ZEBRA: Final = 87
SYMBOL_MARKING: Final = 3
"""The `RoadMarking.Classification.Type` of a painted line or symbol."""
SIGN_KINDS: Final[dict[int, str]] = _words("sign_kinds")
VARIABLE_SIGN: Final = frozenset({3, 5, 6})
"""Values of `TrafficSign.Variability` for signs whose content changes."""
UNITS: Final[dict[int, str]] = _words("units")
SPEED_UNITS_MPS: Final = {"km/h": 1 / 3.6, "mph": 0.44704}
TURNS: Final[dict[int, list[str]]] = _words("turns")
FULL_LIGHT_ICON: Final = 2
LIGHT_KINDS: Final[dict[int, str]] = _words("light_kinds")


def marking(types: Sequence[int | None]) -> str | None:
    """Return the marking that the boundaries on one side of a lane make together; None if it is unknown.

    `types`: the boundaries' types, nearest to the lane first; None for a boundary that is not in the log. An edge, rail or wall
    beside a line is ignored.
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
