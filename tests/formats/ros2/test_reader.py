"""ROS 2 logs: the CARLA bridge, Autoware and plain detections, with their frames, clocks and ids."""

from __future__ import annotations

import contextlib
import math
from typing import TYPE_CHECKING

import pytest
import typer

from drivelint.cli import app
from drivelint.drive.trace import EgoSize
from drivelint.errors import TraceError, UsageError
from tests.formats.logs import actors, at, classes, egos, log, quality, read, size, states
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import T0, TURN, N, along, ego, road_users, ticks, trace_of

if TYPE_CHECKING:
    from pathlib import Path


def info(number: int, role: str = "hero") -> ros.Message:
    content = {"id": number, "type": "vehicle.x", "rolename": role, "wheels": [{"tire_friction": 3.5}] * 4}
    return f"/carla/{role}/vehicle_info", "carla_msgs/CarlaEgoVehicleInfo", T0, content


def test_objects_and_odometry(tmp_path: Path) -> None:
    trace = trace_of(tmp_path, [*ego(), *road_users()])
    assert log(trace)["format"] == "ros2-mcap"
    assert classes(trace) == {"9": "car", "12": "pedestrian", "ego": "vehicle"}
    assert egos(trace) == ["ego"]
    assert (size(trace, "9"), size(trace, "12")) == ((4.5, 1.8, 1.5), (0.6, 0.6, 1.8))
    assert actors(trace)["ego"]["length_m"] is None
    here = at(trace, "ego", T0 + 1.0)
    assert (here["x_m"], here["y_m"]) == pytest.approx((5.0, 10.0 * math.sin(TURN)))
    assert here["yaw_rad"] == pytest.approx(TURN)
    # the twist of odometry is along the vehicle, that of objects is in the frame of the header
    assert (here["vx_mps"], here["vy_mps"]) == pytest.approx((5.0, 10.0 * math.sin(TURN)))
    car = at(trace, "9", T0 + 1.0)
    assert (car["vx_mps"], car["vy_mps"]) == pytest.approx((-5.0, -10.0 * math.sin(TURN)))
    assert "velocity_mismatch" not in quality(trace)
    assert quality(trace)["reference_point"]["severity"] == "warning"


@pytest.mark.parametrize("child", ["map", ""])
def test_twist_in_the_frame_that_the_odometry_says(tmp_path: Path, child: str) -> None:
    twist = ros.xyz(10.0 * math.cos(TURN), 10.0 * math.sin(TURN))
    trace = trace_of(tmp_path, [*ego(child=child, twist=twist), *road_users()])
    assert at(trace, "ego", T0 + 1.0)["vx_mps"] == pytest.approx(5.0)
    assert "twist_frame" not in quality(trace)


def test_twist_of_odometry_in_the_wrong_frame(tmp_path: Path) -> None:
    """Old bridges give it in the map's frame: the positions tell."""
    twist = ros.xyz(10.0 * math.cos(TURN), 10.0 * math.sin(TURN))
    trace = trace_of(tmp_path, [*ego(twist=twist), *road_users()])
    state = at(trace, "ego", T0 + 1.0)
    assert (state["vx_mps"], state["vy_mps"]) == pytest.approx((5.0, 10.0 * math.sin(TURN)))
    assert quality(trace)["twist_frame"]["n"] == N


def test_twist_of_objects_in_the_wrong_frame(tmp_path: Path) -> None:
    messages = [ros.things(t_s, ros.thing(9, *along(t_s), TURN, twist={"linear": ros.xyz(10.0)})) for t_s in ticks()]
    trace = trace_of(tmp_path, messages, ego="9")
    assert at(trace, "9", T0 + 1.0)["vy_mps"] == pytest.approx(10.0 * math.sin(TURN))
    assert "twist_frame" in quality(trace)


def test_wrong_twist_is_not_turned(tmp_path: Path) -> None:
    """A twist that fits in neither frame is that of another motion: the positions' counts."""
    trace = trace_of(tmp_path, [*ego(twist=ros.xyz(20.0)), *road_users()])
    assert at(trace, "ego", T0 + 1.0)["vx_mps"] == pytest.approx(5.0)
    assert "twist_frame" not in quality(trace)
    assert quality(trace)["velocity_derived"]["actor_id"] == "ego"


