"""Autoware's predicted and detected objects: states, shapes, classes, and which topic counts where one perception has several."""

from __future__ import annotations

import math
import uuid
from typing import TYPE_CHECKING, Any

import pytest
from mcap.reader import make_reader

from drivelint.errors import TraceError
from tests.formats.logs import actors, at, classes, quality, read, size, states
from tests.formats.ros2 import autoware_log as autoware
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import T0, TURN, N, along, ego, ticks

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

CAR_1 = "00010203-0405-0607-0809-0a0b0c0d0e01"
CAR_2 = "00010203-0405-0607-0809-0a0b0c0d0e02"
TRACKING = "/perception/object_recognition/tracking/objects"
BOX = {"type": 0, "dimensions": ros.xyz(4.5, 1.8, 1.5)}


def trace_of(
    folder: Path, messages: list[ros.Message], types: dict[str, str] = autoware.TYPES, **options: Any
) -> Trace:
    return read(autoware.write(folder / "log.mcap", messages, types), **options)


def predictions(speed: float = 10.0, **options: Any) -> list[ros.Message]:
    """Return a car that stands and one that drives on from 20, 20 with the heading `TURN`."""
    return [
        autoware.predictions(
            t_s,
            autoware.prediction(1, 60.0, 0.0),
            autoware.prediction(2, 20.0 + along(t_s)[0], 20.0 + along(t_s)[1], TURN, speed, **options),
        )
        for t_s in ticks()
    ]


def tracks(topic: str = TRACKING, name: int = 2, **options: Any) -> list[ros.Message]:
    """Return the car that drives as a track."""
    found = []
    for t_s in ticks():
        _, kind, _, content = ros.tracks(
            t_s, ros.track(name, 20.0 + along(t_s)[0], 20.0 + along(t_s)[1], TURN, 10.0, **options)
        )
        found.append((topic, kind, t_s, content))
    return found


def detections() -> list[ros.Message]:
    return [autoware.detections(t_s, ros.track(9, 30.0, 2.0), frame="map") for t_s in ticks()]


def test_predictions(tmp_path: Path) -> None:
    """Twist is along the body's own axes; the ways it may go are no states."""
    trace = trace_of(tmp_path, [*ego(), *predictions()])
    assert set(actors(trace)) == {CAR_1, CAR_2, "ego"}
    assert (classes(trace)[CAR_2], size(trace, CAR_2)) == ("car", (4.5, 1.8, 1.5))
    assert [row["x_m"] for row in states(trace, CAR_1)] == [60.0] * N
    state = at(trace, CAR_2, T0 + 1.0)
    assert (state["x_m"], state["y_m"]) == pytest.approx((25.0, 20.0 + 10.0 * math.sin(TURN)))
    assert (state["vx_mps"], state["vy_mps"]) == pytest.approx((5.0, 10.0 * math.sin(TURN)))
    assert state["yaw_rad"] == pytest.approx(TURN)
    assert {"twist_frame", "velocity_derived", "no_road_users"}.isdisjoint(quality(trace))


def test_messages_of_different_layouts(tmp_path: Path) -> None:
    """How many paths, classes and corners an object has moves everything behind it."""
    plain = trace_of(tmp_path, [*ego(), *predictions()])
    varied = []
    for k, (topic, kind, t_s, content) in enumerate(predictions()):
        for i, item in enumerate(content["objects"]):
            item["kinematics"]["predicted_paths"] = item["kinematics"]["predicted_paths"][:1] * ((k + i) % 4)
            item["classification"] = item["classification"] * (1 + (k * i) % 3)
        varied.append((topic, kind, t_s, {**content, "objects": content["objects"][:: 1 - 2 * (k % 2)]}))
    other = trace_of(tmp_path, [*ego(), *varied])
    for name in ("actor", "actor_state"):
        assert plain.tables[name].drop("drive_id") == other.tables[name].drop("drive_id")


@pytest.mark.parametrize(
    ("label", "word"), [(0, None), (1, "car"), (5, "motorcycle"), (7, "pedestrian"), (9, "object"), (77, None)]
)
def test_the_likeliest_class(tmp_path: Path, label: int, word: str | None) -> None:
    likely = [{"label": 2, "probability": 0.3}, {"label": label, "probability": 0.6}, {"label": 3, "probability": 0.1}]
    assert classes(trace_of(tmp_path, [*ego(), *predictions(classes=likely)]))[CAR_2] == word


def test_a_cylinder_is_as_long_as_wide(tmp_path: Path) -> None:
    """Its dimensions are diameter and height; some writers leave the second one out."""
    shape = {"type": 1, "dimensions": ros.xyz(0.6, 0.0, 1.7)}
    assert size(trace_of(tmp_path, [*ego(), *predictions(shape=shape)]), CAR_2) == (0.6, 0.6, 1.7)


def corners(*points: tuple[float, float], height: float = 2.0) -> dict[str, Any]:
    footprint = {"points": [ros.xyz(x, y) for x, y in points]}
    return {"type": 2, "footprint": footprint, "dimensions": ros.xyz(0.0, 0.0, height)}


