"""Logs and maps as Argoverse published them, against a second reading: rotations by scipy, json and shapely by hand, and 123D's own."""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import shapely
from pyarrow import feather

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.logs import actors, read
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray
    from scipy.spatial.transform import Rotation

    from drivelint.drive.trace import Trace

LOGS: Final = ("adcf7d18", "3b3570b4")
MAPS: Final = (*(f"perception/av2/{name}/map" for name in LOGS), "perception/av2_forecasting")
METRES: Final = 1e-3
RADIANS: Final = 1e-6
SIDES: Final = ("length", "width", "height")
REAR_AXLE_TO_CENTRE: Final = (1.339, 0.0, 0.438)


@cache
def log(name: str) -> tuple[Trace, Path]:
    folder = shared(f"perception/av2/{name}")
    return read(folder), folder


def columns(table: pa.Table, *names: str) -> NDArray[np.float64]:
    return np.stack([table[name].to_numpy().astype(np.float64) for name in names], axis=1)


def keys(names: list[str], t_ns: NDArray[np.int64]) -> list[tuple[str, int]]:
    return list(zip(names, t_ns.tolist(), strict=True))


def rotation(quaternions: Any) -> Rotation:
    """Return the rotation of x, y, z, w, or those of rows of them."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(quaternions)


def rotations(table: pa.Table) -> Rotation:
    return rotation(columns(table, "qx", "qy", "qz", "qw"))


def second_reading(folder: Path) -> tuple[pa.Table, NDArray[np.float64], NDArray[np.float64]]:
    """Return the annotations but the ego's own, their centres (n, 3) in the city, and headings (n)."""
    (file,) = folder.glob("annotations*.feather")
    boxes, poses = feather.read_table(file), feather.read_table(folder / "city_SE3_egovehicle.feather")
    boxes = boxes.filter(pa.array([word != "EGO_VEHICLE" for word in boxes["category"].to_pylist()]))
    row = {stamp: i for i, stamp in enumerate(poses["timestamp_ns"].to_pylist())}
    poses = poses.take(pa.array([row[stamp] for stamp in boxes["timestamp_ns"].to_pylist()]))
    outer = rotations(poses)
    centres = outer.apply(columns(boxes, "tx_m", "ty_m", "tz_m")) + columns(poses, "tx_m", "ty_m", "tz_m")
    ahead = (outer * rotations(boxes)).apply([1.0, 0.0, 0.0])
    return boxes, centres, np.arctan2(ahead[:, 1], ahead[:, 0])


@pytest.mark.parametrize("name", LOGS)
def test_boxes(name: str) -> None:
    """A few headings differ by half a turn: the checks of every log turn them into the motion, and say so."""
    trace, folder = log(name)
    boxes, centres, headings = second_reading(folder)
    states = trace.tables["actor_state"]
    own = {key: i for i, key in enumerate(keys(states["actor_id"].to_pylist(), states["t_ns"].to_numpy()))}
    theirs = keys(boxes["track_uuid"].to_pylist(), boxes["timestamp_ns"].to_numpy())
    egos = [key for key in own if key[0] == "ego"]
    assert own.keys() == {*theirs, *egos}
    rows = [own[key] for key in theirs]
    found = columns(states, "x_m", "y_m", "z_m", "yaw_rad")[rows]
    assert np.abs(found[:, :3] - centres).max() < METRES
    off = np.abs(np.angle(np.exp(1j * (found[:, 3] - headings))))
    turned = off > RADIANS
    assert np.abs(off[turned] - np.pi).max(initial=0.0) < RADIANS
    quality = trace.tables["quality"].to_pylist()
    assert turned.sum() == sum(row["n"] for row in quality if row["check_id"] == "heading_turned")
    ours = {uuid: [row[f"{side}_m"] for side in SIDES] for uuid, row in actors(trace).items()}
    for uuid, *size in zip(
        boxes["track_uuid"].to_pylist(), *columns(boxes, "length_m", "width_m", "height_m").T, strict=True
    ):
        assert ours[uuid] == pytest.approx(size, abs=METRES)


