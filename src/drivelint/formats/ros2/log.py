"""The content of a ROS 2 log by message type and topic, and the choice of a topic if there are several."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.errors import TraceError
from drivelint.formats.mcap.bag import missing_message_findings
from drivelint.formats.mcap.losses import lost_times_of_parts
from drivelint.formats.mcap.malformed import decode_readable_and_record_losses
from drivelint.formats.mcap.reader import message_batches
from drivelint.formats.mcap.storage import recorded_file
from drivelint.formats.mcap.unread import UnreadTopics
from drivelint.formats.ros2 import traffic_lights
from drivelint.formats.ros2.cdr import Decoder
from drivelint.formats.ros2.messages import (
    DETECTED_OBJECTS,
    EGO_SIZE_ROLE,
    LIGHT_GROUPS,
    MESSAGE_TYPES,
    ODOMETRY,
    OLD_LIGHT_GROUPS,
    TRANSFORMS,
)
from drivelint.formats.ros2.objects import MESSAGE_TYPES_OF_SAME_OBJECTS, OBJECT_CONVERTERS, stamps
from drivelint.formats.ros2.silence import MESSAGE_TYPES_SENT_EVEN_WITHOUT_OBJECTS, silences
from drivelint.formats.ros2.types import message_kind
from drivelint.formats.sqlite_bag.reader import CONVERSION_REMEDY, SqliteFile
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from mcap.records import Channel, Schema

    from drivelint.arrays import Mask, Times
    from drivelint.drive.trace import LostTime, QualityFinding
    from drivelint.formats.mcap.reader import Container
    from drivelint.formats.ros2.cdr import Table
    from drivelint.formats.ros2.recorded_poses import RecordedPoses

TRAFFIC_LIGHT_MESSAGE_TYPES: Final = (LIGHT_GROUPS, OLD_LIGHT_GROUPS)
_CARLA = "carla_msgs/"
Topics = dict[str, list[Any]]
"""Topic -> the decoded content of each batch of its messages."""


class Log:
    """The decoded messages of a drive. `requested_topics`: the topics that the user chose."""

    def __init__(self, path: Path, requested_topics: list[str]) -> None:
        self.path = path
        self.requested_topics = requested_topics
        self.topics: dict[str, Topics] = {}  # by message type
        self.n_detections: dict[str, int] = {}  # topic of detections without ids -> number of messages
        self.findings: list[QualityFinding] = []
        self.notes: list[str] = []
        self.lost_times: list[LostTime] = []
        self.unread = UnreadTopics()
        # odometry and transforms without a definition, in a log of which the user chose another topic
        self.undefined_ego = UnreadTopics()
        self.has_carla_messages = False
        self.is_sqlite = False
        self.ego_frame = ""  # the frame that places the ego, in a log without odometry
        self.why_no_ego = ""  # why neither odometry nor transforms place the ego
        self._times: dict[str, list[tuple[Times, Mask, Times]]] = {}

    def read(self, files: Iterable[Path]) -> None:
        """Read the files of a drive. Errors: `TraceError` for damaged files and invalid message definitions."""
        parts: list[Container] = []
        for file in files:
            container = recorded_file(file)
            decoders: dict[int, Decoder] = {}
            for kind, log_messages in message_batches(container, partial(self._kind_if_read, file, decoders)):
                channel = log_messages[0].channel
                decoder = decoders[channel.schema_id]
                table, readable = decode_readable_and_record_losses(container, log_messages, decoder.table)
                if table is None:
                    continue
                log_ns = np.array([log_message.log_time_ns for log_message in readable], np.int64)
                batches = self.topics.setdefault(kind, {}).setdefault(channel.topic, [])
                batches.append(_batch_content(kind, decoder, table, log_ns))
                if kind in OBJECT_CONVERTERS or kind == ODOMETRY:
                    self._times.setdefault(channel.topic, []).append((*stamps(table, "header.stamp"), log_ns))
            self.has_carla_messages |= any(schema.name.startswith(_CARLA) for schema in container.schemas.values())
            self.findings += container.findings
            if isinstance(container, SqliteFile):
                self.is_sqlite = True
                read_kinds = {container.schemas[number].name for number in decoders}
                if kinds := sorted(container.assumed_kinds & read_kinds):
                    self.notes.append(
                        f"{file.name} has no message definitions: those of drivelint are used for {name_list(kinds)}"
                    )
            parts.append(container)
        if not set(self.requested_topics).isdisjoint(self.topics.get(ODOMETRY, ())):
            self.undefined_ego.discard(ODOMETRY)  # the user chose other odometry
        self.findings += [
            *missing_message_findings(self.path, parts, lambda _, kind: kind in MESSAGE_TYPES),
            *self.unread.findings(),
            *self.undefined_ego.findings(),
        ]
        self.lost_times = lost_times_of_parts([(part.path, part.losses) for part in parts])

    def _kind_if_read(self, path: Path, decoders: dict[int, Decoder], channel: Channel, schema: Schema) -> str | None:
        """Return the message type of a channel, and add its decoder to `decoders`; None for a channel that is not read."""
        kind = message_kind(schema.name)
        if kind == DETECTED_OBJECTS:
            self.n_detections[channel.topic] = self.n_detections.get(channel.topic, 0) + 1
            return None
        if kind not in MESSAGE_TYPES:
            return None
        if MESSAGE_TYPES[kind].role == EGO_SIZE_ROLE and (channel.message_encoding, schema.encoding) != (
            "cdr",
            "ros2msg",
        ):
            return None  # without these messages only the ego's size is unknown, so nothing is reported
        if channel.message_encoding != "cdr":
            if kind not in OBJECT_CONVERTERS or not self.requested_topics or channel.topic in self.requested_topics:
                self.unread.add(channel, kind)
            return None
        if channel.schema_id not in decoders:
            if not self._is_defined(path, channel, schema, kind):
                return None
            decoders[channel.schema_id] = Decoder(path, schema, MESSAGE_TYPES[kind].fields)
        return kind

    def _is_defined(self, path: Path, channel: Channel, schema: Schema, kind: str) -> bool:
        """Return whether a channel that is read has a message definition.

        Without it, road users and poses of the ego are an error, or if the user chose another topic, poses of the ego are reported.
        """
        if schema.encoding:
            if schema.encoding != "ros2msg":
                raise TraceError(
                    f"{path}: {schema.name} has a definition of the kind {schema.encoding}, but only "
                    "ros2msg is supported: record or convert the log with message definitions"
                )
            return True
        if kind not in {*OBJECT_CONVERTERS, ODOMETRY, TRANSFORMS}:
            self.unread.add_undefined(channel, schema.name)
        elif not self.requested_topics or channel.topic in self.requested_topics:
            raise TraceError(
                f"{path}: the log has no message definition of {schema.name} on {channel.topic!r}, and none is known: {CONVERSION_REMEDY}"
            )
        elif kind not in OBJECT_CONVERTERS:
            self.undefined_ego.add_undefined(channel, kind)
        return False

    def refuse_unread_topics(self) -> None:
        """Raise `TraceError` if a topic that the user chose is not read."""
        read_topics = {topic for topics in self.topics.values() for topic in topics}
        for topic in self.requested_topics:
            if topic in self.n_detections:
                raise TraceError(
                    f"{self.path}: the detections on topic {topic!r} have no ids, so they form no tracks: choose a topic of "
                    f"{' or '.join(MESSAGE_TYPES_OF_SAME_OBJECTS)}"
                )
            if topic not in read_topics:
                raise TraceError(
                    f"{self.path}: topic {topic!r} has no messages that can be read: topics that can be read: "
                    f"{name_list(sorted(read_topics)) or 'none'}"
                )

    def times_of_topics(self, topics: Iterable[str], *, own_times: bool) -> Times:
        """Return the times of all messages on the given topics of road users or odometry, including messages without objects.

        `own_times`: the messages' stamps, otherwise log times.
        """
        parts = [part for topic in topics for part in self._times.get(topic, ())]
        times = [stamp_ns[stamped & (stamp_ns != 0)] if own_times else log_ns for stamp_ns, stamped, log_ns in parts]
        return np.concatenate([np.zeros(0, np.int64), *times])

    def add_times(self, topic: str, rows: RecordedPoses) -> None:
        """Count rows that are not messages of their own, such as transforms of the ego, as messages of a topic."""
        self._times.setdefault(topic, []).append((rows.stamp_ns, rows.stamped, rows.log_ns))

    def silences(self, objects: Iterable[str], odometry: Iterable[str]) -> Iterator[LostTime]:
        """Yield the times in which a topic of road users has no messages, if its sender also sends messages without objects."""
        steady = {topic for kind in MESSAGE_TYPES_SENT_EVEN_WITHOUT_OBJECTS for topic in self.topics.get(kind, ())}
        for topic in sorted(steady.intersection(objects)):
            sent_ns, own_ns = (self.times_of_topics(topics, own_times=False) for topics in ([topic], odometry))
            yield from silences(topic, sent_ns, own_ns)

    def batches(self, kind: str) -> Iterator[tuple[str, Any]]:
        """Yield topic and batch content of the messages of a type, sorted by topic."""
        for topic, parts in sorted(self.topics.get(kind, {}).items()):
            yield from ((topic, part) for part in parts)

    def select_topic(self, kinds: Iterable[str], content: str) -> Topics:
        """Return the one topic with messages of `kinds`, or none; a note lists the topics that are left out.

        Of several topics, the user's choice wins, then the usual topic of the type. Predictions win over tracks of the same objects.
        Errors: `TraceError` if several topics remain.
        """
        topics_by_kind = {kind: self.topics[kind] for kind in kinds if kind in self.topics}
        candidates = {topic: parts for topics in topics_by_kind.values() for topic, parts in topics.items()}
        selection = [topic for topic in self.requested_topics if topic in candidates]
        if not selection:
            selection = [usual] if (usual := _default_topic(topics_by_kind)) else sorted(candidates)
            if usual and len(candidates) > 1:
                left = name_list(sorted(candidates.keys() - {usual}))
                self.notes.append(
                    f"{content}: topic {usual} is read, {left} is not read: --topic chooses another topic"
                )
        if len(selection) > 1:
            raise TraceError(
                f"{self.path}: {content} on {len(selection)} topics ({', '.join(selection)}): choose with --topic (several: A,B)"
            )
        return {topic: candidates[topic] for topic in selection}


def _batch_content(kind: str, decoder: Decoder, table: Table, log_ns: Times) -> Any:
    """Return the content of a batch: rows for road users, group states for traffic lights, otherwise fields and log times."""
    if kind in TRAFFIC_LIGHT_MESSAGE_TYPES:
        return traffic_lights.group_states(table, log_ns, decoder.constants)
    if kind not in OBJECT_CONVERTERS:
        return table, log_ns
    rows = OBJECT_CONVERTERS[kind](table)
    rows.log_ns = log_ns[rows.log_ns]
    return rows


def _default_topic(topics_by_kind: dict[str, Topics]) -> str | None:
    """Return the topic to read by default: the only topic of its type, or the type's usual topic; None if it is not clear."""
    bodies = len(topics_by_kind.keys() & set(MESSAGE_TYPES_OF_SAME_OBJECTS))
    if len(topics_by_kind) > max(bodies, 1):
        return None
    for kind, topics in topics_by_kind.items():
        if len(topics) == 1:
            return next(iter(topics))
        if MESSAGE_TYPES[kind].topic in topics:
            return MESSAGE_TYPES[kind].topic
    return None
