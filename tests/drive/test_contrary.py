"""Where recorded velocities lead elsewhere than the positions for a stretch, the velocity is unknown and the place is not."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from tests.drive.actor_traces import checks, column, read, unknown
from tests.scenes import Actor, moving, road, times
from tests.shared_data import shared

WAY: Final = road(((2000.0, 0.0),))
T: Final = times(10.0)


def bumped(peak_mps: float, first_s: float = 4.0, last_s: float = 4.7, speed: float = 8.0) -> Actor:
    """Return who drives steadily, and whose recorded speed swells by so much in between."""
    other = moving("x", WAY, T, 200 + speed * T, WAY.ego_d)
    swell = np.where((first_s < T) & (last_s > T), np.sin(np.pi * (T - first_s) / (last_s - first_s)), 0.0)
    return replace(other, vx=other.vx + peak_mps * swell)


@pytest.mark.parametrize("peak", [2.0, 4.0, -2.5])
def test_a_speed_that_swells_for_half_a_second_is_unknown_and_the_place_is_not(peak: float) -> None:
    trace = read(bumped(peak))
    lost = np.flatnonzero(np.isnan(column(trace, "vx_mps"))).tolist()
    assert set(range(42, 46)) <= set(lost) <= set(range(37, 51))
    assert not unknown(trace)
    assert "velocity_unknown" in checks(trace)
    assert np.nanmax(np.abs(column(trace, "vx_mps") - 8.0)) < 1.0


def test_what_a_recorder_does_is_believed() -> None:
    """Noise, a late filter, the speed of the rear axle in a turn, a speedometer 5 % off, a full stop within one sample."""
    rng = np.random.default_rng(2)
    plain = moving("x", WAY, T, 200 + np.cumsum(12 - 3 * np.clip(T - 4, 0, 2)) * 0.1, WAY.ego_d)
    noisy = replace(plain, x=plain.x + rng.normal(0, 0.1, len(T)), vx=plain.vx + rng.normal(0, 0.3, len(T)))
    late = replace(plain, vx=np.interp(T - 0.2, T, plain.vx))
    axle = replace(plain, vy=plain.vy + 0.7)
    scaled = replace(plain, vx=plain.vx * 1.05)
    stops = replace(moving("x", WAY, T, 200 + 20 * np.minimum(T, 5.0), WAY.ego_d), vx=np.where(T < 5.0, 20.0, 0.0))
    for actor in (plain, noisy, late, axle, scaled, stops):
        assert not checks(read(actor)) & {"velocity_unknown"}
        assert not np.isnan(column(read(actor), "vx_mps")).any()


def test_a_step_of_the_positions_is_no_wrong_velocity() -> None:
    other = moving("x", WAY, T, 200 + 10 * T, WAY.ego_d)
    put_right = replace(other, x=other.x + 0.9 * (T > 4.95))
    assert "velocity_unknown" not in checks(read(put_right))


def test_lankers_speeds_that_its_positions_contradict() -> None:
    """1221 is recorded with up to 11.3 m/s from 2.0 to 2.4 s, where its positions go on at 7.2 m/s."""
    log = shared("commonroad/USA_Lanker-1_1_T-1.xml")
    trace = read_trace(log, IngestOptions(need_ego=False))
    rows = {row["t_ns"]: row for row in trace.tables["actor_state"].to_pylist() if row["actor_id"] == "1221"}
    assert all(
        rows[round(t * 1e8)]["vx_mps"] is None and rows[round(t * 1e8)]["x_m"] is not None for t in (20, 21, 22, 23, 24)
    )
    assert all(rows[round(t * 1e8)]["vx_mps"] is not None for t in (10, 15, 30, 35))
