"""Finds the fields of a protobuf message without decoding their content."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

_VARINT, _FIXED64, _BYTES, _FIXED32 = 0, 1, 2, 5
_BYTES_BY_FIXED_KIND: Final = {_FIXED64: 8, _FIXED32: 4}
_MOST_VARINT_BYTES: Final = 10


class Field(NamedTuple):
    """A field. `value`: the unsigned 64-bit integer of a varint field, otherwise 0; `start`, `end`: the bytes of the content."""

    number: int
    value: int
    start: int
    end: int


def fields(data: bytes, start: int = 0, end: int | None = None) -> Iterator[Field]:
    """Yield the fields of the message in bytes `start` to `end`. Errors: `ValueError` for bytes that are no field."""
    at, stop = start, len(data) if end is None else end
    while at < stop:
        key, at = _read_varint(data, at, stop)
        kind, value = key & 7, 0
        if key >> 3 == 0:
            raise ValueError("a field without a number")
        if kind == _VARINT:
            begin = at
            value, at = _read_varint(data, at, stop)
        elif kind == _BYTES:
            length, begin = _read_varint(data, at, stop)
            at = begin + length
        elif kind in _BYTES_BY_FIXED_KIND:
            begin = at
            at += _BYTES_BY_FIXED_KIND[kind]
        else:
            raise ValueError(f"a field of kind {kind}")
        if at > stop:
            raise ValueError("a field that ends after the end of its message")
        yield Field(key >> 3, value, begin, at)


def signed_integer(value: int) -> int:
    """Return the signed integer with the same 64 bits as an unsigned integer."""
    number: int = struct.unpack("<q", struct.pack("<Q", value))[0]
    return number


def _read_varint(data: bytes, at: int, stop: int) -> tuple[int, int]:
    """Return the varint at byte `at`, and the position of the next byte."""
    value = 0
    for shift in range(min(_MOST_VARINT_BYTES, stop - at)):
        byte = data[at + shift]
        value |= (byte & 0x7F) << 7 * shift
        if byte < 0x80:
            return value & 0xFFFFFFFFFFFFFFFF, at + shift + 1
    raise ValueError("an integer without an end")
