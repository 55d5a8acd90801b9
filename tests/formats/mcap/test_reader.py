"""Damaged MCAP files: each named with its place, none silently shortened."""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING

import pytest
import zstandard
from mcap.writer import CompressionType

from drivelint.errors import TraceError
from drivelint.formats.mcap import chunk
from drivelint.formats.mcap.reader import Container
from drivelint.formats.mcap.resume import MAGIC
from tests.formats.logs import log, quality, read
from tests.formats.mcap.damage import put, records
from tests.formats.osi import osi_log

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.formats.mcap.reader import LogMessage

N = 12


@pytest.fixture
def whole(tmp_path: Path) -> Path:
    return osi_log.write(tmp_path / "whole.mcap", osi_log.truths(osi_log.drive(N)), chunk_size=600)


def messages(path: Path) -> list[LogMessage]:
    """Read a file of which nothing may be lost."""
    return list(Container(path).messages())


def test_whole_file(whole: Path) -> None:
    assert log(read(whole))["n_states"] == 3 * N
    assert set(quality(read(whole))) == {"no_indicator", "no_brake_light"}


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.999])
def test_cut_off(whole: Path, share: float) -> None:
    data = whole.read_bytes()
    cut = int(len(data) * share)
    with pytest.raises(TraceError, match=r"changed\.mcap: .* at byte \d+: the log is damaged or cut off") as error:
        messages(put(whole, data[:cut]))
    assert int(str(error.value).split("at byte ")[1].split(":")[0]) <= cut


