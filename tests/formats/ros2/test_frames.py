"""Where and when: transforms, clocks, bags in parts, damaged and odd ROS 2 logs."""

from __future__ import annotations

import math
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from rosbags import rosbag1, rosbag2
from rosbags.typesys import Stores, get_typestore

from drivelint.errors import TraceError
from drivelint.formats import expand_traces
from drivelint.formats.mcap.bag import bag_files
from drivelint.inspect.content import file_content, size_bytes
from tests.formats.logs import at, log, quality, read, states
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import T0, TURN, N, along, ego, road_users, ticks, trace_of

if TYPE_CHECKING:
    from drivelint.drive.trace import Trace


def chain() -> list[ros.Message]:
    """Return lidar in base (fixed), base in odom (moves east), odom in map (turned left, 100, 50)."""
    return [
        ros.transform(T0 - 50.0, "base", "/lidar", 2.0, topic="/tf_static"),
        *[ros.transform(t_s - 0.01, "odom", "base", 10.0 * (t_s - 0.01 - T0)) for t_s in ticks(N + 2)],
        *[ros.transform(t_s, "map", "odom", 100.0, 50.0, yaw=math.pi / 2) for t_s in ticks(N + 2)],
    ]


def test_chain(tmp_path: Path) -> None:
    # it drives with its frame, 10 m/s to the map's north, and says so
    objects = [ros.things(t_s, ros.thing(9, 30.0, 1.0, 0.05, 10.0), frame="lidar") for t_s in ticks(19)]
    trace = trace_of(tmp_path, [*chain(), *objects], ego="9")
    state = at(trace, "9", T0 + 0.5)
    assert (state["x_m"], state["y_m"]) == pytest.approx((100.0 - 1.0, 50.0 + 5.0 + 2.0 + 30.0))
    assert state["yaw_rad"] == pytest.approx(math.pi / 2 + 0.05)
    assert (state["vx_mps"], state["vy_mps"]) == pytest.approx((-10.0 * math.sin(0.05), 10.0 * math.cos(0.05)))
    assert "frame_unresolved" not in quality(trace)


def test_odometry_in_odom(tmp_path: Path) -> None:
    trace = trace_of(tmp_path, [*chain(), *ego(frame="odom"), *road_users()])
    x, y = along(T0 + 1.0)
    state = at(trace, "ego", T0 + 1.0)
    assert (state["x_m"], state["y_m"]) == pytest.approx((100.0 - y, 50.0 + x))
    assert (state["vx_mps"], state["vy_mps"]) == pytest.approx((-10.0 * math.sin(TURN), 10.0 * math.cos(TURN)))


def test_unresolved_in_part(tmp_path: Path) -> None:
    """Some objects are in a frame of which nothing is known: they are there, and nowhere."""
    lost = [ros.things(t_s, ros.thing(12, 1.0, 2.0), frame="radar") for t_s in ticks()[10:]]
    trace = trace_of(tmp_path, [*ego(), *road_users()[:10], *lost])
    assert {row["x_m"] for row in states(trace, "12")[10:]} == {None}
    found = quality(trace)["frame_unresolved"]
    assert (found["n"], found["t_first_ns"], found["severity"]) == (N - 10, round(ticks()[10] * 1e9), "error")
    assert "no transform leads from 'radar' to 'map'" in found["message"]


def test_not_beyond_the_transforms_times_nor_in_holes(tmp_path: Path) -> None:
    """A transform from 0.5 s to 1.5 s, with a hole of 0.6 s or of 0.4 s in it."""
    objects = [ros.things(t_s, ros.thing(9, 30.0, 0.0), frame="base") for t_s in ticks()]

    def samples_with_place(a: float, b: float) -> list[int]:
        moving = [
            ros.transform(t_s, "map", "base", t_s)
            for t_s in ticks(201, 0.01)
            if 0.499 <= t_s - T0 <= a + 1e-6 or b - 1e-6 <= t_s - T0 <= 1.501
        ]
        rows = states(trace_of(tmp_path, [*ego(), *moving, *objects]), "9")
        return [i for i, row in enumerate(rows) if row["x_m"] is not None]

    assert samples_with_place(1.0, 1.0) == list(range(10, 31))
    assert samples_with_place(0.7, 1.1) == list(range(10, 31))
    assert samples_with_place(0.7, 1.3) == [*range(10, 15), *range(26, 31)]


