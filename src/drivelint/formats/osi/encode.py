"""Ground-truth messages from whole columns: moving objects of one shape are laid out together, byte for byte.

A moving object's bytes depend on its values only where a number stands; what is present and how long its id is decides the
rest. So objects that agree in this *shape* are one table of bytes, into which numpy writes the columns of numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS
from drivelint.formats.osi.enum_codes import BRAKE_LIGHT_NAMES, INDICATOR_NAMES
from drivelint.formats.osi.schema import OPEN_DRIVE_REFERENCE, VERSION, enum_numbers
from drivelint.formats.protobuf.wire import (
    BYTES,
    FIXED64,
    VARINT,
    double_column,
    integer,
    join_columns,
    nested,
    tag,
    varint,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from drivelint.formats.protobuf.wire import Bytes

BLOCK_ROWS: Final = 1 << 14
"""Objects laid out at a time: enough to be quick, few enough to need only some tens of MB."""
_VECTORS: Final[dict[str, tuple[int, tuple[tuple[int, str], ...]]]] = {
    "dimension": (1, ((1, "length_m"), (2, "width_m"), (3, "height_m"))),
    "position": (2, ((1, "x_m"), (2, "y_m"), (3, "z_m"))),
    "orientation": (3, ((3, "yaw_rad"),)),
    "velocity": (4, ((1, "vx_mps"), (2, "vy_mps"))),
    "acceleration": (5, ((1, "ax_mps2"), (2, "ay_mps2"))),
}
"""Vector of `MovingObject.base` -> its field number and coordinates (field number, our column)."""
_OPTIONAL: Final = frozenset({"length_m", "width_m", "height_m", "z_m"})
"""Coordinates that may be left out of a vector; without any other one the whole vector is."""
_ALL: Final = tuple(column for _, parts in _VECTORS.values() for _, column in parts)


_VEHICLES: Final = {
    "car": "MEDIUM_CAR", "van": "DELIVERY_VAN", "truck": "HEAVY_TRUCK", "bus": "BUS", "motorcycle": "MOTORBIKE",
    "bicycle": "BICYCLE", "trailer": "TRAILER", "vehicle": "UNKNOWN",
}  # fmt: skip
_TYPES: Final = {
    "pedestrian": "PEDESTRIAN", "animal": "ANIMAL", "object": "OTHER", **dict.fromkeys(_VEHICLES, "VEHICLE"),
}  # fmt: skip
_CLASSIFICATION: Final = "MovingObject.VehicleClassification"
_CODES: Final[dict[str, tuple[str, tuple[str, ...], str, Mapping[str, str]]]] = {
    "type": ("actor_class", ACTOR_CLASSES, "MovingObject.Type", _TYPES),
    "vehicle": ("actor_class", ACTOR_CLASSES, f"{_CLASSIFICATION}.Type", _VEHICLES),
    "indicator": (
        "indicator", INDICATORS, f"{_CLASSIFICATION}.LightState.IndicatorState",
        {word: name for name, word in INDICATOR_NAMES.items()},
    ),
    "brake_light": (
        "brake_light", BRAKE_LIGHTS, f"{_CLASSIFICATION}.LightState.BrakeLightState",
        {word: name for name, word in BRAKE_LIGHT_NAMES.items()},
    ),
}  # fmt: skip
"""Field -> its code, the words that the code indexes, their enumeration, and the name that each word has in it."""
_COLOR, _MODE = "TrafficLight.Classification.Color", "TrafficLight.Classification.Mode"
_BULBS: Final[dict[str | None, tuple[tuple[str, str], ...]]] = {
    "red": (("RED", "CONSTANT"),),
    "red_amber": (("RED", "CONSTANT"), ("YELLOW", "CONSTANT")),
    "amber": (("YELLOW", "CONSTANT"),),
    "green": (("GREEN", "CONSTANT"),),
    "flashing": (("YELLOW", "FLASHING"),),
    "off": (("YELLOW", "OFF"),),
    None: (("UNKNOWN", "UNKNOWN"),),
}


@dataclass(frozen=True)
class Objects:
    """Moving objects as columns, one row each: OSI id, the columns of `_VECTORS` (NaN: unknown), codes (-1: unknown).

    `codes`: `actor_class`, `indicator` and `brake_light` as indices into the words of ingest. `heights`: the log has
    heights, so that z is written as NaN where it is not known (left out, it would read as 0).
    """

    number: NDArray[np.uint64]
    values: Mapping[str, NDArray[np.float64]]
    codes: Mapping[str, NDArray[np.int8]]
    heights: bool

    def __len__(self) -> int:
        return len(self.number)

    def take(self, rows: NDArray[np.intp]) -> Objects:
        """Return the chosen rows."""
        values = {name: column[rows] for name, column in self.values.items()}
        codes = {name: column[rows] for name, column in self.codes.items()}
        return Objects(self.number[rows], values, codes, self.heights)


def ground_truth_head(t_ns: int, host: int | None) -> bytes:
    """Return the beginning of a ground truth: version, time stamp and, where there is one, the host vehicle's id."""
    version = b"".join(integer(number, value) for number, value in enumerate(VERSION, 1))
    seconds, nanos = divmod(t_ns, 1_000_000_000)
    # a negative int64 is written as its two's complement
    stamp = integer(1, seconds % (1 << 64)) + integer(2, nanos)
    return nested(1, version) + nested(2, stamp) + (b"" if host is None else nested(3, integer(1, host)))


