"""The change of velocity over a contact, of velocities that are known."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from drivelint.drive.finish import with_quality_finding
from drivelint.drive.trace import QualityFinding
from drivelint.incident.delta_v import delta_v_text, greatest_delta_v
from drivelint.incident.motion import MotionOfParties
from tests.incident.straight import STEP_S, steps

if TYPE_CHECKING:
    from tests.incident.conftest import CaseOf

BEFORE = 9
"""The step before the contact, which is at 1 s."""


def struck(*after: tuple[float, float], n: int = 20) -> MotionOfParties:
    """Return an ego that drives east at 5 m/s until 1 s, then has these velocities, the last of them to the end."""
    motion = MotionOfParties.of_steps(steps(np.full(n, 5.0), np.arange(n) * 5.0 * STEP_S, 300.0), 1_000_000_000)
    velocity = np.array([(5.0, 0.0)] * (BEFORE + 1) + [*after] + [after[-1]] * n, np.float64)[:n].T
    return replace(motion, velocity=(velocity, motion.velocity[1]))


def test_a_vehicle_that_is_thrown_back_or_aside_changes_its_velocity_by_more_than_its_speed() -> None:
    back = greatest_delta_v(struck((-1.0, 0.0), (0.5, 0.0)), 0, BEFORE)
    assert back is not None
    assert (back.mps, back.at_s) == pytest.approx((6.0, 0.0))
    assert not back.is_least
    aside = greatest_delta_v(struck((4.0, 1.0), (0.0, 5.0)), 0, BEFORE)  # the speed is the same
    assert aside is not None
    assert (aside.mps, aside.at_s) == pytest.approx((math.hypot(5.0, 5.0), 0.1))


def test_what_comes_after_the_impact_is_none_of_it() -> None:
    found = greatest_delta_v(struck((4.0, 0.0), (4.0, 0.0), (4.0, 0.0), (4.0, 0.0), (0.0, 0.0)), 0, BEFORE)
    assert found is not None
    assert found.mps == pytest.approx(1.0)


def test_a_velocity_that_is_missing_leaves_it_unknown() -> None:
    for after in ([(0.0, np.nan)], [(0.0, 0.0), (np.nan, 0.0), (0.0, 0.0)]):
        assert greatest_delta_v(struck(*after), 0, BEFORE) is None
    hole = struck((0.0, 0.0))
    rows = np.array([i for i in range(20) if i not in {11, 12}])
    hole = replace(hole, t=hole.t[rows], velocity=(hole.velocity[0][:, rows], hole.velocity[1][:, rows]))
    assert greatest_delta_v(hole, 0, BEFORE) is None
    assert greatest_delta_v(struck((0.0, 0.0), n=BEFORE + 1), 0, BEFORE) is None
    assert greatest_delta_v(replace(struck((0.0, 0.0)), velocity=(np.full((2, 20), np.nan),) * 2), 1, BEFORE) is None


def test_a_recording_that_ends_in_the_impact_gives_a_bound() -> None:
    found = greatest_delta_v(struck((0.0, 0.0), n=BEFORE + 2), 0, BEFORE)
    assert found is not None
    assert found.mps == pytest.approx(5.0)
    assert found.is_least


@pytest.mark.slow
def test_words(case_of: CaseOf) -> None:
    trace, motion = case_of("no-collision@collision").drive.trace, struck((-1.0, 0.0), (0.5, 0.0))

    def text(check: str, actor_id: str | None) -> str:
        mine = with_quality_finding(trace, QualityFinding(check, "warning", "said", actor_id=actor_id))
        return delta_v_text(motion, 0, BEFORE, mine, "ego")

    assert (
        text("gap", None)
        == "6.0 m/s (22 km/h, 13 mph), from \u22120.10 s to 0 s: 5.0 to 1.0 m/s, direction changed by 180\u00b0"
    )
    assert text("velocity_filtered", "ego").startswith("not known: the log has only a mean")
    assert text("velocity_filtered", "somebody else") == text("gap", None)
    assert text("velocity_derived", None).endswith("; velocities computed from positions")
    assert delta_v_text(motion, 0, None, trace, "ego") == ""
    short = delta_v_text(struck((0.0, 0.0), n=BEFORE + 2), 0, BEFORE, trace, "ego")
    assert short.startswith("at least 5.0 m/s")
    unknown = delta_v_text(struck((np.nan, 0.0)), 0, BEFORE, trace, "ego")
    assert unknown == "not known: its velocity is missing in part, from \u22120.10 s to +0.30 s"


@pytest.mark.ci
@pytest.mark.parametrize(
    ("after", "ending"),
    [
        ((3.0, 4.0), ": 5.0 to 5.0 m/s, direction changed by 53\u00b0, which may be steering"),
        ((1.0, 1.0), ": 5.0 to 1.4 m/s, direction changed by 45\u00b0"),
        ((1.0, 0.0), ""),
        ((4.8, 0.2), ""),
    ],
)
def test_a_change_of_direction_alone_may_be_steering(case_of: CaseOf, after: tuple[float, float], ending: str) -> None:
    trace = case_of("no-collision@collision").drive.trace
    said = delta_v_text(struck(after), 0, BEFORE, trace, "ego")
    assert said.endswith(f"to 0 s{ending}")
