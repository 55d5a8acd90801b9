"""Copies the messages of a SQLite file of a bag into an MCAP file, byte for byte."""

from __future__ import annotations

import struct
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from mcap.opcode import Opcode

from drivelint import __version__
from drivelint.formats.mcap.original import message_index
from drivelint.formats.sqlite_bag.reader import SqliteFile

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.formats.mcap.writer import Sink

CHUNK_BYTES: Final = 4 << 20
_MESSAGE_RECORD_HEADER: Final = struct.Struct("<BQHIQQ")
_MESSAGE_HEADER_BYTES: Final = 22


def copy_messages(path: Path, sink: Sink) -> None:
    """Append all messages of a file to a sink in their order. Errors: `TraceError` if the file is damaged."""
    if not sink.offset:
        sink.begin(f"drivelint {__version__}")
    file = SqliteFile(path)
    channels: dict[int, int] = {}
    records: list[bytes] = []
    entries: list[tuple[int, int, int, int]] = []
    size = 0

    def write_chunk() -> None:
        nonlocal size
        if entries:
            sink.add_chunk(b"".join(records), message_index(entries))
        records.clear()
        entries.clear()
        size = 0

    for message in file.messages():
        if not channels:
            channels = _write_channels(file, sink)
        number = channels[message.channel.id]
        length = _MESSAGE_HEADER_BYTES + len(message.data)
        head = _MESSAGE_RECORD_HEADER.pack(Opcode.MESSAGE, length, number, 0, message.log_time_ns, message.log_time_ns)
        entries.append((number, 0, message.log_time_ns, size))
        records += [head, message.data]
        size += len(head) + len(message.data)
        if size >= CHUNK_BYTES:
            write_chunk()
    write_chunk()
    if not channels:
        _write_channels(file, sink)  # topics without a message


def _write_channels(file: SqliteFile, sink: Sink) -> dict[int, int]:
    """Write the channels of a file, with their schemas, to the sink; return their ids there. A channel of an earlier file keeps its id."""
    numbers: dict[int, int] = {}
    for number, channel in file.channels.items():
        schema = replace(file.schemas[channel.schema_id], id=0)
        same_channels = (
            there
            for there, sink_channel in sink.channels.items()
            if (sink_channel.topic, sink_channel.message_encoding) == (channel.topic, channel.message_encoding)
            and replace(sink.schemas[sink_channel.schema_id], id=0) == schema
        )
        there = next(same_channels, None)
        numbers[number] = (
            sink.add_channel(channel.topic, channel.message_encoding, schema, channel.metadata)
            if there is None
            else there
        )
    return numbers
