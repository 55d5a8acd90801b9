"""Reads ROS 2 messages of types that drivelint does not know, through a mapping with `[[ros]]`.

The mapping states the reference point of each topic's positions, as for tables. All positions are in one frame, which does not move.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa

from drivelint.drive.trace import EARLIEST_UTC_NS, LostTime, QualityFinding, Recording, States
from drivelint.errors import TraceError
from drivelint.formats.coordinate_frames import clean_frame_name
from drivelint.formats.mcap import bag
from drivelint.formats.mcap.bag import missing_message_findings
from drivelint.formats.mcap.malformed import decode_readable_and_record_losses
from drivelint.formats.mcap.reader import message_batches
from drivelint.formats.mcap.storage import recorded_file
from drivelint.formats.ros2 import topic_mapping
from drivelint.formats.ros2.cdr import Decoder
from drivelint.formats.ros2.ego_frame import EGO_FRAMES
from drivelint.formats.ros2.merge import concatenate_states
from drivelint.formats.ros2.objects import stamps
from drivelint.formats.ros2.silence import silences
from drivelint.formats.ros2.types import parse_definition, short_type_name
from drivelint.formats.sqlite_bag.definitions import definition_in_files
from drivelint.formats.tables import mapping as mappings
from drivelint.formats.tables.mapped_table import read_sheet
from drivelint.formats.tables.sheets import ParquetSheet
from drivelint.phrases import hint, name_list

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from mcap.records import Channel, Schema
    from numpy.typing import NDArray

    from drivelint.arrays import Times
    from drivelint.formats.mcap.reader import Container
    from drivelint.formats.probe import Probe
    from drivelint.formats.protobuf.descriptors import FieldTree
    from drivelint.formats.ros2.cdr import Table
    from drivelint.formats.ros2.topic_mapping import MappedTopic, RosMappingFile
    from drivelint.formats.ros2.types import Types

_MOST_TIME_BETWEEN_TOPICS_NS: Final = 1_000_000_000
_MOST_PROPOSED_FIELDS: Final = 500
_STAMP_MEMBERS: Final = ("sec", "nanosec", "nsec")


class MessageSheet(ParquetSheet):
    """The messages of a topic as a table: one row per message, or per item of its list."""

    def __init__(self, path: Path, table: pa.Table, other_names: Iterable[str]) -> None:
        """Take over a table. `other_names`: fields that are not read, which an error may propose."""
        self._path, self._table = path, table
        self.names = [*table.column_names, *other_names]
        self.bad_lines, self.zeros_at, self.has_content_after_zeros = [], None, False
        self.metadata = {}

    def load(self, names: Iterable[str]) -> int:  # noqa: ARG002 (all columns are loaded)
        """Return the number of rows."""
        return int(self._table.num_rows)


def read(probe: Probe) -> Recording:
    """Read the topics of the mapping. Errors: `TraceError` for a topic or a field that the log lacks; `UsageError` for the mapping."""
    path, file = probe.path, Path(probe.options.mapping or "")
    message_mapping = topic_mapping.load(file)
    messages = _MappedMessages(path, message_mapping, file.parent)
    for part in bag.bag_files(path):
        messages.read(part)
    messages.compare_topics()
    recordings = []
    for topic in message_mapping.ros:
        sheet = MessageSheet(path, messages.table(topic), messages.other_fields(topic))
        recordings.append(read_sheet(path, file.stem, message_mapping.table_mapping(topic), sheet))
    recording = recordings[0]
    _refuse_shared_ids(path, message_mapping, recordings)
    recording.names_indicator = any(topic_recording.names_indicator for topic_recording in recordings)
    for later in recordings[1:]:
        recording.states = concatenate_states(*_with_same_columns(recording.states, later.states))
        recording.findings += [finding for finding in later.findings if finding not in recording.findings]
        recording.lost_times += later.lost_times
    if not len(recording.states):
        raise TraceError(
            f"{path}: no actor on {', '.join(topic.topic for topic in message_mapping.ros)}: nothing can be judged"
        )
    recording.findings += messages.findings
    recording.lost_times += messages.lost_times
    recording.frames_ns, recording.ends_apart_ns = messages.message_times(), _MOST_TIME_BETWEEN_TOPICS_NS
    first = int(recording.frames_ns.min())
    recording.utc_start_ns = first if first >= EARLIEST_UTC_NS else None
    recording.format = file.stem
    recording.notes.append(f"read through the mapping {file.name!r}: all positions are taken to be in one frame")
    return recording


class _MappedMessages:
    """The decoded fields of the topics of a mapping."""

    def __init__(self, path: Path, message_mapping: RosMappingFile, folder: Path) -> None:
        self._path, self._message_mapping = path, message_mapping
        self._definitions = None if message_mapping.message_files is None else folder / message_mapping.message_files
        self._topics = {topic.topic: topic for topic in message_mapping.ros}
        self._trees = {topic.topic: _decoded_fields(topic, message_mapping) for topic in message_mapping.ros}
        self._parts: dict[str, list[tuple[Table, Times]]] = {}
        self._fields: dict[str, list[str]] = {}
        self._containers: list[Container] = []
        self.findings: list[QualityFinding] = []
        self.lost_times: list[LostTime] = []

    def read(self, file: Path) -> None:
        """Decode a file of the log."""
        container = recorded_file(file)
        decoders: dict[tuple[str, int], Decoder] = {}

        def mapped_topic(channel: Channel, schema: Schema) -> str | None:
            if channel.topic in self._topics and (channel.topic, channel.schema_id) not in decoders:
                decoders[channel.topic, channel.schema_id] = self._decoder(file, channel, schema)
            return channel.topic if channel.topic in self._topics else None

        for topic, log_messages in message_batches(container, mapped_topic):
            decoder = decoders[topic, log_messages[0].channel.schema_id]
            table, _ = decode_readable_and_record_losses(container, log_messages, decoder.table)
            if table is not None:
                self._parts.setdefault(topic, []).append((table, self._times(topic, table)))
        self._containers.append(container)
        self._add_losses(container)

    def compare_topics(self) -> None:
        """Compare the topics, after all files: messages that are missing, and topics of road users that are silent while others continue.

        Errors: `TraceError` if the topics have different clocks or frames.
        """
        times = {topic: np.concatenate([t_ns for _, t_ns in parts]) for topic, parts in self._parts.items()}
        if (
            times
            and max(t_ns.min() for t_ns in times.values())
            > min(t_ns.max() for t_ns in times.values()) + _MOST_TIME_BETWEEN_TOPICS_NS
        ):
            raise TraceError(
                f"{self._path}: the times of {name_list(sorted(times))} do not overlap: name other fields with time"
            )
        self._refuse_different_frames()
        missing_messages = missing_message_findings(
            self._path, self._containers, lambda topic, _: topic in self._topics
        )
        self.findings += missing_messages
        self.lost_times += [LostTime(None, None, finding.message) for finding in missing_messages]
        for topic, t_ns in times.items():
            times_of_others = [other_ns for name, other_ns in times.items() if name != topic]
            if self._topics[topic].items is not None and times_of_others:
                self.lost_times += silences(topic, t_ns, np.concatenate(times_of_others))

    def _times(self, topic: str, table: Table) -> Times:
        """Return the times of a batch. Errors: `TraceError` if a message has none, or its unit is not known."""
        field = self._topics[topic].time
        t_ns, stamped = stamps(table, field)
        if not stamped.all():
            raise TraceError(f"{self._path}: topic {topic!r} has no time {field!r}: set time")
        if field in table.columns and table.columns[field].dtype.kind != "f":
            raise TraceError(
                f"{self._path}: topic {topic!r}: {field!r} is a whole number, whose unit is not known: set time to a field of "
                "builtin_interfaces/Time, or of seconds as a floating-point number"
            )
        if (t_ns <= 0).any() and t_ns.max() >= EARLIEST_UTC_NS:
            raise TraceError(
                f"{self._path}: topic {topic!r} has messages whose {field!r} is 0: name another field with time"
            )
        return t_ns

    def _refuse_different_frames(self) -> None:
        """Raise `TraceError` if the messages name several frames, or a frame of the vehicle: transforms are not applied."""
        if self._message_mapping.one_frame:
            return
        recorded = {
            clean_frame_name(frame.decode("utf-8", "replace"))
            for topic, parts in self._parts.items()
            for table, _ in parts
            for frame in np.unique(table.columns.get(_frame_field(self._topics[topic]), np.zeros(0, "S1"))).tolist()
        } - {""}
        if len(recorded) > 1 or any(frame.rsplit("/", maxsplit=1)[-1] in EGO_FRAMES for frame in recorded):
            raise TraceError(
                f"{self._path}: positions are in {name_list(sorted(recorded))} by the messages, but a mapping needs one fixed frame: "
                "publish them in map or odom, or set one_frame = true in the mapping if they are in one nevertheless"
            )

    def table(self, topic: MappedTopic) -> pa.Table:
        """Return the rows of a topic. Errors: `TraceError` if the log has no message on it."""
        if topic.topic not in self._parts:
            suggestion = hint(topic.topic, bag.kinds_by_topic(self._path))
            raise TraceError(
                f"{self._path}: no message on topic {topic.topic!r}, which the mapping names: {suggestion}"
            )
        rows = [_batch_rows(self._path, topic, table, t_ns) for table, t_ns in self._parts[topic.topic]]
        try:
            return pa.concat_tables(rows, promote_options="default")
        except pa.ArrowInvalid as error:
            raise TraceError(
                f"{self._path}: topic {topic.topic!r} has messages of several types, whose fields differ: give a log with one of them"
            ) from error

    def other_fields(self, topic: MappedTopic) -> list[str]:
        """Return the fields of a topic's actors that the mapping does not name."""
        prefix = f"{topic.items}." if topic.items else ""
        of_actor = [name.removeprefix(prefix) for name in self._fields[topic.topic] if name.startswith(prefix)]
        columns = set(mappings.needed_columns(self._message_mapping.table_mapping(topic)))
        return [name for name in of_actor if name not in columns]

    def message_times(self) -> Times:
        """Return the times of all messages, also of those without actors."""
        return np.concatenate([t_ns for parts in self._parts.values() for _, t_ns in parts])

    def _decoder(self, file: Path, channel: Channel, schema: Schema) -> Decoder:
        if not schema.encoding and self._definitions is not None:
            text = definition_in_files(self._definitions, short_type_name(schema.name))
            schema = replace(schema, encoding="ros2msg", data=text.encode())
        if (channel.message_encoding, schema.encoding) != ("cdr", "ros2msg"):
            encoding = f"{channel.message_encoding or 'none'} with definitions in {schema.encoding or 'no language'}"
            raise TraceError(
                f"{file}: topic {channel.topic!r} ({schema.name}) is in {encoding}: a mapping reads cdr with ros2msg: set "
                "message_files in the mapping, the folder of PACKAGE/msg/NAME.msg, or convert the log with ros2 bag convert "
                "and storage_id: mcap where ROS and its packages are installed"
            )
        types = parse_definition(file, schema.name, schema.data)
        self._fields[channel.topic] = list(
            islice(_field_paths(types, short_type_name(schema.name), ""), _MOST_PROPOSED_FIELDS)
        )
        return Decoder(file, schema, self._trees[channel.topic])

    def _add_losses(self, container: Container) -> None:
        """Add the findings of a file; what it lost may be of any time, because its log times are not those of the messages."""
        self.findings += container.findings
        for lost_time in container.losses.lost_times(container.path):
            self.lost_times.append(lost_time._replace(since_ns=None, until_ns=None))


