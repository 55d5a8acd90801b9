"""How far off the ego's filtered motion may be: against numpy's standard errors, and against another reading of the same motion."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from tests.scenes import Actor, derived, drive, judged, rows, times

T = times(6.0, period=0.1)
STILL = np.zeros(len(T))
COLUMNS = ("accel_mps2", "lat_accel_mps2", "accel_error_mps2", "lat_error_mps2", "jerk_error_mps3")
COMFORT = ("comfort.lateral", "comfort.accel-iso15622", "comfort.nuplan")


def straight(speed: np.ndarray, *, column: np.ndarray | None = None, yaw: np.ndarray = STILL) -> Actor:
    """Return an ego whose places follow `speed` along x, whatever the columns of its velocity and heading say."""
    x = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * 0.1)])
    return Actor("ego", T, x, STILL.copy(), yaw, speed if column is None else column, STILL.copy())


def motion(ego: Actor) -> dict[str, np.ndarray]:
    found = rows(derived(drive([ego], None), tables=["ego_motion"]), "FROM ego_motion ORDER BY t_ns")
    return {name: np.array([row[name] for row in found], float) for name in COLUMNS}


def fails(ego: Actor) -> set[str]:
    return {row["rule_id"] for row in judged([drive([ego], None)], rules=COMFORT) if row["verdict"] == "fail"}


def test_the_error_is_three_times_the_mean_standard_error_or_twice_the_greatest_just_here() -> None:
    speed = 10 + np.random.default_rng(3).normal(0, 0.2, len(T))
    found = motion(straight(speed))
    own = np.full(len(T), np.nan)
    for k in range(2, len(T) - 2):
        t, v = T[k - 2 : k + 3] - T[k], speed[k - 2 : k + 3]
        own[k] = np.sqrt(np.polyfit(t, v, 1, cov=True)[1][0, 0])
    expected = [max(3 * own[k - 10 : k + 11].mean(), 2 * own[k - 2 : k + 3].max()) for k in range(13, len(T) - 13)]
    # the places tell half of the scatter: what they contradict is less than the scatter itself
    assert found["accel_error_mps2"][13:-13] == pytest.approx(expected, rel=1e-3)


def test_scatter_is_no_harsh_acceleration_and_a_launch_is() -> None:
    scatter = 8 + np.random.default_rng(5).normal(0, 0.6, len(T))
    assert np.nanmax(np.abs(motion(straight(scatter))["accel_mps2"])) > 2.4
    assert not fails(straight(scatter))
    launch = np.clip(4.5 * (T - 1), 0, 12)
    assert fails(straight(launch)) >= {"comfort.nuplan", "comfort.accel-iso15622"}


def test_a_velocity_that_the_places_contradict_is_no_harsh_acceleration() -> None:
    steady = STILL + 8.0
    column = 8 + np.clip(4.5 * (T - 2), 0, 5.0)
    found = motion(straight(steady, column=column))
    at = np.searchsorted(T, 2.5)
    assert found["accel_mps2"][at] == pytest.approx(4.5, abs=0.01)
    assert found["accel_error_mps2"][at] == pytest.approx(4.5, abs=0.1)
    assert not fails(straight(steady, column=column)) & {"comfort.accel-iso15622"}


@pytest.mark.parametrize("turns", [1, -1])
def test_a_heading_that_turns_where_the_way_does_not_is_no_bend(turns: int) -> None:
    """The heading of an annotated box is interpolated: 30 degrees in half a second, on a straight way. Left and right."""
    kink = turns * np.radians(30) * np.clip((T - 2.5) / 0.5, 0, 1)
    ego = straight(STILL + 9.0, yaw=kink)
    assert np.nanmax(np.abs(motion(ego)["lat_accel_mps2"])) > 5
    assert not fails(ego)
    bend = turns * 0.5 * np.clip(T - 2, 0, 2.5)
    vx, vy = 9 * np.cos(bend), 9 * np.sin(bend)
    driven = Actor("ego", T, np.cumsum(vx) * 0.1, np.cumsum(vy) * 0.1, bend, vx, vy)
    assert "comfort.lateral" in fails(driven)


@pytest.mark.parametrize(
    ("sensor_range_m", "chosen", "fails_at"),
    [
        (None, [("egos_chosen", "somebody")], 2.8),  # ground truth
        (50.0, [], 2.8),  # the recorder's own ego
        (50.0, [("egos_chosen", "ego")], 2.8),  # it again, among all
        (50.0, [("egos_chosen", "somebody")], 4.3),
        (50.0, [("egos_chosen", None)], 4.3),
        (50.0, [("ego_chosen", "ego")], 4.3),
    ],
)
def test_whom_sensors_measured_accelerates_by_1_6_mps2_more_or_less(
    sensor_range_m: float | None, chosen: list[tuple[str, str | None]], fails_at: float
) -> None:
    """nuPlan's bound is 2.4 m/s2."""

    def fails_by(mps2: float) -> bool:
        scene = drive([straight(2 + mps2 * T)], None, sensor_range_m=sensor_range_m)
        tables, schema = scene.trace.tables, scene.trace.tables["quality"].schema
        about = [
            {"drive_id": "d", "check_id": check_id, "actor_id": name, "severity": "info", "message": "", "n": 1}
            for check_id, name in chosen
        ]
        tables["quality"] = pa.Table.from_pylist(about, schema=schema)
        return any(row["verdict"] == "fail" for row in judged([scene], rules=["comfort.nuplan"]))

    assert fails_by(fails_at)
    assert not fails_by(fails_at - 0.6)


def measured(ego: Actor) -> set[str]:
    """Return the rules of comfort that an ego breaks whom the sensors of somebody else measured."""
    scene = drive([ego], None, sensor_range_m=50.0)
    row = {"drive_id": "d", "check_id": "ego_chosen", "actor_id": "ego", "severity": "info", "message": "", "n": 1}
    scene.trace.tables["quality"] = pa.Table.from_pylist([row], schema=scene.trace.tables["quality"].schema)
    return {row["rule_id"] for row in judged([scene], rules=COMFORT) if row["verdict"] == "fail"}


def test_whom_sensors_measured_gains_speed_as_engines_let_it() -> None:
    assert "comfort.nuplan" in measured(straight(2 + 5.0 * T))
    assert not measured(straight(2 + 7.0 * T))
    assert "comfort.nuplan" in measured(straight(60 - 7.0 * T))


@pytest.mark.parametrize(
    ("aside_mps", "at_s", "expected"),
    [(1.5, 3.4, set()), (0.7, 3.4, {"comfort.nuplan"}), (1.5, 0.6, {"comfort.nuplan"})],
)
@pytest.mark.parametrize("side", [1, -1])
def test_whom_sensors_measured_sliding_sideways_is_not_believed(
    aside_mps: float, at_s: float, expected: set[str], side: int
) -> None:
    """Braking of 7 m/s2 from 3 s on, and 0.6 s of moving sideways at an unchanged heading: by 3 to 8 degrees."""
    speed = np.clip(16 - 7 * np.clip(T - 3, 0, None), 0, None)
    along = straight(speed)
    vy = np.where((at_s <= T) & (at_s + 0.6 >= T), side * aside_mps, 0.0)
    y = np.concatenate([[0.0], np.cumsum((vy[1:] + vy[:-1]) / 2 * 0.1)])
    ego = Actor("ego", T, along.x, y, STILL, speed, vy)
    assert measured(ego) & {"comfort.nuplan"} == expected
