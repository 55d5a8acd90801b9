"""Reads MCAP files from front to back, checks every CRC, and bounds every length before it is used.

Messages come from the data section; the index at the end of the file only shows what is missing. Errors name the byte offset of the damage.
On request, the readable part of a damaged file and its losses are returned.
"""

from __future__ import annotations

import io
import mmap
import re
import struct
import zlib
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, DataEnd, Footer, Header, Metadata, Schema, Statistics

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError
from drivelint.formats.mcap.chunk import ChunkError, UnpackingLimit, parse_chunk
from drivelint.formats.mcap.counts import MESSAGE_INDEX_HEADER, MessageCounts
from drivelint.formats.mcap.losses import Losses
from drivelint.formats.mcap.resume import MAGIC, next_record_offset
from drivelint.formats.mcap.summary import Summary, is_summary_intact, read_summary

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

T = TypeVar("T")

BATCH_BYTES = 32 * 1024 * 1024
"""Messages are decoded in batches of about this size, which bounds the memory that a long log needs."""
MOST_RECORD_BYTES = 1 << 48
"""No file is so large: a known record that declares more bytes is not merely cut off, and the file is refused."""
_RECORD_HEADER = struct.Struct("<BQ")
_MESSAGE_HEADER = struct.Struct("<HIQQ")
_LENGTH_BY_OPCODE = {Opcode.FOOTER: 20, Opcode.DATA_END: 4, Opcode.SUMMARY_OFFSET: 17}
"""Opcode -> length in bytes of the records with a fixed length."""
_OPCODES = frozenset(Opcode)
_LEAST_PRIVATE_OPCODE = 0x80
"""Opcodes from this one on are reserved for applications; records with them are ignored."""
_MAGIC_PATTERN = re.compile(re.escape(MAGIC))


class MessageError(TraceError):
    """The error for one message that cannot be decoded."""


class DamageError(TraceError):
    """The error for a part of the file that cannot be read. `resume`: the byte at which reading can go on; None if unknown."""

    resume: int | None = None


@dataclass(frozen=True)
class LogMessage:
    """One message of a log. `offset`: the byte of the file at which its record begins, or the chunk that contains its record."""

    channel: Channel
    log_time_ns: int
    data: bytes
    offset: int

    def error(self, path: Path, problem: str) -> MessageError:
        """Return the error that names this message's topic, time and offset, and the problem."""
        where = f"topic {self.channel.topic!r}, log time {self.log_time_ns} ns, record at byte {self.offset}"
        return MessageError(f"{path}: {where}: {problem}: record or copy the log again")


