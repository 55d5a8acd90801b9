"""Writes small logs and maps as py123d does: Arrow files, MessagePack in the metadata of their schemas and in the features of maps."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
import pyarrow as pa
import shapely

from drivelint.formats.map_registry import load_map, read_source
from drivelint.road.map_reader import MapTables

LABELS = "py123d.parser.registry.AV2SensorBoxDetectionLabel"
CAR = 18
LAYERS = {"lane": 0, "group": 1, "intersection": 2, "crosswalk": 3, "walkway": 4, "stop_zone": 7, "road_line": 9}
BOX_TYPES = {
    "bounding_box_se3": pa.list_(pa.list_(pa.float64(), 10)), "track_token": pa.list_(pa.string()),
    "label": pa.list_(pa.uint16()), "velocity_3d": pa.list_(pa.list_(pa.float64(), 3)),
    "num_lidar_points": pa.list_(pa.int32()),
}  # fmt: skip


class Box(NamedTuple):
    """A box; `v`: velocity along the map's axes, None: NULL."""

    token: str | None
    x: float
    y: float
    v: tuple[float, float, float] | None = (0.0, 0.0, 0.0)
    label: int = CAR
    yaw: float = 0.0
    size: tuple[float, float, float] = (4.5, 1.8, 1.5)
    z: float = 0.0


class Ego(NamedTuple):
    """A pose of the ego's IMU; `motion`: velocity, acceleration and angular velocity along its own axes, None: NULL."""

    t_us: int
    x: float
    y: float
    yaw: float = 0.0
    motion: Sequence[float] | None = None
    z: float = 0.0


class Frame(NamedTuple):
    """A frame: its time and its boxes (None: it has no row of boxes); `ego`: the row of the ego, None: the one of the same number."""

    t_us: int
    boxes: Sequence[Box] | None = ()
    ego: int | None = None


def turn(yaw: float) -> list[float]:
    """Return a turn about the vertical axis as a quaternion, w first."""
    return [math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)]


