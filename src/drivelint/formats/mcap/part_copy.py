"""Appends the data of one MCAP file to a copy, and adds missing indexes.

Chunks are copied unchanged. Readers seek by message indexes and chunks, so two things are added if the log lacks them: message indexes
after a chunk, and a chunk around messages that are in none. If a part of a split log uses an id for another channel or schema than
an earlier part, its records get new ids; the content of messages stays the same.
"""

from __future__ import annotations

import io
import struct
from dataclasses import replace
from typing import TYPE_CHECKING, Final, TypeVar

from mcap.data_stream import ReadDataStream, RecordBuilder
from mcap.opcode import Opcode
from mcap.records import AttachmentIndex, Channel, ChunkIndex, MetadataIndex, Schema

from drivelint.formats.mcap.original import message_index
from drivelint.formats.mcap.resume import MAGIC
from drivelint.formats.mcap.writer import unused_id

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.formats.mcap.original import OriginalFile, Record
    from drivelint.formats.mcap.writer import Sink

T = TypeVar("T", Schema, Channel)
_RECORD_HEADER: Final = struct.Struct("<BQ")
_MESSAGE_HEADER: Final = struct.Struct("<HIQ")
_ID: Final = struct.Struct("<H")
_LOOSE_OPCODES: Final = frozenset({Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE})
_SUMMARY_OPCODES: Final = frozenset({
    Opcode.DATA_END, Opcode.FOOTER, Opcode.CHUNK_INDEX, Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX, Opcode.STATISTICS,
    Opcode.SUMMARY_OFFSET,
})  # fmt: skip
BYTES_PER_CHUNK_OF_LOOSE_MESSAGES: Final = 4 << 20
"""Messages outside of chunks are put into chunks of about this size."""
_COPIED_BLOCK_BYTES: Final = 4 << 20
_MOST_BYTES_BEFORE_RECORD_DATA: Final = (
    1 << 17
)  # enough for the names and times of an attachment or a chunk, without its data


class IdsInCopy:
    """The ids of a part's schemas and channels: id in the part -> id in the copy.

    A schema or channel that is already in the sink has the sink's id. A new one keeps its id if that is free, and is added to the sink.
    """

    def __init__(self, original: OriginalFile, sink: Sink) -> None:
        self.schemas: dict[int, int] = {0: 0}
        for number, schema in sorted(original.schemas.items()):
            self.schemas[number] = _id_in_copy(schema, sink.schemas, "schema", least=1)
            sink.schemas.setdefault(self.schemas[number], replace(schema, id=self.schemas[number]))
        self.channels: dict[int, int] = {}
        for number, channel in sorted(original.channels.items()):
            there = replace(channel, schema_id=self.schemas.get(channel.schema_id, channel.schema_id))
            self.channels[number] = _id_in_copy(there, sink.channels, "channel", least=0)
            sink.channels.setdefault(self.channels[number], replace(there, id=self.channels[number]))

    @property
    def are_unchanged(self) -> bool:
        """Whether every id is the same in the copy."""
        return all(old == new for numbers in (self.schemas, self.channels) for old, new in numbers.items())


def _id_in_copy(declaration: T, records_by_id: dict[int, T], kind: str, *, least: int) -> int:
    same = [number for number, earlier in records_by_id.items() if replace(earlier, id=0) == replace(declaration, id=0)]
    if declaration.id not in records_by_id or declaration.id in same:
        return declaration.id
    return min(same) if same else unused_id(records_by_id, least, kind)


