"""The ego's box: by Autoware's parameters of the vehicle where the log has them, and where the centre then lies."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from drivelint.drive.trace import EgoSize
from tests.formats.logs import at, quality, read, size, states
from tests.formats.logs import messages as told
from tests.formats.ros2 import autoware_log as autoware
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import T0, TURN, ego, ticks

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

SIZE = pytest.approx((4.89, 1.896, 2.5))
AHEAD = 1.345


def trace_of(folder: Path, messages: list[ros.Message], **options: Any) -> Trace:
    return read(autoware.write(folder / "log.mcap", messages), **options)


def axle(**options: Any) -> list[ros.Message]:
    """Return the odometry of the rear axle."""
    return ego(child="base_link", **options)


def parameters(node: str = "/a", t_s: float = T0, /, **values: float) -> list[ros.Message]:
    return autoware.parameters(t_s, node, **{**autoware.PARAMETERS, **values})


def test_size_and_centre(tmp_path: Path) -> None:
    """Odometry is the rear axle's, on the ground; a state is the centre of the box."""
    trace = trace_of(tmp_path, [*axle(), *parameters()])
    assert size(trace) == SIZE
    state = at(trace, "ego", T0)
    place = AHEAD * math.cos(TURN), AHEAD * math.sin(TURN), 1.25
    assert (state["x_m"], state["y_m"], state["z_m"]) == pytest.approx(place)
    assert "reference_point" not in quality(trace)
    assert trace.notes[0] == ("the ego's box is taken from /a: 4.89 m by 1.90 m, its centre 1.34 m ahead of base_link")


def test_without_parameters_nothing_is_made_up(tmp_path: Path) -> None:
    trace = trace_of(tmp_path, axle())
    assert size(trace) == (None, None, None)
    assert (at(trace, "ego", T0)["x_m"], quality(trace)["reference_point"]["severity"]) == (0.0, "warning")


def test_a_vehicle_with_a_side_that_sticks_out(tmp_path: Path) -> None:
    trace = trace_of(tmp_path, [*axle(), *parameters(left_overhang=0.528)])
    assert size(trace) == pytest.approx((4.89, 2.296, 2.5))
    assert trace.notes[0].endswith("ahead of base_link and 0.20 m to the left")
    state = at(trace, "ego", T0)
    place = AHEAD * math.cos(TURN) - 0.2 * math.sin(TURN), AHEAD * math.sin(TURN) + 0.2 * math.cos(TURN)
    assert (state["x_m"], state["y_m"]) == pytest.approx(place)


@pytest.mark.parametrize("child", ["base_link", "robot/base_link", "/base_link"])
def test_the_centre_swings_when_the_vehicle_turns(tmp_path: Path, child: str) -> None:
    """On a circle of 25 m at 0.4 rad/s: the centre's velocity is that of its own places."""
    other: dict[str, Any] = {"turning": 0.4, "child": child, "topic": "/odometry"}
    messages = [
        ros.odometry(t_s, 25.0 * math.sin(turn), -25.0 * math.cos(turn), turn, 10.0, **other)
        for t_s, turn in ((t_s, 0.4 * (t_s - T0)) for t_s in ticks(81))
    ]
    trace = trace_of(tmp_path, [*messages, *parameters(left_overhang=0.528)])
    rows = states(trace, "ego")
    before, here, after = rows[39:42]
    for place, velocity in (("x_m", "vx_mps"), ("y_m", "vy_mps")):
        assert here[velocity] == pytest.approx((after[place] - before[place]) / 0.1, abs=2e-3)
    assert {"velocity_mismatch", "twist_frame", "reference_point"}.isdisjoint(quality(trace))


def test_nodes_that_agree(tmp_path: Path) -> None:
    """The parameters may come late; one that is set again counts as it is then."""
    late = parameters("/b", T0 + 1.0)
    changed = autoware.parameters(T0 + 0.5, "/b", wheel_base=9.0)
    assert size(trace_of(tmp_path, [*axle(), *parameters(), *changed, *late])) == SIZE
    of_event = changed[0][3]
    of_event["changed_parameters"] = of_event.pop("new_parameters")
    trace = trace_of(tmp_path, [*axle(), *parameters("/a", T0 - 1.0), *parameters("/b", T0 - 1.0), *changed])
    assert size(trace) == (None, None, None)
    found = quality(trace)["ego_size"]
    assert found["message"] == "/a, /b give the ego different sizes, and none is used: set it with --ego-size"


def test_nodes_that_say_only_a_part(tmp_path: Path) -> None:
    """The lengths of two nodes may be those of two vehicles."""
    front = autoware.parameters(T0, "/a", wheel_base=2.79, front_overhang=1.0, rear_overhang=1.1)
    side = autoware.parameters(T0, "/b", wheel_tread=1.64, left_overhang=0.128, right_overhang=0.128)
    assert size(trace_of(tmp_path, [*axle(), *front, *side])) == (None, None, None)


