"""Sensor logs of Argoverse 2: a folder with the annotated boxes, the poses of the recording vehicle, and its map.

Boxes are given in the frame of the recording vehicle at exactly their time stamp (quaternion w first, centre of the box); the vehicle's
poses transform them into the frame of the city. The ego's steps are the time stamps of the annotations, ten a second: only then are the
actors around it known. There is a pose for each sensor's time: ten times as many, at irregular times, some repeated one nanosecond later.
Poses between the annotations are not read.

Time stamps are nanoseconds on a clock whose zero is not documented: counted from 1970, these drives of 2020 would be of January 1980. A
log has no date, velocity, indicator or state of a traffic light.

Source: Argoverse user guide ("Sensor Dataset"); av2-api, `SensorDataloader` and `Cuboid`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.trace import QualityFinding, Recording, States
from drivelint.errors import TraceError
from drivelint.formats.argoverse2 import cells, vehicle
from drivelint.formats.argoverse2.categories import (
    EGO_CATEGORY,
    RIDDEN_CATEGORIES,
    RIDER_CATEGORIES,
    SENSOR_CLASSES,
    class_codes,
)
from drivelint.formats.argoverse2.cities import NATION, frame_by_file_name
from drivelint.formats.coordinate_frames import Poses, unit_quaternions
from drivelint.formats.folders import folder_kind
from drivelint.formats.riders import join_riders_and_return_merged_rows_and_rider_tracks
from drivelint.formats.tables import ipc
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from drivelint.arrays import Floats, Indices, Mask, Times
    from drivelint.formats.probe import Probe

NAME: Final = "argoverse2-sensor"
formats: Final = {NAME: ("Argoverse 2 sensor log", "the vehicle that records")}
takes_mapping: Final = False
EGO_ID: Final = "ego"
POSES_FILE: Final = "city_SE3_egovehicle.feather"
SENSOR_RANGE_M: Final = 150.0
"""The range up to which the dataset's benchmarks take the annotations as complete, on the drivable area and within 5 m of it (av2-api,
`DetectionCfg.max_range_m`). Boxes further away are kept."""
_PLACE_COLUMNS: Final = ("tx_m", "ty_m", "tz_m")
_QUATERNION_COLUMNS: Final = ("qx", "qy", "qz", "qw")
_SIZE_COLUMNS: Final = ("length_m", "width_m", "height_m")
_TIME_COLUMN: Final = "timestamp_ns"


def accepts(probe: Probe) -> bool:
    """Return whether the path is a folder with the files of a sensor log."""
    return folder_kind(probe.path) == NAME


def read(probe: Probe) -> Recording:
    """Read a log. Errors: `TraceError` for damaged files, missing columns, and a log without annotations."""
    file, notes = _annotation_file(probe.path)
    rows = ipc.table(
        file, (_TIME_COLUMN, "track_uuid", "category", *_SIZE_COLUMNS, *_PLACE_COLUMNS, *_QUATERNION_COLUMNS)
    )
    t_ns, timed = cells.integer_column(file, rows, _TIME_COLUMN)
    usable, findings, lost_times = cells.rows_with_track_and_time(file, rows, "track_uuid", t_ns, timed)
    rows, t_ns = rows.filter(pa.array(usable)), t_ns[usable]
    steps, step = np.unique(t_ns, return_inverse=True)
    if not len(steps):
        raise TraceError(
            f"{file}: no annotations: the actors around the vehicle are not known: use a log with annotations"
        )
    rear_axle = _poses_at(probe.path / POSES_FILE, steps)
    findings += [
        vehicle.assumed_size_finding(EGO_ID),
        *_findings_on_missing_poses(steps, rear_axle, np.bincount(step, minlength=len(steps))),
    ]
    object_states, more = _annotated_states(file, rows, t_ns, Poses(*(column[step] for column in rear_axle)))
    ego = _ego_states(steps, vehicle.box_poses(rear_axle), object_states.ids)
    recording = Recording(
        NAME, States.concatenate([ego, object_states]), ego_ids=[EGO_ID], findings=findings, lost_times=lost_times
    )
    recording.notes = notes + more
    recording.sensor_range_m = SENSOR_RANGE_M
    recording.conditions["nation"] = NATION
    _add_map(recording, probe.path)
    return recording


def _annotation_file(folder: Path) -> tuple[Path, list[str]]:
    """Return the annotation file to read (`annotations.feather`, else the first by name), and a note on other annotation files."""
    files = sorted(folder.glob("annotations*.feather"))
    first = next((file for file in files if file.name == "annotations.feather"), files[0])
    unread = [file.name for file in files if file != first]
    return first, [f"{first.name} is read; {name_list(unread)} in the same folder is not read"] if unread else []


def _poses_at(path: Path, t_ns: Times) -> Poses:
    """Return the poses at these times (ascending); NaN for a time that no pose has exactly, or that two different poses have."""
    rows = ipc.table(path, (_TIME_COLUMN, *_PLACE_COLUMNS, *_QUATERNION_COLUMNS))
    stamps, timed = cells.integer_column(path, rows, _TIME_COLUMN)
    values = np.stack(list(cells.number_columns(path, rows, (*_PLACE_COLUMNS, *_QUATERNION_COLUMNS)).values()), axis=1)[
        timed
    ]
    order = np.argsort(stamps[timed], kind="stable")
    stamps, values = stamps[timed][order], values[order]
    has_pose, at = np.isin(t_ns, stamps), np.searchsorted(stamps, t_ns)
    twice = (stamps[1:] == stamps[:-1]) & (values[1:] != values[:-1]).any(axis=1)
    has_pose &= ~np.isin(t_ns, stamps[1:][twice])
    poses = np.full((len(t_ns), values.shape[1]), np.nan)
    poses[has_pose] = values[at[has_pose]]
    poses[~np.isfinite(poses).all(axis=1)] = np.nan
    return Poses(poses[:, :3], unit_quaternions(poses[:, 3:]))


def _findings_on_missing_poses(steps: Times, rear_axle: Poses, n_boxes: Indices) -> list[QualityFinding]:
    """Return the finding on time stamps without a pose: the annotated actors and the ego are present there, but not placed."""
    lacks_pose = np.isnan(rear_axle.place[:, 0]) | np.isnan(rear_axle.turn[:, 0])
    if not lacks_pose.any():
        return []
    n, boxes, first = int(lacks_pose.sum()), int(n_boxes[lacks_pose].sum()), int(steps[lacks_pose][0])
    message = (
        f"{POSES_FILE} has no pose, or several, at {n} of {len(steps)} time stamps of the annotations, the first {first}: the ego and "
        f"{boxes} boxes are present there but not placed"
    )
    return [QualityFinding("frame_unresolved", "error", message, n, first)]


def _annotated_states(path: Path, rows: pa.Table, t_ns: Times, rear_axle: Poses) -> tuple[States, list[str]]:
    """Return the annotated boxes as states, and notes. `rear_axle`: the recording vehicle's pose for each box."""
    category = cells.cast_column(path, rows, "category", pa.string())
    classes, notes = class_codes(category, SENSOR_CLASSES)
    is_ego = _is_one_of(category, [EGO_CATEGORY])
    ids = pc.dictionary_encode(cells.cast_column(path, rows, "track_uuid", pa.string()))
    actor = ids.indices.to_numpy().astype(np.int32)
    raw = cells.number_columns(path, rows, (*_PLACE_COLUMNS, *_QUATERNION_COLUMNS, *_SIZE_COLUMNS))
    odd = np.zeros(len(rows), np.bool_)
    for name, values in raw.items():
        wrong = ~np.isfinite(values)
        odd |= wrong & rows[name].is_valid().to_numpy(zero_copy_only=False)
        raw[name] = np.where(wrong, np.nan, values)
    place, turn = (np.stack([raw[name] for name in names], axis=1) for names in (_PLACE_COLUMNS, _QUATERNION_COLUMNS))
    poses = rear_axle.compose(Poses(place, unit_quaternions(turn)))
    boxes = _pose_columns(poses) | {name: raw[name] for name in _SIZE_COLUMNS}
    inside, riders = join_riders_and_return_merged_rows_and_rider_tracks(
        t_ns, actor, _is_one_of(category, RIDER_CATEGORIES), _is_one_of(category, RIDDEN_CATEGORIES), boxes
    )
    names = ids.dictionary.to_pylist()
    if riders:
        rider_names = name_list([names[i] for i in riders])
        notes.append(f"each rider and the vehicle count as one road user, with a box around both: {rider_names}")
    if is_ego.any():
        notes.append(f"the boxes of category {EGO_CATEGORY} are the ego itself: they are not read")
    states = States([EGO_ID, *names], actor + np.int32(1), t_ns, boxes, {"actor_class": classes}, odd)
    return states.take(~is_ego & ~inside), notes