def test_ego_among_the_objects_by_its_id(tmp_path: Path) -> None:
    """The bridge's /carla/objects has the ego: one actor, with its size; its own topic of objects has not."""
    objects = [
        ros.things(t_s, ros.thing(7, *along(t_s), TURN, 10.0), ros.thing(9, 50.0, 0.0, classification=7))
        for t_s in ticks()
    ]
    trace = trace_of(tmp_path, [info(7), *objects, *ego()])
    assert (set(actors(trace)), egos(trace)) == ({"7", "9"}, ["7"])
    assert (actors(trace)["7"]["length_m"], len(states(trace, "7"))) == (4.5, N)
    assert quality(trace)["ego_twice"]["severity"] == "info"


def test_ego_among_the_objects_without_being_said(tmp_path: Path) -> None:
    """Else it would drive inside another car for the whole drive."""
    objects = [ros.things(t_s, ros.thing(7, *along(t_s), TURN, 10.0), ros.thing(9, 2.0, 0.0)) for t_s in ticks()]
    trace = trace_of(tmp_path, [*objects, *ego()])
    assert (set(actors(trace)), egos(trace)) == ({"7", "9"}, ["7"])


def test_finer_odometry_counts(tmp_path: Path) -> None:
    """Odometry at 100 Hz with objects at 20 Hz: the ego's states are the odometry's, its size is the object's."""
    objects = [ros.things(t_s, ros.thing(7, *along(t_s), TURN, 10.0), ros.thing(9, 50.0, 0.0)) for t_s in ticks()]
    trace = trace_of(tmp_path, [info(7), *objects, *ego(0.01, 200)])
    assert len(states(trace, "7")) == 200
    assert (size(trace, "7"), classes(trace)["7"]) == ((4.5, 1.8, 1.5), "car")


def test_own_times_are_kept(tmp_path: Path) -> None:
    """Each actor keeps the time stamps of its messages, whatever the container's."""
    own, other = (
        trace_of(tmp_path, [*ego(0.02, 100, log_s=5000.0), *road_users()]),
        trace_of(tmp_path, road_users(), ego="9"),
    )
    for rows, step_ns in ((states(own, "ego"), 20_000_000), (states(other), 50_000_000)):
        assert [row["t_ns"] for row in rows][:3] == [100_000_000_000 + k * step_ns for k in range(3)]


def test_egos_by_topic(tmp_path: Path) -> None:
    """Two egos: the id is that beside the odometry; which odometry counts, the user says."""
    objects = [
        ros.things(t_s, ros.thing(7, *along(t_s), TURN, 10.0), ros.thing(8, *along(t_s, 8.0), TURN, 8.0))
        for t_s in ticks()
    ]
    two = [ros.odometry(t_s, *along(t_s, 8.0), TURN, 8.0, topic="/carla/rival/odometry") for t_s in ticks()]
    messages = [info(7), info(8, "rival"), *objects, *ego(), *two]
    with pytest.raises(TraceError, match=r"odometry on 2 topics \(/carla/hero/odometry, /carla/rival/odometry\)"):
        trace_of(tmp_path, messages)
    for topic, name in (("/carla/rival/odometry", "8"), ("/carla/hero/odometry", "7")):
        assert egos(trace_of(tmp_path, messages, topic=topic)) == [name]
    with pytest.raises(TraceError, match="topic '/x' has no messages that can be read"):
        trace_of(tmp_path, messages, topic="/x")


def test_two_object_topics(tmp_path: Path) -> None:
    """Both number their objects: together, ids would collide."""
    messages = [*ego(), *road_users(), *road_users(topic="/carla/hero/objects")]
    said = r"road users on 2 topics \(/carla/hero/objects, /carla/objects\): choose with --topic"
    with pytest.raises(TraceError, match=said):
        trace_of(tmp_path, messages)
    assert len(states(trace_of(tmp_path, messages, topic="/carla/hero/objects"), "9")) == N


def test_one_id_twice_in_a_message(tmp_path: Path) -> None:
    objects = [ros.things(t_s, ros.thing(9, 50.0, 0.0), ros.thing(9, 80.0, 0.0)) for t_s in ticks()]
    found = quality(trace_of(tmp_path, [*ego(), *objects]))["duplicate_state"]
    assert (found["n"], found["severity"], found["actor_id"]) == (N, "error", "9")


def test_an_object_called_ego(tmp_path: Path) -> None:
    messages = [*ego(), *[ros.detections(t_s, ros.detection("ego", 50.0, 0.0, ("car", 1.0))) for t_s in ticks()]]
    trace = trace_of(tmp_path, messages)
    assert (set(actors(trace)), egos(trace)) == ({"ego", "ego_odometry"}, ["ego_odometry"])


