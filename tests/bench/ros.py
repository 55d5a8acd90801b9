"""Logs of ROS 2 and Foxglove for `tests.bench.formats`: 50 road users that all move in every message."""

from __future__ import annotations

import struct
from functools import partial
from typing import TYPE_CHECKING

from mcap.writer import CompressionType, Writer

from tests.formats.foxglove import foxglove_log
from tests.formats.ros2 import ros_log

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

OBJECTS = 50
PROBE = 1e6
"""Where the first road user of the message is whose bytes are then changed."""


def things() -> ros_log.Message:
    """Return a message of the CARLA bridge."""
    return ros_log.things(1.0, *(ros_log.thing(k, PROBE + k, 4.0 * k, speed=10.0) for k in range(OBJECTS)))


def tracks() -> ros_log.Message:
    """Return a message of Autoware."""
    return ros_log.tracks(1.0, *(ros_log.track(k, PROBE + k, 4.0 * k, speed=10.0) for k in range(OBJECTS)))


def detections() -> ros_log.Message:
    """Return detections, with ids of different lengths."""
    named = (ros_log.detection(f"car {k}", PROBE + k, 4.0 * k, ("car", 0.9)) for k in range(OBJECTS))
    return ros_log.detections(1.0, *named)


def moved_messages(message: ros_log.Message, steps: int) -> Iterator[tuple[float, bytes]]:
    """Yield a message again and again, its time stamp and its places moved on."""
    _, name, _, content = message
    data = bytearray(ros_log.encode(name, content))
    places = [(at, k) for k in range(OBJECTS) if (at := data.find(struct.pack("<d", PROBE + k))) > 0]
    assert len(places) == OBJECTS
    for i in range(steps):
        t_s = 1.0 + 0.05 * i
        struct.pack_into("<iI", data, 4, int(t_s), round((t_s % 1.0) * 1e9))
        for at, k in places:
            struct.pack_into("<d", data, at, 0.5 * i + 20.0 * k)
        yield t_s, bytes(data)


def write_ros(path: Path, message: ros_log.Message, steps: int) -> None:
    """Write a log of one kind of object list and the odometry of an ego."""
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.ZSTD)
        writer.start()
        channels = []
        for topic, name, _, _ in (message, ros_log.odometry(1.0, 0.0, 0.0)):
            schema = writer.register_schema(name.replace("/", "/msg/"), "ros2msg", ros_log.definition(name).encode())
            channels.append(writer.register_channel(topic, "cdr", schema))
        for i, (t_s, data) in enumerate(moved_messages(message, steps)):
            t_ns = round(t_s * 1e9)
            writer.add_message(channels[0], t_ns, data, t_ns)
            ego = ros_log.odometry(t_s, 0.5 * i, -4.0, speed=10.0)
            writer.add_message(channels[1], t_ns, ros_log.encode(ego[1], ego[3]), t_ns)
        writer.finish()  # type: ignore[no-untyped-call]


def write_scene(path: Path, encoding: str, steps: int) -> None:
    """Write a scene in which everybody moves in every message."""

    def scenes() -> Iterator[foxglove_log.Message]:
        for i in range(steps):
            t_s = 1.0 + 0.05 * i
            cars = (foxglove_log.entity(f"car {k}", t_s, 0.5 * i + 20.0 * k, 4.0 * k, life=0.1) for k in range(OBJECTS))
            yield foxglove_log.scene(t_s, *cars)

    foxglove_log.write(path, scenes(), encoding)


def logs(steps: int) -> dict[str, Callable[[Path], None]]:
    """Return the logs of so many messages: name -> what writes one."""
    ros = {"ObjectArray": things, "TrackedObjects": tracks, "Detection3DArray": detections}
    return {
        **{f"ROS 2 {name}": partial(_write_ros, make, steps) for name, make in ros.items()},
        **{f"Foxglove SceneUpdate, {kind}": partial(_write_scene, kind, steps) for kind in ("json", "protobuf")},
    }


def _write_ros(make: Callable[[], ros_log.Message], steps: int, path: Path) -> None:
    write_ros(path, make(), steps)


def _write_scene(encoding: str, steps: int, path: Path) -> None:
    write_scene(path, encoding, steps)