def test_two_parents(tmp_path: Path) -> None:
    both = [ros.transform(t_s, parent, "base", 5.0) for t_s in ticks() for parent in ("map", "odom")]
    objects = [ros.things(t_s, ros.thing(9, 30.0, 0.0), frame="base") for t_s in ticks()]
    trace = trace_of(tmp_path, [*ego(), *both, *objects])
    assert {row["x_m"] for row in states(trace, "9")} == {None}
    assert "several frames have the child frame 'base'" in quality(trace)["frame_unresolved"]["message"]


def test_a_loop_of_frames_leads_nowhere(tmp_path: Path) -> None:
    loop = [ros.transform(T0, *pair, topic="/tf_static") for pair in (("a", "b"), ("b", "a"))]
    objects = [ros.things(t_s, ros.thing(9, 1.0, 0.0), frame="a") for t_s in ticks()]
    trace = trace_of(tmp_path, [*loop, *objects, *ego(frame="site")])
    assert {row["x_m"] for row in states(trace, "9")} == {None}
    assert "no transform leads from 'a' to 'site'" in quality(trace)["frame_unresolved"]["message"]


def test_nothing_placed(tmp_path: Path) -> None:
    """Odometry in a frame that only its own transforms hold, none of them at its time."""
    late = [ros.transform(T0 + 50.0, "map", "odom", 1.0)]
    with pytest.raises(TraceError, match=r"nothing can be placed: .* 'odom' to 'map' is not recorded at their time"):
        trace_of(tmp_path, [*late, *ego(frame="odom")])


@pytest.mark.parametrize("frame", ["world", "odom", "site"])
def test_fixed_frame_of_another_name(tmp_path: Path, frame: str) -> None:
    """A log whose frames have all one root has it as its fixed frame."""
    base = [ros.transform(T0, frame, "base", 5.0, topic="/tf_static")]
    trace = trace_of(
        tmp_path,
        [*ego(frame=frame), *base, *[ros.things(t_s, ros.thing(9, 30.0, 0.0), frame="base") for t_s in ticks()]],
    )
    assert states(trace, "9")[0]["x_m"] == 35.0
    assert f"positions are in the frame {frame!r}" in trace.notes


def test_no_stamps(tmp_path: Path) -> None:
    """Stamps that stand still, or that are there only in part: the container's times count, for all messages."""
    for keep in (0, 7):
        messages = [*ego(), *road_users()]
        for i, message in enumerate(messages):
            if i >= keep:
                message[3]["header"]["stamp"] = {}
        trace = trace_of(tmp_path, messages)
        assert states(trace, "ego")[1]["t_ns"] == 100_050_000_000
        assert "log times of the container" in quality(trace)["log_time_used"]["message"]


def test_simulated_time_begins_at_zero(tmp_path: Path) -> None:
    messages = [ros.odometry(i * 0.05, i * 0.5, 0.0, 0.0, 10.0, log_s=1.7e9 + i) for i in range(N)]
    trace = trace_of(tmp_path, messages)
    assert [row["t_ns"] for row in states(trace)][:2] == [0, 50_000_000]
    assert log(trace)["utc_start_ns"] == 1_700_000_000 * 10**9


def test_two_clocks(tmp_path: Path) -> None:
    """Objects by the simulation's clock, the ego by the wall's: only the container has one for both."""
    objects = [
        (topic, name, t_s, {**content, "header": ros.header(t_s - 90.0)}) for topic, name, t_s, content in road_users()
    ]
    trace = trace_of(tmp_path, [*ego(), *objects])
    assert states(trace, "9")[0]["t_ns"] == 100_000_000_000
    assert "do not overlap: they come from two clocks" in quality(trace)["log_time_used"]["message"]


def test_float_stamps(tmp_path: Path) -> None:
    """A recorder of its own kind, with seconds as a double."""
    types = {**ros.BASE, "std_msgs/Header": "float64 stamp\nstring frame_id"}
    messages = [
        (topic, name, 5.0 + i, {**content, "header": {"stamp": t_s, "frame_id": "map"}})
        for i, (topic, name, t_s, content) in enumerate(ego())
    ]
    trace = read(ros.write(tmp_path / "float.mcap", messages, types))
    assert [row["t_ns"] for row in states(trace)][:2] == [100_000_000_000, 100_050_000_000]


