"""OSI trace files: the same drive as in MCAP, damage named by its byte, real files of a simulator."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

from drivelint.errors import TraceError
from drivelint.formats.osi.schema import descriptor_set
from tests.formats.logs import actors, at, log, quality, read, states
from tests.shared_data import shared

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


@pytest.mark.parametrize("wrap", [lambda frame: frame, view])
def test_ground_truth_and_sensor_view(tmp_path: Path, wrap: Any) -> None:
    trace = read(write(tmp_path / "drive.osi", map(wrap, drive())))
    assert (log(trace)["format"], log(trace)["n_states"]) == ("osi-file", 40)
    assert {k: (v["actor_class"], v["is_ego"]) for k, v in actors(trace).items()} == {
        "0": ("car", True),
        "7": ("pedestrian", False),
    }
    row = at(trace, "0", 0.5)
    assert (row["x_m"], row["vx_mps"], row["indicator"], row["brake_light"]) == (5.0, 10.0, "left", "strong")
    assert log(trace)["utc_start_ns"] is None
    assert trace.frame_times is None
    assert set(quality(trace)) == {"unprotected"}


def test_its_name_does_not_matter(tmp_path: Path) -> None:
    assert log(read(write(tmp_path / "drive.bin", drive())))["format"] == "osi-file"


def test_the_batches_do_not_matter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = states(read(write(tmp_path / "drive.osi", drive())))
    monkeypatch.setattr("drivelint.formats.osi.reader.BATCH_BYTES", 700)
    assert states(read(tmp_path / "drive.osi")) == whole


def test_a_file_that_breaks_off_is_refused_with_the_byte(tmp_path: Path) -> None:
    path = write(tmp_path / "drive.osi", drive(3))
    data = path.read_bytes()
    first = 4 + int.from_bytes(data[:4], "little")
    path.write_bytes(data[: first + 10])
    with pytest.raises(TraceError, match=rf"the message at byte {first} should have \d+ bytes and the file ends"):
        read(path)
    path.write_bytes(data[: first + 2])  # within the length itself
    with pytest.raises(TraceError, match=rf"the message at byte {first} "):
        read(path)


def test_a_length_past_the_end_allocates_nothing(tmp_path: Path) -> None:
    path = write(tmp_path / "drive.osi", drive(3))
    path.write_bytes(path.read_bytes() + b"\xff\xff\xff\xff\x0a")
    with pytest.raises(TraceError, match="should have 4294967295 bytes"):
        read(path)


def test_what_is_no_osi_trace_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.osi"
    path.write_bytes(b"<html>not found</html>")
    with pytest.raises(TraceError, match="not an OSI trace"):
        read(path)


def test_a_garbled_message_is_refused_with_its_byte(tmp_path: Path) -> None:
    path = write(tmp_path / "drive.osi", drive(3))
    data = bytearray(path.read_bytes())
    first = 4 + int.from_bytes(data[:4], "little")
    data[first + 4 : first + 12] = b"\xff" * 8
    path.write_bytes(data)
    with pytest.raises(TraceError, match=r"drive\.osi"):
        read(path)


def test_other_messages_are_refused(tmp_path: Path) -> None:
    empty = message("GroundTruth")
    empty.timestamp.seconds = 1
    with pytest.raises(TraceError, match="no moving objects"):
        read(write(tmp_path / "drive.osi", [empty] * 3))


def test_without_time_stamps_there_is_no_order(tmp_path: Path) -> None:
    frames = drive(3)
    frames[1].ClearField("timestamp")
    with pytest.raises(TraceError, match="1 of 3 messages have no time stamp"):
        read(write(tmp_path / "drive.osi", frames))


@pytest.mark.parametrize(
    ("name", "n_actors", "frames"),
    [("acc-test", 2, 1010), ("alks_cut-in", 2, 305), ("highway_merge", 6, 433), ("pedestrian", 2, 434)],
)
def test_real_files(name: str, n_actors: int, frames: int) -> None:
    trace = read(shared(f"osi/{name}.osi"), ego="0")
    assert (len(actors(trace)), log(trace)["n_states"]) == (n_actors, n_actors * frames)
    assert not {"velocity_mismatch", "yaw_mismatch", "teleport", "no_size", "gap"} & set(quality(trace))
