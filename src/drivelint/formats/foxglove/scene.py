"""Reads Foxglove scenes in MCAP. The first cube of an entity is the road user's box.

The position of a cube is the centre of its box, in the entity's frame. An entity with a class but without a cube is also a road user, if it
has a cylinder, a sphere or a model. Scenes have no velocities, which are derived later, and no ego, which `--ego` names.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.trace import LostTime, QualityFinding, Recording
from drivelint.errors import TraceError
from drivelint.formats.coordinate_frames import Poses, TransformTree, clean_frame_name, fixed_frame, unit_quaternions
from drivelint.formats.foxglove.decode import (
    FIELD_TREES,
    SCENE,
    TRANSFORM,
    decoded_rows,
    distinct_texts,
    numbers,
    times,
    vectors,
)
from drivelint.formats.foxglove.entity_lifetime import with_states_between_updates
from drivelint.formats.mcap import bag
from drivelint.formats.mcap.losses import lost_times_of_parts
from drivelint.formats.mcap.malformed import decode_readable_and_record_losses
from drivelint.formats.mcap.reader import message_batches
from drivelint.formats.mcap.silent import silent_topics_text
from drivelint.formats.mcap.storage import recorded_file
from drivelint.formats.mcap.unread import UnreadTopics
from drivelint.formats.protobuf.descriptors import list_items_and_row_indices, struct_field
from drivelint.formats.ros2.objects import class_code
from drivelint.formats.ros2.recorded_poses import (
    RecordedPoses,
    distinct_values,
    frame_times_and_start,
    join_batches,
    recorded_poses,
    set_times_and_return_are_own_times,
    states_in_fixed_frame,
)
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from pathlib import Path

    from mcap.records import Channel, Schema
    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Mask, Times
    from drivelint.formats.coordinate_frames import Vectors
    from drivelint.formats.mcap.reader import Container

CLASS_KEYS: Final = ("class", "type", "classification", "category", "label", "object_class", "object_type")
"""Keys of an entity's metadata whose value can be its class."""
_BODIES_OF_CLASSED_ENTITIES: Final = ("cylinders", "spheres", "models")
"""The bodies, the preferred one first, that show where an entity with a class is. Lines, arrows and texts are none."""
DELETE_ALL: Final = 1


@dataclass
class _TopicContent:
    """The content of one topic with scenes. `without_box`: number of entities that have no body."""

    rows: list[RecordedPoses] = field(default_factory=list)
    deletions: list[tuple[Times, Mask, Times, list[str | None]]] = field(default_factory=list)
    without_box: int = 0


def read(path: Path, topic: str | None) -> Recording:
    """Read the scenes of one topic.

    Errors: `TraceError` for a damaged log, no scene, several topics without a choice, or no entity with a position.
    """
    scenes: dict[str, _TopicContent] = {}
    transforms: list[tuple[pa.Array, Times]] = []
    findings: list[QualityFinding] = []
    parts: list[Container] = []
    unread = UnreadTopics()
    for file in bag.bag_files(path):
        container = recorded_file(file)
        for name, log_messages in message_batches(container, partial(_readable_message_type, topic, unread)):
            channel = log_messages[0].channel
            schema = container.schemas[channel.schema_id]
            decoded, readable = decode_readable_and_record_losses(
                container, log_messages, partial(decoded_rows, file, schema)
            )
            if decoded is None:
                continue
            log_ns = np.array([log_message.log_time_ns for log_message in readable], np.int64)
            if name == SCENE:
                _add_messages(scenes.setdefault(channel.topic, _TopicContent()), decoded, log_ns)
            elif name == TRANSFORM:
                transforms.append((decoded, log_ns))
            else:
                inner, parent = list_items_and_row_indices(decoded, "transforms")
                transforms.append((inner, log_ns[parent]))
        findings += container.findings
        parts.append(container)
    findings += bag.missing_message_findings(path, parts, lambda _, kind: kind in FIELD_TREES)
    name = _choose_scene_topic(path, scenes, topic, unread)
    recording = _recording(path, name, scenes[name], transforms, [*findings, *unread.findings()])
    recording.lost_times += lost_times_of_parts([(part.path, part.losses) for part in parts])
    return recording


def _readable_message_type(topic: str | None, unread: UnreadTopics, channel: Channel, schema: Schema) -> str | None:
    if schema.name not in FIELD_TREES:
        return None
    if channel.message_encoding in {"protobuf", "json"}:
        return schema.name
    if schema.name != SCENE or topic in {None, channel.topic}:
        unread.add(channel, schema.name)
    return None


