"""ROS 2 logs in MCAP: road users, odometry, transforms and the rest, each found by its schema's name, never by its topic."""

from __future__ import annotations

from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import QualityFinding, Recording, States, single_map
from drivelint.errors import TraceError
from drivelint.formats.coordinate_frames import TransformTree, fixed_frame
from drivelint.formats.mcap import bag
from drivelint.formats.mcap.losses import times_of_parts
from drivelint.formats.mcap.malformed import decode_readable
from drivelint.formats.mcap.reader import Container, message_batches
from drivelint.formats.mcap.unread import UnreadTopics
from drivelint.formats.ros2 import ego as ros_ego
from drivelint.formats.ros2 import objects as ros_objects
from drivelint.formats.ros2.cdr import Decoder
from drivelint.formats.ros2.merge import merge_ego
from drivelint.formats.ros2.objects import OBJECT_ROWS, stamps
from drivelint.formats.ros2.recorded_poses import (
    RecordedPoses,
    choose_clock,
    distinct,
    join_batches,
    message_times,
    states_in_fixed_frame,
)
from drivelint.formats.ros2.silence import SENT_WHERE_NOBODY_IS, silences
from drivelint.formats.ros2.types import message_kind
from drivelint.phrases import listed

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from mcap.records import Channel, Schema
    from numpy.typing import NDArray

    from drivelint.arrays import Mask, Times
    from drivelint.drive.trace import IngestOptions, LostTime
    from drivelint.formats.ros2.cdr import Table

STATIC_TOPIC_SUFFIX = "tf_static"
"""What the topic of transforms that always hold ends with: nothing in the messages says it."""
TOPICS_APART_NS = 1_000_000_000
"""A recorder finds one topic after the other: one may begin, and end, a second before the other."""
_REPORTS = {
    ros_ego.TURN_INDICATORS: "report", ros_ego.HAZARD_LIGHTS: "report", ros_ego.CONTROL_MODE: "mode", ros_ego.ENGAGE: "engage",
}  # fmt: skip
"""Reports of the ego -> the field that says it."""
_FIELD_TREES = ros_ego.FIELD_TREES | ros_objects.FIELD_TREES
_CARLA = "carla_msgs/"
_NO_ROAD_USERS = QualityFinding(
    "no_road_users",
    "warning",
    "no topic of this log has road users: rules that look at others than the ego are unknown",
)


Topics = dict[str, list[Any]]
"""Topic -> what was read of each batch of its messages."""


