"""OSI ground truth in MCAP, written by the tests: fields, quirks of real files, topics, and what cannot be read."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from google.protobuf import descriptor_pb2

from drivelint.errors import TraceError
from tests.formats.logs import actors, at, classes, egos, log, quality, read, size, states, without_id
from tests.formats.logs import messages as said
from tests.formats.osi import osi_log
from tests.formats.osi.bulbs import bulb, write

if TYPE_CHECKING:
    from pathlib import Path


EPOCH = 1_700_000_000_000_000_000


def test_ground_truth(tmp_path: Path) -> None:
    trace = read(write(tmp_path, osi_log.drive(a=(0.5, 0.0), indicator=3, brake=4)))
    assert trace.drive_id.startswith("drive-")
    assert (log(trace)["format"], log(trace)["n_states"]) == ("osi-mcap", 90)
    assert [row["actor_id"] for row in states(trace)][::30] == ["0", "1", "2"]
    row = at(trace, "2", 1.5)
    assert (row["x_m"], row["y_m"], row["z_m"], row["yaw_rad"], row["vx_mps"]) == pytest.approx((15, 8, 0.75, 0, 10))
    assert (row["ax_mps2"], row["indicator"], row["brake_light"]) == (0.5, "left", "strong")
    assert (egos(trace), classes(trace)["0"], size(trace, "0")) == (["0"], "car", (4.5, 1.8, 1.5))
    assert log(trace)["utc_start_ns"] is None
    assert (log(trace)["has_indicator"], log(trace)["has_brake_light"], log(trace)["has_acceleration"]) == (True,) * 3
    assert not quality(trace)


def test_ids_sort_as_text_and_keep_64_bits(tmp_path: Path) -> None:
    frames = []
    for i in range(3):
        truth = osi_log.frame(i * 100_000_000, host=2**64 - 1)
        for number in (9, 10, 2**64 - 1):
            osi_log.moving(truth, number, float(i))
        frames.append(truth)
    trace = read(write(tmp_path, frames))
    assert list(actors(trace)) == ["10", "18446744073709551615", "9"]
    assert actors(trace)["18446744073709551615"]["is_ego"]


@pytest.mark.parametrize(
    ("kind", "vehicle", "expected"),
    [
        (2, 4, "car"),
        (2, 7, "truck"),
        (2, 11, "bicycle"),
        (2, 0, "vehicle"),
        (3, 0, "pedestrian"),
        (3, 4, "pedestrian"),
        (4, 0, "animal"),
        (1, 0, None),
        (0, 0, None),
    ],
)
def test_classes(tmp_path: Path, kind: int, vehicle: int, expected: str | None) -> None:
    trace = read(write(tmp_path, osi_log.drive(2, kind=kind, vehicle=vehicle)))
    assert actors(trace)["0"]["actor_class"] == expected


@pytest.mark.parametrize(
    ("number", "expected"), [(0, None), (1, None), (2, "off"), (3, "left"), (4, "right"), (5, "hazard")]
)
def test_indicators(tmp_path: Path, number: int, expected: str | None) -> None:
    trace = read(write(tmp_path, osi_log.drive(2, indicator=number)))
    assert at(trace, "0", 0.0)["indicator"] == expected
    assert ("no_indicator" in quality(trace)) == (expected is None)


@pytest.mark.parametrize(("number", "expected"), [(0, None), (2, "off"), (3, "on"), (4, "strong")])
def test_brake_lights(tmp_path: Path, number: int, expected: str | None) -> None:
    assert at(read(write(tmp_path, osi_log.drive(2, brake=number))), "0", 0.0)["brake_light"] == expected


def test_numbers_come_from_the_logs_own_schema(tmp_path: Path) -> None:
    """The same names under other numbers: what the log says they are counts."""
    file = descriptor_pb2.FileDescriptorProto()
    file.CopyFrom(osi_log.FILE)
    indicator = next(enum for enum in file.enum_type if enum.name == "Indicator")
    for value in indicator.value:
        value.number = {"INDICATOR_STATE_LEFT": 4, "INDICATOR_STATE_RIGHT": 3}.get(value.name, value.number)
    other = descriptor_pb2.FileDescriptorSet(file=[file]).SerializeToString()
    trace = read(write(tmp_path, osi_log.drive(2, indicator=3), descriptor_set=other))
    assert at(trace, "0", 0.0)["indicator"] == "right"


def test_numbers_without_a_name_are_unknown(tmp_path: Path) -> None:
    file = descriptor_pb2.FileDescriptorProto()
    file.CopyFrom(osi_log.FILE)
    for enum in file.enum_type:
        kept = [value for value in enum.value if value.name not in {"INDICATOR_STATE_LEFT", "TYPE_CAR"}]
        del enum.value[:]
        enum.value.extend(kept)
    other = descriptor_pb2.FileDescriptorSet(file=[file]).SerializeToString()
    trace = read(write(tmp_path, osi_log.drive(2, indicator=3), descriptor_set=other))
    assert (at(trace, "0", 0.0)["indicator"], actors(trace)["0"]["actor_class"]) == (None, "vehicle")


def test_sensor_view(tmp_path: Path) -> None:
    views = []
    for truth in osi_log.drive(5):
        view = osi_log.message("SensorView")
        truth.ClearField("host_vehicle_id")
        view.global_ground_truth.CopyFrom(truth)
        view.host_vehicle_id.value = 1
        views.append(view)
    for at_ns in (500_000_000, 9_000_000_000):  # these carry no ground truth; the last is far from all others
        views.append(osi_log.message("SensorView"))
        views[-1].timestamp.seconds, views[-1].timestamp.nanos = divmod(at_ns, 1_000_000_000)
    path = osi_log.write(tmp_path / "v.mcap", osi_log.truths(views, "sensor", "SensorView"))
    trace = read(path)
    assert egos(trace) == ["1"]
    assert len(states(trace)) == 15
    assert "ego_absent" not in quality(trace)


def test_host_unset(tmp_path: Path) -> None:
    frames = osi_log.drive(3)
    for truth in frames:
        truth.ClearField("host_vehicle_id")
    path = write(tmp_path, frames)
    refusal = r"no ego: the log does not name the ego: use --ego ID or --ego all \(ids: 0, 1, 2\)"
    with pytest.raises(TraceError, match=refusal):
        read(path)
    assert actors(read(path, ego="0"))["0"]["is_ego"]


def test_host_of_value_zero_is_actor_zero(tmp_path: Path) -> None:
    frames = osi_log.drive(3)
    for truth in frames:
        truth.ClearField("host_vehicle_id")
        truth.host_vehicle_id.SetInParent()
    assert actors(read(write(tmp_path, frames)))["0"]["is_ego"]


@pytest.mark.parametrize("odd", [0, 2])
def test_the_host_is_that_of_most_frames(odd: int, tmp_path: Path) -> None:
    frames = osi_log.drive(5)
    frames[odd].host_vehicle_id.value = 2
    trace = read(write(tmp_path, frames))
    assert egos(trace) == ["0"]
    found = quality(trace)["ego_count"]
    assert "2 host vehicles (0, 2): 0 is used as the ego; 1 of 5 frames do not name it" in found["message"]
    assert (found["severity"], found["actor_id"], found["t_first_ns"]) == ("warning", "0", odd * 100_000_000)


def test_of_hosts_named_equally_often_the_first_is_the_ego(tmp_path: Path) -> None:
    frames = osi_log.drive(4)
    for truth in frames[:2]:
        truth.host_vehicle_id.value = 2
    assert egos(read(write(tmp_path, frames))) == ["2"]


VECTORS = ("position", "orientation", "velocity", "dimension")


def without(frames: list[Any], vector: str, *, empty: bool) -> list[Any]:
    """Take a vector of actor 1 out of every frame, or all that is in it."""
    for truth in frames:
        base = truth.moving_object[1].base
        base.ClearField(vector)
        if empty:
            getattr(base, vector).SetInParent()
    return frames


@pytest.mark.parametrize("empty", [True, False])
@pytest.mark.parametrize("vector", VECTORS)
def test_a_vector_that_says_nothing_is_unknown(vector: str, empty: bool, tmp_path: Path) -> None:
    """The log writes zeros (the ego is at y = 0), so that what it leaves out is no zero."""
    trace = read(write(tmp_path, without(osi_log.drive(4), vector, empty=empty)))
    row = at(trace, "1", 0.1) | actors(trace)["1"]
    columns = {"position": "x_m y_m z_m", "orientation": "yaw_rad", "dimension": "length_m width_m height_m"}
    for of, names in columns.items():
        assert {row[name] is None for name in names.split()} == {of == vector}, of
    finding = {
        "position": "no_position",
        "orientation": "no_yaw",
        "dimension": "no_size",
        "velocity": "velocity_derived",
    }
    assert set(quality(trace)) & {*finding.values(), "not_finite"} == {finding[vector]}


def test_a_coordinate_that_is_left_out_where_zeros_are_written_is_unknown(tmp_path: Path) -> None:
    frames = osi_log.drive(4)
    for truth in frames:
        truth.moving_object[1].base.position.ClearField("x")
    row = at(read(write(tmp_path, frames)), "1", 0.1)
    assert (row["x_m"], row["y_m"]) == (None, 4.0)


def drop_zeros(frames: list[Any]) -> list[Any]:
    """Leave out every coordinate that is 0, as proto3 writers do (esmini's logs are such)."""
    for truth in frames:
        for item in truth.moving_object:
            for vector in (*VECTORS, "acceleration"):
                if item.base.HasField(vector):
                    inner = getattr(item.base, vector)
                    for field, value in list(inner.ListFields()):
                        if value == 0.0:
                            inner.ClearField(field.name)
    return frames


def test_dropped_zeros_are_zero_where_no_zero_is_written(tmp_path: Path) -> None:
    frames = osi_log.drive(4)
    whole = read(osi_log.write(tmp_path / "w.mcap", osi_log.truths(frames)))
    dropped = read(osi_log.write(tmp_path / "z.mcap", osi_log.truths(drop_zeros(frames))))
    assert without_id(dropped) == without_id(whole)
    assert {row["yaw_rad"] for row in states(dropped)} == {0.0}


def test_even_where_zeros_are_dropped_an_empty_position_is_no_place(tmp_path: Path) -> None:
    frames = drop_zeros(osi_log.drive(4))
    for vector in ("position", "dimension"):
        without(frames, vector, empty=True)
    trace = read(write(tmp_path, frames))
    assert (at(trace, "1", 0.1)["x_m"], actors(trace)["1"]["length_m"]) == (None, None)
    assert {"no_position", "no_size"} <= set(quality(trace))


def test_objects_without_id_are_counted(tmp_path: Path) -> None:
    frames = osi_log.drive(4)
    frames[1].moving_object[2].ClearField("id")
    trace = read(write(tmp_path, frames))
    assert len(states(trace)) == 11
    assert quality(trace)["dropped_row"]["n"] == 1


def test_messages_without_times_use_the_logs(tmp_path: Path) -> None:
    frames = osi_log.drive(4)
    for truth in frames:
        truth.ClearField("timestamp")
    messages = [osi_log.Out(m.name, m.topic, EPOCH + m.log_time, m.data) for m in osi_log.truths(frames)]
    trace = read(osi_log.write(tmp_path / "d.mcap", messages))
    assert log(trace)["t_start_ns"] == log(trace)["utc_start_ns"] == EPOCH
    assert quality(trace)["log_time_used"]["n"] == 4


def test_log_times_tell_the_date_of_a_clock_from_zero(tmp_path: Path) -> None:
    messages = [osi_log.Out(m.name, m.topic, EPOCH + m.log_time, m.data) for m in osi_log.truths(osi_log.drive(4))]
    trace = read(osi_log.write(tmp_path / "d.mcap", messages))
    assert (log(trace)["t_start_ns"], log(trace)["utc_start_ns"]) == (0, EPOCH)


def test_a_clock_that_goes_backwards(tmp_path: Path) -> None:
    frames = osi_log.drive(10)
    frames[4], frames[7] = frames[7], frames[4]
    trace = read(write(tmp_path, frames))
    straight = read(osi_log.write(tmp_path / "s.mcap", osi_log.truths(osi_log.drive(10))))
    assert (quality(trace)["clock_jump"]["n"], quality(trace)["clock_jump"]["severity"]) == (2, "warning")
    assert without_id(trace) == without_id(straight)


@pytest.mark.parametrize("ghost_first", [True, False])
def test_repeated_ids_in_a_frame(ghost_first: bool, tmp_path: Path) -> None:
    frames = osi_log.drive(4)
    ghost = osi_log.moving(frames[2], 1, 77.0)
    if ghost_first:
        kept = [type(item).FromString(item.SerializeToString()) for item in (ghost, *frames[2].moving_object[:3])]
        del frames[2].moving_object[:]
        frames[2].moving_object.extend(kept)
    trace = read(write(tmp_path, frames))
    found = quality(trace)["duplicate_state"]
    assert (found["actor_id"], found["n"], found["severity"]) == ("1", 1, "error")
    assert (at(trace, "1", 0.2)["x_m"], at(trace, "1", 0.1)["x_m"]) == (None, 1.0)


def test_a_clock_that_starts_again(tmp_path: Path) -> None:
    """Stamps of 0 to 1.9 s, then of 1 to 2.9 s again, of another drive: the second that is told twice is nobody's."""
    frames, again = osi_log.drive(20), osi_log.drive(20)
    for truth in again:
        truth.timestamp.seconds += 1
    trace = read(write(tmp_path, frames + again))
    assert quality(trace)["clock_restart"]["severity"] == "error"
    assert {row["t_ns"] for row in states(trace) if row["x_m"] is None} == {k * 100_000_000 for k in range(10, 20)}


def test_headings_in_degrees_are_refused(tmp_path: Path) -> None:
    frames = osi_log.drive(30)
    for i, truth in enumerate(frames):
        for item in truth.moving_object:
            base = item.base
            base.position.x, base.position.y = 5.0 * i, 8.66 * i + 5.0 * item.id.value
            base.velocity.x, base.velocity.y, base.orientation.yaw = 50.0, 86.6, 60.0
    with pytest.raises(TraceError, match=r"heading is off the direction of motion .*: record or convert it again"):
        read(write(tmp_path, frames))


def test_traffic_lights(tmp_path: Path) -> None:
    """Bulbs of one OpenDRIVE signal make its state; a bulb by itself is its own signal."""
    shown = [
        (3, 2, 2, "red"), (3, 3, 2, "red_amber"), (2, 2, 3, "green"), (2, 3, 2, "amber"), (2, 2, 2, "off"), (2, 4, 2, "flashing"),
        (3, 2, 0, None), (3, 2, 3, None),
    ]  # fmt: skip
    frames = osi_log.drive(len(shown))
    for truth, (red, amber, green, _) in zip(frames, shown, strict=True):
        for number, color, mode in ((51, 2, red), (52, 3, amber), (53, 4, green)):
            bulb(truth, number, color, mode, signal="sig 7")
        bulb(truth, 60, 4, 3)
    trace = read(write(tmp_path, frames))
    rows = trace.tables["signal_state"].to_pylist()
    assert [row["state"] for row in rows if row["signal_id"] == "sig 7"] == [state for *_, state in shown]
    assert {row["state"] for row in rows if row["signal_id"] == "60"} == {"green"}
    assert [row["t_ns"] for row in rows if row["signal_id"] == "60"] == [i * 100_000_000 for i in range(len(shown))]


def test_embedded_map(tmp_path: Path) -> None:
    chart = osi_log.message("MapAsamOpenDrive")
    chart.open_drive_xml_content = "<OpenDRIVE>é</OpenDRIVE>"
    messages = [osi_log.Out("osi3.MapAsamOpenDrive", "/ground_truth_map", 0, chart.SerializeToString())]
    messages += osi_log.truths(osi_log.drive(3), "/ground_truth")
    trace = read(osi_log.write(tmp_path / "d.mcap", messages))
    assert trace.embedded_map == "<OpenDRIVE>é</OpenDRIVE>".encode()
    chart.open_drive_xml_content = "<OpenDRIVE/>"
    messages.append(osi_log.Out("osi3.MapAsamOpenDrive", "other", 0, chart.SerializeToString()))
    several = read(osi_log.write(tmp_path / "e.mcap", messages))
    assert several.embedded_map is None
    message = "the log has 2 different OpenDRIVE maps (topics /ground_truth_map, other), and none is used: keep only one in the log"
    assert said(several, "own_map_unusable") == [message]


@pytest.mark.parametrize(("content", "why"), [(b"", "is empty"), (b"\xff\xff", "cannot be decoded")])
def test_a_map_message_without_a_map_is_told(tmp_path: Path, content: bytes, why: str) -> None:
    chart = osi_log.Out("osi3.MapAsamOpenDrive", "/m", 0, content)
    trace = read(osi_log.write(tmp_path / "d.mcap", [chart, *osi_log.truths(osi_log.drive(3), "/ground_truth")]))
    assert trace.embedded_map is None
    (message,) = said(trace, "own_map_unusable")
    assert why in message


def test_topics(tmp_path: Path) -> None:
    one = osi_log.truths(osi_log.drive(3), "/one")
    two = osi_log.truths(osi_log.drive(4), "/two")
    path = osi_log.write(tmp_path / "d.mcap", [*one, *two])
    with pytest.raises(TraceError, match=r"ground truth on 2 topics \(/one, /two\): choose one with --topic"):
        read(path)
    assert log(read(path, topic="/two"))["n_states"] == 12
    assert log(read(path, topic="/one"))["n_states"] == 9
    with pytest.raises(TraceError, match=r"no OSI ground truth on topic '/three': ground truth is on /one, /two"):
        read(path, topic="/three")


def test_nothing_to_read(tmp_path: Path) -> None:
    path = osi_log.write(tmp_path / "d.mcap", [osi_log.Out("nav.Odometry", "/odom", 0, b"x")], encoding="cdr")
    with pytest.raises(
        TraceError, match=r"no OSI ground truth in this file: it has nav.Odometry in cdr; osi3.GroundTruth"
    ):
        read(path)
    path = osi_log.write(tmp_path / "j.mcap", osi_log.truths(osi_log.drive(2)), encoding="json")
    with pytest.raises(TraceError, match=r"it has osi3.GroundTruth in json"):
        read(path)
    with pytest.raises(TraceError, match="no actor states in this log"):
        read(write(tmp_path, [osi_log.frame(0)]))
    with pytest.raises(TraceError, match="no channel"):
        read(osi_log.write(tmp_path / "n.mcap", []))


def repeated(message: str, field: str) -> bytes:
    """Return a schema in which a field is a list."""
    changed = descriptor_pb2.FileDescriptorSet.FromString(osi_log.DESCRIPTOR_SET)
    kinds = {kind.name: kind for file in changed.file for kind in file.message_type}
    (member,) = (each for each in kinds[message].field if each.name == field)
    member.label = descriptor_pb2.FieldDescriptorProto.LABEL_REPEATED
    return changed.SerializeToString()


BARE = descriptor_pb2.FileDescriptorProto(name="x", package="osi3")
BARE.message_type.add(name="GroundTruth")


@pytest.mark.parametrize(
    ("descriptor_set", "message"),
    [
        (b"\xff\xff\xff", "is not a protobuf description"),
        (b"", "has no definition of the message type osi3.GroundTruth"),
        (
            descriptor_pb2.FileDescriptorSet(file=[BARE]).SerializeToString(),
            r"no moving_object with id and base\.position",
        ),
        (repeated("Timestamp", "seconds"), r"has timestamp\.seconds as a list: not OSI 3"),
        (repeated("Vector3d", "x"), r"has moving_object\.base\.\w+\.x as a list: not OSI 3"),
    ],
)
def test_schemas_that_cannot_be_used(tmp_path: Path, descriptor_set: bytes, message: str) -> None:
    with pytest.raises(TraceError, match=message) as error:
        read(write(tmp_path, osi_log.drive(2), descriptor_set=descriptor_set))
    assert "\n" not in str(error.value)


def test_batches_do_not_show(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path, osi_log.drive(30))
    whole = read(path)
    monkeypatch.setattr("drivelint.formats.mcap.reader.BATCH_BYTES", 700)
    assert read(path).tables == whole.tables
