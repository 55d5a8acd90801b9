"""What nobody does is doubted, what somebody may do is not; sizes and velocities that the positions contradict are mended and said."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.drive.tracks import doubts, drive, track

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace


def checks(trace: Trace) -> set[str]:
    return {row["check_id"] for row in trace.tables["quality"].to_pylist()}


def actor(trace: Trace, name: str) -> dict[str, Any]:
    rows: list[dict[str, Any]] = trace.tables["actor"].to_pylist()
    (row,) = (row for row in rows if row["actor_id"] == name)
    return row


def speeds(trace: Trace, name: str) -> np.ndarray[Any, Any]:
    rows = [row for row in trace.tables["actor_state"].to_pylist() if row["actor_id"] == name]
    return np.array([np.hypot(row["vx_mps"] or np.nan, row["vy_mps"] or 0.0) for row in rows])


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    speed=st.floats(0.0, 40.0), accel=st.floats(-8.0, 4.0), turn=st.floats(-0.5, 0.5), hz=st.sampled_from([5.0, 10.0, 20.0]),
    noise=st.floats(0.0, 0.02), seed=st.integers(0, 9),
)  # fmt: skip
def test_what_can_be_driven_is_not_doubted(
    tmp_path: Path, *, speed: float, accel: float, turn: float, hz: float, noise: float, seed: int
) -> None:
    t_s = np.arange(80) / hz
    v = np.maximum(speed + accel * t_s, 0.0)
    rate = np.sign(turn) * np.minimum(abs(turn), np.minimum(8.0 / np.maximum(v, 0.1), v / 6.0))  # 8 m/s2, 6 m radius
    yaw = np.cumsum(np.r_[0.0, (rate[1:] + rate[:-1]) / 2 / hz])
    vx, vy = v * np.cos(yaw), v * np.sin(yaw)
    place = [np.cumsum(np.r_[0.0, (u[1:] + u[:-1]) / 2 / hz]) for u in (vx, vy)]
    shake = np.random.default_rng(seed).normal(0.0, noise, (2, len(t_s)))
    car = track(n=80, hz=hz) | {
        "x_m": place[0] + shake[0], "y_m": place[1] + shake[1], "yaw_rad": yaw, "vx_mps": vx, "vy_mps": vy,
    }  # fmt: skip
    assert not {row for row in doubts(drive(tmp_path, car=car)) if row[0] == "car"}


@pytest.mark.parametrize("heading", [0.0, 2.0, -1.2])
def test_a_jolt_there_and_back(tmp_path: Path, heading: float) -> None:
    car = track(heading=heading)
    car["vx_mps"][40], car["vy_mps"][40] = 1.2 * car["vx_mps"][40], 1.2 * car["vy_mps"][40]
    trace = drive(tmp_path, car=car)
    assert doubts(trace) == {("car", "velocity", "velocity_jolt")}
    (row,) = trace.tables["doubt"].to_pylist()
    assert (row["t_from_ns"], row["t_to_ns"]) == (3_900_000_001, 4_099_999_999)


def test_an_impact_is_no_jolt(tmp_path: Path) -> None:
    car = track()
    for name in ("vx_mps",):
        car[name][40:] = 7.0
    car["x_m"] = np.cumsum(np.r_[0.0, (car["vx_mps"][1:] + car["vx_mps"][:-1]) / 20.0])
    assert not doubts(drive(tmp_path, car=car))


def test_a_step_aside_and_back(tmp_path: Path) -> None:
    bike = track(5.0, actor_class="bicycle", length_m=1.8, width_m=0.6)
    bike["y_m"][50:60] += 1.0
    trace = drive(tmp_path, bike=bike)
    assert doubts(trace) == {("bike", "position", "position_step")}
    spans = sorted((row["t_from_ns"], row["t_to_ns"]) for row in trace.tables["doubt"].to_pylist())
    assert spans[0][0] <= 4_900_000_000
    assert spans[-1][1] >= 6_000_000_000


def test_who_is_hit_and_moved_is_not_doubted(tmp_path: Path) -> None:
    person = track(2.0, actor_class="pedestrian", length_m=0.6, width_m=0.6)
    person["vx_mps"][50:] = 0.0
    person["x_m"][50:] = person["x_m"][50]
    person["y_m"][50:] += 0.9
    assert not doubts(drive(tmp_path, person=person))


def test_a_standing_car_that_turns_on_the_spot(tmp_path: Path) -> None:
    car = track(0.0)
    car["yaw_rad"][30:33] = [0.3, 0.6, 0.9]
    car["yaw_rad"][33:] = 1.2
    assert doubts(drive(tmp_path, car=car)) == {("car", "heading", "heading_spin")}
    person = car | {"actor_class": "pedestrian", "length_m": 0.6, "width_m": 0.6}
    assert not doubts(drive(tmp_path, person=person))


def test_a_pedestrian_as_fast_as_a_car(tmp_path: Path) -> None:
    person = track(20.0, actor_class="pedestrian", length_m=0.6, width_m=0.6)
    assert doubts(drive(tmp_path, person=person)) == {("person", "class", "class_implausible")}
    assert not doubts(drive(tmp_path, person=track(9.0, actor_class="pedestrian", length_m=0.6, width_m=0.6)))


@pytest.mark.parametrize("heading", [0.0, 2.5])
def test_swapped_sizes_of_who_moves_are_exchanged(tmp_path: Path, heading: float) -> None:
    trace = drive(tmp_path, car=track(heading=heading, length_m=1.8, width_m=4.5))
    assert (actor(trace, "car")["length_m"], actor(trace, "car")["width_m"]) == (4.5, 1.8)
    assert "size_turned" in checks(trace)
    assert not doubts(trace)


@pytest.mark.parametrize(
    ("actor_class", "sides", "believed", "check"),
    [
        ("bicycle", (0.6, 1.8), (1.8, 0.6), "size_turned"),
        ("animal", (0.8, 2.4), (2.4, 0.8), "size_turned"),
        # the box of a rider's body alone
        ("bicycle", (0.5, 1.2), (0.5, 1.2), None),
        # it may be a horse, a car of which the rear is seen, or a barrier on a trolley
        (None, (0.8, 2.4), (None, None), "size_unknown"),
        ("object", (0.8, 2.4), (None, None), "size_unknown"),
        (None, (0.4, 0.8), (0.4, 0.8), None),
    ],
)
def test_swapped_sizes_of_slim_bodies(
    tmp_path: Path,
    actor_class: str | None,
    sides: tuple[float, float],
    believed: tuple[float, float],
    check: str | None,
) -> None:
    body = track(5.0, actor_class=actor_class, length_m=sides[0], width_m=sides[1])
    trace = drive(tmp_path, body=body)
    assert (actor(trace, "body")["length_m"], actor(trace, "body")["width_m"]) == believed
    assert {name for name in checks(trace) if name.startswith("size_")} == ({check} - {None})


@pytest.mark.parametrize(("speed", "believed"), [(0.0, (0.8, 2.4)), (0.9, (0.8, 2.4)), (1.1, (None, None))])
def test_a_wide_thing_that_stands_keeps_its_size(
    tmp_path: Path, speed: float, believed: tuple[float | None, float | None]
) -> None:
    trace = drive(tmp_path, body=track(speed, actor_class=None, length_m=0.8, width_m=2.4))
    assert (actor(trace, "body")["length_m"], actor(trace, "body")["width_m"]) == believed


def test_swapped_sizes_of_who_stands_are_unknown(tmp_path: Path) -> None:
    trace = drive(tmp_path, car=track(0.0, length_m=1.8, width_m=4.5))
    assert (actor(trace, "car")["length_m"], actor(trace, "car")["width_m"]) == (None, None)
    assert "size_unknown" in checks(trace)


def test_a_box_that_is_hardly_wider_than_long_stays(tmp_path: Path) -> None:
    trace = drive(tmp_path, car=track(0.0, length_m=1.7, width_m=1.8))
    assert (actor(trace, "car")["length_m"], actor(trace, "car")["width_m"]) == (1.7, 1.8)


def test_a_size_that_nobody_has(tmp_path: Path) -> None:
    assert doubts(drive(tmp_path, car=track(width_m=0.18))) == {("car", "size", "size_implausible")}
    assert not doubts(drive(tmp_path, car=track(length_m=14.6, width_m=2.6)))  # a lorry that is recorded as a car


@pytest.mark.parametrize("row", [0, -1])
def test_a_velocity_of_zero_at_an_end_of_a_track(tmp_path: Path, row: int) -> None:
    car = track()
    car["vx_mps"][row] = 0.0
    trace = drive(tmp_path, car=car)
    assert speeds(trace, "car") == pytest.approx(13.0, abs=1e-6)
    assert "velocity_end_derived" in checks(trace)


def test_who_stops_or_sets_off_at_an_end_of_the_log_keeps_its_zero(tmp_path: Path) -> None:
    car = track()
    car["vx_mps"] = np.maximum(0.0, np.linspace(8.0, 0.0, 100))
    car["x_m"] = np.cumsum(np.r_[0.0, (car["vx_mps"][1:] + car["vx_mps"][:-1]) / 20.0])
    assert "velocity_end_derived" not in checks(drive(tmp_path, car=car))


@pytest.mark.parametrize("share", [0.8, 1.2])
def test_a_velocity_with_a_constant_bias_gives_way_to_the_positions(tmp_path: Path, share: float) -> None:
    car = track(15.6)
    car["vx_mps"] = share * car["vx_mps"]
    trace = drive(tmp_path, car=car)
    assert speeds(trace, "car") == pytest.approx(15.6, abs=0.05)
    (said,) = (row["message"] for row in trace.tables["quality"].to_pylist() if row["check_id"] == "velocity_derived")
    assert "derived from positions" in said


@pytest.mark.parametrize("share", [0.97, 1.04])
def test_a_speedometers_error_is_none(tmp_path: Path, share: float) -> None:
    car = track(15.6)
    car["vx_mps"] = share * car["vx_mps"]
    assert "velocity_derived" not in checks(drive(tmp_path, car=car))


def test_positions_that_freeze_are_no_bias_of_the_velocity(tmp_path: Path) -> None:
    car = track(15.6)
    car["x_m"] = np.minimum(car["x_m"], car["x_m"][60])
    trace = drive(tmp_path, car=car)
    assert "velocity_derived" not in checks(trace)
    x_m = [row["x_m"] for row in trace.tables["actor_state"].to_pylist() if row["actor_id"] == "car"]
    assert x_m[62:] == [None] * 38


def dipping(speeds: tuple[float, ...], share: float, *, of: int) -> dict[str, dict[str, Any]]:
    """Return cars of these speeds beside each other, the first `of` of which go `share` of their way in the two steps after 5.0 s."""
    cars = {}
    for i, speed in enumerate(speeds):
        car = track(speed)
        way = np.full(99, speed / 10.0)
        way[50:52] *= share if i < of else 1.0
        car["x_m"] = np.r_[0.0, np.cumsum(way)]
        car["y_m"] = car["y_m"] + 6.0 * i
        cars[f"c{i}"] = car | {"vx_mps": np.full(100, np.nan), "vy_mps": np.full(100, np.nan)}
    return cars


def common(trace: Trace) -> set[str]:
    return {name for name, quantity, code in doubts(trace) if code == "common_jolt" and quantity == "velocity"}


def test_when_all_but_the_recorder_go_half_as_far_the_log_does(tmp_path: Path) -> None:
    trace = drive(tmp_path, **dipping((2.0, 4.0, 7.0, 9.0), 0.5, of=4))
    assert common(trace) == {"c0", "c1", "c2", "c3"}
    (row, *_) = (row for row in trace.tables["doubt"].to_pylist() if row["code"] == "common_jolt")
    # half a second around the dip, up to the samples that are not in doubt; not around those from which everybody seems to rise
    assert (row["t_from_ns"], row["t_to_ns"]) == (4_400_000_001, 5_799_999_999)


@pytest.mark.parametrize(("share", "of"), [(0.5, 2), (0.95, 4)])
def test_some_who_brake_or_a_little_less_is_their_driving(tmp_path: Path, share: float, of: int) -> None:
    assert not common(drive(tmp_path, **dipping((2.0, 4.0, 7.0, 9.0), share, of=of)))
