"""A bag in SQLite is read as the same bag in MCAP: tables, verdicts, pictures, and the annotated log with every message."""

from __future__ import annotations

import re
import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING, Any

import pytest

import drivelint
from drivelint.drive.trace import IngestOptions
from drivelint.errors import TraceError
from drivelint.formats import read_trace
from drivelint.formats.mcap import bag as bags
from drivelint.formats.ros2.messages import MESSAGE_TYPES
from drivelint.formats.sqlite_bag.definitions import candidate_definitions
from drivelint.formats.sqlite_bag.reader import SqliteFile
from drivelint.inspect.content import file_content, size_bytes
from drivelint.result.load import load_result
from tests.annotate.files import seeking, streaming, verify
from tests.formats.ros2 import autoware_log, ros_drive
from tests.formats.ros2 import ros_log as ros
from tests.formats.sqlite_bag import sqlite_log
from tests.pictures.camera_bag import FRONT, LEFT, write_bag

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

LAYOUTS = pytest.mark.parametrize("types", [ros.BASE, sqlite_log.FOXY], ids=["humble", "foxy"])
OF_THE_FILE = {"drive_id", "file_name", "sha256", "format"}


def messages(n: int = 40) -> list[ros.Message]:
    info = "/carla/hero/vehicle_info", "carla_msgs/CarlaWorldInfo", ros_drive.T0, {"map_name": "town"}
    return sorted([info, *ros_drive.ego(n=n), *ros_drive.road_users()[:n]], key=lambda message: message[2])


def read(path: Path, **options: Any) -> Trace:
    return read_trace(path, IngestOptions(**options))


def tables(trace: Trace) -> dict[str, Any]:
    """Return all that a trace says of its drive, without its file and what does not protect it."""
    rows = {name: table.to_pylist() for name, table in trace.tables.items()}
    rows["quality"] = [row for row in rows["quality"] if row["check_id"] != "unprotected"]
    return {name: [{k: v for k, v in row.items() if k not in OF_THE_FILE} for row in rows[name]] for name in rows}


@pytest.mark.parametrize("definitions", [True, False])
def test_a_file_in_sqlite_says_what_it_says_in_mcap(tmp_path: Path, definitions: bool) -> None:
    trace = read(sqlite_log.write(tmp_path / "log.db3", messages(), definitions=definitions))
    other = read(ros.write(tmp_path / "log.mcap", messages()))
    assert tables(trace) == tables(other)
    assert trace.tables["actor_state"].num_rows == 120
    assert trace.tables["data_log"]["format"].to_pylist() == ["ros2-sqlite"]
    assert "unprotected" in trace.tables["quality"]["check_id"].to_pylist()
    assert any("has no message definitions" in note for note in trace.notes) != definitions


def test_a_split_bag_is_one_drive(tmp_path: Path) -> None:
    parts = [messages()[:30], messages()[30:60], messages()[60:]]
    trace = read(sqlite_log.bag(tmp_path / "bag", parts))
    assert tables(trace) == tables(read(sqlite_log.bag(tmp_path / "other", parts, suffix=".mcap")))
    assert size_bytes(tmp_path / "bag") == sum(file.stat().st_size for file in (tmp_path / "bag").glob("*.db3"))
    (tmp_path / "bag" / "drive_1.db3").unlink()
    with pytest.raises(TraceError, match=r"drive_1\.db3, a part of this bag, is missing: copy the whole folder"):
        read(tmp_path / "bag")


def test_a_file_that_the_metadata_does_not_list_is_named(tmp_path: Path) -> None:
    folder = sqlite_log.bag(tmp_path / "bag", [messages()])
    sqlite_log.write(folder / "drive_1.db3", messages())
    with pytest.raises(TraceError, match=r"does not list drive_1\.db3"):
        read(folder)


def test_messages_that_the_metadata_counts_and_the_file_lacks_are_lost(tmp_path: Path) -> None:
    folder = sqlite_log.bag(tmp_path / "bag", [messages()])
    more = (
        "  topics_with_message_count:\n    - topic_metadata: {name: /carla/objects, type: derived_object_msgs/msg/ObjectArray}\n"
        "      message_count: 41\n"
    )
    (folder / "metadata.yaml").write_text(
        (folder / "metadata.yaml").read_text(encoding="utf-8") + more, encoding="utf-8"
    )
    checks = read(folder).tables["quality"].to_pylist()
    assert any(row["check_id"] == "index_mismatch" and "1 are lost" in row["message"] for row in checks)


