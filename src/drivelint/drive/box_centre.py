"""Converts positions and velocities from a vehicle's reference point, as in the log, to the centre of its box."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drivelint.arrays import rotate_vectors, wrap_angles
from drivelint.drive.order import steps, time_derivative

if TYPE_CHECKING:
    from drivelint.arrays import Floats
    from drivelint.drive.trace import States


def lever_to_centre(forward_m: Floats, left_m: Floats, yaw_rad: Floats) -> Floats:
    """Return the vectors (2, n) in metres from the reference point to the box centre, along the axes of the log.

    `forward_m` and `left_m` (n): how far the centre is ahead and to the left of the point, in metres; `yaw_rad` (n): headings in radians.
    If both distances are 0, the heading may be unknown.
    """
    lever = np.stack(rotate_vectors(forward_m, left_m, yaw_rad))
    lever[:, (forward_m == 0.0) & (left_m == 0.0)] = 0.0
    return lever


def velocity_of_centre(velocity: Floats, lever: Floats, yaw_rate_radps: Floats) -> Floats:
    """Return the velocities (2, n) in m/s of the box centre, given those of the reference point.

    `lever` (2, n): from the point to the centre, in metres. `yaw_rate_radps` (n): in rad/s; if unknown, as for a single sample, it counts
    as 0.
    """
    turning = np.where(np.isnan(yaw_rate_radps), 0.0, yaw_rate_radps)
    has_lever = np.any(lever != 0.0, axis=0)
    return np.where(has_lever, velocity + turning * np.stack([-lever[1], lever[0]]), velocity)


def yaw_rates(states: States, yaw_rad: Floats) -> Floats:
    """Return the time derivative of headings (n, radians) along each actor's track; NaN for samples without a neighbour.

    The rows may be in any order.
    """
    order = np.lexsort((states.t_ns, states.actor))
    step = steps(states.take(order))
    along = yaw_rad[order]
    with np.errstate(invalid="ignore"):
        turns = wrap_angles(np.diff(along)) - np.diff(along)
    # a step to another track or to an unknown heading must not change the sum of full turns
    unwrapped = along + np.r_[0.0, np.cumsum(np.where(step.same_actor & np.isfinite(turns), turns, 0.0))]
    rates = np.empty(len(states))
    rates[order] = time_derivative(unwrapped, step)
    return rates
