"""Reads ASAM OSI ground truth in MCAP files and in OSI trace files.

In MCAP, channels are recognised by schema and encoding, not by topic. Trace files (`.osi`) have no schema; each message follows its length.
A moving object's position is the centre of its box, and its dimensions are those of the box.
"""

from __future__ import annotations

import mmap
from collections import Counter
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from mcap.records import Channel

from drivelint.drive.clock_restart import backward_step_findings
from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import (
    EARLIEST_UTC_NS,
    LOG_TIME_CHECK,
    FrameTimes,
    QualityFinding,
    Recording,
    States,
    single_map_or_finding,
)
from drivelint.errors import TraceError
from drivelint.formats.mcap.losses import Losses
from drivelint.formats.mcap.malformed import decode_readable_and_record_losses, decode_without_malformed
from drivelint.formats.mcap.reader import Container, LogMessage, message_batches
from drivelint.formats.mcap.silent import silent_topics_text
from drivelint.formats.mcap.unread import UnreadTopics
from drivelint.formats.osi import metadata, trace_file
from drivelint.formats.osi.decode import FIELD_TREES, Decoder, FirstMessageFacts, read_first_message
from drivelint.formats.osi.enum_codes import signal_states
from drivelint.formats.osi.heights import forget_heights_copied_from_widths
from drivelint.formats.osi.schema import GROUND_TRUTH, OPEN_DRIVE, SENSOR_VIEW, descriptor_set
from drivelint.formats.protobuf.descriptors import message_decoder, parse_schema
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from pathlib import Path

    from mcap.records import Schema
    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Times
    from drivelint.formats.osi.decode import FrameBatch
    from drivelint.formats.probe import Probe

formats: Final = {"osi-file": ("ASAM OSI trace file", "the log's host vehicle")}
takes_mapping: Final = False
_READABLE_MESSAGE_TYPES: Final = frozenset({*FIELD_TREES, OPEN_DRIVE, metadata.EVENT_MESSAGE})


def accepts(probe: Probe) -> bool:
    """Return whether the file begins with a plausible length and OSI message."""
    return not probe.path.is_dir() and trace_file.may_be_osi_trace(probe.head, probe.path.stat().st_size)


def read_mcap(path: Path, topic: str | None) -> Recording:
    """Read the ground truth of an MCAP file, and its OpenDRIVE map if it has exactly one.

    Errors: `TraceError` for a damaged file, no or several ground-truth topics, or a schema without the necessary fields.
    """
    container = Container(path, salvage=True)
    truth_topics: list[str] = []  # topics of ground truth
    first_message, decoder = FirstMessageFacts(), None
    batches: list[FrameBatch] = []
    log_ns: list[int] = []
    maps: dict[bytes, str] = {}
    events: list[bytes] = []
    lost_findings: list[QualityFinding] = []
    unread = UnreadTopics()
    for kind, log_messages in message_batches(container, partial(_message_type_to_read, truth_topics, topic, unread)):
        if kind in FIELD_TREES:
            _check_topics(container, truth_topics, topic)
            schema = container.schemas[log_messages[0].channel.schema_id]
            if not batches:  # only the first message can have lanes
                first_message = read_first_message(log_messages[0].data, kind)
            if decoder is None or decoder.schema_id != schema.id:
                decoder = Decoder(path, schema.id, schema.name, schema.data)
                decoder.lights = first_message.lights
            frames, readable = decode_readable_and_record_losses(container, log_messages, decoder.frames)
            if frames is not None:
                batches.append(frames)
            log_ns += [log_message.log_time_ns for log_message in readable]
        elif kind == OPEN_DRIVE:
            for log_message in log_messages:
                text = _map_content(container, log_message)
                if isinstance(text, bytes):
                    maps.setdefault(text, log_message.channel.topic)
                else:
                    lost_findings.append(text)
        else:
            events += [log_message.data for log_message in log_messages]
    _check_topics(container, truth_topics, topic)
    unread.refuse_kinds(path, FIELD_TREES if topic is None else (), truth_topics)
    _refuse_converted_log_without_end(container)
    if not batches:
        raise TraceError(f"{path}: no message of its ground truth can be decoded ({container.losses.first.cause})")
    recording = _recording("osi-mcap", batches, first_message, np.array(log_ns, np.uint64))
    own_map, several = single_map_or_finding(maps)
    if maps:
        recording.embedded_map = own_map
    recording.findings += [
        *container.findings,
        *unread.findings(),
        *lost_findings[:1],
        *(several if maps else first_message.findings),
    ]
    recording.lost_times += container.losses.lost_times(path)
    recording.events = metadata.read_declared_events(path, events)
    metadata.apply_metadata(path, container.metadata, recording)
    return recording


