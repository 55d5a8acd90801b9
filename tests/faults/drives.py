"""One small drive in each format: cars that drive east at 10 m/s, each in its own lane; car 0 is the ego."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq

from tests.formats import logs
from tests.formats.foxglove import foxglove_log
from tests.formats.osi import osi_log
from tests.formats.ros2 import ros_log

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

N: Final = 40
STEP_S: Final = 0.1
SPEED: Final = 10.0
LENGTH, WIDTH, HEIGHT = 4.5, 1.8, 1.5


class Car(NamedTuple):
    """A car at one time: metres, radians, m/s."""

    name: str
    x: float
    y: float
    yaw: float = 0.0
    vx: float = SPEED


class Frame(NamedTuple):
    """What a log has of one time, in seconds."""

    t_s: float
    cars: list[Car]


def drive(n: int = N, cars: int = 3) -> list[Frame]:
    """Return the frames of the sound drive."""
    return [Frame(i * STEP_S, [Car(str(k), SPEED * i * STEP_S, 4.0 * k) for k in range(cars)]) for i in range(n)]


def truths(frames: list[Frame]) -> list[Any]:
    """Return the frames as OSI ground truth."""
    found = []
    for frame in frames:
        truth = osi_log.frame(round(frame.t_s * 1e9))
        for car in frame.cars:
            osi_log.moving(truth, int(car.name), car.x, car.y, yaw=car.yaw, v=(car.vx, 0.0))
        found.append(truth)
    return found


def osi_mcap(path: Path, frames: list[Frame]) -> Path:
    """Write MCAP of OSI ground truth."""
    return osi_log.write(
        path.with_suffix(".mcap"), osi_log.truths(truths(frames)), chunk_size=600, enable_data_crcs=False
    )


def osi_file(path: Path, frames: list[Frame]) -> Path:
    """Write an OSI trace file."""
    found = path.with_suffix(".osi")
    messages = [truth.SerializeToString() for truth in truths(frames)]
    found.write_bytes(b"".join(len(each).to_bytes(4, "little") + each for each in messages))
    return found


def scenes(frames: list[Frame]) -> list[foxglove_log.Message]:
    """Return the frames as messages of a Foxglove scene."""
    return [
        foxglove_log.scene(
            frame.t_s,
            *(
                foxglove_log.entity(
                    car.name, frame.t_s, car.x, car.y, yaw=car.yaw, metadata=[{"key": "class", "value": "car"}]
                )
                for car in frame.cars
            ),
        )
        for frame in frames
    ]


def foxglove(path: Path, frames: list[Frame]) -> Path:
    """Write a Foxglove scene in protobuf."""
    return foxglove_log.write(path.with_suffix(".mcap"), scenes(frames))


def foxglove_json(path: Path, frames: list[Frame]) -> Path:
    """Write a Foxglove scene in JSON."""
    return foxglove_log.write(path.with_suffix(".mcap"), scenes(frames), "json")


def things(frames: list[Frame]) -> list[ros_log.Message]:
    """Return the frames as messages of the CARLA bridge."""
    return [
        ros_log.things(frame.t_s, *(ros_log.thing(int(car.name), car.x, car.y, car.yaw, car.vx) for car in frame.cars))
        for frame in frames
    ]


def ros(path: Path, frames: list[Frame]) -> Path:
    """Write a ROS 2 log."""
    return ros_log.write(path.with_suffix(".mcap"), things(frames))


def bag(path: Path, frames: list[Frame]) -> Path:
    """Write a bag of rosbag2 in two files."""
    path.mkdir()
    messages, half = things(frames), len(frames) // 2
    for name, part in (("a.mcap", messages[:half]), ("b.mcap", messages[half:])):
        ros_log.write(path / name, part)
    listed = "    - a.mcap\n    - b.mcap\n"
    (path / "metadata.yaml").write_text(
        f"rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: mcap\n  relative_file_paths:\n{listed}",
        encoding="utf-8",
    )
    return path


def table(frames: list[Frame]) -> pa.Table:
    """Return the frames as the rows of `actor_state`, sizes and classes with them."""
    rows = [
        {
            "t_ns": round(frame.t_s * 1e9), "actor_id": car.name, "x_m": car.x, "y_m": car.y, "yaw_rad": car.yaw,
            "vx_mps": car.vx, "vy_mps": 0.0, "length_m": LENGTH, "width_m": WIDTH, "height_m": HEIGHT,
            "actor_class": "car",
        }
        for frame in frames
        for car in frame.cars
    ]  # fmt: skip
    return pa.Table.from_pylist(rows)


def parquet(path: Path, frames: list[Frame]) -> Path:
    """Write one Parquet file of canonical states."""
    found = path.with_suffix(".parquet")
    pq.write_table(table(frames), found, row_group_size=30)
    return found


def canonical(path: Path, frames: list[Frame]) -> Path:
    """Write a canonical folder that counts its states."""
    path.mkdir()
    states = table(frames)
    pq.write_table(states, path / "actor_state.parquet")
    pq.write_table(pa.table({"n_states": [len(states)]}), path / "data_log.parquet")
    return path


def csv(path: Path, frames: list[Frame]) -> Path:
    """Write a table whose mapping is `MAPPING`."""
    lines = ["t,id,x,y,yaw,vx,vy"]
    for frame in frames:
        lines += [f"{frame.t_s:.3f},{car.name},{car.x:.4f},{car.y},{car.yaw},{car.vx},0.0" for car in frame.cars]
    return logs.table(path.with_suffix(".csv"), lines)


MAPPING: Final = logs.LONG.replace('ids = ["a"]', 'ids = ["0"]')
"""The mapping of the CSV tables."""
WRITERS: Final[dict[str, Callable[[Path, list[Frame]], Path]]] = {
    "osi-mcap": osi_mcap, "osi-file": osi_file, "foxglove": foxglove, "foxglove-json": foxglove_json, "ros": ros, "bag": bag,
    "parquet": parquet, "canonical": canonical, "csv": csv,
}  # fmt: skip
"""The formats that the faults are shown in."""
