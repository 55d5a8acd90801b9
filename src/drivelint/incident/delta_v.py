"""The change of velocity (delta-v) of a party in a contact: the length of the difference of its velocity vectors before and after."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.incident.words import speed_text, text_with_minus_signs

if TYPE_CHECKING:
    from drivelint.drive.trace import Trace
    from drivelint.incident.motion import MotionOfParties

IMPACT_WINDOW_S: Final = 0.3
"""The time after the beginning of an impact in which crash recorders record the greatest change of velocity (49 CFR 563.7)."""
_LEAST_TURN_DEGREES: Final = 5.0
_LEAST_MEANINGFUL_SPEED_MPS: Final = 0.5
"""The direction of a smaller velocity, or of a smaller change of velocity, is not meaningful."""
_MOST_STEPS_BETWEEN_SAMPLES: Final = 2.5
"""If samples are farther apart than this many usual steps, there is a gap, as in the rules (`max_gap`)."""


class DeltaV(NamedTuple):
    """The greatest change of velocity in m/s, and its time in seconds from the moment.

    `is_least`: the recording ends within the window, so the change may have been greater.
    """

    mps: float
    at_s: float
    is_least: bool


def greatest_delta_v(motion: MotionOfParties, party: int, step_before: int) -> DeltaV | None:
    """Return the greatest change of a party's velocity vector since the step `step_before`, up to 0.3 s after the moment.

    The step after `step_before` counts even if it is later than that. None: a velocity in that time is not known or not recorded.
    """
    t, v = motion.t, motion.velocity[party]
    window = np.flatnonzero((t <= IMPACT_WINDOW_S + 1e-9) & (np.arange(len(t)) > step_before))
    window = window if window.size else np.arange(step_before + 1, min(step_before + 2, len(t)))
    change = np.hypot(*(v[:, window] - v[:, [step_before]]))
    steps = np.diff(t[step_before : step_before + 1 + window.size])
    if not window.size or np.isnan(change).any() or (steps > _MOST_STEPS_BETWEEN_SAMPLES * motion.step_s + 1e-9).any():
        return None
    i = int(change.argmax())
    return DeltaV(float(change[i]), float(t[window[i]]), bool(t[-1] + motion.step_s <= IMPACT_WINDOW_S + 1e-9))


def delta_v_text(motion: MotionOfParties, party: int, step_before: int | None, trace: Trace, actor_id: str) -> str:
    """Return the change of velocity in a contact with its interval in words, or why it is not known; '' if there is no contact."""
    if step_before is None:
        return ""
    rows = trace.tables["quality"].to_pylist()
    checks = {row["check_id"] for row in rows if row["actor_id"] in {None, actor_id}}
    if "velocity_filtered" in checks:
        return "not known: the log has only a mean of its velocity, which hides an impact"
    change = greatest_delta_v(motion, party, step_before)
    if change is None:
        return (
            f"not known: its velocity is missing in part, from {_signed_time_text(motion.t[step_before])} "
            f"to {_signed_time_text(IMPACT_WINDOW_S)}"
        )
    least = "at least " if change.is_least else ""
    derived = "; velocities computed from positions" if "velocity_derived" in checks else ""
    turned = _speeds_and_course_text(motion, party, step_before, change)
    return (
        f"{least}{speed_text(change.mps)}, from {_signed_time_text(motion.t[step_before])} "
        f"to {_signed_time_text(change.at_s)}{turned}{derived}"
    )


def _speeds_and_course_text(motion: MotionOfParties, party: int, step_before: int, velocity_change: DeltaV) -> str:
    """Return speeds and change of direction in words; '' if the direction did not change.

    The text mentions steering if direction changed more than speed.
    """
    v = motion.velocity[party][:, [step_before, int(np.abs(motion.t - velocity_change.at_s).argmin())]]
    first, last = np.hypot(*v).tolist()
    if velocity_change.mps < _LEAST_MEANINGFUL_SPEED_MPS or min(first, last) < _LEAST_MEANINGFUL_SPEED_MPS:
        return ""
    angle = math.degrees(math.acos(float(np.clip(v[:, 0] @ v[:, 1] / (first * last), -1.0, 1.0))))
    if angle < _LEAST_TURN_DEGREES:
        return ""
    steering = ", which may be steering" if abs(last - first) <= velocity_change.mps / 2 else ""
    return f": {first:.1f} to {last:.1f} m/s, direction changed by {angle:.0f}\u00b0{steering}"


def _signed_time_text(s: float) -> str:
    return text_with_minus_signs(f"{s:+.2f} s") if abs(s) >= 5e-3 else "0 s"
