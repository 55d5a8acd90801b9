"""The schemas of the Foxglove messages that drivelint writes, built from `messages.toml`.

The official package is not used, because it has 54 MB and encodes one object at a time. A scene must be declared with all its
kinds of primitives, because viewers read each of them, used or not.
"""

from __future__ import annotations

from functools import cache
from typing import Final

from google.protobuf import descriptor_pb2, duration_pb2, timestamp_pb2
from mcap.records import Schema

from drivelint.facts import toml_beside
from drivelint.formats.protobuf.descriptors import Declarations, add_field

_WELL_KNOWN_TYPES: Final = {"Timestamp": timestamp_pb2.DESCRIPTOR, "Duration": duration_pb2.DESCRIPTOR}
LINE_STRIP, LINE_LOOP, LINE_LIST = range(3)
DELETE_ALL: Final = 1
INFO, WARNING, ERROR = 2, 3, 4


@cache
def schema(name: str) -> Schema:
    """Return the MCAP schema record of `foxglove.<name>`, with the id 0: a set of file descriptors, imports first."""
    files = descriptor_pb2.FileDescriptorSet()
    _add_message_files(name, files, set(), Declarations(toml_beside(__file__, "messages.toml")))
    # the bytes are deterministic: there are no map fields, and the order of the files is fixed
    return Schema(id=0, name=f"foxglove.{name}", encoding="protobuf", data=files.SerializeToString(deterministic=True))


def _add_message_files(
    name: str, files: descriptor_pb2.FileDescriptorSet, added_names: set[str], declared: Declarations
) -> None:
    """Append the files that a message imports, then the file that declares it."""
    if name in added_names:
        return
    added_names.add(name)
    if name in _WELL_KNOWN_TYPES:
        _WELL_KNOWN_TYPES[name].CopyToProto(files.file.add())
        return
    fields = declared.messages[name]
    used = sorted({kind.removesuffix("[]") for _, _, kind in fields} & {*declared.messages, *_WELL_KNOWN_TYPES})
    for kind in used:
        _add_message_files(kind, files, added_names, declared)
    file = files.file.add(name=f"foxglove/{name}.proto", package="foxglove", syntax="proto3")
    file.dependency.extend(
        _WELL_KNOWN_TYPES[kind].name if kind in _WELL_KNOWN_TYPES else f"foxglove/{kind}.proto" for kind in used
    )
    message = file.message_type.add(name=name)
    for field, number, kind in fields:
        new_field = add_field(message, (field, number, kind), "foxglove", declared.enums)
        first, *later_words = field.split("_")
        new_field.json_name = first + "".join(map(str.title, later_words))
        if kind in _WELL_KNOWN_TYPES:
            new_field.type_name = f".google.protobuf.{kind}"
    for enum, values in declared.enums.items():
        if enum.startswith(f"{name}."):
            added_enum = message.enum_type.add(name=enum.removeprefix(f"{name}."))
            for word, number in values:
                added_enum.value.add(name=word, number=int(number))
