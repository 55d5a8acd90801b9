"""Translates OSI's enumerations into drivelint's codes. Only names are fixed here; their numbers come from the log's schema."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.declared_events import HEADLIGHTS
from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS
from drivelint.formats.osi.schema import OPEN_DRIVE_REFERENCE
from drivelint.formats.protobuf.descriptors import enum_names, integer_values, list_items_and_row_indices, struct_field

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from drivelint.arrays import Codes
    from drivelint.formats.protobuf.descriptors import SchemaTypes

OFF, ON, OTHER_STATE = 0, 1, 2
# one bit per state of a bulb; LIT means: lit in the bulb's colour
RED, AMBER, GREEN, FLASHING, UNKNOWN, LIT = 1, 2, 4, 8, 16, 32
_STATE_BY_LIT_BITS = {0: "off", RED: "red", RED | AMBER: "red_amber", AMBER: "amber", GREEN: "green"}
INDICATOR_NAMES = {"OFF": "off", "LEFT": "left", "RIGHT": "right", "WARNING": "hazard"}
BRAKE_LIGHT_NAMES = {"OFF": "off", "NORMAL": "on", "STRONG": "strong"}
_OBJECT_CLASSES = {"VEHICLE": "vehicle", "PEDESTRIAN": "pedestrian", "ANIMAL": "animal"}
_VEHICLE_CLASSES = {
    "SMALL_CAR": "car", "COMPACT_CAR": "car", "CAR": "car", "MEDIUM_CAR": "car", "LUXURY_CAR": "car",
    "DELIVERY_VAN": "van", "HEAVY_TRUCK": "truck", "SEMITRACTOR": "truck", "SEMITRAILER": "trailer", "TRAILER": "trailer",
    "MOTORBIKE": "motorcycle", "BICYCLE": "bicycle", "BUS": "bus", "WHEELCHAIR": "pedestrian", "STANDUP_SCOOTER": "bicycle",
}  # fmt: skip
_LAMP_CODES = {"OFF": OFF, "ON": ON} | dict.fromkeys(
    ("OTHER", "FLASHING_BLUE", "FLASHING_BLUE_AND_RED", "FLASHING_AMBER"), OTHER_STATE
)


def _index_by_osi_name(names: Mapping[str, str], words: tuple[str, ...]) -> dict[str, int]:
    return {name: words.index(word) for name, word in names.items()}


_VEHICLE_FIELD = "moving_object.vehicle_classification"
_ENUMERATIONS: dict[str, tuple[str, str, dict[str, int]]] = {
    "kind": ("moving_object.type", "TYPE", _index_by_osi_name(_OBJECT_CLASSES, ACTOR_CLASSES)),
    "vehicle": (f"{_VEHICLE_FIELD}.type", "TYPE", _index_by_osi_name(_VEHICLE_CLASSES, ACTOR_CLASSES)),
    "indicator": (f"{_VEHICLE_FIELD}.light_state.indicator_state", "INDICATOR_STATE", _index_by_osi_name(INDICATOR_NAMES, INDICATORS)),
    "brake_light": (
        f"{_VEHICLE_FIELD}.light_state.brake_light_state", "BRAKE_LIGHT_STATE", _index_by_osi_name(BRAKE_LIGHT_NAMES, BRAKE_LIGHTS),
    ),
    "lamp": (f"{_VEHICLE_FIELD}.light_state.head_light", "GENERIC_LIGHT_STATE", _LAMP_CODES),
    "color": ("traffic_light.classification.color", "COLOR", {"RED": RED, "YELLOW": AMBER, "GREEN": GREEN}),
    "mode": (
        "traffic_light.classification.mode", "MODE", {"OFF": 0, "FLASHING": FLASHING, "CONSTANT": LIT, "COUNTING": LIT},
    ),
}  # fmt: skip
"""Attribute -> the ground truth's field with its enumeration, the prefix of the enumeration's names, and the names' codes."""


class EnumCodes:
    """The codes of OSI's enumeration numbers for one schema; -1 for UNKNOWN, OTHER and all other names that are not in `_ENUMERATIONS`."""

    def __init__(self, types: SchemaTypes, message_type: str) -> None:
        """Build the tables from the enumerations of the ground-truth message `message_type`."""
        self._tables = {}
        for attribute, (path, prefix, codes) in _ENUMERATIONS.items():
            names = enum_names(types, message_type, *path.split("."))
            code_by_name = {f"{prefix}_{name}": code for name, code in codes.items()}
            table = np.full(max(names, default=0) + 2, -1, np.int8)
            for number, name in names.items():
                if number >= 0:
                    table[number] = code_by_name.get(name, -1)
            self._tables[attribute] = table

    def codes(self, attribute: str, numbers: pa.Array) -> Codes:
        """Return the codes of an attribute's enumeration numbers; -1 for unknown or missing numbers."""
        table = self._tables[attribute]
        index = pc.fill_null(numbers.cast(pa.int32()), -1).to_numpy(zero_copy_only=False)
        return np.asarray(table[np.where((index < 0) | (index >= len(table)), len(table) - 1, index)], np.int8)


