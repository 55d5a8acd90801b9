"""Small MCAP files of every kind that recorders write, and a reading of any file that trusts none of its indexes."""

from __future__ import annotations

import io
import struct
import zlib
from typing import TYPE_CHECKING, Any, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.reader import NonSeekingReader, SeekingReader
from mcap.records import AttachmentIndex, ChunkIndex, Footer, MessageIndex, MetadataIndex, Statistics, SummaryOffset
from mcap.stream_reader import breakup_chunk
from mcap.writer import CompressionType, IndexType, Writer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

MAGIC = b"\x89MCAP0\r\n"
KINDS: dict[str, dict[str, Any]] = {
    "zstd": {"compression": CompressionType.ZSTD},
    "lz4": {"compression": CompressionType.LZ4},
    "plain chunks": {"compression": CompressionType.NONE},
    "no CRCs": {"enable_crcs": False},
    "data CRC": {"enable_data_crcs": True},
    "no chunks": {"use_chunking": False},
    "no chunks, no index": {"use_chunking": False, "index_types": IndexType.NONE, "use_statistics": False},
    "no message indexes": {"index_types": IndexType.ALL & ~IndexType.MESSAGE},
    "no index": {"index_types": IndexType.NONE},
    "no statistics": {"use_statistics": False},
    "no summary": {
        "index_types": IndexType.NONE,
        "use_statistics": False,
        "use_summary_offsets": False,
        "repeat_channels": False,
        "repeat_schemas": False,
    },
}


class Record(NamedTuple):
    """A record and where it begins, its head included."""

    opcode: int
    at: int
    body: bytes

    @property
    def length(self) -> int:
        return len(self.body) + 9