@dataclass
class Container:
    """An MCAP file. All fields are complete after the last message of `messages()`.

    `salvage`: read the readable part of a damaged file, and list the lost parts in `losses`; otherwise damage is an error.
    `metadata`: name of a metadata record -> its content; the first record of a name counts. `library`: the software that wrote the file.
    """

    path: Path
    salvage: bool = False
    channels: dict[int, Channel] = field(default_factory=dict)
    schemas: dict[int, Schema] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    findings: list[QualityFinding] = field(default_factory=list)
    losses: Losses = field(default_factory=Losses)
    library: str = ""
    counts: MessageCounts = field(default_factory=MessageCounts)
    _n_messages: int = 0
    _n_loose: int = 0
    _n_unprotected: int = 0
    _in_data: bool = True
    _data_crc: int = 0
    _statistics: Statistics | None = None
    _read_offsets: set[int] = field(default_factory=set)
    _unpacking_limit: UnpackingLimit = field(default_factory=UnpackingLimit)

    def messages(self) -> Iterator[LogMessage]:
        """Yield every message in the order of the file.

        Errors: `DamageError` with the damage and its byte; with `salvage` only if no message can be read, or the lost
        bytes cannot be located. `TraceError` if a second MCAP file follows, or chunks are too large to unpack.
        """
        with self.path.open("rb") as file:
            if not self.path.stat().st_size:
                raise self._damage_error(0, "the file is empty")
            # not closed here: a raised error may still refer to views of the map, which is freed after the last view
            data = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        yield from self._messages_in_file(memoryview(data))

    def _damage_error(self, offset: int, problem: str, resume: int | None = None) -> DamageError:
        error = DamageError(
            f"{self.path}: {problem} at byte {offset}: the log is damaged or cut off: copy it again, or repair it"
        )
        error.resume = resume
        return error

    def _messages_in_file(self, view: memoryview) -> Iterator[LogMessage]:
        if bytes(view[: len(MAGIC)]) != MAGIC:
            raise self._damage_error(0, f"not an MCAP file: it begins with {bytes(view[:16])!r}")
        at, footer, index = len(MAGIC), None, None
        while footer is None and at < len(view):
            try:
                opcode, start, end = self._opcode_and_range(view, at)
                if opcode == Opcode.FOOTER:
                    footer = at, start, end
                else:
                    yield from self._messages_in_record(view, opcode, at, start, end)
                at = end
            except DamageError as error:
                if index is None:
                    index = self._index_of_damaged_file(view, error)
                if error.resume is None and not self._n_messages and not index.chunks:
                    raise  # schemas and channels may be lost, and there is no index that has them
                resume = error.resume or self._resume_offset(view, at)
                self._refuse_second_file_within(view, at + 1, resume)
                self.losses.add(at, resume, str(error))
                at = resume
        if self.losses and not self._n_messages:
            raise DamageError(self.losses.first.cause)
        if footer is not None:
            self._check_footer(view, *footer)
        if index is None:
            index = read_summary(view) if footer is not None else Summary()
        self._check_data_end(len(view), has_footer=footer is not None, has_index=bool(index.chunks))
        self._check_index(index)
        self._report_counts_and_missing_crcs()

    def _opcode_and_range(self, view: memoryview, at: int) -> tuple[int, int, int]:
        """Return the opcode, and the start and end of the body, of the record at byte `at`. Errors: `DamageError` if it is invalid."""
        if at + _RECORD_HEADER.size > len(view):
            raise self._damage_error(at, "the file ends without a footer")
        opcode, length = _RECORD_HEADER.unpack_from(view, at)
        start = at + _RECORD_HEADER.size
        if opcode == 0:
            raise self._damage_error(at, "no record (zero bytes)")
        self._refuse_second_file(view, at)
        if length > len(view) - start:
            text = f"a {_record_name(opcode)} record of {length} bytes, of which {len(view) - start} are present,"
            if length >= MOST_RECORD_BYTES and opcode in _OPCODES:
                raise TraceError(str(self._damage_error(at, text)))
            raise self._damage_error(at, text)
        end = start + length
        wrong = length != _LENGTH_BY_OPCODE.get(opcode, length)
        if opcode == Opcode.MESSAGE_INDEX:
            head = MESSAGE_INDEX_HEADER
            wrong = length < head.size or head.unpack_from(view, start)[1] != length - head.size
        elif opcode == Opcode.FOOTER:
            tail = bytes(view[end : end + len(MAGIC)])
            wrong = wrong or not MAGIC.startswith(tail)
            if not wrong and len(tail) < len(MAGIC) and not self.salvage:
                raise self._damage_error(end, "no closing magic bytes after the footer")
        if wrong:
            raise self._damage_error(at, f"a {_record_name(opcode)} record that is none")
        if self._in_data and opcode not in _OPCODES and self._may_be_lost_data(view, opcode, end):
            raise self._damage_error(at, f"a {_record_name(opcode)} record", end)
        return opcode, start, end

    def _may_be_lost_data(self, view: memoryview, opcode: int, end: int) -> bool:
        """Return whether a record with an unknown opcode may be a damaged record: a message index after it means that it was a chunk."""
        return opcode < _LEAST_PRIVATE_OPCODE or (end < len(view) and view[end] == Opcode.MESSAGE_INDEX)

    def _refuse_second_file(self, view: memoryview, at: int) -> None:
        if bytes(view[at : at + len(MAGIC)]) == MAGIC:
            raise TraceError(f"{self.path}: a second MCAP file begins at byte {at}: split it and give one part")

    def _refuse_second_file_within(self, view: memoryview, start: int, end: int) -> None:
        """Raise `TraceError` if lost bytes contain the beginning of another file: the data after it may be of another drive."""
        match = _MAGIC_PATTERN.search(view[: end + len(MAGIC)], start)
        if match and match.start() < len(view) - len(MAGIC):
            self._refuse_second_file(view, match.start())

    def _messages_in_record(self, view: memoryview, opcode: int, at: int, start: int, end: int) -> Iterator[LogMessage]:
        body = view[start:end]
        if opcode in {Opcode.CHUNK, Opcode.METADATA}:
            self._read_offsets.add(at)
        if opcode == Opcode.DATA_END:
            self._in_data = False
            crc = self._parse_record(DataEnd.read, body, at).data_section_crc
            self._data_crc = 0 if self.losses.has_lost_bytes else crc  # after a loss, the CRC cannot be checked
            if self._data_crc and zlib.crc32(view[:at]) != crc:
                self._report_changed_data(at)
        elif opcode == Opcode.HEADER:
            self.library = self._parse_record(Header.read, body, at).library
        elif opcode == Opcode.STATISTICS:
            self._statistics = self._parse_record(Statistics.read, body, at)
        elif opcode == Opcode.CHUNK:
            yield from self._messages_in_chunk(body, at, end)
        elif opcode == Opcode.MESSAGE_INDEX:
            self._check_message_index(body, at)
        elif opcode == Opcode.METADATA:
            record = self._parse_record(Metadata.read, body, at)
            self.metadata.setdefault(record.name, record.metadata)
        elif self._in_data:  # the index repeats schemas and channels: only those in the data section are used
            self._n_loose += opcode == Opcode.MESSAGE
            yield from self._message_of_data_record(opcode, body, at, end)

    def _report_changed_data(self, at: int) -> None:
        """Report a wrong CRC of the data section if all messages came from chunks with right CRCs; otherwise raise `TraceError`."""
        error = self._damage_error(at, "a data section with a wrong CRC (its content changed), ending")
        if not self.salvage or self._n_loose or self._n_unprotected or self.metadata:
            raise TraceError(str(error))
        self.findings.append(QualityFinding("data_changed", "error", str(error)))

    def _parse_record(self, parse: Callable[[ReadDataStream], T], body: memoryview, at: int) -> T:
        try:
            return parse(ReadDataStream(io.BytesIO(body)))
        except (struct.error, McapError, ValueError) as error:
            raise self._damage_error(at, f"a record that cannot be read ({error})") from error

    def _message_of_data_record(self, opcode: int, body: memoryview, at: int, end: int) -> Iterator[LogMessage]:
        """Store a schema or channel, or yield a message; ignore other records."""
        if opcode == Opcode.MESSAGE:
            if len(body) < _MESSAGE_HEADER.size:
                raise self._damage_error(at, "a message record without its header", end)
            number, _, log_time, _ = _MESSAGE_HEADER.unpack_from(body)
            if number not in self.channels:
                raise self._damage_error(at, f"a message on channel {number}, which was never declared,", end)
            self._n_messages += 1
            self.counts.add(number, log_time)
            self.losses.bound_loss_times_by_message(log_time)
            yield LogMessage(self.channels[number], log_time, bytes(body[_MESSAGE_HEADER.size :]), at)
        elif opcode == Opcode.SCHEMA:
            schema = self._parse_record(Schema.read, body, at)
            self.schemas[schema.id] = schema
        elif opcode == Opcode.CHANNEL:
            channel = self._parse_record(Channel.read, body, at)
            if channel.schema_id and channel.schema_id not in self.schemas:
                raise self._damage_error(at, f"channel {channel.topic!r} with a schema that was never declared,", end)
            self.channels[channel.id] = channel

    def _messages_in_chunk(self, body: memoryview, at: int, end: int) -> Iterator[LogMessage]:
        where = f"{self.path}: byte {at}"
        try:
            head = parse_chunk(body)
            records = self._unpacking_limit.unpack(head, where)
        except ChunkError as error:
            raise self._damage_error(at, str(error), end if error.has_valid_length else None) from error
        self._n_unprotected += head.crc == 0
        view, place = memoryview(records), 0
        self.counts.begin_chunk()
        while place < len(view):
            opcode, start, stop = self._opcode_and_range_in_chunk(view, place, at, end)
            self._unpacking_limit.count_record(where)
            try:
                yield from self._message_of_data_record(opcode, view[start:stop], at, end)
            except DamageError as error:
                error.resume = end
                raise
            place = stop
        self.counts.end_chunk()

    def _check_message_index(self, body: memoryview, at: int) -> None:
        for log_ns in self.counts.count_missing_messages_of_chunk_and_return_times(body):
            error = self._damage_error(at, "a message is missing from the chunk before its index")
            if not self.salvage:
                raise error
            self.losses.add_undecodable_message(at, str(error), log_ns)

    def _opcode_and_range_in_chunk(self, view: memoryview, place: int, at: int, end: int) -> tuple[int, int, int]:
        start = place + _RECORD_HEADER.size
        if start <= len(view):
            opcode, length = _RECORD_HEADER.unpack_from(view, place)
            if opcode == 0:
                raise self._damage_error(at, "a chunk with zero bytes in place of a record", end)
            if length <= len(view) - start:
                return opcode, start, start + length
        raise self._damage_error(at, "a chunk that ends within a record", end)

    def _index_of_damaged_file(self, view: memoryview, error: DamageError) -> Summary:
        """Return the index, and add its schemas and channels, as their records may be lost. Without `salvage`, raise `error`."""
        if not self.salvage:
            raise error
        index = read_summary(view)
        self.schemas = {**index.schemas, **self.schemas}
        self.channels = {**index.channels, **self.channels}
        return index

    def _resume_offset(self, view: memoryview, at: int) -> int:
        """Return the byte of the next record that is certainly intact, where reading can go on."""
        chunked = bool(self._n_messages - self._n_loose) or not self._n_loose
        return next_record_offset(view, at + 1, channels=None if chunked else self.channels)

    def _check_data_end(self, size: int, *, has_footer: bool, has_index: bool) -> None:
        """Report a missing data end record or footer: as a loss if messages may be missing at the end, otherwise as a finding."""
        if self._in_data and has_footer:
            if has_index:
                return
            error = self._damage_error(size, "no end of the data before the footer, in a file that ends")
            if not self.salvage:
                raise error
            self.losses.add(size, size, str(error))
        elif self._in_data and (not self.losses or self.losses.last.end < size):
            error = self._damage_error(size, "the file ends without a footer")
            if not self.salvage:
                raise error
            self.losses.add(size, size, str(error))
        elif not has_footer and not self._in_data:
            if not self.salvage:
                raise self._damage_error(size, "the file ends without a footer")
            message = f"the file ends without a footer at byte {size}, after the end of its data: nothing is lost"
            self.findings.append(QualityFinding("no_footer", "warning", message))

    def _check_footer(self, view: memoryview, at: int, start: int, end: int) -> None:
        """Report a wrong CRC of the index, bytes after the file's end, or missing magic bytes; none of these loses messages."""
        footer = self._parse_record(Footer.read, view[start:end], at)
        if not is_summary_intact(footer, view, at, end):
            message = f"the index has a wrong CRC (footer at byte {at}): only its message counts are compared"
            self.findings.append(QualityFinding("index_damaged", "warning", message))
        extra = len(view) - end - len(MAGIC)
        if extra > 0:
            self._refuse_second_file(view, end + len(MAGIC))
            message = f"{extra} bytes follow the end of the log at byte {end + len(MAGIC)}: they are not part of it"
            self.findings.append(QualityFinding("trailing_bytes", "warning", message))
        elif extra < 0:
            message = f"the file ends without its closing magic bytes at byte {len(view)}: nothing is lost"
            self.findings.append(QualityFinding("no_footer", "warning", message))

    def _check_index(self, index: Summary) -> None:
        """Add as losses the chunks that an intact index lists, but the data lack. Errors: `DamageError` for a missing metadata record."""
        for offset, (length, since, until) in sorted(index.chunks.items()):
            if offset not in self._read_offsets and not self.losses.covers(offset):
                error = self._damage_error(offset, "no chunk, where the index has one,")
                if not self.salvage:
                    raise error
                self.losses.add(offset, offset + length, str(error), since, until)
        if lacking := [at for at in index.metadata if at not in self._read_offsets]:
            raise self._damage_error(lacking[0], "no metadata record, where the index has one,")
        if index.chunks:
            self.losses.bound_loss_times_by_chunks(index.chunks)

    def _report_counts_and_missing_crcs(self) -> None:
        if self._statistics is not None and not self.losses.has_lost_bytes:
            is_damaged = any(finding.check_id == "index_damaged" for finding in self.findings)
            contradiction = self.counts.contradiction_text(self._statistics, self.channels, is_damaged=is_damaged)
            if contradiction is not None:
                message = f"the index counts {contradiction}: the present messages are read, the missing ones are lost"
                self.findings.append(QualityFinding("index_mismatch", "error", message))
        if self._n_unprotected:
            message = f"chunks without a CRC: {self._n_unprotected}: flipped bits in them remain undetected"
            self.findings.append(QualityFinding("unprotected", "info", message, self._n_unprotected))
        elif self._n_loose and not self._data_crc:
            message = f"messages outside chunks, without a CRC: {self._n_loose}: flipped bits in them remain undetected"
            self.findings.append(QualityFinding("unprotected", "info", message, self._n_loose))