def _choose_scene_topic(path: Path, scenes: dict[str, _TopicContent], topic: str | None, unread: UnreadTopics) -> str:
    names = sorted(scenes)
    if topic is not None:
        if topic not in scenes:
            raise TraceError(f"{path}: no scene on topic {topic!r}: {SCENE} is on {name_list(names) or 'none'}")
        return topic
    unread.refuse_kinds(path, {SCENE}, names)
    if len(names) != 1:
        several = f"on {len(names)} topics ({', '.join(names)}): choose one with --topic"
        silent = "" if names else silent_topics_text(bag.bag_files(path), SCENE.__eq__)
        raise TraceError(f"{path}: {SCENE} {several if names else 'in none of its messages'}{silent and f': {silent}'}")
    return names[0]


def _add_messages(scene: _TopicContent, decoded: pa.StructArray, log_ns: Times) -> None:
    entities, message = list_items_and_row_indices(decoded, "entities")
    classes = _class_codes(entities)
    place, turn, size, has_body = _bodies(entities, classes)
    scene.without_box += int((~has_body).sum())
    entities = entities.filter(pa.array(has_body))
    scene.rows.append(
        recorded_poses(
            times(struct_field(entities, "timestamp")),
            (place[has_body], turn[has_body]),
            log_ns=log_ns[message[has_body]],
            ids=_text_as_bytes(entities, "id"),
            frames=_text_as_bytes(entities, "frame_id"),
            size=size[has_body],
            classes=classes[has_body],
            lifetime_ns=times(struct_field(entities, "lifetime"))[0],
            locked=pc.fill_null(struct_field(entities, "frame_locked").cast(pa.bool_()), False).to_numpy(
                zero_copy_only=False
            ),
        )
    )
    deletions, message = list_items_and_row_indices(decoded, "deletions")
    if len(deletions):
        t_ns, timed = times(struct_field(deletions, "timestamp"))
        names, name_index = distinct_texts(deletions, "id")
        every = np.nan_to_num(numbers(deletions, "type")) == DELETE_ALL
        deleted_ids = [None if is_of_all else names[i] for i, is_of_all in zip(name_index, every, strict=True)]
        scene.deletions.append((t_ns, timed & (t_ns != 0), log_ns[message], deleted_ids))


def _bodies(entities: pa.Array, classes: Codes) -> tuple[Vectors, Vectors, Vectors, Mask]:
    """Return places, quaternions and sizes of entities (n, 3 or 4), and for each whether it has a body; NaN: not known.

    A body is the first cube or, of an entity with a class, the first other body. A model has no size: its file is not in the log.
    """
    n = len(entities)
    place, turn, size = (np.full((n, columns), np.nan) for columns in (3, 4, 3))
    has_body = np.zeros(n, np.bool_)
    for name in ("cubes", *_BODIES_OF_CLASSED_ENTITIES):
        items, parent = list_items_and_row_indices(entities, name)
        rows, first = np.unique(parent, return_index=True)
        is_body = ~has_body[rows] if name == "cubes" else ~has_body[rows] & (classes[rows] >= 0)
        rows, items = rows[is_body], items.take(pa.array(first[is_body]))
        pose = struct_field(items, "pose")
        place[rows], turn[rows] = vectors(pose, "position"), vectors(pose, "orientation", "xyzw")
        size[rows] = vectors(items, "size")
        has_body[rows] = True
    return place, turn, size, has_body


def _text_as_bytes(entities: pa.Array, name: str) -> NDArray[np.bytes_]:
    texts, text_index = distinct_texts(entities, name)
    return np.array([text.encode() for text in texts] or [b""])[text_index]


def _class_codes(entities: pa.Array) -> Codes:
    """Return the classes of entities, from the first metadata entry with a key of `CLASS_KEYS` and a known value; -1 without one."""
    codes = np.full(len(entities), -1, np.int8)
    pairs, parent = list_items_and_row_indices(entities, "metadata")
    if not len(pairs):
        return codes
    keys, key = distinct_texts(pairs, "key")
    telling = np.array([name.lower() in CLASS_KEYS for name in keys], np.bool_)[key]
    values, value = distinct_texts(pairs, "value")
    class_codes = np.array([class_code(text) for text in values], np.int8)[value]
    rows = np.flatnonzero(telling & (class_codes >= 0))[::-1]
    codes[parent[rows]] = class_codes[rows]
    return codes


