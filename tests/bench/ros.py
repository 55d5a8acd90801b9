"""`python -m tests.bench.ros`, from the repository's root: how many actor states a second are read of ROS 2 and Foxglove logs.

600,000 states of 50 road users and their ego, from the opening of the file to checked tables; the best of three runs.
"""

from __future__ import annotations

import struct
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from mcap.writer import CompressionType, Writer

from drivelint.ingest import IngestOptions, read_trace
from tests.ingest import ros_log

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

OBJECTS, STEPS, RUNS = 50, 12_000, 3
PROBE = 1e6


def _objects(i: int) -> ros_log.Message:
    return ros_log.things(1.0, *(ros_log.thing(k, PROBE + k, 4.0 * k, speed=10.0) for k in range(OBJECTS)))


def _tracks(i: int) -> ros_log.Message:
    return ros_log.tracks(1.0, *(ros_log.track(k, PROBE + k, 4.0 * k, speed=10.0) for k in range(OBJECTS)))


def _detections(i: int) -> ros_log.Message:
    return ros_log.detections(
        1.0, *(ros_log.detection(f"car {k}", PROBE + k, 4.0 * k, ("car", 0.9)) for k in range(OBJECTS))
    )


def moved(message: ros_log.Message) -> Iterator[tuple[float, bytes]]:
    """Yield a message again and again, its time stamp and its places moved on."""
    _, name, _, content = message
    data = bytearray(ros_log.encode(name, content))
    places = [(at, k) for k in range(OBJECTS) if (at := data.find(struct.pack("<d", PROBE + k))) > 0]
    for i in range(STEPS):
        t_s = 1.0 + 0.05 * i
        struct.pack_into("<iI", data, 4, int(t_s), round((t_s % 1.0) * 1e9))
        for at, k in places:
            struct.pack_into("<d", data, at, 0.5 * i + 20.0 * k)
        yield t_s, bytes(data)


def write(path: Path, message: ros_log.Message) -> Path:
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
    return path


def main() -> None:
    """Print the table."""
    kinds: dict[str, Callable[[int], ros_log.Message]] = {
        "ObjectArray": _objects, "TrackedObjects": _tracks, "Detection3DArray": _detections,
    }  # fmt: skip
    print("| log | states | MB | s | M states/s |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="drivelint-bench-") as home:
        for name, make in kinds.items():
            path = write(Path(home) / f"{name}.mcap", make(0))
            best, n = float("inf"), 0
            for _ in range(RUNS):
                start = time.perf_counter()
                trace = read_trace(path, IngestOptions(need_ego=False))
                best, n = min(best, time.perf_counter() - start), trace.tables["actor_state"].num_rows
            print(f"| {name} | {n} | {path.stat().st_size / 1e6:.0f} | {best:.2f} | {n / best / 1e6:.2f} |", flush=True)


if __name__ == "__main__":
    main()
