"""The MCAP container, read from front to back with every CRC checked and every length bounded before it is believed.

The index at the end of the file is not used: what counts is the data. Each record's byte offset is known, so that
damage is named by its place.
"""

from __future__ import annotations

import io
import mmap
import struct
import zlib
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, DataEnd, Footer, Metadata, Schema, Statistics

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

T = TypeVar("T")

MAGIC = b"\x89MCAP0\r\n"
BATCH_BYTES = 32 * 1024 * 1024
"""Messages are decoded in batches of about this size, which bounds the memory that a long log needs."""
MAX_CHUNK_BYTES = 512 * 1024 * 1024
"""A chunk that says it grows beyond this is refused before anything is allocated: recorders write a few MB each."""
_RECORD = struct.Struct("<BQ")
_MESSAGE = struct.Struct("<HIQQ")
_CHUNK = struct.Struct("<QQQII")


@dataclass(frozen=True)
class Packet:
    """One message: its channel, time in the log and bytes; `offset` is its record's, or that of the chunk around it."""

    channel: Channel
    log_time_ns: int
    data: bytes
    offset: int

    def error(self, path: Path, what: str) -> TraceError:
        """Return the error for this message: where it is, and what is wrong with it."""
        where = f"topic {self.channel.topic!r}, log time {self.log_time_ns} ns, record at byte {self.offset}"
        return TraceError(f"{path}: {where}: {what}: record or copy the log again")


