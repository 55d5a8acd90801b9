"""Splits a stream into OSI messages, each preceded by its length, and reads their times without decoding them."""

from __future__ import annotations

from typing import Final

from drivelint.formats.osi.schema import GROUND_TRUTH, SENSOR_VIEW
from drivelint.formats.osi.trace_file import LENGTH_FIELD_BYTES, MOST_MESSAGE_BYTES, may_be_osi_trace
from drivelint.formats.protobuf.scan import fields, signed_integer

_NS_PER_S: Final = 1_000_000_000
_TIMESTAMP, _TRUTH, _MOVING_OBJECT, _BASE, _POSITION = 2, 7, 5, 2, 2
"""Field numbers: the time stamp, the ground truth of a sensor view, and the path from a ground truth to an object's position."""


class MessageCutter:
    """Splits bytes that arrive piece by piece into messages, and finds the same damage as `formats.osi.trace_file`.

    `trouble`: the damage at which the splitting stopped; None: no damage was found.
    """

    def __init__(self) -> None:
        self.trouble: str | None = None
        self._buffer = bytearray()
        self._at = 0  # the byte of the stream at which the buffer begins

    def cut(self, data: bytes, *, ended: bool = False) -> list[bytes]:
        """Add bytes, and return the complete messages. `ended`: no more bytes come, so that a remainder is `trouble`."""
        self._buffer += data
        messages: list[bytes] = []
        place = 0
        while self.trouble is None:
            begin = place + LENGTH_FIELD_BYTES
            length = int.from_bytes(self._buffer[place:begin], "little")
            end = begin + length
            if len(self._buffer) < begin or (0 < length <= MOST_MESSAGE_BYTES and len(self._buffer) < end):
                if ended and len(self._buffer) > place:
                    self._stop_cutting(
                        place, f"it ends after {len(self._buffer) - place} bytes of the message that begins"
                    )
                break
            if not 0 < length <= MOST_MESSAGE_BYTES:
                self._stop_cutting(place, f"no message, but one of {length} bytes, begins")
                break
            sure = _is_message_start(self._buffer, place)
            if not sure and not ended and len(self._buffer) < end + LENGTH_FIELD_BYTES + 1:
                break  # the following bytes show whether the length was right
            if not sure and len(self._buffer) > end and not _is_message_start(self._buffer, end):
                self._stop_cutting(place, f"no message of {length} bytes and another one behind it begin")
                break
            messages.append(bytes(self._buffer[begin:end]))
            place = end
        del self._buffer[:place]
        self._at += place
        return messages

    def _stop_cutting(self, place: int, reason: str) -> None:
        self.trouble = f"{reason} at byte {self._at + place}"


def _is_message_start(buffer: bytearray, at: int) -> bool:
    """Return whether a message and its length may begin at byte `at`."""
    return may_be_osi_trace(bytes(buffer[at : at + LENGTH_FIELD_BYTES + 1]), LENGTH_FIELD_BYTES + MOST_MESSAGE_BYTES)


def message_kind(data: bytes) -> str | None:
    """Return the type of a message, ground truth or sensor view, by the place of its objects; None: it has no objects."""
    try:
        if _has_object_positions(data, 0, len(data)):
            return GROUND_TRUTH
        truths = [field for field in fields(data) if field.number == _TRUTH]
    except ValueError:
        return None
    for truth in truths:
        try:
            if _has_object_positions(data, truth.start, truth.end):
                return SENSOR_VIEW
        except ValueError:
            continue
    return None


def _has_object_positions(data: bytes, start: int, end: int) -> bool:
    spans = [(start, end)]
    for number in (_MOVING_OBJECT, _BASE, _POSITION):
        spans = [(f.start, f.end) for span in spans for f in fields(data, *span) if f.number == number]
    return bool(spans)


def message_time_ns(data: bytes, kind: str | None) -> int | None:
    """Return the time of a message (for a sensor view, of its ground truth) in nanoseconds; None: it has no time."""
    try:
        inner = outer = None
        for field in fields(data):
            if field.number == _TIMESTAMP:
                outer = _time_ns(data, field.start, field.end)
                if kind != SENSOR_VIEW:
                    break
            elif field.number == _TRUTH and kind == SENSOR_VIEW:
                stamps = (f for f in fields(data, field.start, field.end) if f.number == _TIMESTAMP)
                inner = next((_time_ns(data, f.start, f.end) for f in stamps), inner)
    except ValueError:
        return None
    return outer if inner is None else inner


def is_complete_message(data: bytes) -> bool:
    """Return whether bytes are a complete sequence of protobuf fields that includes a time stamp."""
    try:
        numbers = {field.number for field in fields(data)}  # a set, so that all fields are read
    except ValueError:
        return False
    return _TIMESTAMP in numbers


def _time_ns(data: bytes, start: int, end: int) -> int:
    parts = {field.number: field.value for field in fields(data, start, end)}
    return signed_integer(parts.get(1, 0)) * _NS_PER_S + parts.get(2, 0)
