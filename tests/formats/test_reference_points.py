"""One track, one reference point: what every trace format can say of a turning car is read as the same box centre and heading.

The car goes through a left-hand bend. Each writer says where it is by the point that its format is written for: the centre of the box, the
middle of the rear axle, the middle of the front bumper, or the origin of a shape.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.drive.trace import EgoSize
from drivelint.formats.foxglove import scene as foxglove_scene
from drivelint.formats.registry import readers
from drivelint.formats.ros2 import reader as ros2_reader
from tests.formats.commonroad.scenario_text import state as commonroad_state
from tests.formats.foxglove import foxglove_log
from tests.formats.logs import put, read, states
from tests.formats.osi import osi_file, osi_log
from tests.formats.ros2 import ros_log
from tests.formats.sumo import fcd_text

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from drivelint.drive.trace import Trace

N, STEP_S = 21, 0.1
LENGTH, WIDTH, HEIGHT = 4.5, 1.8, 1.5
AHEAD, ASIDE = 1.4, 0.1
"""The centre lies so far ahead and to the left of the middle of the rear axle."""
RADIUS, YAW_RATE = 20.0, 0.4
NEAR_M, NEAR_RAD = 1e-3, 1e-6


class Pose(NamedTuple):
    """Where the centre of the car's box is, and how it moves."""

    t_s: float
    x: float
    y: float
    yaw: float
    vx: float
    vy: float

    def point(self, ahead: float, left: float = 0.0) -> tuple[float, float]:
        """Return a point of the car that lies so far ahead and to the left of the centre."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return self.x + ahead * cos - left * sin, self.y + ahead * sin + left * cos

    def velocity_of(self, ahead: float, left: float = 0.0) -> tuple[float, float]:
        x, y = self.point(ahead, left)
        return self.vx - YAW_RATE * (y - self.y), self.vy + YAW_RATE * (x - self.x)


def pose(k: int) -> Pose:
    t_s = k * STEP_S
    yaw = 0.3 + YAW_RATE * t_s
    speed = RADIUS * YAW_RATE
    x, y = 100.0 + RADIUS * math.sin(yaw), 50.0 - RADIUS * math.cos(yaw)
    return Pose(t_s, x, y, yaw, speed * math.cos(yaw), speed * math.sin(yaw))


TRUTH = [pose(k) for k in range(N)]


def commonroad(tmp_path: Path, *, shape: str, ahead: float) -> Trace:
    """The speed is that of the shape's origin, the slip angle the way that it goes against the heading."""
    path = []
    for k, p in enumerate(TRUTH):
        vx, vy = p.velocity_of(ahead)
        slip = f"<slipAngle><exact>{math.atan2(vy, vx) - p.yaw!r}</exact></slipAngle>"
        tag = "state" if k else "initialState"
        text = commonroad_state(tag, k, *p.point(ahead), p.yaw).replace(f"</{tag}>", f"{slip}</{tag}>")
        path.append(text.replace("<exact>8.0</exact></velocity>", f"<exact>{math.hypot(vx, vy)!r}</exact></velocity>"))
    inner = f"<type>car</type><shape>{shape}</shape>{path[0]}<trajectory>{''.join(path[1:])}</trajectory>"
    text = f'<commonRoad timeStepSize="{STEP_S}"><dynamicObstacle id="1">{inner}</dynamicObstacle></commonRoad>'
    return read(put(tmp_path / "a.xml", text), ego="1")


def commonroad_centre(tmp_path: Path) -> Trace:
    size = f"<length>{LENGTH}</length><width>{WIDTH}</width>"
    return commonroad(tmp_path, shape=f"<rectangle>{size}</rectangle>", ahead=0.0)


def commonroad_rear_axle(tmp_path: Path) -> Trace:
    size = f"<length>{LENGTH}</length><width>{WIDTH}</width><originXShift>{-AHEAD}</originXShift>"
    return commonroad(tmp_path, shape=f"<rectangle>{size}</rectangle>", ahead=-AHEAD)


def truths() -> list[object]:
    frames = []
    for p in TRUTH:
        frame = osi_log.frame(round(p.t_s * 1e9), host=1)
        osi_log.moving(frame, 1, p.x, p.y, yaw=p.yaw, v=(p.vx, p.vy), size=(LENGTH, WIDTH, HEIGHT))
        frames.append(frame)
    return frames


def osi_mcap(tmp_path: Path) -> Trace:
    return read(osi_log.write(tmp_path / "a.mcap", osi_log.truths(truths())))


def osi_trace_file(tmp_path: Path) -> Trace:
    return read(osi_file.write(tmp_path / "a.osi", truths()))


def omega_prime(tmp_path: Path) -> Trace:
    rows = [
        {
            "total_nanos": round(p.t_s * 1e9), "idx": 1, "x": p.x, "y": p.y, "z": 0.75, "vel_x": p.vx, "vel_y": p.vy, "vel_z": 0.0,
            "acc_x": 0.0, "acc_y": 0.0, "acc_z": 0.0, "length": LENGTH, "width": WIDTH, "height": HEIGHT, "roll": 0.0,
            "pitch": 0.0, "yaw": p.yaw, "type": 2, "role": 0, "subtype": 4,
        }
        for p in TRUTH
    ]  # fmt: skip
    pq.write_table(pa.Table.from_pylist(rows), tmp_path / "a.parquet")
    return read(tmp_path / "a.parquet", ego="1")