EGO_METADATA: dict[str, Any] = {
    "vehicle_name": "test_car", "width": 2.0, "length": 5.0, "height": 1.5, "wheel_base": 2.8,
    "center_to_imu_se3": [1.4, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0], "rear_axle_to_imu_se3": [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
}  # fmt: skip


def arrow(path: Path, columns: Mapping[str, pa.Array], metadata: object | None) -> Path:
    """Write an Arrow file."""
    table = pa.table(dict(columns))
    if metadata is not None:
        table = table.replace_schema_metadata({b"metadata": msgspec.msgpack.encode(metadata)})
    path.parent.mkdir(parents=True, exist_ok=True)
    with pa.OSFile(str(path), "wb") as sink, pa.ipc.new_file(sink, table.schema) as writer:
        writer.write_table(table)
    return path


def box_columns(rows: Sequence[tuple[int, Sequence[Box]]]) -> dict[str, pa.Array]:
    """Return the columns of box_detections_se3."""
    found: dict[str, list[Any]] = {name: [] for name in BOX_TYPES}
    for _, boxes in rows:
        found["bounding_box_se3"].append([[b.x, b.y, b.z, *turn(b.yaw), *b.size] for b in boxes])
        found["track_token"].append([b.token for b in boxes])
        found["label"].append([b.label for b in boxes])
        found["velocity_3d"].append([None if b.v is None else list(b.v) for b in boxes])
        found["num_lidar_points"].append([None for _ in boxes])
    times = {"timestamp_us": pa.array([t for t, _ in rows], pa.int64())}
    return {
        f"box_detections_se3.{name}": column
        for name, column in {**times, **{name: pa.array(v, BOX_TYPES[name]) for name, v in found.items()}}.items()
    }


def ego_columns(rows: Sequence[Ego]) -> dict[str, pa.Array]:
    """Return the columns of ego_state_se3."""
    name = "ego_state_se3"
    poses = [[r.x, r.y, r.z, *turn(r.yaw)] for r in rows]
    motions = [None if r.motion is None else list(r.motion) for r in rows]
    return {
        f"{name}.timestamp_us": pa.array([r.t_us for r in rows], pa.int64()),
        f"{name}.imu_se3": pa.array(poses, pa.list_(pa.float64(), 7)),
        f"{name}.dynamic_state_se3": pa.array(motions, pa.list_(pa.float64(), 9)),
    }


def light_columns(rows: Sequence[tuple[int, Sequence[tuple[int, int]]]]) -> dict[str, pa.Array]:
    """Return the columns of traffic_light_detections: of each time the pairs of lane and state."""
    name = "traffic_light_detections"
    return {
        f"{name}.timestamp_us": pa.array([t for t, _ in rows], pa.int64()),
        f"{name}.lane_id": pa.array([[lane for lane, _ in row] for _, row in rows], pa.list_(pa.int32())),
        f"{name}.status": pa.array([[state for _, state in row] for _, row in rows], pa.list_(pa.uint8())),
    }


def write_log(
    folder: Path,
    frames: Sequence[Frame],
    ego: Sequence[Ego],
    *,
    dataset: str = "test-set",
    location: str | None = "PIT",
    version: str = "0.7.0",
    labels: str = LABELS,
    lights: Sequence[tuple[int, Sequence[tuple[int, int]]]] | None = None,
    ego_metadata: Mapping[str, Any] = EGO_METADATA,
    with_boxes: bool = True,
) -> Path:
    """Write the files of a log; every frame's boxes are one row, in order."""
    header = {"dataset": dataset, "split": f"{dataset}_val", "log_name": folder.name, "location": location}
    rows: list[tuple[int, Sequence[Box]]] = []
    sync: dict[str, list[int | None]] = {"sync.timestamp_us": [], "ego_state_se3": [], "box_detections_se3": []}
    for k, frame in enumerate(frames):
        sync["sync.timestamp_us"].append(frame.t_us)
        sync["ego_state_se3"].append(k if frame.ego is None else frame.ego)
        sync["box_detections_se3"].append(None if frame.boxes is None else len(rows))
        if frame.boxes is not None:
            rows.append((frame.t_us, frame.boxes))
    if with_boxes:
        arrow(folder / "box_detections_se3.arrow", box_columns(rows), {"box_detection_label_class": labels})
    else:
        del sync["box_detections_se3"]
    arrow(folder / "ego_state_se3.arrow", ego_columns(ego), dict(ego_metadata))
    if lights is not None:
        arrow(folder / "traffic_light_detections.arrow", light_columns(lights), {})
    columns = {name: pa.array(values, pa.int64()) for name, values in sync.items()}
    arrow(folder / "sync.arrow", columns, {**header, "version": version, "map_metadata": None})
    return folder


# ---- maps


def array_of(points: Sequence[Sequence[float]]) -> dict[bytes, Any]:
    """Return an array as py123d packs it."""
    array = np.array(points, np.float64)
    return {b"__ndarray__": True, b"dtype": array.dtype.str, b"shape": list(array.shape), b"data": array.tobytes()}


class Object(NamedTuple):
    """An object of a map."""

    layer: int
    number: int
    features: dict[str, Any]
    shape: shapely.Geometry


def lane(
    number: int,
    left: Sequence[Sequence[float]],
    right: Sequence[Sequence[float]],
    *,
    kind: int = 2,
    **more_features: Any,
) -> Object:
    """Return a lane; `more_features` come beside its own, or in their place."""
    left, right = ([[*p, *([0.0] if len(p) == 2 else [])] for p in bound] for bound in (left, right))
    features: dict[str, Any] = {
        "lane_type": kind, "lane_group_id": None, "left_boundary": array_of(left), "right_boundary": array_of(right),
        "centerline": array_of(left), "left_lane_id": None, "right_lane_id": None, "predecessor_ids": [],
        "successor_ids": [], "speed_limit_mps": None, "outline": array_of([*left, *right[::-1]]), **more_features,
    }  # fmt: skip
    return Object(LAYERS["lane"], number, features, shapely.Polygon([*left, *right[::-1]]))


def straight(
    number: int,
    x0: float,
    x1: float,
    y: float,
    *,
    width: float = 3.5,
    z: float = 0.0,
    back: bool = False,
    **features: Any,
) -> Object:
    """Return a lane along x with its middle at y; `back`: it is driven towards x0."""
    xs, up = ((x1, x0), -1.0) if back else ((x0, x1), 1.0)
    left, right = ([[x, y + side * up * width / 2, z] for x in xs] for side in (1, -1))
    return lane(number, left, right, **features)


def group(number: int, lanes: Sequence[int], intersection: int | None) -> Object:
    """Return a group of lanes."""
    return Object(
        LAYERS["group"], number, {"lane_ids": list(lanes), "intersection_id": intersection}, shapely.box(0, 0, 1, 1)
    )


def intersection(number: int, groups: Sequence[int], kind: int = 0) -> Object:
    """Return an intersection; kind 1: with traffic lights."""
    features = {"intersection_type": kind, "lane_group_ids": list(groups)}
    return Object(LAYERS["intersection"], number, features, shapely.box(0, 0, 1, 1))


def crosswalk(number: int, x0: float, y0: float, x1: float, y1: float, *, z: float = 0.0) -> Object:
    """Return a crosswalk."""
    ring = [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
    return Object(LAYERS["crosswalk"], number, {"outline": array_of(ring)}, shapely.Polygon(ring))


def road_line(number: int, kind: int, points: Sequence[Sequence[float]]) -> Object:
    """Return a road line."""
    return Object(LAYERS["road_line"], number, {"road_line_type": kind}, shapely.LineString(points))


def write_map(
    path: Path,
    objects: Sequence[Object],
    *,
    dataset: str = "test-set",
    location: str | None = "PIT",
    version: str = "0.7.0",
    has_z: bool = True,
) -> Path:
    """Write a map."""
    columns = {
        "object_id": pa.array([o.number for o in objects], pa.int64()),
        "map_layer": pa.array([o.layer for o in objects], pa.int8()),
        "features": pa.array([msgspec.msgpack.encode(o.features) for o in objects], pa.binary()),
        "wkb": pa.array([shapely.to_wkb(o.shape) for o in objects], pa.binary()),
    }
    header = {"dataset": dataset, "split": None, "log_name": None, "location": location}
    return arrow(path, columns, {**header, "map_has_z": has_z, "map_is_per_log": False, "version": version})


def times(n: int, period_us: int = 100_000, start_us: int = 1_000_000) -> list[int]:
    """Return n times."""
    return [start_us + k * period_us for k in range(n)]


def ego_states(n: int, speed: float = 10.0, **fields: Any) -> list[Ego]:
    """Return an ego that drives along x."""
    return [Ego(t, speed * k * 0.1, 0.0, **fields) for k, t in enumerate(times(n))]


def load(tmp_path: Path, objects: list[Object], *, options: dict[str, Any] | None = None, **header: Any) -> MapTables:
    """Return the tables of a map of these objects."""
    return load_map(read_source(write_map(tmp_path / "map.arrow", objects, **header)), **(options or {}))
