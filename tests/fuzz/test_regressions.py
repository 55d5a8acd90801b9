"""What fuzzing found: files that ended in a traceback, in all memory, or in another drive that nobody said was another."""

from __future__ import annotations

import io
import re
import shutil
import struct
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.catalogue.load import read_rule
from drivelint.drive.contradiction import _first_and_last_rows_within_half_second
from drivelint.drive.lost_time import LATEST_CREDIBLE_NS
from drivelint.engine import profiles
from drivelint.errors import RuleError, TraceError, UsageError
from drivelint.formats.film import mapping as film_mapping
from drivelint.gate import waivers
from drivelint.result.files import parquet_bytes
from drivelint.result.load import _table, load_result
from drivelint.result.names import TABLE_OF_FILE
from drivelint.result.schemas import empty_table
from drivelint.settings import read_settings
from tests.formats.logs import cars, mapping, quality, read, table
from tests.formats.mcap.damage import FOOTER, places, replaced
from tests.formats.osi import osi_log
from tests.formats.ros2 import ros_drive, ros_log
from tests.fuzz import sources
from tests.fuzz.driver import Driver
from tests.fuzz.outcome import GOOD
from tests.fuzz.worker import Job

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

N = 30
DEEP = "a = " + "[" * 20_000


def osi(path: Path, late: dict[int, int], **options: Any) -> Path:
    """Write a drive of which some messages have other log times."""
    messages = osi_log.truths(osi_log.drive(N))
    messages = [
        osi_log.Out(each.name, each.topic, late.get(i, each.log_time), each.data) for i, each in enumerate(messages)
    ]
    return osi_log.write(path / "late.mcap", messages, **options)


def lost_times(trace: Trace) -> list[tuple[int | None, int | None]]:
    rows = trace.tables["quality"].to_pylist()
    return [(row["t_first_ns"], row["t_last_ns"]) for row in rows if row["check_id"] == "lost_time"]


def test_a_log_time_beyond_all_clocks_is_a_malformed_message_of_which_nobody_knows_when_it_was(tmp_path: Path) -> None:
    assert lost_times(read(osi(tmp_path, {4: 2**63}))) == [(None, None)]
    assert lost_times(read(osi(tmp_path, {}))) == []


@pytest.mark.parametrize("write", ["ros", "foxglove"])
def test_such_a_log_time_in_other_messages(tmp_path: Path, write: str) -> None:
    source = next(each for each in getattr(sources, write)(tmp_path) if each.name in {"ros", "json"})
    path = source.write(tmp_path / "late")
    data = path.read_bytes()
    assert not lost_times(read(path, ego=source.options.get("ego")))
    changed = with_late_message(data)
    path.write_bytes(changed)
    assert lost_times(read(path, ego=source.options.get("ego"))) == [(None, None)]


def with_late_message(data: bytes) -> bytes:
    """Write an MCAP file anew, one message of the busiest channel with a log time of 2^63."""
    from mcap.reader import make_reader
    from mcap.writer import Writer

    sink = io.BytesIO()
    writer = Writer(sink)
    writer.start()
    made: dict[int, int] = {}
    for i, (schema, channel, message) in enumerate(make_reader(io.BytesIO(data)).iter_messages(log_time_order=False)):
        assert schema is not None
        if channel.id not in made:
            number = writer.register_schema(schema.name, schema.encoding, schema.data)
            made[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, number)
        writer.add_message(made[channel.id], 2**63 if i == 12 else message.log_time, message.data, message.log_time)
    writer.finish()  # type: ignore[no-untyped-call]
    return sink.getvalue()


@pytest.mark.parametrize("time", [str(2**62 / 1e9 + 1), "-9.2e9"])
def test_states_of_no_time_at_all_are_refused(tmp_path: Path, time: str) -> None:
    lines = cars()
    lines[5] = re.sub("^[^,]+", time, lines[5])
    with pytest.raises(TraceError, match="the clock or its unit is wrong"):
        read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path))


