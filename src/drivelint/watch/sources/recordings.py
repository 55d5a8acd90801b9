"""Writes live messages to a growing MCAP file, the recording."""

from __future__ import annotations

import struct
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

from mcap.opcode import Opcode

from drivelint.errors import TraceError
from drivelint.formats.mcap.original import message_index
from drivelint.formats.mcap.writer import Sink

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from mcap.records import Schema

MCAP_HEADER_LIBRARY: Final = "drivelint watch"
_MESSAGE_HEADER: Final = struct.Struct("<BQHIQQ")
_MESSAGE_FIELDS_BYTES: Final = 22
_SEQUENCE_MODULUS: Final = 1 << 32
"""The sequence number of a message is a 32-bit number, which starts again at 0."""


@contextmanager
def convert_write_errors(path: Path) -> Iterator[None]:
    """Convert errors of the system within the block, such as a full disk, to `TraceError`."""
    try:
        yield
    except OSError as error:
        raise TraceError(f"{path}: the recording cannot be written: {error.strerror or error}") from error


class LiveChannel(NamedTuple):
    """A channel of live messages; its schema has no id yet."""

    topic: str
    encoding: str
    schema: Schema


class LiveMessage(NamedTuple):
    """A message, its channel, and its log time."""

    channel: LiveChannel
    log_ns: int
    content: bytes


class McapRecording:
    """An MCAP file that is written while messages arrive. Added messages are in the file at once; `finish` completes it."""

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = path.open("xb")
        self._sink = Sink(self._file)
        self._sink.begin(MCAP_HEADER_LIBRARY)
        self._count = 0

    def add(self, messages: Sequence[LiveMessage]) -> None:
        """Write messages as a chunk, after their new schemas and channels."""
        records, entries, at = [], [], 0
        for message in messages:
            channel = self._channel_id(message.channel)
            size, number = _MESSAGE_FIELDS_BYTES + len(message.content), self._count % _SEQUENCE_MODULUS
            head = _MESSAGE_HEADER.pack(Opcode.MESSAGE, size, channel, number, message.log_ns, message.log_ns)
            self._count += 1
            records += [head, message.content]
            entries.append((channel, number, message.log_ns, at))
            at += len(head) + len(message.content)
        if entries:
            self._sink.add_chunk(b"".join(records), message_index(entries))
        self._file.flush()

    def finish(self) -> None:
        """Complete and close the file. May be called twice."""
        if not self._file.closed:
            self._sink.finish()
            self._file.close()

    def _channel_id(self, live_channel: LiveChannel) -> int:
        """Return the id of a channel; announce the channel if it is new."""
        for number, channel in self._sink.channels.items():
            schema = replace(self._sink.schemas[channel.schema_id], id=0)
            if (channel.topic, channel.message_encoding, schema) == live_channel:
                return number
        return self._sink.add_channel(*live_channel)