@pytest.mark.parametrize("name", LOGS)
def test_the_ego(name: str) -> None:
    trace, folder = log(name)
    poses = feather.read_table(folder / "city_SE3_egovehicle.feather")
    centres = rotations(poses).apply(REAR_AXLE_TO_CENTRE) + columns(poses, "tx_m", "ty_m", "tz_m")
    ahead = rotations(poses).apply([1.0, 0.0, 0.0])
    row = {stamp: i for i, stamp in enumerate(poses["timestamp_ns"].to_pylist())}
    states = trace.tables["actor_state"]
    ego = states.filter(pa.array([actor == "ego" for actor in states["actor_id"].to_pylist()]))
    (file,) = folder.glob("annotations*.feather")
    assert ego["t_ns"].to_pylist() == sorted(set(feather.read_table(file)["timestamp_ns"].to_pylist()))
    at = [row[stamp] for stamp in ego["t_ns"].to_pylist()]
    assert np.abs(columns(ego, "x_m", "y_m", "z_m") - centres[at]).max() < METRES
    heading = np.arctan2(ahead[at, 1], ahead[at, 0])
    assert np.abs(np.angle(np.exp(1j * (columns(ego, "yaw_rad")[:, 0] - heading)))).max() < RADIANS


@pytest.mark.parametrize("name", LOGS)
def test_the_ego_s_speed_is_that_of_its_poses(name: str) -> None:
    """By central differences over the dense poses: within a quarter of a metre a second."""
    trace, folder = log(name)
    poses = feather.read_table(folder / "city_SE3_egovehicle.feather")
    t = poses["timestamp_ns"].to_numpy()
    place = rotations(poses).apply(REAR_AXLE_TO_CENTRE) + columns(poses, "tx_m", "ty_m", "tz_m")
    states = trace.tables["actor_state"]
    ego = states.filter(pa.array([actor == "ego" for actor in states["actor_id"].to_pylist()]))
    now = ego["t_ns"].to_numpy()[1:-1]
    before, after = (np.stack([np.interp(now + d, t, place[:, k]) for k in (0, 1)], axis=1) for d in (-5e7, 5e7))
    assert np.abs((after - before) / 0.1 - columns(ego, "vx_mps", "vy_mps")[1:-1]).max() < 0.25


def raw_map(relative: str) -> tuple[dict[str, Any], dict[str, list[dict[str, Any]]], dict[str, Any]]:
    (file,) = shared(relative).glob("log_map_archive_*.json")
    environment = load_map(MapSource(file.name, file.read_bytes()))
    tables = {table: content.to_pylist() for table, content in environment.tables.items()}
    points: dict[str, list[dict[str, Any]]] = {}
    for row in tables["lane_point"]:
        points.setdefault(row["lanelet_id"], []).append(row)
    return json.loads(file.read_bytes()), points, tables


def line(points: list[dict[str, float]]) -> NDArray[np.float64]:
    return np.array([[point["x"], point["y"], point["z"]] for point in points])


@pytest.mark.parametrize("relative", MAPS)
def test_lanes(relative: str) -> None:
    """No vertex of the source is further from our bounds, and no vertex of ours from its, than a millimetre."""
    said, points, tables = raw_map(relative)
    assert points.keys() == said["lane_segments"].keys()
    for name, segment in said["lane_segments"].items():
        for side in ("left", "right"):
            bound = line(segment[f"{side}_lane_boundary"])
            ours = np.array([[row[f"{side}_x_m"], row[f"{side}_y_m"]] for row in points[name]])
            assert shapely.distance(shapely.LineString(bound[:, :2]), shapely.points(ours)).max() < METRES
            assert shapely.distance(shapely.LineString(ours), shapely.points(bound[:, :2])).max() < METRES
            assert np.abs(ours[[0, -1]] - bound[[0, -1], :2]).max() < METRES
        ends = [(line(segment["left_lane_boundary"])[k] + line(segment["right_lane_boundary"])[k]) / 2 for k in (0, -1)]
        for k, middle in zip((0, -1), ends, strict=True):
            assert [points[name][k][axis] for axis in ("x_m", "y_m", "z_m")] == pytest.approx(middle, abs=METRES)
    lanes = said["lane_segments"]
    links = {(name, str(to)) for name, segment in lanes.items() for to in segment["successors"] if str(to) in lanes}
    assert {(row["from_id"], row["to_id"]) for row in tables["lane_link"]} == links


