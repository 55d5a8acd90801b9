"""The ego of a 123D log (`ego_state_se3.arrow`): the poses of its IMU, and in the metadata its box in the frame of the IMU."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import pyarrow as pa

from drivelint.drive.trace import ACTOR_CLASSES, ASSUMED_SIZE_CHECK, SIZE_COLUMNS, STATE_COLUMNS, QualityFinding, States
from drivelint.errors import TraceError
from drivelint.formats.coordinate_frames import Poses, rotated, unit_quaternions
from drivelint.formats.d123.arrow_files import EGO_STATE, is_null, read_modality, vectors

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from drivelint.arrays import Floats, Indices, Mask, Times
    from drivelint.formats.d123 import facts
    from drivelint.formats.d123.arrow_files import ModalityFile

_COLUMNS: Final = {
    "imu_se3": pa.list_(pa.float64(), 7),  # place, quaternion w x y z
    "dynamic_state_se3": pa.list_(pa.float64(), 9),  # velocity, acceleration, angular velocity along the ego's axes
}
EGO_ID: Final = "ego"
_MAX_HEADING_CHANGE_WITH_ZERO_TURN_RATES_RAD: Final = 0.02
_LEAST_POSES_TO_DETECT_DERIVED_VELOCITIES: Final = 20
"""With fewer poses that have a pose before and after, velocities count as measured."""
_LEAST_DERIVED_VELOCITY_SHARE: Final = 0.99
"""If at least this share of the velocities is equal to the mean velocity, all were computed from the poses."""
_DERIVED_VELOCITY_TOLERANCE_MPS: Final = 1e-6


class EgoBox(NamedTuple):
    """The ego's box in the frame of the IMU: place (3,) and quaternion x y z w (4,) of its centre, and its sizes (NaN: not known)."""

    place: Floats
    turn: Floats
    sizes: Floats


def read_ego(folder: Path) -> ModalityFile:
    """Return the file of ego states. Errors: as `read_modality`, and `TraceError` if it is missing or has no row."""
    ego = read_modality(folder, EGO_STATE, _COLUMNS)
    if ego is None or not ego.n_rows:
        raise TraceError(f"{folder / EGO_STATE}.arrow: the file has no state of the ego: convert the log again")
    return ego


def ego_id_unlike_box_ids(box_ids: Iterable[str]) -> str:
    """Return an id for the ego that no box has."""
    name, ids = EGO_ID, set(box_ids)
    while name in ids:
        name += "_vehicle"
    return name


def ego_box(
    ego: ModalityFile, about: facts.DatasetFacts, name: str, option_forward_m: float
) -> tuple[EgoBox, list[QualityFinding]]:
    """Return the ego's box, and findings. Errors: `TraceError` for metadata that do not contain the box.

    `option_forward_m`: the user's option for how far the box centre is ahead, used if the metadata contradict themselves.
    """
    entries = ego.metadata
    centre, axle = (_metadata_pose(ego, key) for key in ("center_to_imu_se3", "rear_axle_to_imu_se3"))
    sizes = np.array([_length_or_nan(entries.get(key)) for key in ("length", "width", "height")])
    findings = []
    wheel_base = _length_or_nan(entries.get("wheel_base"))
    if not math.isnan(wheel_base) and np.hypot(*(centre[:2] - axle[:2])) < 0.1 * wheel_base:
        # the centre of a box lies between the axles: one of the two poses is wrong
        sizes[:] = np.nan
        centre[0] += option_forward_m
        message = (
            "the metadata put the middle of the ego's box on its rear axle: the place of its box is not known: set its size, and how far "
            "its middle is ahead of the recorded place: --ego-size LENGTH,WIDTH,AHEAD"
        )
        findings.append(QualityFinding("reference_point", "warning", message, actor_id=name))
    elif not about.ego_size_recorded and not np.isnan(sizes[:2]).any():
        model = entries.get("vehicle_name") or "its model"
        message = f"the ego's size is the size that 123D states for {model}, not recorded"
        findings.append(QualityFinding(ASSUMED_SIZE_CHECK, "info", message, actor_id=name))
    return EgoBox(centre[:3], centre[[4, 5, 6, 3]], sizes), findings