def _refuse_converted_log_without_end(container: Container) -> None:
    """Raise `TraceError` for a log of `drivelint convert` whose end is lost, because the end contains all declared events."""
    if container.library == metadata.CONVERTED_LOG_LIBRARY and any(
        loss.until_ns is None for loss in container.losses.lost_bytes
    ):
        raise TraceError(
            f"{container.path}: the end of this converted log, with its declared events, is lost "
            f"({container.losses.last.cause}): convert it again"
        )


def _message_type_to_read(
    truth_topics: list[str], topic: str | None, unread: UnreadTopics, channel: Channel, schema: Schema
) -> str | None:
    """Return the message type of a channel; None if it is not read. Topics of ground truth are added to `truth_topics`."""
    if schema.name not in _READABLE_MESSAGE_TYPES:
        return None
    encoding = "json" if schema.name == metadata.EVENT_MESSAGE else "protobuf"
    if channel.message_encoding != encoding or (encoding == "protobuf" and schema.encoding != encoding):
        if schema.name not in FIELD_TREES or topic in {None, channel.topic}:
            unread.add(channel, schema.name)
        return None
    if schema.name in FIELD_TREES:
        if channel.topic not in truth_topics:
            truth_topics.append(channel.topic)
        return schema.name if channel.topic == (truth_topics[0] if topic is None else topic) else None
    return schema.name


def _map_content(container: Container, log_message: LogMessage) -> bytes | QualityFinding:
    """Return the OpenDRIVE map in a message, or the finding that it cannot be used."""
    types = parse_schema(container.path, OPEN_DRIVE, container.schemas[log_message.channel.schema_id].data)
    decode = message_decoder(container.path, types, OPEN_DRIVE, {"open_drive_xml_content": None})
    try:
        content = decode([log_message.data])
    except ValueError as error:
        text, why = None, f"cannot be decoded ({error})"
    else:
        text, why = content.field(0)[0].as_py() if content.type.num_fields else None, "is empty"
    if not text:
        where = f"topic {log_message.channel.topic!r}, byte {log_message.offset}"
        return QualityFinding.unusable_map(f"the log's own map (on {where}) is not used: {why}")
    return text if isinstance(text, bytes) else str(text).encode()


def _check_topics(container: Container, truth_topics: list[str], topic: str | None) -> None:
    """Raise `TraceError` if there is no topic of ground truth, or several without a choice."""
    path, topics = container.path, ", ".join(sorted(truth_topics))
    if topic is not None and topic not in truth_topics:
        content = f"ground truth is on {topics}" if truth_topics else _foreign_content_text(container)
        raise TraceError(f"{path}: no OSI ground truth on topic {topic!r}: {content}")
    if not truth_topics:
        raise TraceError(f"{path}: no OSI ground truth in this file: {_foreign_content_text(container)}")
    if topic is None and len(truth_topics) > 1:
        raise TraceError(f"{path}: ground truth on {len(truth_topics)} topics ({topics}): choose one with --topic")


def _foreign_content_text(container: Container) -> str:
    """Return words for the content of an MCAP file without OSI messages: its message types, or topics without messages."""
    names = {0: "no schema", **{number: schema.name for number, schema in container.schemas.items()}}
    kinds = {f"{names[c.schema_id]} in {c.message_encoding or 'no encoding'}" for c in container.channels.values()}
    need = f"{GROUND_TRUTH} or {SENSOR_VIEW} in protobuf is needed"
    if silent := silent_topics_text([container.path], FIELD_TREES.__contains__):
        return f"{silent}: record it again"
    return f"it has {name_list(sorted(kinds)) if kinds else 'no channel'}; {need}"


