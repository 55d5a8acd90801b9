"""ASAM OSI trace files (`.osi`): messages one after another, each behind its length, without a schema of their own."""

from __future__ import annotations

import mmap
from typing import TYPE_CHECKING, Final

import numpy as np
from mcap.records import Channel

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError
from drivelint.formats.mcap.reader import BATCH_BYTES, Packet
from drivelint.formats.osi.decode import Decoder, FirstMessage, read_first_message
from drivelint.formats.osi.reader import join_batches
from drivelint.formats.osi.schema import GROUND_TRUTH, SENSOR_VIEW, reader_descriptor_set

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from drivelint.drive.trace import Recording
    from drivelint.formats.osi.decode import FrameBatch
    from drivelint.formats.probe import Probe

formats: Final = {"osi-file": ("ASAM OSI trace file", "the log's host vehicle")}
takes_mapping: Final = False
_LENGTH = 4
_FIRST_TAGS = frozenset({0x0A, 0x12, 0x1A})
"""What an OSI message begins with: its version, time stamp or an id (fields 1 to 3, length-delimited)."""


def is_osi_trace(head: bytes, size: int) -> bool:
    """Say whether a file of `size` bytes that begins with `head` can be an OSI trace: a length that fits, then a message."""
    length = int.from_bytes(head[:_LENGTH], "little")
    return 2 <= length <= size - _LENGTH and len(head) > _LENGTH and head[_LENGTH] in _FIRST_TAGS


def accepts(probe: Probe) -> bool:
    """Accept by the first length and the message behind it."""
    return not probe.path.is_dir() and is_osi_trace(probe.head, probe.path.stat().st_size)


def read(probe: Probe) -> Recording:
    """Read a trace of `osi3.GroundTruth` or `osi3.SensorView` messages: which of the two, the first messages tell.

    Errors: `TraceError` with the byte for a file that breaks off within a message (what is lost cannot be told), a message
    that is neither kind, or messages without time stamps.
    """
    path = probe.path
    channel = Channel(id=1, topic=path.name, message_encoding="protobuf", schema_id=1, metadata={})
    batches: list[FrameBatch] = []
    decoder: Decoder | None = None
    head = FirstMessage()
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        for packets in _batches(path, channel, content):
            if decoder is None:
                decoder, name = _decoder(path, packets)
                head = read_first_message(packets[0].data, name)
                decoder.lights = head.lights
            batches.append(decoder.frames(packets))
    n = sum(len(batch.t_ns) for batch in batches)
    untimed = n - sum(int(batch.timed.sum()) for batch in batches)
    if untimed:
        raise TraceError(f"{path}: {untimed} of {n} messages have no time stamp, and the file has none of its own")
    recording = join_batches(batches, np.zeros(n, np.uint64))
    recording.format = "osi-file"
    recording.frame_times = None
    recording.embedded_map = head.lanes
    recording.geo_reference, recording.geo_offset = head.reference, head.geo_offset
    recording.findings += head.findings
    recording.findings.append(
        QualityFinding("unprotected", "info", "the file has no checksums: damage inside a message may go unseen")
    )
    return recording


def _batches(path: Path, channel: Channel, content: mmap.mmap) -> Iterator[list[Packet]]:
    """Cut the file into messages, some tens of megabytes at a time. Errors: `TraceError` for a length past the end."""
    waiting: list[Packet] = []
    at = size = 0
    while at < len(content):
        length = int.from_bytes(content[at : at + _LENGTH], "little")
        start = at + _LENGTH
        if start > len(content) or start + length > len(content):
            raise TraceError(
                f"{path}: the message at byte {at} should have {length} bytes and the file ends "
                f"{start + length - len(content)} bytes before that: copy or record it again"
            )
        waiting.append(Packet(channel, 0, content[start : start + length], at))
        at = start + length
        size += length
        if size >= BATCH_BYTES:
            yield waiting
            waiting, size = [], 0
    if waiting:
        yield waiting


def _decoder(path: Path, packets: list[Packet]) -> tuple[Decoder, str]:
    """Return the decoder of the kind of message in which objects with positions are found, and its name."""
    for name in (GROUND_TRUTH, SENSOR_VIEW):
        decoder = Decoder(path, 1, name, reader_descriptor_set())
        try:
            frames = decoder.frames(packets)
        except TraceError:
            continue
        if len(frames.ids) and np.isfinite(frames.numbers["x_m"]).any():
            return decoder, name
    raise TraceError(
        f"{path}: no moving objects in the first {len(packets)} messages, read as {GROUND_TRUTH} or as {SENSOR_VIEW}: "
        "only these two kinds of OSI trace can be judged"
    )
