"""Every original message, attachment and metadata record is in the copy as it was, and every index leads to it."""

from __future__ import annotations

import hashlib
import struct
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mcap.opcode import Opcode
from mcap.reader import SeekingReader
from mcap.records import Channel, Schema

from drivelint.errors import DriveLintError, TraceError
from drivelint.formats.mcap.copy import copy_original
from drivelint.formats.mcap.original import OriginalFile
from drivelint.formats.mcap.writer import Sink
from tests.annotate import files
from tests.annotate.files import KINDS, MAGIC, log, records, seeking, streaming, verify
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

OUR_TOPIC = "/ours"


def annotated(path: Path, *, n: int = 5, prepare: Any = None) -> Path:
    """Copy a log and add `n` messages of our own, one per 7 ms from 0 on."""
    out = path.with_suffix(".annotated.mcap")
    with out.open("wb") as file, OriginalFile(path, hashlib.sha256(path.read_bytes()).hexdigest()) as original:
        sink = Sink(file)
        copy_original(original, sink)
        if prepare:
            prepare(sink)
        channel = sink.add_channel(OUR_TOPIC, "json", Schema(id=0, name="Ours", encoding="jsonschema", data=b"{}"))
        times = np.arange(n, dtype=np.uint64) * np.uint64(7_000_000)
        data = b"".join(struct.pack("<BQHIQQ", 5, 24, channel, k, t, t) + b"{}" for k, t in enumerate(times.tolist()))
        sink.add_chunk(data, {channel: np.stack([times, np.arange(n, dtype=np.uint64) * np.uint64(33)], axis=1)})
        sink.add_metadata("ours", {"b": "2", "a": "1"})
        sink.add_attachment("ours.txt", "text/plain", b"ours", 3)
        sink.finish()
    return out


def original_messages(messages: list[tuple[Any, ...]]) -> list[tuple[Any, ...]]:
    return [message for message in messages if message[0] != OUR_TOPIC]


@pytest.mark.parametrize("kind", KINDS)
def test_every_message_of_every_kind_of_log_is_the_same(tmp_path: Path, kind: str) -> None:
    path = log(tmp_path / "log.mcap", **KINDS[kind])
    before = path.read_bytes()
    out = annotated(path)
    assert path.read_bytes() == before
    expected = streaming(path)
    assert len(expected) == 60
    assert original_messages(streaming(out)) == expected
    assert original_messages(seeking(out)) == expected
    assert streaming(out, log_time_order=False)[:60] == streaming(path, log_time_order=False)
    assert verify(out).message_count == 65


@pytest.mark.parametrize("kind", KINDS)
def test_attachments_and_metadata_are_found_by_the_new_index(tmp_path: Path, kind: str) -> None:
    out = annotated(log(tmp_path / "log.mcap", **KINDS[kind]))
    with out.open("rb") as file:
        reader = SeekingReader(file, validate_crcs=True)
        attached = {a.name: (a.log_time, a.create_time, a.data) for a in reader.iter_attachments()}
        said = {m.name: m.metadata for m in reader.iter_metadata()}
        header = reader.get_header()
    assert attached["first.txt"] == (6, 5, b"attached before the messages")
    assert attached["last.bin"] == (8, 7, bytes(range(256)))
    assert attached["ours.txt"] == (3, 0, b"ours")
    assert said == {"in the middle": {"b": "2", "a": "1"}, "ours": {"a": "1", "b": "2"}}
    assert (header.profile, header.library) == ("some", "a recorder")


@pytest.mark.parametrize("kind", KINDS)
def test_a_reader_that_seeks_finds_what_lies_in_a_time_range(tmp_path: Path, kind: str) -> None:
    out = annotated(log(tmp_path / "log.mcap", **KINDS[kind]))
    for topics, first, end in (
        ([OUR_TOPIC], 7_000_000, 21_000_000),
        (["/t1", OUR_TOPIC], 5_000_000, 15_000_000),
        (None, 0, 1),
    ):
        expected = [m for m in streaming(out) if first <= m[3] < end and (topics is None or m[0] in topics)]
        assert expected
        assert seeking(out, topics=topics, starting_at=first, ending_before=end) == expected


@pytest.mark.parametrize("kind", ["zstd", "lz4", "plain chunks", "no CRCs", "data CRC"])
def test_an_indexed_log_is_copied_byte_by_byte(tmp_path: Path, kind: str) -> None:
    path = log(tmp_path / "log.mcap", **KINDS[kind])
    data = path.read_bytes()
    (end,) = (r.at for r in records(data) if r.opcode == Opcode.DATA_END)
    assert annotated(path).read_bytes()[:end] == data[:end]


@pytest.mark.parametrize("kind", ["no message indexes", "no summary", "no statistics"])
def test_chunks_of_a_log_without_an_index_are_copied_as_they_are(tmp_path: Path, kind: str) -> None:
    path = log(tmp_path / "log.mcap", **KINDS[kind])
    chunks = [r.body for r in records(path.read_bytes()) if r.opcode == Opcode.CHUNK]
    copied = [r.body for r in records(annotated(path).read_bytes()) if r.opcode == Opcode.CHUNK]
    assert copied[:-1] == chunks


