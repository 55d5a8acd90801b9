"""Somebody who rides, and what he rides, are one road user, with the box around both."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.formats.argoverse2.argoverse_log import Row, box, pose, sensor_log, stamp
from tests.formats.logs import actors, read, states

if TYPE_CHECKING:
    from pathlib import Path

N = 12
BIKE: Row = {"category": "BICYCLE", "length_m": 1.8, "width_m": 0.5, "height_m": 1.1}
RIDER: Row = {"category": "BICYCLIST", "length_m": 0.6, "width_m": 0.7, "height_m": 1.6}


def ridden(tmp_path: Path, rows: list[dict[str, Any]]) -> Any:
    return read(sensor_log(tmp_path / "log", rows, [pose(k) for k in range(N)]))


def test_a_rider_has_the_box_around_both(tmp_path: Path) -> None:
    """The bicycle reaches from 9.1 to 10.9 m, the rider stands 0.2 m behind its middle, 0.35 m to both sides, from -0.3 to 1.3 m."""
    bike = [box(k, "bike", 10.0, 2.0, -0.2, **BIKE) for k in range(N)]
    rider = [box(k, "rider", 9.8, 2.0, 0.5, **RIDER) for k in range(N)]
    trace = ridden(tmp_path, bike + rider)
    assert set(actors(trace)) == {"ego", "rider"}
    found = actors(trace)["rider"]
    assert (found["actor_class"], found["length_m"], found["width_m"]) == (
        "bicycle",
        pytest.approx(1.8),
        pytest.approx(0.7),
    )
    assert found["height_m"] == pytest.approx(1.3 - -0.75)
    first = states(trace, "rider")[0]
    assert (first["x_m"], first["y_m"], first["z_m"]) == pytest.approx((10.0, 2.0, (1.3 - 0.75) / 2))
    assert any("each rider and the vehicle" in note and "rider" in note for note in trace.notes)


def test_the_box_lies_along_what_is_ridden(tmp_path: Path) -> None:
    """Both turned to the left by a quarter; the rider leans 0.5 m out over the side that then faces back."""
    bike = [box(k, "bike", 10.0, 2.0, yaw=1.5707963267948966, **BIKE) for k in range(N)]
    rider = [box(k, "rider", 9.5, 2.0, yaw=1.5707963267948966, **RIDER) for k in range(N)]
    trace = ridden(tmp_path, bike + rider)
    found, first = actors(trace)["rider"], states(trace, "rider")[0]
    assert found["width_m"] == pytest.approx(0.25 + 0.5 + 0.35)
    assert (first["x_m"], first["y_m"], first["yaw_rad"]) == pytest.approx((10.0 - 0.3, 2.0, 1.5707963267948966))


def test_a_passenger_is_part_of_the_same_body(tmp_path: Path) -> None:
    motorcycle = [box(k, "m", 10.0, category="MOTORCYCLE", length_m=2.0, width_m=0.8) for k in range(N)]
    riders = [
        box(k, name, x, category="MOTORCYCLIST", length_m=0.6, width_m=0.6)
        for name, x in (("driver", 10.2), ("passenger", 9.6))
        for k in range(N)
    ]
    trace = ridden(tmp_path, motorcycle + riders)
    assert set(actors(trace)) == {"ego", "driver"}
    assert actors(trace)["driver"]["actor_class"] == "motorcycle"
    assert actors(trace)["driver"]["length_m"] == pytest.approx(2.0)


def test_what_nobody_rides_keeps_its_box(tmp_path: Path) -> None:
    """The rider comes by for two samples of twelve, and rides none of the rack's bicycles."""
    rack = [box(k, f"bike{i}", 10.0 + i, 2.0, **BIKE) for i in range(3) for k in range(N)]
    rider = [box(k, "rider", 4.0 + k, 2.0, **RIDER) for k in range(N)]
    trace = ridden(tmp_path, rack + rider)
    assert set(actors(trace)) == {"ego", "bike0", "bike1", "bike2", "rider"}
    assert actors(trace)["bike0"]["actor_class"] == "object"
    assert actors(trace)["rider"]["length_m"] == 0.6
    assert not any("riders" in note for note in trace.notes)


def test_a_bicycle_that_is_left_standing_has_its_own_states_then(tmp_path: Path) -> None:
    bike = [box(k, "bike", 10.0, 2.0, **BIKE) for k in range(N)]
    rider = [box(k, "rider", 10.0, 2.0, **RIDER) for k in range(7)]
    trace = ridden(tmp_path, bike + rider)
    assert [row["t_ns"] for row in states(trace, "bike")] == [stamp(k) for k in range(7, N)]
    assert len(states(trace, "rider")) == 7


def test_a_rider_without_a_bicycle_s_box(tmp_path: Path) -> None:
    trace = ridden(tmp_path, [box(k, "rider", 10.0, 2.0, **RIDER) for k in range(N)])
    assert actors(trace)["rider"]["length_m"] == 0.6


def test_on_a_bridge_above(tmp_path: Path) -> None:
    bike = [box(k, "bike", 10.0, 2.0, -0.2, **BIKE) for k in range(N)]
    rider = [box(k, "rider", 10.0, 2.0, 6.0, **RIDER) for k in range(N)]
    assert set(actors(ridden(tmp_path, bike + rider))) == {"ego", "bike", "rider"}


def test_a_place_that_is_not_known_joins_nobody(tmp_path: Path) -> None:
    bike = [box(k, "bike", 10.0, 2.0, **BIKE) for k in range(N)]
    rider = [box(k, "rider", float("nan") if k < 7 else 10.0, 2.0, **RIDER) for k in range(N)]
    assert set(actors(ridden(tmp_path, bike + rider))) == {"ego", "bike", "rider"}