def test_the_neighbours_in_time_are_found_whatever_the_clock_spans() -> None:
    """A piece's number times the log's span was beyond 64 bits: the neighbours were of other pieces, or beyond the end."""

    class Some:
        t_ns = np.array(
            [
                -LATEST_CREDIBLE_NS,
                0,
                400_000_000,
                800_000_000,
                1_500_000_000,
                LATEST_CREDIBLE_NS,
                0,
                100,
                LATEST_CREDIBLE_NS,
            ]
        )

    pieces = np.array([0, 0, 0, 0, 0, 0, 7, 7, 7])
    first, last = _first_and_last_rows_within_half_second(Some(), pieces, np.arange(9))  # type: ignore[arg-type]
    assert first.tolist() == [0, 1, 1, 2, 4, 5, 6, 6, 8]
    assert last.tolist() == [0, 2, 3, 3, 4, 5, 7, 7, 8]


def test_an_id_without_end_is_refused(tmp_path: Path) -> None:
    lines = [line.replace(",b,", f",{'b' * 1001},") for line in cars()]
    with pytest.raises(TraceError, match=r"an actor's id of 1001 characters, which begins 'bbb"):
        read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path))
    lines = [line.replace(",b,", f",{'b' * 1000},") for line in cars()]
    assert read(table(tmp_path / "d.csv", lines), mapping=mapping(tmp_path))


def test_an_error_of_a_long_text_is_shown_without_its_middle() -> None:
    assert str(UsageError("a" * 500)) == "a" * 500
    shown = str(UsageError(f"file x: unknown key {'k' * 300_000}: correct it"))
    assert len(shown) < 2100
    assert shown.startswith("file x: unknown key kkk")
    assert shown.endswith("kkk: correct it")


def test_a_column_that_stands_twice_is_refused(tmp_path: Path) -> None:
    rows = pa.table([[0], ["a"], [0.0], [0.0], [0.0], [1.0]], ["t_ns", "actor_id", "x_m", "y_m", "yaw_rad", "x_m"])
    pq.write_table(rows, tmp_path / "a.parquet")
    with pytest.raises(TraceError, match="the column 'x_m' occurs twice"):
        read(tmp_path / "a.parquet")


@pytest.mark.parametrize("name", ["data_log", "quality"])
def test_a_date_that_python_does_not_have_is_refused(tmp_path: Path, name: str) -> None:
    folder = sources.parquet(tmp_path)[0].write(tmp_path / "drive")
    texts = {each: ["a"] for each in ("check_id", "severity", "message")} if name == "quality" else {}
    late = pa.array([2**30], pa.int32()).cast(pa.date32())
    pq.write_table(pa.table({**texts, "n": late}), folder / f"{name}.parquet")
    with pytest.raises(TraceError, match=rf"{name}\.parquet: a value cannot be read"):
        read(folder)


def test_an_ego_without_an_id_is_none(tmp_path: Path) -> None:
    folder = sources.parquet(tmp_path)[0].write(tmp_path / "drive")
    actors = pq.read_table(folder / "actor.parquet", partitioning=None)
    ids = pa.array(
        [
            None if ego else name
            for name, ego in zip(actors["actor_id"].to_pylist(), actors["is_ego"].to_pylist(), strict=True)
        ]
    )
    pq.write_table(
        actors.set_column(actors.schema.get_field_index("actor_id"), "actor_id", ids), folder / "actor.parquet"
    )
    with pytest.raises(TraceError, match="no ego: the log does not name the ego"):
        read(folder)


