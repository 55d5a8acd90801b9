"""The parts of a bag whose `metadata.yaml` is missing, as after a crash, are drives of their own, and say so."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.formats.logs import quality, read
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import ego, road_users
from tests.formats.sqlite_bag import sqlite_log

if TYPE_CHECKING:
    from pathlib import Path


def parts(folder: Path, suffix: str, gap_s: float = 0.0) -> list[Path]:
    """Write a recording of two seconds in two files; `gap_s`: the time between them."""
    messages = sorted([*ego(), *road_users()], key=lambda message: message[2])
    half = len(messages) // 2
    later = [(topic, name, t_s + gap_s, content) for topic, name, t_s, content in messages[half:]]
    write = ros.write if suffix == ".mcap" else sqlite_log.write
    folder.mkdir()
    return [write(folder / f"drive_{n}{suffix}", each) for n, each in enumerate([messages[:half], later])]


@pytest.mark.parametrize("suffix", [".mcap", ".db3"])
def test_each_part_says_how_to_make_one_drive_of_them(tmp_path: Path, suffix: str) -> None:
    for part in parts(tmp_path / "bag", suffix):
        found = quality(read(part))["bag_part"]
        assert found["severity"] == "warning"
        assert found["message"].endswith(f"first run ros2 bag reindex {tmp_path / 'bag'}")


def test_logs_of_other_times_are_no_parts(tmp_path: Path) -> None:
    for log in parts(tmp_path / "logs", ".mcap", gap_s=60.0):
        assert "bag_part" not in quality(read(log))


def test_a_part_of_a_bag_that_is_whole_is_a_choice_of_the_user(tmp_path: Path) -> None:
    first, _ = parts(tmp_path / "bag", ".mcap")
    (first.parent / "metadata.yaml").write_text("rosbag2_bagfile_information:\n", encoding="utf-8")
    assert "bag_part" not in quality(read(first))


def test_an_unreadable_neighbour_does_not_matter(tmp_path: Path) -> None:
    first, second = parts(tmp_path / "bag", ".mcap")
    second.write_bytes(b"")
    assert "bag_part" not in quality(read(first))
