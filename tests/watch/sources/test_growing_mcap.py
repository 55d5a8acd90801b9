"""An MCAP file that grows gives the frames of the whole one, however its writer cuts what it appends."""

from __future__ import annotations

import io
import os
import threading
import time
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType, Writer

from drivelint.errors import TraceError
from drivelint.formats.osi.schema import GROUND_TRUTH, descriptor_set
from drivelint.watch.sources.growing_file import GrowingFile
from drivelint.watch.sources.mcap_file import McapSource
from drivelint.watch.sources.mcap_stream import McapStream
from tests.formats.logs import quality, read, states
from tests.formats.osi import osi_file
from tests.watch.sources.windows import drained, times

if TYPE_CHECKING:
    from pathlib import Path

N: Final = 24
STEP_NS: Final = 50_000_000
KINDS: Final = {
    "loose": {"use_chunking": False},
    "plain": {"compression": CompressionType.NONE, "chunk_size": 1500},
    "lz4": {"compression": CompressionType.LZ4, "chunk_size": 1500},
    "zstd": {"compression": CompressionType.ZSTD, "chunk_size": 1500},
}


@cache
def content(kind: str) -> bytes:
    """Return an MCAP file of N frames, with an attachment and a metadata record among them."""
    file = io.BytesIO()
    writer = Writer(file, **KINDS[kind])  # type: ignore[arg-type]
    writer.start()
    channel = writer.register_channel(
        "truth", "protobuf", writer.register_schema(GROUND_TRUTH, "protobuf", descriptor_set())
    )
    for k in range(N):
        if k == N // 2:
            writer.add_attachment(0, 0, "photo", "image/png", b"\x05" * 3000)
            writer.add_metadata("place", {"name": "somewhere"})
        writer.add_message(channel, k * STEP_NS, osi_file.truth(k * STEP_NS).SerializeToString(), k * STEP_NS)
    writer.finish()  # type: ignore[no-untyped-call]
    return file.getvalue()


def log_times(pieces: list[bytes]) -> tuple[list[int], McapStream]:
    stream = McapStream("log.mcap")
    found = [each for piece in pieces for each in stream.parse(piece)]
    return [each.log_ns for each in found], stream  # type: ignore[union-attr]


@pytest.mark.parametrize("kind", sorted(KINDS))
@settings(max_examples=30, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data())
def test_any_cut_gives_the_same(kind: str, data: st.DataObject) -> None:
    whole = content(kind)
    cuts = data.draw(st.lists(st.integers(0, len(whole)), max_size=20))
    found, stream = log_times([whole[a:b] for a, b in pairwise([0, *sorted(cuts), len(whole)])])
    assert found == [k * STEP_NS for k in range(N)]
    assert stream.ended
    assert not stream.notes
    assert stream.metadata == {"place": {"name": "somewhere"}}


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_byte_by_byte(kind: str) -> None:
    whole = content(kind)
    assert log_times([bytes([byte]) for byte in whole])[0] == [k * STEP_NS for k in range(N)]


@pytest.mark.parametrize("kind", ["loose", "zstd"])
def test_the_file_itself_grows(tmp_path: Path, kind: str) -> None:
    path, whole = tmp_path / "log.mcap", content(kind)
    source = McapSource(path, idle_s=None)
    assert source.read(0.0) == []  # it is awaited
    found: list[int] = []
    for start in range(0, len(whole), 997):
        with path.open("ab") as file:
            file.write(whole[start : start + 997])
        found += times(source.read(0.0) or [])
        assert found == [k * STEP_NS for k in range(len(found))]
    assert found == [k * STEP_NS for k in range(N)]
    assert source.read(10.0) is None  # by its footer, at once
    source.close()
    source.close()