def _frame_field(topic: MappedTopic) -> str:
    """Return the field with the name of the frame, beside the time in a header."""
    return f"{topic.time.rpartition('.')[0]}.frame_id".removeprefix(".")


def _refuse_shared_ids(path: Path, message_mapping: RosMappingFile, recordings: Sequence[Recording]) -> None:
    """Raise `TraceError` if two topics have actors with the same id: their states would become one track."""
    topic_by_id: dict[str, str] = {}
    for topic, recording in zip(message_mapping.ros, recordings, strict=True):
        for actor_id in recording.states.ids:
            if actor_id in topic_by_id:
                raise TraceError(
                    f"{path}: the topics {topic_by_id[actor_id]!r} and {topic.topic!r} both have an actor {actor_id!r}: "
                    "map one of them, or a field whose ids differ"
                )
            topic_by_id[actor_id] = topic.topic


def _field_paths(types: Types, kind: str, prefix: str) -> Iterator[str]:
    """Yield the paths of the fields of a message and of the messages in it."""
    for member in types[kind]:
        if member.kind in types:
            yield from _field_paths(types, member.kind, f"{prefix}{member.name}.")
        elif member.count is None:
            yield f"{prefix}{member.name}"


def _decoded_fields(topic: MappedTopic, message_mapping: RosMappingFile) -> FieldTree:
    """Return the fields of a message that are decoded."""
    names = [
        name
        for name in mappings.needed_columns(message_mapping.table_mapping(topic))
        if name != topic_mapping.TIME_COLUMN
    ]
    prefix = f"{topic.items}." if topic.items else ""
    tree: dict[str, Any] = {}
    times = [f"{topic.time}.{part}" for part in _STAMP_MEMBERS]
    for path in (*times, _frame_field(topic), *(f"{prefix}{name}" for name in names)):
        *above, last = path.split(".")
        at = tree
        for name in above:
            at = at.setdefault(name, {})
        at.setdefault(last, None)
    return tree


