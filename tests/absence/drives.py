"""One drive in every format in which an ego can vanish: the ego drives through a slower car ahead of it, from 2.9 to 5.1 s of 5.9 s."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq

from tests.faults import drives
from tests.faults.drives import Car, Frame
from tests.formats import logs
from tests.formats.osi import osi_log
from tests.formats.ros2 import ros_log
from tests.formats.sqlite_bag import sqlite_log
from tests.formats.sumo import fcd_text

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

N: Final = 60
CONTACT: Final = range(29, 52)
"""Frames in which the two cars overlap."""
EGO, OTHER = "0", "1"
HOSTS: Final = {"the ego": 0, "nobody": None, "an id without a state": 99}
WIDE: Final = """
description = "wide table of the tests"
[time]
column = "t"
[columns]
actor_id = { column = "id_{k}" }
x = "x_{k}"
y = "y_{k}"
yaw = "yaw_{k}"
vx = "vx_{k}"
vy = "vy_{k}"
length = 4.5
width = 1.8
[class]
column = "id_{k}"
default = "car"
[ego]
ids = ["0"]
"""


class Format(NamedTuple):
    """How to write a drive in a format, and what a check of it needs.

    `is_own`: the log or its mapping names the ego. `has_empty_frames`: a frame in which nobody is leaves a trace. `ego`: its name.
    """

    write: Callable[[Path, list[Frame]], Path]
    is_own: bool = True
    has_empty_frames: bool = False
    mapping: str | None = None
    ego: str = EGO
    ego_size: str | None = None

    def options(self, path: Path) -> dict[str, Any]:
        """Return the options of a check of a log that was written to a path."""
        options: dict[str, Any] = {"ego_size": self.ego_size} if self.is_own else {"ego": self.ego}
        if self.mapping is not None:
            (path.parent / f"{path.stem}.toml").write_text(self.mapping, encoding="utf-8")
            options["mapping"] = str(path.parent / f"{path.stem}.toml")
        return options


def drive() -> list[Frame]:
    """Return the whole drive."""
    return [
        Frame(i / 10, [Car(EGO, float(i), 0.0), Car(OTHER, 16.0 + 0.6 * i, 0.0, vx=6.0), Car("2", float(i), 8.0)])
        for i in range(N)
    ]


def without(frames: list[Frame], gap: range, *names: str) -> list[Frame]:
    """Return the drive without some cars in some frames; no name: without anybody."""
    return [
        Frame(frame.t_s, [car for car in frame.cars if i not in gap or (names and car.name not in names)])
        for i, frame in enumerate(frames)
    ]


def osi_with_host(frames: list[Frame], gap: range, host: int | None) -> list[Any]:
    """Return OSI ground truths that name another host, or none, in some frames."""
    truths = drives.truths(frames)
    for i in gap:
        truths[i].ClearField("host_vehicle_id")
        if host is not None:
            truths[i].host_vehicle_id.value = host
    return truths


def osi_mcap_with_host(path: Path, frames: list[Frame], gap: range, host: int | None) -> Path:
    """Write such truths as MCAP."""
    return osi_log.write(path.with_suffix(".mcap"), osi_log.truths(osi_with_host(frames, gap, host)))


def osi_file_with_host(path: Path, frames: list[Frame], gap: range, host: int | None) -> Path:
    """Write such truths as a trace file."""
    found = path.with_suffix(".osi")
    messages = [truth.SerializeToString() for truth in osi_with_host(frames, gap, host)]
    found.write_bytes(b"".join(len(each).to_bytes(4, "little") + each for each in messages))
    return found


def odometry(path: Path, frames: list[Frame]) -> Path:
    """Write a ROS 2 log in which the ego is an odometry and the others are objects, beside each other."""
    return ros_log.write(path.with_suffix(".mcap"), _with_odometry(frames))


def odometry_in_sqlite(path: Path, frames: list[Frame]) -> Path:
    """Write the same log as a bag before Iron does."""
    return sqlite_log.write(path.with_suffix(".db3"), _with_odometry(frames), definitions=False)


def transforms(path: Path, frames: list[Frame]) -> Path:
    """Write a ROS 2 log in which the ego is a frame that moves in the map."""
    messages = []
    for topic, name, t_s, content in _with_odometry(frames):
        if name == "nav_msgs/Odometry":
            place = content["pose"]["pose"]["position"]
            messages.append(ros_log.transform(t_s, "map", "base_link", place["x"], place["y"]))
        else:
            messages.append((topic, name, t_s, content))
    return ros_log.write(path.with_suffix(".mcap"), messages)


def _with_odometry(frames: list[Frame]) -> list[ros_log.Message]:
    messages: list[ros_log.Message] = []
    for t_s, cars in frames:
        others = [ros_log.thing(int(car.name), car.x, car.y, car.yaw, car.vx) for car in cars if car.name != EGO]
        messages.append(ros_log.things(t_s, *others, topic="/objects"))
        messages += [ros_log.odometry(t_s, car.x, car.y, car.yaw, car.vx) for car in cars if car.name == EGO]
    return messages


def carla(path: Path, frames: list[Frame]) -> Path:
    """Write a ROS 2 log of the CARLA bridge, whose ego info names one of its objects."""
    info = "/carla/hero/vehicle_info", "carla_msgs/CarlaEgoVehicleInfo", 0.0, {"id": int(EGO), "rolename": "hero"}
    return ros_log.write(path.with_suffix(".mcap"), [info, *drives.things(frames)])


def canonical(path: Path, frames: list[Frame]) -> Path:
    """Write a canonical folder that marks its ego; a frame in which nobody is is a row with its time alone."""
    path.mkdir()
    states = drives.table(frames)
    empty = [round(frame.t_s * 1e9) for frame in frames if not frame.cars]
    rows = [*states.to_pylist(), *({"t_ns": t_ns} for t_ns in empty)]
    pq.write_table(pa.Table.from_pylist(rows, schema=states.schema), path / "actor_state.parquet")
    actors = [
        {"actor_id": name, "is_ego": name == EGO, "actor_class": "car", "length_m": 4.5, "width_m": 1.8}
        for name in "012"
    ]
    pq.write_table(pa.Table.from_pylist(actors), path / "actor.parquet")
    pq.write_table(pa.table({"n_states": [len(states)]}), path / "data_log.parquet")
    return path


def flagged_parquet(path: Path, frames: list[Frame]) -> Path:
    """Write one Parquet file of canonical states that marks its ego."""
    states = drives.table(frames)
    flags = [name == EGO for name in states["actor_id"].to_pylist()]
    found = path.with_suffix(".parquet")
    pq.write_table(states.append_column("is_ego", pa.array(flags)), found)
    return found


def wide_csv(path: Path, frames: list[Frame]) -> Path:
    """Write a table with a group of columns for each car, empty where it is absent."""
    columns = ("id", "x", "y", "yaw", "vx", "vy")
    lines = ["t," + ",".join(f"{name}_{k}" for k in range(3) for name in columns)]
    for t_s, cars in frames:
        there = {car.name: car for car in cars}
        cells = [f"{t_s:.3f}"]
        for k in range(3):
            car = there.get(str(k))
            cells += [""] * len(columns) if car is None else [car.name, *(f"{v:.4f}" for v in (*car[1:], 0.0))]
        lines.append(",".join(cells))
    return logs.table(path.with_suffix(".csv"), lines)


def omega_prime(path: Path, frames: list[Frame]) -> Path:
    """Write omega-prime's Parquet, whose metadata name the host."""
    rows = [
        {
            "total_nanos": round(t_s * 1e9), "idx": int(car.name), "x": car.x, "y": car.y, "z": 0.75, "yaw": car.yaw, "vel_x": car.vx,
            "vel_y": 0.0, "acc_x": 0.0, "acc_y": 0.0, "length": 4.5, "width": 1.8, "height": 1.5, "type": 2, "role": 0, "subtype": 4,
        }
        for t_s, cars in frames
        for car in cars
    ]  # fmt: skip
    found = path.with_suffix(".parquet")
    pq.write_table(pa.Table.from_pylist(rows).replace_schema_metadata({"host_vehicle_idx": EGO}), found)
    return found