@pytest.mark.parametrize(
    "wrong", [{"wheel_base": math.nan}, {"wheel_base": 0.0}, {"front_overhang": 2790.0}, {"wheel_tread": -1.0}]
)
def test_lengths_of_no_vehicle(tmp_path: Path, wrong: dict[str, float]) -> None:
    trace = trace_of(tmp_path, [*axle(), *parameters(**wrong)])
    assert (size(trace), at(trace, "ego", T0)["x_m"]) == ((None, None, None), 0.0)


def test_without_a_height_the_place_is_the_axles(tmp_path: Path) -> None:
    trace = trace_of(tmp_path, [*axle(), *parameters(vehicle_height=math.nan)])
    assert size(trace)[2] is None
    assert at(trace, "ego", T0)["z_m"] == 0.0


def test_whole_numbers(tmp_path: Path) -> None:
    messages = parameters(wheel_base=3.0)
    said = (of["new_parameters"][0] for *_, of in messages)
    value = next(each["value"] for each in said if each["name"] == "wheel_base")
    value.update(type=2, integer_value=3, double_value=0.0)
    assert size(trace_of(tmp_path, [*axle(), *messages]))[0] == pytest.approx(5.1)
    value.update(type=4, string_value="3")
    assert size(trace_of(tmp_path, [*axle(), *messages])) == (None, None, None)


def dimensions() -> list[ros.Message]:
    """Return the answer of the service as a message, in single precision."""
    values = {**autoware.PARAMETERS, "height": autoware.PARAMETERS["vehicle_height"]}
    return [("/api/vehicle/dimensions", "autoware_adapi_v1_msgs/VehicleDimensions", T0, values)]


def test_recorded_dimensions(tmp_path: Path) -> None:
    assert size(trace_of(tmp_path, [*axle(), *dimensions()])) == pytest.approx((4.89, 1.896, 2.5), abs=1e-6)
    both = trace_of(tmp_path, [*axle(), *dimensions(), *parameters()])
    assert size(both) == SIZE
    assert "ego_size" not in quality(both)


def test_another_frame_than_the_axles(tmp_path: Path) -> None:
    """The size is the vehicle's; where its centre lies from that frame nobody says, unless the user does."""
    trace = trace_of(tmp_path, [*ego(child="imu"), *parameters()])
    assert size(trace) == SIZE
    assert at(trace, "ego", T0)["x_m"] == 0.0
    assert quality(trace)["reference_point"]["severity"] == "warning"
    given = trace_of(tmp_path, [*ego(child="imu"), *parameters()], ego_size=EgoSize(4.89, 1.9, 2.0))
    assert at(given, "ego", T0)["x_m"] == pytest.approx(2.0 * math.cos(TURN))
    assert "reference_point" not in quality(given)


def test_the_log_counts_before_the_option(tmp_path: Path) -> None:
    trace = trace_of(tmp_path, [*axle(), *parameters()], ego_size=EgoSize(3.0, 1.9, 0.7))
    assert size(trace) == SIZE
    assert at(trace, "ego", T0)["x_m"] == pytest.approx(AHEAD * math.cos(TURN))
    assert told(trace, "ego_size") == [
        "--ego-size puts the centre of the ego's box 0.7 m ahead of base_link, but the log states 1.345 m: the value of the log is used",
        "--ego-size gives ego a length of 3 m, but the log states 4.89 m: the value of the log is used",
    ]


def test_the_option_counts_where_the_log_says_nothing(tmp_path: Path) -> None:
    trace = trace_of(tmp_path, axle(), ego_size=EgoSize(4.0, 1.7, 1.2))
    assert size(trace) == (4.0, 1.7, None)
    assert at(trace, "ego", T0)["x_m"] == pytest.approx(1.2 * math.cos(TURN))


def test_parameters_that_cannot_be_read_leave_the_drive_whole(tmp_path: Path) -> None:
    """Their definition in another language is no reason to refuse a log, or to call it lossy."""
    text = ros.definition("rcl_interfaces/ParameterEvent", autoware.TYPES).encode()
    path = autoware.write(tmp_path / "log.mcap", [*axle(), *parameters()])
    with (tmp_path / "idl.mcap").open("wb") as file, path.open("rb") as log:
        writer = Writer(file)
        writer.start(profile="ros2")
        channels: dict[str, int] = {}
        for schema, channel, message in make_reader(log).iter_messages():
            assert schema is not None
            if channel.topic not in channels:
                encoding = "ros2idl" if schema.data == text else schema.encoding
                number = writer.register_schema(schema.name, encoding, schema.data)
                channels[channel.topic] = writer.register_channel(channel.topic, "cdr", number)
            writer.add_message(channels[channel.topic], message.log_time, message.data, message.publish_time)
        writer.finish()  # type: ignore[no-untyped-call]
    assert size(read(path)) == SIZE
    trace = read(tmp_path / "idl.mcap")
    assert size(trace) == (None, None, None)
    assert "unread_topic" not in quality(trace)
