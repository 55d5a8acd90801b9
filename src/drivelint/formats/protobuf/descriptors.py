"""A protobuf schema cut down to the fields that are read: the parser then skips all others, three times faster.

The schema record of the log carries the descriptor set. Field numbers and types come from it, so any version of the
messages is read that still has fields of these names.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from google.protobuf import descriptor_pb2, descriptor_pool
from google.protobuf.message import DecodeError

from drivelint.errors import TraceError

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from google.protobuf.descriptor import Descriptor

FieldTree = dict[str, Any]
"""Field name -> subtree of a message field, or None for a value."""

_FIELD = descriptor_pb2.FieldDescriptorProto
PACKAGE = "pruned"
SCALARS = {name.removeprefix("TYPE_").lower(): number for name, number in _FIELD.Type.items()}
"""Type of a value as it is written in a schema -> its number."""


@dataclass
class Types:
    """The messages and enumerations of a descriptor set by full name, with a leading dot as in type references."""

    messages: dict[str, descriptor_pb2.DescriptorProto] = field(default_factory=dict)
    enums: dict[str, descriptor_pb2.EnumDescriptorProto] = field(default_factory=dict)

    def add(self, scope: str, messages: Iterable[descriptor_pb2.DescriptorProto]) -> None:
        """Add messages and, below them, what is nested."""
        for message in messages:
            name = f"{scope}.{message.name}"
            self.messages[name] = message
            self.enums.update({f"{name}.{enum.name}": enum for enum in message.enum_type})
            self.add(name, message.nested_type)


def parse(path: Path, name: str, descriptor_set: bytes) -> Types:
    """Read the schema record of message `name`. Errors: `TraceError` when it does not describe that message."""
    types = Types()
    try:
        files = descriptor_pb2.FileDescriptorSet.FromString(descriptor_set).file
    except DecodeError as error:
        raise TraceError(f"{path}: the schema {name} in the log is not a protobuf description ({error})") from error
    for file in files:
        scope = f".{file.package}" if file.package else ""
        types.enums.update({f"{scope}.{enum.name}": enum for enum in file.enum_type})
        types.add(scope, file.message_type)
    if f".{name}" not in types.messages:
        raise TraceError(
            f"{path}: the schema {name} in the log does not describe {name}: record it with its descriptor set"
        )
    return types


def pruned(path: Path, types: Types, name: str, tree: FieldTree) -> Descriptor:
    """Return message `name` with only those fields of `tree` that it has: same numbers and types, enums as int32.

    Errors: `TraceError` when the log's description contradicts itself.
    """
    file = descriptor_pb2.FileDescriptorProto(name=f"{PACKAGE}.proto", package=PACKAGE, syntax="proto2")
    _add(file, types, f".{name}", tree, "Root")
    pool = descriptor_pool.DescriptorPool()
    try:
        pool.Add(file)
    except TypeError as error:
        raise TraceError(
            f"{path}: the schema {name} in the log contradicts itself ({error}): record it again"
        ) from error
    return pool.FindMessageTypeByName(f"{PACKAGE}.Root")


def _add(file: descriptor_pb2.FileDescriptorProto, types: Types, source: str, tree: FieldTree, name: str) -> None:
    message = file.message_type.add(name=name)
    known = {item.name: item for item in types.messages[source].field}
    for field_name, subtree in tree.items():
        item = known.get(field_name)
        if item is None or (item.type == _FIELD.TYPE_MESSAGE) != (subtree is not None):
            continue
        label = _FIELD.LABEL_REPEATED if item.label == _FIELD.LABEL_REPEATED else _FIELD.LABEL_OPTIONAL
        kept = message.field.add(name=field_name, number=item.number, label=label)
        if subtree is None:
            kept.type = _FIELD.TYPE_INT32 if item.type == _FIELD.TYPE_ENUM else item.type
        elif item.type_name in types.messages:
            kept.type = _FIELD.TYPE_MESSAGE
            kept.type_name = f".{PACKAGE}.{name}_{field_name}"
            _add(file, types, item.type_name, subtree, f"{name}_{field_name}")
        else:
            del message.field[-1]


def enum_names(types: Types, name: str, *path: str) -> dict[int, str]:
    """Return number -> name of the enumeration at field `path` of message `name`; empty where there is no such field.

    Where two names share a number, the last one counts: OSI keeps its old name beside the new one.
    """
    source = f".{name}"
    for step in path:
        if source not in types.messages:
            return {}
        source = next((item.type_name for item in types.messages[source].field if item.name == step), "")
    return {value.number: value.name for value in types.enums[source].value} if source in types.enums else {}