def test_a_changed_page_of_our_own_parquet_is_refused(tmp_path: Path) -> None:
    """`convert` and `check` write page checksums, and whatever reads Parquet holds the pages against those that there are."""
    folder = sources.parquet(tmp_path)[0].write(tmp_path / "drive")
    file = folder / "actor_state.parquet"
    column = pq.ParquetFile(file).metadata.row_group(0).column(4)
    data = bytearray(file.read_bytes())
    data[column.data_page_offset + column.total_compressed_size // 2] ^= 1
    file.write_bytes(data)
    with pytest.raises(TraceError, match="not readable as Parquet"):
        read(folder)


@pytest.mark.sample(0, ci=3)
@pytest.mark.parametrize(
    ("kind", "number"),
    [
        ("parquet", 450),  # the library's metadata of a column ended the process where the sizes in it were wrong
        ("parquet", 5365),
        ("messages", 16),  # an id in JSON that is not UTF-8
        ("cells", 1076),  # a list in the column drive_id
        ("cells", 1537),
        ("baseline", 5436),  # names of files of a result that no file can have
        ("baseline", 5520),
    ],
)
def test_what_ended_in_a_crash_is_refused_or_flagged(kind: str, number: int) -> None:
    with Driver() as driver:
        (found,) = driver.run(Job(kind, 100, number, 1, is_judged=False))
    assert found.outcome in GOOD


def test_bytes_that_look_like_the_seam_of_two_files_are_data(tmp_path: Path) -> None:
    folder = sources.parquet(tmp_path)[0].write(tmp_path / "drive")
    states = pq.read_table(folder / "actor_state.parquet", partitioning=None)
    seam = pa.array(["\x10\0\0\0PAR1PAR1"] * states.num_rows)
    pq.write_table(states.append_column("note", seam), folder / "actor_state.parquet", compression="none")
    assert b"PAR1PAR1" in (folder / "actor_state.parquet").read_bytes()
    assert read(folder)


def test_a_changed_page_of_a_result_is_refused(tmp_path: Path) -> None:
    rows = empty_table(TABLE_OF_FILE["drives"]).schema
    content = bytearray(
        parquet_bytes(pa.Table.from_pylist([{"drive_id": f"d{i}"} for i in range(99)], rows), TABLE_OF_FILE["drives"])
    )
    content[40] ^= 1
    (tmp_path / "drives.parquet").write_bytes(content)
    with pytest.raises(UsageError, match="cannot be read: check the drives again"):
        _table(tmp_path / "drives.parquet")


@pytest.mark.parametrize("kind", ["osi-file", "folder", "states", "cars", "fcd"])
def test_a_log_without_checksums_says_so(tmp_path: Path, kind: str) -> None:
    makers = {"osi-file": sources.osi_file, "folder": sources.parquet, "states": sources.parquet, "cars": sources.csv}
    found = makers.get(kind, sources.xml_traces)(tmp_path)
    source = next((each for each in found if each.name == kind), found[0])
    said = quality(read(source.write(tmp_path / "log"), **source.options))["unprotected"]
    assert (said["severity"], "damage may remain undetected" in said["message"]) == ("info", True)


def test_a_log_with_checksums_does_not(tmp_path: Path) -> None:
    assert "unprotected" not in quality(read(osi(tmp_path, {})))


def test_a_film_of_impossible_frame_numbers_is_refused(tmp_path: Path) -> None:
    source = next(each for each in sources.csv(tmp_path) if each.name == "film")
    text = source.files["film.csv"].decode()
    for number in ("9223372036854775807", "1e18", "900000000"):
        changed = source.write(tmp_path / number, {"film.csv": text.replace("\n7,", f"\n{number},").encode()})
        found = quality(read(changed, **source.options))
        assert "malformed_row" in found
    every = re.sub(r"\n(\d+),", r"\n90000000\1,", text)
    with pytest.raises(TraceError, match="has no frame numbers"):
        read(source.write(tmp_path / "every", {"film.csv": every.encode()}), **source.options)


def test_messages_of_another_encoding_are_refused(tmp_path: Path) -> None:
    path = ros_log.write(tmp_path / "log.mcap", ros_drive.ego(n=20), order=">")
    data = path.read_bytes()
    for head in (b"\x00\x03\x00\x00", b"\x01\x00\x00\x00"):
        path.write_bytes(rewritten(data, head))
        with pytest.raises(TraceError, match=f"not encoded as plain CDR.*{head.hex()}"):
            read(path)


def rewritten(data: bytes, head: bytes) -> bytes:
    """Write a log anew with another CDR header in all messages."""
    from mcap.reader import make_reader
    from mcap.writer import Writer

    sink = io.BytesIO()
    writer = Writer(sink)
    writer.start()
    number = channel_number = 0
    for schema, channel, message in make_reader(io.BytesIO(data)).iter_messages():
        assert schema is not None
        number = number or writer.register_schema(schema.name, schema.encoding, schema.data)
        channel_number = channel_number or writer.register_channel(channel.topic, "cdr", number)
        writer.add_message(channel_number, message.log_time, head + message.data[4:], message.log_time)
    writer.finish()  # type: ignore[no-untyped-call]
    return sink.getvalue()


def test_a_definition_without_a_member_that_is_read(tmp_path: Path) -> None:
    types = {**ros_log.BASE, "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_ix"}
    path = ros_log.write(tmp_path / "log.mcap", ros_drive.ego(n=20), types)
    with pytest.raises(TraceError, match=r"log\.mcap: the definition of nav_msgs/msg/Odometry has no header\.frame_id"):
        read(path)


def test_a_bag_with_a_part_that_is_not_listed_or_empty(tmp_path: Path) -> None:
    """What is not listed is not read: without a word, half of a drive would be judged as all of it."""
    bag = next(each for each in sources.ros(tmp_path) if each.name == "bag").write(tmp_path / "drive")
    read(bag)
    shutil.copy(bag / "drive_1.mcap", bag / "drive_2.mcap")
    with pytest.raises(TraceError, match=r"does not list drive_2\.mcap"):
        read(bag)
    (bag / "drive_2.mcap").unlink()
    (bag / "drive_1.mcap").write_bytes(b"")
    with pytest.raises(TraceError, match=r"drive_1\.mcap, a part of this bag, is empty"):
        read(bag)


def test_a_description_of_a_bag_nested_without_end(tmp_path: Path) -> None:
    bag = next(each for each in sources.ros(tmp_path) if each.name == "bag").write(tmp_path / "drive")
    (bag / "metadata.yaml").write_text("rosbag2_bagfile_information: " + "[" * 20_000, encoding="utf-8")
    with pytest.raises(TraceError, match=r"its metadata\.yaml cannot be read"):
        read(bag)


def test_a_log_whose_only_message_is_malformed(tmp_path: Path) -> None:
    (message,) = osi_log.truths(osi_log.drive(1))
    broken = osi_log.Out(message.name, message.topic, 0, message.data[:-3])
    with pytest.raises(TraceError, match="no message of its ground truth can be decoded"):
        read(osi_log.write(tmp_path / "one.mcap", [broken]))


@pytest.mark.parametrize("start", [1, 8, 2000, 2**40, 2**63])
def test_an_index_that_begins_elsewhere_is_not_believed(tmp_path: Path, start: int) -> None:
    """Asked by the stock reader, it had a chunk unpacked, or gigabytes read."""
    path = osi(tmp_path, {})
    data = path.read_bytes()
    ((at, _),) = places(data, FOOTER)
    path.write_bytes(replaced(data, at + 9, struct.pack("<QQI", start, 0, 0)))
    assert read(path).tables["actor_state"].num_rows == 3 * N


def test_a_file_nested_without_end_is_one_line(tmp_path: Path) -> None:
    file = tmp_path / "x.toml"
    file.write_text(DEEP, encoding="utf-8")
    with pytest.raises(UsageError, match="not TOML"):
        waivers.read(file)
    with pytest.raises(UsageError, match="not valid TOML"):
        film_mapping.load(str(file))
    assert not film_mapping.is_video_mapping(str(file))
    with pytest.raises(UsageError, match="not TOML"):
        read_settings({}, file)
    (tmp_path / "profiles.toml").write_text(DEEP, encoding="utf-8")
    with pytest.raises(RuleError, match=r"profiles\.toml: "):
        profiles.load_profiles([tmp_path])
    (tmp_path / "profiles.toml").write_bytes(b"\xff")
    with pytest.raises(RuleError, match=r"profiles\.toml: "):
        profiles.load_profiles([tmp_path])
    (tmp_path / "rule.sql").write_text(f"-- {DEEP}\n-- @condition\nSELECT 1\n", encoding="utf-8")
    with pytest.raises(RuleError, match=r"rule\.sql"):
        read_rule(tmp_path / "rule.sql")
    (tmp_path / "summary.json").write_text("[" * 200_000, encoding="utf-8")
    with pytest.raises(UsageError, match="no result of drivelint check"):
        load_result(tmp_path)
