"""Unpacks the chunks of an MCAP file: at most to their declared size, and checked by their CRC."""

from __future__ import annotations

import struct
import zlib
from typing import NamedTuple

from drivelint.errors import TraceError

MAX_CHUNK_BYTES = 512 * 1024 * 1024
"""A chunk that declares a larger unpacked size is refused before memory is allocated. Recorders write chunks of a few MB."""
FREE_BYTES = 1 << 30
MOST_UNPACKED_PER_PACKED_BYTE = 250
"""All chunks of a file may unpack to `FREE_BYTES` plus this many times their packed size. Real logs grew at most thirtyfold."""
FREE_RECORDS = 500_000
LEAST_RECORD_BYTES = 4
"""A file may have `FREE_RECORDS` records, plus one per this many packed bytes: even well packed, a message's time needs as many."""
COMPRESSIONS = frozenset({"", "zstd", "lz4"})
_CHUNK = struct.Struct("<QQQII")


class ChunkError(Exception):
    """The error for a damaged chunk. `framed`: the length of its record is still right, so that the next record can be found."""

    def __init__(self, message: str, *, framed: bool = True) -> None:
        super().__init__(message)
        self.framed = framed


class ChunkHead(NamedTuple):
    """The header of a chunk record, and its packed bytes. `size`: the declared unpacked size in bytes."""

    size: int
    crc: int
    compression: str
    packed: memoryview


class Work:
    """Limits the unpacked bytes and records of a file relative to its size, because a small malicious file could take hours to read."""

    def __init__(self) -> None:
        self._packed = self._unpacked = self._records = 0

    def unpacked(self, head: ChunkHead, where: str) -> bytes:
        """Return the unpacked records of a chunk. Errors: those of `chunk_records`; `TraceError` beyond the limit."""
        packed, size = self._packed + len(head.packed), self._unpacked + head.size
        if head.size <= MAX_CHUNK_BYTES and size > FREE_BYTES + MOST_UNPACKED_PER_PACKED_BYTE * packed:
            raise TraceError(
                f"{where}: chunks of {packed} bytes that say they unpack to {size}: no recorder writes such a log: record or copy it again"
            )
        records = chunk_records(head, where)
        self._packed, self._unpacked = packed, size
        return records

    def record(self, where: str) -> None:
        """Count a record of a chunk. Errors: `TraceError` beyond the limit."""
        self._records += 1
        if self._records > FREE_RECORDS + self._packed // LEAST_RECORD_BYTES:
            raise TraceError(
                f"{where}: more than {self._records - 1} records in chunks of {self._packed} bytes: no recorder "
                "writes such a log: record or copy it again"
            )


def chunk_head(body: memoryview) -> ChunkHead:
    """Return the header of a chunk record. Errors: `ChunkError` if its lengths contradict each other."""
    if len(body) < _CHUNK.size:
        raise ChunkError("a chunk record without its header", framed=False)
    _, _, size, crc, name_length = _CHUNK.unpack_from(body)
    name_end = _CHUNK.size + name_length
    if name_end + 8 > len(body):
        raise ChunkError("a chunk record whose lengths do not fit", framed=False)
    compression = bytes(body[_CHUNK.size : name_end]).decode("utf-8", "replace")
    (packed_length,) = struct.unpack_from("<Q", body, name_end)
    packed = body[name_end + 8 :]
    if packed_length != len(packed):
        raise ChunkError("a chunk record whose lengths do not fit", framed=False)
    return ChunkHead(size, crc, compression, packed)


def chunk_records(head: ChunkHead, where: str) -> bytes:
    """Return the unpacked records of a chunk. `where`: file and byte, for the error.

    Errors: `ChunkError` if the chunk is damaged; `TraceError` if it is too large, or its compression is unknown.
    """
    if head.size > MAX_CHUNK_BYTES:
        raise TraceError(
            f"{where}: a chunk of {len(head.packed)} bytes whose header states an unpacked size of {head.size}, beyond "
            f"{MAX_CHUNK_BYTES // 2**20} MiB: record or copy the log again"
        )
    if head.compression not in COMPRESSIONS:
        raise TraceError(f"{where}: a chunk is compressed by {head.compression!r}: zstd, lz4 or none is needed")
    records = _unpacked(head)
    if head.crc and zlib.crc32(records) != head.crc:
        raise ChunkError("a chunk with a wrong CRC (its content changed)")
    return records


def _unpacked(head: ChunkHead) -> bytes:
    """Return the decompressed records. Errors: `ChunkError` if their size is not the declared size."""
    import zstandard

    size, packed = head.size, head.packed
    try:
        if head.compression == "":
            records = bytes(packed) if len(packed) == size else b""
        elif head.compression == "zstd":
            declared = zstandard.get_frame_parameters(packed).content_size
            # the library uses the size in the frame instead of the limit given to it
            if declared not in {size, zstandard.CONTENTSIZE_UNKNOWN}:
                raise ChunkError(
                    f"a chunk whose header states an unpacked size of {size} bytes and then of {declared},"
                )
            records = zstandard.ZstdDecompressor().decompress(packed, max_output_size=max(size, 1))
        else:
            import lz4.frame  # type: ignore[import-untyped]

            records = lz4.frame.LZ4FrameDecompressor().decompress(packed, max_length=size + 1)
    except (zstandard.ZstdError, RuntimeError, EOFError) as error:
        raise ChunkError(f"a chunk that cannot be unpacked ({error})") from error
    if len(records) != size:
        found = len(records) if head.compression else len(packed)
        raise ChunkError(f"a chunk whose header states an unpacked size of {size} bytes, but which unpacks to {found}")
    return records
