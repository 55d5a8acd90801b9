"""Finds where an MCAP file can be read again behind damage: at the next record that vouches for itself."""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING, Final

from mcap.opcode import Opcode

from drivelint.errors import TraceError
from drivelint.formats.mcap.chunk import ChunkError, chunk_head, chunk_records

if TYPE_CHECKING:
    from collections.abc import Container

MAGIC = b"\x89MCAP0\r\n"
_RECORD = struct.Struct("<BQ")
_CANDIDATE: Final = re.compile(rb"[\x02\x05\x06\x0f][\s\S]{5}\x00{3}")
"""The head of a footer, message, chunk or end of data, shorter than 1 TiB."""
_BEHIND_DATA_END: Final = frozenset({
    Opcode.SCHEMA, Opcode.CHANNEL, Opcode.STATISTICS, Opcode.CHUNK_INDEX, Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX,
    Opcode.SUMMARY_OFFSET, Opcode.FOOTER,
})  # fmt: skip
_CHAIN: Final = 3
"""So many messages in a row, each on a known channel, are no chance."""
_LEAST_MESSAGE: Final = 22
_WORK: Final = 4
"""At most this many times the file's size is unpacked in a search: a file made of false chunk heads must end, too."""
_LEAST_WORK: Final = 64 << 20


def next_record(view: memoryview, at: int, *, channels: Container[int] | None) -> int:
    """Return the first byte from `at` on at which reading can go on; the end of the file if there is none.

    That is a chunk with its CRC, the end of the data, or the footer. `channels`: the known ones of a file without chunks, whose
    messages stand by themselves; None: the file has chunks, so that bytes like a message are the inside of a damaged one.
    """
    work = max(_WORK * len(view), _LEAST_WORK)
    place = at
    while work > 0 and (match := _CANDIDATE.search(view, place)):
        place = match.start()
        opcode, length = _RECORD.unpack_from(view, place)
        start, end = place + _RECORD.size, place + _RECORD.size + length
        if end <= len(view):
            if opcode == Opcode.CHUNK:
                work -= length + _declared(view[start:end])
                found = _is_chunk(view[start:end])
            else:
                found = _is_end(view, opcode, start, end) or (
                    opcode == Opcode.MESSAGE and channels is not None and _is_message(view, place, channels)
                )
            if found:
                return place
        place += 1
    return len(view)


def _declared(body: memoryview) -> int:
    try:
        return chunk_head(body).size
    except ChunkError:
        return 0


def _is_chunk(body: memoryview) -> bool:
    try:
        head = chunk_head(body)
        # without a CRC, only what unpacks vouches for itself
        return bool(head.crc or head.compression) and len(chunk_records(head, "")) == head.size
    except (ChunkError, TraceError):
        return False


def _is_end(view: memoryview, opcode: int, start: int, end: int) -> bool:
    if opcode == Opcode.FOOTER:
        return end - start == 20 and bytes(view[end:]) == MAGIC
    if opcode != Opcode.DATA_END or end - start != 4 or end + _RECORD.size > len(view):
        return False
    behind, length = _RECORD.unpack_from(view, end)
    return behind in _BEHIND_DATA_END and end + _RECORD.size + length <= len(view)


def _is_message(view: memoryview, at: int, channels: Container[int]) -> bool:
    """Say whether messages follow one another from `at` on, up to the end of the data if they are few."""
    for _ in range(_CHAIN):
        if at + _RECORD.size > len(view):
            return False
        opcode, length = _RECORD.unpack_from(view, at)
        start, end = at + _RECORD.size, at + _RECORD.size + length
        if _is_end(view, opcode, start, end):
            return True
        if opcode != Opcode.MESSAGE or length < _LEAST_MESSAGE or end > len(view):
            return False
        (channel,) = struct.unpack_from("<H", view, start)
        if channel not in channels:
            return False
        at = end
    return True
