"""Finds single samples off their track, and small steps of a track, that no motion explains.

`jumps` recognises jumps of metres by their length. A step back by half a metre would also cause a wrong derived velocity. This module
recognises it by the samples around it and by the noise of the positions. It also finds jolts that most actors have at the same moment,
which are errors of the log.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.order import extent_by_track, track_starts
from drivelint.drive.velocity import (
    LEAST_POSITION_SPREAD_OF_MOVING_ACTOR_M,
    LEAST_SAMPLES_TO_ESTIMATE_NOISE,
    Tracklets,
    noise_of_samples_m,
)

if TYPE_CHECKING:
    from drivelint.arrays import Floats, Mask
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import States

    # the mean velocities (2, n - 1) and times (n - 1) between neighbouring samples; NaN across holes and between tracks
    _Moves = tuple[Floats, Floats]


TYRE_LIMIT_MPS2: Final = 12.0
"""No vehicle changes its velocity faster than this and back again (see `ukhc.contact-signature`); an impact does not change it back."""
MOST_VELOCITY_CHANGE_SHARE_AT_FALSE_STEP: Final = 0.25
"""At a false step, the velocities before and after it differ by at most this share of the velocity change that the step seems to have."""
LEAST_JOLTED_ACTORS: Final = 4
"""If at least this many moving actors change speed by the same share at one moment, the log's times or positions are wrong."""
LEAST_SHARE_OF_ACTORS_IN_COMMON_JOLT: Final = 0.8
LEAST_SPEED_CHANGE_IN_COMMON_JOLT: Final = 0.12
MOST_SPEED_RATIO_SPREAD_IN_COMMON_JOLT: Final = 0.08
"""The limits of a common jolt. For each actor, the ratio of its speed to its speed `JOLT_COMPARISON_NS` before and after is computed.

At a common jolt, the median of these ratios differs from 1 by more than `LEAST_SPEED_CHANGE_IN_COMMON_JOLT`, and at least
`LEAST_SHARE_OF_ACTORS_IN_COMMON_JOLT` of the actors have a ratio within `MOST_SPEED_RATIO_SPREAD_IN_COMMON_JOLT` of the median."""
JOLT_COMPARISON_NS: Final = 300_000_000
AFFECTED_AROUND_JOLT_NS: Final = 500_000_000
"""Values derived from velocities, such as accelerations and jerks, are also wrong within this time before and after a common jolt."""
LEAST_SPEED_OF_JOLTED_ACTOR_MPS: Final = 1.0
"""For slower actors, relative changes of speed are noise."""
OUTLIER_SIGMAS: Final = 6.0
"""A sample is an outlier only if it is off by this many standard deviations of the position noise."""
LEAST_FALSE_STEP_BOUNDS_M: Final = (0.05, 0.25)
"""With derived velocities, a step counts if it is longer than 24 m/s2 dt2, clipped to these bounds (m): shorter steps cause no jolt of
12 m/s2."""
LEAST_FALSE_STEP_WITH_RECORDED_VELOCITY_M: Final = 0.4
"""With recorded velocities, a step affects the position only; shorter steps are within the accuracy of boxes."""
PIECE_ROWS = 1 << 18
"""The number of samples that are processed together, to limit memory."""
_PIECE_OVERLAP_ROWS: Final = 8
"""The number of samples by which a piece of `PIECE_ROWS` is extended on each side, more than a decision needs."""


def outlier_samples(states: States, step: Steps) -> Mask:
    """Return the mask of the samples (n, in order) that are off their track or at a false step of it.

    A sample is off its track if the two samples before and the two after form a possible motion without it, and it is too far from that
    motion. Without a recorded velocity, a step is false if it differs equally from the motion before and after it.
    """
    n = len(states)
    no_samples = np.zeros(n, np.bool_)
    if n < LEAST_SAMPLES_TO_ESTIMATE_NOISE or not {"x_m", "y_m"} <= states.numbers.keys():
        return no_samples
    place = states.place
    has_velocity = _has_recorded_velocity(states, place)
    dt_s = np.where(step.continuous & (step.dt_s > 0.0), step.dt_s, np.nan)
    # estimating noise is slow: skip it if there is no outlier even under the assumption of zero noise
    if not _outliers_by_piece(place, dt_s, has_velocity, np.broadcast_to(0.0, n), np.broadcast_to(np.inf, n)).any():
        return no_samples
    runs = Tracklets.from_samples(states.t_ns, place, step)
    sigma = noise_of_samples_m(place, runs, states.actor)
    return _outliers_by_piece(place, dt_s, has_velocity, sigma, sigma)