@dataclass
class Container:
    """An MCAP file. All but its path is complete once `packets` is exhausted.

    `metadata`: name of a metadata record -> its texts; of several with one name, the first.
    """

    path: Path
    channels: dict[int, Channel] = field(default_factory=dict)
    schemas: dict[int, Schema] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    findings: list[QualityFinding] = field(default_factory=list)
    _messages: int = 0
    _unprotected: int = 0

    def packets(self) -> Iterator[Packet]:
        """Yield every message in the order of the file. Errors: `TraceError` naming what is damaged, at which byte."""
        with self.path.open("rb") as file:
            # not closed by hand: an error on its way up still holds views into the map; it ends with the last of them
            data = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        yield from self._file(memoryview(data))

    def _damaged(self, offset: int, what: str) -> TraceError:
        return TraceError(
            f"{self.path}: {what} at byte {offset}: the log is damaged or cut off: copy it again, or repair it"
        )

    def _file(self, view: memoryview) -> Iterator[Packet]:
        if bytes(view[: len(MAGIC)]) != MAGIC:
            raise self._damaged(0, f"not an MCAP file: it begins with {bytes(view[:16])!r}")
        at, in_data, statistics = len(MAGIC), True, None
        while True:
            opcode, start, end = self._record(view, at, len(view))
            if opcode == Opcode.FOOTER:
                self._check_summary(view, at, start, end)
                break
            if opcode == Opcode.DATA_END:
                in_data = False
                crc = self._parsed(DataEnd.read, view[start:end], at).data_section_crc
                if crc and zlib.crc32(view[:at]) != crc:
                    raise self._damaged(at, "a data section with a wrong CRC (its content changed), ending")
            elif opcode == Opcode.STATISTICS:
                statistics = self._parsed(Statistics.read, view[start:end], at)
            elif opcode == Opcode.CHUNK:
                yield from self._chunk(view[start:end], at)
            elif opcode == Opcode.METADATA:
                record = self._parsed(Metadata.read, view[start:end], at)
                self.metadata.setdefault(record.name, record.metadata)
            elif in_data:  # the index repeats schemas and channels: only those among the data count
                yield from self._content(opcode, view[start:end], at)
            at = end
        self._check_end(view, end)
        if statistics is not None and statistics.message_count != self._messages:
            message = (
                f"the index counts {statistics.message_count} messages, the file has {self._messages}: all are read"
            )
            self.findings.append(QualityFinding("index_mismatch", "warning", message))
        if self._unprotected:
            message = f"chunks without a CRC: {self._unprotected}: flipped bits in them cannot be seen"
            self.findings.append(QualityFinding("unprotected", "info", message, self._unprotected))

    def _record(self, view: memoryview, at: int, end: int) -> tuple[int, int, int]:
        """Return opcode, start and end of the record at `at`, which must lie wholly before `end`."""
        if at + _RECORD.size > end:
            raise self._damaged(at, "the file ends without a footer")
        opcode, length = _RECORD.unpack_from(view, at)
        start = at + _RECORD.size
        if opcode == 0:
            raise self._damaged(at, "no record (zero bytes)")
        if length > end - start:
            raise self._damaged(at, f"a {_name(opcode)} record of {length} bytes, of which {end - start} are there,")
        return opcode, start, start + length

    def _parsed(self, read: Callable[[ReadDataStream], T], body: memoryview, at: int) -> T:
        try:
            return read(ReadDataStream(io.BytesIO(body)))
        except (struct.error, McapError, ValueError) as error:
            raise self._damaged(at, f"a record that cannot be read ({error})") from error

    def _content(self, opcode: int, body: memoryview, at: int) -> Iterator[Packet]:
        """Take a schema, a channel or a message; other records are of no use here."""
        if opcode == Opcode.MESSAGE:
            if len(body) < _MESSAGE.size:
                raise self._damaged(at, "a message record without its header")
            number, _, log_time, _ = _MESSAGE.unpack_from(body)
            if number not in self.channels:
                raise self._damaged(at, f"a message on channel {number}, which was never announced,")
            self._messages += 1
            yield Packet(self.channels[number], log_time, bytes(body[_MESSAGE.size :]), at)
        elif opcode == Opcode.SCHEMA:
            schema = self._parsed(Schema.read, body, at)
            self.schemas[schema.id] = schema
        elif opcode == Opcode.CHANNEL:
            channel = self._parsed(Channel.read, body, at)
            if channel.schema_id and channel.schema_id not in self.schemas:
                raise self._damaged(at, f"channel {channel.topic!r} with a schema that was never announced,")
            self.channels[channel.id] = channel

    def _chunk(self, body: memoryview, at: int) -> Iterator[Packet]:
        if len(body) < _CHUNK.size:
            raise self._damaged(at, "a chunk record without its header")
        _, _, size, crc, name_length = _CHUNK.unpack_from(body)
        name_end = _CHUNK.size + name_length
        if name_end + 8 > len(body):
            raise self._damaged(at, "a chunk record whose lengths do not fit")
        compression = bytes(body[_CHUNK.size : name_end]).decode("utf-8", "replace")
        (packed_length,) = struct.unpack_from("<Q", body, name_end)
        packed = body[name_end + 8 :]
        if packed_length != len(packed):
            raise self._damaged(at, "a chunk record whose lengths do not fit")
        if size > MAX_CHUNK_BYTES:
            beyond = f"{size}, beyond {MAX_CHUNK_BYTES // 2**20} MiB,"
            raise self._damaged(at, f"a chunk of {len(packed)} bytes that says it unpacks to {beyond}")
        records = self._unpacked(packed, compression, size, at)
        if crc == 0:
            self._unprotected += 1
        elif zlib.crc32(records) != crc:
            raise self._damaged(at, "a chunk with a wrong CRC (its content changed)")
        view, place = memoryview(records), 0
        while place < size:
            opcode, start, end = self._inner(view, place, at)
            yield from self._content(opcode, view[start:end], at)
            place = end

    def _inner(self, view: memoryview, place: int, at: int) -> tuple[int, int, int]:
        start = place + _RECORD.size
        if start <= len(view):
            opcode, length = _RECORD.unpack_from(view, place)
            if length <= len(view) - start:
                return opcode, start, start + length
        raise self._damaged(at, "a chunk that ends within a record")

    def _unpacked(self, packed: memoryview, compression: str, size: int, at: int) -> bytes:
        """Decompress at most `size` bytes, the number the chunk declares."""
        import zstandard

        try:
            if compression == "":
                records = bytes(packed)
            elif compression == "zstd":
                declared = zstandard.get_frame_parameters(packed).content_size
                # the library believes the frame's own size rather than the limit given to it
                if declared not in {size, zstandard.CONTENTSIZE_UNKNOWN}:
                    raise self._damaged(at, f"a chunk that says it unpacks to {size} bytes and then to {declared},")
                records = zstandard.ZstdDecompressor().decompress(packed, max_output_size=max(size, 1))
            elif compression == "lz4":
                import lz4.frame  # type: ignore[import-untyped]

                records = lz4.frame.LZ4FrameDecompressor().decompress(packed, max_length=size + 1)
            else:
                raise TraceError(
                    f"{self.path}: a chunk at byte {at} is compressed by {compression!r}: zstd, lz4 or none is needed"
                )
        except (zstandard.ZstdError, RuntimeError) as error:
            raise self._damaged(at, f"a chunk that cannot be unpacked ({error})") from error
        if len(records) != size:
            raise self._damaged(at, f"a chunk that says it unpacks to {size} bytes and unpacks to {len(records)}")
        return records

    def _check_summary(self, view: memoryview, at: int, start: int, end: int) -> None:
        """Check the index's CRC: the data were read without it, so damage there loses nothing."""
        footer = self._parsed(Footer.read, view[start:end], at)
        if not summary_is_whole(footer, view, at, end):
            message = f"the index has a wrong CRC (footer at byte {at}): it is not used, the data are complete"
            self.findings.append(QualityFinding("index_damaged", "warning", message))

    def _check_end(self, view: memoryview, end: int) -> None:
        tail = view[end:]
        if bytes(tail[: len(MAGIC)]) != MAGIC:
            raise self._damaged(end, "no closing magic bytes after the footer")
        extra = len(tail) - len(MAGIC)
        if extra == 0:
            return
        if bytes(tail[len(MAGIC) : 2 * len(MAGIC)]) == MAGIC:
            raise TraceError(
                f"{self.path}: a second MCAP file begins at byte {end + len(MAGIC)}: split the two, give each by itself"
            )
        message = f"{extra} bytes follow the end of the log at byte {end + len(MAGIC)}: they are not part of it"
        self.findings.append(QualityFinding("trailing_bytes", "warning", message))


