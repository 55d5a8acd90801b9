"""`python -m tests.bench.ros`, from the repository's root: how many actor states a second are read of ROS 2 and Foxglove logs.

600,000 states of 50 road users, from the opening of the file to checked tables; the best of five runs. On a busy machine
look at the CPU seconds.
"""

from __future__ import annotations

import struct
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from mcap.writer import CompressionType, Writer

from drivelint.ingest import IngestOptions, read_trace
from tests.ingest import foxglove_log, ros_log

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

OBJECTS, STEPS, RUNS = 50, 12_000, 5
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


def moved(message: ros_log.Message) -> Iterator[tuple[float, bytes]]:
    """Yield a message again and again, its time stamp and its places moved on."""
    _, name, _, content = message
    data = bytearray(ros_log.encode(name, content))
    places = [(at, k) for k in range(OBJECTS) if (at := data.find(struct.pack("<d", PROBE + k))) > 0]
    assert len(places) == OBJECTS
    for i in range(STEPS):
        t_s = 1.0 + 0.05 * i
        struct.pack_into("<iI", data, 4, int(t_s), round((t_s % 1.0) * 1e9))
        for at, k in places:
            struct.pack_into("<d", data, at, 0.5 * i + 20.0 * k)
        yield t_s, bytes(data)


def write_ros(path: Path, message: ros_log.Message) -> None:
    """Write a log of one kind of object list and the odometry of an ego."""
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.ZSTD)
        writer.start()
        channels = []
        for topic, name, _, _ in (message, ros_log.odometry(1.0, 0.0, 0.0)):
            schema = writer.register_schema(name.replace("/", "/msg/"), "ros2msg", ros_log.definition(name).encode())
            channels.append(writer.register_channel(topic, "cdr", schema))
        for i, (t_s, data) in enumerate(moved(message)):
            t_ns = round(t_s * 1e9)
            writer.add_message(channels[0], t_ns, data, t_ns)
            ego = ros_log.odometry(t_s, 0.5 * i, -4.0, speed=10.0)
            writer.add_message(channels[1], t_ns, ros_log.encode(ego[1], ego[3]), t_ns)
        writer.finish()  # type: ignore[no-untyped-call]


def write_scene(path: Path, encoding: str) -> None:
    """Write a scene in which everybody moves in every message."""

    def scenes() -> Iterator[foxglove_log.Message]:
        for i in range(STEPS):
            t_s = 1.0 + 0.05 * i
            cars = (foxglove_log.entity(f"car {k}", t_s, 0.5 * i + 20.0 * k, 4.0 * k, life=0.1) for k in range(OBJECTS))
            yield foxglove_log.scene(t_s, *cars)

    foxglove_log.write(path, scenes(), encoding)


def main() -> None:
    """Print the table."""
    logs: dict[str, Callable[[Path], None]] = {
        "ObjectArray": lambda path: write_ros(path, things()),
        "TrackedObjects": lambda path: write_ros(path, tracks()),
        "Detection3DArray": lambda path: write_ros(path, detections()),
        "SceneUpdate, JSON": lambda path: write_scene(path, "json"),
        "SceneUpdate, protobuf": lambda path: write_scene(path, "protobuf"),
    }
    print("| log | states | MB | s | CPU s | M states/s | per CPU s |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="drivelint-bench-") as home:
        for name, write in logs.items():
            path = Path(home) / "log.mcap"
            write(path)
            best, cpu, n = float("inf"), float("inf"), 0
            for _ in range(RUNS):
                start, used = time.perf_counter(), time.process_time()
                n = read_trace(path, IngestOptions(need_ego=False)).tables["actor_state"].num_rows
                best, cpu = min(best, time.perf_counter() - start), min(cpu, time.process_time() - used)
            megabytes = path.stat().st_size / 1e6
            rates = f"{n / best / 1e6:.2f} | {n / cpu / 1e6:.2f}"
            print(f"| {name} | {n} | {megabytes:.0f} | {best:.2f} | {cpu:.2f} | {rates} |", flush=True)


if __name__ == "__main__":
    main()
