"""Encodes columns as OSI ground-truth messages: Arrow structs with OSI's nesting are built, and ptars serialises them."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import ptars
import pyarrow as pa

from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS
from drivelint.formats.osi.decode import COLUMNS_BY_VECTOR
from drivelint.formats.osi.enum_codes import BRAKE_LIGHT_NAMES, INDICATOR_NAMES
from drivelint.formats.osi.schema import OPEN_DRIVE_REFERENCE, WRITTEN_OSI_VERSION, enum_numbers, message_class

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Floats, Mask, Times

_OMISSIBLE_COORDINATES: Final = frozenset({"length_m", "width_m", "height_m", "z_m"})
"""Coordinates that may be missing in a vector; if any other coordinate is missing, the whole vector is left out."""
_OSI_VEHICLE_TYPES: Final = {
    "car": "MEDIUM_CAR", "van": "DELIVERY_VAN", "truck": "HEAVY_TRUCK", "bus": "BUS", "motorcycle": "MOTORBIKE",
    "bicycle": "BICYCLE", "trailer": "TRAILER", "vehicle": "UNKNOWN",
}  # fmt: skip
_OSI_OBJECT_TYPES: Final = {
    "pedestrian": "PEDESTRIAN", "animal": "ANIMAL", "object": "OTHER", **dict.fromkeys(_OSI_VEHICLE_TYPES, "VEHICLE"),
}  # fmt: skip
_VEHICLE_CLASSIFICATION: Final = "MovingObject.VehicleClassification"
_VEHICLE_LIGHT_STATE: Final = f"{_VEHICLE_CLASSIFICATION}.LightState"
_VEHICLE_LIGHT_FIELDS: Final = {
    "indicator_state": ("indicator", INDICATORS, "IndicatorState", {w: name for name, w in INDICATOR_NAMES.items()}),
    "brake_light_state": (
        "brake_light", BRAKE_LIGHTS, "BrakeLightState", {w: name for name, w in BRAKE_LIGHT_NAMES.items()},
    ),
}  # fmt: skip
"""Field -> column of codes, the words that the codes index, OSI's enumeration, and word -> OSI's name."""
_BULBS_BY_SIGNAL_STATE: Final[dict[str | None, tuple[tuple[str, str], ...]]] = {
    "red": (("RED", "CONSTANT"),),
    "red_amber": (("RED", "CONSTANT"), ("YELLOW", "CONSTANT")),
    "amber": (("YELLOW", "CONSTANT"),),
    "green": (("GREEN", "CONSTANT"),),
    "flashing": (("YELLOW", "FLASHING"),),
    "off": (("YELLOW", "OFF"),),
    None: (("UNKNOWN", "UNKNOWN"),),
}


def encode_ground_truths(
    t_ns: Times, host_id: int | None, objects: pa.StructArray, starts: NDArray[np.int64]
) -> pa.BinaryArray:
    """Return one ground truth per time, with version, time stamp and the host's id (None: left out).

    Message i has the objects from `starts[i]` to before `starts[i + 1]`.
    """
    n = len(t_ns)
    seconds, nanos = np.divmod(t_ns, 1_000_000_000)
    parts = ("version_major", "version_minor", "version_patch")
    rows = {
        "version": _struct_array(
            {name: np.full(n, part, np.uint32) for name, part in zip(parts, WRITTEN_OSI_VERSION, strict=True)}
        ),
        "timestamp": _struct_array({"seconds": seconds, "nanos": nanos.astype(np.uint32)}),
        "moving_object": pa.ListArray.from_arrays(pa.array(starts, pa.int32()), objects),
    }
    if host_id is not None:
        rows["host_vehicle_id"] = _struct_array({"value": np.full(n, host_id, np.uint64)})
    return _ground_truth_encoder().record_batch_to_array(pa.RecordBatch.from_pydict(rows))


@cache
def _ground_truth_encoder() -> Any:
    truth = message_class("GroundTruth").DESCRIPTOR
    return ptars.HandlerPool([truth.file]).get_for_message(truth)


def moving_objects(
    object_ids: NDArray[np.uint64], values: Mapping[str, Floats], codes: Mapping[str, Codes], *, log_has_heights: bool
) -> pa.StructArray:
    """Return moving objects as structs.

    `object_ids`: OSI ids; `values`: the columns of `COLUMNS_BY_VECTOR` (NaN: unknown); `codes`: indices in words such as `ACTOR_CLASSES`
    (-1: unknown).
    `log_has_heights`: whether the log has heights; then an unknown z is written as NaN, because a missing z would be read as 0.
    """
    base = {}
    for vector, columns in COLUMNS_BY_VECTOR.items():
        is_known = {column: np.isfinite(values[column]) | (column == "z_m" and log_has_heights) for column in columns}
        must = [rows for column, rows in is_known.items() if column not in _OMISSIBLE_COORDINATES]
        numbers = {name: pa.array(values[column], mask=~is_known[column]) for column, name in columns.items()}
        base[vector] = _struct_array(
            numbers, np.logical_and.reduce([np.logical_or.reduce([*is_known.values()]), *must])
        )
    lights = {
        field: pa.array(
            _codes_to_enum_numbers(codes[code], words, f"{_VEHICLE_LIGHT_STATE}.{enum}", names), mask=codes[code] < 0
        )
        for field, (code, words, enum, names) in _VEHICLE_LIGHT_FIELDS.items()
    }
    lit = (codes["indicator"] >= 0) | (codes["brake_light"] >= 0)
    kinds = codes["actor_class"]
    vehicle = {
        "type": _codes_to_enum_numbers(kinds, ACTOR_CLASSES, f"{_VEHICLE_CLASSIFICATION}.Type", _OSI_VEHICLE_TYPES),
        "light_state": _struct_array(lights, lit),
    }
    is_vehicle = np.array([*(word in _OSI_VEHICLE_TYPES for word in ACTOR_CLASSES), False])[kinds]
    return _struct_array({
        "id": _struct_array({"value": object_ids}), "base": _struct_array(base),
        "type": _codes_to_enum_numbers(kinds, ACTOR_CLASSES, "MovingObject.Type", _OSI_OBJECT_TYPES),
        "vehicle_classification": _struct_array(vehicle, is_vehicle | lit),
    })  # fmt: skip


def _struct_array(fields: Mapping[str, Any], is_valid: Mask | None = None) -> pa.StructArray:
    mask = None if is_valid is None else pa.array(~is_valid)
    return pa.StructArray.from_arrays([*fields.values()], [*fields], mask=mask)


def _codes_to_enum_numbers(
    codes: Codes, words: Sequence[str], enum: str, names: Mapping[str, str]
) -> NDArray[np.int32]:
    """Return the enumeration numbers of codes that index `words`; 0 for code -1, and for words without a name in `names`."""
    numbers = {word: enum_numbers(enum)[name] for word, name in names.items()}
    return np.array([*(numbers.get(word, 0) for word in words), 0], np.int32)[codes]


def encode_traffic_light(signal_id: str, state: str | None, bulb_ids: Sequence[int]) -> bytes:
    """Return a signal's state as serialised fields of a ground truth: one bulb per lit colour, each with a reference to the signal.

    `bulb_ids`: the ids of the bulbs, of which there are at most two.
    """
    bulbs = [
        {
            "id": {"value": number},
            "classification": {"color": f"COLOR_{color}", "mode": f"MODE_{mode}"},
            "source_reference": [{"type": OPEN_DRIVE_REFERENCE, "identifier": [signal_id]}],
        }
        for number, (color, mode) in zip(bulb_ids, _BULBS_BY_SIGNAL_STATE[state], strict=False)
    ]
    return bytes(message_class("GroundTruth")(traffic_light=bulbs).SerializeToString(deterministic=True))
