"""ASAM OSI ground truth in MCAP: the channel is known by its schema and encoding, never by its topic."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import ptars

from drivelint.drive.trace import LEAST_UTC_NS, FrameTimes, QualityFinding, Recording, States, single_map
from drivelint.errors import TraceError
from drivelint.formats.mcap.reader import Container
from drivelint.formats.osi import extras
from drivelint.formats.osi.decode import (
    FIELD_TREES,
    GROUND_TRUTH,
    SENSOR_VIEW,
    Decoder,
    FirstMessage,
    read_first_message,
)
from drivelint.formats.osi.enum_codes import Bulbs, signal_states
from drivelint.formats.protobuf import descriptors
from drivelint.phrases import listed

if TYPE_CHECKING:
    from pathlib import Path

    import pyarrow as pa
    from mcap.records import Channel
    from numpy.typing import NDArray

    from drivelint.formats.mcap.reader import Packet
    from drivelint.formats.osi.decode import FrameBatch

OPEN_DRIVE = "osi3.MapAsamOpenDrive"
BATCH_BYTES = 32 * 1024 * 1024
"""Messages are decoded in batches of about this size, which bounds the memory that a long log needs."""


def read(path: Path, topic: str | None) -> Recording:
    """Read the ground truth of an MCAP file, and the OpenDRIVE beside it if there is one.

    Of several different OpenDRIVE maps none is taken. Errors: `TraceError` for a damaged file, no or several ground-truth
    topics, or a schema without the fields needed.
    """
    container = Container(path)
    source = _Source(container, topic)
    maps: dict[bytes, str] = {}
    events: list[bytes] = []
    lost: list[QualityFinding] = []
    for packet in container.packets():
        kind = _kind(container, packet.channel)
        if kind in FIELD_TREES:
            source.take(packet, kind)
        elif kind == OPEN_DRIVE:
            text, trouble = _map_text(container, packet)
            lost += trouble
            if text is not None:
                maps.setdefault(text, packet.channel.topic)
        elif _is_event(container, packet.channel):
            events.append(packet.data)
    recording = source.recording()
    recording.findings += container.findings
    own, several = single_map(maps)
    recording.embedded_map = own if maps else source.head.lanes
    recording.findings += [*lost[:1], *several]
    recording.geo_reference = source.head.reference
    recording.findings += () if maps else source.head.findings
    recording.events = extras.read_declared_events(path, events)
    extras.apply_metadata(path, container.metadata, recording)
    return recording


def _kind(container: Container, channel: Channel) -> str | None:
    """Return the protobuf message type on a channel; None for any other encoding."""
    schema = container.schemas.get(channel.schema_id)
    if schema is None or schema.encoding != "protobuf" or channel.message_encoding != "protobuf":
        return None
    return schema.name


def _is_event(container: Container, channel: Channel) -> bool:
    """Say whether a channel is that of the declared events of a converted log."""
    schema = container.schemas.get(channel.schema_id)
    return schema is not None and schema.name == extras.EVENT_MESSAGE and channel.message_encoding == "json"


def _map_text(container: Container, packet: Packet) -> tuple[bytes | None, tuple[QualityFinding, ...]]:
    """Return the OpenDRIVE of a message, and why there is none."""
    types = descriptors.parse(container.path, OPEN_DRIVE, container.schemas[packet.channel.schema_id].data)
    descriptor = descriptors.pruned(container.path, types, OPEN_DRIVE, {"open_drive_xml_content": None})
    try:
        rows = ptars.HandlerPool([descriptor.file]).get_for_message(descriptor).list_to_record_batch([packet.data])
    except ValueError as error:
        text, why = None, f"cannot be decoded ({error})"
    else:
        text, why = rows.column(0)[0].as_py() if rows.num_columns else None, "is empty"
    if not text:
        message = (
            f"the log's own map is not used: the one on topic {packet.channel.topic!r}, byte {packet.offset}, {why}"
        )
        return None, (QualityFinding.unusable_map(message),)
    return text if isinstance(text, bytes) else str(text).encode(), ()


@dataclass
class _Source:
    """Collects the messages of the one ground-truth topic and decodes them batch by batch."""

    container: Container
    topic: str | None
    kinds: dict[str, str] = field(default_factory=dict)
    waiting: list[Packet] = field(default_factory=list)
    size: int = 0
    log_ns: list[int] = field(default_factory=list)
    batches: list[FrameBatch] = field(default_factory=list)
    decoder: Decoder | None = None
    head: FirstMessage = field(default_factory=FirstMessage)

    def take(self, packet: Packet, kind: str) -> None:
        """Keep a message of the topic, decoding when enough have come together."""
        topic = packet.channel.topic
        self.kinds.setdefault(topic, kind)
        if topic != (self.topic if self.topic is not None else next(iter(self.kinds))):
            return
        if self.waiting and packet.channel.schema_id != self.waiting[-1].channel.schema_id:
            self._decode()
        self.waiting.append(packet)
        if not self.log_ns:  # lanes stand in the first message, if anywhere
            self.head = read_first_message(packet.data, kind)
        self.log_ns.append(packet.log_time_ns)
        self.size += len(packet.data)
        if self.size >= BATCH_BYTES:
            self._decode()

    def _decode(self) -> None:
        if not self.waiting:
            return
        schema = self.container.schemas[self.waiting[0].channel.schema_id]
        if self.decoder is None or self.decoder.schema_id != schema.id:
            self.decoder = Decoder(self.container.path, schema.id, schema.name, schema.data)
            self.decoder.lights = self.head.lights
        self.batches.append(self.decoder.frames(self.waiting))
        self.waiting, self.size = [], 0

    def recording(self) -> Recording:
        """Join the batches. Errors: `TraceError` where the topic is missing or not the only one."""
        path = self.container.path
        topics = ", ".join(sorted(self.kinds))
        if self.topic is not None and self.topic not in self.kinds:
            found = f"ground truth is on {topics}" if self.kinds else _nothing(self.container)
            raise TraceError(f"{path}: no OSI ground truth on topic {self.topic!r}: {found}")
        if not self.kinds:
            raise TraceError(f"{path}: no OSI ground truth in this file: {_nothing(self.container)}")
        if self.topic is None and len(self.kinds) > 1:
            raise TraceError(f"{path}: ground truth on {len(self.kinds)} topics ({topics}): choose one with --topic")
        self._decode()
        return join_batches(self.batches, np.array(self.log_ns, np.uint64))


def _nothing(container: Container) -> str:
    """Say what an MCAP file without OSI messages holds instead."""
    kinds = set()
    for channel in container.channels.values():
        schema = container.schemas.get(channel.schema_id)
        kinds.add(f"{schema.name if schema else 'no schema'} in {channel.message_encoding or 'no encoding'}")
    needed = f"{GROUND_TRUTH} or {SENSOR_VIEW} in protobuf is needed"
    return f"it has {listed(sorted(kinds)) if kinds else 'no channel'}; {needed}"


def join_batches(batches: list[FrameBatch], log_ns: NDArray[np.uint64]) -> Recording:
    """Join batches into one recording in the order of the file."""
    findings: list[QualityFinding] = []
    t_ns = _clock(batches, log_ns.astype(np.int64), findings)
    offsets = np.cumsum([0, *(len(batch.t_ns) for batch in batches)])
    frame = np.concatenate([batch.frame + offset for batch, offset in zip(batches, offsets, strict=False)])
    unique, actor = np.unique(np.concatenate([batch.ids for batch in batches]), return_inverse=True)
    zeroed = _zeros(batches)
    states = States(
        [str(number) for number in unique],
        actor.astype(np.int32),
        t_ns[frame],
        {name: np.concatenate([numbers[name] for numbers in zeroed]) for name in zeroed[0]},
        {name: np.concatenate([batch.codes[name] for batch in batches]) for name in batches[0].codes},
        np.concatenate([batch.not_finite for batch in batches]),
    )
    nameless = sum(batch.nameless for batch in batches)
    if nameless:
        message = f"moving objects without an id: {nameless}: they are not judged"
        findings.append(QualityFinding("dropped_row", "error", message, nameless))
    return Recording(
        "osi-mcap",
        states,
        signals=_signals(batches, offsets, t_ns),
        ego_ids=_host([host for batch in batches for host in batch.hosts], t_ns, findings),
        findings=findings,
        utc_start_ns=int(log_ns.min()) if log_ns.min() >= LEAST_UTC_NS else None,
        frame_times=FrameTimes(t_ns, log_ns),
    )


def _zeros(batches: list[FrameBatch]) -> list[dict[str, NDArray[np.float64]]]:
    """Return the numbers of each batch, with 0 for coordinates that the log leaves out if it never writes a zero.

    Some writers leave zeros out, as proto3 does. One that writes zeros means by a coordinate without a value that it is not known.
    """
    if any(batch.says_zero for batch in batches):
        return [batch.numbers for batch in batches]
    return [
        {
            name: np.where(batch.left_out[name], 0.0, v) if name in batch.left_out else v
            for name, v in batch.numbers.items()
        }
        for batch in batches
    ]


def _clock(batches: list[FrameBatch], log_ns: NDArray[np.int64], findings: list[QualityFinding]) -> NDArray[np.int64]:
    """Return each frame's time: the messages' own where they all have one that runs, else the log's."""
    stamps = np.concatenate([batch.t_ns for batch in batches])
    timed = np.concatenate([batch.timed for batch in batches])
    if not timed.all() or (len(stamps) > 1 and stamps.min() == stamps.max()):
        stamps = log_ns
        message = "the messages' own time stamps are missing or stand still: the log times of the container are used"
        findings.append(
            QualityFinding("log_time_used", "warning", message, int((~timed).sum()) or len(stamps), int(stamps.min()))
        )
    back = np.diff(stamps) < 0
    if back.any():
        n, first = int(back.sum()), int(stamps[1:][back][0])
        message = f"backward steps of the clock: {n}, the first to {first / 1e9:g} s: states are sorted by their times"
        findings.append(QualityFinding("clock_jump", "warning", message, n, first))
    return stamps