def log(path: Path, *, n: int = 60, topics: int = 3, **options: Any) -> Path:
    """Write a log of `n` messages on some topics, one of them without a schema, with two attachments and a metadata record."""
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=600, **options)
        writer.start(profile="some", library="a recorder")
        schema = writer.register_schema("some.Type", "jsonschema", b'{"type": "object"}')
        channels = [
            writer.register_channel(f"/t{k}", "json", schema if k else 0, {"unit": "m"} if k else {})
            for k in range(topics)
        ]
        writer.add_attachment(5, 6, "first.txt", "text/plain", b"attached before the messages")
        for k in range(n):
            data = f'{{"k": {k}, "x": "{"y" * (k % 40)}"}}'.encode()
            # some out of order, some at one time
            writer.add_message(channels[k % topics], 1_000_000 * (k // 2 + (3 if k % 7 == 0 else 0)), data, k, k)
            if k == n // 2:
                writer.add_metadata("in the middle", {"b": "2", "a": "1"})
        writer.add_attachment(7, 8, "last.bin", "application/octet-stream", bytes(range(256)))
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def messages(path: Path, reader: Callable[..., Any], **query: Any) -> list[tuple[Any, ...]]:
    """Read a file by a stock reader, CRCs on: per message topic, schema, channel metadata, times, number and bytes."""
    with path.open("rb") as file:
        return [
            (
                channel.topic,
                schema.name if schema else None,
                tuple(channel.metadata.items()),
                message.log_time,
                message.publish_time,
                message.sequence,
                message.data,
            )
            for schema, channel, message in reader(file, validate_crcs=True).iter_messages(**query)
        ]


def seeking(path: Path, **query: Any) -> list[tuple[Any, ...]]:
    """Read a file by its index."""
    return messages(path, SeekingReader, **query)


def streaming(path: Path, **query: Any) -> list[tuple[Any, ...]]:
    """Read a file from front to back, its data CRC checked."""
    return messages(path, NonSeekingReader, **query)


def records(data: bytes, at: int = len(MAGIC)) -> Iterator[Record]:
    """Yield every record up to the footer."""
    while True:
        opcode, length = struct.unpack_from("<BQ", data, at)
        yield Record(opcode, at, data[at + 9 : at + 9 + length])
        if opcode == Opcode.FOOTER:
            assert data[at + 9 + length :] == MAGIC
            return
        at += 9 + length


def verify(path: Path) -> Statistics:
    """Hold everything that the summary says against the data, found by walking; return its statistics."""
    data = path.read_bytes()
    found = list(records(data))
    (end,) = (k for k, record in enumerate(found) if record.opcode == Opcode.DATA_END)
    places = {record.at: record for record in found[:end]}
    assert struct.unpack("<I", found[end].body)[0] == zlib.crc32(data[: found[end].at])
    footer = _read(Footer.read, found[-1])
    assert footer.summary_start == found[end + 1].at
    assert footer.summary_crc == zlib.crc32(data[footer.summary_start : len(data) - len(MAGIC) - 4])
    kinds = [record.opcode for record in found[end + 1 : -1]]
    for record in found[end + 1 : -1]:
        if record.opcode == Opcode.SUMMARY_OFFSET:
            group = _read(SummaryOffset.read, record)
            inside = [r for r in found if group.group_start <= r.at < group.group_start + group.group_length]
            assert {r.opcode for r in inside} == {group.group_opcode}
            assert len(inside) == kinds.count(group.group_opcode)
            assert sum(r.length for r in inside) == group.group_length
    first = next(r.at for r in found if r.opcode == Opcode.SUMMARY_OFFSET)
    assert footer.summary_offset_start == first
    for record in found[end + 1 : -1]:
        if record.opcode == Opcode.CHUNK_INDEX:
            _verify_chunk(_read(ChunkIndex.read, record), places)
        elif record.opcode in {Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX}:
            read = AttachmentIndex.read if record.opcode == Opcode.ATTACHMENT_INDEX else MetadataIndex.read
            index = _read(read, record)
            there = places[index.offset]
            assert (there.opcode, there.length) == (record.opcode - 1 if record.opcode == 10 else 12, index.length)
    assert kinds.count(Opcode.CHUNK_INDEX) == sum(r.opcode == Opcode.CHUNK for r in places.values())
    assert kinds.count(Opcode.ATTACHMENT_INDEX) == sum(r.opcode == Opcode.ATTACHMENT for r in places.values())
    assert kinds.count(Opcode.METADATA_INDEX) == sum(r.opcode == Opcode.METADATA for r in places.values())
    assert not any(r.opcode == Opcode.MESSAGE for r in places.values()), "a message that no index leads to"
    statistics: Statistics
    (statistics,) = (_read(Statistics.read, r) for r in found if r.opcode == Opcode.STATISTICS)
    assert statistics.chunk_count == kinds.count(Opcode.CHUNK_INDEX)
    assert statistics.schema_count == kinds.count(Opcode.SCHEMA)
    assert statistics.channel_count == kinds.count(Opcode.CHANNEL)
    assert statistics.attachment_count == kinds.count(Opcode.ATTACHMENT_INDEX)
    assert statistics.metadata_count == kinds.count(Opcode.METADATA_INDEX)
    return statistics


def _verify_chunk(index: ChunkIndex, places: dict[int, Record]) -> None:
    from mcap.records import Chunk, Message

    there = places[index.chunk_start_offset]
    assert (there.opcode, there.length) == (Opcode.CHUNK, index.chunk_length)
    chunk = _read(Chunk.read, there)
    assert (chunk.compression, len(chunk.data)) == (index.compression, index.compressed_size)
    inside = [r for r in breakup_chunk(chunk, validate_crc=True) if isinstance(r, Message)]
    times = [m.log_time for m in inside]
    assert (index.message_start_time, index.message_end_time) == (min(times), max(times))
    listed: dict[int, list[tuple[int, int]]] = {}
    length = 0
    for channel, offset in index.message_index_offsets.items():
        assert places[offset].opcode == Opcode.MESSAGE_INDEX
        assert offset > there.at
        entries = _read(MessageIndex.read, places[offset])
        assert entries.channel_id == channel
        listed[channel] = entries.records
        length += places[offset].length
    assert length == index.message_index_length
    assert sum(map(len, listed.values())) == len(inside)
    unpacked = b"".join(_bytes(r) for r in breakup_chunk(chunk))
    for channel, entries in listed.items():
        for log_time, offset in entries:
            opcode, _, found_channel, _, found_time = struct.unpack_from("<BQHIQ", unpacked, offset)
            assert (opcode, found_channel, found_time) == (Opcode.MESSAGE, channel, log_time)


def _bytes(record: Any) -> bytes:
    from mcap.data_stream import RecordBuilder

    builder = RecordBuilder()
    record.write(builder)
    return bytes(builder.end())  # type: ignore[no-untyped-call]


def _read(read_content: Callable[[ReadDataStream], Any], record: Record) -> Any:
    return read_content(ReadDataStream(io.BytesIO(record.body)))
