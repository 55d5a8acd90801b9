"""Writes bags in SQLite as rosbag2 does, by code of the tests' own: with message definitions (since Iron) and without."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING

from tests.formats.ros2 import ros_log as ros

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

OLD_TABLES = """
    CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL,
        offered_qos_profiles TEXT NOT NULL);
    CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL);
    CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""
NEW_TABLES = """
    CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
    INSERT INTO schema VALUES (4, 'iron');
    CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
        encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);
"""
FOXY = ros.BASE | {"shape_msgs/SolidPrimitive": "uint8 type\nfloat64[<=3] dimensions"}
"""Before Humble, a shape has no polygon."""


def write(
    path: Path, messages: Iterable[ros.Message], types: dict[str, str] = ros.BASE, *, definitions: bool = True
) -> Path:
    """Write one file."""
    with closing(sqlite3.connect(path)) as file:
        file.executescript(OLD_TABLES + (NEW_TABLES if definitions else ""))
        topics: dict[str, int] = {}
        written: set[str] = set()
        for topic, name, t_s, content in messages:
            kind = name.replace("/", "/msg/")
            if definitions and name not in written:
                written.add(name)
                text = ros.definition(name, types)
                file.execute("INSERT INTO message_definitions VALUES (NULL, ?, 'ros2msg', ?, '')", (kind, text))
            if topic not in topics:
                topics[topic] = len(topics) + 1
                file.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", (topics[topic], topic, kind))
            data = ros.encode(name, content, types)
            file.execute("INSERT INTO messages VALUES (NULL, ?, ?, ?)", (topics[topic], round(t_s * 1e9), data))
        file.commit()
    return path


def bag(folder: Path, parts: list[list[ros.Message]], *, definitions: bool = True, suffix: str = ".db3") -> Path:
    """Write a bag that is split into several files."""
    folder.mkdir()
    names = [f"drive_{n}{suffix}" for n in range(len(parts))]
    for name, part in zip(names, parts, strict=True):
        if suffix == ".db3":
            write(folder / name, part, definitions=definitions)
        else:
            ros.write(folder / name, part)
    listed = "".join(f"    - {name}\n" for name in names)
    storage = "sqlite3" if suffix == ".db3" else "mcap"
    text = (
        f"rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: {storage}\n  relative_file_paths:\n{listed}"
    )
    (folder / "metadata.yaml").write_text(text, encoding="utf-8")
    return folder
