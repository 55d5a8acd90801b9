"""A log without odometry, as most bags of ROS are: the ego is placed by the transforms of its frame, or it is said why not."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint.errors import TraceError
from tests.formats.logs import quality, read
from tests.formats.ros2 import autoware_log
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import T0, TURN, N, along, ego, others, seen, ticks

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


def egos(trace: Trace) -> list[str]:
    return [row["actor_id"] for row in trace.tables["actor"].to_pylist() if row["is_ego"]]


def test_the_ego_is_that_of_the_same_log_with_odometry(tmp_path: Path) -> None:
    trace, with_odometry = seen(tmp_path, [*moving(), *others()]), seen(tmp_path, [*ego(), *others()])
    found, wanted = track(trace), track(with_odometry)
    for name in wanted:
        assert found[name] == pytest.approx(wanted[name], abs=1e-6), name
    assert egos(trace) == egos(with_odometry) == ["ego"]
    assert any("the ego is placed by the transforms of 'base_link' on /tf" in note for note in trace.notes)


def test_odometry_comes_first(tmp_path: Path) -> None:
    wrong = [ros.transform(t_s, "map", "base_link", 5000.0) for t_s in ticks()]
    assert track(seen(tmp_path, [*wrong, *ego(), *others()]))["x_m"].max() < 100.0


def test_static_transforms_are_chained_and_times_are_those_of_the_transforms(tmp_path: Path) -> None:
    """The moving frame is base_footprint, at 7 Hz; the ego's frame is 2 m ahead of it and turned."""
    messages = [*moving("odom", "base_footprint", dt=1 / 7, n=12), still("base_footprint", "base_link", 2.0, 0.1)]
    found = track(seen(tmp_path, messages))
    t_s = np.array(ticks(12, 1 / 7))
    assert found["t_ns"] == pytest.approx([round(each * 1e9) for each in t_s], abs=1)
    wanted = [(x + 2.0 * math.cos(TURN), y + 2.0 * math.sin(TURN)) for x, y in map(along, t_s)]
    assert np.column_stack([found["x_m"], found["y_m"]]) == pytest.approx(np.array(wanted))
    assert found["yaw_rad"] == pytest.approx(TURN + 0.1)


def test_the_ego_is_placed_in_the_map(tmp_path: Path) -> None:
    """The localisation moves `odom` in `map`, at another rate."""
    local = [ros.transform(t_s, "map", "odom", 100.0) for t_s in np.arange(T0 - 0.5, T0 + 3.0, 0.13).tolist()]
    found = track(seen(tmp_path, [*local, *moving("odom"), *others()]))
    assert found["x_m"] == pytest.approx([100.0 + along(t_s)[0] for t_s in ticks()])


def test_the_box_of_the_vehicle_and_the_option_set_the_centre(tmp_path: Path) -> None:
    box = autoware_log.parameters(T0, **autoware_log.PARAMETERS)
    path = autoware_log.write(tmp_path / "box.mcap", [*box, *moving()])
    ahead = (2.79 + 1.0 - 1.1) / 2
    found = track(read(path))
    assert found["x_m"] == pytest.approx([along(t_s)[0] + ahead * math.cos(TURN) for t_s in ticks()], abs=1e-3)
    assert "reference_point" in quality(seen(tmp_path, moving()))


def test_relayed_transforms_count_once(tmp_path: Path) -> None:
    twice = [message for each in moving() for message in (each, each)]
    assert len(track(seen(tmp_path, twice))["t_ns"]) == N


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
        seen(tmp_path, messages)
    assert "\n" not in str(error.value)


def test_objects_without_a_chain_have_no_ego(tmp_path: Path) -> None:
    tracked = [ros.tracks(t_s, ros.track(3, 50.0, 9.0)) for t_s in ticks()]
    trace = seen(tmp_path, [*tracked, *moving(child="camera")], need_ego=False)
    assert egos(trace) == []
    assert any("no transform leads to base_link" in note and "is not among the actors" in note for note in trace.notes)


def test_an_ego_that_is_not_in_the_frame_of_the_objects_is_not_placed(tmp_path: Path) -> None:
    tracked = [ros.tracks(t_s, ros.track(3, 50.0, 9.0)) for t_s in ticks()]
    trace = seen(tmp_path, [*tracked, *moving("odom")])
    assert "no transform leads from 'odom' to 'map'" in quality(trace)["frame_unresolved"]["message"]
    assert np.isnan(track(trace)["x_m"]).all()


def test_a_hole_of_the_transforms_is_lost_time(tmp_path: Path) -> None:
    kept = [message for k, message in enumerate(moving()) if not 10 <= k < 30]
    trace = seen(tmp_path, [*kept, *others()])
    assert "ego_absent" in quality(trace)
    assert np.isfinite(track(trace)["x_m"]).sum() == N - 20


@pytest.mark.parametrize("frame", ["chassis", "two/base_link"])
def test_the_option_chooses_the_frame_of_the_ego(tmp_path: Path, frame: str) -> None:
    far = [ros.transform(t_s, "map", "one/base_link", 5000.0) for t_s in ticks()]
    trace = seen(tmp_path, [*far, *moving(child=frame), *others()], ego=frame)
    assert egos(trace) == [frame]
    rows = [row for row in trace.tables["actor_state"].to_pylist() if row["actor_id"] == frame]
    assert [row["x_m"] for row in rows] == pytest.approx([along(t_s)[0] for t_s in ticks()])


def test_ends_at_which_the_map_is_not_known_are_no_loss(tmp_path: Path) -> None:
    """`odom` in `map` is sent at 5 Hz: at the end its last transform is older than that of the ego."""
    local = [ros.transform(t_s, "map", "odom", 100.0) for t_s in np.arange(T0 + 0.1, T0 + 1.8, 0.2).tolist()]
    trace = seen(tmp_path, [*local, *moving("odom"), *others()])
    assert "frame_unresolved" not in quality(trace)
    assert "ego_absent" not in quality(trace)
    late = [message for message in local if message[2] > T0 + 1.2]
    assert "frame_unresolved" in quality(seen(tmp_path, [*late, *moving("odom"), *others()]))
