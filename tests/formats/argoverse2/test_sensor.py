"""Sensor logs: boxes brought from the vehicle's frame into the city's, the vehicle's own box, and logs that are broken."""

from __future__ import annotations

import math
import random
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pytest
from pyarrow import feather

from drivelint.errors import TraceError
from drivelint.formats import expand_traces
from tests.formats.argoverse2.argoverse_log import (
    MAP_NAME,
    STEP_NS,
    box,
    drive,
    pose,
    road,
    sensor_log,
    stamp,
    straight,
    turn,
)
from tests.formats.logs import actors, log, quality, read, states

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

N = 12


def place(row: dict[str, Any]) -> tuple[float, ...]:
    return tuple(row[name] for name in ("x_m", "y_m", "z_m", "yaw_rad"))


def at_step(trace: Any, actor: str, k: int) -> dict[str, Any]:
    return next(row for row in states(trace, actor) if row["t_ns"] == stamp(k))


def test_a_box_is_turned_and_moved_by_the_pose_at_its_time(tmp_path: Path) -> None:
    poses = [pose(k, 100.0, 50.0 + k, 7.0, **turn(math.pi / 2)) for k in range(N)]
    trace = read(sensor_log(tmp_path / "log", [box(k, x=10.0, y=2.0, z=0.5, yaw=0.3) for k in range(N)], poses))
    assert place(at_step(trace, "a", 3)) == pytest.approx((98.0, 63.0, 7.5, math.pi / 2 + 0.3))
    assert actors(trace)["a"]["length_m"] == 4.5
    assert (log(trace)["format"], log(trace)["utc_start_ns"], log(trace)["sensor_range_m"]) == (
        "argoverse2-sensor", None, 150.0,
    )  # fmt: skip


def test_pitch_and_roll_count(tmp_path: Path) -> None:
    """By hand: nose down by a tenth, 10 m ahead is 10 cos 0.1 ahead and 10 sin 0.1 below; rolled, 2 m to the left is lower."""
    poses = [pose(k, **turn(0.0, 0.1, 0.0)) for k in range(N)]
    trace = read(sensor_log(tmp_path / "down", [box(k) for k in range(N)], poses))
    assert place(at_step(trace, "a", 0)) == pytest.approx((10 * math.cos(0.1), 0.0, -10 * math.sin(0.1), 0.0))
    poses = [pose(k, **turn(0.0, 0.0, -0.2)) for k in range(N)]
    trace = read(sensor_log(tmp_path / "rolled", [box(k, x=0.0, y=2.0, yaw=1.0) for k in range(N)], poses))
    x, y, z, yaw = place(at_step(trace, "a", 0))
    assert (x, y, z) == pytest.approx((0.0, 2 * math.cos(0.2), -2 * math.sin(0.2)))
    assert yaw == pytest.approx(math.atan2(math.sin(1.0) * math.cos(0.2), math.cos(1.0)))


def test_the_ego_has_the_documented_box_at_the_steps_of_the_annotations(tmp_path: Path) -> None:
    """The pose is the rear axle's: the middle is 1.339 m ahead of it and 0.438 m above."""
    poses = [
        row
        for k in range(N)
        for row in (pose(k, x=0.5 * k, **turn(0.1)), {**pose(k, x=99.0), "timestamp_ns": stamp(k) + 1})
    ]
    trace = read(sensor_log(tmp_path / "log", [box(k) for k in range(N)], poses))
    ego = actors(trace)["ego"]
    assert (ego["actor_class"], ego["length_m"], ego["width_m"], ego["height_m"], ego["is_ego"]) == (
        "car", 4.869, pytest.approx(2.127), 1.476, True,
    )  # fmt: skip
    assert [row["t_ns"] for row in states(trace, "ego")] == [stamp(k) for k in range(N)]
    expected = (1.0 + 1.339 * math.cos(0.1), 1.339 * math.sin(0.1), 0.438, 0.1)
    assert place(at_step(trace, "ego", 2)) == pytest.approx(expected)
    assert quality(trace)["assumed_size"]["actor_id"] == "ego"
    assert "documentation, not recorded" in quality(trace)["assumed_size"]["message"]


def test_the_ego_is_no_second_body(tmp_path: Path) -> None:
    own = [box(k, "e", x=0.0, category="EGO_VEHICLE", length_m=4.877, width_m=2.0) for k in range(N)]
    rows = [*own, *(box(k) for k in range(N))]
    trace = read(sensor_log(tmp_path / "log", rows, name="annotations_with_ego.feather"))
    assert set(actors(trace)) == {"a", "ego"}
    assert actors(trace)["ego"]["length_m"] == 4.869
    assert any("EGO_VEHICLE" in note for note in trace.notes)


