"""This module converts two-dimensional boxes (`vision_msgs/Detection2DArray`) into distances ahead.

An actor W metres wide with a box of w pixels is s = c W / w metres ahead; c is the camera's focal constant in pixels.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.errors import TraceError, UsageError
from drivelint.formats.mcap import bag
from drivelint.formats.mcap.reader import message_batches
from drivelint.formats.mcap.storage import recorded_file
from drivelint.formats.ros2 import cdr
from drivelint.formats.ros2.messages import HEADER_FIELDS
from drivelint.formats.ros2.objects import stamps
from drivelint.formats.ros2.types import short_type_name

if TYPE_CHECKING:
    from pathlib import Path

    from mcap.records import Channel, Schema
    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Times
    from drivelint.formats.film.mapping import VideoMapping
    from drivelint.formats.protobuf.descriptors import FieldTree

BOXES_MESSAGE_TYPE: Final = "vision_msgs/Detection2DArray"
_FIELD_TREE: Final[FieldTree] = {
    "header": HEADER_FIELDS,
    "detections": {"bbox": {"size_x": None, "size_y": None}, "id": None, "tracking_id": None},
}


class DistancesAhead(NamedTuple):
    """The numbers of the frames, ascending, and each actor's distance ahead in each frame (NaN: not detected, inf: distance unknown)."""

    frames: NDArray[np.int64]
    ahead_m: list[Floats]


def read(path: Path, film: VideoMapping) -> DistancesAhead:
    """Return the distances ahead in every frame. Errors: `TraceError` without boxes, `UsageError` for a mapping that lacks a value."""
    if film.camera is None:
        raise UsageError(
            "a film's boxes need [camera] focal_px in the mapping: the distance at which 1 m is 1 pixel wide"
        )
    if unsaid := [actor.id for actor in film.actor if actor.box is None]:
        raise UsageError(f"mapping: actor {unsaid[0]} has no 'box', the id of its detections")
    times: list[Times] = []
    boxes: list[tuple[Times, list[str], Floats]] = []
    for file in bag.bag_files(path):
        container = recorded_file(file, salvage=False)
        for _, log_messages in message_batches(container, _boxes_message_type):
            table = cdr.Decoder(file, container.schemas[log_messages[0].channel.schema_id], _FIELD_TREE).table(
                log_messages
            )
            t_ns, _ = stamps(table, "header.stamp")
            items = table.children["detections"]
            ids = items.columns.get("id", items.columns.get("tracking_id"))
            names = [] if ids is None else [str(name, "utf-8", "replace") for name in ids.tolist()]
            times.append(t_ns)
            boxes.append((t_ns[items.parent], names, items.columns["bbox.size_x"].astype(np.float64)))
    if not times:
        raise TraceError(f"{path}: no {BOXES_MESSAGE_TYPE} messages: this mapping reads the boxes of a film")
    return _distances_ahead(path, film, film.camera.focal_px, np.concatenate(times), boxes)


def _boxes_message_type(channel: Channel, schema: Schema) -> str | None:
    is_read = channel.message_encoding == "cdr" and short_type_name(schema.name) == BOXES_MESSAGE_TYPE
    return BOXES_MESSAGE_TYPE if is_read else None


def _distances_ahead(
    path: Path, film: VideoMapping, focal_px: float, t_ns: Times, boxes: list[tuple[Times, list[str], Floats]]
) -> DistancesAhead:
    """Return the distance of each actor per frame of a film, from the widths of its boxes: the smallest of several in a frame."""
    start = int(t_ns.min())
    numbers = _frame_numbers(t_ns, start, film)
    whole = np.arange(0, int(numbers.max()) + 1)
    ahead = []
    for actor in film.actor:
        distance = np.full(len(whole), np.inf)
        for at_ns, names, width in boxes:
            of_actor = np.array([name == actor.box for name in names], np.bool_) & (width > 0)
            np.minimum.at(
                distance, _frame_numbers(at_ns[of_actor], start, film), focal_px * actor.width / width[of_actor]
            )
        ahead.append(np.where(np.isfinite(distance), distance, np.nan))
    if not any(np.isfinite(distances).any() for distances in ahead):
        ids = ", ".join(str(actor.box) for actor in film.actor)
        raise TraceError(f"{path}: no box has an id that the mapping names ({ids}): correct the ids in the mapping")
    return DistancesAhead(whole, ahead)


def _frame_numbers(t_ns: Times, start: int, film: VideoMapping) -> NDArray[np.int64]:
    return np.rint((t_ns - start) / 1e9 * film.frames.rate_hz).astype(np.int64)
