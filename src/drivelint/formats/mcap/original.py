"""Reads a recorded MCAP file for copying: only its record headers, wherever they are enough."""

from __future__ import annotations

import hashlib
import io
import mmap
import os
import struct
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, BinaryIO, Final, NamedTuple, Self

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Footer, Schema, Statistics
from mcap.stream_reader import get_chunk_data_stream

from drivelint.errors import TraceError
from drivelint.formats.mcap.resume import MAGIC
from drivelint.formats.mcap.summary import is_summary_intact

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray


ChunkMessageIndex = dict[int, "NDArray[np.uint64]"]

_RECORD_HEADER: Final = struct.Struct("<BQ")
_MESSAGE_HEADER: Final = struct.Struct("<HIQ")
_MESSAGE_INDEX_HEADER: Final = struct.Struct("<HI")
_HASHED_BLOCK_BYTES: Final = 4 << 20


class Record(NamedTuple):
    """A record: its opcode, and the bytes at which its header begins (`at`), its body begins (`body_at`) and it ends."""

    opcode: int
    at: int
    body_at: int
    end: int


class OriginalFile:
    """A mapped MCAP file. Only its record headers are read, wherever they are enough.

    `sha256`: the hash when the file was read and checked; None: the caller compares the hash of the whole log instead.
    `has_complete_indexes`: whether the message indexes of its chunks are complete.
    Errors: `TraceError` if the file is damaged, or was changed after it was checked.
    """

    def __init__(self, path: Path, sha256: str | None = None) -> None:
        self.path = path
        self.sha256 = sha256
        self._file = open_log(path)  # closed by `__exit__`
        # only record headers are read through the map: pages that are read through it count as memory of this process
        self._view = memoryview(mmap.mmap(self._file.fileno(), 0, access=mmap.ACCESS_READ))
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.has_complete_indexes = self._read_schemas_and_channels_and_return_are_indexes_complete()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._view.release()
        self._file.close()

    def records(self, at: int = len(MAGIC)) -> Iterator[Record]:
        """Yield the records from byte `at` up to and including the footer."""
        size = len(self._view)
        while at + _RECORD_HEADER.size <= size:
            opcode, length = _RECORD_HEADER.unpack_from(self._view, at)
            record = Record(opcode, at, at + _RECORD_HEADER.size, at + _RECORD_HEADER.size + length)
            if record.end > size:
                break
            yield record
            if opcode == Opcode.FOOTER:
                return
            at = record.end
        raise self.damage_error(at)

    def damage_error(self, at: int) -> TraceError:
        """Return the error for a record at byte `at` that cannot be read."""
        return TraceError(f"{self.path}: the log changed or is damaged at byte {at}: check it again")

    @contextmanager
    def convert_sqlite_errors(self, record: Record) -> Iterator[None]:
        """Convert errors of the MCAP library about this record to `TraceError`."""
        try:
            yield
        except (McapError, struct.error, ValueError) as error:
            raise self.damage_error(record.at) from error

    def read(self, start: int, end: int) -> bytes:
        """Return bytes `start` to `end` of the file."""
        try:
            content = os.pread(self._file.fileno(), end - start, start)
        except OSError as error:
            raise _unreadable_log_error(self.path, error) from error
        if len(content) != end - start:
            raise self.damage_error(start)
        return content

    def body_stream(self, record: Record, most_bytes: int | None = None) -> ReadDataStream:
        """Return a stream of a record's body; with `most_bytes`, only of its first bytes, which contain the fields before the data."""
        end = record.end if most_bytes is None else min(record.end, record.body_at + most_bytes)
        return ReadDataStream(io.BytesIO(self.read(record.body_at, end)))

    def chunk_records(self, record: Record) -> Iterator[tuple[int, int, memoryview]]:
        """Yield opcode, offset within the chunk and body of every record of a chunk."""
        with self.convert_sqlite_errors(record):
            stream, size = get_chunk_data_stream(Chunk.read(self.body_stream(record)), validate_crc=True)
            view = memoryview(stream.read(size))
        at = 0
        while at < len(view):
            opcode, length = _RECORD_HEADER.unpack_from(view, at)
            yield opcode, at, view[at + _RECORD_HEADER.size : at + _RECORD_HEADER.size + length]
            at += _RECORD_HEADER.size + length

    def chunk_message_index(self, record: Record) -> ChunkMessageIndex:
        """Return the message index of a chunk, made by unpacking the chunk."""
        inside = (record_inside for record_inside in self.chunk_records(record) if record_inside[0] == Opcode.MESSAGE)
        return message_index((*_MESSAGE_HEADER.unpack_from(body), at) for _, at, body in inside)

    def channel_and_n_messages(self, message_index: Record) -> tuple[int, int]:
        """Return the channel of a message index record, and the number of messages in it."""
        channel, length = _MESSAGE_INDEX_HEADER.unpack_from(self._view, message_index.body_at)
        return channel, length // 16

    def message_header(self, record: Record) -> tuple[int, int, int]:
        """Return channel, sequence number and log time of a message record."""
        channel, sequence, log_time = _MESSAGE_HEADER.unpack_from(self._view, record.body_at)
        return channel, sequence, log_time

    def _read_schemas_and_channels_and_return_are_indexes_complete(self) -> bool:
        """Set schemas and channels; return whether the indexes are complete. If not, the chunks are unpacked for schemas and channels."""
        indexed_channels: set[int] = set()
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
                channel_id, n = self.channel_and_n_messages(record)
                indexed_channels.add(channel_id)
                messages += n
            else:
                part.append(record)
        self.schemas, self.channels, _ = self._schemas_channels_statistics(data)
        counts: Statistics | None = None
        with suppress(TraceError):  # a damaged summary is not needed
            schemas, channels, counts = self._schemas_channels_statistics(summary)
            self.schemas, self.channels = schemas | self.schemas, channels | self.channels
        if not chunks or self._are_indexes_complete(counts, messages, indexed_channels):
            return True
        self._read_schemas_and_channels_in_chunks(chunks)
        return False

    def _schemas_channels_statistics(
        self, records: list[Record]
    ) -> tuple[dict[int, Schema], dict[int, Channel], Statistics | None]:
        """Return the schemas, channels and statistics among `records`. Errors: `TraceError` for a damaged record."""
        schemas: dict[int, Schema] = {}
        channels: dict[int, Channel] = {}
        counts: Statistics | None = None
        for record in records:
            with self.convert_sqlite_errors(record):
                if record.opcode == Opcode.SCHEMA:
                    schema = Schema.read(self.body_stream(record))
                    schemas.setdefault(schema.id, schema)
                elif record.opcode == Opcode.CHANNEL:
                    channel = Channel.read(self.body_stream(record))
                    channels.setdefault(channel.id, channel)
                elif record.opcode == Opcode.STATISTICS:
                    counts = Statistics.read(self.body_stream(record))
                elif record.opcode == Opcode.FOOTER and not is_summary_intact(
                    Footer.read(self.body_stream(record)), self._view, record.at, record.end
                ):
                    raise self.damage_error(record.at)
        return schemas, channels, counts

    def _read_schemas_and_channels_in_chunks(self, chunks: list[Record]) -> None:
        for chunk in chunks:
            with self.convert_sqlite_errors(chunk):
                for opcode, _, body in self.chunk_records(chunk):
                    if opcode == Opcode.SCHEMA:
                        schema = Schema.read(ReadDataStream(io.BytesIO(body)))
                        self.schemas[schema.id] = schema
                    elif opcode == Opcode.CHANNEL:
                        channel = Channel.read(ReadDataStream(io.BytesIO(body)))
                        self.channels[channel.id] = channel

    def _are_indexes_complete(self, statistics: Statistics | None, n_messages: int, indexed_channels: set[int]) -> bool:
        """Return whether the summary lists every channel and schema, and the message indexes list every message."""
        return (
            statistics is not None
            and statistics.message_count == n_messages
            and statistics.channel_count == len(self.channels)
            and statistics.schema_count == len(self.schemas)
            and indexed_channels <= self.channels.keys()
            and all(c.schema_id == 0 or c.schema_id in self.schemas for c in self.channels.values())
        )

    def current_sha256(self) -> str:
        """Return the SHA-256 of the file's present content."""
        digest = hashlib.sha256()
        for start in range(0, len(self._view), _HASHED_BLOCK_BYTES):
            digest.update(self.read(start, min(start + _HASHED_BLOCK_BYTES, len(self._view))))
        return digest.hexdigest()


def open_log(path: Path) -> BinaryIO:
    """Open a log that ingest has read. Errors: `TraceError` if it cannot be opened."""
    try:
        return path.open("rb")
    except OSError as error:
        raise _unreadable_log_error(path, error) from error


def _unreadable_log_error(path: Path, error: OSError) -> TraceError:
    return TraceError(
        f"{path}: the log can no longer be read ({error.strerror or error}): make it readable and check it again"
    )


def message_index(messages: Iterable[tuple[int, int, int, int]]) -> ChunkMessageIndex:
    """Return channel id -> (n, 2) array of log time and offset, for messages (channel id, sequence number, log time, offset)."""
    entries: dict[int, list[tuple[int, int]]] = {}
    for channel, _, log_time, at in messages:
        entries.setdefault(channel, []).append((log_time, at))
    return {channel: np.array(pairs, np.uint64) for channel, pairs in sorted(entries.items())}
