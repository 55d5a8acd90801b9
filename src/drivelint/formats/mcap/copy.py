"""This module copies a recorded MCAP file into an annotated one, and adds the indexes that it lacks.

Chunks are copied as they are. Two things are added where a log lacks them, because readers seek by them: message indexes
behind a chunk, and a chunk around messages that stand outside of any.
"""

from __future__ import annotations

import hashlib
import io
import mmap
import os
import struct
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, BinaryIO, Final, NamedTuple, Self

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import AttachmentIndex, Channel, Chunk, ChunkIndex, Footer, MetadataIndex, Schema, Statistics
from mcap.stream_reader import get_chunk_data_stream

from drivelint.errors import ChangedLogError, TraceError
from drivelint.formats.mcap.resume import MAGIC
from drivelint.formats.mcap.summary import summary_is_whole

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.formats.mcap.writer import Sink

ChunkMessageIndex = dict[int, "NDArray[np.uint64]"]

_HEAD: Final = struct.Struct("<BQ")
_TIMES: Final = struct.Struct("<QQ")
_MESSAGE: Final = struct.Struct("<HIQ")
_INDEX: Final = struct.Struct("<HI")
_LOOSE: Final = frozenset({Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE})
_SUMMARY: Final = frozenset({
    Opcode.DATA_END, Opcode.FOOTER, Opcode.CHUNK_INDEX, Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX, Opcode.STATISTICS,
    Opcode.SUMMARY_OFFSET,
})  # fmt: skip
LOOSE_CHUNK_BYTES: Final = 4 << 20
"""Messages outside of chunks are put into chunks of about this size."""
_BLOCK: Final = 4 << 20
_HEAD_BYTES: Final = 1 << 17  # names and times of an attachment or a chunk, without what is in it


class Record(NamedTuple):
    """A record: its opcode, where it begins (its head included), where its body begins, where it ends."""

    opcode: int
    at: int
    body: int
    end: int