def _host(hosts: list[int | None], t_ns: NDArray[np.int64], findings: list[QualityFinding]) -> list[str]:
    """Return the host vehicle's id, that of most frames if it changes; of several that are as often said, the first."""
    said = Counter(host for host in hosts if host is not None)
    if not said:
        return []
    first: dict[int, int] = {}
    for host, at in zip(hosts, t_ns.tolist(), strict=True):
        if host is not None:
            first[host] = min(first.get(host, at), at)
    ego = min(said, key=lambda host: (-said[host], first[host], host))
    if len(said) > 1:
        frames, n = said.total(), said.total() - said[ego]
        names = listed(sorted(map(str, said)))
        message = f"the log names {len(said)} host vehicles ({names}): {ego} is the ego, which {n} of {frames} frames do not name"
        since = min(at for host, at in first.items() if host != ego)
        findings.append(QualityFinding("ego_count", "warning", message, n, since, str(ego)))
    return [str(ego)]


def _signals(batches: list[FrameBatch], offsets: NDArray[np.int64], t_ns: NDArray[np.int64]) -> pa.Table | None:
    bulbs = Bulbs(
        np.concatenate([batch.bulbs.frame + offset for batch, offset in zip(batches, offsets, strict=False)]),
        [name for batch in batches for name in batch.bulbs.signal_id],
        np.concatenate([batch.bulbs.bits for batch in batches]),
    )
    return signal_states(bulbs, t_ns)