@pytest.mark.parametrize("relative", MAPS)
def test_neighbours_run_as_their_middles_do(relative: str) -> None:
    said, points, tables = raw_map(relative)
    n = 0
    for row in tables["lanelet"]:
        segment = said["lane_segments"][row["lanelet_id"]]
        for side in ("left", "right"):
            other = str(segment[f"{side}_neighbor_id"])
            if other not in points:
                assert row[f"{side}_id"] is row[f"{side}_against"] is None
                continue
            ways = [
                np.array([points[name][-1][axis] - points[name][0][axis] for axis in ("x_m", "y_m")])
                for name in (row["lanelet_id"], other)
            ]
            assert (row[f"{side}_id"], row[f"{side}_against"]) == (other, float(ways[0] @ ways[1]) < 0.0)
            n += 1
    assert n > 40


@pytest.mark.parametrize(("relative", "n"), [*zip(MAPS, (6, 6, 3), strict=True)])
def test_junctions_and_crossings(relative: str, n: int) -> None:
    """The junctions were counted on a drawing of each map."""
    said, _, tables = raw_map(relative)
    inside = {name for name, segment in said["lane_segments"].items() if segment["is_intersection"]}
    named = {row["lanelet_id"]: row["junction_id"] for row in tables["lanelet"] if row["junction_id"] is not None}
    assert named.keys() == inside
    assert len(set(named.values())) == n
    assert {row["crossing_id"] for row in tables["crossing"]} == said["pedestrian_crossings"].keys()
    assert {row["severity"] for row in tables["map_quality"]} <= {"info"}


def test_a_scenario() -> None:
    """What the checks of every log doubt is unknown; all else is as in the file, and the vehicle that records moved to its middle."""
    folder = shared("perception/av2_forecasting")
    (file,) = folder.glob("scenario_*.parquet")
    rows = pq.read_table(file).to_pylist()
    trace = read(folder)
    states = {(row["actor_id"], row["t_ns"]): row for row in trace.tables["actor_state"].to_pylist()}
    stamps = np.linspace(rows[0]["start_timestamp"], rows[0]["end_timestamp"], rows[0]["num_timestamps"]).astype(
        np.int64
    )
    assert len(states) == len(rows)
    unknown = 0
    for row in rows:
        found = states[row["track_id"], int(stamps[row["timestep"]])]
        if found["x_m"] is None:
            unknown += 1
            continue
        ahead = REAR_AXLE_TO_CENTRE[0] if row["track_id"] == "AV" else 0.0
        heading = row["heading"]
        assert found["x_m"] == pytest.approx(row["position_x"] + ahead * np.cos(heading), abs=METRES)
        assert found["y_m"] == pytest.approx(row["position_y"] + ahead * np.sin(heading), abs=METRES)
        if row["track_id"] == "AV":
            assert found["vx_mps"] in {None, row["velocity_x"]}
            assert found["vy_mps"] in {None, row["velocity_y"]}
            assert found["yaw_rad"] == pytest.approx(heading, abs=RADIANS)
    doubts = {row["check_id"]: row["n"] for row in trace.tables["quality"].to_pylist()}
    assert unknown == doubts["motion_unknown"]


def test_the_vehicle_of_a_scenario_is_given_by_its_rear_axle() -> None:
    """Where it turns, its point slips sideways against its heading by far less than the middle of the vehicle would."""
    (file,) = shared("perception/av2_forecasting").glob("scenario_*.parquet")
    table = pq.read_table(file)
    own = table.filter(pa.array([name == "AV" for name in table["track_id"].to_pylist()]))
    x, y, heading = columns(own, "position_x", "position_y", "heading").T
    inner = slice(3, -3)  # the first and the last step are shorter than the others
    vx, vy, turn = (np.gradient(values, 0.1)[inner] for values in (x, y, np.unwrap(heading)))
    across = vy * np.cos(heading[inner]) - vx * np.sin(heading[inner])
    # of a point so far ahead of the axle, which itself slips outwards with the square of the speed
    speed = np.hypot(vx, vy)
    ahead, _ = np.linalg.lstsq(np.stack([turn, turn * speed**2], axis=1), across, rcond=None)[0]
    assert abs(ahead) < 0.5 * REAR_AXLE_TO_CENTRE[0]