def carla_objects(tmp_path: Path) -> Trace:
    messages = [ros_log.things(p.t_s, ros_log.thing(1, p.x, p.y, p.yaw, RADIUS * YAW_RATE)) for p in TRUTH]
    return read(ros_log.write(tmp_path / "a.mcap", messages), ego="1")


def autoware_tracks(tmp_path: Path) -> Trace:
    messages = [ros_log.tracks(p.t_s, ros_log.track(1, p.x, p.y, p.yaw, RADIUS * YAW_RATE)) for p in TRUTH]
    return read(ros_log.write(tmp_path / "a.mcap", messages), ego="00010203-0405-0607-0809-0a0b0c0d0e01")


def vision_detections(tmp_path: Path) -> Trace:
    messages = []
    for p in TRUTH:
        item = ros_log.detection("1", p.x, p.y, ("car", 1.0))
        item["bbox"]["center"] = ros_log.pose(p.x, p.y, p.yaw)
        messages.append(ros_log.detections(p.t_s, item))
    return read(ros_log.write(tmp_path / "a.mcap", messages), ego="1")


def odometry_at_the_rear_axle(tmp_path: Path) -> Trace:
    """A place that the user has to give: odometry does not say where on the vehicle its frame lies."""
    twist = ros_log.xyz(RADIUS * YAW_RATE, -AHEAD * YAW_RATE)
    messages = [
        ros_log.odometry(p.t_s, *p.point(-AHEAD), p.yaw, twist=twist, turning=YAW_RATE, child="base_link")
        for p in TRUTH
    ]
    return read(ros_log.write(tmp_path / "a.mcap", messages), ego_size=EgoSize(LENGTH, WIDTH, AHEAD))


def foxglove_cubes(tmp_path: Path) -> Trace:
    messages = [
        foxglove_log.scene(p.t_s, foxglove_log.entity("1", p.t_s, p.x, p.y, yaw=p.yaw, life=1.0)) for p in TRUTH
    ]
    return read(foxglove_log.write(tmp_path / "a.mcap", messages), ego="1")


def foxglove_cubes_in_a_moving_frame(tmp_path: Path) -> Trace:
    """The cube lies ahead of the frame that goes with the rear axle."""
    messages = []
    for p in TRUTH:
        messages.append(foxglove_log.transform(p.t_s, "map", "car", *p.point(-AHEAD), yaw=p.yaw))
        messages.append(foxglove_log.scene(p.t_s, foxglove_log.entity("1", p.t_s, AHEAD, life=1.0, frame="car")))
    return read(foxglove_log.write(tmp_path / "a.mcap", messages), ego="1")


def sumo(tmp_path: Path) -> Trace:
    """SUMO 1.28: the middle of the front bumper, an angle clockwise from north."""
    rows = []
    for p in TRUTH:
        x, y = p.point(LENGTH / 2)
        angle = math.degrees(math.pi / 2 - p.yaw) % 360.0
        place = {"x": repr(x), "y": repr(y), "angle": repr(angle)}
        rows.append({"time": f"{p.t_s:.2f}", "id": "1", **place, "type": "t", "speed": 8.0})
    types = f'<vType id="t" vClass="passenger" length="{LENGTH}" width="{WIDTH}"/>'
    put(tmp_path / "r.rou.xml", f"<routes>{types}</routes>")
    return read(put(tmp_path / "a.xml", fcd_text.xml(rows)), ego="1")


def esmini_columns(p: Pose) -> dict[str, str | float]:
    """Return what esmini writes of a car: the middle of its rear axle, and the box from there."""
    (x, y), (vx, vy) = p.point(-AHEAD, -ASIDE), p.velocity_of(-AHEAD, -ASIDE)
    return {
        "Entity_Name [-]": "Ego", "World_Position_X [m]": x, "World_Position_Y [m]": y, "World_Position_Z [m]": 0.0,
        "World_Heading_Angle [rad]": p.yaw, "Heading_Angle_Rate [rad/s]": YAW_RATE, "Vel_X [m/s]": vx, "Vel_Y [m/s]": vy,
        "Acc_X [m/s2]": 0.0, "Acc_Y [m/s2]": 0.0, "bb_x [m]": AHEAD, "bb_y [m]": ASIDE, "bb_z [m]": 0.75, "bb_length [m]": LENGTH,
        "bb_width [m]": WIDTH, "bb_height [m]": HEIGHT,
    }  # fmt: skip


def esmini(tmp_path: Path) -> Trace:
    names = ["Index [-]", "TimeStamp [s]", *(f"#1 {name}" for name in esmini_columns(TRUTH[0]))]
    lines = [*("esmini" for _ in range(6)), ", ".join(names)]
    lines += [", ".join(map(str, (k, p.t_s, *esmini_columns(p).values()))) for k, p in enumerate(TRUTH)]
    return read(put(tmp_path / "a.csv", "\n".join(lines) + "\n"), mapping="esmini")


