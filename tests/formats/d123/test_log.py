"""Logs of 123D: frames, the ego's box, the others, their classes, what is lost."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest

from drivelint.drive.trace import ACTOR_CLASSES, EgoSize
from drivelint.errors import TraceError
from drivelint.formats.d123 import facts
from drivelint.formats.files import expand_traces
from tests.formats.d123.files import (
    EGO_METADATA,
    LABELS,
    Box,
    Ego,
    Frame,
    arrow,
    box_columns,
    ego_columns,
    ego_states,
    times,
    write_log,
)
from tests.formats.logs import actors, classes, egos, log, quality, read, size, states

REGISTRY = "py123d.parser.registry."


def boxes_of(k: int) -> list[Box]:
    """Return somebody who drives 20 m ahead of the ego, and somebody who is parked."""
    return [Box("a", 20.0 + k, 3.0, (10.0, 0.0, 0.0)), Box("p", 50.0, -4.0)]


def plain(folder: Path, n: int = 12, **options: object) -> Path:
    frames = [Frame(t, boxes_of(k)) for k, t in enumerate(times(n))]
    return write_log(folder, frames, ego_states(n), **options)  # type: ignore[arg-type]


def test_a_log_is_read(tmp_path: Path) -> None:
    trace = read(plain(tmp_path / "log"))
    about = log(trace)
    assert (about["format"], about["t_start_ns"], about["utc_start_ns"]) == ("123d", 1_000_000_000, None)
    assert about["sensor_range_m"] is None
    assert (set(actors(trace)), egos(trace)) == ({"ego", "a", "p"}, ["ego"])
    assert len(states(trace)) == 36
    first = states(trace, "a")[0]
    assert (first["t_ns"], first["x_m"], first["y_m"], first["vx_mps"]) == (1_000_000_000, 20.0, 3.0, 10.0)
    assert (classes(trace)["a"], size(trace, "a")) == ("car", (4.5, 1.8, 1.5))
    assert any("data set test-set, PIT; written by py123d 0.7.0" in note for note in trace.notes)


def test_the_ego_is_the_box_around_its_imu(tmp_path: Path) -> None:
    """The IMU looks north; the middle of the box is 1.4 m before it and 0.5 m above, and swings with the turn."""
    ego = [Ego(t, 3.0, 5.0 + k, math.pi / 2, [10, 0, 0, 0, 0, 0, 0, 0, 0.5], 2.0) for k, t in enumerate(times(4))]
    trace = read(write_log(tmp_path / "log", [Frame(t, [Box("p", 9, 9)]) for t in times(4)], ego))
    here = states(trace, "ego")[1]
    place = [here[name] for name in ("x_m", "y_m", "z_m", "yaw_rad")]
    assert place == pytest.approx([3.0, 7.4, 2.5, math.pi / 2], abs=1e-9)
    # 10 m/s ahead, and 0.5 rad/s about a point 1.4 m behind: 0.7 m/s to the left, which is west
    assert [here["vx_mps"], here["vy_mps"]] == pytest.approx([-0.7, 10.0], abs=1e-9)
    assert here["ax_mps2"] is None
    assert actors(trace)["ego"]["length_m"] == 5.0
    assert quality(trace)["assumed_size"]["actor_id"] == "ego"


def test_a_tilted_box_faces_where_its_front_points(tmp_path: Path) -> None:
    """Turned by 1 rad, then pitched by 0.3 rad: its front points 1 rad from east on the ground."""
    yaw, pitch = 1.0, 0.3
    cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    tilted = [0.0, 0.0, 0.0, cy * cp, -sy * sp, cy * sp, sy * cp, 4.0, 2.0, 1.0]
    folder = plain(tmp_path / "log", 3)
    columns = box_columns([(t, [Box("a", 0, 0)]) for t in times(3)])
    kind = columns["box_detections_se3.bounding_box_se3"].type
    columns["box_detections_se3.bounding_box_se3"] = pa.array([[tilted]] * 3, kind)
    arrow(folder / "box_detections_se3.arrow", columns, {"box_detection_label_class": LABELS})
    assert states(read(folder), "a")[0]["yaw_rad"] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("enumeration", sorted(facts.LABELS_BY_ENUMERATION))
def test_every_label_is_a_class(tmp_path: Path, enumeration: str) -> None:
    labels = facts.LABELS_BY_ENUMERATION[enumeration]
    assert sorted(number for number, _ in labels.values()) == list(range(len(labels)))
    boxes = [Box(name, 9.0 * number, 40.0, label=number) for name, (number, _) in labels.items()]
    frames = [Frame(t, boxes) for t in times(3)]
    trace = read(write_log(tmp_path / "log", frames, ego_states(3), labels=REGISTRY + enumeration))
    found = actors(trace)
    for name, (_, word) in labels.items():
        if name == "EGO":
            assert name not in found
            continue
        assert found[name]["actor_class"] == (word or None)
        assert word in {"", *ACTOR_CLASSES}
    assert "unknown_label" not in quality(trace)


@pytest.mark.parametrize(
    ("enumeration", "number", "word"),
    [
        ("AV2SensorBoxDetectionLabel", 18, "car"), ("NuScenesBoxDetectionLabel", 11, "pedestrian"),
        ("NuPlanBoxDetectionLabel", 1, "vehicle"), ("WODMotionBoxDetectionLabel", 3, "bicycle"),
        ("WODPerceptionBoxDetectionLabel", 3, "object"), ("KITTI360BoxDetectionLabel", 2, "bus"),
        ("PandasetBoxDetectionLabel", 17, "car"), ("DefaultBoxDetectionLabel", 3, "vehicle"),
        ("WODMotionBoxDetectionLabel", 4, None), ("PhysicalAIAVBoxDetectionLabel", 4, None),
    ],
)  # fmt: skip
def test_labels_of_data_sets(tmp_path: Path, enumeration: str, number: int, word: str | None) -> None:
    frames = [Frame(t, [Box("a", 9, 9, label=number)]) for t in times(3)]
    trace = read(write_log(tmp_path / "log", frames, ego_states(3), labels=REGISTRY + enumeration))
    assert actors(trace)["a"]["actor_class"] == word


@pytest.mark.parametrize(
    ("labels", "number", "phrase"),
    [
        (LABELS, 30, "labels that AV2SensorBoxDetectionLabel does not define (30) at 3 boxes"),
        ("my.own.Labels", 1, "their labels are numbers of my.own.Labels"),
        ("my.own.AV2SensorBoxDetectionLabel", 1, "their labels are numbers of my.own.AV2SensorBoxDetectionLabel"),
        ("", 1, "their labels are numbers of an enumeration without a name"),
    ],
)
def test_a_label_that_is_not_known_is_no_class(tmp_path: Path, labels: str, number: int, phrase: str) -> None:
    frames = [Frame(t, [Box("a", 9, 9, label=number)]) for t in times(3)]
    trace = read(write_log(tmp_path / "log", frames, ego_states(3), labels=labels))
    assert actors(trace)["a"]["actor_class"] is None
    found = quality(trace)["unknown_label"]
    assert (found["severity"], found["n"]) == ("warning", 3)
    assert phrase in found["message"]


def test_an_ego_whose_id_a_box_has(tmp_path: Path) -> None:
    frames = [Frame(t, [Box("ego", 30, 9)]) for t in times(3)]
    trace = read(write_log(tmp_path / "log", frames, ego_states(3)))
    assert (set(actors(trace)), egos(trace)) == ({"ego", "ego_vehicle"}, ["ego_vehicle"])


def test_frames_without_anybody_are_steps_and_those_without_boxes_are_none(tmp_path: Path) -> None:
    frames = [Frame(t, boxes_of(k)) for k, t in enumerate(times(6))]
    frames[2] = frames[2]._replace(boxes=())
    frames[5] = frames[5]._replace(boxes=None)
    trace = read(write_log(tmp_path / "log", frames, ego_states(6)))
    assert [row["t_ns"] // 1_000_000 for row in states(trace, "ego")] == [1000, 1100, 1200, 1300, 1400]
    assert [row["t_ns"] // 1_000_000 for row in states(trace, "p")] == [1000, 1100, 1300, 1400]
    assert any("1 of 6 frames have no boxes" in note for note in trace.notes)


def test_the_ego_is_where_it_was_when_the_boxes_were(tmp_path: Path) -> None:
    """Its poses are dense. A frame names the first pose after its time, while one of the same time is rounded to a microsecond before."""
    ego = [Ego(t, t * 1e-5, 0.0) for t in range(999_999, 1_300_000, 5_000)]
    frames = [Frame(t, [Box("p", 9, 9)], ego=k * 20 + 1) for k, t in enumerate(times(3))]
    assert ego[1].t_us == 1_004_999
    trace = read(write_log(tmp_path / "log", frames, ego))
    rows = states(trace, "ego")
    assert [row["t_ns"] for row in rows] == [t * 1000 for t in times(3)]
    assert [row["x_m"] for row in rows] == pytest.approx([1.4 + (t - 1) * 1e-5 for t in times(3)], abs=1e-9)
    assert "aligned" not in quality(trace)


def test_an_ego_of_other_times_keeps_its_own(tmp_path: Path) -> None:
    """The boxes are brought to its steps, as in every log."""
    ego = [Ego(t + 20_000, k * 1.0, 0.0) for k, t in enumerate(times(20))]
    frames = [Frame(t, [Box("a", 30.0 + k, 3.0, None)]) for k, t in enumerate(times(20))]
    trace = read(write_log(tmp_path / "log", frames, ego))
    assert states(trace, "ego")[3]["t_ns"] == 1_320_000_000
    assert next(row["x_m"] for row in states(trace, "a") if row["t_ns"] == 1_320_000_000) == pytest.approx(33.2)


def test_a_log_without_boxes(tmp_path: Path) -> None:
    trace = read(plain(tmp_path / "log", with_boxes=False))
    assert set(actors(trace)) == {"ego"}
    assert len(states(trace)) == 12
    assert "no box_detections_se3.arrow" in quality(trace)["no_road_users"]["message"]


def damage(folder: Path, name: str, values: list[object]) -> None:
    """Write the boxes of a log again, with other values in a column."""
    rows = [(t, boxes_of(k)) for k, t in enumerate(times(len(values)))]
    columns = box_columns(rows)
    column = f"box_detections_se3.{name}"
    columns[column] = pa.array(values, columns[column].type)
    arrow(folder / "box_detections_se3.arrow", columns, {"box_detection_label_class": LABELS})


@pytest.mark.parametrize(
    ("name", "good", "bad"),
    [
        ("label", [18, 18], [18]),
        ("label", [18, 18], None),
        ("track_token", ["a", "p"], ["a"]),
        ("track_token", ["a", "p"], ["a", None]),
        ("track_token", ["a", "p"], ["", "p"]),
        ("velocity_3d", [[10.0, 0, 0], [0.0, 0, 0]], [[10.0, 0, 0]]),
    ],
)
def test_a_frame_whose_lists_do_not_match_is_lost(tmp_path: Path, name: str, good: object, bad: object) -> None:
    folder = plain(tmp_path / "log")
    damage(folder, name, [bad if k == 4 else good for k in range(12)])
    trace = read(folder)
    assert len(states(trace, "ego")) == len(states(trace, "a")) == 11
    assert quality(trace)["malformed_row"]["n"] == 1
    lost = quality(trace)["lost_time"]
    assert lost["t_first_ns"] < 1_400_000_000 < lost["t_last_ns"]


def test_a_frame_that_points_to_no_row_is_lost(tmp_path: Path) -> None:
    folder = plain(tmp_path / "log")
    columns = {
        "sync.timestamp_us": pa.array(times(12)), "ego_state_se3": pa.array([*range(11), 12]),
        "box_detections_se3": pa.array([*range(10), 99, 11]),
    }  # fmt: skip
    header = {"dataset": "test-set", "location": None, "version": "0.7.0"}
    arrow(folder / "sync.arrow", columns, header)
    trace = read(folder)
    assert len(states(trace, "ego")) == 10
    assert quality(trace)["malformed_row"]["n"] == 2


def test_numbers_that_are_none_are_not_known(tmp_path: Path) -> None:
    frames = [Frame(t, [Box("a", math.nan if k == 1 else 9.0 + k, 3.0, (10, 0, 0))]) for k, t in enumerate(times(12))]
    frames[2] = Frame(times(12)[2], [Box("a", 11.0, 3.0, (math.inf, 0, 0), size=(0.0, -1.0, 1.5))])
    trace = read(write_log(tmp_path / "log", frames, ego_states(12)))
    rows = states(trace, "a")
    assert (rows[1]["x_m"], rows[1]["y_m"]) == (None, 3.0)
    assert rows[2]["vx_mps"] is None
    assert quality(trace)["not_finite"]["n"] == 2
    assert actors(trace)["a"]["length_m"] == 4.5


@pytest.mark.parametrize(("ahead", "x_m"), [(None, 0.0), (1.3, 1.3)])
def test_an_ego_whose_middle_is_on_its_axle_has_no_box(tmp_path: Path, ahead: float | None, x_m: float) -> None:
    header = {**EGO_METADATA, "center_to_imu_se3": [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]}
    size = None if ahead is None else EgoSize(4.0, 1.9, ahead)
    trace = read(plain(tmp_path / "log", ego_metadata=header), ego_size=size)
    assert states(trace, "ego")[0]["x_m"] == x_m
    assert actors(trace)["ego"]["length_m"] == (None if ahead is None else 4.0)
    assert "--ego-size LENGTH,WIDTH,AHEAD" in quality(trace)["reference_point"]["message"]


def test_folders_are_searched_for_logs(tmp_path: Path) -> None:
    one, two = (plain(tmp_path / "data" / "logs" / "set_val" / name, 3) for name in ("one", "two"))
    (tmp_path / "data" / "maps" / "set").mkdir(parents=True)
    (tmp_path / "data" / "maps" / "set" / "set_here.arrow").write_bytes(b"ARROW1")
    assert expand_traces([str(tmp_path / "data")]) == [one, two]
    assert expand_traces([str(one)]) == [one]


def test_a_folder_without_the_table_of_frames_is_no_log(tmp_path: Path) -> None:
    folder = plain(tmp_path / "log")
    (folder / "sync.arrow").unlink()
    with pytest.raises(TraceError, match="not a folder of one drive"):
        read(folder)


@pytest.mark.parametrize("version", ["0.1.0", "0.8.0", "1.0.0", "unknown", None])
def test_a_version_that_is_not_known_is_refused(tmp_path: Path, version: str | None) -> None:
    folder = plain(tmp_path / "log", version=version)
    said = rf"py123d {version} wrote the file, but only the versions 0\.2 to 0\.7 are supported"
    with pytest.raises(TraceError, match=said):
        read(folder)


@pytest.mark.parametrize("version", ["0.2.1", "0.6.0", "0.7.9"])
def test_versions_that_are_read(tmp_path: Path, version: str) -> None:
    assert len(states(read(plain(tmp_path / "log", version=version)))) == 36


@pytest.mark.parametrize("name", ["sync", "ego_state_se3", "box_detections_se3"])
def test_a_cut_file_is_refused(tmp_path: Path, name: str) -> None:
    file = plain(tmp_path / "log") / f"{name}.arrow"
    file.write_bytes(file.read_bytes()[:-200])
    with pytest.raises(TraceError, match=rf"{name}\.arrow: not readable in Arrow's file format"):
        read(file.parent)


def of_texts() -> dict[str, pa.Array]:
    return ego_columns(ego_states(12)) | {"ego_state_se3.imu_se3": pa.array(["x"] * 12)}


@pytest.mark.parametrize(
    ("columns", "metadata", "message"),
    [
        ({"ego_state_se3.timestamp_us": pa.array([1])}, EGO_METADATA, r"no column ego_state_se3\.imu_se3"),
        (ego_columns(ego_states(12)), None, "its schema has no 'metadata'"),
        (ego_columns(ego_states(12)), {**EGO_METADATA, "center_to_imu_se3": [1.0, 2.0]}, "no pose 'center_to_imu_se3'"),
        (ego_columns([]), EGO_METADATA, "no state of the ego"),
        (of_texts(), EGO_METADATA, "is string, not fixed_size_list"),
    ],
)
def test_what_is_no_log_of_123d_is_refused(tmp_path: Path, columns: Any, metadata: Any, message: str) -> None:
    folder = plain(tmp_path / "log")
    arrow(folder / "ego_state_se3.arrow", columns, metadata)
    with pytest.raises(TraceError, match=message):
        read(folder)


def test_a_log_without_a_frame_that_can_be_used(tmp_path: Path) -> None:
    folder = write_log(tmp_path / "log", [Frame(t, None) for t in times(3)], ego_states(3))
    with pytest.raises(TraceError, match="no frame has the ego and boxes"):
        read(folder)


@pytest.mark.parametrize(("dataset", "utc"), [("nuscenes", True), ("kitti360", False), ("test-set", False)])
def test_times_are_utc_only_where_that_is_documented(tmp_path: Path, dataset: str, utc: bool) -> None:
    start = 1_531_883_530_449_377
    moments = times(3, start_us=start)
    frames = [Frame(t, [Box("p", 9, 9)]) for t in moments]
    ego = [Ego(t, 0.0, 0.0) for t in moments]
    trace = read(write_log(tmp_path / "log", frames, ego, dataset=dataset))
    about = log(trace)
    assert about["t_start_ns"] == (start * 1000 if utc else 0)
    assert about["utc_start_ns"] == (start * 1000 if utc else None)
    assert any(f"times count from {start} us" in note for note in trace.notes) != utc


def test_a_broken_clock_is_refused(tmp_path: Path) -> None:
    frames = [Frame(t, [Box("p", 9, 9)]) for t in times(3, start_us=1 << 60)]
    with pytest.raises(TraceError, match="the clock or its unit is wrong"):
        read(write_log(tmp_path / "log", frames, ego_states(3)))


@pytest.mark.parametrize(("dataset", "range_m"), [("av2-sensor", 150.0), ("nuscenes", 40.0), ("nuplan", None)])
def test_how_far_others_are_recorded(tmp_path: Path, dataset: str, range_m: float | None) -> None:
    assert log(read(plain(tmp_path / "log", dataset=dataset)))["sensor_range_m"] == range_m


def test_reading_twice_gives_the_same(tmp_path: Path) -> None:
    folder = plain(tmp_path / "log")
    first, second = read(folder), read(folder)
    assert all(first.tables[name].equals(second.tables[name]) for name in first.tables)