def _recording(
    path: Path,
    topic: str,
    scene: _TopicContent,
    transforms: list[tuple[pa.Array, Times]],
    findings: list[QualityFinding],
) -> Recording:
    rows = join_batches(scene.rows)
    has_id = rows.ids != b""
    lost_times: list[LostTime] = []
    if not has_id.all():
        n = int((~has_id).sum())
        message = f"{topic}: entities without an id: {n}: they are not judged"
        findings.append(QualityFinding("dropped_row", "error", message, n))
        lost_times = _lost_times(rows.take(~has_id), topic)
        rows = rows.take(has_id)
    if not len(rows):
        raise TraceError(f"{path}: no entity on {topic!r} has a cube and an id: nothing can be judged")
    if scene.without_box:
        message = (
            f"{topic}: entities without a cube: {scene.without_box}: they are not treated as road users, as they have no class, or no "
            "cylinder, sphere or model either"
        )
        findings.append(QualityFinding("no_box", "info", message, scene.without_box))
    own_times = set_times_and_return_are_own_times({topic: rows}, findings)
    frames = _transform_tree(transforms, own_times=own_times)
    rows = with_states_between_updates(rows, _deletions(scene, rows, own_times=own_times), findings, topic)
    fixed = fixed_frame(frames, sorted(distinct_values(rows.frames)[0]))
    states, frame_findings = states_in_fixed_frame(rows, frames, fixed, topic)
    findings += frame_findings
    if not np.isfinite(states.numbers["x_m"]).any():
        raise TraceError(
            f"{path}: nothing can be placed: {frame_findings[-1].message if frame_findings else 'no positions'}"
        )
    recording = Recording("foxglove-mcap", states, findings=findings, lost_times=lost_times)
    recording.fixed_frame = fixed
    recording.notes = [f"positions are in the frame {fixed!r}"]
    recording.frame_times, recording.utc_start_ns = frame_times_and_start([rows])
    return recording


def _lost_times(nameless: RecordedPoses, topic: str) -> list[LostTime]:
    """Return the time ranges of entities without an id: from the message to the end of the lifetime (no lifetime: no end)."""
    times = zip(nameless.log_ns.tolist(), np.asarray(nameless.lifetime_ns).tolist(), strict=True)
    spans = {(log_ns - 1, log_ns + lifetime_ns + 1 if lifetime_ns > 0 else None) for log_ns, lifetime_ns in times}
    endless = min((since for since, until in spans if until is None), default=None)
    ended = sorted((since, until) for since, until in spans if until is not None)
    cause = f"{topic}: an entity without an id"
    lost_times = [LostTime(since, until, cause) for since, until in ended if endless is None or since < endless]
    return lost_times if endless is None else [*lost_times, LostTime(endless, None, cause)]


def _deletions(scene: _TopicContent, rows: RecordedPoses, *, own_times: bool) -> tuple[Times, list[str | None]]:
    """Return times and ids (None: all) of deletions, in the clock of the entities.

    A deletion without a time gets the latest time of the entities before it in the log.
    """
    order = np.argsort(rows.log_ns, kind="stable")
    log_ns, latest = rows.log_ns[order], np.maximum.accumulate(rows.t_ns[order])
    times, ids = [np.zeros(0, np.int64)], []
    for t_ns, timed, sent_ns, deleted_ids in scene.deletions:
        at = np.searchsorted(log_ns, sent_ns, side="right") - 1
        last = np.where(at >= 0, latest[np.maximum(at, 0)], np.iinfo(np.int64).min)
        times.append(np.where(timed & own_times, t_ns, last if own_times else sent_ns))
        ids += deleted_ids
    return np.concatenate(times), ids


def _transform_tree(transforms: list[tuple[pa.Array, Times]], *, own_times: bool) -> TransformTree:
    """Return the tree of all transforms. A transform that never changes is static: some logs contain it only once, at the start."""
    parts_by_frames: dict[tuple[str, str], list[tuple[Times, Any, Any]]] = {}
    for rows, log_ns in transforms:
        t_ns = times(struct_field(rows, "timestamp"))[0] if own_times else log_ns
        place, turn = vectors(rows, "translation"), vectors(rows, "rotation", "xyzw")
        parents, parent = distinct_texts(rows, "parent_frame_id")
        children, inner = distinct_texts(rows, "child_frame_id")
        for i, j in sorted(set(zip(inner.tolist(), parent.tolist(), strict=True))):
            here = (inner == i) & (parent == j)
            names = clean_frame_name(children[i]), clean_frame_name(parents[j])
            parts_by_frames.setdefault(names, []).append((t_ns[here], place[here], turn[here]))
    frames = TransformTree()
    for (name, parent_name), parts in parts_by_frames.items():
        t_ns, place, turn = (np.concatenate([part[k] for part in parts]) for k in range(3))
        same = bool((place == place[0]).all() and (turn == turn[0]).all())
        frames.add(name, parent_name, t_ns, Poses(place, unit_quaternions(turn)), static=same)
    return frames