def table(tmp_path: Path, *, ahead: float, left: float = 0.0, reference: str = "", columns: str = "") -> Trace:
    lines = ["t,id,x,y,yaw,vx,vy,length,width"]
    for p in TRUTH:
        values = (*p.point(ahead, left), p.yaw, *p.velocity_of(ahead, left), LENGTH, WIDTH)
        lines.append(",".join([repr(p.t_s), "1", *map(repr, values)]))
    read_as = "".join(f'{name} = "{name}"\n' for name in ("x", "y", "yaw", "vx", "vy", "length", "width"))
    mapping = f'[time]\ncolumn = "t"\n[columns]\nactor_id = "id"\n{read_as}{columns}{reference}[ego]\nids = ["1"]\n'
    path = put(tmp_path / "a.csv", "\n".join(lines) + "\n")
    return read(path, mapping=str(put(tmp_path / "m.toml", mapping)))


def table_centre(tmp_path: Path) -> Trace:
    return table(tmp_path, ahead=0.0)


def table_rear_axle(tmp_path: Path) -> Trace:
    reference = f'[reference]\npoint = "rear_axle"\nforward = {AHEAD}\nleft = {ASIDE}\n'
    return table(tmp_path, ahead=-AHEAD, left=-ASIDE, reference=reference)


def table_front_bumper(tmp_path: Path) -> Trace:
    return table(tmp_path, ahead=LENGTH / 2, reference='[reference]\npoint = "front_bumper"\n')


def table_left_handed(tmp_path: Path) -> Trace:
    """Y and heading turned, as in CARLA's own frame."""
    lines = ["time,agentNo,agentType,x,y,z,yaw,vel_x,vel_y"]
    for p in TRUTH:
        values = (p.x, -p.y, 0.0, -p.yaw, p.vx, -p.vy)
        lines.append(",".join([repr(p.t_s), "1", "vehicle.tesla.model3", *map(repr, values)]))
    return read(put(tmp_path / "a.csv", "\n".join(lines) + "\n"), mapping="carla-testbench")


def canonical(tmp_path: Path) -> Trace:
    """A converted log: the tables of the model, box centres."""
    names = "x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps"
    rows = [{"t_ns": round(p.t_s * 1e9), "actor_id": "1", **dict(zip(names, p[1:], strict=True))} for p in TRUTH]
    pq.write_table(pa.Table.from_pylist(rows), tmp_path / "a.parquet")
    return read(tmp_path / "a.parquet", ego="1")


FORMATS: dict[str, Callable[[Path], Trace]] = {
    of.__name__: of
    for of in (
        commonroad_centre, commonroad_rear_axle, osi_mcap, osi_trace_file, omega_prime, carla_objects, autoware_tracks,
        vision_detections, odometry_at_the_rear_axle, foxglove_cubes, foxglove_cubes_in_a_moving_frame, sumo, esmini, table_centre,
        table_rear_axle, table_front_bumper, table_left_handed, canonical,
    )
}  # fmt: skip


@pytest.mark.parametrize("name", FORMATS)
def test_the_same_box_centre_and_heading(name: str, tmp_path: Path) -> None:
    trace = FORMATS[name](tmp_path)
    (actor,) = trace.tables["actor"]["actor_id"].to_pylist()
    rows = states(trace, actor)
    first = rows[0]["t_ns"]
    assert [row["t_ns"] - first for row in rows] == [round(p.t_s * 1e9) for p in TRUTH]
    off = np.array([[row["x_m"] - p.x, row["y_m"] - p.y] for row, p in zip(rows, TRUTH, strict=True)])
    assert float(np.hypot(*off.T).max()) < NEAR_M
    turned = [math.remainder(row["yaw_rad"] - p.yaw, math.tau) for row, p in zip(rows, TRUTH, strict=True)]
    assert max(map(abs, turned)) < NEAR_RAD


@pytest.mark.parametrize("name", FORMATS)
def test_the_velocity_is_that_of_the_box_centre(name: str, tmp_path: Path) -> None:
    """The centre goes along the heading. The rear axle goes 0.56 m/s sideways against that, the front bumper 0.9 m/s."""
    trace = FORMATS[name](tmp_path)
    rows = states(trace)
    off = [math.hypot(row["vx_mps"] - p.vx, row["vy_mps"] - p.vy) for row, p in zip(rows, TRUTH, strict=True)]
    assert max(off[1:-1]) < 0.1
    assert "velocity_mismatch" not in trace.tables["quality"]["check_id"].to_pylist()


@pytest.mark.parametrize("module", [*readers(), ros2_reader, foxglove_scene], ids=lambda module: module.__name__)
def test_every_reader_says_where_its_places_are(module: object) -> None:
    said = re.sub(r"\s+", " ", module.__doc__ or "")
    assert re.search(r"box centre|centre of (the|its|their) box|front bumper|rear axle", said), said
