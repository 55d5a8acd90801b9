"""Unpacks the chunks of an MCAP file: at most to their declared size, and checked by their CRC."""

from __future__ import annotations

import struct
import zlib
from typing import NamedTuple

from drivelint.errors import TraceError

MAX_CHUNK_BYTES = 512 * 1024 * 1024
"""A chunk that declares a larger unpacked size is refused before memory is allocated. Recorders write chunks of a few MB."""
BASE_UNPACKED_BYTES = 1 << 30
MOST_UNPACKED_PER_PACKED_BYTE = 250
"""All chunks of a file may unpack to `BASE_UNPACKED_BYTES` plus this many times their packed size. Real logs grew at most thirtyfold."""
BASE_RECORDS = 500_000
PACKED_BYTES_PER_RECORD = 4
"""A file may have `BASE_RECORDS` records, plus one per this many packed bytes: even well packed, a message's time needs as many."""
COMPRESSIONS = frozenset({"", "zstd", "lz4"})
_CHUNK_HEADER = struct.Struct("<QQQII")


class ChunkError(Exception):
    """The error for a damaged chunk. `has_valid_length`: the length of its record is still right, so that the next record can be found."""

    def __init__(self, message: str, *, has_valid_length: bool = True) -> None:
        super().__init__(message)
        self.has_valid_length = has_valid_length


class PackedChunk(NamedTuple):
    """The header of a chunk record, and its packed bytes. `size`: the declared unpacked size in bytes."""

    size: int
    crc: int
    compression: str
    packed: memoryview


class UnpackingLimit:
    """Limits the unpacked bytes and records of a file relative to its size, because a small malicious file could take hours to read."""

    def __init__(self) -> None:
        self._packed = self._unpacked = self._records = 0

    def unpack(self, chunk: PackedChunk, where: str) -> bytes:
        """Return the unpacked records of a chunk. Errors: those of `chunk_records`; `TraceError` beyond the limit."""
        packed, size = self._packed + len(chunk.packed), self._unpacked + chunk.size
        if chunk.size <= MAX_CHUNK_BYTES and size > BASE_UNPACKED_BYTES + MOST_UNPACKED_PER_PACKED_BYTE * packed:
            raise TraceError(
                f"{where}: chunks of {packed} bytes that say they unpack to {size}: no recorder writes such a log: record or copy it again"
            )
        records = chunk_records(chunk, where)
        self._packed, self._unpacked = packed, size
        return records

    def count_record(self, where: str) -> None:
        """Count a record of a chunk. Errors: `TraceError` beyond the limit."""
        self._records += 1
        if self._records > BASE_RECORDS + self._packed // PACKED_BYTES_PER_RECORD:
            raise TraceError(
                f"{where}: more than {self._records - 1} records in chunks of {self._packed} bytes: no recorder "
                "writes such a log: record or copy it again"
            )


def parse_chunk(body: memoryview) -> PackedChunk:
    """Return the header of a chunk record. Errors: `ChunkError` if its lengths contradict each other."""
    if len(body) < _CHUNK_HEADER.size:
        raise ChunkError("a chunk record without its header", has_valid_length=False)
    _, _, size, crc, name_length = _CHUNK_HEADER.unpack_from(body)
    name_end = _CHUNK_HEADER.size + name_length
    if name_end + 8 > len(body):
        raise ChunkError("a chunk record whose lengths do not fit", has_valid_length=False)
    compression = bytes(body[_CHUNK_HEADER.size : name_end]).decode("utf-8", "replace")
    (packed_length,) = struct.unpack_from("<Q", body, name_end)
    packed = body[name_end + 8 :]
    if packed_length != len(packed):
        raise ChunkError("a chunk record whose lengths do not fit", has_valid_length=False)
    return PackedChunk(size, crc, compression, packed)


def chunk_records(chunk: PackedChunk, where: str) -> bytes:
    """Return the unpacked records of a chunk. `where`: file and byte, for the error.

    Errors: `ChunkError` if the chunk is damaged; `TraceError` if it is too large, or its compression is unknown.
    """
    if chunk.size > MAX_CHUNK_BYTES:
        raise TraceError(
            f"{where}: a chunk of {len(chunk.packed)} bytes whose header states an unpacked size of {chunk.size}, beyond "
            f"{MAX_CHUNK_BYTES // 2**20} MiB: record or copy the log again"
        )
    if chunk.compression not in COMPRESSIONS:
        raise TraceError(f"{where}: a chunk is compressed by {chunk.compression!r}: zstd, lz4 or none is needed")
    records = _decompressed_records(chunk)
    if chunk.crc and zlib.crc32(records) != chunk.crc:
        raise ChunkError("a chunk with a wrong CRC (its content changed)")
    return records


def _decompressed_records(chunk: PackedChunk) -> bytes:
    """Return the decompressed records. Errors: `ChunkError` if their size is not the declared size."""
    import zstandard

    size, packed = chunk.size, chunk.packed
    try:
        if chunk.compression == "":
            records = bytes(packed) if len(packed) == size else b""
        elif chunk.compression == "zstd":
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
        n_bytes = len(records) if chunk.compression else len(packed)
        raise ChunkError(
            f"a chunk whose header states an unpacked size of {size} bytes, but which unpacks to {n_bytes}"
        )
    return records
