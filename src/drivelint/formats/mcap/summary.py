"""Reads the index at the end of an MCAP file."""

from __future__ import annotations

import io
import mmap
import struct
import zlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, ChunkIndex, Footer, MetadataIndex, Schema

from drivelint.formats.mcap.resume import MAGIC

if TYPE_CHECKING:
    from pathlib import Path

_RECORD_HEADER = struct.Struct("<BQ")
_FOOTER_BYTES = 20


@dataclass
class Summary:
    """The index of an MCAP file. `schemas`, `channels`: by their ids; `metadata`: the offsets of metadata records.

    `chunks`: offset of a chunk -> its length, first and last log time.
    `message_indexes`: offset of a chunk -> channel id -> offset of the message index.
    """

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    chunks: dict[int, tuple[int, int, int]] = field(default_factory=dict)
    metadata: list[int] = field(default_factory=list)
    message_indexes: dict[int, dict[int, int]] = field(default_factory=dict)


def read_index(file: Path) -> Summary:
    """Return the index of a file, even if it has no CRC; an empty `Summary` if it is missing or damaged."""
    with (
        file.open("rb") as stream,
        mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as data,
        memoryview(data) as view,
    ):
        return read_summary(view, may_lack_crc=True)


def read_summary(view: memoryview, *, may_lack_crc: bool = False) -> Summary:
    """Return the index of a mapped file; an empty `Summary` if the index is missing or damaged.

    An index without a CRC is read only if `may_lack_crc`.
    """
    end = len(view) - len(MAGIC)
    at = end - _FOOTER_BYTES - _RECORD_HEADER.size
    if (
        at < len(MAGIC)
        or bytes(view[end:]) != MAGIC
        or _RECORD_HEADER.unpack_from(view, at) != (Opcode.FOOTER, _FOOTER_BYTES)
    ):
        return Summary()
    footer = Footer.read(_stream(view[at + _RECORD_HEADER.size : end]))
    if (
        not (footer.summary_crc or may_lack_crc)
        or not 0 < footer.summary_start < at
        or not is_summary_intact(footer, view, at, end)
    ):
        return Summary()
    try:
        return _summary_of_records(view, footer.summary_start, at)
    except (struct.error, McapError, ValueError):
        return Summary()


def is_summary_intact(footer: Footer, view: memoryview, at: int, end: int) -> bool:
    """Return whether the index matches the CRC in the footer, which is in bytes `at` to `end`; also True without a CRC."""
    begin = min(footer.summary_start or at, at)
    return not footer.summary_crc or zlib.crc32(view[begin : end - 4]) == footer.summary_crc


def _summary_of_records(view: memoryview, at: int, end: int) -> Summary:
    summary = Summary()
    while at + _RECORD_HEADER.size <= end:
        opcode, length = _RECORD_HEADER.unpack_from(view, at)
        body = view[at + _RECORD_HEADER.size : min(at + _RECORD_HEADER.size + length, end)]
        if opcode == Opcode.SCHEMA:
            schema = Schema.read(_stream(body))
            summary.schemas[schema.id] = schema
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(_stream(body))
            summary.channels[channel.id] = channel
        elif opcode == Opcode.CHUNK_INDEX:
            chunk = ChunkIndex.read(_stream(body))
            times = chunk.message_start_time, chunk.message_end_time
            summary.chunks[chunk.chunk_start_offset] = (chunk.chunk_length, *times)
            summary.message_indexes[chunk.chunk_start_offset] = chunk.message_index_offsets
        elif opcode == Opcode.METADATA_INDEX:
            summary.metadata.append(MetadataIndex.read(_stream(body)).offset)
        at += _RECORD_HEADER.size + length
    return summary


def _stream(body: memoryview) -> ReadDataStream:
    return ReadDataStream(io.BytesIO(body))
