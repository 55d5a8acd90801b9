"""Messages of types that are not read: the guide's script makes a table of them, for which `inspect` drafts the mapping."""

from __future__ import annotations

import math
import sqlite3
import subprocess
import sys
from contextlib import closing
from typing import TYPE_CHECKING, Any

import pytest
from rosbags import rosbag2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from drivelint.drive.trace import IngestOptions
from drivelint.errors import TraceError, UsageError
from drivelint.formats import read_trace
from drivelint.guide import FOLDER
from drivelint.inspect import InspectRequest, inspect
from tests.formats.logs import actors, put, read, states
from tests.formats.sqlite_bag.sqlite_log import OLD_TABLES
from tests.guide.blocks import blocks

if TYPE_CHECKING:
    from pathlib import Path

EGO, TURNED, TRACKS = "acme_msgs/msg/EgoState", "acme_msgs/msg/TurnedState", "acme_msgs/msg/FusedTrackArray"
DEFINITIONS = {
    EGO: "std_msgs/Header header\nfloat64 x\nfloat64 y\nfloat64 yaw\nfloat64 v\nuint32 time_ms",
    TURNED: "std_msgs/Header header\nfloat64 y\nfloat64 x\nfloat64 yaw\nfloat64 v\nuint32 time_ms",
    "acme_msgs/msg/FusedTrack": (
        "uint32 track_id\nuint8 kind\ngeometry_msgs/Point position\nfloat64 heading_deg\nfloat64 speed_kmh\n"
        "geometry_msgs/Vector3 size"
    ),
    TRACKS: "std_msgs/Header header\nacme_msgs/FusedTrack[] tracks",
}


STEPS = range(101)


def bag(
    folder: Path,
    ego_steps: range = STEPS,
    track_steps: range = STEPS,
    *,
    frame: str = "map",
    turned_from: int = 101,
    unstamped: range = range(0),
) -> Path:
    """Return a bag of two seconds: the ego at 50 Hz and 10 m/s to the north, and a car 30 m ahead at 10 Hz and 8 m/s.

    `frame`: that of the tracks. From the step `turned_from` on, the ego's messages have another type. `unstamped`: steps of the ego
    without a time.
    """
    store = get_typestore(Stores.ROS2_HUMBLE)
    for name, text in DEFINITIONS.items():
        store.register(get_types_from_msg(text, name))
    types = store.types
    point, vector = types["geometry_msgs/msg/Point"], types["geometry_msgs/msg/Vector3"]
    with rosbag2.Writer(folder, version=9, storage_plugin=rosbag2.StoragePlugin.MCAP) as writer:
        to = {
            kind: writer.add_connection(topic, kind, typestore=store)
            for kind, topic in ((EGO, "/acme/ego"), (TURNED, "/acme/ego"), (TRACKS, "/acme/fused_tracks"))
            if kind != TURNED or turned_from in STEPS
        }
        for i in range(101):
            t_ns = 1_700_000_000_000_000_000 + i * 20_000_000
            stamp = types["builtin_interfaces/msg/Time"](*divmod(t_ns, 10**9))
            header = types["std_msgs/msg/Header"](stamp, "map")
            own = (
                header
                if i not in unstamped
                else types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](0, 0), "map")
            )
            values: dict[str, Any] = {
                "header": own,
                "x": 5.0,
                "y": 0.2 * i,
                "yaw": math.pi / 2,
                "v": 10.0,
                "time_ms": 20 * i,
            }
            kind = TURNED if i >= turned_from else EGO
            messages = {kind: types[kind](**values)} if i in ego_steps else {}
            if i % 5 == 0 and i in track_steps:
                place, size = point(5.0, 30.0 + 0.16 * i, 0.0), vector(4.5, 1.8, 1.5)
                track = types["acme_msgs/msg/FusedTrack"](7, 1, place, 90.0, 28.8, size)
                messages[TRACKS] = types[TRACKS](types["std_msgs/msg/Header"](stamp, frame), [track])
            for kind, message in messages.items():
                writer.write(to[kind], t_ns, store.serialize_cdr(message, kind))
    return folder


def guide_mapping(folder: Path) -> str:
    (block,) = (block.body for block in blocks(FOLDER / "mapping.md") if "[[ros]]" in block.body)
    return str(put(folder / "acme.toml", block))


