"""Velocities from positions: exact ones by central differences, noisy ones by a filter whose error is known."""

from __future__ import annotations

import numpy as np
import pytest

from drivelint.drive.order import Steps
from drivelint.drive.velocity import LARGEST_VELOCITY_ERROR_MPS, DerivedVelocity, derive_velocities


def of(t: np.ndarray, x: np.ndarray, y: np.ndarray | None = None) -> DerivedVelocity:
    t_ns = np.round(t * 1e9).astype(np.int64)
    dt = np.diff(t_ns)
    period = int(np.median(dt))
    same = np.ones(len(dt), np.bool_)
    step = Steps(same, dt * 1e-9, same & (dt <= 2.5 * period), period, np.full(len(t_ns), period))
    return derive_velocities(
        t_ns, np.zeros(len(t), np.int32), np.stack([x, np.zeros_like(x) if y is None else y]), step
    )


def noisy(values: np.ndarray, sigma: float, seed: int = 1) -> np.ndarray:
    found: np.ndarray = values + np.random.default_rng(seed).normal(0.0, sigma, values.shape)
    return found


RATES = pytest.mark.parametrize("hertz", [5, 10, 20, 50])


@RATES
def test_exact_positions_give_central_differences(hertz: int) -> None:
    """Braking, turning and standing: nothing is filtered, a stop is seen to the sample."""
    t = np.arange(20 * hertz) / hertz
    v = np.clip(15 - 6 * np.clip(t - 5, 0, None), 0, None)
    x = np.cumsum(v) / hertz
    found = of(t, x, 0.5 * t)
    assert not found.filtered.any()
    assert found.v_mps[0][1:-1] == pytest.approx((x[2:] - x[:-2]) * hertz / 2)
    turn = of(t, 30 * np.cos(t / 2), 30 * np.sin(t / 2))
    assert not turn.filtered.any()


@RATES
@pytest.mark.parametrize("sigma", [0.01, 0.02, 0.05, 0.1])
def test_who_stands_in_noise_stands(hertz: int, sigma: float) -> None:
    t = np.arange(30 * hertz) / hertz
    found = of(t, noisy(np.zeros_like(t), sigma), noisy(np.zeros_like(t), sigma, 2))
    known = np.isfinite(found.v_mps[0])
    assert (np.hypot(*found.v_mps)[known] == 0.0).mean() > 0.9
    assert np.abs(found.v_mps[0][known]).max() <= 0.5


@RATES
@pytest.mark.parametrize("sigma", [0.005, 0.02, 0.05, 0.1])
def test_the_error_of_a_moving_one_is_as_said_or_it_is_unknown(hertz: int, sigma: float) -> None:
    t = np.arange(60 * hertz) / hertz
    found = of(t, noisy(12 * t, sigma), noisy(np.zeros_like(t), sigma, 2))
    known = np.isfinite(found.v_mps[0])
    off = np.abs(found.v_mps[0][known] - 12.0)
    assert np.sqrt((off**2).mean()) < LARGEST_VELOCITY_ERROR_MPS / 2
    assert off.max() < 2 * LARGEST_VELOCITY_ERROR_MPS
    assert known[2 * hertz : -2 * hertz].mean() > (0.9 if sigma <= 0.05 or hertz >= 10 else 0.0)


def test_what_no_filter_tells_is_unknown() -> None:
    t = np.arange(300) / 10
    found = of(t, noisy(12 * t, 1.0))
    assert np.isnan(found.v_mps[0]).all()
    assert found.filtered.all()


def test_a_hole_is_not_filtered_over() -> None:
    """Twenty metres are jumped in a second without samples: on neither side of it a velocity has anything of that."""
    t = np.concatenate([np.arange(100), np.arange(110, 200)]) / 10
    x = noisy(np.where(t < 10.5, 0.0, 20.0), 0.05)
    found = of(t, x, noisy(np.zeros_like(t), 0.05, 2))
    assert np.nanmax(np.abs(found.v_mps[0])) <= 0.5
