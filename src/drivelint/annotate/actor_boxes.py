"""The boxes of all actors at every step, encoded column by column for speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.annotate import draw
from drivelint.annotate.draw import Colour
from drivelint.drive.order import MAX_GAP_PERIODS
from drivelint.formats.protobuf import wire

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from drivelint.annotate.clock import LogClock
    from drivelint.annotate.tracks import Tracks
    from drivelint.arrays import Floats, Times

MAX_BOXES: Final = 1_000_000
"""If a drive has more states, only every second, third ... step is drawn: about 30 MB of boxes are enough for any viewer."""
CHUNK_BYTES: Final = 2 << 20
EGO_FRAME: Final = "base_link"
"""The frame that viewers follow by default."""
EGO_COLOUR = Colour(0.13, 0.45, 0.95)
VEHICLE_COLOUR = Colour(0.62, 0.66, 0.72)
VULNERABLE_COLOUR = Colour(0.95, 0.78, 0.25)
_VULNERABLE_CLASSES: Final = frozenset({"pedestrian", "bicycle", "animal"})
_LENGTH_OR_WIDTH_IF_UNKNOWN_M: Final = 1.0
_HEIGHT_IF_UNKNOWN_M: Final = 1.5
RecordChunk = tuple[bytes, "NDArray[np.uint64]"]


def box_rows_and_step_interval(tracks: Tracks) -> tuple[NDArray[np.intp], int]:
    """Return the rows with a position and a heading, by time and actor, and n. Above `MAX_BOXES` rows, only every n-th step is included."""
    rows = np.flatnonzero(np.isfinite(tracks.x) & np.isfinite(tracks.y) & np.isfinite(tracks.yaw))
    every = max(1, -(-len(rows) // MAX_BOXES))
    if every > 1:
        steps, step = np.unique(tracks.t_ns[rows], return_inverse=True)
        rows = rows[step % every == 0] if len(steps) > every else rows
    order = np.argsort(tracks.t_ns[rows], kind="stable")
    return rows[order], every


def scene_update_chunks(tracks: Tracks, rows: NDArray[np.intp], clock: LogClock, channel: int) -> Iterator[RecordChunk]:
    """Yield chunks of message records, each with its index (log time, offset): a `foxglove.SceneUpdate` per step."""
    if not len(rows):
        return
    t_ns = tracks.t_ns[rows]
    first = np.flatnonzero(np.diff(t_ns, prepend=t_ns[0] - 1))
    count = np.diff(first, append=len(rows))
    t_ns = t_ns[first]
    log_time = clock.log_times(t_ns)
    heads = _constant_box_bytes(tracks, _box_lifetime_ns(t_ns))
    width = np.array([len(head) for head in heads])[tracks.actor[rows]] + _changing_bytes_per_box()
    size = np.add.reduceat(width, first)
    cuts = np.unique(np.searchsorted(np.cumsum(size), np.arange(0, size.sum(), CHUNK_BYTES)))
    for begin, end in zip(cuts, [*cuts[1:], len(first)], strict=True):
        if begin == end:
            continue
        rows_of = rows[first[begin] : first[end - 1] + count[end - 1]]
        times, counts = log_time[begin:end], count[begin:end]
        starts = message_headers(channel, times, size[begin:end], int(begin))
        tails = _changing_box_bytes(tracks, rows_of, np.repeat(times, counts))
        records, place = _join_headers_and_boxes(starts, counts, heads, tracks.actor[rows_of], tails)
        yield records, np.stack([times, place.astype(np.uint64)], axis=1)


def map_transform(frame: str, log_time: int) -> bytes:
    """Return a `foxglove.FrameTransform` which says that the frame of the drawings is `frame`, that of the log's positions."""
    head = wire.time(1, log_time) + wire.text(2, frame) + wire.text(3, draw.MAP_FRAME)
    return head + wire.nested(4, wire.doubles(0.0, 0.0, 0.0)) + wire.nested(5, wire.doubles(0.0, 0.0, 0.0, 1.0))