def read(probe: Probe) -> Recording:
    """Read a trace file of `osi3.GroundTruth` or `osi3.SensorView` messages; the first messages show which type it has.

    Errors: `TraceError` if no message can be read, if messages have another type, or if time stamps are missing.
    """
    path = probe.path
    channel = Channel(id=1, topic=path.name, message_encoding="protobuf", schema_id=1, metadata={})
    batches: list[FrameBatch] = []
    decoder: Decoder | None = None
    first_message, losses = FirstMessageFacts(), Losses()
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        for log_messages in trace_file.message_batches(channel, content, losses):
            if decoder is None:
                decoder, name = _fitting_decoder_and_type(path, log_messages)
                first_message = read_first_message(log_messages[0].data, name)
                decoder.lights = first_message.lights
            frames, malformed = decode_without_malformed(log_messages, decoder.frames)
            times = iter(() if frames is None else frames.t_ns.tolist())
            for k, log_message in enumerate(log_messages):
                if k in malformed:
                    end = log_message.offset + trace_file.LENGTH_FIELD_BYTES + len(log_message.data)
                    losses.add(log_message.offset, end, "a message that cannot be decoded")
                else:
                    losses.bound_loss_times_by_message(next(times))
            if frames is not None:
                batches.append(frames)
    if not batches:
        raise TraceError(f"{path}: {losses.first.cause if losses else 'no message'}: copy or record it again")
    n = sum(len(batch.t_ns) for batch in batches)
    untimed = n - sum(int(batch.has_time.sum()) for batch in batches)
    if untimed:
        raise TraceError(
            f"{path}: {untimed} of {n} messages have no time stamp, and a file of this format has no other "
            "times: record the log with time stamps"
        )
    recording = _recording("osi-file", batches, first_message, np.zeros(n, np.uint64))
    recording.frame_times = None
    recording.lost_times += trace_file.lost_times(path, losses, np.concatenate([batch.t_ns for batch in batches]))
    recording.findings += first_message.findings
    return recording


def _fitting_decoder_and_type(path: Path, log_messages: list[LogMessage]) -> tuple[Decoder, str]:
    """Return the decoder and the name of the message type with which these messages have objects with positions.

    Errors: `TraceError` if neither type fits.
    """
    for batch in (log_messages, log_messages[:1]):  # a damaged later message is reported when it is decoded
        for name in (GROUND_TRUTH, SENSOR_VIEW):
            decoder = Decoder(path, 1, name, descriptor_set("read"))
            if _has_placed_objects(decoder, batch):
                return decoder, name
    raise TraceError(
        f"{path}: no moving objects in the first {len(log_messages)} messages, read as {GROUND_TRUTH} or as {SENSOR_VIEW}: "
        "only these two kinds of OSI trace can be judged"
    )


def _has_placed_objects(decoder: Decoder, log_messages: list[LogMessage]) -> bool:
    try:
        frames, _ = decode_without_malformed(log_messages, decoder.frames)
    except TraceError:
        return False
    return frames is not None and bool(len(frames.ids) and np.isfinite(frames.numbers["x_m"]).any())


