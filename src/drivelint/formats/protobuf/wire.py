"""Encodes protobuf fields, one at a time or as columns with one row per message."""

from __future__ import annotations

import struct
from typing import Final

import numpy as np
from numpy.typing import NDArray

VARINT, FIXED64, BYTES = 0, 1, 2  # protobuf's wire types
_ONE_BYTE_VARINTS: Final = [bytes([value]) for value in range(0x80)]
_NS_PER_S: Final = 1_000_000_000
_PADDED_VARINT_BYTES: Final = 5  # bytes of a varint of fixed width: 35 bits, seconds until the year 3058
Bytes = NDArray[np.uint8]


def varint(value: int) -> bytes:
    """Return a non-negative integer as protobuf's varint."""
    if value < 0x80:
        return _ONE_BYTE_VARINTS[value]
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def nested(number: int, content: bytes) -> bytes:
    """Return a field with a message or bytes."""
    return tag(number, BYTES) + varint(len(content)) + content


def text(number: int, content: str) -> bytes:
    """Return a field with text."""
    return nested(number, content.encode("utf-8", "replace"))


def integer(number: int, value: int) -> bytes:
    """Return a field with a non-negative integer, an enumeration value or a Boolean."""
    return tag(number, VARINT) + varint(value)


def doubles(*values: float, first_number: int = 1) -> bytes:
    """Return one field of type double per value, with consecutive numbers from `first_number` on (all below 16)."""
    keyed = [part for number, value in enumerate(values, first_number) for part in (number << 3 | FIXED64, value)]
    return struct.pack("<" + "Bd" * len(values), *keyed)


def time(number: int, t_ns: int) -> bytes:
    """Return a field with a Timestamp or a Duration."""
    return nested(number, integer(1, t_ns // _NS_PER_S) + integer(2, t_ns % _NS_PER_S))


def points(number: int, xyz: NDArray[np.float64]) -> bytes:
    """Return a repeated field of points. `xyz`: shape (n, 3)."""
    head = tag(number, BYTES) + varint(27)
    parts = [part for axis in range(3) for part in (tag(axis + 1, FIXED64), double_column(xyz[:, axis]))]
    return join_columns(len(xyz), head, *parts).tobytes()


def indices(number: int, values: NDArray[np.uint32]) -> bytes:
    """Return a packed repeated field of indices of four bytes (fixed32)."""
    return nested(number, np.ascontiguousarray(values, "<u4").tobytes())


def double_column(values: NDArray[np.float64]) -> Bytes:
    """Return the bytes of n doubles, with the shape (n, 8)."""
    return np.ascontiguousarray(values, "<f8").view(np.uint8).reshape(len(values), 8)


def timestamps(number: int, t_ns: NDArray[np.uint64]) -> Bytes:
    """Return Timestamp fields, one per row; all rows have the same length, because their integers are padded with zero groups."""
    parts = [integer_column(1, t_ns // _NS_PER_S), integer_column(2, t_ns % _NS_PER_S)]
    return join_columns(len(t_ns), tag(number, BYTES) + varint(2 * (_PADDED_VARINT_BYTES + 1)), *parts)


def integer_column(number: int, values: NDArray[np.uint64]) -> Bytes:
    """Return fields with integers below 2^35, one per row; all rows have the same length."""
    shifts = np.arange(_PADDED_VARINT_BYTES, dtype=np.uint64) * np.uint64(7)
    groups = ((values[:, None] >> shifts) & np.uint64(0x7F)).astype(np.uint8)
    groups[:, :-1] |= 0x80
    return join_columns(len(values), tag(number, VARINT), groups)


def join_columns(n_rows: int, *parts: bytes | Bytes) -> Bytes:
    """Return the parts joined row by row; parts of type `bytes` are repeated in all n rows."""
    widths = [len(part) if isinstance(part, bytes) else part.shape[1] for part in parts]
    out = np.empty((n_rows, sum(widths)), np.uint8)
    at = 0
    for part, width in zip(parts, widths, strict=True):
        out[:, at : at + width] = np.frombuffer(part, np.uint8) if isinstance(part, bytes) else part
        at += width
    return out


def tag(number: int, kind: int) -> bytes:
    """Return the tag of a field with its number and wire type."""
    return varint(number << 3 | kind)