class Original:
    """An MCAP file, mapped into memory and read by its record heads alone wherever that is enough.

    The file was read and checked by ingest; `sha256` is what it was then. `indexed`: its chunks' message indexes can be relied on.
    Errors: `TraceError` where it is damaged or was changed since.
    """

    def __init__(self, path: Path, sha256: str) -> None:
        self.path = path
        self._sha256 = sha256
        self._file = _opened(path)  # closed by leaving the `with` that this object is made for
        # mapped for the record heads alone: what is read through a map counts as memory of this process
        self._view = memoryview(mmap.mmap(self._file.fileno(), 0, access=mmap.ACCESS_READ))
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.indexed = self._survey()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._view.release()
        self._file.close()

    def copy(self, sink: Sink) -> None:
        """Copy the data into a fresh sink and tell its index what was copied."""
        with ThreadPoolExecutor(max_workers=1) as pool:
            digest = pool.submit(self._digest)
            _Copy(self, sink).run()
            if digest.result() != self._sha256:
                raise ChangedLogError(
                    f"{self.path}: the log changed while it was judged: check it again when it is complete"
                )

    def records(self, at: int = len(MAGIC)) -> Iterator[Record]:
        """Yield the records of the file from byte `at` on, the footer being the last."""
        size = len(self._view)
        while at + _HEAD.size <= size:
            opcode, length = _HEAD.unpack_from(self._view, at)
            record = Record(opcode, at, at + _HEAD.size, at + _HEAD.size + length)
            if record.end > size:
                break
            yield record
            if opcode == Opcode.FOOTER:
                return
            at = record.end
        raise self.damage_error(at)

    def damage_error(self, at: int) -> TraceError:
        """Return the error for a record that cannot be read."""
        return TraceError(f"{self.path}: the log changed or is damaged at byte {at}: check it again")

    @contextmanager
    def parsing(self, record: Record) -> Iterator[None]:
        """Turn what the library raises of a record that cannot be understood into a `TraceError`."""
        try:
            yield
        except (McapError, struct.error, ValueError) as error:
            raise self.damage_error(record.at) from error

    def read(self, start: int, end: int) -> bytes:
        """Return bytes of the file."""
        try:
            content = os.pread(self._file.fileno(), end - start, start)
        except OSError as error:
            raise _unreadable(self.path, error) from error
        if len(content) != end - start:
            raise self.damage_error(start)
        return content

    def stream(self, record: Record, most: int | None = None) -> ReadDataStream:
        """Return the body of a record, to be read field by field; `most`: so many bytes, for the fields before its data."""
        end = record.end if most is None else min(record.end, record.body + most)
        return ReadDataStream(io.BytesIO(self.read(record.body, end)))

    def chunk_records(self, record: Record) -> Iterator[tuple[int, int, memoryview]]:
        """Yield opcode, offset within the chunk and body of every record of a chunk."""
        with self.parsing(record):
            stream, size = get_chunk_data_stream(Chunk.read(self.stream(record)), validate_crc=True)
            view = memoryview(stream.read(size))
        at = 0
        while at < len(view):
            opcode, length = _HEAD.unpack_from(view, at)
            yield opcode, at, view[at + _HEAD.size : at + _HEAD.size + length]
            at += _HEAD.size + length

    def chunk_message_index(self, record: Record) -> ChunkMessageIndex:
        """Unpack a chunk to find where its messages are."""
        inside = (each for each in self.chunk_records(record) if each[0] == Opcode.MESSAGE)
        return index_arrays((*_MESSAGE.unpack_from(body), at) for _, at, body in inside)

    def message_index_header(self, record: Record) -> tuple[int, int]:
        """Return channel and number of entries of a message index record."""
        channel, length = _INDEX.unpack_from(self._view, record.body)
        return channel, length // 16

    def message_header(self, record: Record) -> tuple[int, int, int]:
        """Return channel, sequence number and log time of a message record."""
        channel, sequence, log_time = _MESSAGE.unpack_from(self._view, record.body)
        return channel, sequence, log_time

    def _survey(self) -> bool:
        """Find schemas and channels, from the summary if it agrees with the data, else from the chunks; say whether it agrees."""
        named: set[int] = set()
        chunks: list[Record] = []
        data: list[Record] = []
        summary: list[Record] = []
        messages, behind_chunk, part = 0, False, data
        for record in self.records():
            behind_chunk = record.opcode == Opcode.CHUNK or (behind_chunk and record.opcode == Opcode.MESSAGE_INDEX)
            if record.opcode in {Opcode.DATA_END, Opcode.FOOTER}:
                part = summary
            if record.opcode == Opcode.CHUNK:
                chunks.append(record)
            elif record.opcode == Opcode.MESSAGE:
                messages += 1
            elif record.opcode == Opcode.MESSAGE_INDEX and behind_chunk:
                channel_id, n = self.message_index_header(record)
                named.add(channel_id)
                messages += n
            else:
                part.append(record)
        self.schemas, self.channels, _ = self._announced(data)
        counts: Statistics | None = None
        with suppress(TraceError):  # the data are enough
            schemas, channels, counts = self._announced(summary)
            self.schemas, self.channels = schemas | self.schemas, channels | self.channels
        if not chunks or self._agrees(counts, messages, named):
            return True
        self._look_inside(chunks)
        return False

    def _announced(self, records: list[Record]) -> tuple[dict[int, Schema], dict[int, Channel], Statistics | None]:
        """Return the schemas, channels and counts among records. Errors: `TraceError` for one that is damaged."""
        schemas: dict[int, Schema] = {}
        channels: dict[int, Channel] = {}
        counts: Statistics | None = None
        for record in records:
            with self.parsing(record):
                if record.opcode == Opcode.SCHEMA:
                    schema = Schema.read(self.stream(record))
                    schemas.setdefault(schema.id, schema)
                elif record.opcode == Opcode.CHANNEL:
                    channel = Channel.read(self.stream(record))
                    channels.setdefault(channel.id, channel)
                elif record.opcode == Opcode.STATISTICS:
                    counts = Statistics.read(self.stream(record))
                elif record.opcode == Opcode.FOOTER and not summary_is_whole(
                    Footer.read(self.stream(record)), self._view, record.at, record.end
                ):
                    raise self.damage_error(record.at)
        return schemas, channels, counts

    def _look_inside(self, chunks: list[Record]) -> None:
        for chunk in chunks:
            with self.parsing(chunk):
                for opcode, _, body in self.chunk_records(chunk):
                    if opcode == Opcode.SCHEMA:
                        schema = Schema.read(ReadDataStream(io.BytesIO(body)))
                        self.schemas[schema.id] = schema
                    elif opcode == Opcode.CHANNEL:
                        channel = Channel.read(ReadDataStream(io.BytesIO(body)))
                        self.channels[channel.id] = channel

    def _agrees(self, counts: Statistics | None, messages: int, named: set[int]) -> bool:
        """Whether the summary names every channel and schema, and the message indexes know of every message."""
        return (
            counts is not None
            and counts.message_count == messages
            and counts.channel_count == len(self.channels)
            and counts.schema_count == len(self.schemas)
            and named <= self.channels.keys()
            and all(c.schema_id == 0 or c.schema_id in self.schemas for c in self.channels.values())
        )

    def _digest(self) -> str:
        digest = hashlib.sha256()
        for start in range(0, len(self._view), _BLOCK):
            digest.update(self.read(start, min(start + _BLOCK, len(self._view))))
        return digest.hexdigest()


