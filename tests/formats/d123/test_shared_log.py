"""A log of Argoverse 2 read through 123D has what the data set itself has, by a decode of its files that is written here."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from pyarrow import feather

from drivelint.formats.map_registry import load_map, read_source
from tests.formats.logs import actors, log, read, states
from tests.shared_data import shared

LOG = "perception/d123/av2-sensor_val/adcf7d18-0510-35b0-a2fa-b4cea13a6d76"
SOURCE = "perception/av2/adcf7d18"
EGO = (1.339, 0.0, 0.438)  # from the pose of the log to the middle of the box, as 123D has it
WORDS = {
    "REGULAR_VEHICLE": "car", "PEDESTRIAN": "pedestrian", "BUS": "bus", "BOX_TRUCK": "truck", "TRUCK": "truck", "BICYCLE": "object",
    "BOLLARD": "object", "CONSTRUCTION_CONE": "object", "STOP_SIGN": "object", "SIGN": "object", "LARGE_VEHICLE": "vehicle",
    "CONSTRUCTION_BARREL": "object", "STROLLER": "object", "WHEELED_DEVICE": "object", "BICYCLIST": "bicycle", "MOTORCYCLE": "motorcycle",
    "VEHICULAR_TRAILER": "trailer", "ARTICULATED_BUS": "bus", "SCHOOL_BUS": "bus", "WHEELCHAIR": "object",
}  # fmt: skip


def rotation(q: np.ndarray) -> np.ndarray:
    """Return rotation matrices (n, 3, 3) of quaternions w, x, y, z (n, 4)."""
    w, x, y, z = (q / np.linalg.norm(q, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.array(rows).transpose(2, 0, 1)


@cache
def source() -> dict[tuple[str, int], tuple[Any, ...]]:
    """Return (track, microseconds) -> x, y, z, heading, length, width, height, category of the data set's own files."""
    folder = shared(SOURCE)
    poses = feather.read_table(folder / "city_SE3_egovehicle.feather").to_pydict()
    row = {t: i for i, t in enumerate(poses["timestamp_ns"])}
    turns = rotation(np.array([poses[name] for name in ("qw", "qx", "qy", "qz")]).T)
    places = np.array([poses[name] for name in ("tx_m", "ty_m", "tz_m")]).T
    boxes = feather.read_table(folder / "annotations.feather").to_pydict()
    own = rotation(np.array([boxes[name] for name in ("qw", "qx", "qy", "qz")]).T)
    found: dict[tuple[str, int], tuple[Any, ...]] = {}
    for i, (t, track) in enumerate(zip(boxes["timestamp_ns"], boxes["track_uuid"], strict=True)):
        k = row[t]
        at = places[k] + turns[k] @ np.array([boxes[name][i] for name in ("tx_m", "ty_m", "tz_m")])
        front = turns[k] @ own[i][:, 0]
        size = [boxes[name][i] for name in ("length_m", "width_m", "height_m")]
        found[track, t // 1000] = (*at, math.atan2(front[1], front[0]), *size, boxes["category"][i])
        front = turns[k][:, 0]
        ego = places[k] + turns[k] @ np.array(EGO)
        found["ego", t // 1000] = (*ego, math.atan2(front[1], front[0]), 4.869, 2.127, 1.476, "")
    return found


def test_everybody_is_where_the_data_set_has_them() -> None:
    trace = read(shared(LOG))
    expected, who, rows = source(), actors(trace), states(trace)
    assert {(row["actor_id"], row["t_ns"] // 1000) for row in rows} == set(expected)
    assert len(rows) == len(expected) == 12_234
    off_m, off_rad = 0.0, 0.0
    for row in rows:
        x, y, z, yaw, *_ = expected[row["actor_id"], row["t_ns"] // 1000]
        off_m = max(off_m, abs(row["x_m"] - x), abs(row["y_m"] - y), abs(row["z_m"] - z))
        off_rad = max(off_rad, abs(math.remainder(row["yaw_rad"] - yaw, math.tau)))
    assert off_m < 1e-3
    # the annotations' quaternions are of unit length to 1e-7
    assert off_rad < 1e-6
    for (track, _), (*_, length, width, height, category) in expected.items():
        assert [who[track][name] for name in ("length_m", "width_m", "height_m")] == pytest.approx(
            [length, width, height], abs=0.05
        )
        assert not category or who[track]["actor_class"] == WORDS[category]
    assert log(trace)["utc_start_ns"] is None


def test_speeds_are_those_of_the_positions() -> None:
    """Nobody's velocity is recorded; those of the ego's dense poses tell how fast it was."""
    folder, trace = shared(SOURCE), read(shared(LOG))
    poses = feather.read_table(folder / "city_SE3_egovehicle.feather").to_pydict()
    t = np.array(poses["timestamp_ns"]) * 1e-9
    places = np.array([poses["tx_m"], poses["ty_m"]])
    for row in states(trace, "ego")[5:-5:10]:
        near = np.abs(t - row["t_ns"] * 1e-9) < 0.25
        slope = [np.polyfit(t[near] - row["t_ns"] * 1e-9, axis[near], 2)[1] for axis in places]
        assert math.hypot(row["vx_mps"], row["vy_mps"]) == pytest.approx(math.hypot(*slope), abs=0.15)


@cache
def lanes() -> dict[str, Any]:
    (path,) = (shared(SOURCE) / "map").glob("log_map_archive_*.json")
    segments: dict[str, Any] = json.loads(path.read_text())["lane_segments"]
    return segments


def points(line: list[dict[str, float]]) -> np.ndarray:
    return np.array([[p["x"], p["y"], p["z"]] for p in line])


def test_lanes_are_those_of_the_data_set() -> None:
    environment = load_map(read_source(shared(LOG) / "map.arrow"))
    found = {row["lanelet_id"]: row for row in environment.tables["lanelet"].to_pylist()}
    assert set(found) == set(lanes())
    table = environment.tables["lane_point"].to_pydict()
    of_lane = np.array(table["lanelet_id"])
    kinds = {"VEHICLE": "driving", "BIKE": "biking", "BUS": "bus"}
    for name, lane in lanes().items():
        row, here = found[name], np.flatnonzero(of_lane == name)
        assert row["lane_type"] == kinds[lane["lane_type"]]
        assert (row["junction_id"] is not None) == lane["is_intersection"]
        for side in ("left", "right"):
            bound = points(lane[f"{side}_lane_boundary"])
            line = shapely.LineString(bound[:, :2])
            mine = np.array([[table[f"{side}_{axis}_m"][i] for axis in "xy"] for i in here])
            assert shapely.distance(shapely.points(mine), line).max() < 1e-3
            assert shapely.distance(shapely.points(bound[:, :2]), shapely.LineString(mine)).max() < 1e-3
            other = lane[f"{side}_neighbor_id"]
            assert row[f"{side}_id"] == (str(other) if str(other) in lanes() else None)
        middle = [
            np.mean([points(lane[f"{side}_lane_boundary"])[end, 2] for side in ("left", "right")]) for end in (0, -1)
        ]
        assert [table["z_m"][here[0]], table["z_m"][here[-1]]] == pytest.approx(middle, abs=0.02)
    links = {(row["from_id"], row["to_id"]) for row in environment.tables["lane_link"].to_pylist()}
    assert links == {(n, str(s)) for n, lane in lanes().items() for s in lane["successors"] if str(s) in lanes()}


def test_markings_are_those_of_the_data_set() -> None:
    words = {
        "NONE": "none", "DASHED_WHITE": "broken", "DASHED_YELLOW": "broken", "SOLID_WHITE": "solid", "SOLID_YELLOW": "solid",
        "DOUBLE_SOLID_YELLOW": "solid_solid",
    }  # fmt: skip
    environment = load_map(read_source(shared(LOG) / "map.arrow"))
    rows = environment.tables["lane_boundary"].to_pylist()
    assert len(rows) == 2 * len(lanes())
    for row in rows:
        assert row["marking"] == words[lanes()[row["lanelet_id"]][f"{row['side']}_lane_mark_type"]]


def test_the_log_is_found_and_lies_on_its_map() -> None:
    from drivelint.formats.files import expand_traces

    folder = shared(LOG)
    assert expand_traces([str(folder.parents[1])]) == [folder]
    trace = read(folder)
    assert trace.embedded_map == Path(folder / "map.arrow").read_bytes()
