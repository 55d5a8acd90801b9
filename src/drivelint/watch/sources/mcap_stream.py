"""Reads an MCAP file while it grows: only complete records, each once, and each chunk unpacked once."""

from __future__ import annotations

import io
import struct
from typing import TYPE_CHECKING, Final, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Metadata, Schema

from drivelint.errors import TraceError
from drivelint.formats.mcap import reader
from drivelint.formats.mcap.chunk import MAX_CHUNK_BYTES, ChunkError, chunk_records, parse_chunk
from drivelint.formats.mcap.resume import MAGIC

if TYPE_CHECKING:
    from collections.abc import Iterator

RECORD_HEADER: Final = struct.Struct("<BQ")
MESSAGE_HEADER: Final = struct.Struct("<HIQQ")
MOST_RECORD_BYTES: Final = MAX_CHUNK_BYTES + (1 << 20)
"""The longest record of the kinds that are read: a greater length is damage. Other records, such as attachments, may be longer."""
_READABLE_OPCODES: Final = frozenset(
    {Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE, Opcode.CHUNK, Opcode.METADATA, Opcode.DATA_END}
)
_STANDARD_OPCODES: Final = frozenset(Opcode)
_FIRST_PRIVATE_OPCODE: Final = 0x80
"""The first of the opcodes that applications may define."""
_FOOTER_BYTES: Final = 20


class MessageRecord(NamedTuple):
    """A message record: the id of its channel, its log time, and the unchanged bytes of the record, with its header."""

    channel: int
    log_ns: int
    record: bytes

    @property
    def content(self) -> bytes:
        """The data of the message, without any header."""
        return self.record[RECORD_HEADER.size + MESSAGE_HEADER.size :]

    def with_content(self, content: bytes) -> MessageRecord:
        """Return a message of the same channel and times with other data."""
        head = RECORD_HEADER.pack(Opcode.MESSAGE, MESSAGE_HEADER.size + len(content))
        return self._replace(
            record=head + self.record[RECORD_HEADER.size : RECORD_HEADER.size + MESSAGE_HEADER.size] + content
        )


class NumberedMessage(NamedTuple):
    """A message and its number among all watched messages of the file."""

    number: int
    message: MessageRecord


class DamagedChunk(NamedTuple):
    """The unchanged bytes of a chunk record that cannot be read."""

    record: bytes