def test_a_writer_that_dies_within_a_chunk(tmp_path: Path) -> None:
    whole = content("zstd")
    path = tmp_path / "log.mcap"
    path.write_bytes(whole[: len(whole) // 3])
    source = McapSource(path, idle_s=0.2)
    begun = time.monotonic()
    frames = drained(source)
    assert time.monotonic() - begun >= 0.2
    assert 0 < len(frames) < N
    assert times(frames) == [k * STEP_NS for k in range(len(frames))]
    assert {row["t_ns"] for row in states(read(path))} == set(
        times(frames)
    )  # the recording is judged as far as it goes
    assert source.read(0.0) is None


def test_a_writer_in_a_thread(tmp_path: Path) -> None:
    path, whole = tmp_path / "log.mcap", content("lz4")

    def write() -> None:
        with path.open("wb", buffering=0) as file:
            for start in range(0, len(whole), 2500):
                file.write(whole[start : start + 2500])
                time.sleep(0.01)

    thread = threading.Thread(target=write)
    thread.start()
    assert times(drained(McapSource(path, idle_s=5.0))) == [k * STEP_NS for k in range(N)]
    thread.join()


def test_a_file_that_never_comes_is_waited_for(tmp_path: Path) -> None:
    assert drained(McapSource(tmp_path / "log.mcap", idle_s=0.1)) == []


def test_a_truncated_file(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    path.write_bytes(content("zstd")[:-100])
    source = McapSource(path, idle_s=None)
    source.read(0.0)
    os.truncate(path, 1000)
    with pytest.raises(TraceError, match="truncated to 1000 of"):
        source.read(0.0)
    source.close()


@pytest.mark.parametrize(("again", "message"), [(True, "replaced by another file"), (False, "taken away")])
def test_a_replaced_file(tmp_path: Path, again: bool, message: str) -> None:
    path = tmp_path / "log.mcap"
    path.write_bytes(content("zstd")[:-100])
    source = McapSource(path, idle_s=None)
    source.read(0.0)
    path.rename(tmp_path / "old.mcap")
    if again:
        path.write_bytes(content("zstd"))
    with pytest.raises(TraceError, match=message):
        source.read(0.0)
    source.close()


def test_no_mcap(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    path.write_bytes(b"PK\x03\x04 and so on")
    source = McapSource(path, idle_s=None)
    with pytest.raises(TraceError, match="not an MCAP file: it begins with"):
        source.read(0.0)
    source.close()


def test_a_damaged_chunk_is_lost_in_the_window_too(tmp_path: Path) -> None:
    whole = bytearray(content("plain"))
    place = whole.index(b"\x08\x00\x12", len(whole) // 3)
    whole[place + 1] ^= 0x40
    path = tmp_path / "log.mcap"
    path.write_bytes(whole)
    source = McapSource(path, idle_s=0.0)
    frames = drained(source)
    assert [note for note in source.notes() if "wrong CRC" in note]
    assert not source.notes()
    window = tmp_path / "window.mcap"
    source.write_window(frames[2:-1], window)
    lost, whole_lost = (quality(read(each))["lost_time"] for each in (window, path))
    assert "wrong CRC" in lost["message"]
    assert lost["t_first_ns"] <= whole_lost["t_first_ns"]  # the window has no index of what was in the chunk
    assert lost["t_last_ns"] >= whole_lost["t_last_ns"]


def test_what_is_no_record_ends_it(tmp_path: Path) -> None:
    whole = content("loose")
    path = tmp_path / "log.mcap"
    path.write_bytes(whole[: len(whole) // 2] + bytes(4000))
    source = McapSource(path, idle_s=None)
    assert drained(source)
    assert [note for note in source.notes() if "nothing after it is watched" in note]


def test_each_byte_is_read_once(tmp_path: Path) -> None:
    path = tmp_path / "log"
    path.write_bytes(b"ab")
    file = GrowingFile(path, idle_s=None)
    assert file.read(0.0) == b"ab"
    with path.open("ab") as more:
        more.write(b"cd")
    assert file.read(0.0) == b"cd"
    assert file.read(0.0) == b""
    file.close()