def _is_one_of(categories: pa.Array, wanted_categories: Iterable[str]) -> Mask:
    is_wanted = pc.is_in(categories, value_set=pa.array(list(wanted_categories), pa.string()))
    return np.asarray(is_wanted.to_numpy(zero_copy_only=False), np.bool_)


def _pose_columns(poses: Poses) -> dict[str, Floats]:
    x, y, z = poses.place.T.copy()
    return {"x_m": x, "y_m": y, "z_m": z, "yaw_rad": poses.yaw}


def _ego_states(steps: Times, poses: Poses, ids: list[str]) -> States:
    n = len(steps)
    numbers = _pose_columns(poses) | {
        name: np.full(n, size) for name, size in zip(_SIZE_COLUMNS, vehicle.EGO_BOX_SIZE_M, strict=True)
    }
    classes, _ = class_codes(pa.array([EGO_CATEGORY] * n), SENSOR_CLASSES)
    return States(ids, np.zeros(n, np.int32), steps, numbers, {"actor_class": classes}, np.zeros(n, np.bool_))


def _add_map(recording: Recording, folder: Path) -> None:
    files = sorted((folder / "map").glob("log_map_archive_*.json"))
    if len(files) > 1:
        names = name_list([file.name for file in files])
        message = f"the log has {len(files)} maps ({names}), and none is used: keep only one"
        recording.findings.append(QualityFinding.unusable_map(message))
    elif files:
        try:
            recording.embedded_map = files[0].read_bytes()
        except OSError as error:
            raise TraceError(f"{files[0]}: cannot be read: {error.strerror or error}") from error
        if frame := frame_by_file_name(files[0].name):
            recording.geo_reference, recording.geo_offset = frame.reference, (frame.x_m, frame.y_m, 0.0)
    else:
        recording.notes.append("its map is missing: map/log_map_archive_*.json")