def bag(folder: Path, names: list[str], storage: str = "mcap") -> Path:
    listed = "".join(f"    - {name}\n" for name in names)
    text = (
        f"rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: {storage}\n  relative_file_paths:\n{listed}"
    )
    (folder / "metadata.yaml").write_text(text, encoding="utf-8")
    return folder


def parts(tmp_path: Path, n: int = 3) -> tuple[Path, list[ros.Message]]:
    messages = sorted([*chain(), *ego(), *road_users()], key=lambda message: message[2])
    folder = tmp_path / "drive"
    folder.mkdir()
    step = -(-len(messages) // n)
    for i in range(n):
        ros.write(folder / f"drive_{i}.mcap", messages[i * step : (i + 1) * step])
    return bag(folder, [f"drive_{i}.mcap" for i in range(n)]), messages


def rows(trace: Trace) -> list[dict[str, object]]:
    return [{key: value for key, value in row.items() if key != "drive_id"} for row in states(trace)]


def test_bag_in_parts(tmp_path: Path) -> None:
    folder, messages = parts(tmp_path)
    assert expand_traces([str(folder)]) == expand_traces([str(tmp_path)]) == [folder]
    trace = read(folder)
    assert trace.drive_id.startswith("drive-")
    assert rows(trace) == rows(trace_of(tmp_path, messages))
    before = trace.drive_id
    shutil.copy(folder / "drive_0.mcap", folder / "drive_2.mcap")
    assert read(folder).drive_id != before


def test_types_are_numbered_anew_in_each_part(tmp_path: Path) -> None:
    """The decoders of mcap 1.6.0 take the first file's types for those of the next (findings/mcap-decoder-of-another-file.sh)."""
    folder, messages = parts(tmp_path, 2)
    ros.write(folder / "drive_1.mcap", sorted(messages[-(-len(messages) // 2) :], key=lambda message: message[1]))
    first = set()
    for file in folder.glob("*.mcap"):
        with file.open("rb") as stream:
            summary = make_reader(stream).get_summary()
            assert summary is not None
            first.add(summary.schemas[1].name)
    assert len(first) == 2
    assert rows(read(folder)) == rows(trace_of(tmp_path, messages))


def test_what_a_bag_holds(tmp_path: Path) -> None:
    folder, messages = parts(tmp_path)
    assert size_bytes(folder) == sum(file.stat().st_size for file in folder.glob("*.mcap"))
    found = {channel.topic: channel for channel in file_content(folder, None, [], has_reader=True).channels}
    assert {topic: channel.read_as for topic, channel in found.items()} == {
        "/carla/hero/odometry": "odometry", "/carla/objects": "road users", "/tf": "frames", "/tf_static": "frames",
    }  # fmt: skip
    assert sum(channel.messages for channel in found.values()) == len(messages)
    assert found["/carla/objects"].rate_hz == pytest.approx(20.0)


def test_bag_with_a_part_missing(tmp_path: Path) -> None:
    folder, _ = parts(tmp_path)
    (folder / "drive_1.mcap").unlink()
    with pytest.raises(TraceError, match=r"drive_1\.mcap, a part of this bag, is missing"):
        read(folder)


def test_bags_that_cannot_be_read(tmp_path: Path) -> None:
    folder, _ = parts(tmp_path)
    with pytest.raises(TraceError, match=r"drive_0\.db3, a part of this bag, is missing"):
        read(bag(folder, ["drive_0.db3"], "sqlite3"))
    with pytest.raises(TraceError, match="a bag in rocks: convert it to MCAP"):
        read(bag(folder, ["drive_0.db3"], "rocks"))
    with pytest.raises(TraceError, match="lists no files"):
        read(bag(folder, []))
    (folder / "metadata.yaml").write_text("rosbag2_bagfile_information: 5\n", encoding="utf-8")
    with pytest.raises(TraceError, match=r"its metadata\.yaml cannot be read"):
        read(folder)


def compressed_bag(folder: Path, mode: rosbag2.CompressionMode) -> Path:
    """Return the folder of a compressed bag with one odometry message."""
    store, odometry = get_typestore(Stores.ROS2_HUMBLE), "nav_msgs/msg/Odometry"
    writer = rosbag2.Writer(folder, version=9, storage_plugin=rosbag2.StoragePlugin.MCAP)
    writer.set_compression(mode, rosbag2.CompressionFormat.ZSTD)
    with writer:
        writer.write(writer.add_connection("/odometry", odometry, typestore=store), 10, b"\0\1\0\0" + bytes(700))
    return folder


def test_a_bag_of_compressed_files_is_read_when_they_are_unpacked(tmp_path: Path) -> None:
    folder = compressed_bag(tmp_path / "my bag", rosbag2.CompressionMode.FILE)
    (packed,) = folder.glob("*.zstd")
    with pytest.raises(TraceError, match="a bag whose files are compressed: unpack them in its folder with ") as error:
        read(folder)
    assert shlex.split(str(error.value).split(" with ")[-1]) == ["zstd", "-d", str(packed)]
    with packed.open("rb") as source, packed.with_suffix("").open("wb") as target:
        zstandard.ZstdDecompressor().copy_stream(source, target)
    assert [file.name for file in bag_files(folder)] == ["my bag.mcap"]


@pytest.mark.ci
def test_a_bag_of_compressed_messages_and_a_bag_of_ros_1_name_the_command_that_converts_them(tmp_path: Path) -> None:
    folder = compressed_bag(tmp_path / "bag", rosbag2.CompressionMode.MESSAGE)
    old = tmp_path / "old.bag"
    with rosbag1.Writer(old) as writer:
        writer.add_connection("/odometry", "nav_msgs/msg/Odometry", typestore=get_typestore(Stores.ROS1_NOETIC))
    for path, why in ((folder, "a bag whose messages are each compressed"), (old, "a ROS 1 bag")):
        with pytest.raises(TraceError, match=f"{why}: convert it with rosbags-convert ") as error:
            read(path)
        command = shlex.split(re.search(r"rosbags-convert.*-dst-storage mcap", str(error.value))[0])  # type: ignore[index]
        subprocess.run([Path(sys.executable).with_name(command[0]), *command[1:]], check=True)
        assert bag_files(Path(command[command.index("--dst") + 1]))


def test_the_description_of_a_bag_is_not_a_log(tmp_path: Path) -> None:
    folder, _ = parts(tmp_path)
    with pytest.raises(TraceError, match=f"describes a bag: give the bag's folder, {re.escape(str(folder))}"):
        read(folder / "metadata.yaml")


@pytest.mark.parametrize("order", ["<", ">"])
def test_byte_orders(tmp_path: Path, order: str) -> None:
    messages = [*ego(), *road_users(), *chain()]
    assert rows(read(ros.write(tmp_path / "x.mcap", messages, order=order))) == rows(trace_of(tmp_path, messages))


@settings(max_examples=15, deadline=None)
@given(st.randoms(use_true_random=False))
def test_order_of_messages_and_objects_changes_nothing(
    tmp_path_factory: pytest.TempPathFactory, random: object
) -> None:
    folder = tmp_path_factory.mktemp("order")
    messages = [*ego(), *road_users(), *chain()]
    expected = rows(trace_of(folder, messages))
    for message in messages:
        random.shuffle(message[3].get("objects", []))  # type: ignore[attr-defined]
    random.shuffle(messages)  # type: ignore[attr-defined]
    assert rows(trace_of(folder, messages)) == expected


def test_nothing_to_read(tmp_path: Path) -> None:
    said = (
        "no nav_msgs/Odometry and no road users: the log has tf2_msgs/TFMessage on /tf, .* on /tf_static; "
        "drivelint docs mapping shows how messages of other types become a table"
    )
    with pytest.raises(TraceError, match=said):
        trace_of(tmp_path, chain())
    folder = tmp_path / "bag"
    folder.mkdir()
    ros.write(folder / "drive.mcap", chain())
    with pytest.raises(TraceError, match=said):
        read(bag(folder, ["drive.mcap"]))
    with pytest.raises(TraceError, match="no road users and no odometry"):
        trace_of(tmp_path, [ros.things(T0)])


def test_definition_in_idl(tmp_path: Path) -> None:
    with pytest.raises(
        TraceError, match=r"nav_msgs/msg/Odometry has a definition of the kind ros2idl, but only ros2msg is supported"
    ):
        read(ros.write(tmp_path / "idl.mcap", ego(), encoding="ros2idl"))