class _Log:
    """Everything that is read of a drive, topic by topic."""

    def __init__(self, path: Path, asked: list[str], forward_m: float) -> None:
        self.path = path
        self.asked = asked  # topics
        self.topics: dict[str, Topics] = {}  # by the type of their messages
        self.findings: list[QualityFinding] = []
        self.lost: list[LostTime] = []
        self.unread = UnreadTopics()
        self.carla = False
        self._times: dict[str, list[tuple[Times, Mask, Times]]] = {}
        self._forward_m = forward_m

    def read(self, files: Iterable[Path]) -> None:
        parts: list[Container] = []
        for file in files:
            container = Container(file, salvage=True)
            decoders: dict[int, Decoder] = {}
            for kind, packets in message_batches(container, partial(self._kind, file, decoders)):
                channel = packets[0].channel
                table, readable = decode_readable(container, packets, decoders[channel.schema_id].table)
                if table is None:
                    continue
                log_ns = np.array([packet.log_time_ns for packet in readable], np.int64)
                read = self.topics.setdefault(kind, {}).setdefault(channel.topic, [])
                read.append(self._part(kind, table, log_ns))
                if kind in OBJECT_ROWS or kind == ros_ego.ODOMETRY:
                    self._times.setdefault(channel.topic, []).append((*stamps(table, "header.stamp"), log_ns))
            self.carla |= any(schema.name.startswith(_CARLA) for schema in container.schemas.values())
            self.findings += container.findings
            parts.append(container)
        self.findings += [*bag.missing_messages(self.path, parts, _FIELD_TREES.__contains__), *self.unread.findings()]
        self.lost = times_of_parts([(part.path, part.losses) for part in parts])

    def _kind(self, path: Path, decoders: dict[int, Decoder], channel: Channel, schema: Schema) -> str | None:
        """Return the type of ROS messages that are read on a channel, its decoder made; None for any other."""
        kind = message_kind(schema.name)
        if kind not in _FIELD_TREES:
            return None
        if channel.message_encoding != "cdr":
            if kind not in OBJECT_ROWS or not self.asked or channel.topic in self.asked:
                self.unread.add(channel, kind)
            return None
        if channel.schema_id not in decoders:
            if schema.encoding != "ros2msg":
                raise TraceError(
                    f"{path}: {schema.name} is described by {schema.encoding or 'nothing'}: only ros2msg is read: record or "
                    "convert it with message definitions"
                )
            decoders[channel.schema_id] = Decoder(path, schema, _FIELD_TREES[kind])
        return kind

    def _part(self, kind: str, table: Table, log_ns: Times) -> Any:
        if kind == ros_ego.ODOMETRY:
            return ros_ego.odometry(table, log_ns, self._forward_m)
        if kind not in OBJECT_ROWS:
            return table, log_ns
        rows = OBJECT_ROWS[kind](table)
        rows.log_ns = log_ns[rows.log_ns]
        return rows

    def frames(self, topics: Iterable[str], *, own_times: bool) -> Times:
        """Return the times of the messages of some topics of poses, those in which nobody is among them."""
        parts = [part for topic in topics for part in self._times.get(topic, ())]
        times = [stamp_ns[stamped & (stamp_ns != 0)] if own_times else log_ns for stamp_ns, stamped, log_ns in parts]
        return np.concatenate([np.zeros(0, np.int64), *times])

    def silences(self, objects: Iterable[str], odometry: Iterable[str]) -> Iterator[LostTime]:
        """Yield when a topic of road users is silent that also sends where nobody is."""
        steady = {topic for kind in SENT_WHERE_NOBODY_IS for topic in self.topics.get(kind, ())}
        for topic in sorted(steady.intersection(objects)):
            sent_ns, own_ns = (self.frames(topics, own_times=False) for topics in ([topic], odometry))
            yield from silences(topic, sent_ns, own_ns)

    def parts(self, kind: str) -> Iterator[tuple[str, Any]]:
        """Yield topic and batch of the messages of a kind, by topic."""
        for topic, parts in sorted(self.topics.get(kind, {}).items()):
            yield from ((topic, part) for part in parts)

    def one(self, kinds: Iterable[str], what: str) -> Topics:
        """Return the one topic with messages of some kinds, if any. Errors: `TraceError` where there are several, none asked for."""
        found = {topic: parts for kind in kinds for topic, parts in self.topics.get(kind, {}).items()}
        chosen = [topic for topic in self.asked if topic in found] or sorted(found)
        if len(chosen) > 1:
            raise TraceError(
                f"{self.path}: {what} on {len(chosen)} topics ({', '.join(chosen)}): choose with --topic (several: A,B)"
            )
        return {topic: found[topic] for topic in chosen}