CLASSES = {
    "REGULAR_VEHICLE": "car", "LARGE_VEHICLE": "vehicle", "RAILED_VEHICLE": "vehicle", "TRUCK": "truck", "BOX_TRUCK": "truck",
    "TRUCK_CAB": "truck", "BUS": "bus", "SCHOOL_BUS": "bus", "ARTICULATED_BUS": "bus", "MOTORCYCLE": "motorcycle",
    "MOTORCYCLIST": "motorcycle", "BICYCLIST": "bicycle", "WHEELED_RIDER": None, "VEHICULAR_TRAILER": "trailer",
    "MESSAGE_BOARD_TRAILER": "trailer", "TRAFFIC_LIGHT_TRAILER": "trailer", "PEDESTRIAN": "pedestrian",
    "OFFICIAL_SIGNALER": "pedestrian", "DOG": "animal", "ANIMAL": "animal", "BICYCLE": "object", "WHEELED_DEVICE": "object",
    "WHEELCHAIR": "object", "STROLLER": "object", "BOLLARD": "object", "CONSTRUCTION_CONE": "object",
    "CONSTRUCTION_BARREL": "object", "SIGN": "object", "STOP_SIGN": "object", "MOBILE_PEDESTRIAN_CROSSING_SIGN": "object",
}  # fmt: skip


def test_every_category_has_its_class(tmp_path: Path) -> None:
    """The thirty of av2-api's `AnnotationCategories`."""
    rows = [box(k, word, x=20.0 * i, category=word) for i, word in enumerate(CLASSES) for k in range(N)]
    trace = read(sensor_log(tmp_path / "log", rows))
    assert len(CLASSES) == 30
    assert {name: row["actor_class"] for name, row in actors(trace).items() if name != "ego"} == CLASSES
    assert trace.notes == ["its map is missing: map/log_map_archive_*.json"]


def test_a_category_that_argoverse_does_not_have_may_be_anything(tmp_path: Path) -> None:
    trace = read(sensor_log(tmp_path / "log", [box(k, category="HOVERCRAFT") for k in range(N)]))
    assert actors(trace)["a"]["actor_class"] is None
    assert any("HOVERCRAFT" in note for note in trace.notes)


@pytest.mark.parametrize(
    "more",
    [
        [],
        [pose(3, x=1.0), pose(3, x=2.0)],
        [{**pose(3), "qw": 0.0}],
        [pose(3, x=math.nan)],
        [{**pose(3), "tx_m": None}],
    ],
    ids=["no pose", "two that differ", "a quaternion of nothing", "NaN", "an empty cell"],
)
def test_a_time_stamp_without_a_pose_leaves_all_present_but_not_placed(
    tmp_path: Path, more: list[dict[str, Any]]
) -> None:
    poses = [row for row in drive() if row["timestamp_ns"] != stamp(3)] + more
    trace = read(sensor_log(tmp_path / "log", [box(k) for k in range(N)], poses))
    for actor in ("a", "ego"):
        assert len(states(trace, actor)) == N
        unplaced = [row["t_ns"] for row in states(trace, actor) if row["x_m"] is None and row["yaw_rad"] is None]
        assert unplaced == [stamp(3)]
    row = quality(trace)["frame_unresolved"]
    assert (row["severity"], row["n"], row["t_first_ns"]) == ("error", 1, stamp(3))
    assert "1 boxes are present there but not placed" in row["message"]


def test_a_pose_that_stands_twice_alike_is_one(tmp_path: Path) -> None:
    trace = read(sensor_log(tmp_path / "log", [box(k) for k in range(N)], drive() * 2))
    assert "frame_unresolved" not in quality(trace)
    assert at_step(trace, "ego", 4)["x_m"] == pytest.approx(2.0 + 1.339)


def test_a_track_in_two_places_at_once_is_in_none(tmp_path: Path) -> None:
    trace = read(sensor_log(tmp_path / "log", [*(box(k) for k in range(N)), box(5, x=40.0)]))
    assert len(states(trace, "a")) == N
    assert at_step(trace, "a", 5)["x_m"] is None
    assert quality(trace)["duplicate_state"]["severity"] == "error"


