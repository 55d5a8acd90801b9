"""The rate of the samples decides nothing: what fails at 20 Hz neither passes nor disappears at 10 or 5 Hz, and the other way round."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.scenes import drive, moving, road, times, verdict_rows

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

RATES = (20, 10, 5)


def braking(rate: int, hardest_mps2: float, ramp_s: float, then_mps2: float = 0.0) -> Drive:
    """Return an ego that brakes for 3 s, after a ramp of so many seconds, and then accelerates, at this rate."""
    way = road(((900.0, 0.0),))
    fine = np.arange(0, 14.0001, 0.001)
    moments = [0, 4, 4 + ramp_s, 7 + ramp_s, 7 + 2 * ramp_s, 10]
    accel = np.interp(fine, moments, [0, 0, -hardest_mps2, -hardest_mps2, then_mps2, 0])
    speed = 25 + np.cumsum(accel) * 0.001
    place = 50 + np.cumsum(speed) * 0.001
    t = times(14.0, period=1 / rate)
    ego = moving("ego", way, t, np.interp(t, fine, place), way.ego_d)
    return drive([ego], way.environment, drive_id=f"{rate} Hz")


@pytest.mark.sample(2, ci=2)
@pytest.mark.parametrize(
    ("hardest_mps2", "ramp_s", "then_mps2", "verdict"),
    [
        (2.6, 0.2, 0.0, "pass"),  # 13 m/s3, but over less than nuPlan's window
        (3.4, 0.5, 0.0, "pass"),
        (3.4, 0.8, 0.0, "pass"),
        (3.9, 0.3, 2.0, "fail"),  # the jerk alone is too much
        (4.5, 2.0, 0.0, "fail"),
        (6.0, 0.5, 0.0, "fail"),
    ],
)
def test_comfort(hardest_mps2: float, ramp_s: float, then_mps2: float, verdict: str) -> None:
    rows = verdict_rows([braking(rate, hardest_mps2, ramp_s, then_mps2) for rate in RATES], rules=["comfort.nuplan"])
    assert {row["drive_id"]: row["verdict"] for row in rows} == {f"{rate} Hz": verdict for rate in RATES}
    assert len(rows) == len(RATES)
