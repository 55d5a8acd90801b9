"""Finds the byte after damage at which an MCAP file can be read again: the next record that is certainly intact."""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING, Final

from mcap.opcode import Opcode

from drivelint.errors import TraceError
from drivelint.formats.mcap.chunk import ChunkError, chunk_records, parse_chunk

if TYPE_CHECKING:
    from collections.abc import Container

MAGIC = b"\x89MCAP0\r\n"
_RECORD_HEADER = struct.Struct("<BQ")
_RECORD_HEADER_PATTERN: Final = re.compile(rb"[\x02\x05\x06\x0f][\s\S]{5}\x00{3}")
"""Matches the head of a footer, message, chunk or data end record that is shorter than 1 TiB."""
_OPCODES_AFTER_DATA_END: Final = frozenset({
    Opcode.SCHEMA, Opcode.CHANNEL, Opcode.STATISTICS, Opcode.CHUNK_INDEX, Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX,
    Opcode.SUMMARY_OFFSET, Opcode.FOOTER,
})  # fmt: skip
_LEAST_CHAIN_MESSAGES: Final = 3
"""Bytes that look like this many consecutive messages on known channels are certainly messages."""
_LEAST_MESSAGE_BYTES: Final = 22
_MOST_UNPACKED_MULTIPLE_OF_FILE_SIZE: Final = 4
"""A search unpacks at most this multiple of the file's size (`_LEAST_UNPACKING_LIMIT_BYTES`, if that is more).

So it also ends for a file full of false chunk headers.
"""
_LEAST_UNPACKING_LIMIT_BYTES: Final = 64 << 20
"""A search may unpack this many bytes of any file."""


def next_record_offset(view: memoryview, at: int, *, channels: Container[int] | None) -> int:
    """Return the first byte from `at` on at which reading can go on; the end of the file if there is none.

    Reading goes on at an intact chunk, a data end record, or the footer; in a file without chunks also at a message.
    `channels`: the known channel ids of a file without chunks; None: the file has chunks, and messages are only inside them.
    """
    bytes_to_unpack = max(_MOST_UNPACKED_MULTIPLE_OF_FILE_SIZE * len(view), _LEAST_UNPACKING_LIMIT_BYTES)
    place = at
    while bytes_to_unpack > 0 and (match := _RECORD_HEADER_PATTERN.search(view, place)):
        place = match.start()
        opcode, length = _RECORD_HEADER.unpack_from(view, place)
        start, end = place + _RECORD_HEADER.size, place + _RECORD_HEADER.size + length
        if end <= len(view):
            if opcode == Opcode.CHUNK:
                bytes_to_unpack -= length + _declared_unpacked_bytes(view[start:end])
                is_record = _is_intact_chunk(view[start:end])
            else:
                is_record = _is_end_of_data(view, opcode, start, end) or (
                    opcode == Opcode.MESSAGE and channels is not None and _has_message_chain(view, place, channels)
                )
            if is_record:
                return place
        place += 1
    return len(view)


def _declared_unpacked_bytes(body: memoryview) -> int:
    try:
        return parse_chunk(body).size
    except ChunkError:
        return 0


def _is_intact_chunk(body: memoryview) -> bool:
    try:
        head = parse_chunk(body)
        # without a CRC, only successful decompression shows that the chunk is intact
        return bool(head.crc or head.compression) and len(chunk_records(head, "")) == head.size
    except (ChunkError, TraceError):
        return False


def _is_end_of_data(view: memoryview, opcode: int, start: int, end: int) -> bool:
    if opcode == Opcode.FOOTER:
        return end - start == 20 and bytes(view[end:]) == MAGIC
    if opcode != Opcode.DATA_END or end - start != 4 or end + _RECORD_HEADER.size > len(view):
        return False
    behind, length = _RECORD_HEADER.unpack_from(view, end)
    return behind in _OPCODES_AFTER_DATA_END and end + _RECORD_HEADER.size + length <= len(view)


def _has_message_chain(view: memoryview, at: int, channels: Container[int]) -> bool:
    """Return whether `_LEAST_CHAIN_MESSAGES` messages on known channels follow from `at` on, or fewer up to the end of the data."""
    for _ in range(_LEAST_CHAIN_MESSAGES):
        if at + _RECORD_HEADER.size > len(view):
            return False
        opcode, length = _RECORD_HEADER.unpack_from(view, at)
        start, end = at + _RECORD_HEADER.size, at + _RECORD_HEADER.size + length
        if _is_end_of_data(view, opcode, start, end):
            return True
        if opcode != Opcode.MESSAGE or length < _LEAST_MESSAGE_BYTES or end > len(view):
            return False
        (channel,) = struct.unpack_from("<H", view, start)
        if channel not in channels:
            return False
        at = end
    return True