def test_a_polygon_has_the_box_around_its_footprint(tmp_path: Path) -> None:
    """The footprint is given along the body's axes, from its pose; the box is around the footprint, not around the pose."""
    trace = trace_of(tmp_path, [*ego(), *predictions(shape=corners((-1.0, -0.5), (3.0, -0.5), (2.0, 1.5)))])
    state, (x, y) = at(trace, CAR_2, T0 + 1.0), along(T0 + 1.0)
    assert size(trace, CAR_2) == pytest.approx((4.0, 2.0, 2.0))
    ahead, left = 1.0, 0.5
    off = ahead * math.cos(TURN) - left * math.sin(TURN), ahead * math.sin(TURN) + left * math.cos(TURN)
    assert (state["x_m"], state["y_m"]) == pytest.approx((20.0 + x + off[0], 20.0 + y + off[1]))
    found = quality(trace)["polygon_box"]
    assert (found["severity"], found["n"]) == ("info", N)
    assert (actors(trace)[CAR_1]["length_m"], at(trace, CAR_1, T0)["x_m"]) == (4.5, 60.0)


@pytest.mark.parametrize("points", [(), ((1.0, 1.0),)])
def test_a_polygon_without_an_area_has_no_size(tmp_path: Path, points: tuple[tuple[float, float], ...]) -> None:
    shape = {**corners(*points), "dimensions": ros.xyz(9.0, 9.0, 2.0)}
    assert size(trace_of(tmp_path, [*ego(), *predictions(shape=shape)]), CAR_2) == (None, None, 2.0)


def test_a_polygon_of_no_orientation_stays_in_place(tmp_path: Path) -> None:
    shape = corners((0.0, 0.0), (2.0, 0.0), (2.0, 2.0))
    messages = tracks()
    for *_, content in messages:
        content["objects"][0]["shape"] = shape
        content["objects"][0]["kinematics"]["pose_with_covariance"]["pose"]["orientation"] = {}
        content["objects"][0]["kinematics"]["orientation_availability"] = 0
    state = at(trace_of(tmp_path, [*ego(), *messages]), CAR_2, T0)
    assert (state["x_m"], state["y_m"], state["yaw_rad"]) == (20.0, 20.0, None)


def test_one_body_on_several_topics_is_one_track(tmp_path: Path) -> None:
    """The prediction counts before the tracks it was made of, whose headings may be turned round; detections are nobody's."""
    messages = [*ego(), *predictions(), *tracks(facing=1), *detections()]
    trace = trace_of(tmp_path, messages)
    assert set(actors(trace)) == {CAR_1, CAR_2, "ego"}
    assert at(trace, CAR_2, T0 + 1.0)["yaw_rad"] == pytest.approx(TURN)
    assert len(states(trace, CAR_2)) == N
    (note,) = [note for note in trace.notes if "road users" in note]
    assert note == (
        f"road users: topic /perception/object_recognition/objects is read, {TRACKING} is not read: --topic chooses another topic"
    )
    chosen = trace_of(tmp_path, messages, topic=TRACKING)
    assert set(actors(chosen)) == {CAR_2, "ego"}
    assert at(chosen, CAR_2, T0 + 1.0)["yaw_rad"] is None
    assert "no_road_users" not in quality(chosen)


def test_the_usual_topic_counts_among_several(tmp_path: Path) -> None:
    near = "/perception/object_recognition/tracking/near_objects"
    both = [*ego(), *tracks(), *tracks(near, name=7)]
    assert set(actors(trace_of(tmp_path, both))) == {CAR_2, "ego"}
    two = [*ego(), *tracks("/far"), *tracks(near, name=7)]
    said = r"road users on 2 topics \(/far, /perception.*near_objects\): choose with --topic"
    with pytest.raises(TraceError, match=said):
        trace_of(tmp_path, two)
    # a prediction is of all of them
    assert set(actors(trace_of(tmp_path, [*two, *predictions()]))) == {CAR_1, CAR_2, "ego"}


def test_two_kinds_of_perception_are_not_told_apart(tmp_path: Path) -> None:
    simulated = [ros.things(t_s, ros.thing(5, 9.0, 9.0)) for t_s in ticks()]
    with pytest.raises(TraceError, match="road users on 2 topics"):
        trace_of(tmp_path, [*ego(), *predictions(), *simulated])


def test_detections_alone_are_nobody(tmp_path: Path) -> None:
    """They have no ids: that somebody was there is known, not who, so rules about others are unknown."""
    trace = trace_of(tmp_path, [*ego(), *detections()])
    assert set(actors(trace)) == {"ego"}
    found = quality(trace)["no_road_users"]
    assert (found["severity"], found["n"]) == ("warning", N)
    assert "/perception/object_recognition/detection/objects, are detections without ids" in found["message"]
    topic = "/perception/object_recognition/detection/objects"
    with pytest.raises(TraceError, match=f"the detections on topic '{topic}' have no ids"):
        trace_of(tmp_path, [*ego(), *detections()], topic=topic)
    with pytest.raises(TraceError, match="no road users and no odometry in this ROS log"):
        trace_of(tmp_path, detections())


