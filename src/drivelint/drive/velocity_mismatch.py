"""Finds short stretches of a track in which the recorded velocity contradicts the positions.

`contradiction` refuses places and velocities that contradict each other by far, `motion` replaces the velocities of a whole track.
Here both are a track, and which of them is right is not known: the place is believed as it is, the velocity is unknown.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.order import integral_per_step, known_motion
from drivelint.drive.velocity import Tracklets, sample_noise

if TYPE_CHECKING:
    from drivelint.arrays import Floats, Mask
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import States


STRETCH_S: Final = 0.5
"""Over so long a time the mean velocity is compared with the way, over two steps at least."""
MISMATCH_MPS: Final = 0.8
MISMATCH_SHARE: Final = 0.05
"""A turning vehicle's rear axle is 0.7 m/s off its middle (1.4 m, 0.5 rad/s), a speedometer 5 %, a filter that is late 0.8 m/s."""
SIGMAS: Final = 4.0
"""And so many standard deviations of the positions' noise."""
SINGLE_STEP_SHARE: Final = 0.75
"""A single step that makes up more of the difference is a step of the positions, of which the velocity knows nothing."""
WHOLE_TRACK_SHARE: Final = 0.5
"""Of a track that contradicts its velocities for longer than this not a stretch is wrong, but what is recorded (see `checks`)."""


def mismatched_samples(states: States, step: Steps) -> Mask:
    """Return the samples (n, in order, velocities complete) of stretches whose velocities contradict their positions."""
    n, numbers = len(states), states.numbers
    found = np.zeros(n, np.bool_)
    k = max(2, round(STRETCH_S * 1e9 / step.period_ns)) if step.period_ns else n
    if n <= k:
        return found
    usable = known_motion(states, step)
    unusable = np.r_[0, np.cumsum(~usable)]
    whole = unusable[k:] == unusable[:-k]
    span = np.where(whole, (states.t_ns[k:] - states.t_ns[:-k]) * 1e-9, np.nan)
    off, fastest = np.zeros(n - k), np.zeros(n - k)
    slack, alone = np.zeros(n - 1), np.zeros(n - 1)
    for place, rate_of in (("x_m", "vx_mps"), ("y_m", "vy_mps")):
        v = numbers[rate_of]
        told = integral_per_step(v, step, usable)
        way = np.r_[0.0, np.cumsum(told)]
        went, led = (numbers[place][k:] - numbers[place][:-k]) / span, (way[k:] - way[:-k]) / span
        off, fastest = np.hypot(off, went - led), np.hypot(fastest, np.maximum(np.abs(went), np.abs(led)))
        alone = np.hypot(alone, np.where(usable, np.diff(numbers[place]) - told, 0.0))
        # what the velocity did between two samples is not known
        slack = np.hypot(slack, np.where(usable, 0.5 * np.abs(np.diff(v)) * step.dt_s, 0.0))
    allowed = MISMATCH_MPS + MISMATCH_SHARE * fastest + _most(slack, k) / span
    with np.errstate(invalid="ignore"):
        wrong = whole & (off > allowed) & (_most(alone, k) < SINGLE_STEP_SHARE * off * span)
    if not wrong.any():
        return found
    runs = Tracklets.from_samples(states.t_ns, numbers["x_m"], numbers["y_m"], step)
    sigma = sample_noise(numbers["x_m"], numbers["y_m"], runs, states.actor)
    with np.errstate(invalid="ignore"):
        wrong &= off > allowed + SIGMAS * np.sqrt(2.0) * sigma[:-k] / span
    rows = np.flatnonzero(wrong)
    edges = np.zeros(n + 1, np.int64)
    np.add.at(edges, rows, 1)
    np.add.at(edges, rows + k + 1, -1)
    found = np.cumsum(edges[:-1]) > 0
    wrong_by_actor, all_by_actor = (
        np.bincount(who, minlength=len(states.ids)) for who in (states.actor[found], states.actor)
    )
    many = wrong_by_actor > WHOLE_TRACK_SHARE * all_by_actor
    return found & ~many[states.actor]


def _most(values: Floats, k: int) -> Floats:
    """Return the largest of every k neighbouring values (m - k + 1 of m)."""
    most: Floats = np.lib.stride_tricks.sliding_window_view(values, k).max(axis=1)
    return most
