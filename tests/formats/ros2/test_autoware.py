"""Autoware and plain detections: UUIDs, classes by probability, unknown headings, lights, who drives."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.errors import TraceError
from tests.formats.logs import actors, at, classes, quality, read, states
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import T0, TURN, N, along, ego, ticks, trace_of

if TYPE_CHECKING:
    from pathlib import Path

CAR_1 = "00010203-0405-0607-0809-0a0b0c0d0e01"
CAR_2 = "00010203-0405-0607-0809-0a0b0c0d0e02"


def cars(facing: int = 2, speed: float = 10.0, **options: Any) -> list[ros.Message]:
    """Return two cars, the second with a heading that is known as well as `facing` says."""
    return [
        ros.tracks(
            t_s,
            ros.track(1, 60.0, 0.0),
            ros.track(2, 20.0 + along(t_s)[0], 20.0 + along(t_s)[1], TURN, speed, facing=facing, **options),
        )
        for t_s in ticks()
    ]


def test_tracks(tmp_path: Path) -> None:
    trace = trace_of(tmp_path, [*ego(), *cars()])
    rows = actors(trace)
    assert set(rows) == {CAR_1, CAR_2, "ego"}
    assert (rows[CAR_2]["actor_class"], rows[CAR_2]["length_m"]) == ("car", 4.5)
    state = at(trace, CAR_2, T0 + 1.0)
    assert (state["vx_mps"], state["vy_mps"]) == pytest.approx((5.0, 10.0 * math.sin(TURN)))
    assert state["yaw_rad"] == pytest.approx(TURN)


def test_without_odometry_the_bag_s_own_vehicle_is_missed(tmp_path: Path) -> None:
    transforms = [ros.transform(t_s, "map", "camera", *along(t_s)) for t_s in ticks()]
    (told,) = (
        note for note in trace_of(tmp_path, [*cars(), *transforms], ego=CAR_1).notes if "nav_msgs/Odometry" in note
    )
    assert "no transform leads to base_link" in told
    assert told.endswith("is not among the actors: record /localization/kinematic_state too")
    assert not any("nav_msgs/Odometry" in note for note in trace_of(tmp_path, [*ego(), *cars()]).notes)


@pytest.mark.parametrize(
    ("likely", "word"),
    [
        ({}, None), ({0: 0.9, 1: 0.1}, None), ({6: 0.3, 7: 0.4, 1: 0.3}, "pedestrian"), ({3: 0.5, 2: 0.5}, "bus"), ({200: 1.0}, None),
    ],
)  # fmt: skip
def test_likeliest_class(tmp_path: Path, likely: dict[int, float], word: str | None) -> None:
    labels = [{"label": label, "probability": probability} for label, probability in likely.items()]
    assert classes(trace_of(tmp_path, [*ego(), *cars(classes=labels)]))[CAR_2] == word


def test_no_orientation(tmp_path: Path) -> None:
    """Neither heading nor, since it is given along the heading, velocity: that comes from the places."""
    trace = trace_of(tmp_path, [*ego(), *cars(0, 99.0)])
    state = at(trace, CAR_2, T0 + 1.0)
    assert state["yaw_rad"] is None
    assert state["vx_mps"] == pytest.approx(5.0)
    assert quality(trace)["no_yaw"]["n"] == N
    assert quality(trace)["velocity_derived"]["actor_id"] == CAR_2


def test_front_or_back(tmp_path: Path) -> None:
    """The axis is known and the velocity along it, not which end is the front."""
    trace = trace_of(tmp_path, [*ego(), *cars(1)])
    state = at(trace, CAR_2, T0 + 1.0)
    assert state["yaw_rad"] is None
    assert state["vx_mps"] == pytest.approx(5.0)
    assert "velocity_derived" not in quality(trace)


def lights(name: str, *reports: tuple[float, int]) -> list[ros.Message]:
    return [ros.report(name, T0 + t_s, report=value) for t_s, value in reports]


def indicators(path: Path, messages: list[ros.Message]) -> list[str | None]:
    """Return the ego's indicator every half second."""
    rows = states(trace_of(path, [*ego(n=61), *cars(), *messages]), "ego")
    return [row["indicator"] for row in rows[::10]]