def _recording(
    format_name: str, batches: list[FrameBatch], first_message: FirstMessageFacts, log_ns: NDArray[np.uint64]
) -> Recording:
    """Return one recording of all batches, in the order of the file. `first_message`: what only the first message has."""
    findings: list[QualityFinding] = []
    t_ns = _frame_times_ns(batches, log_ns.astype(np.int64), findings)
    offsets = np.cumsum([0, *(len(batch.t_ns) for batch in batches)])
    frame = np.concatenate([batch.frame + offset for batch, offset in zip(batches, offsets, strict=False)])
    unique, actor = np.unique(np.concatenate([batch.ids for batch in batches]), return_inverse=True)
    zeroed = _numbers_with_restored_zeros(batches)
    states = States(
        [str(number) for number in unique],
        actor.astype(np.int32),
        t_ns[frame],
        {column: np.concatenate([numbers[column] for numbers in zeroed]) for column in zeroed[0]},
        {column: np.concatenate([batch.codes[column] for batch in batches]) for column in batches[0].codes},
        np.concatenate([batch.not_finite for batch in batches]),
    )
    if copied := forget_heights_copied_from_widths(states):
        findings.append(copied)
    bulbs = pa.concat_tables(
        batch.bulbs.set_column(0, "frame", pc.add(batch.bulbs["frame"], int(offset)))
        for batch, offset in zip(batches, offsets, strict=False)
    )
    nameless = np.concatenate(
        [batch.frames_of_nameless + offset for batch, offset in zip(batches, offsets, strict=False)]
    )
    if len(nameless):
        message = f"moving objects without an id: {len(nameless)}: they are not judged"
        findings.append(QualityFinding("dropped_row", "error", message, len(nameless)))
    if unplaced := sum(batch.outlines.n_unplaced for batch in batches):
        message = "stationary objects without a position are not read: a contact with them is not detected"
        findings.append(QualityFinding("unread_obstacle", "warning", message, unplaced))
    lost_times = times_of_lost_rows(
        log_ns.astype(np.int64) if format_name == "osi-mcap" else t_ns,
        np.ones(len(t_ns), np.bool_),
        np.isin(np.arange(len(t_ns)), nameless),
        "messages with moving objects without an id",
    )
    return Recording(
        format_name,
        states,
        signals=signal_states(bulbs, t_ns),
        ego_ids=_ego_ids_of_hosts([host for batch in batches for host in batch.hosts], t_ns, findings),
        findings=findings,
        lost_times=lost_times,
        utc_start_ns=int(log_ns.min()) if log_ns.min() >= EARLIEST_UTC_NS else None,
        frame_times=FrameTimes(t_ns, log_ns),
        frames_ns=t_ns,
        embedded_map=first_message.lanes,
        geo_reference=first_message.reference,
        geo_offset=first_message.geo_offset,
        conditions={} if first_message.nation is None else {"nation": first_message.nation},
        outlines=[*{key: outline for batch in batches for key, outline in batch.outlines.items()}.values()],
    )


def _numbers_with_restored_zeros(batches: list[FrameBatch]) -> list[dict[str, Floats]]:
    """Return the numbers of each batch, with 0 for missing coordinates if the log contains no zero.

    Some writers omit zeros, as proto3 does. In a log with zeros, a missing coordinate is unknown.
    """
    if any(batch.has_zeros for batch in batches):
        return [batch.numbers for batch in batches]
    return [
        batch.numbers
        | {name: np.where(rows, 0.0, batch.numbers[name]) for name, rows in batch.missing_coordinates.items()}
        for batch in batches
    ]


def _frame_times_ns(batches: list[FrameBatch], log_ns: Times, findings: list[QualityFinding]) -> Times:
    """Return each frame's time: its own time stamp, or the log time for all frames if time stamps are missing or do not advance."""
    stamps = np.concatenate([batch.t_ns for batch in batches])
    timed = np.concatenate([batch.has_time for batch in batches])
    if not timed.all() or (len(stamps) > 1 and stamps.min() == stamps.max()):
        stamps = log_ns
        message = (
            "the time stamps of the messages are missing or do not advance: the log times of the container are used"
        )
        findings.append(
            QualityFinding(LOG_TIME_CHECK, "warning", message, int((~timed).sum()) or len(stamps), int(stamps.min()))
        )
    findings += backward_step_findings(stamps)
    return stamps


def _ego_ids_of_hosts(host_ids: list[int | None], t_ns: Times, findings: list[QualityFinding]) -> list[str]:
    """Return the most frequent host vehicle's id, of equally frequent ids the earliest, as a list; empty without any id."""
    host_counts = Counter(host for host in host_ids if host is not None)
    if not host_counts:
        return []
    first: dict[int, int] = {}
    for host, at in zip(host_ids, t_ns.tolist(), strict=True):
        if host is not None:
            first[host] = min(first.get(host, at), at)
    ego = min(host_counts, key=lambda host: (-host_counts[host], first[host], host))
    if len(host_counts) > 1:
        frames, n = host_counts.total(), host_counts.total() - host_counts[ego]
        names = name_list(sorted(map(str, host_counts)))
        message = (
            f"the log names {len(host_counts)} host vehicles ({names}): {ego} is used as the ego; "
            f"{n} of {frames} frames do not name it"
        )
        since = min(at for host, at in first.items() if host != ego)
        findings.append(QualityFinding("ego_count", "warning", message, n, since, str(ego)))
    return [str(ego)]
