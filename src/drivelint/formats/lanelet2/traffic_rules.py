"""The participants, directions and speeds that a lanelet allows, by the German rules of the library lanelet2, which has no other rules.

By these rules, a tag `participant:*` replaces all participants that the subtype allows. A tag `one_way:*` applies to its kind of road user
if there is no tag `one_way`.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.formats.lanelet2.file import attribute

if TYPE_CHECKING:
    from collections.abc import Mapping

_LANE_TYPE_BY_SUBTYPE: Final[Mapping[str, str]] = {
    "road": "driving", "highway": "driving", "play_street": "driving", "bus_lane": "bus", "exit": "exit",
    "emergency_lane": "stop", "bicycle_lane": "biking", "walkway": "sidewalk", "shared_walkway": "sidewalk",
    "stairs": "sidewalk", "pedestrian_lane": "sidewalk", "road_shoulder": "shoulder", "rail": "rail",
}  # fmt: skip
"""Subtype -> lane type, by default."""
_ROADSIDE_SUBTYPES: Final = frozenset({"road_shoulder", "pedestrian_lane"})
"""Autoware's subtypes of lanes beside the road, which the library does not know. Whatever their tags, they are not for driving."""
_LANE_TYPE_BY_VEHICLE: Final = {
    "vehicle:car": "driving", "vehicle:truck": "driving", "vehicle:bus": "bus", "vehicle:taxi": "taxi",
    "vehicle:motorcycle": "driving",
}  # fmt: skip
"""Motor vehicle -> type of a lane that it may use, but none of the vehicles listed before it."""
_CAR: Final = "vehicle:car"
_LANE_TYPE_BY_PARTICIPANT: Final = {"pedestrian": "sidewalk", "bicycle": "biking", "vehicle:emergency": "restricted"}
_SPEED_PATTERN: Final = re.compile(r"\s*([0-9]+(?:\.[0-9]+)?)\s*([a-z/]*)\s*")
_UNITS_MPS: Final = {
    "": 1 / 3.6, "km/h": 1 / 3.6, "kmh": 1 / 3.6, "kph": 1 / 3.6, "kmph": 1 / 3.6, "mph": 0.44704, "m/s": 1.0, "mps": 1.0,
}  # fmt: skip
"""A number without a unit is in km/h. The library itself reads `50 kmph` as miles, only the start of `50 mph;30`, and other texts as 0."""
_LIMIT_TAGS: Final = ("speed_limit:vehicle:car", "speed_limit:vehicle", "speed_limit")


_MANDATORY_TAGS: Final = tuple(name.replace("speed_limit", "speed_limit_mandatory") for name in _LIMIT_TAGS)
_TRUE_WORDS: Final = frozenset({"yes", "true", "1"})
_FALSE_WORDS: Final = frozenset({"no", "false", "0"})
"""The library reads these as booleans."""


class LaneAccess(NamedTuple):
    """The type of a lane, whether motor vehicles may drive on it, and whether they may do so in both directions.

    `is_unread`: cars may not drive on it, which its type does not show.
    """

    lane_type: str
    drivable: bool
    bidirectional: bool
    is_unread: bool = False


class TrafficRules:
    """The library's rules for each kind of road user."""

    def __init__(self) -> None:
        import lanelet2

        rules = lanelet2.traffic_rules
        self._vehicle = rules.create(rules.Locations.Germany, rules.Participants.Vehicle)
        self._of = {
            word: rules.create(rules.Locations.Germany, word)
            for word in (*_LANE_TYPE_BY_VEHICLE, *_LANE_TYPE_BY_PARTICIPANT)
        }

    def access(self, lanelet: Any) -> LaneAccess | None:
        """Return the type of a lanelet and who may drive on it; None if it is not a lane of a road but, for example, a crosswalk."""
        subtype = attribute(lanelet, "subtype")
        of_subtype = _LANE_TYPE_BY_SUBTYPE.get(subtype)
        if subtype in _ROADSIDE_SUBTYPES:
            return LaneAccess(_LANE_TYPE_BY_SUBTYPE[subtype], False, False)
        for word, lane_type in _LANE_TYPE_BY_VEHICLE.items():
            if self._of[word].canPass(lanelet):
                both_ways = not self._of[word].isOneWay(lanelet)
                kind = of_subtype if of_subtype == "exit" else lane_type
                return LaneAccess(kind, True, both_ways, is_unread=word != _CAR and kind in {"driving", "exit"})
        if of_subtype is None:
            return None
        may_pass = [
            lane_type for word, lane_type in _LANE_TYPE_BY_PARTICIPANT.items() if self._of[word].canPass(lanelet)
        ]
        has_participants = any(key.startswith("participant:") for key in lanelet.attributes.keys())  # noqa: SIM118 - the library's map
        if of_subtype in {"driving", "bus", "exit"} or (has_participants and may_pass):
            return LaneAccess(may_pass[0] if may_pass else "restricted", False, False)
        return LaneAccess(of_subtype, False, False)

    def limit_mps(self, lanelet: Any) -> float | None:
        """Return the limit (m/s) of a lanelet's sign, else of its tag; a nation's default is not used.

        None: the map states no limit; NaN: the stated limit cannot be read, or it changes.
        """
        signs = [rule for rule in lanelet.regulatoryElements if attribute(rule, "subtype") == "speed_limit"]
        if any(is_dynamic(sign) for sign in signs):
            return math.nan
        signed = len(signs) > 0
        of_sign = self._sign_limit_mps(lanelet) if signed else math.nan
        if of_sign > 0.0:
            return of_sign
        text = limit_text(lanelet)
        if text is None:
            return math.nan if signed else None
        return speed_mps(text)

    def _sign_limit_mps(self, lanelet: Any) -> float:
        """Return the limit (m/s) of a lanelet that has a sign; NaN if the library does not know the number on the sign."""
        try:
            limit = float(self._vehicle.speedLimit(lanelet).speedLimit) / 3.6
        except RuntimeError:
            return math.nan
        return limit if math.isfinite(limit) else math.nan


def limit_text(lanelet: Any) -> str | None:
    """Return the text of the tag that limits the speed of vehicles on a lanelet; None without one, or if it only recommends a speed."""
    mandatory = next((attribute(lanelet, name) for name in _MANDATORY_TAGS if name in lanelet.attributes), "yes")
    if mandatory in _FALSE_WORDS:
        return None
    return next((attribute(lanelet, name) for name in _LIMIT_TAGS if name in lanelet.attributes), None)


def is_dynamic(element: Any) -> bool:
    """Return whether a regulatory element applies only under a condition, such as at certain hours or when a variable sign shows it."""
    return attribute(element, "dynamic") in _TRUE_WORDS


def speed_mps(text: str) -> float:
    """Return a speed in m/s; NaN for a text that is not one positive number, with a known unit or without a unit."""
    match = _SPEED_PATTERN.fullmatch(text.lower())
    speed = float(match[1]) * _UNITS_MPS.get(match[2], math.nan) if match else math.nan
    return speed if speed > 0.0 else math.nan
