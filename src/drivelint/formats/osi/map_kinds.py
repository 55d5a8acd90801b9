"""OSI's numbers for lanes, boundaries, signs and lights in the words of the map's tables, as `map_kinds.toml` has them."""

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
"""`Lane.Classification.Type` of an area where ways meet."""
CURB: Final = 16
"""`LogicalLane.Type` of a kerb stone: it has no width."""
INCREASING, DECREASING, BOTH = 2, 3, 4
"""`LogicalLane.MoveDirection`: along the reference line, against it, both; of any other it is not known."""
_MARKINGS: Final[dict[int, str]] = _words("markings")
_UNSAID: Final = frozenset({0, 1})  # UNKNOWN, OTHER
_LINES: Final = frozenset({"solid", "broken", "botts_dots"})
_DOUBLE: Final = frozenset({"solid", "broken"})
LANE_CHANGES: Final[dict[int, str]] = _words("lane_changes")
STOP_SIGN: Final = 17
"""`TrafficSign.MainSign.Classification.Type` of a stop sign, and of the line at which one stops if it is painted as a symbol."""
ZEBRA: Final = 87
SYMBOL_MARKING: Final = 3
"""`RoadMarking.Classification.Type` of a line or symbol painted on the road."""
SIGN_KINDS: Final[dict[int, str]] = _words("sign_kinds")
VARIABLE_SIGN: Final = frozenset({3, 5, 6})
"""`TrafficSign.Variability` of a sign that shows now this, now that."""
UNITS: Final[dict[int, str]] = _words("units")
SPEED_UNITS_MPS: Final = {"km/h": 1 / 3.6, "mph": 0.44704}
TURNS: Final[dict[int, list[str]]] = _words("turns")
FULL_LIGHT_ICON: Final = 2
LIGHT_KINDS: Final[dict[int, str]] = _words("light_kinds")


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
