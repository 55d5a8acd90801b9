"""Foxglove's public message types, as far as they are written here: names, field numbers and types as their documentation says.

They are spelled out because the package that holds them weighs 54 MB and encodes one object at a time. A scene must be
declared whole: viewers walk through every kind of primitive, used or not.
"""

from __future__ import annotations

from functools import cache
from typing import Final

from google.protobuf import descriptor_pb2, duration_pb2, timestamp_pb2
from mcap.records import Schema

from drivelint.formats.protobuf.descriptors import SCALARS

_FIELD = descriptor_pb2.FieldDescriptorProto
_KNOWN: Final = {"Timestamp": timestamp_pb2.DESCRIPTOR, "Duration": duration_pb2.DESCRIPTOR}
# message -> its fields, numbered from 1; []: repeated; a name with an upper-case letter is a message, E: its own enumeration
_TYPES: Final[dict[str, str]] = {
    "Vector3": "x double, y double, z double",
    "Point3": "x double, y double, z double",
    "Quaternion": "x double, y double, z double, w double",
    "Color": "r double, g double, b double, a double",
    "Pose": "position Vector3, orientation Quaternion",
    "KeyValuePair": "key string, value string",
    "ArrowPrimitive": "pose Pose, shaft_length double, shaft_diameter double, head_length double, head_diameter double, color Color",
    "CubePrimitive": "pose Pose, size Vector3, color Color",
    "SpherePrimitive": "pose Pose, size Vector3, color Color",
    "CylinderPrimitive": "pose Pose, size Vector3, bottom_scale double, top_scale double, color Color",
    "LinePrimitive": "type E:Type, pose Pose, thickness double, scale_invariant bool, points [Point3], color Color, colors [Color],"
    " indices [fixed32]",
    "TriangleListPrimitive": "pose Pose, points [Point3], color Color, colors [Color], indices [fixed32]",
    "TextPrimitive": "pose Pose, billboard bool, font_size double, scale_invariant bool, color Color, text string",
    "ModelPrimitive": "pose Pose, scale Vector3, color Color, override_color bool, url string, media_type string, data bytes",
    "SceneEntity": "timestamp Timestamp, frame_id string, id string, lifetime Duration, frame_locked bool, metadata [KeyValuePair],"
    " arrows [ArrowPrimitive], cubes [CubePrimitive], spheres [SpherePrimitive], cylinders [CylinderPrimitive],"
    " lines [LinePrimitive], triangles [TriangleListPrimitive], texts [TextPrimitive], models [ModelPrimitive]",
    "SceneEntityDeletion": "timestamp Timestamp, type E:Type, id string",
    "SceneUpdate": "deletions [SceneEntityDeletion], entities [SceneEntity]",
    "FrameTransform": "timestamp Timestamp, parent_frame_id string, child_frame_id string, translation Vector3, rotation Quaternion",
    "Log": "timestamp Timestamp, level E:Level, message string, name string, file string, line fixed32",
}
_ENUMS: Final = {
    "LinePrimitive": ("LINE_STRIP", "LINE_LOOP", "LINE_LIST"),
    "SceneEntityDeletion": ("MATCHING_ID", "ALL"),
    "Log": ("UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"),
}
LINE_STRIP, LINE_LOOP, LINE_LIST = range(3)
DELETE_ALL: Final = 1
INFO, WARNING, ERROR = 2, 3, 4


@cache
def schema(name: str) -> Schema:
    """Return the MCAP schema record (still without id) of `foxglove.<name>`: a set of file descriptors, imports first."""
    files = descriptor_pb2.FileDescriptorSet()
    _add(name, files, set())
    # a fixed order of bytes: no map fields, and the files in the order in which they are found
    return Schema(id=0, name=f"foxglove.{name}", encoding="protobuf", data=files.SerializeToString(deterministic=True))


def _add(name: str, files: descriptor_pb2.FileDescriptorSet, done: set[str]) -> None:
    """Append the file that declares a message, after those that it imports."""
    if name in done:
        return
    done.add(name)
    if name in _KNOWN:
        _KNOWN[name].CopyToProto(files.file.add())
        return
    used = sorted({kind for _, kind, _ in _fields(name) if kind in _TYPES or kind in _KNOWN})
    for kind in used:
        _add(kind, files, done)
    file = files.file.add(name=f"foxglove/{name}.proto", package="foxglove", syntax="proto3")
    file.dependency.extend(_KNOWN[kind].name if kind in _KNOWN else f"foxglove/{kind}.proto" for kind in used)
    message = file.message_type.add(name=name)
    for number, (field, kind, repeated) in enumerate(_fields(name), 1):
        _declare(message, field, kind, number, repeated=repeated)
    for enum in {kind[2:] for _, kind, _ in _fields(name) if kind.startswith("E:")}:
        declared = message.enum_type.add(name=enum)
        for value, word in enumerate(_ENUMS[name]):
            declared.value.add(name=word, number=value)


def _fields(name: str) -> list[tuple[str, str, bool]]:
    """Return name, type and whether repeated of a message's fields, in the order of their numbers."""
    pairs = (part.split() for part in _TYPES[name].split(","))
    return [(field, kind.strip("[]"), kind.startswith("[")) for field, kind in pairs]


def _declare(message: descriptor_pb2.DescriptorProto, name: str, kind: str, number: int, *, repeated: bool) -> None:
    words = name.split("_")
    field = message.field.add(name=name, number=number, json_name=words[0] + "".join(w.title() for w in words[1:]))
    field.label = _FIELD.LABEL_REPEATED if repeated else _FIELD.LABEL_OPTIONAL
    if kind in SCALARS:
        field.type = SCALARS[kind]
    elif kind.startswith("E:"):
        field.type, field.type_name = _FIELD.TYPE_ENUM, f".foxglove.{message.name}.{kind[2:]}"
    else:
        field.type = _FIELD.TYPE_MESSAGE
        field.type_name = f".google.protobuf.{kind}" if kind in _KNOWN else f".foxglove.{kind}"