class McapStream:
    """Parses the bytes of an MCAP file piece by piece.

    `schemas`, `channels`: id -> record, for the records read so far; `metadata`: name -> the first record with this name.
    `ended`: the file is complete, or its remainder cannot be read; `notes`: the reason for this, and other problems.
    """

    def __init__(self, where: str) -> None:
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.metadata: dict[str, dict[str, str]] = {}
        self.ended = False
        self.notes: list[str] = []
        self._where = where
        self._buffer = bytearray()
        self._at = 0  # the byte of the file at which the buffer begins
        self._place = 0  # the position in the buffer up to which it was read
        self._skip = 0  # the number of bytes to skip from there on
        self._magic_is_read = False
        self._in_data = True

    def parse(self, data: bytes) -> list[MessageRecord | DamagedChunk]:
        """Add bytes, and return the messages that are complete, in the order of the file.

        Errors: `TraceError` if the file is no MCAP file, or has a chunk that no reader accepts.
        """
        self._buffer += data
        records: list[MessageRecord | DamagedChunk] = []
        if self._magic_is_read or self._try_to_read_magic():
            while (record := self._next_record()) is not None:
                at = self._at + self._place - len(record)
                try:
                    records += self._read_record(record, at)
                except (struct.error, McapError, ValueError) as error:
                    self._stop_reading(at, f"a record that cannot be read ({error})")
        del self._buffer[: self._place]
        self._at += self._place
        self._place = 0
        return records

    def _try_to_read_magic(self) -> bool:
        head = bytes(self._buffer[: len(MAGIC)])
        if not MAGIC.startswith(head):
            raise TraceError(f"{self._where}: not an MCAP file: it begins with {head!r}")
        if len(head) == len(MAGIC):
            self._magic_is_read, self._place = True, len(MAGIC)
        return self._magic_is_read

    def _stop_reading(self, at: int, reason: str) -> None:
        self.ended = True
        self.notes.append(f"{self._where}: {reason} at byte {at}: nothing after it is watched")

    def _next_record(self) -> bytes | None:
        """Return the next record; None: it is not complete yet, or no more records follow."""
        while not self.ended:
            skipped = min(self._skip, len(self._buffer) - self._place)
            self._skip -= skipped
            self._place += skipped
            if self._skip or len(self._buffer) < self._place + RECORD_HEADER.size:
                return None
            opcode, length = RECORD_HEADER.unpack_from(self._buffer, self._place)
            end = self._place + RECORD_HEADER.size + length
            is_read = self._in_data and opcode in _READABLE_OPCODES
            unknown = opcode not in _STANDARD_OPCODES and opcode < _FIRST_PRIVATE_OPCODE
            if unknown or length > (MOST_RECORD_BYTES if is_read else reader.MOST_RECORD_BYTES):
                self._stop_reading(self._at + self._place, f"no record, but one of kind {opcode} and {length} bytes,")
            elif opcode == Opcode.FOOTER:
                tail = bytes(self._buffer[end : end + len(MAGIC)])
                self.ended = tail == MAGIC or not MAGIC.startswith(tail) or length != _FOOTER_BYTES
                if not self.ended:
                    return None
            elif not is_read:
                self._skip = RECORD_HEADER.size + length
            elif len(self._buffer) < end:
                return None
            else:
                record = bytes(self._buffer[self._place : end])
                self._place = end
                return record
        return None

    def _read_record(self, record: bytes, at: int) -> Iterator[MessageRecord | DamagedChunk]:
        body = record[RECORD_HEADER.size :]
        opcode = record[0]
        if opcode == Opcode.CHUNK:
            yield from self._messages_of_chunk(record, at)
        elif opcode == Opcode.DATA_END:
            self._in_data = False
        elif opcode == Opcode.METADATA:
            metadata = Metadata.read(_data_stream(body))
            self.metadata.setdefault(metadata.name, metadata.metadata)
        else:
            yield from self._messages_of_record(opcode, record, at)

    def _messages_of_chunk(self, record: bytes, at: int) -> Iterator[MessageRecord | DamagedChunk]:
        try:
            head = parse_chunk(memoryview(record)[RECORD_HEADER.size :])
            records = chunk_records(head, f"{self._where}: byte {at}")
        except ChunkError as error:
            if not error.has_valid_length:
                self._stop_reading(at, str(error))
                return
            self.notes.append(f"{self._where}: {error} at byte {at}: its content is lost")
            yield DamagedChunk(record)
            return
        place = 0
        while place + RECORD_HEADER.size <= len(records):
            opcode, length = RECORD_HEADER.unpack_from(records, place)
            end = place + RECORD_HEADER.size + length
            if end > len(records):
                break
            yield from self._messages_of_record(opcode, records[place:end], at)
            place = end
        if place < len(records):
            self.notes.append(f"{self._where}: a chunk that ends within a record at byte {at}: its rest is lost")
            yield DamagedChunk(record)

    def _messages_of_record(self, opcode: int, record: bytes, at: int) -> Iterator[MessageRecord]:
        """Store a schema or a channel, or yield a message."""
        if opcode == Opcode.MESSAGE:
            number, _, log_ns, _ = MESSAGE_HEADER.unpack_from(record, RECORD_HEADER.size)
            if number in self.channels:
                yield MessageRecord(number, log_ns, record)
            else:
                self.notes.append(
                    f"{self._where}: a message on channel {number}, which was never declared, at byte {at}"
                )
        elif opcode == Opcode.SCHEMA:
            schema = Schema.read(_data_stream(record[RECORD_HEADER.size :]))
            self.schemas[schema.id] = schema
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(_data_stream(record[RECORD_HEADER.size :]))
            self.channels[channel.id] = channel


def _data_stream(body: bytes) -> ReadDataStream:
    return ReadDataStream(io.BytesIO(body))
