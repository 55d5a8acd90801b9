"""A window of an MCAP file is read as the same span of the whole file."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any, cast

import pytest
from mcap.writer import CompressionType, Writer

from drivelint.watch.sources.mcap_file import McapSource
from drivelint.watch.sources.mcap_memory import MOST_KEPT_FIRST_MESSAGES
from tests.formats.foxglove import foxglove_log as scenes
from tests.formats.logs import at, read
from tests.formats.osi import osi_file, osi_log
from tests.formats.ros2 import autoware_log as autoware
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import T0, ego, road_users, ticks
from tests.shared_data import ROOT, shared
from tests.watch.sources.windows import assert_window_is_span, assert_windows_are_spans, drained, times

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.watch.source import Frame
    from drivelint.watch.sources.mcap_stream import MessageRecord, NumberedMessage

EDGE_NS = 60_000_000
"""A little more than a step of the small logs."""
REFERENCES = ("MovingHostWithStopLineVariations", "osi_centerline_example", "sensorDataDetectedLaneBoundaries")


@pytest.mark.parametrize("name", ["safe", "signal-late", "tunnel"])
def test_fixtures(tmp_path: Path, name: str) -> None:
    path = ROOT / "fixtures" / "scenes" / f"{name}.mcap"
    assert_windows_are_spans(McapSource(path, idle_s=0.0), tmp_path)


@pytest.mark.sample(1, ci=2)
@pytest.mark.parametrize("name", REFERENCES)
def test_reference_logs(tmp_path: Path, name: str) -> None:
    assert_windows_are_spans(McapSource(shared(f"osi/{name}.mcap"), idle_s=0.0), tmp_path)


def test_sensor_views_whose_lanes_stand_in_the_first(tmp_path: Path) -> None:
    frames = [osi_file.view(frame) for frame in osi_file.drive(30)]
    truth = frames[0].global_ground_truth
    truth.lane.add().id.value = 3
    boundary = truth.lane_boundary.add()
    boundary.id.value = 4
    boundary.boundary_line.add().position.x = 1.0
    truth.proj_string = "+proj=utm +zone=32"
    path = tmp_path / "log.mcap"
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.LZ4, chunk_size=1000)
        writer.start()
        from drivelint.formats.osi.schema import SENSOR_VIEW, descriptor_set

        schema = writer.register_schema(SENSOR_VIEW, "protobuf", descriptor_set("read"))
        channel = writer.register_channel("view", "protobuf", schema)
        for k, frame in enumerate(frames):
            writer.add_message(channel, k * 50_000_000, frame.SerializeToString(), k * 50_000_000)
        writer.finish()  # type: ignore[no-untyped-call]
    assert_windows_are_spans(McapSource(path, idle_s=0.0), tmp_path)
    assert read(path).embedded_map is not None
    assert read(path).geo_reference == "+proj=utm +zone=32"


def scene_messages() -> list[scenes.Message]:
    """A car that drives, one that is parked and said once, one that is deleted, one that comes again elsewhere, one with a short life."""
    found = [
        scenes.transform(0.0, "map", "base", 100.0, 50.0, yaw=0.5),
        scenes.scene(
            0.0, scenes.entity("parked", 0.0, 30.0), scenes.entity("gone", 0.0, 35.0), scenes.entity("again", 0.0, 5.0)
        ),
        scenes.scene(0.05, scenes.entity("short", 0.05, 70.0, life=0.5)),
    ]
    for k in range(2, 80):
        t_s = k * 0.05
        things = [scenes.entity("ego", t_s, 10.0 * t_s, frame="base")]
        things += [scenes.entity("again", t_s, 9.0)] if k == 20 else []
        gone = (scenes.deletion(t_s, "gone"),) if k == 10 else (scenes.deletion(t_s, "again"),) if k == 12 else ()
        found.append(scenes.scene(t_s, *things, deletions=gone))
    return found


@pytest.mark.parametrize("encoding", ["protobuf", "json"])
def test_scene(tmp_path: Path, encoding: str) -> None:
    path = scenes.write(tmp_path / "log.mcap", scene_messages(), encoding)
    source = McapSource(path, idle_s=0.0)
    frames = drained(source)
    for start in (5, 8, 25, 50):
        window = assert_window_is_span(source, frames, tmp_path, slice(start, start + 20), EDGE_NS, ego="ego")
        assert at(window, "parked", frames[start].t_ns / 1e9)["x_m"] == 30.0


def test_scene_that_deletes_all(tmp_path: Path) -> None:
    messages = scene_messages()
    messages.insert(40, scenes.scene(1.9, deletions=(scenes.deletion(1.9),)))
    source = McapSource(scenes.write(tmp_path / "log.mcap", messages), idle_s=0.0)
    frames = drained(source)
    window = assert_window_is_span(source, frames, tmp_path, slice(50, 70), EDGE_NS, ego="ego")
    there = [row["actor_id"] for row in window.tables["actor_state"].to_pylist() if row["t_ns"] >= frames[50].t_ns]
    assert set(there) == {"ego"}


def transforms() -> list[ros.Message]:
    """The map's frame moves, and that of the sensor never does, which is said once."""
    found = [ros.transform(T0, "base_link", "sensor", 1.5, 0.0, yaw=0.1, topic="/tf_static")]
    found += [
        ros.transform(t_s, "map", "odom", math.sin(t_s), 3.0, yaw=0.01 * (t_s - T0)) for t_s in ticks(n=80, dt=0.025)
    ]
    return found


