"""OSI trace files: the same drive as in MCAP, damage named by its byte, real files of a simulator."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.errors import TraceError
from tests.formats.logs import actors, at, log, quality, read, states
from tests.formats.osi.osi_file import drive, message, view, write
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path


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
    monkeypatch.setattr("drivelint.formats.osi.trace_file.BATCH_BYTES", 700)
    assert states(read(tmp_path / "drive.osi")) == whole


def test_what_is_no_osi_trace_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.osi"
    path.write_bytes(b"<html>not found</html>")
    with pytest.raises(TraceError, match="not an OSI trace"):
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
