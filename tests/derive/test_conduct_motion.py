"""The ego's own motion: filtered as said, against numpy's least squares; nothing where the window is not whole."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.scenes import Actor, derived, drive, rows, times

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

COLUMNS = ("v_long_mps", "accel_mps2", "lat_accel_mps2", "jerk_mps3", "accel_2s_mps2", "jerk_1s_mps3")
PEAKS = ("accel_peak_mps2", "lat_peak_mps2")


def free(t: Floats, speed: Floats, yaw: Floats, slip: float = 0.0) -> Actor:
    """Return an ego with this speed along its heading, and `slip` across it."""
    vx, vy = speed * np.cos(yaw) - slip * np.sin(yaw), speed * np.sin(yaw) + slip * np.cos(yaw)
    x, y = np.cumsum(vx) * (t[1] - t[0]), np.cumsum(vy) * (t[1] - t[0])
    return Actor("ego", t, x, y, np.remainder(yaw + math.pi, 2 * math.pi) - math.pi, vx, vy)


def slope(t: Floats, y: Floats, half: float, share: float = 0.7) -> Floats:
    """Least-squares slope around each sample; NaN where the samples do not reach `share` of `half` to both sides, or one is NaN."""
    found = np.full(t.shape, np.nan)
    for k, at in enumerate(t):
        near = np.abs(t - at) <= half + 1e-9
        if (
            at - t[near].min() >= share * half - 1e-9
            and t[near].max() - at >= share * half - 1e-9
            and np.isfinite(y[near]).all()
        ):
            found[k] = np.polyfit(t[near] - at, y[near], 1)[0]
    return found


def columns(ego: Actor) -> dict[str, Floats]:
    found = rows(derived(drive([ego], None), tables=["ego_motion"]), "FROM ego_motion ORDER BY t_ns")
    return {name: np.array([row[name] for row in found], float) for name in (*COLUMNS, *PEAKS)}


@pytest.mark.parametrize("period", [0.02, 0.05, 0.1, 0.15, 0.2])
def test_slopes_are_those_of_numpy(period: float) -> None:
    """A weaving, braking ego that turns round more than once; a jittering clock."""
    rng = np.random.default_rng(7)
    t = times(9.0, period=period) + rng.uniform(-0.02, 0.02, len(times(9.0, period=period))) * period
    t = np.round(t, 9) - np.round(t.min(), 9)
    speed = 12 + 3 * np.sin(t) + rng.normal(0, 0.02, len(t))
    yaw = 1.1 * t + 0.2 * np.sin(2 * t)
    found = columns(free(t, speed, yaw, slip=0.4))
    half = max(0.25, 2.2 * float(np.median(np.diff(t))))
    accel, turning = slope(t, speed, half), slope(t, yaw, half)
    jerk = slope(t, accel, 0.7, 0.59 / 0.7)
    assert found["v_long_mps"] == pytest.approx(speed, abs=1e-9)
    assert found["accel_mps2"] == pytest.approx(accel, abs=1e-6, nan_ok=True)
    assert found["lat_accel_mps2"] == pytest.approx(speed * turning, abs=1e-5, nan_ok=True)
    assert found["jerk_mps3"] == pytest.approx(jerk, abs=1e-5, nan_ok=True)
    for name, value, back in (("accel_2s_mps2", speed, 2.0), ("jerk_1s_mps3", accel, 1.0)):
        first = np.searchsorted(t, t - back - 1e-9)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = np.where(t - t[0] >= back - 1e-9, (value - value[first]) / (t - t[first]), np.nan)
        assert found[name] == pytest.approx(mean, abs=1e-6, nan_ok=True)
        assert np.isfinite(mean).any()


@pytest.mark.ci
@pytest.mark.parametrize("seed", range(4))
def test_the_jerk_does_not_depend_on_the_rate(seed: int) -> None:
    """A drive of smooth random accelerations, at 20, 10 and 5 Hz."""
    rng = np.random.default_rng(seed)
    parts = [(rng.uniform(0.3, 1.2), rng.uniform(0.5, 4.0), rng.uniform(0, 6)) for _ in range(4)]
    found = {}
    for period in (0.05, 0.1, 0.2):
        t = times(16.0, period=period)
        speed = 20 + np.sum([a * np.sin(w * t + p) for a, w, p in parts], axis=0)
        found[period] = columns(free(t, speed, np.zeros(t.shape)))["jerk_mps3"][:: round(0.2 / period)]
    whole = np.isfinite(found[0.2])
    assert whole.sum() > 60
    most = float(np.nanmax(np.abs(found[0.05])))
    assert np.abs(found[0.1] - found[0.05])[whole].max() < 0.04 * most
    assert np.abs(found[0.2] - found[0.05])[whole].max() < 0.12 * most


@pytest.mark.parametrize("rises", [0.5, 0.7, 1.5])
@pytest.mark.parametrize("shape", ["pointed", "round"])
def test_a_peak_is_not_hidden_by_the_filter(shape: str, rises: float) -> None:
    """What the filter shows of a peak is too low; with what it may have flattened it is not."""
    t = times(12.0, period=0.05)
    middle = 6.0

    def bump(at: Floats) -> Floats:
        far = np.abs(at - middle) / rises
        return np.where(far < 1, 1 - far if shape == "pointed" else (1 + np.cos(math.pi * far)) / 2, 0.0)

    fine = np.linspace(0, t[-1], 20 * (len(t) - 1) + 1)
    total = np.concatenate([[0], np.cumsum((bump(fine[1:]) + bump(fine[:-1])) / 2 * np.diff(fine))])
    gained = np.interp(t, fine, total)
    along = columns(free(t, 20 - 3 * gained, np.zeros(t.shape)))
    across = columns(free(t, np.full(t.shape, 10.0), 0.3 * gained))
    for found, value, peak in ((along, "accel_mps2", "accel_peak_mps2"), (across, "lat_accel_mps2", "lat_peak_mps2")):
        seen = np.abs(found[value])
        assert np.nanmax(seen) < 2.99
        assert np.nanmax(seen + found[peak]) >= 3.0 - 1e-6
        assert np.nanmax(seen + found[peak]) < 3.0 * (1 + 0.2 / rises)
