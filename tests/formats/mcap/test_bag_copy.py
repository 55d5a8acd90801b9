"""A bag becomes one annotated log with every message of all its files, whatever numbers their topics have there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from mcap.records import Schema

import drivelint
from drivelint.formats.mcap.copy import copy_log, copy_original
from drivelint.formats.mcap.original import OriginalFile
from drivelint.formats.mcap.writer import Sink
from tests.annotate.files import KINDS, log, seeking, streaming, verify
from tests.pictures.camera_bag import write_bag


def bag(folder: Path, files: list[Path]) -> Path:
    listed = "".join(f"    - {file.name}\n" for file in files)
    text = f"rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: mcap\n  relative_file_paths:\n{listed}"
    (folder / "metadata.yaml").write_text(text, encoding="utf-8")
    return folder


def one_log(path: Path, out: Path) -> Path:
    with out.open("wb") as file:
        sink = Sink(file)
        copy_log(path, "", sink)
        sink.finish()
    return out


def other_numbers(path: Path) -> Path:
    """Rewrite a log so that its topics and schema have other numbers, some of which are those of other topics in another part."""
    out = path.with_name(f"turned-{path.name}")
    with out.open("wb") as file, OriginalFile(path) as original:
        sink = Sink(file)
        sink.begin("another recorder")
        sink.write_schema(Schema(1, b"", "jsonschema", "some.Other"))
        for channel in reversed(list(original.channels.values())):
            sink.add_channel(f"{channel.topic}/x", "json", Schema(0, b"{}", "jsonschema", "some.Type"))
        copy_original(original, sink)
        sink.finish()
    path.unlink()
    return out


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("turned", [False, True])
def test_every_message_of_all_parts_is_there_in_their_order(tmp_path: Path, kind: str, turned: bool) -> None:
    parts = [log(tmp_path / f"part_{n}.mcap", n=40 + n, topics=3 + n, **KINDS[kind]) for n in range(3)]
    if turned:
        parts[1] = other_numbers(parts[1])
    out = one_log(bag(tmp_path, parts), tmp_path / "out")
    expected = [message for part in parts for message in streaming(part, log_time_order=False)]
    assert len(expected) == 40 + 41 + 42
    assert streaming(out, log_time_order=False) == expected
    assert sorted(seeking(out), key=str) == sorted(expected, key=str)
    statistics = verify(out)
    assert (statistics.message_count, statistics.attachment_count, statistics.metadata_count) == (123, 6, 3)


def test_one_topic_of_all_parts_is_one_channel(tmp_path: Path) -> None:
    parts = [log(tmp_path / f"part_{n}.mcap") for n in range(2)]
    parts[1] = other_numbers(parts[1])
    out = one_log(bag(tmp_path, parts), tmp_path / "out")
    with OriginalFile(out) as copied:
        topics = [
            (channel.topic, tuple(channel.metadata.items()), channel.schema_id) for channel in copied.channels.values()
        ]
    assert len(topics) == len(set(topics))


@pytest.mark.ci
def test_the_annotated_log_of_a_bag_holds_what_rosbags_reads_of_it(tmp_path: Path) -> None:
    rosbag2 = pytest.importorskip("rosbags.rosbag2", reason="rosbags is not installed: pip install rosbags")
    path = write_bag(tmp_path / "bag")
    drivelint.check(
        path, out=tmp_path / "out", rules=["ukhc.no-collision"], ego_size="4.5,1.8", robustness=False, pictures=False
    )
    (annotated,) = (tmp_path / "out" / "annotated").glob("*.mcap")
    with rosbag2.Reader(path) as reader:
        recorded: list[tuple[Any, ...]] = [(c.topic, t_ns, bytes(data)) for c, t_ns, data in reader.messages()]
    ours = [(m[0], m[3], m[6]) for m in seeking(annotated) if not m[0].startswith("/drivelint/")]
    assert sorted(ours) == sorted(recorded)
    assert any(m[0] == "/drivelint/findings" for m in seeking(annotated))