@pytest.mark.parametrize("column", ["tx_m", "qz"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_numbers_that_are_none(tmp_path: Path, column: str, value: float) -> None:
    rows = [box(k) for k in range(N)]
    rows[4][column] = value
    trace = read(sensor_log(tmp_path / "log", rows))
    row = at_step(trace, "a", 4)
    assert row["yaw_rad" if column == "qz" else "x_m"] is None
    assert quality(trace)["not_finite"]["n"] == 1


def test_a_size_that_is_not_known(tmp_path: Path) -> None:
    trace = read(sensor_log(tmp_path / "log", [box(k, length_m=None) for k in range(N)]))
    assert actors(trace)["a"]["length_m"] is None
    assert quality(trace)["no_size"]["actor_id"] == "a"


def test_rows_without_a_track_are_lost_and_told(tmp_path: Path) -> None:
    rows = [*(box(k) for k in range(N)), {**box(5), "track_uuid": None}, {**box(6), "track_uuid": ""}]
    trace = read(sensor_log(tmp_path / "log", rows))
    found = trace.tables["quality"].to_pylist()
    dropped = next(row for row in found if row["check_id"] == "dropped_row")
    assert (dropped["n"], dropped["severity"]) == (2, "error")
    spans = [(row["t_first_ns"], row["t_last_ns"]) for row in found if row["check_id"] == "lost_time"]
    assert spans == [(stamp(5) - 1, stamp(6) + 1)]


@pytest.mark.parametrize("file", ["annotations.feather", "city_SE3_egovehicle.feather"])
def test_broken_files_are_named_in_one_line(tmp_path: Path, file: str) -> None:
    folder = sensor_log(tmp_path / "log", [box(k) for k in range(N)])
    content = (folder / file).read_bytes()
    whole = feather.read_table(folder / file)
    timed = whole["timestamp_ns"].combine_chunks()
    damages: dict[str, Callable[[], object]] = {
        "cut": lambda: (folder / file).write_bytes(content[: len(content) // 2]),
        "no column": lambda: feather.write_feather(whole.drop_columns(["qw"]), folder / file),
        "text": lambda: feather.write_feather(
            whole.set_column(0, "timestamp_ns", pa.array(["x"] * len(timed))), folder / file
        ),
        "empty": lambda: (folder / file).write_bytes(b""),
    }
    for damage in damages.values():
        damage()
        with pytest.raises(TraceError) as error:
            read(folder)
        assert str(folder / file) in str(error.value)
        assert "\n" not in str(error.value)


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize("file", ["annotations.feather", "city_SE3_egovehicle.feather"])
def test_a_flipped_byte_is_refused_or_unseen(tmp_path: Path, file: str) -> None:
    """Arrow's own files have no checksums; offsets of texts that lead out of their buffer ended the process."""
    folder = sensor_log(tmp_path / "log", [box(k) for k in range(N)])
    content = (folder / file).read_bytes()
    numbers = random.Random(17)  # noqa: S311 - the same each time
    refused: list[str] = []
    for _ in range(100):
        damaged = bytearray(content)
        damaged[numbers.randrange(len(content))] = numbers.randrange(256)
        (folder / file).write_bytes(bytes(damaged))
        try:
            read(folder)
        except TraceError as error:
            refused.append(str(error))
    assert 10 < len(refused) < 100
    assert not any("\n" in message for message in refused)


def test_a_log_without_annotations(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match=r"annotations\.feather: no annotations: .*use a log with annotations"):
        read(sensor_log(tmp_path / "log", []))


def test_argoverse_s_own_annotations_go_before_others(tmp_path: Path) -> None:
    folder = sensor_log(tmp_path / "log", [box(k, "other") for k in range(N)], name="annotations_a.feather")
    trace = read(sensor_log(folder, [box(k) for k in range(N)]))
    assert set(actors(trace)) == {"a", "ego"}
    assert "annotations.feather is read; annotations_a.feather in the same folder is not read" in trace.notes


def test_the_map_goes_along_with_its_city(tmp_path: Path) -> None:
    folder = sensor_log(tmp_path / "log", [box(k) for k in range(N)], road=road(straight(1)))
    trace = read(folder)
    assert trace.embedded_map == (folder / "map" / MAP_NAME).read_bytes()
    assert trace.geo_reference == "+proj=utm +zone=17 +datum=WGS84 +units=m +no_defs"
    (folder / "map" / "log_map_archive_2.json").write_text("{}")
    trace = read(folder)
    assert trace.embedded_map is None
    assert "2 maps" in quality(trace)["own_map_unusable"]["message"]


def test_another_map_is_another_log(tmp_path: Path) -> None:
    folder = sensor_log(tmp_path / "log", [box(k) for k in range(N)], road=road(straight(1)))
    first = read(folder).drive_id
    sensor_log(folder, [box(k) for k in range(N)], road=road(straight(2)))
    assert read(folder).drive_id != first


def test_a_folder_of_logs_is_searched(tmp_path: Path) -> None:
    for name in ("b", "a"):
        sensor_log(tmp_path / "val" / name, [box(k) for k in range(N)])
    assert [path.name for path in expand_traces([str(tmp_path)])] == ["a", "b"]


def test_a_single_file_of_a_log_names_the_folder(tmp_path: Path) -> None:
    folder = sensor_log(tmp_path / "log", [box(k) for k in range(N)])
    with pytest.raises(TraceError, match=r"annotations\.feather: .*give the folder"):
        read(folder / "annotations.feather")


def test_velocities_are_derived(tmp_path: Path) -> None:
    trace = read(sensor_log(tmp_path / "log", [box(k, x=10.0 + 0.3 * k) for k in range(N)]))
    assert at_step(trace, "ego", 5)["vx_mps"] == pytest.approx(5.0)
    assert at_step(trace, "a", 5)["vx_mps"] == pytest.approx(8.0)
    assert states(trace, "ego")[1]["t_ns"] - states(trace, "ego")[0]["t_ns"] == STEP_NS
