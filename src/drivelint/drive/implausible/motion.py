"""Finds motion that is impossible for a road user: a jolt and back, a step aside and back, a turn on the spot, too high a speed.

Doubtful values stay as recorded. The table `doubt` contains the actor, the quantity and the time, and no verdict may depend on these
values. `states` are in order, with completed velocities.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.arrays import wrap_angles
from drivelint.drive.order import integral_per_step, steps_with_known_motion
from drivelint.drive.outliers import samples_near_common_jolts
from drivelint.drive.trace import MOTOR_VEHICLES
from drivelint.drive.velocity import Tracklets, noise_of_samples_m

if TYPE_CHECKING:
    from drivelint.arrays import Floats, Mask
    from drivelint.drive.actors import Actors
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import QualityFinding, States

TYRE_LIMIT_MPS2: Final = 12.0
"""No tyre changes a velocity faster than this, and an impact does not change it back (see `ukhc.contact-signature`)."""
LONGEST_JOLT_SAMPLES: Final = 2
"""A jolt of at most this many samples is a recording error: with central differences, one wrong position affects two velocities."""
LEAST_VELOCITY_CHANGE_OF_JOLT_MPS: Final = 1.0
"""Smaller changes of velocity are within the accuracy of a tracker."""
LEAST_FALSE_STEP_M: Final = 0.5
LEAST_FALSE_STEP_SHARE: Final = 0.15
"""A single step of the positions is a recording error if it is off the velocity by more than 0.5 m + 15 %, and by more than
`LEAST_FALSE_STEP_SIGMAS` standard deviations of the noise."""
LEAST_FALSE_STEP_SIGMAS: Final = 6.0
MOST_REST_SHARE_OF_UNDONE_STEP: Final = 0.3
STEP_UNDONE_WITHIN_NS: Final = 3_000_000_000
"""A step within 3 s reverses an earlier one if their sum is at most 30 % of the earlier one."""
SPIN_LEAST_RAD: Final = np.deg2rad(12.0)
LEAST_TURNING_RADIUS_M: Final = 3.0
SPIN_WINDOW_S: Final = 1.0
SPIN_FASTEST_MPS: Final = 1.0
"""Within a second, a slow vehicle turns by at most its distance divided by 3 m (the smallest turning radius), plus 12 degrees for a
detector's noise."""
FASTEST_SPEED_BY_CLASS_MPS: Final = {"pedestrian": 12.5, "animal": 30.0, "bicycle": 30.0}
"""Class -> its highest possible speed: a sprinter's record, a galloping horse, a descent of racers."""
LEAST_TOO_FAST_SAMPLES: Final = 3


def implausible_motion_findings(
    states: States, step: Steps, actors: Actors, *, derived_velocities: bool
) -> list[QualityFinding]:
    """Return findings and doubts on impossible motion. `derived_velocities`: the velocities are derived from the positions."""
    if len(states) < 3:
        return []
    jolt = _jolt_samples(states, step)
    findings = states.findings(
        jolt,
        "velocity_jolt",
        "warning",
        "velocity jumps and returns, faster than tyres allow, in {n} of {of} states ({ids})",
        quantity="velocity",
    )
    text = (
        "velocities of most actors change alike at the same time, and change back, in {n} of {of} states "
        "({ids}): the times or positions of the log are wrong"
    )
    findings += states.findings(
        samples_near_common_jolts(states, step), "common_jolt", "warning", text, quantity="velocity"
    )
    if not derived_velocities:
        aside = _false_step_samples(states, step)
        text = "position changes sideways, but the velocity shows no such motion, in {n} of {of} states ({ids})"
        findings += states.findings(aside, "position_step", "warning", text, quantity="position")
    spin = _spin_samples(states, step, actors)
    text = "heading turns on the spot, as no vehicle can, in {n} of {of} states ({ids})"
    findings += states.findings(spin, "heading_spin", "warning", text, quantity="heading")
    fast = _too_fast_samples(states, actors)
    return findings + states.findings(
        fast, "class_implausible", "warning", "faster than any actor of their class: {ids}", quantity="class"
    )


def _jolt_samples(states: States, step: Steps) -> Mask:
    """Return the mask of the samples between two opposite changes of velocity that are both too fast for tyres."""
    v = states.velocity
    jolt = np.zeros(len(states), np.bool_)
    change = np.diff(v)
    with np.errstate(invalid="ignore"):
        hard = step.continuous & (
            np.hypot(*change) > np.maximum(TYRE_LIMIT_MPS2 * step.dt_s, LEAST_VELOCITY_CHANGE_OF_JOLT_MPS)
        )
    if not hard.any():
        return jolt
    for width in range(1, LONGEST_JOLT_SAMPLES + 1):
        to, away = slice(0, -width), slice(width, None)
        whole = np.ones(len(change[0]) - width, np.bool_)
        for i in range(width + 1):
            whole &= step.continuous[i : len(step.continuous) - width + i]
        against = np.sum(change[:, to] * change[:, away], axis=0) < 0.0
        # the sum of both changes is possible for an actor in that time
        span_s = sum(step.dt_s[i : len(step.dt_s) - width + i] for i in range(width + 1))
        goes_on = np.hypot(*(v[:, width + 1 :] - v[:, : -width - 1])) <= TYRE_LIMIT_MPS2 * span_s
        first = np.flatnonzero(hard[to] & hard[away] & whole & against & goes_on)
        for i in range(1, width + 1):
            jolt[first + i] = True
    return jolt


