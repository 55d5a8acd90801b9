"""Messages to Arrow structs, a batch at a time, and the members of structs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import ptars
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.errors import TraceError
from drivelint.formats.protobuf.descriptors import pruned

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.formats.mcap.reader import Packet
    from drivelint.formats.protobuf.descriptors import FieldTree, Types

    Decode = Callable[[list[bytes]], pa.StructArray]


def decoder(path: Path, types: Types, name: str, tree: FieldTree) -> Decode:
    """Return a function that decodes messages `name`, one struct each, with those fields of `tree` that their schema has.

    Errors: `TraceError` when the log's schema contradicts itself. The function raises `ValueError`.
    """
    descriptor = pruned(path, types, name, tree)
    handler = ptars.HandlerPool([descriptor.file]).get_for_message(descriptor)

    def decode(messages: list[bytes]) -> pa.StructArray:
        rows = handler.list_to_record_batch(messages)
        return pa.StructArray.from_arrays(rows.columns, fields=list(rows.schema))

    return decode


def decoded(path: Path, packets: list[Packet], decode: Decode) -> pa.StructArray:
    """Decode a batch. Errors: `TraceError` naming topic and byte of the first message that cannot be decoded."""
    try:
        return decode([packet.data for packet in packets])
    except ValueError as error:
        if len(packets) == 1:
            raise packets[0].error(path, str(error).splitlines()[0]) from error
        for packet in packets:  # one of them spoilt the batch
            decoded(path, [packet], decode)
        raise TraceError(f"{path}: {len(packets)} messages cannot be decoded together: {error}") from error


def struct_field(parent: pa.Array, name: str) -> pa.Array:
    """Return a field of a struct array, null where the parent is; all null where the schema has no such field."""
    if pa.types.is_struct(parent.type) and parent.type.get_field_index(name) >= 0:
        return pc.struct_field(parent, [parent.type.get_field_index(name)])
    return pa.nulls(len(parent))


def list_items(rows: pa.Array, name: str) -> tuple[pa.Array, NDArray[np.int64]]:
    """Return the items of all lists called `name`, and the row that each is in."""
    lists = struct_field(rows, name)
    if not pa.types.is_list(lists.type):
        return pa.nulls(0), np.zeros(0, np.int64)
    return lists.flatten(), pc.list_parent_indices(lists).to_numpy(zero_copy_only=False)


def integers(rows: pa.Array, name: str, kind: pa.DataType) -> NDArray[Any]:
    """Return a field as integers, 0 where it is not there."""
    values: NDArray[Any] = pc.fill_null(struct_field(rows, name).cast(kind), 0).to_numpy(zero_copy_only=False)
    return values
