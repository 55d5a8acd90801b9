"""Writes small logs of Foxglove scenes, in protobuf (from field lists given as text here) and in JSON."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

from google.protobuf import descriptor_pb2, descriptor_pool, duration_pb2, json_format, message_factory, timestamp_pb2
from mcap.writer import CompressionType, Writer

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

_F = descriptor_pb2.FieldDescriptorProto
_SCALARS = {"double": _F.TYPE_DOUBLE, "string": _F.TYPE_STRING, "bool": _F.TYPE_BOOL}
# message -> its fields: name, number, type (a * means repeated, T and D are protobuf's own time and duration)
MESSAGES = {
    "Vector3": "x 1 double, y 2 double, z 3 double",
    "Quaternion": "x 1 double, y 2 double, z 3 double, w 4 double",
    "Pose": "position 1 Vector3, orientation 2 Quaternion",
    "Color": "r 1 double, g 2 double, b 3 double, a 4 double",
    "CubePrimitive": "pose 1 Pose, size 2 Vector3, color 3 Color",
    "CylinderPrimitive": "pose 1 Pose, size 2 Vector3, bottom_scale 3 double, top_scale 4 double",
    "SpherePrimitive": "pose 1 Pose, size 2 Vector3, color 3 Color",
    "ModelPrimitive": "pose 1 Pose, scale 2 Vector3, url 5 string",
    "KeyValuePair": "key 1 string, value 2 string",
    "SceneEntity": "timestamp 1 T, frame_id 2 string, id 3 string, lifetime 4 D, frame_locked 5 bool, metadata 6 *KeyValuePair, "
    "cubes 8 *CubePrimitive, spheres 9 *SpherePrimitive, cylinders 10 *CylinderPrimitive, models 14 *ModelPrimitive",
    "SceneEntityDeletion": "timestamp 1 T, type 2 Kind, id 3 string",
    "SceneUpdate": "deletions 1 *SceneEntityDeletion, entities 2 *SceneEntity",
    "FrameTransform": "timestamp 1 T, parent_frame_id 2 string, child_frame_id 3 string, translation 4 Vector3, rotation 5 Quaternion",
    "FrameTransforms": "transforms 1 *FrameTransform",
}


def _file_set() -> descriptor_pb2.FileDescriptorSet:
    file = descriptor_pb2.FileDescriptorProto(name="foxglove.proto", package="foxglove", syntax="proto3")
    file.dependency.extend(["google/protobuf/timestamp.proto", "google/protobuf/duration.proto"])
    kind = file.enum_type.add(name="Kind")
    kind.value.add(name="MATCHING_ID", number=0)
    kind.value.add(name="ALL", number=1)
    for name, text in MESSAGES.items():
        message = file.message_type.add(name=name)
        for field_name, number, type_ in (each.split() for each in text.split(", ")):
            field = message.field.add(name=field_name, number=int(number))
            field.label = _F.LABEL_REPEATED if type_.startswith("*") else _F.LABEL_OPTIONAL
            bare = type_.lstrip("*")
            if bare in _SCALARS:
                field.type = _SCALARS[bare]
            elif bare == "Kind":
                field.type, field.type_name = _F.TYPE_ENUM, ".foxglove.Kind"
            else:
                known = {"T": ".google.protobuf.Timestamp", "D": ".google.protobuf.Duration"}
                field.type, field.type_name = _F.TYPE_MESSAGE, known.get(bare, f".foxglove.{bare}")
    files = descriptor_pb2.FileDescriptorSet()
    for module in (timestamp_pb2, duration_pb2):
        module.DESCRIPTOR.CopyToProto(files.file.add())
    files.file.append(file)
    return files


FILES = _file_set()
_POOL = descriptor_pool.DescriptorPool()
for _file in FILES.file:
    _POOL.Add(_file)

Message = tuple[str, str, float, dict[str, Any]]
"""Topic, message name, log time in seconds, content as in JSON (times as {sec, nsec})."""


def _protobuf(name: str, content: dict[str, Any]) -> bytes:
    message = message_factory.GetMessageClass(_POOL.FindMessageTypeByName(f"foxglove.{name}"))()
    json_format.ParseDict(_google(content), message)
    return bytes(message.SerializeToString())


def _google(value: Any) -> Any:
    """Turn {sec, nsec} and NaN into the texts that protobuf's own JSON has for them."""
    if isinstance(value, float) and math.isnan(value):
        return "NaN"
    if isinstance(value, list):
        return [_google(each) for each in value]
    if not isinstance(value, dict):
        return value
    found = {}
    for key, item in value.items():
        if key in {"timestamp", "lifetime"}:
            time = (timestamp_pb2.Timestamp if key == "timestamp" else duration_pb2.Duration)(
                seconds=int(item.get("sec", 0)), nanos=int(item.get("nsec", 0))
            )
            found[key] = time.ToJsonString()
        else:
            found[key] = _google(item)
    return found


def write(path: Path, messages: Iterable[Message], encoding: str = "protobuf", indent: int | None = None) -> Path:
    """Write a log in the order given."""
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start()
        schemas: dict[str, int] = {}
        channels: dict[str, int] = {}
        for topic, name, t_s, content in messages:
            if name not in schemas:
                data = FILES.SerializeToString() if encoding == "protobuf" else b'{"type": "object"}'
                kind = "protobuf" if encoding == "protobuf" else "jsonschema"
                schemas[name] = writer.register_schema(f"foxglove.{name}", kind, data)
            if topic not in channels:
                channels[topic] = writer.register_channel(topic, encoding, schemas[name])
            data = _protobuf(name, content) if encoding == "protobuf" else json.dumps(content, indent=indent).encode()
            t_ns = round(t_s * 1e9)
            writer.add_message(channels[topic], t_ns, data, t_ns)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def stamp(t_s: float) -> dict[str, int]:
    t_ns = round(t_s * 1e9)
    return {"sec": t_ns // 10**9, "nsec": t_ns % 10**9}


def entity(
    name: str,
    t_s: float,
    x: float,
    y: float = 0.0,
    *,
    yaw: float = 0.0,
    life: float = 0.0,
    frame: str = "map",
    **fields: Any,
) -> dict[str, Any]:
    """Return an entity with one cube of 4.5 x 1.8 x 1.5 m."""
    pose = {
        "position": {"x": x, "y": y, "z": 0.75},
        "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)},
    }
    return {
        "timestamp": stamp(t_s), "frame_id": frame, "id": name, "lifetime": stamp(life),
        "cubes": [{"pose": pose, "size": {"x": 4.5, "y": 1.8, "z": 1.5}}], **fields,
    }  # fmt: skip


def scene(
    t_s: float, *entities: dict[str, Any], deletions: tuple[dict[str, Any], ...] = (), topic: str = "/scene"
) -> Message:
    return topic, "SceneUpdate", t_s, {"entities": list(entities), "deletions": list(deletions)}


def deletion(t_s: float, name: str | None = None) -> dict[str, Any]:
    return {"timestamp": stamp(t_s), "type": 1 if name is None else 0, "id": name or ""}


def transform(t_s: float, parent: str, child: str, x: float = 0.0, y: float = 0.0, *, yaw: float = 0.0) -> Message:
    content = {
        "timestamp": stamp(t_s), "parent_frame_id": parent, "child_frame_id": child,
        "translation": {"x": x, "y": y, "z": 0.0},
        "rotation": {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)},
    }  # fmt: skip
    return "/tf", "FrameTransform", t_s, content
