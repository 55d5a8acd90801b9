"""Writes an MCAP file with its CRCs, and a summary at its end that indexes all records."""

from __future__ import annotations

import struct
import zlib
from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING, BinaryIO, Final

import numpy as np
import zstandard
from mcap import records
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode

from drivelint.errors import DriveLintError
from drivelint.formats.mcap.resume import MAGIC

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

ID_LIMIT: Final = 1 << 16  # channel and schema ids have 16 bits; schema id 0 means: no schema
_ZSTD_LEVEL: Final = 1
_WRITTEN_BLOCK_BYTES: Final = 4 << 20


class Sink:
    """Writes one MCAP file. Records that are copied into the file are also in its index, so that the summary is complete.

    `offset`: the place of the next byte. The summary contains schemas, channels, statistics, the indexes of chunks, attachments
    and metadata, and the offsets of these. Summary and data section each have a CRC.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._crc = 0
        self.offset = 0
        self.schemas: dict[int, records.Schema] = {}
        self.channels: dict[int, records.Channel] = {}
        self.chunks: list[records.ChunkIndex] = []
        self.attachments: list[records.AttachmentIndex] = []
        self.metadata: list[records.MetadataIndex] = []
        self.counts: Counter[int] = Counter()

    def write(self, data: bytes | memoryview) -> None:
        """Append bytes unchanged."""
        for start in range(0, len(data), _WRITTEN_BLOCK_BYTES):
            block = data[start : start + _WRITTEN_BLOCK_BYTES]
            self._crc = zlib.crc32(block, self._crc)
            self._file.write(block)
        self.offset += len(data)

    def begin(self, library: str) -> None:
        """Write magic bytes and header. Not for a copied file, which begins with those of the original."""
        self.write(MAGIC)
        self._write_record(records.Header(profile="", library=library))

    def add_channel(
        self, topic: str, encoding: str, schema: records.Schema, metadata: Mapping[str, str] | None = None
    ) -> int:
        """Write a channel with a free id, and return the id. The schema is written first, unless the file already has it.

        `schema` has the id 0, as its id is chosen here. Errors: `DriveLintError` if no id is free.
        """
        same = [number for number, earlier in self.schemas.items() if replace(earlier, id=0) == replace(schema, id=0)]
        number = min(same) if same else unused_id(self.schemas, 1, "schema")
        if not same:
            self.schemas[number] = replace(schema, id=number)
            self._write_record(self.schemas[number])
        channel = records.Channel(
            id=unused_id(self.channels, 0, "channel"),
            topic=topic,
            message_encoding=encoding,
            metadata=dict(metadata or {}),
            schema_id=number,
        )
        self.channels[channel.id] = channel
        self._write_record(channel)
        return channel.id

    def write_schema(self, schema: records.Schema) -> None:
        """Write a schema, keeping its id."""
        self.schemas[schema.id] = schema
        self._write_record(schema)

    def write_channel(self, channel: records.Channel) -> None:
        """Write a channel, keeping its id."""
        self.channels[channel.id] = channel
        self._write_record(channel)

    def add_chunk(
        self, content: bytes | memoryview, index: Mapping[int, NDArray[np.uint64]], *, compressed: bool = True
    ) -> None:
        """Write records as one chunk with its message indexes.

        `index`: channel id -> (n, 2) array of log time and offset within the chunk, for every message in `content`.
        """
        times = np.concatenate([entries[:, 0] for entries in index.values()])
        data = zstandard.ZstdCompressor(level=_ZSTD_LEVEL).compress(content) if compressed else bytes(content)
        chunk = records.Chunk(
            compression="zstd" if compressed else "",
            data=data,
            message_start_time=int(times.min()),
            message_end_time=int(times.max()),
            uncompressed_crc=zlib.crc32(content),
            uncompressed_size=len(content),
        )
        start = self.offset
        self._write_record(chunk)
        entry = records.ChunkIndex(
            chunk_length=self.offset - start, chunk_start_offset=start, compression=chunk.compression,
            compressed_size=len(data), message_end_time=chunk.message_end_time, message_index_length=0,
            message_index_offsets={}, message_start_time=chunk.message_start_time, uncompressed_size=chunk.uncompressed_size,
        )  # fmt: skip
        self.index_chunk(entry, index)

    def index_chunk(self, chunk: records.ChunkIndex, index: Mapping[int, NDArray[np.uint64]]) -> None:
        """Write the message indexes of the last chunk, and add the chunk to the summary."""
        start = self.offset
        for channel, entries in sorted(index.items()):
            chunk.message_index_offsets[channel] = self.offset
            body = np.ascontiguousarray(entries, dtype="<u8").tobytes()
            self.write(struct.pack("<BQHI", Opcode.MESSAGE_INDEX, 6 + len(body), channel, len(body)) + body)
            self.counts[channel] += len(entries)
        chunk.message_index_length = self.offset - start
        self.chunks.append(chunk)

    def add_attachment(self, name: str, media_type: str, data: bytes, log_time: int) -> None:
        """Write an attachment; its creation time is 0, so that equal runs write equal bytes."""
        start = self.offset
        self._write_record(
            records.Attachment(create_time=0, log_time=log_time, name=name, media_type=media_type, data=data)
        )
        self.attachments.append(records.AttachmentIndex(
            offset=start, length=self.offset - start, log_time=log_time, create_time=0, data_size=len(data),
            name=name, media_type=media_type,
        ))  # fmt: skip

    def add_metadata(self, name: str, content: Mapping[str, str]) -> None:
        """Write a metadata record with its keys sorted."""
        start = self.offset
        self._write_record(records.Metadata(name=name, metadata=dict(sorted(content.items()))))
        self.metadata.append(records.MetadataIndex(offset=start, length=self.offset - start, name=name))

    def finish(self) -> None:
        """Write the end of the data section, the summary and the footer."""
        self._write_record(records.DataEnd(data_section_crc=self._crc))
        start = self.offset
        self._crc = 0  # the CRC in the footer covers the bytes from the summary on
        groups: list[tuple[int, Sequence[records.McapRecord]]] = [
            (Opcode.SCHEMA, [s for _, s in sorted(self.schemas.items())]),
            (Opcode.CHANNEL, [c for _, c in sorted(self.channels.items())]),
            (Opcode.STATISTICS, [self._statistics()]),
            (Opcode.CHUNK_INDEX, self.chunks),
            (Opcode.ATTACHMENT_INDEX, self.attachments),
            (Opcode.METADATA_INDEX, self.metadata),
        ]
        places = []
        for opcode, group in groups:
            group_start = self.offset
            for record in group:
                self._write_record(record)
            if group:
                length = self.offset - group_start
                places.append(records.SummaryOffset(group_opcode=opcode, group_start=group_start, group_length=length))
        offsets = self.offset
        for place in places:
            self._write_record(place)
        head = struct.pack("<BQQQ", Opcode.FOOTER, 20, start, offsets)
        self._write_record(
            records.Footer(summary_start=start, summary_offset_start=offsets, summary_crc=zlib.crc32(head, self._crc))
        )
        self.write(MAGIC)

    def _write_record(self, record: records.McapRecord) -> None:
        builder = RecordBuilder()
        record.write(builder)
        self.write(builder.end())  # type: ignore[no-untyped-call]

    def _statistics(self) -> records.Statistics:
        filled = [c for c in self.chunks if c.message_index_offsets]
        return records.Statistics(
            attachment_count=len(self.attachments),
            channel_count=len(self.channels),
            channel_message_counts=dict(sorted((c, n) for c, n in self.counts.items() if n)),
            chunk_count=len(self.chunks),
            message_count=self.counts.total(),
            message_start_time=min((c.message_start_time for c in filled), default=0),
            message_end_time=max((c.message_end_time for c in filled), default=0),
            metadata_count=len(self.metadata),
            schema_count=len(self.schemas),
        )


def unused_id(used_ids: Mapping[int, object], least: int, kind: str) -> int:
    """Return the id after the highest used one, or if that is too large, the lowest free id. Errors: `DriveLintError` if none is free."""
    after = max(used_ids, default=least - 1) + 1
    if after < ID_LIMIT:
        return max(after, least)
    for number in range(least, ID_LIMIT):
        if number not in used_ids:
            return number
    raise DriveLintError(f"all {ID_LIMIT} {kind} ids of the log are taken: it cannot be annotated, use --no-annotate")