def ros_messages() -> list[ros.Message]:
    world: tuple[str, str, float, dict[str, Any]]
    world = ("/carla/world_info", "carla_msgs/CarlaWorldInfo", T0, {"map_name": "Town01", "opendrive": "<OpenDRIVE/>"})
    lights = [ros.report("TurnIndicatorsReport", t_s + 0.01, report=2) for t_s in ticks(n=20, dt=0.1)]
    modes = [ros.report("ControlModeReport", T0 + t_s, mode=mode) for t_s, mode in ((0.1, 4), (0.2, 1))]
    messages = [world, *transforms(), *road_users(), *ego(frame="odom", child="base_link"), *lights, *modes]
    return sorted(messages, key=lambda message: message[2])


def test_ros(tmp_path: Path) -> None:
    source = McapSource(ros.write(tmp_path / "log.mcap", ros_messages()), idle_s=0.0)
    frames = drained(source)
    whole = read(source.recording)
    assert whole.embedded_map is not None
    third = len(frames) // 3
    for start in (0, third, 2 * third - 10):
        window = assert_window_is_span(source, frames, tmp_path, slice(start, start + third), EDGE_NS)
        events = window.tables["declared_event"].to_pylist()
        assert [(row["t_ns"], row["value"]) for row in events][-1:] == [(round((T0 + 0.2) * 1e9), "on")]


def test_a_report_that_was_sent_often_is_carried_in_part(tmp_path: Path) -> None:
    """The first ones and the last ones: what was reported last holds, though the window has no report."""
    messages = [
        *ego(n=600, dt=0.01),
        *(ros.report("Engage", t_s, engage=k > 300) for k, t_s in enumerate(ticks(450, 0.01))),
    ]
    source = McapSource(ros.write(tmp_path / "log.mcap", sorted(messages, key=lambda m: m[2])), idle_s=0.0)
    frames = drained(source)
    path = tmp_path / "window.mcap"
    source.write_window(frames[-100:], path)
    carried = drained(McapSource(path, idle_s=0.0))
    assert len(carried) < 100 + 200 + 210
    assert [row["value"] for row in read(path).tables["declared_event"].to_pylist()][-1] == "on"


def test_autoware(tmp_path: Path) -> None:
    """The parameters of the vehicle were sent once, after many others; a light that was seen early is not carried on."""
    others = [autoware.parameters(T0, f"/node_{k}", rate=10.0 + k)[0] for k in range(MOST_KEPT_FIRST_MESSAGES + 50)]
    found = [
        *others,
        *autoware.parameters(T0 + 0.01, **autoware.PARAMETERS),
        *autoware.parameters(T0 + 2.6, "/node_0", rate=1.0),
    ]
    found += ego(n=80, child="base_link")
    for k, t_s in enumerate(ticks(80)):
        shown = {7: [autoware.element(autoware.RED if k < 60 else autoware.GREEN)]} | (
            {8: [autoware.element(1)]} if k < 3 else {}
        )
        found += [
            autoware.predictions(t_s, autoware.prediction(2, 20.0 + 10.0 * (t_s - T0), 5.0, 0.0, 10.0)),
            autoware.lights(t_s, shown),
        ]
    path = autoware.write(tmp_path / "log.mcap", sorted(found, key=lambda message: message[2]))
    source = McapSource(path, idle_s=0.0)
    frames = drained(source)
    for start in (0, 100, 180):
        begin = len(frames) - 3 * 80 + start
        window = assert_window_is_span(source, frames, tmp_path, slice(begin, begin + 60), EDGE_NS)
        sizes = {row["actor_id"]: row["length_m"] for row in window.tables["actor"].to_pylist()}
        assert sizes["ego"] == pytest.approx(4.89)
    late = [row for row in window.tables["signal_state"].to_pylist() if row["state"] is not None]
    assert {row["signal_id"] for row in late} == {"7"}


def messages(frames: list[Frame]) -> list[MessageRecord]:
    return [cast("NumberedMessage", frame.data).message for frame in frames]


def test_log_times_and_bytes_are_those_of_the_recording(tmp_path: Path) -> None:
    source = McapSource(ROOT / "fixtures" / "scenes" / "safe.mcap", idle_s=0.0)
    frames = drained(source)
    source.write_window(frames[40:80], tmp_path / "window.mcap")
    again = drained(McapSource(tmp_path / "window.mcap", idle_s=0.0))
    assert messages(again) == messages(frames[40:80])
    assert times(again) == times(frames[40:80])


def test_what_nobody_reads_is_no_frame(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    frames = osi_log.truths(osi_log.drive(5))
    osi_log.write(path, frames)
    with (tmp_path / "camera.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema(
            "foxglove.CompressedImage", "jsonschema", json.dumps({"type": "object"}).encode()
        )
        channel = writer.register_channel("/camera", "json", schema)
        writer.add_message(channel, 1, b"{}", 1)
        writer.finish()  # type: ignore[no-untyped-call]
    assert drained(McapSource(tmp_path / "camera.mcap", idle_s=0.0)) == []
    assert len(drained(McapSource(path, idle_s=0.0))) == 5
