"""A damaged, unfinished or hostile file of SQLite is one clear line, in bounded time and memory."""

from __future__ import annotations

import sqlite3
from contextlib import closing, suppress
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.errors import TraceError
from drivelint.formats import read_trace
from drivelint.formats.sqlite_bag.reader import SqliteFile
from tests.formats.ros2 import ros_drive
from tests.formats.ros2 import ros_log as ros
from tests.formats.sqlite_bag import sqlite_log
from tests.fuzz.mutations import generator

if TYPE_CHECKING:
    from pathlib import Path


def messages() -> list[ros.Message]:
    return sorted([*ros_drive.ego(), *ros_drive.road_users()], key=lambda message: message[2])


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return sqlite_log.write(tmp_path / "log.db3", messages())


def refusal(path: Path) -> str:
    """Return the error of reading a file: one line that begins with the path."""
    with pytest.raises(TraceError) as error:
        read_trace(path, IngestOptions())
    text = str(error.value)
    assert text.startswith(f"{path}: ")
    assert "\n" not in text
    return text


def change(path: Path, sql: str) -> Path:
    with closing(sqlite3.connect(path)) as file:
        file.executescript(sql)
        file.commit()
    return path


@pytest.mark.parametrize("share", [0.002, 0.1, 0.5, 0.9, 0.999])
def test_a_truncated_file_is_refused(log: Path, share: float) -> None:
    whole = log.read_bytes()
    log.write_bytes(whole[: int(share * len(whole))])
    assert "a SQLite file that is damaged or cut off (" in refusal(log)
    log.write_bytes(b"")
    assert "the file is empty (0 bytes)" in refusal(log)