def test_older_names(tmp_path: Path) -> None:
    """Bags of autoware_auto_perception_msgs, where the definitions are recorded as text."""
    new = trace_of(tmp_path, [*ego(), *predictions()])
    old_name = "autoware_auto_perception_msgs"
    types = {key.replace("autoware_perception_msgs", old_name): text for key, text in autoware.TYPES.items()}
    types = {key: text.replace("autoware_perception_msgs", old_name) for key, text in types.items()}
    messages = [
        (topic, kind.replace("autoware_perception_msgs", old_name), *rest) for topic, kind, *rest in predictions()
    ]
    old = trace_of(tmp_path, [*ego(), *messages], types)  # type: ignore[list-item]
    assert old.tables["actor_state"].drop("drive_id") == new.tables["actor_state"].drop("drive_id")


def round_drive() -> list[ros.Message]:
    """Return twenty seconds in which everybody drives in circles, the ego around 0, 0."""
    found = autoware.parameters(T0, **autoware.PARAMETERS)
    for t_s in ticks(201, 0.1):
        turn = 0.2 * (t_s - T0)
        other: dict[str, Any] = {"turning": 0.2, "child": "base_link", "topic": "/odometry"}
        found.append(ros.odometry(t_s, 50.0 * math.sin(turn), -50.0 * math.cos(turn), turn, 10.0, **other))
        objects = [
            autoware.prediction(
                k, 30.0 * k + 20.0 * math.sin(turn + k), -20.0 * math.cos(turn + k), turn + k, 4.0, paths=k % 3,
                shape=BOX if k % 2 else {"type": 1, "dimensions": ros.xyz(0.5 + 0.1 * k, 0.5 + 0.1 * k, 1.7)},
            )
            for k in range(1, 9)
        ]  # fmt: skip
        found.append(autoware.predictions(t_s, *objects))
    return found


@pytest.mark.ci
def test_values_are_those_that_rosbags_reads(tmp_path: Path) -> None:
    """To a millimetre and a millionth of a radian, over twenty seconds."""
    typesys = pytest.importorskip("rosbags.typesys", reason="rosbags is not installed: pip install rosbags")
    store = typesys.get_typestore(typesys.Stores.EMPTY)
    for name, text in autoware.TYPES.items():
        store.register(typesys.get_types_from_msg(text.strip(), name.replace("/", "/msg/")))
    trace = trace_of(tmp_path, round_drive())
    ours = {(row["actor_id"], row["t_ns"]): row for row in states(trace)}
    sizes = {name: size(trace, name) for name in actors(trace)}
    compared = 0
    with (tmp_path / "log.mcap").open("rb") as file:
        for schema, _, record in make_reader(file).iter_messages():
            assert schema is not None
            message = store.deserialize_cdr(record.data, schema.name)
            if schema.name == "nav_msgs/msg/Odometry":
                pose, twist = message.pose.pose, message.twist.twist
                # half of 2.79 + 1.0 - 1.1 ahead of the rear axle, which moves sideways when the vehicle turns
                velocity = twist.linear.x, twist.linear.y + 1.345 * twist.angular.z
                assert_same(ours["ego", nanoseconds(message)], pose, velocity, ahead=1.345)
                compared += 1
            elif schema.name.endswith("PredictedObjects"):
                for item in message.objects:
                    name = str(uuid.UUID(bytes=bytes(item.object_id.uuid)))
                    pose = item.kinematics.initial_pose_with_covariance.pose
                    velocity = item.kinematics.initial_twist_with_covariance.twist.linear
                    assert_same(ours[name, nanoseconds(message)], pose, (velocity.x, velocity.y))
                    sides = item.shape.dimensions
                    assert sizes[name] == (sides.x, sides.y, sides.z)
                    compared += 1
    assert compared == len(ours) == 201 * 9


def nanoseconds(message: Any) -> int:
    return int(message.header.stamp.sec) * 10**9 + int(message.header.stamp.nanosec)


def assert_same(row: dict[str, Any], pose: Any, along: tuple[float, float], ahead: float = 0.0) -> None:
    """Hold a state against a pose, `ahead` of which it lies, and a velocity along the body's axes."""
    q = pose.orientation
    yaw = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
    cos, sin = math.cos(yaw), math.sin(yaw)
    assert row["x_m"] == pytest.approx(pose.position.x + ahead * cos, abs=1e-3)
    assert row["y_m"] == pytest.approx(pose.position.y + ahead * sin, abs=1e-3)
    assert row["vx_mps"] == pytest.approx(along[0] * cos - along[1] * sin, abs=1e-6)
    assert row["vy_mps"] == pytest.approx(along[0] * sin + along[1] * cos, abs=1e-6)
    assert abs(math.remainder(row["yaw_rad"] - yaw, math.tau)) < 1e-6