def moving_object_codes(enum_codes: EnumCodes, objects: pa.Array) -> dict[str, Codes]:
    """Return class, indicator, brake light and headlights of moving objects as codes. A vehicle of unknown type is a `vehicle`."""
    vehicle = struct_field(objects, "vehicle_classification")
    lights = struct_field(vehicle, "light_state")
    kind = enum_codes.codes("kind", struct_field(objects, "type"))
    finer = enum_codes.codes("vehicle", struct_field(vehicle, "type"))
    is_vehicle = kind == ACTOR_CLASSES.index("vehicle")
    return {
        "actor_class": np.where(is_vehicle & (finer >= 0), finer, kind),
        "indicator": enum_codes.codes("indicator", struct_field(lights, "indicator_state")),
        "brake_light": enum_codes.codes("brake_light", struct_field(lights, "brake_light_state")),
        HEADLIGHTS: _headlight_codes(
            *(enum_codes.codes("lamp", struct_field(lights, lamp)) for lamp in ("head_light", "high_beam"))
        ),
    }


def _headlight_codes(dipped_beam: Codes, main_beam: Codes) -> Codes:
    """Return `ON` where dipped or main beam is on, `OFF` where dipped beam is off and main beam off or unknown; otherwise -1.

    Other states, such as flashing, are unknown.
    """
    off = (dipped_beam == OFF) & np.isin(main_beam, (OFF, -1))
    return np.where((dipped_beam == ON) | (main_beam == ON), ON, np.where(off, OFF, -1)).astype(np.int8)


def bulb_state_rows(enum_codes: EnumCodes, truth: pa.Array, light_by_bulb: Mapping[str, str]) -> pa.Table:
    """Return one row per message and bulb of a traffic light: frame, id of the signal, and bit of the bulb's state.

    The signal is the OpenDRIVE signal to which the bulb refers, otherwise the light in `light_by_bulb`, otherwise the bulb alone. A bulb
    that is out of service is covered, crossed out or switched off: it is dark, whatever its colour and mode.
    """
    bulbs, frame = list_items_and_row_indices(truth, "traffic_light")
    classification = struct_field(bulbs, "classification")
    mode, color = (
        enum_codes.codes(attribute, struct_field(classification, attribute)) for attribute in ("mode", "color")
    )
    light = np.where(mode == LIT, color, mode)
    out_of_service = pc.fill_null(struct_field(classification, "is_out_of_service").cast(pa.bool_()), False)
    light = np.where(out_of_service.to_numpy(zero_copy_only=False), 0, light)
    bits = np.where(light < 0, UNKNOWN, light).astype(np.int8)
    return pa.table(
        {"frame": frame, "signal_id": pa.array(_signal_ids(bulbs, light_by_bulb), pa.string()), "bits": bits}
    )


def _signal_ids(bulbs: pa.Array, light_by_bulb: Mapping[str, str]) -> list[str]:
    bulb_ids = integer_values(struct_field(bulbs, "id"), "value", pa.uint64()).tolist()
    references = struct_field(bulbs, "source_reference").to_pylist()
    ids = []
    for number, sources in zip(bulb_ids, references, strict=True):  # a loop is fast enough, because bulbs are few
        names = [
            s["identifier"][0] for s in sources or [] if s.get("type") == OPEN_DRIVE_REFERENCE and s.get("identifier")
        ]
        ids.append(names[0] if names else light_by_bulb.get(str(number), str(number)))
    return ids


def signal_states(bulbs: pa.Table, t_ns: NDArray[np.int64]) -> pa.Table | None:
    """Return the state of each signal in each frame, joined from its bulbs; None without bulbs. `t_ns`: the time of each frame."""
    if not bulbs.num_rows:
        return None
    different = bulbs.group_by(["frame", "signal_id", "bits"]).aggregate([])
    shown_bits = different.group_by(["frame", "signal_id"]).aggregate([("bits", "sum")])
    states = [
        None if value & UNKNOWN else "flashing" if value & FLASHING else _STATE_BY_LIT_BITS.get(value)
        for value in range(2 * UNKNOWN)
    ]
    return pa.table(
        {
            "signal_id": shown_bits["signal_id"],
            "t_ns": pa.array(t_ns[shown_bits["frame"].to_numpy()]),
            "state": pa.array(states, pa.string()).take(shown_bits["bits_sum"]),
        }
    )