def ego_transform_chunks(
    tracks: Tracks, rows: NDArray[np.intp], clock: LogClock, channel: int
) -> Iterator[RecordChunk]:
    """Yield chunks of `foxglove.FrameTransform` records with the pose of the first ego, so that a viewer can follow it."""
    if not tracks.egos:
        return
    rows = rows[tracks.actor[rows] == tracks.names.index(tracks.egos[0])]
    log_time = clock.log_times(tracks.t_ns[rows])
    z, half = np.nan_to_num(tracks.z[rows]), tracks.yaw[rows] / 2
    body = wire.join_columns(
        len(rows),
        wire.text(2, draw.MAP_FRAME) + wire.text(3, EGO_FRAME),
        _fields_of_doubles(4, tracks.x[rows], tracks.y[rows], z),
        _fields_of_doubles(5, np.sin(half), np.cos(half), first_number=3),
        wire.timestamps(1, log_time),
    )
    size = body.shape[1] + message_headers(channel, log_time[:0], log_time[:0].astype(np.int64), 0).shape[1]
    for first in range(0, len(rows), CHUNK_BYTES // size):
        part = slice(first, first + CHUNK_BYTES // size)
        times = log_time[part]
        sizes = np.full(len(times), body.shape[1])
        records = np.concatenate([message_headers(channel, times, sizes, first), body[part]], axis=1)
        place = np.arange(len(times), dtype=np.uint64) * np.uint64(size)
        yield records.tobytes(), np.stack([times, place], axis=1)


def message_headers(channel: int, log_time: NDArray[np.uint64], size: NDArray[np.int64], first: int) -> wire.Bytes:
    """Return the headers of MCAP message records for messages of these sizes, numbered from `first`."""
    n = len(log_time)
    head = np.zeros(n, np.dtype("u1, <u8, <u2, <u4, <u8, <u8"))
    for field, values in zip(
        head.dtype.names or (), (5, size + 22, channel, np.arange(first, first + n), log_time, log_time), strict=True
    ):
        head[field] = values
    return head.view(np.uint8).reshape(n, head.dtype.itemsize)


def _join_headers_and_boxes(
    starts: wire.Bytes, count: NDArray[np.int64], heads: list[bytes], actor: NDArray[np.int32], tails: wire.Bytes
) -> tuple[bytes, NDArray[np.int64]]:
    """Join each encoded message header of `starts` with its `count` boxes; return the bytes and the offset of each message.

    A box consists of `heads[actor]`, which is the same at every step, and a row of `tails`, which changes.
    """
    head_width = np.array([len(head) for head in heads])[actor]
    is_start = np.zeros(len(actor) + len(count), np.bool_)
    is_start[np.cumsum(count) - count + np.arange(len(count))] = True
    width = np.where(is_start, starts.shape[1], 0)
    width[~is_start] = head_width + tails.shape[1]
    place = np.cumsum(width) - width
    out = np.empty(int(width.sum()), np.uint8)
    out[place[is_start, None] + np.arange(starts.shape[1])] = starts
    box_place = place[~is_start]
    for w in np.unique(head_width):
        indices = np.flatnonzero(head_width == w)
        names, name_index = np.unique(actor[indices], return_inverse=True)
        table = np.stack([np.frombuffer(heads[name], np.uint8) for name in names])
        piece = np.concatenate([table[name_index], tails[indices]], axis=1)
        out[box_place[indices, None] + np.arange(piece.shape[1])] = piece
    return out.tobytes(), place[is_start]


def _box_lifetime_ns(t_ns: Times) -> int:
    return int(MAX_GAP_PERIODS * float(np.median(np.diff(t_ns)))) if len(t_ns) > 1 else 0


def _constant_box_bytes(tracks: Tracks, lifetime_ns: int) -> list[bytes]:
    """Return the encoded part of each actor's box that is the same at every step: name, class, size and colour."""
    heads = []
    for name, kind, size, is_ego in zip(tracks.names, tracks.classes, tracks.sizes, tracks.is_ego, strict=True):
        length, width, height = (
            float(v) if np.isfinite(v) else d
            for v, d in zip(
                size, (_LENGTH_OR_WIDTH_IF_UNKNOWN_M, _LENGTH_OR_WIDTH_IF_UNKNOWN_M, _HEIGHT_IF_UNKNOWN_M), strict=True
            )
        )
        shade = EGO_COLOUR if is_ego else VULNERABLE_COLOUR if kind in _VULNERABLE_CLASSES else VEHICLE_COLOUR
        cube = draw.cube_without_pose(length, width, height, shade.with_opacity(0.9))
        facts = {
            "class": ("ego, " if is_ego else "") + (kind or "unknown"),
            "length": f"{size[0]:.2f} m",
            "width": f"{size[1]:.2f} m",
        }
        lifetime = wire.time(4, lifetime_ns) if lifetime_ns else b""
        body = wire.text(2, draw.MAP_FRAME) + wire.text(3, name) + lifetime + draw.facts_fields(facts)
        body += draw.cube_header(len(cube) + _POSE_BYTES) + cube
        heads.append(wire.varint(2 << 3 | 2) + wire.varint(len(body) + _changing_bytes_per_box()) + body)
    return heads


def _changing_box_bytes(tracks: Tracks, rows: NDArray[np.intp], log_time: NDArray[np.uint64]) -> wire.Bytes:
    """Return the encoded part of a box that changes, per row: the cube's pose (its last field), and the entity's time."""
    half = tracks.yaw[rows] / 2
    z = tracks.z[rows]
    height = np.nan_to_num(tracks.sizes[tracks.actor[rows], 2], nan=_HEIGHT_IF_UNKNOWN_M)
    z = np.where(np.isfinite(z), z, height / 2)
    pose = _pose_fields(tracks.x[rows], tracks.y[rows], z, half)
    return np.concatenate([pose, wire.timestamps(1, log_time)], axis=1)


def _pose_fields(x: Floats, y: Floats, z: Floats, half_yaw: Floats) -> wire.Bytes:
    """Return one encoded pose field per row."""
    where, turned = (
        _fields_of_doubles(1, x, y, z),
        _fields_of_doubles(2, np.sin(half_yaw), np.cos(half_yaw), first_number=3),
    )
    head = wire.varint(1 << 3 | 2) + wire.varint(where.shape[1] + turned.shape[1])
    return wire.join_columns(len(x), head, where, turned)


def _fields_of_doubles(field_number: int, *columns: Floats, first_number: int = 1) -> wire.Bytes:
    """Return, for each row, field `field_number`: a message whose fields, numbered from `first_number`, are doubles."""
    keyed = [(wire.varint(n << 3 | 1), wire.double_column(values)) for n, values in enumerate(columns, first_number)]
    head = wire.varint(field_number << 3 | 2) + wire.varint(9 * len(columns))
    return wire.join_columns(len(columns[0]), head, *(part for pair in keyed for part in pair))


_POSE_BYTES: Final = int(_pose_fields(*(np.zeros(1),) * 4).shape[1])


def _changing_bytes_per_box() -> int:
    return _POSE_BYTES + int(wire.timestamps(1, np.zeros(1, np.uint64)).shape[1])
