"""Foxglove scenes: who is there when, where, and how big; in protobuf and in JSON alike."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from drivelint.engine.batch import Drive
from drivelint.errors import TraceError
from tests.formats.foxglove import foxglove_log as fox
from tests.formats.logs import actors, at, log, quality, read, states
from tests.formats.osi import osi_log
from tests.scenes import verdict_rows

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

BOTH_ENCODINGS = pytest.mark.parametrize("encoding", ["protobuf", "json"])
T0 = 1000.0


def trace_of(path: Path, messages: list[fox.Message], encoding: str = "protobuf", **options: Any) -> Trace:
    return read(fox.write(path / "scene.mcap", messages, encoding), **{"need_ego": False, **options})


def times(trace: Trace, actor: str) -> list[float]:
    return [round(row["t_ns"] / 1e9 - T0, 3) for row in states(trace, actor)]


def drive(n: int = 20, **fields: Any) -> list[fox.Message]:
    return [
        fox.scene(T0 + i / 10, fox.entity("car", T0 + i / 10, i * 1.0, 2.0, yaw=0.0, life=0.15, **fields))
        for i in range(n)
    ]


@BOTH_ENCODINGS
def test_boxes(tmp_path: Path, encoding: str) -> None:
    messages = drive(metadata=[{"key": "colour", "value": "car"}, {"key": "Type", "value": "vehicle.truck"}])
    trace = trace_of(tmp_path, messages, encoding, ego="car")
    car = actors(trace)["car"]
    assert (car["actor_class"], car["length_m"], car["width_m"], car["height_m"]) == ("truck", 4.5, 1.8, 1.5)
    state = at(trace, "car", T0 + 0.5)
    assert (state["x_m"], state["y_m"], state["z_m"], state["yaw_rad"]) == (5.0, 2.0, 0.75, 0.0)
    assert state["vx_mps"] == pytest.approx(10.0)
    assert log(trace)["format"] == "foxglove-mcap"
    assert "no velocity in the log" in quality(trace)["velocity_derived"]["message"]


@BOTH_ENCODINGS
def test_no_ego(tmp_path: Path, encoding: str) -> None:
    with pytest.raises(TraceError, match="use --ego ID"):
        trace_of(tmp_path, drive(), encoding, need_ego=True)


@BOTH_ENCODINGS
def test_expired_is_gone(tmp_path: Path, encoding: str) -> None:
    """An entity that stands still is there until its lifetime is over, and not at that moment."""
    messages = [*drive(), fox.scene(T0 + 0.15, fox.entity("parked", T0 + 0.15, 5.0, 9.0, life=0.45))]
    trace = trace_of(tmp_path, messages, encoding)
    assert times(trace, "parked") == [0.15, 0.2, 0.3, 0.4, 0.5]
    assert {row["x_m"] for row in states(trace, "parked")} == {5.0}
    assert times(trace, "car")[-1] == 1.9


@BOTH_ENCODINGS
@pytest.mark.parametrize("name", ["parked", None])
def test_deleted_is_gone(tmp_path: Path, encoding: str, name: str | None) -> None:
    """For ever means until a later deletion: of itself or of all; one of an earlier time, or of another, does not count."""
    messages = drive()
    messages.append(fox.scene(T0 + 0.15, fox.entity("parked", T0 + 0.15, 5.0, 9.0)))
    messages.append(
        fox.scene(
            T0 + 0.2, deletions=(fox.deletion(T0 + 0.15, name), fox.deletion(T0 + 0.1), fox.deletion(T0 + 0.2, "x"))
        )
    )
    messages.append(fox.scene(T0 + 0.45, deletions=(fox.deletion(T0 + 0.45, name),)))
    trace = trace_of(tmp_path, messages, encoding)
    assert times(trace, "parked") == [0.15, 0.2, 0.3, 0.4]
    assert quality(trace)["entity_held"]["n"] == 3


def test_deleted_and_added_again(tmp_path: Path) -> None:
    """A writer that deletes all and adds who is there, in one message: who is not added again is gone."""
    messages = []
    for i in range(8):
        t_s = T0 + i / 10
        there = [fox.entity("a", t_s, 1.0 * i)] + ([fox.entity("b", t_s, 0.0, 5.0)] if i < 4 else [])
        messages.append(fox.scene(t_s, *there, deletions=(fox.deletion(t_s),)))
    trace = trace_of(tmp_path, messages)
    assert times(trace, "a") == [i / 10 for i in range(8)]
    assert times(trace, "b") == [0.0, 0.1, 0.2, 0.3]
    assert "entity_held" not in quality(trace)


def test_moved_and_no_longer_updated(tmp_path: Path) -> None:
    """Nobody deleted it: it is there, and nobody knows where."""
    messages = drive(20)
    messages += [fox.scene(T0 + i / 10, fox.entity("ghost", T0 + i / 10, i * 1.0, 9.0)) for i in range(5)]
    trace = trace_of(tmp_path, messages)
    rows = states(trace, "ghost")
    assert [row["x_m"] for row in rows[:5]] == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert times(trace, "ghost")[5:] == [1.0 + i / 10 for i in range(10)]
    assert {row["x_m"] for row in rows[5:]} == {None}
    found = quality(trace)["entity_stale"]
    assert (found["n"], found["t_first_ns"]) == (10, round((T0 + 1.0) * 1e9))


@BOTH_ENCODINGS
def test_frames(tmp_path: Path, encoding: str) -> None:
    """A chain of a transform that is said once and one that moves; the order of messages does not matter."""
    messages = [fox.transform(T0, "map", "odom", 100.0, 50.0, yaw=math.pi / 2)]
    messages += [fox.transform(T0 + i / 10, "odom", "base", i * 1.0) for i in range(21)]
    messages += [
        fox.scene(T0 + 0.05 + i / 10, fox.entity("a", T0 + 0.05 + i / 10, 10.0, life=0.1, frame="base"))
        for i in range(20)
    ]
    trace = trace_of(tmp_path, messages, encoding)
    state = at(trace, "a", T0 + 0.55)
    assert state["x_m"] == pytest.approx(100.0)
    assert state["y_m"] == pytest.approx(50.0 + 10.0 + 5.5)
    assert state["yaw_rad"] == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(("locked", "x"), [(False, 10.0), (True, 15.0)])
def test_held_goes_with_its_frame_where_it_is_locked(tmp_path: Path, locked: bool, x: float) -> None:
    messages = [fox.transform(T0 + i / 10, "map", "base", i * 1.0) for i in range(21)]
    messages += [fox.scene(T0, fox.entity("a", T0, 10.0, frame="base", frame_locked=locked))]
    messages += drive(11)
    assert at(trace_of(tmp_path, messages), "a", T0 + 0.5)["x_m"] == pytest.approx(x)


def test_unresolved_frame(tmp_path: Path) -> None:
    messages = [*drive(), fox.scene(T0 + 1.0, fox.entity("lost", T0 + 1.0, 1.0, frame="lidar", life=0.05))]
    trace = trace_of(tmp_path, messages)
    assert states(trace, "lost")[0]["x_m"] is None
    found = quality(trace)["frame_unresolved"]
    assert (found["n"], found["t_first_ns"], found["severity"]) == (1, round((T0 + 1.0) * 1e9), "error")
    assert "no transform leads from 'lidar' to 'map'" in found["message"]


def test_float_seconds(tmp_path: Path) -> None:
    """JSON writers that have time as a number with a fraction."""
    messages = drive()
    for i, message in enumerate(messages):
        message[3]["entities"][0]["timestamp"] = (
            {"sec": T0 + i * 0.5, "nsec": 0} if i % 2 else {"sec": int(T0 + i * 0.5), "nsec": 0.0}
        )
    trace = trace_of(tmp_path, messages, "json")
    assert times(trace, "car") == [i * 0.5 for i in range(20)]


def test_json_on_several_lines(tmp_path: Path) -> None:
    path = fox.write(tmp_path / "lines.mcap", drive(), "json", indent=1)
    assert len(states(read(path, ego="car"))) == 20


def test_truth_counts_before_scenes(tmp_path: Path) -> None:
    """A log of OSI to which somebody has added a scene is still a log of OSI, with an index and without."""
    for index in (True, False):
        path = osi_log.write(tmp_path / "osi.mcap", osi_log.truths(osi_log.drive(5)))
        with path.open("rb") as file:
            packets = list(make_reader(file).iter_messages())
        with path.open("wb") as file:
            writer = Writer(file, use_summary_offsets=index, repeat_schemas=index, repeat_channels=index)
            writer.start()
            own = writer.register_schema("foxglove.SceneUpdate", "jsonschema", b"{}")
            scene = writer.register_channel("/scene", "json", own)
            writer.add_message(scene, 0, b"{}", 0)
            schema, channel, _ = packets[0]
            assert schema is not None
            truth = writer.register_channel(
                channel.topic, "protobuf", writer.register_schema(schema.name, "protobuf", schema.data)
            )
            for _, _, message in packets:
                writer.add_message(truth, message.log_time, message.data, message.publish_time)
            writer.finish()  # type: ignore[no-untyped-call]
        assert log(read(path))["format"] == "osi-mcap"


def test_no_times(tmp_path: Path) -> None:
    messages = drive()
    for message in messages:
        del message[3]["entities"][0]["timestamp"]
    trace = trace_of(tmp_path, messages)
    assert times(trace, "car") == [i / 10 for i in range(20)]
    assert "log times of the container are used" in quality(trace)["log_time_used"]["message"]


def test_two_scenes(tmp_path: Path) -> None:
    """Two topics may use one id for two things."""
    other = [(("/lanes", *message[1:])) for message in drive()]
    with pytest.raises(TraceError, match=r"on 2 topics \(/lanes, /scene\): choose one with --topic"):
        trace_of(tmp_path, [*drive(), *other])
    assert len(states(trace_of(tmp_path, [*drive(), *other], topic="/lanes"))) == 20
    with pytest.raises(TraceError, match="no scene on topic '/x'"):
        trace_of(tmp_path, drive(), topic="/x")


def test_no_box_no_id(tmp_path: Path) -> None:
    messages = drive()
    messages.append(fox.scene(T0 + 2.0, fox.entity("line", T0 + 2.0, 0.0, cubes=[]), fox.entity("", T0 + 2.0, 0.0)))
    trace = trace_of(tmp_path, messages)
    assert set(actors(trace)) == {"car"}
    assert quality(trace)["no_box"]["n"] == 1
    assert quality(trace)["dropped_row"]["severity"] == "error"
    with pytest.raises(TraceError, match="no entity on '/scene' has a cube and an id"):
        trace_of(tmp_path, [fox.scene(T0, fox.entity("line", T0, 0.0, cubes=[]))])


def walker(t_s: float, word: str = "pedestrian", **bodies: Any) -> dict[str, Any]:
    """Return an entity with these bodies and no cube, 18 m ahead of where the car starts."""
    said = [{"key": "class", "value": word}] if word else []
    return {**fox.entity("walker", t_s, 0.0), "cubes": [], "metadata": said, **bodies}


POSE = {"position": {"x": 18.0, "y": 2.0, "z": 0.9}, "orientation": {"w": 1.0}}
CYLINDER = {
    "cylinders": [{"pose": POSE, "size": {"x": 0.6, "y": 0.7, "z": 1.8}, "bottom_scale": 1.0, "top_scale": 1.0}]
}
SPHERE = {"spheres": [{"pose": POSE, "size": {"x": 0.6, "y": 0.7, "z": 1.8}}]}
MODEL = {"models": [{"pose": POSE, "scale": {"x": 1.0, "y": 1.0, "z": 1.0}, "url": "package://walker.dae"}]}


def with_walker(word: str = "pedestrian", **bodies: Any) -> list[fox.Message]:
    own = [{"key": "class", "value": "car"}]
    return [
        fox.scene(t_s, fox.entity("car", t_s, i * 1.0, 2.0, metadata=own), walker(t_s, word, **bodies))
        for i, t_s in ((i, T0 + i / 10) for i in range(30))
    ]


@BOTH_ENCODINGS
@pytest.mark.parametrize(
    ("bodies", "size", "verdict"),
    [
        (CYLINDER, (0.6, 0.7, 1.8), "fail"),
        (SPHERE, (0.6, 0.7, 1.8), "fail"),
        (MODEL, (None, None, None), "unknown"),
        (MODEL | CYLINDER, (0.6, 0.7, 1.8), "fail"),
    ],
)
def test_a_road_user_without_a_cube_is_one_all_the_same(
    tmp_path: Path, encoding: str, bodies: dict[str, Any], size: tuple[float | None, ...], verdict: str
) -> None:
    trace = trace_of(tmp_path, with_walker(**bodies), encoding, ego="car")
    found = actors(trace)["walker"]
    assert (found["actor_class"], found["length_m"], found["width_m"], found["height_m"]) == ("pedestrian", *size)
    assert (at(trace, "walker", T0 + 0.5)["x_m"], at(trace, "walker", T0 + 0.5)["y_m"]) == (18.0, 2.0)
    assert "no_box" not in quality(trace)
    (result,) = verdict_rows([Drive(trace, None)], rules=["ukhc.no-collision"])
    assert result["verdict"] == verdict


@pytest.mark.parametrize(
    ("word", "bodies"), [("", CYLINDER), ("lane", CYLINDER), ("pedestrian", {}), ("pedestrian", {"models": []})]
)
def test_what_has_no_class_or_no_body_is_no_road_user(tmp_path: Path, word: str, bodies: dict[str, Any]) -> None:
    trace = trace_of(tmp_path, with_walker(word, **bodies), ego="car")
    assert set(actors(trace)) == {"car"}
    assert quality(trace)["no_box"]["n"] == 30


def test_damaged_message(tmp_path: Path) -> None:
    messages = drive()
    messages[7][3]["entities"][0]["cubes"] = "none"
    found = quality(trace_of(tmp_path, messages, "json"))["lost_time"]
    assert "topic '/scene', log time 1000700000000 ns" in found["message"]


@BOTH_ENCODINGS
def test_order_of_messages_changes_nothing(tmp_path: Path, encoding: str) -> None:
    messages = [
        *drive(),
        *[fox.scene(T0 + i / 5, fox.entity("slow", T0 + i / 5, float(i // 3), 9.0)) for i in range(8)],
    ]
    one, other = trace_of(tmp_path, messages, encoding), trace_of(tmp_path, messages[::-1], encoding)
    drop = ["drive_id"]
    assert one.tables["actor_state"].drop_columns(drop).equals(other.tables["actor_state"].drop_columns(drop))
