"""Decodes batches of OSI messages (ground truth or sensor views) to arrays of the fields that are read."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from google.protobuf.message import DecodeError

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError
from drivelint.formats.osi import signal_heads as osi_heads
from drivelint.formats.osi.enum_codes import EnumCodes, bulb_state_rows, moving_object_codes
from drivelint.formats.osi.schema import GROUND_TRUTH, SENSOR_VIEW, message_class
from drivelint.formats.osi.stationary import STATIONARY_FIELDS, Outlines, kind_by_number, outlines
from drivelint.formats.protobuf.descriptors import (
    decode_batch,
    integer_values,
    list_items_and_row_indices,
    message_decoder,
    parse_schema,
    struct_field,
)
from drivelint.road.countries import nation_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Floats, Indices, Mask
    from drivelint.formats.mcap.reader import LogMessage
    from drivelint.formats.protobuf.descriptors import FieldTree

_XY: FieldTree = {"x": None, "y": None}
_ID: FieldTree = {"value": None}
_TIMESTAMP: FieldTree = {"seconds": None, "nanos": None}
_LAMPS: FieldTree = {"indicator_state": None, "brake_light_state": None, "head_light": None, "high_beam": None}
_GROUND_TRUTH_FIELDS: FieldTree = {
    "timestamp": _TIMESTAMP,
    "host_vehicle_id": _ID,
    "moving_object": {
        "id": _ID,
        "type": None,
        "base": {
            "dimension": {"length": None, "width": None, "height": None},
            "position": {**_XY, "z": None},
            "orientation": {"yaw": None},
            "velocity": _XY,
            "acceleration": _XY,
        },
        "vehicle_classification": {"type": None, "light_state": _LAMPS},
    },
    "stationary_object": STATIONARY_FIELDS,
    "traffic_light": {
        "id": _ID,
        "classification": {"color": None, "mode": None, "is_out_of_service": None},
        "source_reference": {"type": None, "identifier": None},
    },
}
FIELD_TREES: dict[str, FieldTree] = {
    GROUND_TRUTH: _GROUND_TRUTH_FIELDS,
    SENSOR_VIEW: {"timestamp": _TIMESTAMP, "host_vehicle_id": _ID, "global_ground_truth": _GROUND_TRUTH_FIELDS},
}
COLUMNS_BY_VECTOR: dict[str, dict[str, str]] = {
    "position": {"x_m": "x", "y_m": "y", "z_m": "z"},
    "orientation": {"yaw_rad": "yaw"},
    "velocity": {"vx_mps": "x", "vy_mps": "y"},
    "acceleration": {"ax_mps2": "x", "ay_mps2": "y"},
    "dimension": {"length_m": "length", "width_m": "width", "height_m": "height"},
}
"""Vector of `moving_object.base` -> drivelint's column -> OSI's coordinate."""
_LANE_FIELDS = ("lane_boundary", "lane", "reference_line", "logical_lane_boundary", "logical_lane")
_LIST_FIELDS = frozenset({"identifier"})
"""Values that are lists in OSI."""
_NEVER_ZERO_VECTORS = frozenset({"position", "dimension"})
"""Vectors that are unknown if all coordinates are missing, even if the writer omits zeros."""


@dataclass(frozen=True)
class FrameBatch:
    """A decoded batch. Per frame: the message's time, whether it has one (`has_time`), and the host's id (None: missing).

    Per object with an id: its frame, id, columns of `STATE_COLUMNS` and `SIZE_COLUMNS` (NaN: unknown), and codes.
    `frames_of_nameless`: the frame of each object without an id. `missing_coordinates`: column -> whether the coordinate is missing
    but means 0 if the writer omits zeros. `has_zeros`: whether any coordinate is written as 0, which shows that the writer does not
    omit zeros.
    """

    t_ns: NDArray[np.int64]
    has_time: Mask
    hosts: list[int | None]
    frame: Indices
    ids: NDArray[np.uint64]
    frames_of_nameless: Indices
    numbers: dict[str, Floats]
    codes: dict[str, Codes]
    not_finite: Mask
    missing_coordinates: dict[str, Mask]
    has_zeros: bool
    bulbs: pa.Table
    outlines: Outlines


class Decoder:
    """Decodes messages of one schema record."""

    def __init__(self, path: Path, schema_id: int, message_type: str, descriptor_set: bytes) -> None:
        """Prune the schema to the fields that are read. Errors: `TraceError` if it has no ids or positions of moving objects."""
        self._path, self._name, self.schema_id = path, message_type, schema_id
        self.lights: Mapping[str, str] = {}  # bulb id -> traffic light id, from the first message
        types = parse_schema(path, message_type, descriptor_set)
        self._decode = message_decoder(path, types, message_type, FIELD_TREES[message_type])
        kind = self._decode([]).type
        truth = _struct_type_of_field(kind, "global_ground_truth") if message_type == SENSOR_VIEW else kind
        base = _struct_type_of_field(_struct_type_of_field(truth, "moving_object"), "base")
        if (
            _struct_type_of_field(base, "position") is None
            or _struct_type_of_field(_struct_type_of_field(truth, "moving_object"), "id") is None
        ):
            raise TraceError(
                f"{path}: the schema {message_type} in the log has no moving_object with id and base.position: not OSI 3"
            )
        if (repeated := _path_of_unexpected_list(kind, FIELD_TREES[message_type])) is not None:
            raise TraceError(f"{path}: the schema {message_type} in the log has {repeated} as a list: not OSI 3")
        self._words = EnumCodes(types, GROUND_TRUTH)
        self._stationary_kinds = kind_by_number(types)

    def frames(self, log_messages: list[LogMessage]) -> FrameBatch:
        """Decode a batch. Errors: `TraceError` with topic and byte of the first message that cannot be decoded."""
        message = decode_batch(self._path, log_messages, self._decode)
        truth = struct_field(message, "global_ground_truth") if self._name == SENSOR_VIEW else message
        (t_ns, timed), (outer_ns, outer_timed) = _times_ns_and_presence(truth), _times_ns_and_presence(message)
        objects, frame = list_items_and_row_indices(truth, "moving_object")
        base = struct_field(objects, "base")
        numbers, left_out, not_finite = {}, {}, np.zeros(len(objects), np.bool_)
        says_zero = False
        for vector, columns in COLUMNS_BY_VECTOR.items():
            values = struct_field(base, vector)
            present = values.is_valid().to_numpy(zero_copy_only=False)
            for column, coordinate in columns.items():
                numbers[column], is_present = _coordinate_and_presence(values, coordinate)
                left_out[column] = present & ~is_present
                not_finite |= is_present & np.isnan(numbers[column])
                says_zero = says_zero or bool((numbers[column] == 0.0).any())
            if vector in _NEVER_ZERO_VECTORS:
                empty = np.logical_and.reduce([left_out[column] for column in columns])
                left_out |= {column: left_out[column] & ~empty for column in columns}
        left_out = {column: rows for column, rows in left_out.items() if rows.any()}
        ids = struct_field(objects, "id")
        number = integer_values(ids, "value", pa.uint64())
        codes = moving_object_codes(self._words, objects)
        nameless = frame[:0]
        if ids.null_count:
            has_id = ids.is_valid().to_numpy(zero_copy_only=False)
            nameless = frame[~has_id]
            frame, number, not_finite = frame[has_id], number[has_id], not_finite[has_id]
            numbers = {name: column[has_id] for name, column in numbers.items()}
            left_out = {name: rows[has_id] for name, rows in left_out.items()}
            codes = {name: column[has_id] for name, column in codes.items()}
        return FrameBatch(
            np.where(timed, t_ns, outer_ns), timed | outer_timed,
            pc.coalesce(_host_vehicle_ids(truth), _host_vehicle_ids(message)).to_pylist(),
            frame, number, nameless, numbers, codes, not_finite, left_out, says_zero,
            bulb_state_rows(self._words, truth, self.lights),
            outlines(truth, self._stationary_kinds),
        )  # fmt: skip


class FirstMessageFacts(NamedTuple):
    """Data that only the first message of a trace has.

    `lanes`: lanes and road furniture as a serialised ground truth; `reference`, `geo_offset`: the geo reference; `findings`: lanes
    without a width. `lights`: see `osi_heads.light_by_bulb`. `nation`: the country in two letters, from its ISO 3166-1 number.
    """

    lanes: bytes | None = None
    reference: str | None = None
    findings: tuple[QualityFinding, ...] = ()
    lights: Mapping[str, str] = MappingProxyType({})
    geo_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    nation: str | None = None


def read_first_message(data: bytes, message_type: str) -> FirstMessageFacts:
    """Return lanes, geo reference (a PROJ string, with x, y and yaw) and country of a ground truth or a sensor view.

    `lanes` includes boundaries, signs, lights and road markings. If no lane has boundaries, there is no map, because the lanes have
    no width; this is a finding.
    """
    try:
        outer = message_class(message_type.removeprefix("osi3.")).FromString(data)
    except DecodeError:
        return FirstMessageFacts()  # a damaged message is reported when its objects are decoded
    truth = outer.global_ground_truth if message_type == SENSOR_VIEW else outer
    reference = str(truth.proj_string) or None
    lights = osi_heads.light_by_bulb(truth.traffic_light)
    frame = truth.proj_frame_offset
    head = FirstMessageFacts(None, reference, (), lights, (frame.position.x, frame.position.y, frame.yaw))
    head = head._replace(nation=nation_of(int(truth.country_code)))
    if not (truth.lane_boundary or truth.logical_lane_boundary):
        n = len(truth.lane) + len(truth.logical_lane)
        message = (
            f"the log has {n} lanes, all without boundaries: without widths, they cannot be used as a map: give --map"
        )
        return head._replace(findings=(QualityFinding("lanes_without_width", "info", message, n),) if n else ())
    if not (truth.lane or truth.logical_lane):
        return head
    lanes, beside = message_class("GroundTruth")(), message_class("GroundTruth")()
    for field in _LANE_FIELDS:
        getattr(lanes, field).extend(getattr(truth, field))
    beside.traffic_sign.extend(truth.traffic_sign)
    beside.traffic_light.extend(osi_heads.bulb_without_state(bulb, lights) for bulb in truth.traffic_light)
    beside.road_marking.extend(truth.road_marking)
    # the map format is recognised by its first tag, so lanes must come first
    content = b"".join(part.SerializeToString(deterministic=True) for part in (lanes, beside))
    return head._replace(lanes=content)


def _path_of_unexpected_list(struct_type: pa.DataType, tree: FieldTree) -> str | None:
    """Return the path of the first value in a schema that is a list or a message, where OSI has one value; None: there is none."""
    for name, inner in tree.items():
        at = struct_type.get_field_index(name)
        if at < 0:
            continue
        kind = struct_type.field(at).type
        if inner is None:
            if pa.types.is_nested(kind) and name not in _LIST_FIELDS:
                return name
        elif (items := _struct_type_of_field(struct_type, name)) is not None and (
            path := _path_of_unexpected_list(items, inner)
        ) is not None:
            return f"{name}.{path}"
    return None


def _struct_type_of_field(struct_type: pa.DataType | None, name: str) -> pa.DataType | None:
    """Return the struct type of a field, or of the items of a list field; None if there is no such field."""
    if struct_type is None or struct_type.get_field_index(name) < 0:
        return None
    kind = struct_type.field(struct_type.get_field_index(name)).type
    kind = kind.value_type if pa.types.is_list(kind) else kind
    return kind if pa.types.is_struct(kind) else None


def _coordinate_and_presence(vector: pa.Array, name: str) -> tuple[Floats, Mask]:
    """Return a coordinate (NaN if missing or not finite), and for each row whether it is present."""
    values = struct_field(vector, name).cast(pa.float64())
    is_present = values.is_valid().to_numpy(zero_copy_only=False)
    numbers = pc.fill_null(values, float("nan")).to_numpy(zero_copy_only=False)
    return np.where(np.isfinite(numbers), numbers, np.nan), is_present


def _times_ns_and_presence(message: pa.Array) -> tuple[NDArray[np.int64], Mask]:
    stamp = struct_field(message, "timestamp")
    seconds, nanos = (integer_values(stamp, name, pa.int64()) for name in ("seconds", "nanos"))
    return seconds * 1_000_000_000 + nanos, stamp.is_valid().to_numpy(zero_copy_only=False)


def _host_vehicle_ids(message: pa.Array) -> pa.Array:
    host = struct_field(message, "host_vehicle_id")
    value = pc.fill_null(struct_field(host, "value").cast(pa.uint64()), 0)
    return pc.if_else(host.is_valid(), value, pa.scalar(None, pa.uint64()))
