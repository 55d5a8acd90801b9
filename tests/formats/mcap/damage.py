"""Damages MCAP files in known places."""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

CHUNK, MESSAGE, STATISTICS, DATA_END, FOOTER = 6, 5, 11, 15, 2


def put(path: Path, data: bytes) -> Path:
    """Write changed bytes beside a file."""
    changed = path.with_name("changed.mcap")
    changed.write_bytes(data)
    return changed


def records(data: bytes) -> list[tuple[int, int, int]]:
    """Return opcode, offset and body length of every top-level record."""
    found, at = [], 8
    while at < len(data) - 8:
        opcode, length = struct.unpack_from("<BQ", data, at)
        found.append((opcode, at, length))
        at += 9 + length
    return found


def places(data: bytes, opcode: int) -> list[tuple[int, int]]:
    """Return begin and end of every top-level record of a kind, head included."""
    return [(at, at + 9 + length) for each, at, length in records(data) if each == opcode]


def replaced(data: bytes, at: int, new: bytes) -> bytes:
    """Return the data with other bytes in one place."""
    return data[:at] + new + data[at + len(new) :]


def with_index_crc(data: bytes) -> bytes:
    """Return the data with the CRC of the index set right."""
    ((at, end),) = places(data, FOOTER)
    (start,) = struct.unpack_from("<Q", data, at + 9)
    return replaced(data, end - 4, struct.pack("<I", zlib.crc32(data[start : end - 4])))