def test_indicators(tmp_path: Path) -> None:
    side = lights("TurnIndicatorsReport", (0.5, 1), (1.0, 2), (1.5, 3), (2.0, 7))
    assert indicators(tmp_path, side) == [None, "off", "left", "right", None, None, None]


def test_stale_reports(tmp_path: Path) -> None:
    assert indicators(tmp_path, lights("TurnIndicatorsReport", (0.5, 2))) == [
        None,
        "left",
        "left",
        "left",
        None,
        None,
        None,
    ]


def test_hazard_lights(tmp_path: Path) -> None:
    every = [i / 2 for i in range(7)]
    side = lights("TurnIndicatorsReport", *((t_s, 2) for t_s in every))
    hazard = lights("HazardLightsReport", (0.5, 1), (1.0, 2), (1.5, 1))
    assert indicators(tmp_path, [*side, *hazard]) == [None, "left", "hazard", "left", "left", "left", None]
    assert indicators(tmp_path, hazard) == [None, None, "hazard", None, None, None, None]


def events(path: Path, messages: list[ros.Message]) -> list[tuple[float, str, str, str]]:
    rows = trace_of(path, [*ego(), *cars(), *messages]).tables["declared_event"].to_pylist()
    return [(round(row["t_ns"] / 1e9 - T0, 6), row["actor_id"], row["event"], row["value"]) for row in rows]


def test_engagement(tmp_path: Path) -> None:
    modes = [ros.report("ControlModeReport", T0 + i / 4, mode=mode) for i, mode in enumerate((4, 4, 1, 1, 2, 1))]
    orders = [ros.report("Engage", T0 + 0.1, engage=1)]
    expected = [(0.0, "off"), (0.5, "on"), (1.0, "off"), (1.25, "on")]
    assert events(tmp_path, [*modes, *orders]) == [(t_s, "ego", "engaged", value) for t_s, value in expected]
    assert events(tmp_path, orders) == [(0.1, "ego", "engaged", "on")]
    assert events(tmp_path, []) == []


def test_detections(tmp_path: Path) -> None:
    messages = [
        ros.detections(
            t_s,
            ros.detection("a", *along(t_s), ("car", 0.2), ("PERSON", 0.7)),
            ros.detection("long name", 5.0, 0.0, ("thing", 1.0)),
            ros.detection("", 9.0, 0.0),
        )
        for t_s in ticks()
    ]
    trace = trace_of(tmp_path, [*ego(), *messages], ego="a")
    assert {name: word for name, word in classes(trace).items() if name != "ego"} == {
        "a": "pedestrian",
        "long name": None,
    }
    assert at(trace, "a", T0 + 1.0)["vx_mps"] == pytest.approx(5.0)
    assert quality(trace)["velocity_derived"]["n"] == 2 * N
    found = quality(trace)["dropped_row"]
    assert (found["n"], found["severity"]) == (N, "error")
    nameless = [ros.detections(t_s, ros.detection("", 1.0, 2.0)) for t_s in ticks()]
    with pytest.raises(TraceError, match="nothing can be placed"):
        trace_of(tmp_path, nameless, need_ego=False)


def test_old_detections(tmp_path: Path) -> None:
    """vision_msgs before its version 4: other names, and a class that is a number in a table that is not in the log."""
    types = {
        **ros.BASE,
        "vision_msgs/ObjectHypothesisWithPose": "int64 id\nfloat64 score\ngeometry_msgs/PoseWithCovariance pose",
        "vision_msgs/Detection3D": """
            std_msgs/Header header
            vision_msgs/ObjectHypothesisWithPose[] results
            vision_msgs/BoundingBox3D bbox
            bool is_tracking
            string tracking_id
        """,
    }
    box = ros.detection("", 4.0, 5.0)["bbox"]
    messages = [
        ros.detections(t_s, {"tracking_id": "t", "bbox": box, "results": [{"id": 3, "score": 0.5}]}) for t_s in ticks()
    ]
    trace = read(ros.write(tmp_path / "old.mcap", messages, types), ego="t")
    assert (states(trace, "t")[0]["x_m"], actors(trace)["t"]["actor_class"]) == (4.0, None)