def _batch_rows(path: Path, topic: MappedTopic, table: Table, t_ns: Times) -> pa.Table:
    """Return the rows of a batch: numbers as they are, texts as strings; fields with several values have no column."""
    if topic.items is not None:
        if topic.items not in table.children:
            suggestion = hint(topic.items, table.children)
            raise TraceError(f"{path}: a message on {topic.topic!r} has no list {topic.items!r} (items): {suggestion}")
        table, t_ns = table.children[topic.items], t_ns[table.children[topic.items].parent]
    columns = {name: _arrow_column(values) for name, values in table.columns.items() if values.ndim == 1}
    return pa.table({**columns, topic_mapping.TIME_COLUMN: t_ns})


def _arrow_column(values: NDArray[Any]) -> pa.Array:
    if values.dtype.kind == "S":
        return pa.array([text.decode("utf-8", "backslashreplace") for text in values.tolist()], pa.string())
    return pa.array(values.astype(values.dtype.newbyteorder("=")))


def _with_same_columns(first: States, second: States) -> tuple[States, States]:
    """Return both with all columns of either; what one lacks is unknown."""
    for states, counterpart in ((first, second), (second, first)):
        for name in counterpart.numbers.keys() - states.numbers.keys():
            states.numbers[name] = np.full(len(states), np.nan)
        for name in counterpart.codes.keys() - states.codes.keys():
            states.codes[name] = np.full(len(states), -1, np.int8)
    return first, second
