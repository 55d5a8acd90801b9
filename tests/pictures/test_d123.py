"""Frames of the cameras of a 123D log: the nearest in time, whatever clock the log has, and said where they cannot be had."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

import drivelint
from drivelint.cli.receipts import OutputPathTest
from drivelint.pictures.d123_log import camera_names
from drivelint.receipts.recorder import record_inputs
from drivelint.result.load import load_result
from tests.formats.d123.files import Box, Ego, Frame, arrow, turn, write_log
from tests.pictures.camera_bag import bars, jpeg, number_in

pytestmark = pytest.mark.ci

FRONT, LEFT = "camera.pcam_f0", "camera.pcam_l0"
FIRST_US, EVERY_US = 33_000, 100_000
N_FRAMES = 80
UTC_US = 1_700_000_000_000_000


def camera(folder: Path, name: str, t_us: Any, data: pa.Array, batch: int = 10) -> None:
    """Write the file of a camera as py123d 0.7.0 does: batches of a few frames, each with its time, data and pose."""
    poses = pa.array([[0.0, 0.0, 1.5, *turn(0.0)]] * len(t_us), pa.list_(pa.float64(), 7))
    columns = {"timestamp_us": pa.array(t_us, pa.int64()), "data": data, "camera_to_global_se3": poses}
    table = pa.table({f"{name}.{key}": column for key, column in columns.items()})
    table = table.replace_schema_metadata({b"metadata": b"\x80"})
    with pa.OSFile(str(folder / f"{name}.arrow"), "wb") as sink, pa.ipc.new_file(sink, table.schema) as writer:
        writer.write_table(table, max_chunksize=batch)


def drive(folder: Path, zero_us: int, dataset: str) -> Path:
    """Write a log of 8 s in which the ego drives into a parked car, 40 m ahead of it."""
    times = zero_us + np.arange(0, 8_000_000, EVERY_US)
    boxes = (Box("parked", 40.0, 0.0),)
    frames = [Frame(int(t), boxes) for t in times]
    ego = [Ego(int(t), 10.0 * (t - zero_us) / 1e6, 0.0) for t in times]
    return write_log(folder, frames, ego, dataset=dataset)


def check_result(log: Path, out: Path) -> Any:
    drivelint.check(log, rules="ukhc.no-collision", robustness=False, annotate=False, out=out)
    return load_result(out)


@pytest.mark.parametrize(("zero_us", "dataset"), [(0, "test-set"), (UTC_US, "test-set"), (UTC_US, "nuscenes")])
def test_the_frame_is_the_nearest_in_time_on_any_clock(tmp_path: Path, zero_us: int, dataset: str) -> None:
    """Large times of an unknown clock count from the log's first time; those of nuScenes are UTC."""
    log = drive(tmp_path / "log", zero_us, dataset)
    taken = zero_us + FIRST_US + EVERY_US * np.arange(N_FRAMES)
    camera(log, FRONT, taken, pa.array([jpeg(bars(n)) for n in range(N_FRAMES)], pa.binary()))
    camera(log, LEFT, taken + 20_000, pa.array([jpeg(bars(n), "PNG") for n in range(N_FRAMES)], pa.binary()))
    result = check_result(log, tmp_path / "out")
    rows = result.pictures.to_pylist()
    assert {(row["camera"], row["shot"]) for row in rows} == {
        (name, shot) for name in (FRONT, LEFT) for shot in ("before", "at", "after")
    }
    assert {row["camera"] for row in rows if row["camera_no"] == 0} == {FRONT}
    (start,) = result.drives["t_start_ns"].to_pylist()
    for row in rows:
        off_s = {"before": -1.0, "at": 0.0, "after": 1.0}[row["shot"]]
        taken_s = (taken - zero_us + (20_000 if row["camera"] == LEFT else 0)) / 1e6
        nearest = int(abs(taken_s - ((row["t_ns"] - start) / 1e9 + off_s)).argmin())
        assert number_in(row["jpeg"]) == nearest
        assert (row["t_frame_ns"] - start) / 1e9 == pytest.approx(taken_s[nearest], abs=1e-6)


def test_a_frame_of_a_video_is_found_by_its_number(tmp_path: Path) -> None:
    av: Any = pytest.importorskip("av", reason="PyAV is not installed (pip install av)")
    log = drive(tmp_path / "log", 0, "test-set")
    with av.open(str(log / f"{FRONT}.mp4"), "w") as container:
        stream = container.add_stream("mpeg4", rate=10)
        stream.width, stream.height = 640, 360
        for n in range(N_FRAMES):
            container.mux(stream.encode(av.VideoFrame.from_ndarray(bars(n), format="rgb24")))
        container.mux(stream.encode())
    taken = FIRST_US + EVERY_US * np.arange(N_FRAMES)
    camera(log, FRONT, taken, pa.array(range(N_FRAMES), pa.int32()), batch=1000)
    for row in check_result(log, tmp_path / "out").pictures.to_pylist():
        assert number_in(row["jpeg"]) == round((row["t_frame_ns"] / 1e3 - FIRST_US) / EVERY_US)


def test_frames_that_are_paths_are_said_to_be_missing(tmp_path: Path) -> None:
    log = drive(tmp_path / "log", 0, "test-set")
    taken = FIRST_US + EVERY_US * np.arange(N_FRAMES)
    camera(log, FRONT, taken, pa.array([f"frames/{n}.jpg" for n in range(N_FRAMES)], pa.string()))
    result = check_result(log, tmp_path / "out")
    assert not result.pictures.num_rows
    (note,) = (note for note in result.notes if FRONT in note)
    assert "convert it with the frames as JPEG" in note


def test_a_changed_camera_file_is_a_changed_input(tmp_path: Path) -> None:
    """A receipt of the run names the files that Python opened."""
    log = drive(tmp_path / "log", 0, "test-set")
    taken = FIRST_US + EVERY_US * np.arange(N_FRAMES)
    camera(log, FRONT, taken, pa.array([jpeg(bars(n)) for n in range(N_FRAMES)], pa.binary()))
    out = tmp_path / "out"
    with record_inputs(OutputPathTest(out), [log]) as recorder:
        check_result(log, out)
    inputs = recorder.end_recording_and_return_inputs()
    assert inputs is not None, recorder.trouble
    assert str(log / f"{FRONT}.arrow") in inputs.states


@pytest.mark.parametrize("content", [b"", b"ARROW1", b"no arrow file at all"])
def test_a_damaged_camera_file_costs_pictures_and_no_verdict(tmp_path: Path, content: bytes) -> None:
    log = drive(tmp_path / "log", 0, "test-set")
    before = check_result(log, tmp_path / "without")
    (log / f"{FRONT}.arrow").write_bytes(content)
    result = check_result(log, tmp_path / "out")
    assert not result.pictures.num_rows
    assert any("no picture" in note for note in result.notes)
    assert result.findings["rule_id"].equals(before.findings["rule_id"])


def test_cameras_that_look_ahead_come_first_and_label_images_are_no_pictures(tmp_path: Path) -> None:
    names = ("camera.pcam_b0", "camera.pcam_l1", "camera.pcam_stereo_l", "camera.ftcam_f0", "camera_semantic.pcam_f0")
    for name in names:
        arrow(tmp_path / f"{name}.arrow", {}, {})
    assert camera_names(tmp_path) == ("camera.ftcam_f0", "camera.pcam_stereo_l", "camera.pcam_l1", "camera.pcam_b0")
