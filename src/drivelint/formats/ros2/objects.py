"""Converts the ROS 2 messages that list other road users to `RecordedPoses`.

Definitions: astuff_sensor_msgs/derived_object_msgs (as the CARLA bridge fills them), autoware_msgs/autoware_perception_msgs,
ros-perception/vision_msgs (before version 4 and since).
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.drive.trace import ACTOR_CLASSES
from drivelint.formats.coordinate_frames import rotated, unit_quaternions
from drivelint.formats.ros2.messages import CARLA_OBJECTS, PREDICTED_OBJECTS, TRACKED_OBJECTS, VISION_DETECTIONS
from drivelint.formats.ros2.recorded_poses import RecordedPoses, distinct_values, recorded_poses

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Mask, Times
    from drivelint.formats.coordinate_frames import Vectors
    from drivelint.formats.ros2.cdr import Table

_BOX, _SPHERE, _CYLINDER = 1, 2, 3
_ROUND, _POLYGON = 1, 2
_NO_ORIENTATION, _EITHER_WAY = 0, 1
_UNKNOWN = -1


def _class_codes(*words: str | None) -> Codes:
    return np.array([_UNKNOWN if word is None else ACTOR_CLASSES.index(word) for word in words], np.int8)


_CARLA_CODES = _class_codes(
    None, None, None, None, "pedestrian", "bicycle", "car", "truck", "motorcycle", "vehicle", "object", "object"
)
_AUTOWARE_CODES = _class_codes(
    None, "car", "truck", "bus", "trailer", "motorcycle", "bicycle", "pedestrian", "animal", "object", "object", "object"
)  # fmt: skip
_CLASS_BY_WORD: Final = {
    **{word: word for word in ACTOR_CLASSES},
    "person": "pedestrian", "bike": "bicycle", "cyclist": "bicycle", "motorbike": "motorcycle", "lorry": "truck",
}  # fmt: skip


def class_code(word: str) -> int:
    """Return the index in `ACTOR_CLASSES` of a word such as `Car`, `vehicle.car` or `PERSON`; -1 if the word is unknown."""
    actor_class = _CLASS_BY_WORD.get(word.strip().lower().replace("/", ".").rsplit(".", 1)[-1])
    return _UNKNOWN if actor_class is None else ACTOR_CLASSES.index(actor_class)


def stamps(table: Table, path: str) -> tuple[Times, Mask]:
    """Return times in nanoseconds, and for each row whether it has a time.

    The definition may have seconds and nanoseconds, or one number of seconds.
    """
    columns = table.columns
    whole = columns.get(f"{path}.sec", columns.get(path))
    if whole is None:
        return np.zeros(table.n, np.int64), np.zeros(table.n, np.bool_)
    rest = columns.get(f"{path}.nanosec", columns.get(f"{path}.nsec", np.zeros(table.n, np.int64)))
    if whole.dtype.kind == "f":
        t_ns = np.rint(np.nan_to_num(whole) * 1e9).astype(np.int64) + rest.astype(np.int64)
    else:
        t_ns = whole.astype(np.int64) * 1_000_000_000 + rest.astype(np.int64)
    return t_ns, np.ones(table.n, np.bool_)


def vectors(table: Table, path: str, axes: str = "xyz") -> Vectors:
    """Return vectors with one column per axis; NaN for axes that the definition does not have."""
    unknown = np.full(table.n, np.nan)
    return np.stack(
        [
            table.columns.get(f"{path}.{axis}" if path else axis, unknown).astype(np.float64, copy=False)
            for axis in axes
        ],
        axis=1,
    )


def _rows_of_items(top: Table, items: Table, ids: NDArray[Any], frame: str | None, pose: str) -> RecordedPoses:
    """Return rows with the columns that all message types share: times, ids, frames and poses.

    `frame`: the path of an item's own frame, which takes precedence over the message's frame.
    """
    stamp_ns, stamped = stamps(top, "header.stamp")
    frames = top.columns.get("header.frame_id", np.zeros(top.n, "S1"))[items.parent]
    own_frames = items.columns.get(frame) if frame is not None else None
    if own_frames is not None:
        frames = np.where(own_frames == b"", frames, own_frames)
    poses = vectors(items, f"{pose}.position"), vectors(items, f"{pose}.orientation", "xyzw")
    times = stamp_ns[items.parent], stamped[items.parent]
    return recorded_poses(times, poses, log_ns=items.parent.astype(np.int64), ids=ids, frames=frames)


def _carla_rows(top: Table) -> RecordedPoses:
    items = top.items("objects")
    rows = _rows_of_items(top, items, items.column("id"), "header.frame_id", "pose")
    rows.velocity, rows.acceleration = vectors(items, "twist.linear"), vectors(items, "accel.linear")
    form, numbers = items.column("shape.type"), items.column("shape.dimensions")
    rows.size = np.where((form == _BOX)[:, None], numbers, np.nan)
    round_ = np.stack([2.0 * numbers[:, 1], 2.0 * numbers[:, 1], numbers[:, 0]], axis=1)  # height, radius
    rows.size = np.where((form == _CYLINDER)[:, None], round_, rows.size)
    rows.size = np.where((form == _SPHERE)[:, None], 2.0 * numbers[:, :1], rows.size)
    rows.classes = _codes_of_numbers(_CARLA_CODES, items.column("classification"))
    return rows


def _autoware_rows(top: Table, prefix: str = "") -> RecordedPoses:
    """Return Autoware's road users.

    Twist and acceleration are along the object's own axes, as multi_object_tracker writes and planners read them. Predicted paths
    are not read, as they are no states.
    """
    items = top.items("objects")
    ids = np.ascontiguousarray(items.column("object_id.uuid")).view("V16").reshape(-1)
    pose, twist, accel = (f"kinematics.{prefix}{name}_with_covariance" for name in ("pose", "twist", "acceleration"))
    rows = _rows_of_items(top, items, ids, None, f"{pose}.pose")
    rows.along[:] = True
    rows.velocity, rows.acceleration = vectors(items, f"{twist}.twist.linear"), vectors(items, f"{accel}.accel.linear")
    rows.size = vectors(items, "shape.dimensions")
    _fit_boxes(rows, items)
    rows.classes = _codes_of_numbers(
        _AUTOWARE_CODES, _likeliest_labels(items, "classification", "label", "probability", 0)
    )
    availability = items.columns.get("kinematics.orientation_availability")
    if availability is not None:
        rows.turn[availability == _NO_ORIENTATION] = np.nan
        rows.faces = availability != _EITHER_WAY
    return rows


def _fit_boxes(rows: RecordedPoses, items: Table) -> None:
    """Set size and place of Autoware's cylinders and polygons to those of a box, in place.

    The box of a polygon encloses its footprint, along the object's axes.
    """
    form = items.columns.get("shape.type", np.zeros(items.n, np.uint8))
    rows.outlined = form == _POLYGON
    rows.size[:, 1] = np.where(form == _ROUND, rows.size[:, 0], rows.size[:, 1])  # both are the diameter
    rows.size[rows.outlined, :2] = np.nan
    if not rows.outlined.any():
        return
    points = items.items("shape.footprint.points")
    of_polygon = np.flatnonzero(rows.outlined[points.parent])
    polygon_rows, first = np.unique(points.parent[of_polygon], return_index=True)
    if not len(polygon_rows):
        return
    corners = vectors(points, "", "xy")[of_polygon]
    low, high = np.minimum.reduceat(corners, first), np.maximum.reduceat(corners, first)
    rows.size[polygon_rows, :2] = np.where(high > low, high - low, np.nan)
    middle = np.column_stack([0.5 * (low + high), np.zeros(len(polygon_rows))])
    shift = rotated(unit_quaternions(rows.turn[polygon_rows]), middle)
    rows.place[polygon_rows] += np.where(
        np.isfinite(shift), shift, 0.0
    )  # an object without an orientation keeps its place


def _vision_rows(top: Table) -> RecordedPoses:
    items = top.items("detections")
    ids = items.columns.get("id", items.columns.get("tracking_id", np.zeros(items.n, "S1")))
    rows = _rows_of_items(top, items, ids, "header.frame_id", "bbox.center")
    rows.size = vectors(items, "bbox.size")
    results = items.items("results")
    key = next((c for c in ("hypothesis.class_id", "id") if c in results.columns), None)
    score = next((c for c in ("hypothesis.score", "score") if c in results.columns), None)
    if key is not None and score is not None and results.columns[key].dtype.kind == "S":
        words, word_index = distinct_values(_likeliest_labels(items, "results", key, score, b""))
        rows.classes = np.array([class_code(word) for word in words], np.int8)[word_index]
    return rows


def _likeliest_labels(items: Table, path: str, label: str, score: str, default: Any) -> NDArray[Any]:
    """Return for each item the label with the highest score, of equal scores the first; `default` for an item without labels."""
    listed = items.items(path)
    labels = listed.column(label)
    result = np.full(items.n, default, labels.dtype)
    order = np.lexsort((np.arange(listed.n), -listed.column(score), listed.parent))
    parents, first = np.unique(listed.parent[order], return_index=True)
    result[parents] = labels[order[first]]
    return result


def _codes_of_numbers(code_table: Codes, numbers: NDArray[Any]) -> Codes:
    inside = (numbers >= 0) & (numbers < len(code_table))
    result: Codes = np.where(inside, code_table[np.where(inside, numbers, 0)], np.int8(_UNKNOWN)).astype(np.int8)
    return result


OBJECT_CONVERTERS: Final[dict[str, Callable[[Table], RecordedPoses]]] = {
    PREDICTED_OBJECTS: partial(_autoware_rows, prefix="initial_"),
    TRACKED_OBJECTS: _autoware_rows,
    CARLA_OBJECTS: _carla_rows,
    VISION_DETECTIONS: _vision_rows,
}
"""Message type -> the function that converts its messages to rows. `log_ns` of a row is at first the index of its message."""
MESSAGE_TYPES_OF_SAME_OBJECTS: Final = (PREDICTED_OBJECTS, TRACKED_OBJECTS)
"""Message types in which one perception system sends the same objects, the preferred type first: predictions have headings in the
direction of motion, while those of tracks may be reversed."""