def _outliers_by_piece(
    place: Floats, dt_s: Floats, has_velocity: Mask, noise_m: Floats, motion_noise_m: Floats
) -> Mask:
    """Return the mask of the outliers, piece by piece, because each piece needs about thirty arrays of its length."""
    n = len(has_velocity)
    outliers = np.zeros(n, np.bool_)
    for first in range(0, n, PIECE_ROWS):
        begin, end = max(0, first - _PIECE_OVERLAP_ROWS), min(n, first + PIECE_ROWS + _PIECE_OVERLAP_ROWS)
        rows, dt = slice(begin, end), dt_s[begin : end - 1]
        moves = np.diff(place[:, rows], axis=1) / dt, dt
        beside = _samples_off_path(place[:, rows], moves, has_velocity[rows], noise_m[rows], motion_noise_m[rows])
        piece = beside | _samples_at_false_steps(moves, has_velocity[rows], noise_m[rows], motion_noise_m[rows], beside)
        outliers[first : first + PIECE_ROWS] = piece[first - begin :][:PIECE_ROWS]
    return outliers


def _has_recorded_velocity(states: States, place: Floats) -> Mask:
    """Return the mask of samples with a recorded velocity; a velocity of zero on a whole track that moves is not recorded."""
    v = [states.numbers.get(name, np.full(len(states), np.nan)) for name in ("vx_mps", "vy_mps")]
    starts = track_starts(states.actor)
    still = np.logical_and.reduceat((v[0] == 0.0) & (v[1] == 0.0), starts)
    false_zero = still & (
        np.nan_to_num(extent_by_track(place, starts)).max(axis=0) > LEAST_POSITION_SPREAD_OF_MOVING_ACTOR_M
    )
    is_recorded: Mask = (
        np.isfinite(v[0]) & np.isfinite(v[1]) & ~np.repeat(false_zero, np.diff(np.r_[starts, len(states)]))
    )
    return is_recorded


def _samples_off_path(
    place: Floats, moves: _Moves, has_velocity: Mask, noise_m: Floats, motion_noise_m: Floats
) -> Mask:
    """Return the mask of the samples that are off the path of the two samples before and the two after them.

    `noise_m` (n): the noise (m) that the offset must exceed. `motion_noise_m` (n): the noise (m) that the motion without the sample may
    have.
    """
    n = place.shape[1]
    outliers = np.zeros(n, np.bool_)
    v, dt = moves
    before, to, away, after = (v[:, i : n - 4 + i] for i in range(4))
    dt_before, dt_to, dt_away, dt_after = (dt[i : n - 4 + i] for i in range(4))
    across = dt_to + dt_away
    without = (to * dt_to + away * dt_away) / across
    off = (to - without) * dt_to
    size = np.hypot(*off)
    s, e = noise_m[2:-2], motion_noise_m[2:-2]
    least = np.where(has_velocity[2:-2], LEAST_FALSE_STEP_WITH_RECORDED_VELOCITY_M, _least_false_step_m(dt_to))
    limit = np.maximum(least, np.maximum(TYRE_LIMIT_MPS2 * dt_to * dt_away / 2, OUTLIER_SIGMAS * 1.22 * s))
    # there and back: the path bends towards the sample before it, and back after it
    there = np.sum((to - before) * off, axis=0) * dt_to > size**2 / 2
    back = np.sum((after - away) * off, axis=0) * dt_away > size**2 / 2
    goes_on = _can_change_velocity(before, without, (dt_before + across) / 2, 1.9 * e / dt_to) & _can_change_velocity(
        without, after, (dt_after + across) / 2, 1.9 * e / dt_away
    )
    outliers[2:-2] = (size > limit) & there & back & goes_on
    return outliers