def ego_states(
    ego: ModalityFile, rows: Indices, t_ns: Times, box: EgoBox, *, about: facts.DatasetFacts, name: str
) -> States:
    """Return the states of the centre of the ego's box at these rows of the file. `t_ns`: their times (rows,)."""
    n = len(rows)
    poses, motion = vectors(ego.columns["imu_se3"]), vectors(ego.columns["dynamic_state_se3"])
    turn = unit_quaternions(poses[:, [4, 5, 6, 3]])
    velocity = _centre_velocity(ego, Poses(poses[:, :3], turn), motion, box)[rows]
    odd = ~np.isfinite(poses[rows]).all(axis=1)
    odd |= ~is_null(ego.columns["dynamic_state_se3"])[rows] & ~np.isfinite(motion[rows, :3]).all(axis=1)
    imu = Poses(poses[rows, :3], turn[rows])
    middle = imu.compose(Poses(np.tile(box.place, (n, 1)), np.tile(box.turn, (n, 1))))
    place = np.where(np.isfinite(middle.place), middle.place, np.nan)
    numbers = {column: place[:, k].copy() for k, column in enumerate(STATE_COLUMNS[:3])}
    numbers |= {"yaw_rad": middle.yaw, "vx_mps": velocity[:, 0].copy(), "vy_mps": velocity[:, 1].copy()}
    numbers |= {column: np.full(n, size) for column, size in zip(SIZE_COLUMNS, box.sizes.tolist(), strict=True)}
    kind = np.full(n, ACTOR_CLASSES.index(about.ego_class), np.int8)
    return States([name], np.zeros(n, np.int32), t_ns, numbers, {"actor_class": kind}, np.asarray(odd, np.bool_))


def _centre_velocity(ego: ModalityFile, imu: Poses, motion: Floats, box: EgoBox) -> Floats:
    """Return the velocity of the centre of the box along the map's axes, (n, 3), NaN: not known.

    The file records the velocity of the IMU and the turn rate. The velocity is not known if the converter computed it from the poses, or
    if the heading changes although all turn rates are 0.
    """
    unknown_velocity = np.full((len(motion), 3), np.nan)
    velocity, turning = motion[:, :3], motion[:, 6:9]
    has_velocity = np.asarray(np.isfinite(velocity).all(axis=1), np.bool_)
    if not has_velocity.any():
        return unknown_velocity
    outward = rotated(imu.turn, velocity)
    if _has_derived_velocities(ego, imu, outward, has_velocity):
        return unknown_velocity
    still = has_velocity & (velocity == 0.0).all(axis=1)
    if still[has_velocity].all():
        return np.where(has_velocity[:, None], np.zeros_like(velocity), np.nan)
    yaw = np.unwrap(imu.yaw[np.isfinite(imu.yaw)])
    if (
        len(yaw)
        and np.ptp(yaw) > _MAX_HEADING_CHANGE_WITH_ZERO_TURN_RATES_RAD
        and not (turning[has_velocity] != 0.0).any()
        and box.place[:2].any()
    ):
        return unknown_velocity
    swing = rotated(imu.turn, np.cross(turning, box.place))
    return np.where(has_velocity[:, None], outward + swing, np.nan)


def _has_derived_velocities(ego: ModalityFile, imu: Poses, velocity: Floats, has_velocity: Mask) -> bool:
    """Return whether nearly all velocities are the mean velocity from the pose before to the pose after."""
    t_us = ego.columns["timestamp_us"].to_numpy(zero_copy_only=False)
    if len(t_us) - 2 < _LEAST_POSES_TO_DETECT_DERIVED_VELOCITIES:
        return False
    with np.errstate(divide="ignore", invalid="ignore"):
        way = (imu.place[2:] - imu.place[:-2]) / ((t_us[2:] - t_us[:-2]) * 1e-6)[:, None]
    off = np.linalg.norm(way - velocity[1:-1], axis=1)
    length = np.linalg.norm(way, axis=1)
    moving = has_velocity[1:-1] & (length > _DERIVED_VELOCITY_TOLERANCE_MPS) & np.isfinite(length)
    return bool(
        moving.any()
        and (off[moving] <= _DERIVED_VELOCITY_TOLERANCE_MPS * (1.0 + length[moving])).mean()
        >= _LEAST_DERIVED_VELOCITY_SHARE
    )


def _metadata_pose(ego: ModalityFile, key: str) -> Floats:
    """Return a pose of the metadata, (7,). Errors: `TraceError` if it is missing or invalid."""
    try:
        pose = np.array(ego.metadata.get(key), np.float64)
    except (TypeError, ValueError):
        pose = np.empty(0)
    if pose.shape != (7,) or not np.isfinite(pose).all() or not np.linalg.norm(pose[3:]) > 0.5:
        raise TraceError(
            f"{ego.path}: its metadata have no pose {key!r}: where the ego's box lies is not known: convert the log again"
        )
    pose[3:] /= np.linalg.norm(pose[3:])
    return pose


def _length_or_nan(value: Any) -> float:
    """Return a length in metres, NaN if the value is not a length."""
    return float(value) if isinstance(value, int | float) and 0.0 < value < math.inf else math.nan