def test_the_mapping_of_the_guide_reads_messages_of_other_types(tmp_path: Path) -> None:
    trace = read_trace(bag(tmp_path / "bag"), IngestOptions(mapping=guide_mapping(tmp_path)))
    assert {name: (row["actor_class"], row["is_ego"], row["length_m"]) for name, row in actors(trace).items()} == {
        "7": ("car", False, 4.5), "ego": ("car", True, 4.9),
    }  # fmt: skip
    row, mine = states(trace, "7")[50], states(trace, "ego")[50]
    assert (row["x_m"], row["y_m"], row["yaw_rad"], row["vy_mps"]) == pytest.approx((5.0, 38.0, math.pi / 2, 8.0))
    assert (mine["x_m"], mine["y_m"], mine["vy_mps"]) == pytest.approx((5.0, 10.0, 10.0))
    assert trace.tables["data_log"]["format"].to_pylist() == ["acme"]


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("/acme/ego", "/acme/egg", r"no message on topic '/acme/egg', which the mapping names: .*/acme/ego"),
        ('items = "tracks"', 'items = "trucks"', r"a message on '/acme/fused_tracks' has no list 'trucks' \(items\)"),
        ('x = "position.x"', 'x = "place.x"', "no column 'place.x', which mapping 'acme' needs"),
        ('"speed_kmh"', '"speed_kph"', "no column 'speed_kph', which mapping 'acme' needs: .*speed_kmh"),
        ('items = "tracks"', 'item = "tracks"', "unknown key 'ros.item'.*items"),
        ('unit = "km/h"', 'unit = "furlong"', "unknown unit 'furlong'"),
        ("/acme/ego", "/acme/fused_tracks", r"each \[\[ros\]\] needs a topic of its own"),
        ('items = "tracks"', 'items = "tracks"\ntime = "stamp"', "topic '/acme/fused_tracks' has no time 'stamp'"),
        ("[ros.columns]", 'time = "time_ms"\n[ros.columns]', "'time_ms' is a whole number, whose unit is not known"),
        ('value = "ego"', 'value = "7"', "'/acme/ego' and '/acme/fused_tracks' both have an actor '7'"),
    ],
)
def test_a_mapping_that_does_not_fit_is_refused(tmp_path: Path, old: str, new: str, why: str) -> None:
    path = guide_mapping(tmp_path)
    text = put(tmp_path / "acme.toml", (tmp_path / "acme.toml").read_text(encoding="utf-8").replace(old, new))
    assert str(text) == path
    with pytest.raises((TraceError, UsageError), match=why) as error:
        read_trace(bag(tmp_path / "bag"), IngestOptions(mapping=path))
    assert "\n" not in str(error.value)


def test_positions_in_a_frame_of_the_vehicle_are_refused(tmp_path: Path) -> None:
    path, mapping = bag(tmp_path / "bag", frame="base_link"), guide_mapping(tmp_path)
    with pytest.raises(TraceError, match="positions are in base_link, map by the messages"):
        read_trace(path, IngestOptions(mapping=mapping))
    put(tmp_path / "acme.toml", "one_frame = true\n" + (tmp_path / "acme.toml").read_text(encoding="utf-8"))
    assert len(states(read_trace(path, IngestOptions(mapping=mapping)), "7")) == 101


def test_messages_without_a_time_among_others_are_refused(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match=r"has messages whose 'header.stamp' is 0"):
        read_trace(bag(tmp_path / "bag", unstamped=range(3, 4)), IngestOptions(mapping=guide_mapping(tmp_path)))


@pytest.mark.parametrize("steps", [range(30), range(60, 101)])
def test_road_users_of_a_silent_topic_are_unknown(tmp_path: Path, steps: range) -> None:
    trace = read_trace(bag(tmp_path / "bag", track_steps=steps), IngestOptions(mapping=guide_mapping(tmp_path)))
    lost = [row["message"] for row in trace.tables["quality"].to_pylist() if row["check_id"] == "lost_time"]
    assert len(lost) == 1
    assert "/acme/fused_tracks has no messages while the odometry continues" in lost[0]


def test_messages_that_the_bag_counts_and_lacks_are_lost(tmp_path: Path) -> None:
    path, mapping = bag(tmp_path / "bag"), guide_mapping(tmp_path)
    metadata = path / "metadata.yaml"
    metadata.write_text(metadata.read_text().replace("message_count: 101", "message_count: 501"))
    quality = read_trace(path, IngestOptions(mapping=mapping)).tables["quality"].to_pylist()
    assert any(row["check_id"] == "index_mismatch" and "400 are lost" in row["message"] for row in quality)
    assert "lost_time" in {row["check_id"] for row in quality}


