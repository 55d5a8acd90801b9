"""Writes small logs, scenarios and maps as Argoverse 2 publishes them."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa
import pyarrow.parquet as pq
from pyarrow import feather

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from drivelint.road.map_reader import MapTables

Row = dict[str, Any]
START_NS: Final = 315_970_000_000_000_000
STEP_NS: Final = 100_000_000
MAP_NAME: Final = "log_map_archive_0000____PIT_city_1.json"
ANNOTATION_COLUMNS: Final = (
    "timestamp_ns", "track_uuid", "category", "length_m", "width_m", "height_m", "qw", "qx", "qy", "qz", "tx_m", "ty_m", "tz_m",
    "num_interior_pts",
)  # fmt: skip
_TYPES: Final = {
    "timestamp_ns": pa.int64(), "track_uuid": pa.string(), "category": pa.string(), "num_interior_pts": pa.int64(),
}  # fmt: skip


def stamp(k: int) -> int:
    """Return the time stamp of a step."""
    return START_NS + k * STEP_NS


def turn(yaw: float = 0.0, pitch: float = 0.0, roll: float = 0.0) -> Row:
    """Return the quaternion of a heading, then a pitch, then a roll (radians)."""
    (cy, sy), (cp, sp), (cr, sr) = ((math.cos(a / 2), math.sin(a / 2)) for a in (yaw, pitch, roll))
    return {
        "qw": cr * cp * cy + sr * sp * sy, "qx": sr * cp * cy - cr * sp * sy,
        "qy": cr * sp * cy + sr * cp * sy, "qz": cr * cp * sy - sr * sp * cy,
    }  # fmt: skip


def box(k: int, uuid: str = "a", x: float = 10.0, y: float = 0.0, z: float = 0.0, yaw: float = 0.0, **more: Any) -> Row:  # noqa: PLR0917
    """Return an annotation in the frame of the vehicle."""
    return {
        "timestamp_ns": stamp(k), "track_uuid": uuid, "category": "REGULAR_VEHICLE", "length_m": 4.5, "width_m": 1.8, "height_m": 1.5,
        **turn(yaw), "tx_m": x, "ty_m": y, "tz_m": z, "num_interior_pts": 9, **more,
    }  # fmt: skip


def pose(k: int, x: float = 0.0, y: float = 0.0, z: float = 0.0, **more: Any) -> Row:
    """Return a pose of the vehicle in the city."""
    return {"timestamp_ns": stamp(k), **turn(), "tx_m": x, "ty_m": y, "tz_m": z, **more}


def drive(n: int = 12, speed: float = 5.0) -> list[Row]:
    """Return the poses of a vehicle that drives along x."""
    return [pose(k, x=speed * k / 10) for k in range(n)]


def table(rows: Sequence[Row], columns: Iterable[str]) -> pa.Table:
    """Return rows as a table of the published types."""
    return pa.table({name: pa.array([row[name] for row in rows], _TYPES.get(name, pa.float64())) for name in columns})


def sensor_log(
    folder: Path,
    boxes: Sequence[Row],
    poses: Sequence[Row] | None = None,
    road: Row | None = None,
    name: str = "annotations.feather",
) -> Path:
    """Write a log; without poses, the vehicle drives along x."""
    folder.mkdir(parents=True, exist_ok=True)
    feather.write_feather(table(boxes, ANNOTATION_COLUMNS), folder / name)
    rows = drive() if poses is None else poses
    columns = ("timestamp_ns", "qw", "qx", "qy", "qz", "tx_m", "ty_m", "tz_m")
    feather.write_feather(table(rows, columns), folder / "city_SE3_egovehicle.feather")
    if road is not None:
        (folder / "map").mkdir(exist_ok=True)
        (folder / "map" / MAP_NAME).write_text(json.dumps(road))
    return folder


def points(*places: tuple[float, ...], z: float = 0.0) -> list[Row]:
    """Return the points of a line."""
    return [{"x": x, "y": y, "z": more[0] if more else z} for x, y, *more in places]


def segment(number: int, left: list[Row], right: list[Row], **more: Any) -> Row:
    """Return a lane segment."""
    return {
        "id": number, "is_intersection": False, "lane_type": "VEHICLE",
        "left_lane_boundary": left, "left_lane_mark_type": "NONE", "right_lane_boundary": right, "right_lane_mark_type": "NONE",
        "successors": [], "predecessors": [], "left_neighbor_id": None, "right_neighbor_id": None, **more,
    }  # fmt: skip


def straight(
    number: int, y: float = 0.0, begin: float = -50.0, end: float = 150.0, width: float = 4.0, **more: Any
) -> Row:
    """Return a straight lane along x, driven from `begin` to `end`, its middle at y."""
    half = width / 2 if end > begin else -width / 2
    z = more.pop("z", 0.0)
    left, right = (points((begin, y + side), (end, y + side), z=z) for side in (half, -half))
    return segment(number, left, right, **more)


def road(*segments: Row, crossings: Sequence[Row] = ()) -> Row:
    """Return a map."""
    return {
        "lane_segments": {str(each["id"]): each for each in segments},
        "pedestrian_crossings": {str(each["id"]): each for each in crossings},
        "drivable_areas": {},
    }


def load(content: Row | bytes, name: str = MAP_NAME, **options: Any) -> MapTables:
    """Read a map."""
    return load_map(MapSource(name, content if isinstance(content, bytes) else json.dumps(content).encode()), **options)


def track(track_id: str, steps: Iterable[int], speed: float = 5.0, y: float = 0.0, **more: Any) -> list[Row]:
    """Return the rows of a track along x."""
    return [
        {
            "observed": k < 50, "track_id": track_id, "object_type": "vehicle", "object_category": 1, "timestep": k,
            "position_x": speed * k / 10, "position_y": y, "heading": 0.0, "velocity_x": speed, "velocity_y": 0.0,
            "scenario_id": "s", "start_timestamp": float(START_NS), "end_timestamp": float(START_NS + 109 * STEP_NS),
            "num_timestamps": 110, "focal_track_id": "1", "city": "austin", "map_id": 1, "slice_id": "s", **more,
        }
        for k in steps
    ]  # fmt: skip


def scenario(folder: Path, rows: Sequence[Row], without: Sequence[str] = (), name: str = "scenario_s.parquet") -> Path:
    """Write the table of a scenario; return the file."""
    folder.mkdir(parents=True, exist_ok=True)
    names = [key for key in rows[0] if key not in without]
    pq.write_table(pa.table({key: [row[key] for row in rows] for key in names}), folder / name)
    return folder / name
