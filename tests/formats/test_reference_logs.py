"""The reference logs beside the checkout: the case study, esmini's CSVs, omega-prime's table, a real OSI MCAP."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from tests.formats.logs import actors, at, log, quality, read, states
from tests.shared_data import shared

RUNS = ("safe", "near_miss", "collision")
ESMINI = {
    "cut-in": ("Ego", 2, 50_000_000),
    "left-hand-traffic_using_road_rule": ("Ego", 2, 50_000_000),
    "light_state": ("Car1", 4, 50_000_000),
    "pedestrian_collision": ("Ego", 2, 50_000_000),
    "slow-lead-vehicle": ("Ego", 2, 50_000_000),
    "two_plus_one_road": ("Ego", 2, 50_000_000),
}


@pytest.mark.parametrize("run", RUNS)
def test_case_study(run: str) -> None:
    trace = read(shared(f"overtake_case_study/{run}.csv"), mapping="carla-testbench")
    assert [(k, v["is_ego"]) for k, v in actors(trace).items()] == [("1", True), ("2", False), ("3", False)]
    assert {(v["length_m"], v["width_m"], v["actor_class"]) for v in actors(trace).values()} == {(4.8, 1.8, "car")}
    times = [row["t_ns"] for row in states(trace, "1")]
    assert times == [i * 100_000_000 for i in range(len(times))]
    assert trace.map_offset == (2.618, 3.113)
    assert set(quality(trace)) == {"assumed_size", "turned_frame", "no_indicator", "no_brake_light", "unprotected"}


def test_case_study_frame_and_speeds() -> None:
    trace = read(shared("overtake_case_study/safe.csv"), mapping="carla-testbench")
    ego, oncoming = at(trace, "1", 8.3), at(trace, "3", 8.3)
    for row in (ego, oncoming):
        assert math.hypot(row["vx_mps"], row["vy_mps"]) == pytest.approx(5.218, abs=1e-3)
    assert (ego["x_m"], ego["y_m"], ego["yaw_rad"]) == (-341.041, -197.179, 0.186)
    assert (ego["vx_mps"], ego["vy_mps"]) == (5.210, 0.285)
    assert oncoming["yaw_rad"] == -2.685


@pytest.mark.parametrize("name", sorted(ESMINI))
def test_esmini(name: str) -> None:
    ego, n_actors, step = ESMINI[name]
    trace = read(shared(f"esmini/{name}.csv"))
    assert log(trace)["format"] == "esmini"
    assert [k for k, v in actors(trace).items() if v["is_ego"]] == [ego]
    assert len(actors(trace)) == n_actors
    times = [row["t_ns"] for row in states(trace, ego)]
    assert {b - a for a, b in pairwise(times)} == {step}
    # a scenario may set an actor in motion within one step, so single velocities differ; headings never
    assert quality(trace).get("velocity_mismatch", {"n": 0})["n"] <= 1
    assert not {"yaw_mismatch", "teleport", "no_size", "not_finite", "gap"} & set(quality(trace))


def test_esmini_positions_are_moved_from_the_rear_axle() -> None:
    trace = read(shared("esmini/two_plus_one_road.csv"))
    ego = at(trace, "Ego", 0.0)
    assert (ego["x_m"], ego["y_m"], ego["z_m"]) == pytest.approx((70.0 + 1.4, -1.75, 0.75))
    assert actors(trace)["Ego"]["length_m"] == 5.04
    walker = read(shared("esmini/pedestrian_collision.csv"))
    assert actors(walker)["pedestrian_adult"]["actor_class"] == "pedestrian"


def test_omega_prime_table() -> None:
    trace = read(shared("osi/example.csv"), ego="0")
    assert {k: v["actor_class"] for k, v in actors(trace).items()} == {"0": "car", "1": "pedestrian"}
    assert states(trace, "0")[1]["t_ns"] == 33_000_000
    assert log(trace)["has_acceleration"] is True


def test_real_osi_mcap() -> None:
    trace = read(shared("osi/osi_centerline_example.mcap"))
    assert log(trace)["format"] == "osi-mcap"
    assert (log(trace)["n_states"], len(actors(trace))) == (622, 14)
    assert [k for k, v in actors(trace).items() if v["is_ego"]] == ["225"]
    assert (log(trace)["t_start_ns"], log(trace)["t_end_ns"]) == (0, 8_999_640_000)
    first = at(trace, "192", 0.0)
    assert (first["x_m"], first["y_m"], first["vx_mps"]) == (-7131.11767578125, -2962.264404296875, -20.849609375)
    assert actors(trace)["192"]["actor_class"] == "car"
    lacks = {"acceleration_not_recorded", "no_indicator", "no_brake_light", "lanes_without_width"}
    assert lacks | {"copied_height"} == set(quality(trace)), "14 cars are as high as wide, to the last digit"
    assert log(trace)["has_acceleration"] is False