def test_zero_filled_tail(whole: Path) -> None:
    data = whole.read_bytes()
    half = next(at for opcode, at, _ in records(data) if opcode == 6 and at > len(data) // 3)
    with pytest.raises(TraceError, match=rf"no record \(zero bytes\) at byte {half}"):
        messages(put(whole, data[:half] + bytes(len(data) - half)))


def test_changed_chunk(whole: Path) -> None:
    path = osi_log.write(
        whole.with_name("plain.mcap"), osi_log.truths(osi_log.drive(N)), compression=CompressionType.NONE
    )
    data = bytearray(path.read_bytes())
    at = next(at for opcode, at, _ in records(bytes(data)) if opcode == 6)
    data[at + 300] ^= 1
    with pytest.raises(TraceError, match=rf"a chunk with a wrong CRC \(its content changed\) at byte {at}"):
        messages(put(whole, bytes(data)))


def test_files_without_crcs_are_flagged(whole: Path) -> None:
    path = osi_log.write(whole.with_name("bare.mcap"), osi_log.truths(osi_log.drive(N)), enable_crcs=False)
    assert quality(read(path))["unprotected"]["severity"] == "info"


def test_chunk_bomb(whole: Path) -> None:
    data = bytearray(whole.read_bytes())
    at = next(at for opcode, at, _ in records(bytes(data)) if opcode == 6)
    struct.pack_into("<Q", data, at + 9 + 16, 2**40)
    with pytest.raises(
        TraceError,
        match=rf"byte {at}: a chunk of \d+ bytes whose header states an unpacked size of {2**40}, beyond 512 MiB",
    ):
        read(put(whole, bytes(data)))


def chunks_of(records_: bytes, n: int) -> bytes:
    """Return an MCAP file of n chunks that hold these records."""
    packed = zstandard.compress(records_, 19)
    sizes = struct.pack("<QQQII", 0, 0, len(records_), zlib.crc32(records_), 4)
    packed_chunk = sizes + b"zstd" + struct.pack("<Q", len(packed)) + packed
    head = record(1, bytes(8)) + record(4, struct.pack("<HH", 1, 0) + bytes(12))
    return MAGIC + head + record(6, packed_chunk) * n + record(15, bytes(4)) + record(2, bytes(20)) + MAGIC


def record(opcode: int, body: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(body)) + body


def test_a_chunk_of_zeros_is_no_chunk_of_empty_records(tmp_path: Path) -> None:
    """Each nine zeros were taken for a record without a name: half a gigabyte of them cost a hundred seconds."""
    path = tmp_path / "zeros.mcap"
    path.write_bytes(chunks_of(bytes(900), 1))
    with pytest.raises(TraceError, match="a chunk with zero bytes in place of a record"):
        messages(path)


def test_more_records_than_a_file_of_its_size_can_have_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(chunk, "BASE_RECORDS", 1_000)
    path = tmp_path / "many.mcap"
    message = record(5, struct.pack("<HIQQ", 1, 0, 0, 0))
    path.write_bytes(chunks_of(message * 900, 1))
    assert len(messages(path)) == 900
    path.write_bytes(chunks_of(message * 900, 2))
    with pytest.raises(TraceError, match=r"many\.mcap: byte \d+: more than \d+ records in chunks of \d+ bytes"):
        messages(path)


def test_chunks_that_together_grow_too_much_are_refused_before_they_are_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(chunk, "BASE_UNPACKED_BYTES", 100_000)
    path = tmp_path / "grows.mcap"
    empty = record(0x80, bytes(50_000))
    path.write_bytes(chunks_of(empty, 1))
    assert messages(path) == []
    path.write_bytes(chunks_of(empty, 9))
    with pytest.raises(TraceError, match=r"grows\.mcap: byte \d+: chunks of \d+ bytes that say they unpack to"):
        messages(path)


@pytest.mark.parametrize("compression", [CompressionType.ZSTD, CompressionType.LZ4, CompressionType.NONE])
def test_chunk_that_unpacks_to_another_size(whole: Path, compression: CompressionType) -> None:
    path = osi_log.write(whole.with_name("c.mcap"), osi_log.truths(osi_log.drive(N)), compression=compression)
    data = bytearray(path.read_bytes())
    at = next(at for opcode, at, _ in records(bytes(data)) if opcode == 6)
    (size,) = struct.unpack_from("<Q", data, at + 9 + 16)
    struct.pack_into("<Q", data, at + 9 + 16, size - 7)
    with pytest.raises(TraceError, match=rf"states an unpacked size of {size - 7} bytes[ ,].* at byte {at}"):
        messages(put(whole, bytes(data)))


def test_record_longer_than_the_file(whole: Path) -> None:
    data = bytearray(whole.read_bytes())
    struct.pack_into("<Q", data, 9, 2**60)
    with pytest.raises(TraceError, match=rf"a header record of {2**60} bytes, of which \d+ are present, at byte 8"):
        read(put(whole, bytes(data)))


def test_unknown_compression(whole: Path) -> None:
    data = whole.read_bytes().replace(b"\x04\0\0\0zstd", b"\x04\0\0\0brot")
    with pytest.raises(TraceError, match=r"byte \d+: a chunk is compressed by 'brot': zstd, lz4 or none is needed"):
        read(put(whole, data))


def test_two_files_in_one(whole: Path) -> None:
    data = whole.read_bytes()
    with pytest.raises(TraceError, match=rf"a second MCAP file begins at byte {len(data)}"):
        read(put(whole, data + data))


def test_trailing_bytes(whole: Path) -> None:
    found = quality(read(put(whole, whole.read_bytes() + b"more")))
    assert "4 bytes follow the end of the log" in found["trailing_bytes"]["message"]


def test_message_on_an_unknown_channel(whole: Path) -> None:
    path = osi_log.write(
        whole.with_name("flat.mcap"), osi_log.truths(osi_log.drive(2)), use_chunking=False, enable_crcs=False
    )
    data = bytearray(path.read_bytes())
    at = next(at for opcode, at, _ in records(bytes(data)) if opcode == 5)
    struct.pack_into("<H", data, at + 9, 77)
    with pytest.raises(TraceError, match=rf"a message on channel 77, which was never declared, at byte {at}"):
        messages(put(whole, bytes(data)))


def test_schemas_in_the_index_do_not_count(whole: Path) -> None:
    data = bytearray(whole.read_bytes())
    at = [at for opcode, at, _ in records(bytes(data)) if opcode == 3][-1]
    data[at + 9 + 2 + 4] ^= 1  # the first letter of its name
    trace = read(put(whole, bytes(data)))
    assert "wrong CRC" in quality(trace)["index_damaged"]["message"]
    assert log(trace)["n_states"] == log(read(whole))["n_states"]
