"""A log without odometry, as most bags of ROS are: the ego is placed by the transforms of its frame, or it is said why not."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint.errors import TraceError
from tests.formats.logs import egos, quality, read
from tests.formats.ros2 import autoware_log
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import T0, TURN, N, along, ego, road_users, ticks, trace_of

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace


def moving(
    parent: str = "map", child: str = "base_link", dt: float = 0.05, topic: str = "/tf", n: int = N
) -> list[ros.Message]:
    return [ros.transform(t_s, parent, child, *along(t_s), yaw=TURN, topic=topic) for t_s in ticks(n, dt)]


def still(parent: str, child: str, x: float = 0.0, yaw: float = 0.0) -> ros.Message:
    return ros.transform(T0 - 5.0, parent, child, x, yaw=yaw, topic="/tf_static")


def track(trace: Trace) -> dict[str, np.ndarray[Any, Any]]:
    rows = [row for row in trace.tables["actor_state"].to_pylist() if row["actor_id"] == "ego"]
    return {name: np.array([row[name] for row in rows], float) for name in ("t_ns", "x_m", "y_m", "yaw_rad", "vx_mps")}


def test_the_ego_is_that_of_the_same_log_with_odometry(tmp_path: Path) -> None:
    trace, with_odometry = trace_of(tmp_path, [*moving(), *road_users()]), trace_of(tmp_path, [*ego(), *road_users()])
    found, wanted = track(trace), track(with_odometry)
    for name in wanted:
        assert found[name] == pytest.approx(wanted[name], abs=1e-6), name
    assert egos(trace) == egos(with_odometry) == ["ego"]
    assert any("the ego is placed by the transforms of 'base_link' on /tf" in note for note in trace.notes)


def test_odometry_comes_first(tmp_path: Path) -> None:
    wrong = [ros.transform(t_s, "map", "base_link", 5000.0) for t_s in ticks()]
    assert track(trace_of(tmp_path, [*wrong, *ego(), *road_users()]))["x_m"].max() < 100.0


def test_static_transforms_are_chained_and_times_are_those_of_the_transforms(tmp_path: Path) -> None:
    """The moving frame is base_footprint, at 7 Hz; the ego's frame is 2 m ahead of it and turned."""
    messages = [*moving("odom", "base_footprint", dt=1 / 7, n=12), still("base_footprint", "base_link", 2.0, 0.1)]
    found = track(trace_of(tmp_path, messages))
    t_s = np.array(ticks(12, 1 / 7))
    assert found["t_ns"] == pytest.approx([round(each * 1e9) for each in t_s], abs=1)
    wanted = [(x + 2.0 * math.cos(TURN), y + 2.0 * math.sin(TURN)) for x, y in map(along, t_s)]
    assert np.column_stack([found["x_m"], found["y_m"]]) == pytest.approx(np.array(wanted))
    assert found["yaw_rad"] == pytest.approx(TURN + 0.1)


def test_the_ego_is_placed_in_the_map(tmp_path: Path) -> None:
    """The localisation moves `odom` in `map`, at another rate."""
    local = [ros.transform(t_s, "map", "odom", 100.0) for t_s in np.arange(T0 - 0.5, T0 + 3.0, 0.13).tolist()]
    found = track(trace_of(tmp_path, [*local, *moving("odom"), *road_users()]))
    assert found["x_m"] == pytest.approx([100.0 + along(t_s)[0] for t_s in ticks()])


def test_the_box_of_the_vehicle_and_the_option_set_the_centre(tmp_path: Path) -> None:
    box = autoware_log.parameters(T0, **autoware_log.PARAMETERS)
    path = autoware_log.write(tmp_path / "box.mcap", [*box, *moving()])
    ahead = (2.79 + 1.0 - 1.1) / 2
    found = track(read(path))
    assert found["x_m"] == pytest.approx([along(t_s)[0] + ahead * math.cos(TURN) for t_s in ticks()], abs=1e-3)
    assert "reference_point" in quality(trace_of(tmp_path, moving()))


