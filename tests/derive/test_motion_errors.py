"""How far off the ego's filtered motion may be: against numpy's standard errors, and against another reading of the same motion."""

from __future__ import annotations

import numpy as np
import pytest

from tests.scenes import Actor, derived, drive, rows, times, verdict_rows

T = times(6.0, period=0.1)
STILL = np.zeros(len(T))
COLUMNS = ("accel_mps2", "lat_accel_mps2", "accel_error_mps2", "lat_error_mps2", "jerk_error_mps3")
COMFORT = ("comfort.lateral", "comfort.accel-iso15622", "comfort.nuplan")


def straight(speed: np.ndarray, *, yaw: np.ndarray = STILL) -> Actor:
    """Return an ego whose places follow `speed` along x, whatever the column of its heading says."""
    x = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * 0.1)])
    return Actor("ego", T, x, STILL.copy(), yaw, speed, STILL.copy())


def motion(ego: Actor) -> dict[str, np.ndarray]:
    found = rows(derived(drive([ego], None), tables=["ego_motion"]), "FROM ego_motion ORDER BY t_ns")
    return {name: np.array([row[name] for row in found], float) for name in COLUMNS}


def fails(ego: Actor) -> set[str]:
    return {row["rule_id"] for row in verdict_rows([drive([ego], None)], rules=COMFORT) if row["verdict"] == "fail"}


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