def test_the_reference_log(tmp_path: Path) -> None:
    path = tmp_path / "reference.mcap"
    path.write_bytes(shared("osi/osi_centerline_example.mcap").read_bytes())
    out = annotated(path)
    assert original_messages(seeking(out)) == seeking(path)
    assert len(seeking(path)) == 91
    verify(out)


def test_loose_messages_become_chunks_that_are_not_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("drivelint.formats.mcap.part_copy.BYTES_PER_CHUNK_OF_LOOSE_MESSAGES", 500)
    path = log(tmp_path / "log.mcap", use_chunking=False)
    out = annotated(path)
    assert original_messages(streaming(out)) == streaming(path)
    assert original_messages(seeking(out)) == streaming(path)
    assert verify(out).chunk_count > 5


def test_chunks_and_loose_messages_in_one_log(tmp_path: Path) -> None:
    """A recorder may put some messages outside of its chunks: they lie between them, and behind the last."""
    chunked = log(tmp_path / "chunked.mcap", enable_crcs=False).read_bytes()
    loose = log(tmp_path / "loose.mcap", use_chunking=False).read_bytes()
    message = b"".join(loose[r.at : r.at + r.length] for r in records(loose) if r.opcode == Opcode.MESSAGE)
    parts = [r for r in records(chunked) if r.opcode in {Opcode.CHUNK, Opcode.MESSAGE_INDEX}]
    first_chunk_end = next(r.at for r in parts if r.at > parts[0].at and r.opcode == Opcode.CHUNK)
    (end,) = (r.at for r in records(chunked) if r.opcode == Opcode.DATA_END)
    mixed = chunked[:first_chunk_end] + message + chunked[first_chunk_end:end] + message
    mixed += struct.pack("<BQI", Opcode.DATA_END, 4, 0) + struct.pack("<BQQQI", Opcode.FOOTER, 20, 0, 0, 0) + MAGIC
    path = tmp_path / "mixed.mcap"
    path.write_bytes(mixed)
    assert len(streaming(path)) == 180
    out = annotated(path)
    assert original_messages(streaming(out, log_time_order=False)) == streaming(path, log_time_order=False)
    assert sorted(original_messages(seeking(out))) == sorted(streaming(path))
    assert verify(out).message_count == 185


def test_a_summary_that_counts_wrongly_is_not_believed(tmp_path: Path) -> None:
    path = log(tmp_path / "log.mcap")
    data = bytearray(path.read_bytes())
    (statistics,) = (r.at for r in records(bytes(data)) if r.opcode == Opcode.STATISTICS)
    struct.pack_into("<Q", data, statistics + 9, 61)
    path.write_bytes(data)
    out = annotated(path)
    assert verify(out).message_count == 65
    assert original_messages(streaming(out)) == streaming(path)


@pytest.mark.parametrize("opcode", [Opcode.SCHEMA, Opcode.CHANNEL, Opcode.STATISTICS])
@pytest.mark.parametrize("kind", ["zstd", "no CRCs", "no chunks"])
@pytest.mark.parametrize("damage", [b"\xff\xfe", b"zz"])
def test_a_damaged_summary_is_not_used(tmp_path: Path, opcode: Opcode, kind: str, damage: bytes) -> None:
    """Of a log without CRCs, only what cannot be read is seen to be damaged."""
    path = log(tmp_path / "log.mcap", **KINDS[kind])
    expected = streaming(path)
    data = bytearray(path.read_bytes())
    (end,) = (r.at for r in records(bytes(data)) if r.opcode == Opcode.DATA_END)
    victim = next(r for r in records(bytes(data)) if r.opcode == opcode and r.at > end)
    at = victim.at + 9 + (8 if opcode == Opcode.CHANNEL else 6)  # its topic or name
    data[at : at + 2] = damage
    path.write_bytes(data)
    out = annotated(path)
    assert original_messages(streaming(out)) == expected
    if kind != "no CRCs" or damage != b"zz":
        assert original_messages(seeking(out)) == expected


def test_an_attachment_that_cannot_be_read_is_named_by_its_place(tmp_path: Path) -> None:
    path = log(tmp_path / "log.mcap")
    data = path.read_bytes().replace(b"first.txt", b"\xffirst.txt")
    path.write_bytes(data)
    with pytest.raises(TraceError, match="damaged at byte"):
        annotated(path)


def test_message_indexes_that_lie_are_written_anew(tmp_path: Path) -> None:
    """An index that leaves a message out disagrees with the statistics: all are found again from the chunks."""
    path = log(tmp_path / "log.mcap")
    data = path.read_bytes()
    victim = next(r for r in records(data) if r.opcode == Opcode.MESSAGE_INDEX and len(r.body) > 6 + 16)
    shorter = struct.pack("<BQ", Opcode.MESSAGE_INDEX, len(victim.body) - 16) + victim.body[:2]
    shorter += struct.pack("<I", len(victim.body) - 6 - 16) + victim.body[6:-16]
    path.write_bytes(data[: victim.at] + shorter + data[victim.at + victim.length :])
    assert verify(annotated(path)).message_count == 65