class PartCopy:
    """Copies one part. Consecutive records are written together: bytes `_from` to `_to` of the original are still to be written."""

    def __init__(self, original: OriginalFile, sink: Sink) -> None:
        self._original = original
        self._sink = sink
        self._from = 0
        self._to = 0
        self._loose: list[Record] = []
        self._chunk: tuple[Record, ChunkIndex] | None = None
        self._is_first = sink.offset == 0
        self._ids = IdsInCopy(original, sink)
        self._has_new_ids = not self._ids.are_unchanged

    def run(self) -> None:
        """Copy all records before the end of the data section."""
        self._to = len(MAGIC)
        if not self._is_first:
            self._from = self._to
        for record in self._original.records():
            if record.opcode in _SUMMARY_OPCODES:
                break
            if record.opcode != Opcode.MESSAGE_INDEX:
                self._index_last_chunk()
            if record.opcode in _LOOSE_OPCODES:
                self._loose.append(record)
                if record.end - self._loose[0].at >= BYTES_PER_CHUNK_OF_LOOSE_MESSAGES:
                    self._write_loose_records()
                continue
            self._write_loose_records()
            if record.opcode == Opcode.MESSAGE_INDEX:
                self._copy_message_index(record)
            elif record.opcode == Opcode.HEADER and not self._is_first:
                self._skip_record(record)
            elif record.opcode == Opcode.CHUNK and self._has_new_ids:
                self._skip_record(record)
                self._write_with_new_ids((opcode, body) for opcode, _, body in self._original.chunk_records(record))
            else:
                with self._original.convert_sqlite_errors(record):
                    self._add_to_index(record)
                self._copy_record(record)
        self._index_last_chunk()
        self._write_loose_records()
        self._flush()

    def _copy_record(self, record: Record) -> None:
        self._to = record.end
        if self._to - self._from > _COPIED_BLOCK_BYTES:
            self._flush()

    def _skip_record(self, record: Record) -> None:
        """Leave a record out of the copy."""
        self._flush()
        self._from = self._to = record.end

    def _write_with_new_ids(self, records: Iterable[tuple[int, bytes | memoryview]]) -> None:
        """Write schemas, channels and messages (opcode, body) with their ids in the copy; as a chunk, if there are messages."""
        parts: list[bytes | memoryview] = []
        messages: list[tuple[int, int, int, int]] = []
        at = 0
        for opcode, body in records:
            new = self._body_with_new_ids(opcode, body)
            if opcode == Opcode.MESSAGE:
                messages.append((*_MESSAGE_HEADER.unpack_from(new), at))
            parts += [_RECORD_HEADER.pack(opcode, len(new)), new]
            at += _RECORD_HEADER.size + len(new)
        content = b"".join(parts)
        if messages:
            self._sink.add_chunk(content, message_index(messages))
        else:
            self._sink.write(content)

    def _body_with_new_ids(self, opcode: int, body: bytes | memoryview) -> bytes | memoryview:
        if opcode == Opcode.MESSAGE:
            (number,) = _ID.unpack_from(body)
            return _ID.pack(self._ids.channels[number]) + body[_ID.size :]
        if opcode not in _LOOSE_OPCODES:
            return body
        stream = ReadDataStream(io.BytesIO(body))
        if opcode == Opcode.SCHEMA:
            declaration: Schema | Channel = self._sink.schemas[self._ids.schemas[Schema.read(stream).id]]
        else:
            declaration = self._sink.channels[self._ids.channels[Channel.read(stream).id]]
        builder = RecordBuilder()
        declaration.write(builder)
        return bytes(builder.end())[_RECORD_HEADER.size :]  # type: ignore[no-untyped-call]

    def _flush(self) -> None:
        for start in range(self._from, self._to, _COPIED_BLOCK_BYTES):
            self._sink.write(self._original.read(start, min(start + _COPIED_BLOCK_BYTES, self._to)))
        self._from = self._to

    def _offset_in_copy(self, at: int) -> int:
        """Return the offset that byte `at` of the original, which is not yet written, will have in the copy."""
        return self._sink.offset + at - self._from

    def _add_to_index(self, record: Record) -> None:
        """Add a chunk, attachment or metadata record, which will be copied, to the index of the copy."""
        start, length = self._offset_in_copy(record.at), record.end - record.at
        head = self._original.body_stream(record, _MOST_BYTES_BEFORE_RECORD_DATA)
        if record.opcode == Opcode.CHUNK:
            begin, end, size, _crc = head.read8(), head.read8(), head.read8(), head.read4()
            self._chunk = record, ChunkIndex(
                chunk_length=length, chunk_start_offset=start, compression=head.read_prefixed_string(),
                compressed_size=head.read8(), message_end_time=end, message_index_length=0, message_index_offsets={},
                message_start_time=begin, uncompressed_size=size,
            )  # fmt: skip
        elif record.opcode == Opcode.ATTACHMENT:
            log_time, create_time = head.read8(), head.read8()
            name, media_type = head.read_prefixed_string(), head.read_prefixed_string()
            self._sink.attachments.append(AttachmentIndex(
                offset=start, length=length, log_time=log_time, create_time=create_time, data_size=head.read8(),
                name=name, media_type=media_type,
            ))  # fmt: skip
        elif record.opcode == Opcode.METADATA:
            self._sink.metadata.append(MetadataIndex(offset=start, length=length, name=head.read_prefixed_string()))

    def _copy_message_index(self, record: Record) -> None:
        """Copy a message index if it follows a chunk and the original's indexes are complete; otherwise leave it out."""
        if self._chunk is None or not self._original.has_complete_indexes:
            self._skip_record(record)
            return
        channel, n = self._original.channel_and_n_messages(record)
        self._chunk[1].message_index_offsets[channel] = self._offset_in_copy(record.at)
        self._chunk[1].message_index_length += record.end - record.at
        self._sink.counts[channel] += n
        self._copy_record(record)

    def _index_last_chunk(self) -> None:
        if self._chunk is None:
            return
        (record, index), self._chunk = self._chunk, None
        if self._original.has_complete_indexes:
            self._sink.chunks.append(index)
            return
        self._flush()
        self._sink.index_chunk(index, self._original.chunk_message_index(record))

    def _write_loose_records(self) -> None:
        """Write messages outside of chunks, with the schemas and channels between them, as a chunk; without messages, copy the records."""
        if not self._loose:
            return
        loose, self._loose = self._loose, []
        start, end = loose[0].at, loose[-1].end
        messages = [record for record in loose if record.opcode == Opcode.MESSAGE]
        if self._has_new_ids:
            self._flush()
            self._write_with_new_ids(
                (record.opcode, self._original.read(record.body_at, record.end)) for record in loose
            )
            self._from = end
        elif messages:
            self._flush()
            index = message_index((*self._original.message_header(record), record.at - start) for record in messages)
            self._sink.add_chunk(self._original.read(start, end), index, compressed=False)
            self._from = end
        self._to = end
