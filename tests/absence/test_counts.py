"""What a log itself counts is compared with what was read of it, topic by topic: what is missing is lost, and said."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import pytest
from mcap.writer import CompressionType, Writer

import drivelint
from tests.faults import drives
from tests.formats.foxglove import foxglove_log
from tests.formats.mcap.damage import DATA_END, FOOTER, MESSAGE, STATISTICS, places, replaced, with_index_crc
from tests.formats.osi import osi_log
from tests.formats.ros2 import ros_log

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

RULE = "ukhc.no-collision"
CAMERA = "/camera"


def check_outcome(path: Path, **options: Any) -> tuple[int, dict[str, str], list[str]]:
    """Return exit code, findings by check, and verdicts."""
    result = drivelint.check([path], rules=RULE, annotate=False, robustness=False, **options)
    (drive,) = result.drives.arrow().to_pylist()
    found = {found["check_id"]: found["message"] for found in drive["quality"]}
    return result.exit_code, found, result.verdicts.arrow()["verdict"].to_pylist()


def osi(path: Path) -> bytes:
    messages = osi_log.truths(drives.truths(drives.drive()))
    return osi_log.write(path, messages, use_chunking=False, enable_data_crcs=False).read_bytes()


def ros(path: Path) -> bytes:
    return unchunked(path, drives.ros(path, drives.drive()))


def foxglove(path: Path) -> bytes:
    return unchunked(path, foxglove_log.write(path, drives.scenes(drives.drive())))


def unchunked(path: Path, log: Path, *, camera: bool = False) -> bytes:
    """Return a log with its messages outside of chunks, where one can be taken away and every CRC stays right; and one of a camera."""
    from mcap.reader import make_reader

    out = path.with_name("unchunked.mcap")
    with log.open("rb") as source, out.open("wb") as sink:
        writer = Writer(sink, use_chunking=False, enable_data_crcs=False, compression=CompressionType.NONE)
        writer.start()
        channels: dict[int, int] = {}
        for schema, channel, message in make_reader(source).iter_messages(log_time_order=False):
            assert schema is not None
            if channel.id not in channels:
                number = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, number)
            writer.add_message(channels[channel.id], message.log_time, message.data, message.publish_time)
        if camera:
            number = writer.register_channel(CAMERA, "raw", writer.register_schema("picture", "raw", b""))
            for k in range(3):
                writer.add_message(number, k, b"pixels", k)
        writer.finish()  # type: ignore[no-untyped-call]
    return out.read_bytes()


def without_message(data: bytes, k: int) -> bytes:
    """Return a log without one of its messages; its index is where it was said to be, and counts it."""
    begin, end = places(data, MESSAGE)[k]
    data = data[:begin] + data[end:]
    ((at, _),) = places(data, FOOTER)
    start, offsets = struct.unpack_from("<QQ", data, at + 9)
    size = end - begin
    return replaced(data, at + 9, struct.pack("<QQ", start - size, offsets - size if offsets else 0))


def wrong_index_crc(data: bytes) -> bytes:
    ((_, end),) = places(data, FOOTER)
    return replaced(data, end - 4, b"\1\2\3\4")


@pytest.mark.parametrize("write", [osi, ros, foxglove])
@pytest.mark.parametrize("crc", [with_index_crc, wrong_index_crc], ids=["right index CRC", "wrong index CRC"])
def test_a_message_is_missing(tmp_path: Path, write: Callable[[Path], bytes], crc: Callable[[bytes], bytes]) -> None:
    path = tmp_path / "log.mcap"
    whole = write(path)
    path.write_bytes(crc(whole))
    code, found, verdicts = check_outcome(path, ego="0")
    assert (code, verdicts.count("pass")) == (0, 2)
    assert "index_mismatch" not in found
    assert ("index_damaged" in found) == (crc is wrong_index_crc)
    path.write_bytes(crc(without_message(whole, 20)))
    code, found, _ = check_outcome(path, ego="0")
    assert code == 3
    assert f"counts {drives.N} messages of topic " in found["index_mismatch"]
    assert (
        f"the file has {drives.N - 1}: the present messages are read, the missing ones are lost"
        in found["index_mismatch"]
    )


@pytest.mark.ci
def test_an_index_that_contradicts_itself_is_no_witness(tmp_path: Path) -> None:
    """With a wrong CRC: it is its own count that was changed."""
    path = tmp_path / "log.mcap"
    data = osi(path)
    at = places(data, STATISTICS)[0][0] + 9
    path.write_bytes(wrong_index_crc(replaced(data, at, struct.pack("<Q", drives.N + 5))))
    code, found, _ = check_outcome(path)
    assert (code, "index_mismatch" in found) == (0, False)
    path.write_bytes(with_index_crc(replaced(data, at, struct.pack("<Q", drives.N + 5))))
    assert check_outcome(path)[0] == 3


@pytest.mark.ci
def test_a_topic_that_is_not_read_is_no_matter(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    data = unchunked(path, drives.ros(path, drives.drive()), camera=True)
    path.write_bytes(with_index_crc(without_message(data, drives.N + 1)))
    code, found, _ = check_outcome(path, ego="0")
    assert (code, "index_mismatch" in found) == (0, False)
    path.write_bytes(with_index_crc(without_message(data, 3)))
    code, found, _ = check_outcome(path, ego="0")
    assert code == 3
    assert CAMERA not in found["index_mismatch"]


def test_all_messages_of_the_topic_that_is_not_here_are_missing(tmp_path: Path) -> None:
    """An index may name a topic of which the file has not one message."""
    path = tmp_path / "log.mcap"
    data = unchunked(path, drives.ros(path, drives.drive()), camera=True)
    for _ in range(3):
        data = without_message(data, drives.N)
    path.write_bytes(with_index_crc(data))
    code, found, _ = check_outcome(path, ego="0")
    assert code == 3  # nobody knows what was on it
    assert f"counts 3 messages of topic '{CAMERA}', the file has 0" in found["index_mismatch"]


@pytest.mark.ci
def test_the_index_of_a_chunk_names_a_message_that_is_not_in_it(tmp_path: Path) -> None:
    """The chunk was packed anew without it, with a CRC that is right, and so was the count of all."""
    path = tmp_path / "log.mcap"
    messages = osi_log.truths(drives.truths(drives.drive()))
    kept = [each for k, each in enumerate(messages) if k != 20]
    whole, less = (
        osi_log.write(path, some, chunk_size=1 << 20, enable_data_crcs=False).read_bytes() for some in (messages, kept)
    )
    path.write_bytes(with_message_index_of(less, whole))
    code, found, verdicts = check_outcome(path)
    assert code == 3
    assert "at 2.000 s is lost: no rule is judged across this time" in found["lost_time"]
    assert "unknown" in verdicts
    path.write_bytes(less)
    assert check_outcome(path)[0] == 0


def with_message_index_of(data: bytes, other_log: bytes) -> bytes:
    """Return a log of one chunk with the index of another log behind its chunk, and what the footer says moved by as much."""
    message_index = 7
    ((begin, end),), ((other_begin, other_end),) = places(data, message_index), places(other_log, message_index)
    data = data[:begin] + other_log[other_begin:other_end] + data[end:]
    more = (other_end - other_begin) - (end - begin)
    ((at, _),) = places(data, FOOTER)
    start, offsets = struct.unpack_from("<QQ", data, at + 9)
    assert places(data, DATA_END)
    return with_index_crc(replaced(data, at + 9, struct.pack("<QQ", start + more, offsets + more if offsets else 0)))


BAG_METADATA = """rosbag2_bagfile_information:
  version: 9
  storage_identifier: mcap
  relative_file_paths:
    - a.mcap
    - b.mcap
  message_count: {n}
  topics_with_message_count:
    - topic_metadata: {{name: /carla/objects, type: derived_object_msgs/msg/ObjectArray, serialization_format: cdr}}
      message_count: {n}
    - topic_metadata: {{name: /camera, type: sensor_msgs/msg/Image, serialization_format: cdr}}
      message_count: 999
"""


@pytest.mark.parametrize(("n_lost", "code"), [(0, 0), (1, 3)])
def test_the_description_of_a_bag_counts_more(tmp_path: Path, n_lost: int, code: int) -> None:
    bag = drives.bag(tmp_path / "bag", drives.drive())
    (bag / "metadata.yaml").write_text(BAG_METADATA.format(n=drives.N), encoding="utf-8")
    messages = drives.things(drives.drive())
    ros_log.write(bag / "b.mcap", messages[drives.N // 2 + n_lost :])
    found = check_outcome(bag, ego="0")
    assert found[0] == code
    said = f"counts {drives.N} messages of topic '/carla/objects', the bag has {drives.N - 1}: 1 are lost"
    assert (said in found[1].get("index_mismatch", "")) == bool(n_lost)


def test_a_canonical_folder_counts_more(tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    folder = drives.canonical(tmp_path / "drive", drives.drive())
    pq.write_table(pa.table({"n_states": [3 * drives.N + 1]}), folder / "data_log.parquet")
    with pytest.raises(drivelint.DriveLintError, match=r"120 rows, but data_log\.parquet states 121") as error:
        check_outcome(folder, ego="0")
    assert error.value.exit_code == 4