def read(path: Path, options: IngestOptions) -> Recording:
    """Read a file or a bag. Errors: `TraceError` for damage, for nothing that can be judged, for topics to choose from."""
    forward_m = 0.0 if options.ego_size is None else options.ego_size.forward_m
    asked = [] if options.topic is None else [part.strip() for part in options.topic.split(",")]
    log = _Log(path, asked, forward_m)
    log.read(bag.mcap_files(path))
    known = {topic for topics in log.topics.values() for topic in topics}
    for topic in asked:
        if topic not in known:
            raise TraceError(
                f"{path}: nothing that is read is on topic {topic!r}: there is {listed(sorted(known)) or 'nothing'}"
            )
    objects = log.one(OBJECT_ROWS, "road users")
    odometry = log.one([ros_ego.ODOMETRY], "odometry")
    log.unread.refuse(path, OBJECT_ROWS, objects or odometry)
    parts = {topic: join_batches(batches) for topic, batches in (objects | odometry).items()}
    if not sum(map(len, parts.values())):
        raise TraceError(
            f"{path}: no road users and no odometry in this ROS log: {', '.join(sorted(OBJECT_ROWS))} are read"
        )
    findings = log.findings
    findings += () if objects else (_NO_ROAD_USERS,)
    own_times = choose_clock(parts, findings)
    frames = TransformTree()
    for topic, (table, log_ns) in log.parts(ros_ego.TRANSFORMS):
        static = topic.endswith(STATIC_TOPIC_SUFFIX)
        ros_ego.add_transforms(frames, table, log_ns, static=static, own_times=own_times)
    for topic in objects:
        parts[topic] = _named(parts[topic], topic, log)
    used = [sorted(distinct(parts[topic].frames)[0]) for topic in (*odometry, *objects)]
    fixed = fixed_frame(frames, chain.from_iterable(used))
    states: dict[str, States] = {}
    for topic in (*objects, *odometry):
        states[topic], found = states_in_fixed_frame(parts[topic], frames, fixed, topic)
        findings += found
    if not any(np.isfinite(part.numbers["x_m"]).any() for part in states.values()):
        raise TraceError(f"{path}: nothing can be placed: {findings[-1].message if findings else 'no positions'}")
    others, own = (
        next(((topic, states[topic]) for topic in source if len(states[topic])), None) for source in (objects, odometry)
    )
    carla = log.carla and not objects.keys().isdisjoint(log.topics.get("derived_object_msgs/ObjectArray", ()))
    # the id of the ego that each topic of the CARLA bridge's ego info gives last
    infos = {
        topic: str(number)
        for topic, (table, _) in log.parts(ros_ego.EGO_INFO)
        for number in table.column("id").tolist()
    }
    recording = merge_ego(others, own, infos, findings, carla=carla, forward_m=forward_m)
    reports = _reports(log, own_times=own_times)
    for ego in recording.ego_ids[:1]:
        all_states = recording.states
        if ego in all_states.ids and reports.keys() & {ros_ego.TURN_INDICATORS, ros_ego.HAZARD_LIGHTS}:
            mine = all_states.actor == all_states.ids.index(ego)
            all_states.codes["indicator"] = np.full(len(all_states), -1, np.int8)
            all_states.codes["indicator"][mine] = ros_ego.indicators(all_states.t_ns[mine], reports)
        recording.events = ros_ego.engagement(reports, ego)
    maps: dict[bytes, str] = {}
    for topic, (table, _) in log.parts(ros_ego.WORLD_INFO):
        for text in filter(bytes.strip, table.column("opendrive").tolist()):
            maps.setdefault(text, topic)
    recording.lost = [*log.lost, *log.silences(objects, odometry)]
    recording.frames_ns, recording.ends_apart_ns = log.frames(parts, own_times=own_times), TOPICS_APART_NS
    recording.embedded_map, trouble = single_map(maps)
    recording.findings += trouble
    recording.frame_times, recording.utc_start_ns = message_times(list(parts.values()))
    recording.notes.append(f"positions are in the frame {fixed!r}")
    return recording


def _named(rows: RecordedPoses, topic: str, log: _Log) -> RecordedPoses:
    nameless = rows.ids == b"" if rows.ids.dtype.kind == "S" else np.zeros(len(rows), np.bool_)
    if not nameless.any():
        return rows
    n = int(nameless.sum())
    what = f"{topic}: objects without an id"
    finding = QualityFinding(
        "dropped_row", "error", f"{what}: {n}: they are not judged", n, int(rows.t_ns[nameless].min())
    )
    log.findings.append(finding)
    log.lost += times_of_lost_rows(rows.log_ns, np.ones(len(rows), np.bool_), nameless, what)
    return rows.take(~nameless)


def _reports(log: _Log, *, own_times: bool) -> dict[str, tuple[Times, NDArray[Any]]]:
    reports = {}
    for kind, column in _REPORTS.items():
        for parts in log.one([kind], kind.split("/")[1]).values():
            t_ns = [stamps(table, "stamp")[0] if own_times else log_ns for table, log_ns in parts]
            values = [table.column(column) for table, _ in parts]
            reports[kind] = (np.concatenate(t_ns), np.concatenate(values))
    return reports
