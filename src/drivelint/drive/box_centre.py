"""From the point of a vehicle that a log's positions refer to, to the centre of its box: the one place where this is worked out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drivelint.arrays import turned, wrapped
from drivelint.drive.order import steps, time_derivative

if TYPE_CHECKING:
    from drivelint.arrays import Floats
    from drivelint.drive.trace import States


def lever_to_centre(forward: Floats, left: Floats, yaw: Floats) -> Floats:
    """Return the way from the reference point to the box centre along the axes of the log (2, n), in metres.

    `forward` and `left` (n): how far the centre lies ahead and to the left of the point, in metres; `yaw` (n): headings in radians. A
    centre that lies in the point itself needs no heading.
    """
    lever = np.stack(turned(forward, left, yaw))
    lever[:, (forward == 0.0) & (left == 0.0)] = 0.0
    return lever


def velocity_of_centre(velocity: Floats, lever: Floats, yaw_rate: Floats) -> Floats:
    """Return the velocities (2, n) in m/s of the box centre of a vehicle that turns about its reference point by `yaw_rate` (n) rad/s.

    Where the rate is not known, as of a single sample, the velocity is that of the reference point.
    """
    turning = np.where(np.isnan(yaw_rate), 0.0, yaw_rate)
    moved = np.any(lever != 0.0, axis=0)
    return np.where(moved, velocity + turning * np.stack([-lever[1], lever[0]]), velocity)


def yaw_rates(states: States, yaw: Floats) -> Floats:
    """Differentiate headings (n, radians) along each actor's track, rows in any order; NaN where there is no neighbour."""
    order = np.lexsort((states.t_ns, states.actor))
    step = steps(states.take(order))
    along = yaw[order]
    with np.errstate(invalid="ignore"):
        turns = wrapped(np.diff(along)) - np.diff(along)
    # a new track or an unknown heading starts afresh: its sum of turns must not carry over
    unwrapped = along + np.r_[0.0, np.cumsum(np.where(step.same & np.isfinite(turns), turns, 0.0))]
    rates = np.empty(len(states))
    rates[order] = time_derivative(unwrapped, step)
    return rates