@pytest.mark.ci
def test_verdicts_pictures_and_the_annotated_log_are_those_of_the_bag_in_mcap(tmp_path: Path) -> None:
    rosbag2 = pytest.importorskip("rosbags.rosbag2", reason="rosbags is not installed: pip install rosbags")
    found = {}
    for name in ("SQLITE3", "MCAP"):
        path = write_bag(tmp_path / name / "bag", storage=rosbag2.StoragePlugin[name])
        out = tmp_path / f"out-{name}"
        drivelint.check(path, out=out, rules=["ukhc.no-collision", "ukhc.r126.*"], ego_size="4.5,1.8", robustness=False)
        result = load_result(out)
        rows = {table: getattr(result, table).to_pylist() for table in ("verdicts", "findings", "pictures")}
        left = {"drive_id", "finding_id", "finding_ids"}  # they contain the hash of the log
        found[name] = {t: [{k: v for k, v in row.items() if k not in left} for row in rows[t]] for t in rows}
        (annotated,) = (out / "annotated").glob("*.mcap")
        with rosbag2.Reader(path) as reader:
            recorded = sorted((c.topic, t_ns, bytes(data)) for c, t_ns, data in reader.messages())
        ours = sorted((m[0], m[3], m[6]) for m in seeking(annotated) if not m[0].startswith("/drivelint/"))
        assert ours == recorded
        verify(annotated)
    assert found["SQLITE3"] == found["MCAP"]
    assert {row["camera"] for row in found["SQLITE3"]["pictures"]} == {FRONT, LEFT}
    assert any(row["verdict"] == "fail" for row in found["SQLITE3"]["verdicts"])


@pytest.mark.ci
def test_every_message_of_a_split_bag_is_copied_in_its_order(tmp_path: Path) -> None:
    parts = [messages()[:30], messages()[30:]]
    path = sqlite_log.bag(tmp_path / "bag", parts, definitions=False)
    drivelint.check(path, out=tmp_path / "out", rules=["ukhc.no-collision"], ego_size="4.5,1.8", robustness=False)
    (annotated,) = (tmp_path / "out" / "annotated").glob("*.mcap")
    ours = [m for m in streaming(annotated, log_time_order=False) if not m[0].startswith("/drivelint/")]
    wanted = [(m[0], round(m[2] * 1e9), ros.encode(m[1], m[3])) for part in parts for m in part]
    assert [(m[0], m[3], m[6]) for m in ours] == wanted


def test_inspect_lists_the_topics(tmp_path: Path) -> None:
    path = sqlite_log.write(tmp_path / "log.db3", messages(), definitions=False)
    found = {channel.topic: channel for channel in file_content(path, None, [], has_reader=True).channels}
    assert {topic: channel.read_as for topic, channel in found.items()} == {
        "/carla/hero/odometry": "odometry", "/carla/hero/vehicle_info": "map", "/carla/objects": "road users",
    }  # fmt: skip
    assert found["/carla/objects"].messages == 40


@LAYOUTS
def test_both_layouts_of_a_shape_are_told_apart(tmp_path: Path, types: dict[str, str]) -> None:
    trace = read(sqlite_log.write(tmp_path / "log.db3", messages(), types, definitions=False))
    assert tables(trace) == tables(read(ros.write(tmp_path / "log.mcap", messages(), types)))


def pedestrians(kind: int = 4) -> list[ros.Message]:
    """Return messages of one object each, which is where both layouts of a shape may fit."""
    walker = ros.thing(12, 5.0, 5.0, classification=kind, shape={"type": 3, "dimensions": [1.8, 0.3]})
    return [ros.things(t_s, walker) for t_s in ros_drive.ticks(30)]


@LAYOUTS
@pytest.mark.parametrize("kind", [0, 4])
def test_both_layouts_of_a_shape_are_told_apart_by_messages_of_one_object(
    tmp_path: Path, types: dict[str, str], kind: int
) -> None:
    drive = [*ros_drive.ego(), *pedestrians(kind)]
    trace = read(sqlite_log.write(tmp_path / "log.db3", drive, types, definitions=False))
    assert tables(trace) == tables(read(ros.write(tmp_path / "log.mcap", drive, types)))