def test_a_message_index_that_is_not_behind_its_chunk_is_found_anew(tmp_path: Path) -> None:
    path = log(tmp_path / "log.mcap")
    data = path.read_bytes()
    stray = next(r for r in records(data) if r.opcode == Opcode.MESSAGE_INDEX)
    private = struct.pack("<BQ", 0x91, 0)
    path.write_bytes(data[: stray.at] + private + data[stray.at :])
    out = annotated(path)
    assert verify(out).message_count == 65
    assert original_messages(streaming(out)) == streaming(path)


def test_ids_are_chosen_among_the_free_ones(tmp_path: Path) -> None:
    path = log(tmp_path / "log.mcap")

    def full(sink: Sink) -> None:
        sink.channels[65_535] = Channel(id=65_535, topic="/last", message_encoding="", metadata={}, schema_id=0)
        sink.schemas[65_535] = Schema(id=65_535, name="Last", encoding="", data=b"")

    out = annotated(path, prepare=full)
    with out.open("rb") as file:
        summary = SeekingReader(file).get_summary()
    assert summary is not None
    (ours,) = (c for c in summary.channels.values() if c.topic == OUR_TOPIC)
    before = {r.body[:2] for r in records(path.read_bytes()) if r.opcode == Opcode.CHANNEL}
    assert struct.pack("<H", ours.id) not in before
    assert 0 < ours.schema_id < 65_535
    assert summary.schemas[ours.schema_id].name == "Ours"


def test_a_log_with_every_id_taken_is_named(tmp_path: Path) -> None:
    taken = Channel(id=0, topic="/t", message_encoding="", metadata={}, schema_id=0)

    def full(sink: Sink) -> None:
        sink.channels.update(dict.fromkeys(range(65_536), taken))

    with pytest.raises(DriveLintError, match=r"all 65536 channel ids of the log are taken.*--no-annotate"):
        annotated(log(tmp_path / "log.mcap"), prepare=full)


def test_a_schema_that_the_log_has_is_used_again(tmp_path: Path) -> None:
    once = annotated(log(tmp_path / "log.mcap"))
    twice = annotated(once)
    assert verify(twice).schema_count == verify(once).schema_count
    assert len(streaming(twice)) == 70


def test_a_log_that_changed_meanwhile_is_refused(tmp_path: Path) -> None:
    path = log(tmp_path / "log.mcap")
    changed = pytest.raises(TraceError, match="changed while it was judged")
    with (tmp_path / "out").open("wb") as file, OriginalFile(path, "0" * 64) as original, changed:
        copy_original(original, Sink(file))


def test_a_log_that_was_cut_meanwhile_is_refused(tmp_path: Path) -> None:
    path = log(tmp_path / "log.mcap")
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(TraceError, match=r"changed or is damaged at byte \d+"):
        OriginalFile(path, "")


def test_unknown_records_are_copied(tmp_path: Path) -> None:
    path = log(tmp_path / "log.mcap")
    data = path.read_bytes()
    (end,) = (r.at for r in records(data) if r.opcode == Opcode.DATA_END)
    private = struct.pack("<BQ", 0x91, 5) + b"mine!"
    path.write_bytes(data[:end] + private + data[end:])
    out = annotated(path)
    assert out.read_bytes()[end : end + len(private)] == private
    assert verify(out).message_count == 65


def test_bytes_behind_the_end_are_no_part_of_the_log(tmp_path: Path) -> None:
    """Ingest reads such a log with a warning; the annotated one ends where it should."""
    path = log(tmp_path / "log.mcap")
    expected = streaming(path)
    path.write_bytes(path.read_bytes() + b"\0" * 100)
    out = annotated(path)
    assert original_messages(streaming(out)) == expected
    verify(out)


def test_same_log_same_bytes(tmp_path: Path) -> None:
    path = log(tmp_path / "log.mcap")
    assert annotated(path).read_bytes() == annotated(path).read_bytes()


def test_the_oracle_notices_a_wrong_index(tmp_path: Path) -> None:
    """`verify` itself: a file with one wrong offset does not pass it."""
    out = annotated(log(tmp_path / "log.mcap"))
    data = bytearray(out.read_bytes())
    index = next(r for r in files.records(bytes(data)) if r.opcode == Opcode.CHUNK_INDEX)
    footer = next(r for r in files.records(bytes(data)) if r.opcode == Opcode.FOOTER)
    verify(out)
    for field in (16, 24):  # where the chunk begins, how long it is
        wrong = bytearray(data)
        struct.pack_into("<Q", wrong, index.at + 9 + field, struct.unpack_from("<Q", index.body, field)[0] + 1)
        (start,) = struct.unpack_from("<Q", footer.body)
        struct.pack_into("<I", wrong, footer.at + 9 + 16, zlib.crc32(wrong[start : footer.at + 9 + 16]))
        out.write_bytes(wrong)
        with pytest.raises((AssertionError, KeyError)):
            verify(out)
