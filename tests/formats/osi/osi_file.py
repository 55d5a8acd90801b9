"""Writes small OSI trace files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

from drivelint.formats.osi.schema import descriptor_set

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

_POOL = descriptor_pool.DescriptorPool()
for _file in descriptor_pb2.FileDescriptorSet.FromString(descriptor_set("read")).file:
    _POOL.Add(_file)


def message(name: str) -> Any:
    return message_factory.GetMessageClass(_POOL.FindMessageTypeByName(f"osi3.{name}"))()


def truth(t_ns: int, host: int | None = 0) -> Any:
    """A frame: a car at 10 m/s that indicates left, and a person on foot."""
    frame = message("GroundTruth")
    frame.timestamp.seconds, frame.timestamp.nanos = divmod(t_ns, 1_000_000_000)
    if host is not None:
        frame.host_vehicle_id.value = host
    for number, kind, x, v in ((0, 2, t_ns / 1e8, 10.0), (7, 3, 30.0, 0.0)):
        item = frame.moving_object.add()
        item.id.value, item.type = number, kind
        item.base.position.x, item.base.position.y = x, 1.5
        item.base.orientation.yaw = 0.0
        item.base.velocity.x = v
        item.base.dimension.length, item.base.dimension.width, item.base.dimension.height = 4.5, 1.8, 1.5
        if kind == 2:
            item.vehicle_classification.type = 5  # luxury car
            item.vehicle_classification.light_state.indicator_state = 3
            item.vehicle_classification.light_state.brake_light_state = 4
    return frame


def drive(n: int = 20) -> list[Any]:
    return [truth(i * 50_000_000) for i in range(n)]


def view(frame: Any) -> Any:
    """The same inside a sensor view that says the host itself."""
    outer = message("SensorView")
    outer.timestamp.CopyFrom(frame.timestamp)
    outer.host_vehicle_id.value = 0
    outer.global_ground_truth.CopyFrom(frame)
    return outer


def write(path: Path, messages: Iterable[Any]) -> Path:
    data = [m.SerializeToString() for m in messages]
    path.write_bytes(b"".join(len(d).to_bytes(4, "little") + d for d in data))
    return path
