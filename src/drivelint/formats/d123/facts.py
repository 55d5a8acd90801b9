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
"""The label of the ego's own box among the others."""


class Dataset(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What holds for a data set; the defaults hold for one that is not known.

    `sensor_range_m`: the range in which it is documented to have every actor.
    `utc`: times count from 1970 in UTC.
    `ego_class`: of the vehicle that recorded.
    `ego_size_recorded`: its size is that of this vehicle, not of its model.
    `box_velocities_global`: velocities of boxes are along the axes of the map.
    `steady_for_flashing`: a light that flashes is written as one that shows this colour.
    `lines_of_lanes`: the road lines are the bounds of the lanes, left and right, in the lanes' order, without the unmarked.
    `estimated_bounds`: bounds of lanes that the converter estimates, "": none.
    `unsure_lines`: types of road lines that may be others.
    `nations`: location -> country, as two letters; *: of every location.
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
        """Return the country if the location shows it."""
        return self.nations.get(location or "", self.nations.get("*"))

    def side_driven_on(self, location: str | None) -> str | None:
        """Return lht or rht if the location shows it."""
        nation = self.nation_of(location)
        return None if nation is None else side_of_nation(nation)


DATASETS: Final = {name: msgspec.convert(facts, Dataset) for name, facts in _FACTS["datasets"].items()}
UNKNOWN_DATASET: Final = Dataset()
VERSIONS: Final[tuple[str, ...]] = tuple(_FACTS["versions"]["read"])
LAYERS: Final[dict[str, int]] = _FACTS["layers"]
LABELS: Final[dict[str, dict[str, tuple[int, str]]]] = {
    name: {label: (number, word) for label, (number, word) in labels.items()}
    for name, labels in _FACTS["labels"].items()
}
"""Enumeration -> label -> its number and our class, "": the label may be anything."""
LANE_TYPES: Final[dict[int, tuple[str, str | None]]] = {
    number: (kind, road or None) for number, kind, road in _FACTS["lane_types"].values()
}
"""Number -> our lane type and road type."""
MARKINGS: Final[dict[int, str | None]] = {number: word or None for number, word in _FACTS["road_lines"].values()}
LINE_NUMBERS: Final[dict[str, int]] = {name: number for name, (number, _) in _FACTS["road_lines"].items()}
SIGNALLED: Final[int] = _FACTS["intersection_types"]["TRAFFIC_LIGHT"]
"""The type of an intersection with traffic lights."""


def is_read(version: str) -> bool:
    """Say whether the files of this version of py123d are read: by its first two numbers."""
    return ".".join(version.split(".")[:2]) in VERSIONS


def dataset(name: str) -> Dataset:
    """Return the facts about a data set."""
    return DATASETS.get(name, UNKNOWN_DATASET)


def rider_labels(enumeration: str) -> tuple[list[int], list[int]]:
    """Return the numbers of the labels of riders and of what they ride, where these have boxes of their own."""
    both = _FACTS["riders"].get(enumeration, {"riders": [], "ridden": []})
    riders, ridden = ([LABELS[enumeration][name][0] for name in both[role]] for role in ("riders", "ridden"))
    return riders, ridden


def label_classes(enumeration: str) -> Codes | None:
    """Return number of the label -> code of `ACTOR_CLASSES`, -1: may be anything, -2: no label; None: no such enumeration."""
    labels = LABELS.get(enumeration)
    if labels is None:
        return None
    codes = np.full(max(number for number, _ in labels.values()) + 1, -2, np.int8)
    for number, word in labels.values():
        codes[number] = ACTOR_CLASSES.index(word) if word else -1
    return codes


def light_codes() -> Codes:
    """Return number of the state -> code of `SIGNAL_STATES`, -1: unknown."""
    words = dict(_FACTS["light_states"].values())
    return np.array([SIGNAL_STATES.index(words[n]) if words[n] else -1 for n in range(len(words))], np.int8)