def test_each_message_is_read_by_the_definition_of_its_type(tmp_path: Path) -> None:
    path = bag(tmp_path / "bag", turned_from=50)
    rows = states(read_trace(path, IngestOptions(mapping=guide_mapping(tmp_path))), "ego")
    assert {row["x_m"] for row in rows} == {5.0}
    assert [row["y_m"] for row in rows] == pytest.approx([0.2 * i for i in STEPS])


def test_a_bag_without_definitions_is_read_with_the_files_of_its_messages(tmp_path: Path) -> None:
    """As Humble writes it into SQLite."""
    source, old = bag(tmp_path / "bag"), tmp_path / "old.db3"
    with closing(sqlite3.connect(old)) as file, rosbag2.Reader(source) as reader:
        file.executescript(OLD_TABLES)
        for each in reader.connections:
            file.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", (each.id, each.topic, each.msgtype))
        for each, t_ns, data in reader.messages():
            file.execute("INSERT INTO messages VALUES (NULL, ?, ?, ?)", (each.id, t_ns, data))
        file.commit()
    path = guide_mapping(tmp_path)
    with pytest.raises(TraceError, match="set message_files in the mapping"):
        read_trace(old, IngestOptions(mapping=path))
    text = 'message_files = "msgs"\n' + (tmp_path / "acme.toml").read_text(encoding="utf-8")
    put(tmp_path / "acme.toml", text)
    with pytest.raises(
        UsageError,
        match=r"msgs/acme_msgs/msg/EgoState.msg: the definition of acme_msgs/EgoState cannot be read: .*: "
        r"copy the folder msg of the package acme_msgs into .*/msgs/acme_msgs$",
    ):
        read_trace(old, IngestOptions(mapping=path))
    folder = tmp_path / "msgs" / "acme_msgs" / "msg"
    folder.mkdir(parents=True)
    for name, definition in DEFINITIONS.items():
        put(
            folder / f"{name.rsplit('/', maxsplit=1)[-1]}.msg",
            f"# a comment of three words\nuint8 LIMIT=3\n{definition}",
        )
    trace, wanted = (read_trace(each, IngestOptions(mapping=path)) for each in (old, source))
    for table in ("actor_state", "actor"):
        rows, others = ([{**row, "drive_id": ""} for row in each.tables[table].to_pylist()] for each in (trace, wanted))
        assert rows == others


@pytest.mark.ci
def test_inspect_says_which_topics_the_mapping_reads(tmp_path: Path) -> None:
    path = str(bag(tmp_path / "bag"))
    found = inspect(InspectRequest(trace=path, mapping=guide_mapping(tmp_path)))
    assert {each.topic: each.read_as for each in found.content.channels} == {
        "/acme/ego": "actors, by the mapping", "/acme/fused_tracks": "actors, by the mapping",
    }  # fmt: skip


def test_an_ego_that_is_absent_is_lost_time(tmp_path: Path) -> None:
    path = bag(tmp_path / "bag", ego_steps=range(40))
    checks = read_trace(path, IngestOptions(mapping=guide_mapping(tmp_path))).tables["quality"]["check_id"].to_pylist()
    assert "ego_absent" in checks


def test_the_guides_script_makes_a_table_of_messages_of_other_types(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match="drivelint docs mapping shows how messages of other types become a table"):
        read(bag(tmp_path / "bag"))
    (script,) = (block.body for block in blocks(FOLDER / "mapping.md") if block.language == "python")
    subprocess.run([sys.executable, put(tmp_path / "table.py", script)], cwd=tmp_path, check=True)
    draft = inspect(InspectRequest(trace=str(tmp_path / "drive.csv"))).content.draft_mapping
    assert draft is not None
    assert 'speed = { column = "speed_kmh", unit = "km/h" }' in draft
    full = draft.replace('values = { "car" = "car" }', 'values = { "car" = "car", "1" = "car" }')
    full = full.replace("ids = []", 'ids = ["ego"]')
    trace = read_trace(tmp_path / "drive.csv", IngestOptions(mapping=str(put(tmp_path / "my.toml", full))))
    assert {name: (row["actor_class"], row["is_ego"]) for name, row in actors(trace).items()} == {
        "7": ("car", False),
        "ego": ("car", True),
    }
    row = states(trace, "7")[50]
    assert (row["x_m"], row["y_m"], row["vy_mps"]) == pytest.approx((5.0, 38.0, 8.0))