def sumo(path: Path, frames: list[Frame]) -> Path:
    """Write SUMO's floating car data, whose steps are there when nobody is."""
    rows = [
        {
            "time": f"{t_s:.2f}", "id": car.name, "x": car.x + 2.5, "y": car.y, "angle": 90.0, "type": "DEFAULT_VEHTYPE",
            "speed": car.vx,
        }
        for t_s, cars in frames
        for car in cars
    ]  # fmt: skip
    found = path.with_suffix(".fcd.xml")
    found.write_text(fcd_text.xml(rows), encoding="utf-8")
    return found


def commonroad(path: Path, frames: list[Frame]) -> Path:
    """Write a CommonRoad scenario."""
    obstacles = []
    for name in "012":
        states = [
            f"<position><point><x>{car.x}</x><y>{car.y}</y></point></position><orientation><exact>0</exact></orientation>"
            f"<time><exact>{i}</exact></time><velocity><exact>{car.vx}</exact></velocity>"
            for i, frame in enumerate(frames)
            for car in frame.cars
            if car.name == name
        ]
        trajectory = "".join(f"<state>{state}</state>" for state in states[1:])
        obstacles.append(
            f'<dynamicObstacle id="{name}"><type>car</type><shape><rectangle><length>4.5</length><width>1.8</width></rectangle></shape>'
            f"<initialState>{states[0]}</initialState><trajectory>{trajectory}</trajectory></dynamicObstacle>"
        )
    found = path.with_suffix(".xml")
    found.write_text(f'<commonRoad timeStepSize="0.1">{"".join(obstacles)}</commonRoad>', encoding="utf-8")
    return found


FORMATS: Final = {
    "osi-mcap": Format(drives.osi_mcap, has_empty_frames=True),
    "osi-file": Format(drives.osi_file, has_empty_frames=True),
    "ros odometry": Format(odometry, has_empty_frames=True, ego="ego", ego_size="4.5,1.8"),
    "ros sqlite": Format(odometry_in_sqlite, has_empty_frames=True, ego="ego", ego_size="4.5,1.8"),
    "ros transforms": Format(transforms, has_empty_frames=True, ego="ego", ego_size="4.5,1.8"),
    "ros carla": Format(carla, has_empty_frames=True),
    "canonical": Format(canonical, has_empty_frames=True),
    "flagged parquet": Format(flagged_parquet),
    "csv": Format(drives.csv, mapping=drives.MAPPING),
    "wide csv": Format(wide_csv, has_empty_frames=True, mapping=WIDE),
    "omega-prime": Format(omega_prime),
    # without an ego of their own
    "foxglove": Format(drives.foxglove, is_own=False),
    "ros objects": Format(drives.ros, is_own=False),
    "bare parquet": Format(drives.parquet, is_own=False),
    "sumo": Format(sumo, is_own=False),
    "commonroad": Format(commonroad, is_own=False),
}
