"""A channel without any message is there, and says nothing: the error names its topic."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from mcap.writer import CompressionType, Writer

from drivelint.errors import TraceError
from drivelint.formats.mcap.silent import silent_topics_text
from drivelint.inspect.content import file_content
from tests.formats.logs import read

if TYPE_CHECKING:
    from pathlib import Path

KINDS = {
    "osi3.GroundTruth": ("protobuf", "protobuf", "no OSI ground truth in this file: "),
    "osi3.SensorView": ("protobuf", "protobuf", "no OSI ground truth in this file: "),
    "foxglove.SceneUpdate": ("protobuf", "protobuf", "foxglove.SceneUpdate in none of its messages: "),
    "derived_object_msgs/msg/ObjectArray": ("ros2msg", "cdr", "no road users and no odometry in this ROS log: "),
    "nav_msgs/msg/Odometry": ("ros2msg", "cdr", "no road users and no odometry in this ROS log: "),
}


def write(path: Path, schema: str, *topics: str, chunks: bool = True, with_note: bool = False) -> Path:
    """Write a log with channels of a schema and no message on them; `with_note`: with a message of another kind."""
    schema_encoding, encoding, _ = KINDS[schema]
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE, use_chunking=chunks)
        writer.start()
        number = writer.register_schema(schema, schema_encoding, b"")
        for topic in topics:
            writer.register_channel(topic, encoding, number)
        if with_note:
            text = writer.register_schema("text", "", b"")
            note = writer.register_channel("/note", "json", text)
            for t_ns in (0, 1):
                writer.add_message(note, t_ns, b"{}", t_ns)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


@pytest.mark.parametrize("chunks", [True, False])
@pytest.mark.parametrize("with_note", [True, False])
@pytest.mark.parametrize("schema", KINDS)
def test_the_topic_is_named(schema: str, with_note: bool, chunks: bool, tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", schema, "/truth", chunks=chunks, with_note=with_note)
    with pytest.raises(TraceError) as error:
        read(path)
    assert f"{KINDS[schema][2]}topic '/truth' has no message" in str(error.value)
    assert "no channel" not in str(error.value)
    channels = {channel.topic: channel.messages for channel in file_content(path, None, [], has_reader=False).channels}
    assert channels == {"/truth": 0} | ({"/note": 2} if with_note else {})


def test_several_topics_and_one_that_was_asked_for(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", "osi3.GroundTruth", "/b", "/a")
    with pytest.raises(TraceError, match="in this file: /a, /b have no message: record it again"):
        read(path)
    with pytest.raises(TraceError, match="on topic '/a': /a, /b have no message"):
        read(path, topic="/a")


def test_of_a_damaged_file_it_is_what_is_left(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", "osi3.GroundTruth", "/truth", with_note=True, chunks=False)
    whole = path.read_bytes()
    path.write_bytes(whole[: whole.rindex(b"{}") - 5])
    assert silent_topics_text([path], "osi3.GroundTruth".__eq__) == "topic '/truth' has no message that is left"


def test_topics_with_messages_are_not_named(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", "osi3.GroundTruth", "/truth", with_note=True)
    assert not silent_topics_text([path], "text".__eq__)