@LAYOUTS
def test_a_damaged_message_leaves_the_layouts_of_a_shape_told_apart(tmp_path: Path, types: dict[str, str]) -> None:
    path = sqlite_log.write(tmp_path / "log.db3", [*ros_drive.ego(), *pedestrians()], types, definitions=False)
    with closing(sqlite3.connect(path)) as file:
        ((data,),) = file.execute("SELECT data FROM messages WHERE id = 45")
        file.execute("UPDATE messages SET data = ? WHERE id = 45", (data + bytes(40),))
        file.commit()
    trace = read(path)
    assert "pedestrian" in {row["actor_class"] for row in trace.tables["actor"].to_pylist()}
    lost = [row["message"] for row in trace.tables["quality"].to_pylist() if row["check_id"] == "lost_time"]
    assert len(lost) == 1
    assert "row 45 of messages" in lost[0]


@pytest.mark.parametrize("kind", ["shape_msgs/SolidPrimitive", "derived_object_msgs/Object"])
@pytest.mark.parametrize("used", [False, True])
def test_topics_that_are_not_read_may_have_a_type_with_two_layouts(tmp_path: Path, kind: str, used: bool) -> None:
    path = sqlite_log.write(tmp_path / "log.db3", [*messages(), ("/shape", kind, 200.0, {})], definitions=False)
    with closing(sqlite3.connect(path)) as file:
        file.execute("DELETE FROM messages WHERE timestamp = 200000000000 AND NOT ?", (used,))
        file.commit()
    assert read(path).tables["actor_state"].num_rows == 120


def test_types_without_a_known_definition_are_refused_with_the_remedy(tmp_path: Path) -> None:
    old = {name.replace("autoware_", "autoware_auto_"): text for name, text in ros.BASE.items()}
    types = ros.BASE | {name: text.replace("autoware_", "autoware_auto_") for name, text in old.items()}
    tracked = [
        (topic, name.replace("autoware_", "autoware_auto_"), t_s, what)
        for topic, name, t_s, what in (ros.tracks(t_s, ros.track(3, 50.0, 9.0)) for t_s in ros_drive.ticks())
    ]
    path = sqlite_log.write(tmp_path / "log.db3", [*ros_drive.ego(), *tracked], types, definitions=False)
    with pytest.raises(TraceError) as error:
        read(path)
    assert re.search(
        "no message definition of autoware_auto_perception_msgs/msg/TrackedObjects on '/perception/objects', and none is known: "
        ".*ros2 bag convert", str(error.value),
    )  # fmt: skip
    assert "\n" not in str(error.value)
    assert read(path, topic="/carla/hero/odometry").tables["actor_state"].num_rows == 40


def test_lights_without_a_known_definition_are_reported(tmp_path: Path) -> None:
    lights = [autoware_log.lights(t_s, {7: [autoware_log.element(1)]}) for t_s in ros_drive.ticks(5)]
    path = sqlite_log.write(
        tmp_path / "log.db3", [*ros_drive.ego(), *lights], ros.BASE | autoware_log.TYPES, definitions=False
    )
    unread = [row for row in read(path).tables["quality"].to_pylist() if row["check_id"] == "unread_topic"]
    assert [row["n"] for row in unread] == [5]
    assert "no message definitions in the log" in unread[0]["message"]


@pytest.mark.parametrize("kind", [*MESSAGE_TYPES, "sensor_msgs/Image", "sensor_msgs/CompressedImage"])
def test_known_definitions_are_those_of_ros_in_every_distribution(kind: str) -> None:
    typesys = pytest.importorskip("rosbags.typesys", reason="rosbags is not installed: pip install rosbags")
    for name in ("FOXY", "GALACTIC", "HUMBLE", "IRON", "JAZZY"):
        store = typesys.get_typestore(typesys.Stores[f"ROS2_{name}"])
        full = kind.replace("/", "/msg/")
        if full in store.fielddefs:
            for text in candidate_definitions(kind):
                found = typesys.get_types_from_msg(text, full)
                assert {each: store.fielddefs[each][1] for each in found} == {each: found[each][1] for each in found}


def test_data_of_topics_that_are_not_read_are_not_loaded(tmp_path: Path) -> None:
    big = [("/lidar", "rcl_interfaces/ParameterValue", 100.0 + n, {"byte_array_value": [7] * 9000}) for n in range(20)]
    path = sqlite_log.write(tmp_path / "log.db3", [*big, *messages()], autoware_log.TYPES)
    file = SqliteFile(path)
    sizes = []
    for message in file.messages():
        if message.channel.topic == "/lidar":
            file.counts.unread_channels.add(message.channel.id)
            sizes.append(len(message.data))
    assert sizes[0] > 9000
    assert set(sizes[1:]) == {0}
    assert bags.kinds_by_topic(path)["/lidar"] == "rcl_interfaces/ParameterValue"
