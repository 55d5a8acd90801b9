"""The chunks of an MCAP file: unpacked within the size that they declare, and checked by their CRC."""

from __future__ import annotations

import struct
import zlib
from typing import NamedTuple

from drivelint.errors import TraceError

MAX_CHUNK_BYTES = 512 * 1024 * 1024
"""A chunk that says it grows beyond this is refused before anything is allocated: recorders write a few MB each."""
FREE_BYTES = 1 << 30
MOST_GROWTH = 250
"""All chunks together may unpack to `FREE_BYTES`, and to so many times their size; of real logs none grew by more than thirty times."""
FREE_RECORDS = 500_000
LEAST_RECORD_BYTES = 4
"""So many records a file may have whatever its size, and of more each takes so many packed bytes: its time alone takes as many."""
COMPRESSIONS = frozenset({"", "zstd", "lz4"})
_CHUNK = struct.Struct("<QQQII")


class ChunkError(Exception):
    """A chunk is damaged. `framed`: the length of its record can be believed all the same."""

    def __init__(self, message: str, *, framed: bool = True) -> None:
        super().__init__(message)
        self.framed = framed


class ChunkHead(NamedTuple):
    """What a chunk declares, and its bytes as they are in the file."""

    size: int
    crc: int
    compression: str
    packed: memoryview


class Work:
    """Counts the work that a file causes, and refuses one that causes too much for its size: a small file could keep a reader for hours."""

    def __init__(self) -> None:
        self._packed = self._unpacked = self._records = 0

    def unpacked(self, head: ChunkHead, where: str) -> bytes:
        """Return the records of a chunk, if it may be unpacked. Errors: as `chunk_records`, and `TraceError`."""
        packed, size = self._packed + len(head.packed), self._unpacked + head.size
        if head.size <= MAX_CHUNK_BYTES and size > FREE_BYTES + MOST_GROWTH * packed:
            raise TraceError(
                f"{where}: chunks of {packed} bytes that say they unpack to {size}: no recorder writes such a log: record or copy it again"
            )
        records = chunk_records(head, where)
        self._packed, self._unpacked = packed, size
        return records

    def record(self, where: str) -> None:
        """Count a record of a chunk. Errors: `TraceError`."""
        self._records += 1
        if self._records > FREE_RECORDS + self._packed // LEAST_RECORD_BYTES:
            raise TraceError(
                f"{where}: more than {self._records - 1} records in chunks of {self._packed} bytes: no recorder "
                "writes such a log: record or copy it again"
            )


def chunk_head(body: memoryview) -> ChunkHead:
    """Return the declaration of a chunk record. Errors: `ChunkError` where its lengths do not fit."""
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
    """Return the records of a chunk. Errors: `ChunkError` where they are damaged.

    `TraceError` where they cannot be read at all, `where` (file and byte): too large, or of an unknown compression.
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
    """Decompress at most as many bytes as the chunk declares."""
    import zstandard

    size, packed = head.size, head.packed
    try:
        if head.compression == "":
            records = bytes(packed) if len(packed) == size else b""
        elif head.compression == "zstd":
            declared = zstandard.get_frame_parameters(packed).content_size
            # the library believes the frame's own size rather than the limit given to it
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