def is_mcap(path: Path) -> bool:
    """Whether a trace is an MCAP file, by its first bytes."""
    if path.is_dir():
        return False
    with _opened(path) as file:
        return file.read(len(MAGIC)) == MAGIC


def _opened(path: Path) -> BinaryIO:
    try:
        return path.open("rb")
    except OSError as error:
        raise _unreadable(path, error) from error


def _unreadable(path: Path, error: OSError) -> TraceError:
    return TraceError(f"{path}: the log cannot be read any more ({error.strerror or error}): check it again")


class _Copy:
    """One copying: bytes wait to be written in one go, from `_from` on, as long as nothing must be put between them."""

    def __init__(self, original: Original, sink: Sink) -> None:
        self._original = original
        self._sink = sink
        self._from = 0
        self._to = 0
        self._loose: list[Record] = []
        self._chunk: tuple[Record, ChunkIndex] | None = None

    def run(self) -> None:
        """Copy everything before the end of the data."""
        self._sink.schemas.update(self._original.schemas)
        self._sink.channels.update(self._original.channels)
        self._to = len(MAGIC)
        for record in self._original.records():
            if record.opcode in _SUMMARY:
                break
            if record.opcode != Opcode.MESSAGE_INDEX:
                self._end_chunk()
            if record.opcode in _LOOSE:
                self._loose.append(record)
                if record.end - self._loose[0].at >= LOOSE_CHUNK_BYTES:
                    self._end_loose()
                continue
            self._end_loose()
            if record.opcode == Opcode.MESSAGE_INDEX:
                self._take_index(record)
            else:
                with self._original.parsing(record):
                    self._note(record)
                self._keep(record)
        self._end_chunk()
        self._end_loose()
        self._flush()

    def _keep(self, record: Record) -> None:
        self._to = record.end
        if self._to - self._from > _BLOCK:
            self._flush()

    def _flush(self) -> None:
        for start in range(self._from, self._to, _BLOCK):
            self._sink.write(self._original.read(start, min(start + _BLOCK, self._to)))
        self._from = self._to

    def _place(self, at: int) -> int:
        """Return where a byte of the original that is waiting will be in the copy."""
        return self._sink.offset + at - self._from

    def _note(self, record: Record) -> None:
        """Tell the index of a record that will be copied."""
        start, length = self._place(record.at), record.end - record.at
        head = self._original.stream(record, _HEAD_BYTES)
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

    def _take_index(self, record: Record) -> None:
        """Copy a message index that can be relied on; another is left out and found anew."""
        if self._chunk is None or not self._original.indexed:
            self._flush()
            self._from = self._to = record.end
            return
        channel, n = self._original.message_index_header(record)
        self._chunk[1].message_index_offsets[channel] = self._place(record.at)
        self._chunk[1].message_index_length += record.end - record.at
        self._sink.counts[channel] += n
        self._keep(record)

    def _end_chunk(self) -> None:
        if self._chunk is None:
            return
        (record, index), self._chunk = self._chunk, None
        if self._original.indexed:
            self._sink.chunks.append(index)
            return
        self._flush()
        self._sink.index_chunk(index, self._original.chunk_message_index(record))

    def _end_loose(self) -> None:
        """Put messages outside of chunks, and what was announced between them, into a chunk; announcements alone stay."""
        if not self._loose:
            return
        loose, self._loose = self._loose, []
        start, end = loose[0].at, loose[-1].end
        messages = [record for record in loose if record.opcode == Opcode.MESSAGE]
        if messages:
            self._flush()
            index = index_arrays((*self._original.message_header(each), each.at - start) for each in messages)
            self._sink.add_chunk(self._original.read(start, end), index, compressed=False)
            self._from = end
        self._to = end


def index_arrays(messages: Iterable[tuple[int, int, int, int]]) -> ChunkMessageIndex:
    """Return the index of messages (channel, sequence number, log time, offset): by channel an array of log time and offset."""
    entries: dict[int, list[tuple[int, int]]] = {}
    for channel, _, log_time, at in messages:
        entries.setdefault(channel, []).append((log_time, at))
    return {channel: np.array(pairs, np.uint64) for channel, pairs in sorted(entries.items())}