def test_a_zeroed_page_is_no_shorter_log(log: Path) -> None:
    """Pages that contradict each other may lack rows without an error: the file is checked as a whole."""
    whole = log.read_bytes()
    for page in range(1, len(whole) // 4096):
        log.write_bytes(whole[: page * 4096] + bytes(4096) + whole[(page + 1) * 4096 :])
        with suppress(TraceError):
            assert read_trace(log, IngestOptions()).tables["actor_state"].num_rows == 120


def test_flipped_bytes_are_an_error_or_are_said_to_remain_undetected(log: Path) -> None:
    whole, random = log.read_bytes(), generator("sqlite")
    for _ in range(60):
        data = bytearray(whole)
        for _ in range(random.choice((1, 4, 40))):
            data[random.randrange(16, len(data))] = random.randrange(256)
        log.write_bytes(data)
        with suppress(TraceError):
            assert "unprotected" in read_trace(log, IngestOptions()).tables["quality"]["check_id"].to_pylist()


def test_text_that_is_no_database(tmp_path: Path) -> None:
    path = tmp_path / "log.db3"
    path.write_bytes(b"x" * 500)
    assert "not db3: it should begin b'SQLite format 3" in refusal(path)
    path.write_bytes(b"SQLite format 3\0" + b"x" * 500)
    assert "a SQLite file that is damaged" in refusal(path)


def test_another_database_is_no_bag(tmp_path: Path) -> None:
    path = change(tmp_path / "log.db3", "CREATE TABLE songs(id INTEGER)")
    assert "a SQLite file without the table 'topics': no bag of ROS 2" in refusal(path)


@pytest.mark.parametrize("suffix", ["-wal", "-journal"])
def test_a_file_that_was_not_closed_names_the_command_that_closes_it(log: Path, suffix: str) -> None:
    beside = log.with_name(log.name + suffix)
    beside.write_bytes(b"1")
    text = refusal(log)
    assert f"its recorder did not close it, and {beside.name} has messages that are not in it" in text
    assert text.endswith("'PRAGMA journal_mode = DELETE'")


@pytest.mark.parametrize("suffix", ["-wal", "-journal"])
def test_a_link_to_a_file_that_was_not_closed_names_the_command_for_the_file(log: Path, suffix: str) -> None:
    """SQLite writes beside the file, not beside the link."""
    log.with_name(log.name + suffix).write_bytes(b"1")
    link = log.parent / "links" / "link.db3"
    link.parent.mkdir()
    link.symlink_to(log)
    text = refusal(link)
    assert f"its recorder did not close it, and {log.name}{suffix} has messages that are not in it" in text
    assert text.endswith(f"sqlite3 {log.resolve()} 'PRAGMA journal_mode = DELETE'")


def test_a_link_to_a_closed_file_is_read(log: Path) -> None:
    link = log.parent / "link.db3"
    link.symlink_to(log)
    assert read_trace(link, IngestOptions()).tables["actor_state"].num_rows == 120


def test_a_repaired_file_is_not_to_be_repaired_again(log: Path) -> None:
    repaired = log.rename(log.with_name("repaired-log.db3"))
    repaired.write_bytes(repaired.read_bytes()[:9000])
    text = refusal(repaired)
    assert text.endswith("): copy it again")
    assert "repaired-repaired" not in text


def checks(path: Path) -> dict[str, list[dict[str, Any]]]:
    """Return check -> its rows of reading a file."""
    found: dict[str, list[dict[str, Any]]] = {}
    for row in read_trace(path, IngestOptions()).tables["quality"].to_pylist():
        found.setdefault(row["check_id"], []).append(row)
    return found


GAP = "DELETE FROM messages WHERE id BETWEEN 21 AND 30;"
"""The messages at 100.5 to 100.7 s, of 2 s and 80 rows in all."""
RECOVERED = "CREATE TABLE lost_and_found_0(rootpgno INTEGER, pgno INTEGER, nfield INTEGER, id INTEGER, c0, c1, c2, c3);"


def test_rows_that_a_repair_did_not_find_are_lost(log: Path) -> None:
    lost = checks(change(log, GAP + RECOVERED))["lost_time"]
    assert (
        "log.db3: the file was repaired (it has a table lost_and_found), and rows of messages from 21 to 30 are missing: "
        in (lost[0]["message"])
    )
    assert "from 0.450 s to 0.750 s is lost" in lost[0]["message"]
    assert (
        "rows of messages from 81 on may be missing: the recording from 1.950 s to the end is lost"
        in lost[1]["message"]
    )


def test_rows_that_a_repair_did_not_find_at_the_start_are_lost(log: Path) -> None:
    lost = checks(change(log, "DELETE FROM messages WHERE id <= 4;" + RECOVERED))["lost_time"]
    assert (
        "rows of messages from 1 to 4 are missing: the recording from the beginning to 0.000 s is lost"
        in lost[0]["message"]
    )


def test_gaps_alone_are_reported_but_no_loss(log: Path) -> None:
    """A user may have deleted a topic from an honest bag."""
    assert "index_mismatch" not in checks(log)
    found = checks(change(log, GAP))
    assert "lost_time" not in found
    (row,) = found["index_mismatch"]
    assert (row["severity"], row["n"]) == ("info", 1)
    assert row["message"].startswith("gaps in the row numbers of messages: 1: ")


def test_the_command_closes_it(tmp_path: Path) -> None:
    """With the write-ahead log of a recorder that was killed."""
    path = sqlite_log.write(tmp_path / "source.db3", messages())
    with closing(sqlite3.connect(path)) as file:
        file.execute("PRAGMA journal_mode = WAL")
        file.execute("UPDATE topics SET name = name || '2'")
        file.commit()
        for suffix in ("", "-wal"):
            killed = tmp_path / f"log.db3{suffix}"
            killed.write_bytes((tmp_path / f"source.db3{suffix}").read_bytes())
    killed = tmp_path / "log.db3"
    command = refusal(killed).rsplit("'", 2)[1]
    with closing(sqlite3.connect(killed)) as file:
        file.execute(command)
    read_trace(killed, IngestOptions())
    assert "/carla/objects2" in {channel.topic for channel in SqliteFile(killed).index().channels.values()}


@pytest.mark.parametrize(
    ("sql", "why"),
    [
        (
            ("ALTER TABLE messages RENAME TO m; CREATE VIEW messages AS WITH RECURSIVE r(topic_id, timestamp, data) AS "
            "(SELECT 1, 1, x'00' UNION ALL SELECT topic_id, timestamp + 1, data FROM r) SELECT * FROM r"),
            "its table 'messages' is not as rosbag2 writes it",
        ),
        (
            ("DROP TABLE messages; CREATE TABLE messages(topic_id INTEGER, timestamp INTEGER, "
            "data BLOB AS (zeroblob(100000000)) VIRTUAL); INSERT INTO messages VALUES (1, 5)"),
            "its table 'messages' is not as rosbag2 writes it",
        ),
        (
            ("DROP TABLE messages; CREATE TABLE messages(topic_id INTEGER, timestamp INTEGER); WITH RECURSIVE r(i) AS (SELECT 1 "
            "UNION ALL SELECT i + 1 FROM r LIMIT 2000) INSERT INTO messages SELECT 1, i FROM r; ALTER TABLE messages ADD COLUMN "
            f"data BLOB DEFAULT x'{'00' * 100000}'"),
            "its messages are longer than its ",
        ),
        ("UPDATE messages SET topic_id = 77 WHERE id = 5", "row 5 of messages has the topic 77"),
        ("UPDATE messages SET timestamp = 'noon' WHERE id = 5", "row 5 of messages has the topic 1 and the time 'noon'"),
        ("UPDATE messages SET timestamp = -1 WHERE id = 5", "the time -1"),
        ("UPDATE messages SET data = 'text' WHERE id = 5", "row 5 of messages has no data"),
        ("UPDATE topics SET name = x'ff00'", "row 1 of topics is not as rosbag2 writes it"),
        ("UPDATE message_definitions SET encoded_message_definition = x'00'", "is not text"),
        ("DROP TABLE topics; CREATE TABLE topics(id INTEGER)", "its table 'topics' is not as rosbag2 writes it"),
    ],
)  # fmt: skip
def test_a_hostile_file_is_refused(log: Path, sql: str, why: str) -> None:
    assert why in refusal(change(log, sql))


def test_reading_leaves_the_file_and_its_folder_unchanged(log: Path) -> None:
    before = log.read_bytes()
    log.chmod(0o400)
    log.parent.chmod(0o500)
    try:
        read_trace(log, IngestOptions())
    finally:
        log.parent.chmod(0o700)
    assert log.read_bytes() == before
    assert [file.name for file in log.parent.iterdir()] == [log.name]


def test_a_malformed_message_is_left_out_and_named_by_its_row(log: Path) -> None:
    trace = read_trace(change(log, "UPDATE messages SET data = x'00010000' WHERE id = 21"), IngestOptions())
    lost = [row for row in trace.tables["quality"].to_pylist() if row["check_id"] == "lost_time"]
    assert any("row 21 of messages" in row["message"] for row in lost)