def _false_step_samples(states: States, step: Steps) -> Mask:
    """Return the mask of the samples at both ends of false steps: single steps of the positions that the velocities do not show.

    If a later false step reverses one, the samples between them are included.
    """
    aside = np.zeros(len(states), np.bool_)
    usable_steps = steps_with_known_motion(states, step)
    off = np.where(usable_steps, np.diff(states.place) - integral_per_step(states.velocity, step, usable_steps), 0.0)
    size = np.hypot(*off)
    way = np.where(usable_steps, np.hypot(*np.diff(states.place)), 0.0)
    turn = np.where(usable_steps, np.hypot(*np.diff(states.velocity)) * step.dt_s / 2.0, 0.0)
    limit = LEAST_FALSE_STEP_M + LEAST_FALSE_STEP_SHARE * way + turn
    if not (size > limit).any():
        return aside
    sigma = noise_of_samples_m(
        states.place, Tracklets.from_samples(states.t_ns, states.place, step), states.actor, default_m=0.0
    )
    limit = np.maximum(limit, LEAST_FALSE_STEP_SIGMAS * np.sqrt(2.0) * sigma[:-1])
    # only isolated steps count: if the neighbouring steps differ in the same direction, the velocity is wrong
    alone = size > 2.0 * np.maximum(
        _neighbour_error_along_own_error_m(off, size, 1), _neighbour_error_along_own_error_m(off, size, -1)
    )
    # a real step by an impact also changes the velocity
    hit = np.hypot(*np.diff(states.velocity)) > TYRE_LIMIT_MPS2 * step.dt_s
    at = np.flatnonzero((size > limit) & alone & ~hit)
    aside[at] = aside[at + 1] = True
    for a, b in pairwise(at):
        same = states.actor[a] == states.actor[b] and states.t_ns[b] - states.t_ns[a] <= STEP_UNDONE_WITHIN_NS
        if same and np.hypot(*(off[:, a] + off[:, b])) <= MOST_REST_SHARE_OF_UNDONE_STEP * size[a]:
            aside[a + 1 : b + 1] = True
    return aside


def _neighbour_error_along_own_error_m(error: Floats, error_m: Floats, steps_later: int) -> Floats:
    """Return for each step (n - 1) the component of the error of another step along the step's own error, in metres.

    `error`: the errors (2, n - 1); `error_m`: their lengths; `steps_later`: 1 for the step before, -1 for the step after.
    """
    neighbour = np.roll(error, steps_later, axis=1)
    neighbour[:, 0 if steps_later > 0 else -1] = 0.0
    along: Floats = np.sum(neighbour * error, axis=0) / np.where(error_m > 0.0, error_m, 1.0)
    return along


def _spin_samples(states: States, step: Steps, actors: Actors) -> Mask:
    """Return the mask of the samples within one-second windows in which a slow vehicle turns further than its distance allows."""
    spin, n = np.zeros(len(states), np.bool_), len(states)
    k = max(1, round(SPIN_WINDOW_S * 1e9 / step.period_ns)) if step.period_ns else n
    if n <= k:
        return spin
    kinds = dict(zip(actors.ids, actors.classes, strict=True))
    vehicle = np.array([kinds.get(name) in MOTOR_VEHICLES for name in states.ids], np.bool_)[states.actor]
    yaw, place = states.numbers["yaw_rad"], states.place
    same = (
        vehicle[k:]
        & (states.actor[k:] == states.actor[:-k])
        & (states.t_ns[k:] - states.t_ns[:-k] <= 2.0e9 * SPIN_WINDOW_S)
    )
    turn = np.abs(wrap_angles(yaw[k:] - yaw[:-k]))
    way = np.hypot(*(place[:, k:] - place[:, :-k]))
    slow = np.hypot(*states.velocity) < SPIN_FASTEST_MPS
    at = np.flatnonzero(same & slow[k:] & slow[:-k] & (turn > SPIN_LEAST_RAD + way / LEAST_TURNING_RADIUS_M))
    edges = np.zeros(n + 1, np.int64)
    np.add.at(edges, at, 1)
    np.add.at(edges, at + k + 1, -1)
    spin[:] = (np.cumsum(edges[:-1]) > 0) & slow
    return spin


def _too_fast_samples(states: States, actors: Actors) -> Mask:
    """Return the mask of all samples of the actors that exceed the highest speed of their class in at least three samples."""
    kinds = dict(zip(actors.ids, actors.classes, strict=True))
    limits = np.array([FASTEST_SPEED_BY_CLASS_MPS.get(kinds.get(name) or "", np.inf) for name in states.ids])
    over = np.hypot(*states.velocity) > limits[states.actor]
    is_often = np.bincount(states.actor[over], minlength=len(states.ids)) >= LEAST_TOO_FAST_SAMPLES
    return is_often[states.actor]
