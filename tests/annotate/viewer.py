"""What a viewer makes of an annotated log: messages decoded by the schemas in the file, and what it shows after a jump to a time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.reader import SeekingReader

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

SCENES = ("map", "scene", "danger_spaces", "markers")


class TimedMessage(NamedTuple):
    """A message: when, and its content."""

    log_time: int
    content: Any


def messages(path: Path, topic: str, **query: Any) -> list[TimedMessage]:
    """Return the messages of one of our topics, decoded by the schema that the file carries (JSON: as bytes)."""
    decode: dict[int, Any] = {}
    found = []
    with path.open("rb") as file:
        for schema, _, message in SeekingReader(file, validate_crcs=True).iter_messages(
            [f"/drivelint/{topic}"], **query
        ):
            assert schema is not None
            if schema.encoding != "protobuf":
                found.append(TimedMessage(message.log_time, message.data))
                continue
            if schema.id not in decode:
                pool = descriptor_pool.DescriptorPool()
                for declared in descriptor_pb2.FileDescriptorSet.FromString(schema.data).file:
                    pool.Add(declared)
                decode[schema.id] = message_factory.GetMessageClass(pool.FindMessageTypeByName(schema.name))
            content = decode[schema.id].FromString(message.data)
            content.DiscardUnknownFields()
            assert content.ByteSize() <= len(message.data)
            assert content == decode[schema.id].FromString(content.SerializeToString()), "nothing that a reader skips"
            found.append(TimedMessage(message.log_time, content))
    return found


def visible_entities(path: Path, topic: str, t: int) -> dict[str, Any]:
    """Return the entities on a topic after a jump to log time `t`: those of the last message there, if they still live."""
    before = messages(path, topic, ending_at=t)
    if not before:
        return {}
    living = {}
    for entity in before[-1].content.entities:
        ends = entity.timestamp.ToNanoseconds() + entity.lifetime.ToNanoseconds()
        if not entity.lifetime.ToNanoseconds() or ends >= t:
            living[entity.id] = entity
    return living


def played(path: Path, topic: str, t: int) -> dict[str, Any]:
    """Return the entities on a topic when everything up to log time `t` was played."""
    living: dict[str, Any] = {}
    for said in messages(path, topic, ending_at=t):
        for deletion in said.content.deletions:
            assert deletion.type == 1
            living.clear()
        living |= {entity.id: entity for entity in said.content.entities}
    return living


def yaw(pose: Any) -> float:
    """Return the heading of a pose that is turned about the vertical only."""
    q = pose.orientation
    assert (q.x, q.y) == (0, 0)
    assert math.isclose(q.z * q.z + q.w * q.w, 1.0)
    return 2 * math.atan2(q.z, q.w)


def points(primitive: Any) -> NDArray[np.float64]:
    """Return the points of a line or of triangles in the fixed frame: x, y, z."""
    assert yaw(primitive.pose) == 0
    origin = primitive.pose.position
    return np.array([[p.x + origin.x, p.y + origin.y, p.z + origin.z] for p in primitive.points])