def summary_is_whole(footer: Footer, view: memoryview, at: int, end: int) -> bool:
    """Say whether the index has the CRC, if any, that the footer in bytes `at` to `end` of the file says."""
    begin = min(footer.summary_start or at, at)
    return not footer.summary_crc or zlib.crc32(view[begin : end - 4]) == footer.summary_crc


def message_batches(
    container: Container, kind_of: Callable[[Channel, Schema], str | None]
) -> Iterator[tuple[str, list[Packet]]]:
    """Yield the kind and the messages of a topic, those of one schema and some tens of megabytes at a time.

    `kind_of`: what is read from a channel with a schema; None: nothing.
    """
    waiting: dict[str, tuple[str, list[Packet]]] = {}
    sizes: Counter[str] = Counter()
    for packet in container.packets():
        topic, schema = packet.channel.topic, container.schemas.get(packet.channel.schema_id)
        kind = None if schema is None else kind_of(packet.channel, schema)
        if kind is None:
            continue
        changed = topic in waiting and waiting[topic][1][0].channel.schema_id != packet.channel.schema_id
        if changed or sizes[topic] >= BATCH_BYTES:
            yield waiting.pop(topic)
            sizes[topic] = 0
        waiting.setdefault(topic, (kind, []))[1].append(packet)
        sizes[topic] += len(packet.data)
    yield from waiting.values()


def _name(opcode: int) -> str:
    try:
        return Opcode(opcode).name.lower().replace("_", " ")
    except ValueError:
        return f"unknown (opcode {opcode})"