def test_relayed_transforms_count_once(tmp_path: Path) -> None:
    twice = [message for each in moving() for message in (each, each)]
    assert len(track(trace_of(tmp_path, twice))["t_ns"]) == N


@pytest.mark.parametrize(
    ("messages", "why"),
    [
        (moving(child="camera"), r"no transform leads to base_link or base_footprint \(child frames: camera; --ego FRAME"),
        ([still("map", "base_link")], "the chain from it ends at 'map'"),
        ([still("base_footprint", "base_link")], "the chain from it ends at 'base_footprint'"),
        ([*moving("a"), *moving("b")], "several frames have the child frame 'base_link'"),
        ([*moving("map", "one/base_link"), *moving("map", "two/base_link")], "and --ego FRAME chooses one: one/base_link"),
        (moving("lidar"), "ends at 'lidar', without map or world or odom"),
        ([*moving("a", "base_link"), *moving("base_link", "a")], "ends at '(a|base_link)', without map"),
    ],
)  # fmt: skip
def test_a_broken_chain_is_refused_with_its_reason(tmp_path: Path, messages: list[ros.Message], why: str) -> None:
    with pytest.raises(TraceError, match=why) as error:
        trace_of(tmp_path, messages)
    assert "\n" not in str(error.value)


def test_objects_without_a_chain_have_no_ego(tmp_path: Path) -> None:
    tracked = [ros.tracks(t_s, ros.track(3, 50.0, 9.0)) for t_s in ticks()]
    trace = trace_of(tmp_path, [*tracked, *moving(child="camera")], need_ego=False)
    assert egos(trace) == []
    assert any("no transform leads to base_link" in note and "is not among the actors" in note for note in trace.notes)


def test_an_ego_that_is_not_in_the_frame_of_the_objects_is_not_placed(tmp_path: Path) -> None:
    tracked = [ros.tracks(t_s, ros.track(3, 50.0, 9.0)) for t_s in ticks()]
    trace = trace_of(tmp_path, [*tracked, *moving("odom")])
    assert "no transform leads from 'odom' to 'map'" in quality(trace)["frame_unresolved"]["message"]
    assert np.isnan(track(trace)["x_m"]).all()


def test_a_hole_of_the_transforms_is_lost_time(tmp_path: Path) -> None:
    kept = [message for k, message in enumerate(moving()) if not 10 <= k < 30]
    trace = trace_of(tmp_path, [*kept, *road_users()])
    assert "ego_absent" in quality(trace)
    assert np.isfinite(track(trace)["x_m"]).sum() == N - 20


@pytest.mark.parametrize("frame", ["chassis", "two/base_link"])
def test_the_option_chooses_the_frame_of_the_ego(tmp_path: Path, frame: str) -> None:
    far = [ros.transform(t_s, "map", "one/base_link", 5000.0) for t_s in ticks()]
    trace = trace_of(tmp_path, [*far, *moving(child=frame), *road_users()], ego=frame)
    assert egos(trace) == [frame]
    rows = [row for row in trace.tables["actor_state"].to_pylist() if row["actor_id"] == frame]
    assert [row["x_m"] for row in rows] == pytest.approx([along(t_s)[0] for t_s in ticks()])


def test_ends_at_which_the_map_is_not_known_are_no_loss(tmp_path: Path) -> None:
    """`odom` in `map` is sent at 5 Hz: at the end its last transform is older than that of the ego."""
    local = [ros.transform(t_s, "map", "odom", 100.0) for t_s in np.arange(T0 + 0.1, T0 + 1.8, 0.2).tolist()]
    trace = trace_of(tmp_path, [*local, *moving("odom"), *road_users()])
    assert "frame_unresolved" not in quality(trace)
    assert "ego_absent" not in quality(trace)
    late = [message for message in local if message[2] > T0 + 1.2]
    assert "frame_unresolved" in quality(trace_of(tmp_path, [*late, *moving("odom"), *road_users()]))


