"""Derives velocities from positions where the log has no or wrong velocities, and reports it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drivelint.drive.order import (
    extent_by_track,
    motion_over_steps,
    steps_between,
    steps_with_known_motion,
    track_starts,
)
from drivelint.drive.trace import STATE_COLUMNS, QualityFinding
from drivelint.drive.velocity import (
    LARGEST_VELOCITY_ERROR_MPS,
    LEAST_POSITION_SPREAD_OF_MOVING_ACTOR_M,
    derive_velocities,
)

if TYPE_CHECKING:
    from drivelint.arrays import Indices, Mask
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import States

MISMATCH_MPS = 1.0
MISMATCH_SHARE = 0.15
"""Velocities mismatch the positions if, over one second, the displacements differ by more than 1 m/s + 15 % of the faster
(see `checks.VELOCITY_MISMATCH_MPS`)."""
MISMATCH_WINDOW_NS = 1_000_000_000
END_ZERO_LEAST_MPS = 1.0
"""A velocity of 0 in the first or last sample of a track is not real if the neighbouring velocity, and the step of the positions, are
faster than this."""
BIAS_SHARE = 0.05
BIAS_LEAST_M = 50.0
BIAS_LEAST_MPS = 2.0
"""Over 50 m, the ratio of velocities to the motion of the positions is known to about 1 %. Up to 5 % is accepted, as speedometers, and
velocities of an axle in a bend, are that inexact."""
FROZEN_SHARE = 0.1
"""Positions are frozen if, over one second, they move by less than this share of the way at the recorded velocity."""
LEAST_MISMATCHING_WINDOWS = 20
"""At least this many one-second windows must mismatch; single steps are too noisy to compare."""


def complete_velocities(states: States, step: Steps, *, most_replaced_share: float = 1.0) -> list[QualityFinding]:
    """Derive velocities that are absent, zero although the actor moves, or in contradiction to the positions; return findings.

    `most_replaced_share`: if velocities contradict the positions in more than this share of all motion, they stay. Accelerations that
    were not measured become unknown. `states` in order, changed in place: every column of `STATE_COLUMNS` exists afterwards.
    """
    n = len(states)
    for name in STATE_COLUMNS:
        states.numbers.setdefault(name, np.full(n, np.nan))
    starts = np.flatnonzero(np.r_[True, ~step.same_actor])
    return [
        *_replace_zero_end_velocities(states, step, starts),
        *_replace_velocities(states, step, starts, most_replaced_share),
        *_drop_zero_accelerations(states, starts),
    ]


def _replace_zero_end_velocities(states: States, step: Steps, starts: Indices) -> list[QualityFinding]:
    """Replace a velocity of exactly 0 in the first or last sample of a track that moves there: 0 stands for an unknown value."""
    n = len(states)
    if n < 3:
        return []
    ends = np.r_[starts[1:], n] - 1
    long = ends - starts >= 2
    end = np.r_[starts[long], ends[long]]
    inner = np.r_[starts[long] + 1, ends[long] - 1]
    first = np.minimum(end, inner)
    v, dt_s = states.velocity, np.where(step.continuous[first], step.dt_s[first], np.nan)
    step_velocity = (states.place[:, first + 1] - states.place[:, first]) / np.where(dt_s > 0.0, dt_s, np.nan)
    zero = (
        (v[:, end] == 0.0).all(axis=0)
        & (np.hypot(*v[:, inner]) > END_ZERO_LEAST_MPS)
        & (np.hypot(*step_velocity) > END_ZERO_LEAST_MPS)
    )
    rows = np.zeros(n, np.bool_)
    rows[end[zero]] = True
    for axis, name in enumerate(("vx_mps", "vy_mps")):
        states.numbers[name] = states.numbers[name].copy()
        states.numbers[name][end[zero]] = step_velocity[axis, zero]
    text = "velocity 0 in the first or last sample of {n} tracks that move there ({ids}): it is derived from positions"
    return states.findings(rows, "velocity_end_derived", "warning", text)


def _replace_velocities(
    states: States, step: Steps, starts: Indices, most_replaced_share: float
) -> list[QualityFinding]:
    numbers, v = states.numbers, states.velocity
    absent = np.logical_and.reduceat(np.isnan(v).all(axis=0), starts)
    still = ~absent & np.logical_and.reduceat((v == 0.0).all(axis=0), starts)
    astray = ~absent & _actors_with_velocity_mismatch(states, step, most_replaced_share)[states.actor[starts]]
    biased = ~absent & _actors_with_biased_speed(states, step, most_replaced_share)[states.actor[starts]]
    if not (absent.any() or still.any() or astray.any() or biased.any()):
        return []
    false_zero = still & (
        np.nan_to_num(extent_by_track(states.place, starts)).max(axis=0) > LEAST_POSITION_SPREAD_OF_MOVING_ACTOR_M
    )
    findings = []
    for tracks, why in (
        (absent, "no velocity in the log"),
        (false_zero, "velocity 0 throughout although the positions move"),
        (astray & ~still, "velocity that does not match the motion of the positions"),
        (
            biased & ~astray & ~still,
            "velocity that is too high or too low by a constant factor, compared with the positions",
        ),
    ):
        if not tracks.any():
            continue
        rows = np.repeat(tracks, np.diff(np.r_[starts, len(states)]))
        lacking = states.take(rows)
        of_lacking = steps_between(lacking.t_ns, lacking.actor, step.period_ns, step.track_period_ns[rows])
        motion = derive_velocities(lacking.t_ns, lacking.actor, lacking.place, of_lacking)
        velocity, filtered = states.velocity, rows.copy()
        velocity[:, rows], filtered[rows] = motion
        numbers["vx_mps"], numbers["vy_mps"] = velocity
        findings += _filtered_velocity_findings(states, filtered)
        text = why + " ({ids}): velocity is derived from positions"
        findings += states.findings(rows, "velocity_derived", "warning", text)
    return findings


def _filtered_velocity_findings(states: States, rows: Mask) -> list[QualityFinding]:
    """Return a finding for each actor whose velocities were filtered because its positions are noisy, with their accuracy."""
    text = (
        f"the positions of {{ids}} are noisy: the velocity is a mean over up to two seconds, known to "
        f"{LARGEST_VELOCITY_ERROR_MPS:g} m/s, the acceleration is not known"
    )
    findings = []
    for number in np.unique(states.actor[rows]):
        findings += states.findings(rows & (states.actor == number), "velocity_filtered", "warning", text)
    return findings


def _actors_with_velocity_mismatch(states: States, step: Steps, most_replaced_share: float) -> Mask:
    """Return the mask of actors whose velocities contradict their positions in most one-second windows with motion."""
    wrong, n = np.zeros(len(states.ids), np.bool_), len(states)
    k = max(1, round(MISMATCH_WINDOW_NS / step.period_ns)) if step.period_ns else n
    if n <= k or most_replaced_share == 0.0 or not _may_velocities_mismatch(states, k):
        return wrong
    went, led, whole, span = motion_over_steps(states, step, steps_with_known_motion(states, step), k)
    off, way, way_by_velocity = np.hypot(*(went - led)), np.hypot(*went), np.hypot(*led)
    fastest = np.maximum(way, way_by_velocity)
    moving = whole & (fastest > MISMATCH_MPS * span)
    # constant positions do not show how an actor moves: `contradiction` treats them
    bad = moving & (way > MISMATCH_MPS * span) & (off > MISMATCH_MPS * span + MISMATCH_SHARE * fastest)
    seconds, astray = (np.bincount(states.actor[:-k][rows], minlength=len(states.ids)) for rows in (moving, bad))
    wrong = (astray >= LEAST_MISMATCHING_WINDOWS) & (2 * astray > seconds)
    return wrong & bool(seconds[wrong].sum() <= most_replaced_share * seconds.sum())


def _actors_with_biased_speed(states: States, step: Steps, most_replaced_share: float) -> Mask:
    """Return the mask of actors whose velocities differ from the motion of their positions by a constant factor.

    The factor must show in both halves of the track: a single displacement of a track is a different error. So are positions that stay
    the same although the velocity goes on: see `contradiction`.
    """
    biased, n = np.zeros(len(states.ids), np.bool_), len(states)
    if n < 3 or most_replaced_share == 0.0:
        return biased
    usable_steps = steps_with_known_motion(states, step)
    if _actors_with_factor(states, step, usable_steps, most_replaced_share).any():
        usable_steps &= ~_frozen_steps(states, step, usable_steps)
        return _actors_with_factor(states, step, usable_steps, most_replaced_share)
    return biased


def _frozen_steps(states: States, step: Steps, known_steps: Mask) -> Mask:
    """Return the mask of the steps (n - 1) within a second in which the positions are frozen."""
    n = len(states)
    k = max(1, round(MISMATCH_WINDOW_NS / step.period_ns)) if step.period_ns else n
    if n <= k:
        return np.zeros(n - 1, np.bool_)
    went, led, whole, _ = motion_over_steps(states, step, known_steps, k)
    first = np.flatnonzero(whole & (np.hypot(*went) < FROZEN_SHARE * np.hypot(*led)))
    edges = np.zeros(n, np.int64)
    np.add.at(edges, first, 1)
    np.add.at(edges, first + k, -1)
    frozen: Mask = np.cumsum(edges[:-1]) > 0
    return frozen


def _actors_with_factor(states: States, step: Steps, known_steps: Mask, most_replaced_share: float) -> Mask:
    biased = np.zeros(len(states.ids), np.bool_)
    v = (states.velocity[:, 1:] + states.velocity[:, :-1]) / 2.0
    speed = np.hypot(*v)
    moving = known_steps & (speed > BIAS_LEAST_MPS)
    led = np.where(moving, speed * step.dt_s, 0.0)
    # projected on the velocity, so that lateral noise and noise at a standstill add nothing
    went = np.where(moving, np.sum(np.diff(states.place) * v, axis=0) / np.where(moving, speed, 1.0), 0.0)
    actor, count = states.actor[:-1], len(states.ids)
    ways = np.bincount(actor, went, count)
    until = np.r_[0.0, np.cumsum(led)]
    half = until[1:] - until[track_starts(states.actor)][actor]
    second = 2.0 * half > np.bincount(actor, led, count)[actor]
    off = np.ones(count, np.bool_)
    side = np.zeros(count)
    for part in (second, ~second):
        with np.errstate(invalid="ignore", divide="ignore"):
            ratio = np.bincount(actor[part], led[part], count) / np.bincount(actor[part], went[part], count)
        off &= np.abs(ratio - 1.0) > BIAS_SHARE
        side += np.sign(ratio - 1.0)
    biased[:] = off & (np.abs(side) == 2.0) & (ways > BIAS_LEAST_M)
    return biased & bool(ways[biased].sum() <= most_replaced_share * ways.sum())


def _may_velocities_mismatch(states: States, stride: int) -> bool:
    """Return whether the velocities of any actor may mismatch its positions: a fast test of every k-th state (Simpson's rule)."""
    first = np.arange(0, len(states) - stride, stride)
    middle, last = first + stride // 2, first + stride
    here = (states.actor[first] == states.actor[last]) & (states.t_ns[last] > states.t_ns[first])
    first, middle, last = first[here], middle[here], last[here]
    span, place, v = (states.t_ns[last] - states.t_ns[first]) * 1e-9, states.place, states.velocity
    went = (place[:, last] - place[:, first]) / span
    led = (v[:, first] + 4.0 * v[:, middle] + v[:, last]) / 6.0
    off = np.hypot(*(went - led))
    actor, rows = states.actor[first], (off > MISMATCH_MPS / 2, off >= 0.0)
    bad, n = (np.bincount(actor[some], minlength=len(states.ids)) for some in rows)
    return bool((3 * bad > n).any())


def _drop_zero_accelerations(states: States, starts: Indices) -> list[QualityFinding]:
    """Make accelerations unknown if they are zero in all states although velocities change, and return a finding about it."""
    ax, ay = states.numbers["ax_mps2"], states.numbers["ay_mps2"]
    has_acceleration = ~(np.isnan(ax) & np.isnan(ay))
    if not has_acceleration.any() or (ax[has_acceleration] != 0.0).any() or (ay[has_acceleration] != 0.0).any():
        return []
    if not any((extent_by_track(states.numbers[name], starts) > 0.5).any() for name in ("vx_mps", "vy_mps")):
        return []
    states.numbers["ax_mps2"] = np.full(len(states), np.nan)
    states.numbers["ay_mps2"] = np.full(len(states), np.nan)
    n = int(has_acceleration.sum())
    message = f"acceleration is 0 in all {n} states although speeds change: it counts as not recorded"
    return [QualityFinding("acceleration_not_recorded", "info", message, n, int(states.t_ns[has_acceleration].min()))]
