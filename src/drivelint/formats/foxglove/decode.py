"""Decodes batches of Foxglove messages in protobuf or JSON to Arrow structs that have only the fields that are read.

Schemas: https://docs.foxglove.dev/docs/visualization/message-schemas. Times are `seconds` and `nanos` in protobuf, `sec` and
`nsec` in JSON, which may be fractions.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import json

from drivelint.formats.protobuf.descriptors import decode_batch, message_decoder, parse_schema, struct_field

if TYPE_CHECKING:
    from pathlib import Path

    from mcap.records import Schema
    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Mask, Times
    from drivelint.formats.coordinate_frames import Vectors
    from drivelint.formats.mcap.reader import LogMessage
    from drivelint.formats.protobuf.descriptors import FieldTree

SCENE: Final = "foxglove.SceneUpdate"
TRANSFORM: Final = "foxglove.FrameTransform"
TRANSFORMS: Final = "foxglove.FrameTransforms"
_TIME_FIELDS: Final = {"seconds": None, "nanos": None, "sec": None, "nsec": None}
_XYZ_FIELDS: Final = {"x": None, "y": None, "z": None}
_QUATERNION_FIELDS: Final = {**_XYZ_FIELDS, "w": None}
_POSE_FIELDS: Final = {"position": _XYZ_FIELDS, "orientation": _QUATERNION_FIELDS}
_TRANSFORM_FIELDS: Final = {
    "timestamp": _TIME_FIELDS, "parent_frame_id": None, "child_frame_id": None, "translation": _XYZ_FIELDS, "rotation": _QUATERNION_FIELDS,
}  # fmt: skip
FIELD_TREES: Final[dict[str, FieldTree]] = {
    SCENE: {
        "deletions": {"timestamp": _TIME_FIELDS, "type": None, "id": None},
        "entities": {
            "timestamp": _TIME_FIELDS,
            "frame_id": None,
            "id": None,
            "lifetime": _TIME_FIELDS,
            "frame_locked": None,
            "metadata": {"key": None, "value": None},
            **{name: {"pose": _POSE_FIELDS, "size": _XYZ_FIELDS} for name in ("cubes", "cylinders", "spheres")},
            "models": {"pose": _POSE_FIELDS},
        },
    },
    TRANSFORM: _TRANSFORM_FIELDS,
    TRANSFORMS: {"transforms": _TRANSFORM_FIELDS},
}
_LIST_FIELDS: Final = frozenset(
    {"deletions", "entities", "metadata", "cubes", "cylinders", "spheres", "models", "transforms"}
)
_TEXT_FIELDS: Final = frozenset({"id", "frame_id", "key", "value", "parent_frame_id", "child_frame_id"})
_MIN_JSON_BLOCK_BYTES: Final = 1 << 20


def decoded_rows(path: Path, schema: Schema, log_messages: list[LogMessage]) -> pa.StructArray:
    """Decode a batch of messages with one schema and encoding to one struct per message.

    Errors: `TraceError` with the first message that cannot be decoded, or if the log's schema does not describe the message.
    """
    tree = FIELD_TREES[schema.name]
    if log_messages[0].channel.message_encoding == "json":
        return decode_batch(path, log_messages, partial(_json_rows, pa.schema(_json_fields(tree))))
    types = parse_schema(path, schema.name, schema.data)
    return decode_batch(path, log_messages, message_decoder(path, types, schema.name, tree))


def _json_rows(schema: pa.Schema, messages: list[bytes]) -> pa.StructArray:
    # JSON strings contain no raw line breaks, so each message can be put on one line
    lines = [message.replace(b"\n", b" ").replace(b"\r", b" ") for message in messages]
    parse = json.ParseOptions(explicit_schema=schema, unexpected_field_behavior="ignore")
    block = json.ReadOptions(block_size=max(_MIN_JSON_BLOCK_BYTES, 2 * max(map(len, lines)) + 2))
    text = b"\n".join(lines)
    text.decode()  # raises for invalid UTF-8, which the library would only notice when the texts are used
    table = json.read_json(pa.BufferReader(text), block, parse).combine_chunks()
    if table.num_rows != len(messages):
        raise ValueError(f"{len(messages)} messages hold {table.num_rows} JSON objects")
    columns = [table.column(name).chunk(0) for name in schema.names]
    return pa.StructArray.from_arrays(columns, fields=list(schema))


def _json_fields(tree: FieldTree) -> list[pa.Field]:
    fields = []
    for name, subtree in tree.items():
        if subtree is not None:
            inner = pa.struct(_json_fields(subtree))
            kind = pa.list_(inner) if name in _LIST_FIELDS else inner
        elif name in _TEXT_FIELDS:
            kind = pa.string()
        else:
            kind = pa.bool_() if name == "frame_locked" else pa.float64()
        fields.append(pa.field(name, kind))
    return fields


def times(stamp: pa.Array) -> tuple[Times, Mask]:
    """Return times or durations in nanoseconds (0 if missing), and for each row whether it is present."""
    whole, rest = (_first_finite(stamp, names) for names in (("seconds", "sec"), ("nanos", "nsec")))
    seconds = np.floor(whole)
    t_ns = seconds.astype(np.int64) * 1_000_000_000 + np.rint((whole - seconds) * 1e9 + rest).astype(np.int64)
    return t_ns, stamp.is_valid().to_numpy(zero_copy_only=False)


def _first_finite(parent: pa.Array, names: tuple[str, ...]) -> Floats:
    """Return for each row the first finite member of `names`; 0 if there is none, because protobuf does not write zeros."""
    result = np.zeros(len(parent))
    for name in reversed(names):
        values = numbers(parent, name)
        result = np.where(np.isfinite(values), values, result)
    return result


def numbers(parent: pa.Array, name: str) -> Floats:
    """Return a member as doubles; NaN if it is missing."""
    values: Floats = struct_field(parent, name).cast(pa.float64()).to_numpy(zero_copy_only=False)
    return values


def vectors(parent: pa.Array, name: str, axes: str = "xyz") -> Vectors:
    """Return vectors with one column per axis: 0 for a missing axis, because protobuf omits zeros, and NaN for a missing vector."""
    inner = struct_field(parent, name)
    there = inner.is_valid().to_numpy(zero_copy_only=False)
    columns = [
        pc.fill_null(struct_field(inner, axis).cast(pa.float64()), 0.0).to_numpy(zero_copy_only=False) for axis in axes
    ]  # a NaN in the log stays NaN
    return np.where(there[:, None], np.stack(columns, axis=1), np.nan)


def distinct_texts(parent: pa.Array, name: str) -> tuple[list[str], NDArray[np.int32]]:
    """Return the distinct texts of a member ('' if it is missing), and each row's index in them."""
    column = struct_field(parent, name)
    if pa.types.is_null(column.type):
        return [""], np.zeros(len(column), np.int32)
    coded = pc.fill_null(column.cast(pa.string()), "").dictionary_encode()
    return coded.dictionary.to_pylist(), coded.indices.to_numpy(zero_copy_only=False)