def test_an_end_longer_than_the_periods_explain_stays_and_is_not_placed(tmp_path: Path) -> None:
    """`odom` in `map` is sent at 20 Hz and ends 0.85 s before the ego; at its start it is a period late."""
    local = [ros.transform(t_s, "map", "odom", 100.0) for t_s in ticks()[1:-17]]
    trace = trace_of(tmp_path, [*local, *moving("odom"), *road_users()])
    assert np.isfinite(track(trace)["x_m"]).tolist() == [True] * (N - 18) + [False] * 17
    assert "17 poses cannot be placed" in quality(trace)["frame_unresolved"]["message"]
    assert "no_position" in quality(trace)


@pytest.mark.parametrize(("frame", "option"), [("base_footprint", None), ("imu_link", "imu_link")])
def test_the_centre_of_the_box_is_not_known_in_another_frame_than_the_axle(
    tmp_path: Path, frame: str, option: str | None
) -> None:
    box = autoware_log.parameters(T0, **autoware_log.PARAMETERS)
    trace = read(autoware_log.write(tmp_path / "box.mcap", [*box, *moving(child=frame)]), ego=option)
    assert "reference_point" in quality(trace)
    (note,) = [note for note in trace.notes if "the ego's box is taken from" in note]
    assert "4.89 m by 1.90 m; its centre in the ego's frame is not stated" in note


def test_two_writers_of_the_ego_s_frame_are_refused_unless_the_user_chooses_one(tmp_path: Path) -> None:
    """Objects in the ego's frame are placed by the chosen topic too."""
    other = [
        ros.transform(t_s + 0.02, "map", "base_link", 5.0, 300.0, topic="/localisation/tf")
        for t_s in ticks(N + 1, 0.05)
    ]
    near = [ros.tracks(t_s, ros.track(3, 9.0, 0.0), frame="base_link") for t_s in ticks()]
    messages = [message for each in zip(moving(), other, strict=False) for message in each]
    why = "several topics have transforms to 'base_link', and --topic chooses one: /localisation/tf, /tf"
    with pytest.raises(TraceError, match=why):
        trace_of(tmp_path, messages)
    trace = trace_of(tmp_path, [*messages, *near], topic="/tf")
    assert track(trace)["x_m"] == pytest.approx([along(t_s)[0] for t_s in ticks()])
    placed = [row["y_m"] for row in trace.tables["actor_state"].to_pylist() if row["actor_id"] != "ego"]
    assert placed == pytest.approx([along(t_s)[1] + 9.0 * math.sin(TURN) for t_s in ticks()])


def test_the_choice_of_a_static_topic_leaves_no_other_topic_out(tmp_path: Path) -> None:
    messages = [still("map", "odom", 100.0), *moving("odom")]
    found = track(trace_of(tmp_path, messages, topic="/tf_static"))
    assert found["x_m"] == pytest.approx([100.0 + along(t_s)[0] for t_s in ticks()])
    assert found["x_m"] == pytest.approx(track(trace_of(tmp_path, messages, topic="/tf"))["x_m"])


@pytest.mark.ci
def test_many_child_frames_do_not_take_long(tmp_path: Path) -> None:
    """With a pass over all transforms for each child frame, this would take many times longer."""
    topic, kind, t_s, content = ros.transform(T0, "map", "marker")
    (item,) = content["transforms"]
    markers = [{**item, "child_frame_id": f"marker_{k}"} for k in range(20_000)]
    found = track(trace_of(tmp_path, [(topic, kind, t_s, {"transforms": markers}), *moving()]))
    assert found["x_m"] == pytest.approx([along(t_s)[0] for t_s in ticks()])


def test_transforms_are_split_by_their_frames_in_the_order_of_the_log(tmp_path: Path) -> None:
    """The rows of a chain interleave with others; a name may be a prefix of another."""
    messages = [
        message
        for t_s in ticks()
        for message in (
            ros.transform(t_s, "odom", "base_link", *along(t_s), yaw=TURN),
            ros.transform(t_s, "base_link", "base_link_2", 70.0),
            ros.transform(t_s, "map", "odom", t_s),
        )
    ]
    assert track(trace_of(tmp_path, messages))["x_m"] == pytest.approx([t_s + along(t_s)[0] for t_s in ticks()])
