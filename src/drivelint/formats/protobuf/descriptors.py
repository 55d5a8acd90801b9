"""Reads protobuf schemas, and decodes messages to Arrow structs that have only the fields that are read.

Skipping all other fields makes decoding three times faster. Field numbers and types come from the descriptor set in the log's schema
record, so any version of a message can be read that has fields with these names.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import ptars
import pyarrow as pa
import pyarrow.compute as pc
from google.protobuf import descriptor_pb2, descriptor_pool
from google.protobuf.message import DecodeError

from drivelint.errors import TraceError

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterable, Mapping, Sequence
    from pathlib import Path

    from google.protobuf.descriptor_pb2 import DescriptorProto, EnumDescriptorProto, FileDescriptorProto
    from numpy.typing import NDArray

    from drivelint.formats.mcap.reader import LogMessage

    Decode = Callable[[list[bytes]], pa.StructArray]

FieldTree = dict[str, Any]
"""Field name -> subtree of a message field, or None for a value."""

_FIELD = descriptor_pb2.FieldDescriptorProto
PRUNED_PACKAGE = "pruned"
_SCALARS = {name.removeprefix("TYPE_").lower(): number for name, number in _FIELD.Type.items()}
"""Scalar type, as in a .proto file -> its number in a descriptor."""


class Declarations:
    """Messages and enumerations that are declared in TOML: name -> the words of each field or value."""

    def __init__(self, *tables: Mapping[str, Any]) -> None:
        """Merge several tables, each with the subtables `messages` and `enums`."""
        self.messages: dict[str, list[list[str]]] = {}
        self.enums: dict[str, list[list[str]]] = {}
        for table in tables:
            for own_table, more in ((self.messages, table["messages"]), (self.enums, table["enums"])):
                for name, items in more.items():
                    own_table.setdefault(name, []).extend(item.split() for item in items)


def add_field(
    message: DescriptorProto, declaration: Sequence[str], package: str, enums: Container[str]
) -> descriptor_pb2.FieldDescriptorProto:
    """Add a field to `message`, and return it. `declaration`: name, number and type (`[]`: repeated).

    A type that is no scalar belongs to `package`; `enums`: the names of enumerations.
    """
    name, number, kind = declaration
    plain = kind.removesuffix("[]")
    new_field = message.field.add(name=name, number=int(number))
    new_field.label = _FIELD.LABEL_REPEATED if kind != plain else _FIELD.LABEL_OPTIONAL
    new_field.type = _SCALARS.get(plain, _FIELD.TYPE_ENUM if plain in enums else _FIELD.TYPE_MESSAGE)
    if plain not in _SCALARS:
        new_field.type_name = f".{package}.{plain}"
    return new_field


@dataclass
class SchemaTypes:
    """The messages and enumerations of a descriptor set, by full name with a leading dot."""

    messages: dict[str, DescriptorProto] = field(default_factory=dict)
    enums: dict[str, EnumDescriptorProto] = field(default_factory=dict)

    def add(self, scope: str, messages: Iterable[DescriptorProto], enums: Iterable[EnumDescriptorProto]) -> None:
        """Add messages and enumerations, including nested ones, that are declared in `scope`."""
        self.enums.update({f"{scope}.{enum.name}": enum for enum in enums})
        for message in messages:
            name = f"{scope}.{message.name}"
            self.messages[name] = message
            self.add(name, message.nested_type, message.enum_type)


def parse_schema(path: Path, message_type: str, descriptor_set: bytes) -> SchemaTypes:
    """Return the types in the schema record of message `message_type`. Errors: `TraceError` if they do not include that message."""
    types = SchemaTypes()
    try:
        files = descriptor_pb2.FileDescriptorSet.FromString(descriptor_set).file
    except DecodeError as error:
        raise TraceError(
            f"{path}: the schema {message_type} in the log is not a protobuf description ({error})"
        ) from error
    for file in files:
        scope = f".{file.package}" if file.package else ""
        types.add(scope, file.message_type, file.enum_type)
    if f".{message_type}" not in types.messages:
        raise TraceError(
            f"{path}: the schema {message_type} in the log has no definition of the message type {message_type}: "
            "record the log with its descriptor set"
        )
    return types


def message_decoder(path: Path, types: SchemaTypes, message_type: str, tree: FieldTree) -> Decode:
    """Return a function that decodes messages `message_type` to one struct each, with the fields of `tree` that the schema has.

    Enumerations are int32. Errors: `TraceError` if the log's schema contradicts itself. The function raises `ValueError` for a
    message that cannot be decoded.
    """
    file = descriptor_pb2.FileDescriptorProto(name=f"{PRUNED_PACKAGE}.proto", package=PRUNED_PACKAGE, syntax="proto2")
    _add_pruned_message(file, types, f".{message_type}", tree, "Root")
    pool = descriptor_pool.DescriptorPool()
    try:
        pool.Add(file)
    except TypeError as error:
        raise TraceError(
            f"{path}: the schema {message_type} in the log contradicts itself ({error}): record it again"
        ) from error
    descriptor = pool.FindMessageTypeByName(f"{PRUNED_PACKAGE}.Root")
    handler = ptars.HandlerPool([descriptor.file]).get_for_message(descriptor)

    def decode(messages: list[bytes]) -> pa.StructArray:
        rows = handler.list_to_record_batch(messages)
        return pa.StructArray.from_arrays(rows.columns, fields=list(rows.schema))

    return decode


def _add_pruned_message(
    file: FileDescriptorProto, types: SchemaTypes, source_type: str, tree: FieldTree, name: str
) -> None:
    message = file.message_type.add(name=name)
    field_by_name = {item.name: item for item in types.messages[source_type].field}
    for field_name, subtree in tree.items():
        item = field_by_name.get(field_name)
        if item is None or (item.type == _FIELD.TYPE_MESSAGE) != (subtree is not None):
            continue
        label = _FIELD.LABEL_REPEATED if item.label == _FIELD.LABEL_REPEATED else _FIELD.LABEL_OPTIONAL
        new_field = message.field.add(name=field_name, number=item.number, label=label)
        if subtree is None:
            new_field.type = _FIELD.TYPE_INT32 if item.type == _FIELD.TYPE_ENUM else item.type
        elif item.type_name in types.messages:
            new_field.type = _FIELD.TYPE_MESSAGE
            new_field.type_name = f".{PRUNED_PACKAGE}.{name}_{field_name}"
            _add_pruned_message(file, types, item.type_name, subtree, f"{name}_{field_name}")
        else:
            del message.field[-1]


def enum_names(types: SchemaTypes, message_type: str, *field_path: str) -> dict[int, str]:
    """Return number -> name for the enumeration at field `field_path` of message `message_type`; empty if there is no such field.

    If two names have the same number, the last name is returned: OSI keeps a replaced name beside its replacement.
    """
    source = f".{message_type}"
    for step in field_path:
        if source not in types.messages:
            return {}
        source = next((item.type_name for item in types.messages[source].field if item.name == step), "")
    return {value.number: value.name for value in types.enums[source].value} if source in types.enums else {}


def decode_batch(path: Path, log_messages: list[LogMessage], decode: Decode) -> pa.StructArray:
    """Decode a batch. Errors: `TraceError` with topic and byte of the first message that cannot be decoded."""
    try:
        return decode([log_message.data for log_message in log_messages])
    except ValueError as error:
        if len(log_messages) == 1:
            raise log_messages[0].error(path, str(error).splitlines()[0]) from error
        for log_message in log_messages:  # find the message that cannot be decoded
            decode_batch(path, [log_message], decode)
        raise TraceError(f"{path}: {len(log_messages)} messages cannot be decoded together: {error}") from error


def struct_field(parent: pa.Array, name: str) -> pa.Array:
    """Return a field of a struct array; NULL where the parent is NULL, and in all rows if the schema lacks the field."""
    if pa.types.is_struct(parent.type) and parent.type.get_field_index(name) >= 0:
        return pc.struct_field(parent, [parent.type.get_field_index(name)])
    return pa.nulls(len(parent))


def list_items_and_row_indices(rows: pa.Array, name: str) -> tuple[pa.Array, NDArray[np.int64]]:
    """Return the items of the lists in field `name`, and for each item the row that contains it."""
    lists = struct_field(rows, name)
    if not pa.types.is_list(lists.type):
        return pa.nulls(0), np.zeros(0, np.int64)
    return lists.flatten(), pc.list_parent_indices(lists).to_numpy(zero_copy_only=False)


def integer_values(rows: pa.Array, name: str, kind: pa.DataType) -> NDArray[Any]:
    """Return a field as integers; 0 if it is missing."""
    values: NDArray[Any] = pc.fill_null(struct_field(rows, name).cast(kind), 0).to_numpy(zero_copy_only=False)
    return values