def _samples_at_false_steps(
    moves: _Moves, has_velocity: Mask, noise_m: Floats, motion_noise_m: Floats, off_path: Mask
) -> Mask:
    """Return the mask of samples at false steps without recorded velocity, which differ equally from the motion before and after them."""
    n = len(has_velocity)
    outliers = np.zeros(n, np.bool_)
    v, dt = moves
    before, here, after = (v[:, i : n - 3 + i] for i in range(3))
    dt_before, dt_here, dt_after = (dt[i : n - 3 + i] for i in range(3))
    whole = ~np.any([has_velocity[i : n - 3 + i] | off_path[i : n - 3 + i] for i in range(4)], axis=0)
    s, e = noise_m[1:-2], motion_noise_m[1:-2]
    from_before, from_after = (here - before) * dt_here, (here - after) * dt_here
    near, far = np.hypot(*from_before), np.hypot(*from_after)
    limit = np.maximum(
        _least_false_step_m(dt_here), np.maximum(TYRE_LIMIT_MPS2 * dt_here**2, OUTLIER_SIGMAS * 2.45 * s)
    )
    same = np.sum(from_before * from_after, axis=0) > near * far / 2
    error_mps = 2.0 * e / np.minimum(dt_before, dt_after)
    goes_on = _can_change_velocity(before, after, (dt_before + dt_after) / 2 + dt_here, error_mps)
    # the velocity must be nearly the same before and after: an impact would change it
    goes_on &= (
        np.hypot(*(after - before))
        <= MOST_VELOCITY_CHANGE_SHARE_AT_FALSE_STEP * np.minimum(near, far) / dt_here + OUTLIER_SIGMAS * error_mps
    )
    rows = np.flatnonzero((np.minimum(near, far) > limit) & same & goes_on & whole) + 1
    outliers[rows] = outliers[rows + 1] = True
    return outliers


def _can_change_velocity(velocity: Floats, later_velocity: Floats, time_s: Floats, error_mps: Floats) -> Mask:
    """Return the mask of the samples at which an actor can change from one velocity to the other in the given time."""
    can: Mask = np.hypot(*(velocity - later_velocity)) <= TYRE_LIMIT_MPS2 * time_s + OUTLIER_SIGMAS * error_mps
    return can


def _least_false_step_m(dt_s: Floats) -> Floats:
    least: Floats = np.clip(2.0 * TYRE_LIMIT_MPS2 * dt_s**2, *LEAST_FALSE_STEP_BOUNDS_M)
    return least


def samples_near_common_jolts(states: States, step: Steps) -> Mask:
    """Return the mask of the samples near common jolts: most moving actors' speeds change by the same factor and back."""
    n, width = len(states), max(2, round(JOLT_COMPARISON_NS / max(step.period_ns, 1)))
    near = np.zeros(n, np.bool_)
    if step.period_ns <= 0 or n <= 2 * width:
        return near
    speed = np.hypot(*states.velocity)
    holes = np.r_[0, np.cumsum(~step.continuous)]
    middle = np.arange(width, n - width)
    before, after = speed[middle - width], speed[middle + width]
    around = (before + after) / 2.0
    with np.errstate(invalid="ignore", divide="ignore"):
        share = speed[middle] / around
        # actors whose speed differs much before and after the moment are not used
        usable = (around > LEAST_SPEED_OF_JOLTED_ACTOR_MPS) & (abs(after - before) < around / 2.0) & np.isfinite(share)
    middle, share = (values[usable & (holes[middle - width] == holes[middle + width])] for values in (middle, share))
    times, moment, count = np.unique(states.t_ns[middle], return_inverse=True, return_counts=True)
    if not len(times):
        return near
    order = np.lexsort((share, moment))
    median = share[order][np.r_[0, np.cumsum(count)[:-1]] + count // 2]
    alike = abs(share - median[moment]) <= MOST_SPEED_RATIO_SPREAD_IN_COMMON_JOLT
    shared = np.bincount(moment[alike], minlength=len(times)) >= LEAST_SHARE_OF_ACTORS_IN_COMMON_JOLT * count
    common = (count >= LEAST_JOLTED_ACTORS) & (abs(median - 1.0) > LEAST_SPEED_CHANGE_IN_COMMON_JOLT) & shared
    at = middle[common[moment] & alike]
    # beside a dip, all speeds seem to rise: the median of a window excludes these samples
    window = np.median(speed[at[:, None] + np.arange(-width, width + 1)], axis=1)
    at = at[abs(speed[at] / window - 1.0) > LEAST_SPEED_CHANGE_IN_COMMON_JOLT]
    since = states.t_ns - states.t_ns.min()
    key = since + states.actor.astype(np.int64) * (int(since.max()) + 2 * AFFECTED_AROUND_JOLT_NS)
    edges = np.zeros(n + 1, np.int64)
    np.add.at(edges, np.searchsorted(key, key[at] - AFFECTED_AROUND_JOLT_NS), 1)
    np.add.at(edges, np.searchsorted(key, key[at] + AFFECTED_AROUND_JOLT_NS, side="right"), -1)
    near[:] = np.cumsum(edges[:-1]) > 0
    return near