def traffic_light(signal_id: str, state: str | None, numbers: Sequence[int]) -> bytes:
    """Return a signal's state as fields of a ground truth: a bulb per lit colour, each naming the signal of the map.

    `numbers`: an id for each of its bulbs, at most two.
    """
    reference = nested(5, nested(2, OPEN_DRIVE_REFERENCE.encode()) + nested(3, signal_id.encode()))
    bulbs = (
        nested(1, integer(1, number))
        + nested(3, integer(1, enum_numbers(_COLOR)[color]) + integer(3, enum_numbers(_MODE)[mode]))
        + reference
        for number, (color, mode) in zip(numbers, _BULBS[state], strict=False)
    )
    return b"".join(nested(7, bulb) for bulb in bulbs)


def moving_objects(objects: Objects) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Return the bytes of all objects in order, each a field of a ground truth, and where each begins (n + 1 offsets)."""
    shapes, shape = np.unique(_shape(objects), return_inverse=True)
    sizes = np.array([_encoded(int(key), objects, np.zeros(0, np.intp)).shape[1] for key in shapes], np.int64)
    starts = np.concatenate([[0], np.cumsum(sizes[shape])]) if len(objects) else np.zeros(1, np.int64)
    data = np.empty(int(starts[-1]), np.uint8)
    for k, key in enumerate(shapes):
        rows = np.flatnonzero(shape == k)
        for first in range(0, len(rows), BLOCK_ROWS):
            some = rows[first : first + BLOCK_ROWS]
            data[starts[some][:, None] + np.arange(sizes[k])] = _encoded(int(key), objects, some)
    return data, starts


def _shape(objects: Objects) -> NDArray[np.int64]:
    """Return a number per object that says which coordinates and lights it has, and how many bytes its id takes."""
    key = np.ones(len(objects), np.int64)
    key += sum((objects.number >> np.uint64(7 * k) > 0).astype(np.int64) for k in range(1, 10))
    for i, column in enumerate(_ALL, 4):
        known = np.isfinite(objects.values[column])
        key |= (known | (column == "z_m" and objects.heights)).astype(np.int64) << i
    for i, code in enumerate(("indicator", "brake_light"), 4 + len(_ALL)):
        key |= (objects.codes[code] >= 0).astype(np.int64) << i
    vehicle = np.array([*(word in _VEHICLES for word in ACTOR_CLASSES), False])[objects.codes["actor_class"]]
    return key | vehicle.astype(np.int64) << (6 + len(_ALL))


def _encoded(key: int, objects: Objects, rows: NDArray[np.intp]) -> Bytes:
    """Return the bytes of objects of one shape, a row each, from the tag of the field that holds it on."""
    known = {column for i, column in enumerate(_ALL, 4) if key >> i & 1}
    base: list[bytes | Bytes] = []
    for number, coordinates in _VECTORS.values():
        must = {column for _, column in coordinates} - _OPTIONAL
        fields: list[bytes | Bytes] = []
        for n, column in coordinates:
            if column in known:
                fields += [tag(n, FIXED64), double_column(objects.values[column][rows])]
        if fields and must <= known:
            base += _nested(number, *fields)
    parts = [
        *_nested(1, tag(1, VARINT), _varints(objects.number[rows], key & 15)),
        *_nested(2, *base),
        *(tag(3, VARINT), _numbers("type", objects, rows)),
    ]
    if lit := key >> (4 + len(_ALL)):
        lights: list[bytes | Bytes] = [tag(1, VARINT), _numbers("indicator", objects, rows)] if lit & 1 else []
        lights += [tag(7, VARINT), _numbers("brake_light", objects, rows)] if lit & 2 else []
        state = _nested(2, *lights) if lights else []
        parts += _nested(6, tag(1, VARINT), _numbers("vehicle", objects, rows), *state)
    return join_columns(len(rows), *_nested(5, *parts))


def _nested(number: int, *parts: bytes | Bytes) -> list[bytes | Bytes]:
    size = sum(len(part) if isinstance(part, bytes) else part.shape[1] for part in parts)
    return [tag(number, BYTES) + varint(size), *parts]


def _varints(numbers: NDArray[np.uint64], size: int) -> Bytes:
    groups = numbers[:, None] >> (np.arange(size, dtype=np.uint64) * np.uint64(7))
    more = np.where(np.arange(size) < size - 1, 0x80, 0).astype(np.uint64)
    return (groups & np.uint64(0x7F) | more).astype(np.uint8)


def _numbers(field: str, objects: Objects, rows: NDArray[np.intp]) -> Bytes:
    """Return the numbers of an enumeration, all below 128."""
    code, words, enum, names = _CODES[field]
    numbers = {word: enum_numbers(enum)[name] for word, name in names.items()}
    table = np.array([*(numbers.get(word, 0) for word in words), 0], np.uint8)  # the last is for code -1, unknown
    return table[objects.codes[code][rows]][:, None]
