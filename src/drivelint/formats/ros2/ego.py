"""Converts ROS 2 messages about the ego: odometry, transforms, reports of its lights, and whether the automated system drives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa

from drivelint.drive.trace import ACTOR_CLASSES, INDICATORS
from drivelint.formats.coordinate_frames import Poses, TransformTree, clean_frame_name, unit_quaternions
from drivelint.formats.ros2.messages import CONTROL_MODE, ENGAGE, HAZARD_LIGHTS, TURN_INDICATORS
from drivelint.formats.ros2.objects import stamps, vectors
from drivelint.formats.ros2.recorded_poses import RecordedPoses, recorded_poses
from drivelint.formats.ros2.vehicle import VehicleBox, is_axle_frame

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Indices, Times
    from drivelint.formats.ros2.cdr import Table

LIGHT_REPORT_STALE_AFTER_NS: Final = 1_000_000_000
"""A report of lights is valid for at most this time: vehicles send ten or more per second."""
_AUTONOMOUS = 1
_HAZARD_ON = 2
_OFF, _HAZARD = INDICATORS.index("off"), INDICATORS.index("hazard")
_INDICATOR_CODE_BY_REPORT: Final = {1: _OFF, 2: INDICATORS.index("left"), 3: INDICATORS.index("right")}


def odometry_poses(table: Table, log_ns: Times, box: VehicleBox | None, option_ahead_m: float) -> RecordedPoses:
    """Return the poses of odometry messages as rows of one actor, moved to the centre of its box.

    `box`: the vehicle's box relative to `AXLE_FRAME`; `option_ahead_m`: the distance of the centre ahead of any other child frame.
    Twist is in the child frame, as the message's definition says; if no child frame is named, in the header's frame.
    """
    n = table.n
    frames = table.column("header.frame_id")
    child = table.column("child_frame_id")
    turn = unit_quaternions(vectors(table, "pose.pose.orientation", "xyzw"))
    velocity = vectors(table, "twist.twist.linear")
    yaw_rate = vectors(table, "twist.twist.angular")[:, 2]
    along = (child != b"") & (child != frames)
    inside = Poses(vectors(table, "pose.pose.position"), turn)
    place = inside.place
    lever = np.tile([option_ahead_m, 0.0, 0.0], (n, 1))
    if box is not None:
        lever[is_axle_frame(child)] = box.centre
    if lever.any():
        place = inside.compose(Poses(lever, np.tile([0.0, 0.0, 0.0, 1.0], (n, 1)))).place
        swing = np.nan_to_num(yaw_rate)[:, None] * np.column_stack([-lever[:, 1], lever[:, 0]])
        cos, sin = np.cos(inside.yaw), np.sin(inside.yaw)
        velocity[:, 0] += np.where(along, swing[:, 0], cos * swing[:, 0] - sin * swing[:, 1])
        velocity[:, 1] += np.where(along, swing[:, 1], sin * swing[:, 0] + cos * swing[:, 1])
    kind = np.full(n, ACTOR_CLASSES.index("vehicle"), np.int8)
    rows = recorded_poses(
        stamps(table, "header.stamp"), (place, turn), log_ns=log_ns, ids=np.full(n, b"ego"), frames=frames, classes=kind,
        along=along, velocity=velocity,
    )  # fmt: skip
    if box is not None:
        rows.size[:] = box.size
    return rows


def add_transforms(frames: TransformTree, table: Table, log_ns: Times, *, static: bool, own_times: bool) -> None:
    """Add the transforms of TFMessages to `frames`. `own_times`: with the messages' stamps, otherwise with log times."""
    items = table.items("transforms")
    if not items.n:
        return
    t_ns = stamps(items, "header.stamp")[0] if own_times else log_ns[items.parent]
    places = vectors(items, "transform.translation")
    turns = unit_quaternions(vectors(items, "transform.rotation", "xyzw"))
    for child, parent, rows in rows_by_frames(items):
        frames.add(child, parent, t_ns[rows], Poses(places[rows], turns[rows]), static=static)


def rows_by_frames(items: Table) -> Iterator[tuple[str, str, Indices]]:
    """Yield child frame, parent frame and ascending rows of the transforms between them, sorted by the names as recorded."""
    (children, child), (parents, parent) = (
        np.unique(items.column(name), return_inverse=True) for name in ("child_frame_id", "header.frame_id")
    )
    pair = child.reshape(-1) * len(parents) + parent.reshape(-1)
    order = np.argsort(pair, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(pair[order])) + 1):
        of_child, of_parent = divmod(int(pair[rows[0]]), len(parents))
        yield _frame_name(children[of_child]), _frame_name(parents[of_parent]), rows


def _frame_name(recorded: bytes) -> str:
    return clean_frame_name(recorded.decode("utf-8", "replace"))


def indicator_codes(t_ns: Times, reports: dict[str, tuple[Times, NDArray[Any]]]) -> Codes:
    """Return the ego's indicator at the given times, from the last reports of at most `LIGHT_REPORT_STALE_AFTER_NS` before; -1 if unknown.

    Hazard lights take precedence over left and right. A report of hazard lights alone does not show that both indicators are off.
    """
    side, hazard = (_last_fresh_values(t_ns, reports.get(name)) for name in (TURN_INDICATORS, HAZARD_LIGHTS))
    result = np.full(len(t_ns), -1, np.int8)
    for number, code in _INDICATOR_CODE_BY_REPORT.items():
        result[side == number] = code
    if HAZARD_LIGHTS in reports:  # without a recent report, the hazard lights may be on
        result[hazard < 0] = -1
    result[hazard == _HAZARD_ON] = _HAZARD
    return result


def _last_fresh_values(t_ns: Times, reports: tuple[Times, NDArray[Any]] | None) -> Times:
    if reports is None:
        return np.full(len(t_ns), -1, np.int64)
    order = np.argsort(reports[0], kind="stable")
    times, values = reports[0][order], reports[1][order].astype(np.int64)
    at = np.searchsorted(times, t_ns, side="right") - 1
    fresh = (at >= 0) & (t_ns - times[np.maximum(at, 0)] <= LIGHT_REPORT_STALE_AFTER_NS)
    return np.where(fresh, values[np.maximum(at, 0)], -1)


def engagement_events(reports: dict[str, tuple[Times, NDArray[Any]]], ego: str) -> pa.Table | None:
    """Return events `engaged` (on or off) at the first report and whenever the automated system starts or stops driving; None: no reports.

    The vehicle's report takes precedence over the command to the vehicle. Only full automation is `engaged`.
    """
    if CONTROL_MODE in reports:
        t_ns, on = reports[CONTROL_MODE][0], reports[CONTROL_MODE][1] == _AUTONOMOUS
    elif ENGAGE in reports:
        t_ns, on = reports[ENGAGE][0], reports[ENGAGE][1] != 0
    else:
        return None
    order = np.argsort(t_ns, kind="stable")
    t_ns, on = t_ns[order], on[order]
    changes = np.flatnonzero(np.r_[True, on[1:] != on[:-1]])
    n, value = len(changes), np.where(on[changes], "on", "off")
    return pa.table({"t_ns": t_ns[changes], "actor_id": [ego] * n, "event": ["engaged"] * n, "value": value})