def message_batches(
    container: Container, kind_of: Callable[[Channel, Schema], str | None]
) -> Iterator[tuple[str, list[LogMessage]]]:
    """Yield batches of messages, each of one topic and one schema and of about `BATCH_BYTES`, with their kind.

    `kind_of`: returns the kind for a channel and its schema; None: the channel is not read.
    """
    waiting: dict[str, tuple[str, list[LogMessage]]] = {}
    sizes: Counter[str] = Counter()
    for log_message in container.messages():
        topic, schema = log_message.channel.topic, container.schemas.get(log_message.channel.schema_id)
        kind = None if schema is None else kind_of(log_message.channel, schema)
        if kind is None:
            container.counts.unread_channels.add(log_message.channel.id)
            continue
        is_other_schema = topic in waiting and waiting[topic][1][0].channel.schema_id != log_message.channel.schema_id
        if is_other_schema or sizes[topic] >= BATCH_BYTES:
            yield waiting.pop(topic)
            sizes[topic] = 0
        waiting.setdefault(topic, (kind, []))[1].append(log_message)
        sizes[topic] += len(log_message.data)
    yield from waiting.values()


def _record_name(opcode: int) -> str:
    try:
        return Opcode(opcode).name.lower().replace("_", " ")
    except ValueError:
        return f"nameless (opcode {opcode})"
