"""The meaning of 123D's numbers and data sets, from `facts.toml`."""

from __future__ import annotations

from typing import Final

import msgspec
import numpy as np

from drivelint.arrays import Codes  # noqa: TC001 (part of a type that is looked up)
from drivelint.drive.trace import ACTOR_CLASSES, SIGNAL_STATES
from drivelint.facts import toml_beside
from drivelint.road.countries import side_of_nation

_FACTS: Final = toml_beside(__file__, "facts.toml")
EGO_LABEL: Final = "EGO"
"""The label of the ego's own box."""


class DatasetFacts(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The facts about a data set; the defaults apply to an unknown data set.

    `sensor_range_m`: the range within which every actor is documented to be recorded.
    `utc`: times count from 1970 in UTC.
    `ego_class`: the class of the recording vehicle.
    `ego_size_recorded`: the ego's size is that of the recording vehicle, not of its model.
    `box_velocities_global`: velocities of boxes are along the axes of the map.
    `steady_for_flashing`: a flashing light is written as a steady light of the same colour.
    `lines_of_lanes`: the road lines are the marked bounds of the lanes, left before right, in the order of the lanes.
    `estimated_bounds`: bounds of lanes that the converter estimates, "": none.
    `unsure_lines`: types of road lines that may stand for another marking.
    `nations`: location -> country, as two letters; *: every location.
    """

    sensor_range_m: float | None = None
    utc: bool = False
    ego_class: str = "vehicle"
    ego_size_recorded: bool = False
    box_velocities_global: bool = True
    steady_for_flashing: bool = False
    lines_of_lanes: bool = False
    estimated_bounds: str = ""
    unsure_lines: tuple[str, ...] = ()
    nations: dict[str, str] = msgspec.field(default_factory=dict)

    def nation_of(self, location: str | None) -> str | None:
        """Return the country of a location; None if it is not known."""
        return self.nations.get(location or "", self.nations.get("*"))

    def side_driven_on(self, location: str | None) -> str | None:
        """Return the side that is driven on, lht or rht, at a location; None if it is not known."""
        nation = self.nation_of(location)
        return None if nation is None else side_of_nation(nation)


FACTS_BY_DATASET: Final = {name: msgspec.convert(facts, DatasetFacts) for name, facts in _FACTS["datasets"].items()}
UNKNOWN_DATASET: Final = DatasetFacts()
SUPPORTED_VERSIONS: Final[tuple[str, ...]] = tuple(_FACTS["versions"]["read"])
LAYER_NUMBERS: Final[dict[str, int]] = _FACTS["layers"]
LABELS_BY_ENUMERATION: Final[dict[str, dict[str, tuple[int, str]]]] = {
    name: {label: (number, word) for label, (number, word) in labels.items()}
    for name, labels in _FACTS["labels"].items()
}
"""Enumeration -> label -> its number and our class; "": any class is possible."""
LANE_TYPES: Final[dict[int, tuple[str, str | None]]] = {
    number: (kind, road or None) for number, kind, road in _FACTS["lane_types"].values()
}
"""Number -> our lane type and road type."""
MARKINGS: Final[dict[int, str | None]] = {number: word or None for number, word in _FACTS["road_lines"].values()}
ROAD_LINE_NUMBERS: Final[dict[str, int]] = {name: number for name, (number, _) in _FACTS["road_lines"].items()}
SIGNALLED_INTERSECTION_TYPE: Final[int] = _FACTS["intersection_types"]["TRAFFIC_LIGHT"]
"""The type of an intersection with traffic lights."""


def is_supported_version(version: str) -> bool:
    """Return whether files of this version of py123d are read; only its first two numbers count."""
    return ".".join(version.split(".")[:2]) in SUPPORTED_VERSIONS


def dataset_facts(name: str) -> DatasetFacts:
    """Return the facts about a data set."""
    return FACTS_BY_DATASET.get(name, UNKNOWN_DATASET)


def rider_and_ridden_label_numbers(enumeration: str) -> tuple[list[int], list[int]]:
    """Return the label numbers of riders and of ridden vehicles; none if the data set has no separate boxes for them."""
    names_by_role = _FACTS["riders"].get(enumeration, {"riders": [], "ridden": []})
    riders, ridden = (
        [LABELS_BY_ENUMERATION[enumeration][name][0] for name in names_by_role[role]] for role in ("riders", "ridden")
    )
    return riders, ridden


def class_code_by_label(enumeration: str) -> Codes | None:
    """Return label number -> index into `ACTOR_CLASSES` (-1: any class, -2: no such label); None for an unknown enumeration."""
    labels = LABELS_BY_ENUMERATION.get(enumeration)
    if labels is None:
        return None
    codes = np.full(max(number for number, _ in labels.values()) + 1, -2, np.int8)
    for number, word in labels.values():
        codes[number] = ACTOR_CLASSES.index(word) if word else -1
    return codes


def light_state_codes() -> Codes:
    """Return number of the state -> index into `SIGNAL_STATES`, -1: unknown."""
    words = dict(_FACTS["light_states"].values())
    return np.array([SIGNAL_STATES.index(words[n]) if words[n] else -1 for n in range(len(words))], np.int8)