def test_carlas_origins(tmp_path: Path) -> None:
    """The origin of a vehicle lies on the ground below its box, that of a pedestrian in its middle."""
    messages = [info(7), *road_users()]
    trace = trace_of(tmp_path, messages, ego="9")
    assert at(trace, "9", T0)["z_m"] == 0.75
    assert at(trace, "12", T0)["z_m"] == 0.0
    found = quality(trace)["reference_point"]
    assert found["severity"] == "info"
    assert "used as the centres of their boxes" in found["message"]
    assert "reference_point" not in quality(trace_of(tmp_path, road_users(), ego="9"))


def test_map_in_the_log(tmp_path: Path) -> None:
    def world(text: str, topic: str = "/carla/world_info") -> ros.Message:
        return topic, "carla_msgs/CarlaWorldInfo", T0, {"map_name": "Town01", "opendrive": text}

    trace = trace_of(tmp_path, [world("<OpenDRIVE/>"), world(""), *ego(), world("<OpenDRIVE/>", "/again")])
    assert trace.embedded_map == b"<OpenDRIVE/>"
    assert trace_of(tmp_path, ego()).embedded_map is None
    several = trace_of(tmp_path, [world("<OpenDRIVE/>"), world("<OpenDRIVE></OpenDRIVE>"), *ego()])
    assert several.embedded_map is None
    assert "2 different OpenDRIVE maps" in quality(several)["own_map_unusable"]["message"]


def test_ego_size(tmp_path: Path) -> None:
    """The rear axle drives on a circle, the centre 1.4 m before it on a larger one, and faster."""
    rate = 0.5
    messages = [
        ros.odometry(t_s, 20 * math.sin(yaw), -20 * math.cos(yaw), yaw, 10.0, turning=rate)
        for t_s, yaw in ((t_s, rate * (t_s - T0)) for t_s in ticks())
    ]
    trace = trace_of(tmp_path, messages, ego_size=EgoSize(4.9, 1.9, 1.4))
    assert size(trace)[:2] == (4.9, 1.9)
    state = at(trace, "ego", T0 + 1.0)
    assert math.hypot(state["x_m"], state["y_m"]) == pytest.approx(math.hypot(20, 1.4))
    assert math.hypot(state["vx_mps"], state["vy_mps"]) == pytest.approx(rate * math.hypot(20, 1.4))
    assert {"no_size", "velocity_mismatch", "reference_point", "twist_frame"}.isdisjoint(quality(trace))
    assert quality(trace)["assumed_size"]["message"] == "size from --ego-size, not recorded"


@pytest.mark.parametrize("text", ["4.9", "4.9,0", "-4.9,1.9", "4.9,x", "nan,1.9", "4.9,1.9,1.4,2", ""])
def test_ego_size_on_the_command_line(tmp_path: Path, text: str) -> None:
    path = ros.write(tmp_path / "log.mcap", [*ego(), *road_users()])
    with pytest.raises(UsageError, match="write length and width in metres"):
        app(["inspect", str(path), "--ego-size", text], standalone_mode=False)


def test_ego_size_reaches_the_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = ros.write(tmp_path / "log.mcap", [*ego(), *road_users()])
    for command in (["inspect", str(path)], ["convert", str(path), "--to", "parquet", "--out", str(tmp_path / "out")]):
        with contextlib.suppress(typer.Exit):
            app([*command, "--ego-size", "4.9,1.9,1.4"], standalone_mode=False)
    assert "4.90 x 1.90 m" in capsys.readouterr().out
    assert actors(read(tmp_path / "out"))["ego"]["length_m"] == 4.9


def test_ego_size_of_the_log_counts(tmp_path: Path) -> None:
    trace = trace_of(tmp_path, road_users(), ego="9", ego_size=EgoSize(4.9, 1.82))
    assert size(trace, "9")[:2] == (4.5, 1.8)
    assert "length of 4.9 m, but the log states 4.5 m" in quality(trace)["ego_size"]["message"]
    assert "assumed_size" not in quality(trace)


def test_the_time_of_a_gap_counts_from_the_start_of_the_drive(tmp_path: Path) -> None:
    kept = [message for message in [*ego(), *road_users()] if not 0.51 < message[2] - T0 < 1.49]
    message = quality(trace_of(tmp_path, kept))["gap"]["message"]
    assert "the longest 1 s, the first from 0.5 s" in message
