"""Sorts states, removes duplicate states, and computes differences and sums along each actor's track."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.drive.trace import STATE_COLUMNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Indices, Mask, Times
    from drivelint.drive.trace import QualityFinding, States

MAX_GAP_PERIODS = 2.5
"""Samples further apart than this many periods are not continuous."""
LONGEST_INTERPOLATED_PERIOD_NS: Final = 250_000_000
"""Objects with a longer sampling period are not interpolated: at 250 ms, interpolating a braking car is already 8 cm off."""
UNKNOWN_CODE = np.int8(-1)


def sorted_states(states: States) -> States:
    """Return the states sorted by actor id (as text), then by time (stable), without ids that have no state."""
    used = np.flatnonzero(np.bincount(states.actor, minlength=len(states.ids)))
    ids = sorted(states.ids[i] for i in used)
    rank = np.zeros(len(states.ids), np.int32)
    place = {name: i for i, name in enumerate(ids)}
    for i in used:
        rank[i] = place[states.ids[i]]
    actor = rank[states.actor]
    rising = np.all(states.t_ns[1:] >= states.t_ns[:-1])
    time_order = np.arange(len(states)) if rising else np.argsort(states.t_ns, kind="stable")
    # numpy's stable sort of 16-bit keys is a radix sort, which is ten times faster
    keys = actor[time_order].astype(np.uint16) if len(ids) <= np.iinfo(np.uint16).max else actor[time_order]
    ordered = states.take(time_order[np.argsort(keys, kind="stable")])
    ordered.ids = ids
    ordered.actor = rank[ordered.actor]
    return ordered


def without_duplicates(states: States) -> tuple[States, list[QualityFinding]]:
    """Keep one of several states of an actor at the same time (states in order), and make values that differ unknown.

    If any column of `STATE_COLUMNS` differs, all of these columns become unknown: the actor is present, but without a position.
    """
    repeated, of = repetition_mask_and_index_without_repetitions(states)
    if not repeated.any():
        return states, []
    unique_states = states.take(~repeated)
    differ = {
        name: np.bincount(of[repeated & rows], minlength=len(unique_states)) > 0
        for name, rows in value_changes_by_column(states).items()
    }
    differs_in_state = np.logical_or.reduce([differ[name] for name in STATE_COLUMNS if name in differ])
    for name, values in unique_states.numbers.items():
        values[differ[name] | differs_in_state if name in STATE_COLUMNS else differ[name]] = np.nan
    for name, codes in unique_states.codes.items():
        codes[differ[name]] = UNKNOWN_CODE
    differing = repeated & np.logical_or.reduce(list(differ.values()))[of]
    text = "an actor appears again at the same time in {n} states ({ids}), which "
    return unique_states, [
        *states.findings(
            differing, "duplicate_state", "error", text + "differ: the values that differ are unknown there"
        ),
        *states.findings(repeated & ~differing, "duplicate_state", "info", text + "are equal: they count once"),
    ]


def repetition_mask_and_index_without_repetitions(states: States) -> tuple[Mask, Indices]:
    """Return the mask of rows that repeat the actor and time of the row before, and each row's index after these rows are removed."""
    repeated = np.zeros(len(states), np.bool_)
    repeated[1:] = (states.actor[1:] == states.actor[:-1]) & (states.t_ns[1:] == states.t_ns[:-1])
    return repeated, np.cumsum(~repeated) - 1


def value_changes_by_column(states: States) -> dict[str, Mask]:
    """Return for each column the mask of rows whose value differs from the row before; two unknown values are equal."""
    changes = {}
    columns: dict[str, NDArray[Any]] = {**states.numbers, **states.codes}
    for name, values in columns.items():
        unknown = np.isnan(values)
        changes[name] = np.zeros(len(values), np.bool_)
        changes[name][1:] = (values[1:] != values[:-1]) & ~(unknown[1:] & unknown[:-1])
    return changes


@dataclass(frozen=True)
class Steps:
    """The steps from each row of the states to the next row: arrays of n - 1 values for n rows.

    `same_actor`: both rows are of one actor. `dt_s`: the seconds between them. `continuous`: `same_actor`, and no further apart than
    `MAX_GAP_PERIODS` periods of the track. `period_ns`: the median step of all actors (0: no actor has two states).
    `track_period_ns` (n): for each row the period of its track, such as that of objects at 10 Hz beside an ego at 50 Hz.
    """

    same_actor: Mask
    dt_s: Floats
    continuous: Mask
    period_ns: int
    track_period_ns: Times


def steps(states: States) -> Steps:
    """Measure the steps between neighbouring states (in order, no duplicates)."""
    same = states.actor[1:] == states.actor[:-1]
    dt = np.diff(states.t_ns)
    period = int(np.median(dt[same])) if same.any() else 0
    return steps_between(states.t_ns, states.actor, period, _track_periods_ns(states.t_ns, states.actor, period))


def steps_between(t_ns: Times, actor: NDArray[np.int32], period_ns: int, track_period_ns: Times) -> Steps:
    """Measure the steps between these samples (n, in order), given the log's sampling period, and that of each sample's track."""
    same = actor[1:] == actor[:-1]
    dt = np.diff(t_ns)
    return Steps(same, dt * 1e-9, same & (dt <= MAX_GAP_PERIODS * track_period_ns[1:]), period_ns, track_period_ns)


def _track_periods_ns(t_ns: Times, actor: NDArray[np.int32], period_ns: int) -> Times:
    """Return for each sample the sampling period of its track, but not less than that of the log.

    A track's period is the lower quartile of its steps, so holes do not lengthen it. If it is longer than `LONGEST_INTERPOLATED_PERIOD_NS`,
    the track is not interpolated either, and the log's period counts.
    """
    starts = track_starts(actor)
    periods = np.full(len(starts), period_ns, np.int64)
    for i, (first, end) in enumerate(pairwise([*starts.tolist(), len(t_ns)])):
        dt = np.diff(t_ns[first:end])
        if len(dt) and dt.max() > MAX_GAP_PERIODS * period_ns:
            track_period_ns = int(np.partition(dt, (len(dt) - 1) // 4)[(len(dt) - 1) // 4])
            periods[i] = (
                max(track_period_ns, period_ns) if track_period_ns <= LONGEST_INTERPOLATED_PERIOD_NS else period_ns
            )
    return np.repeat(periods, np.diff(np.r_[starts, len(t_ns)]))


def time_derivative(values: Floats, step: Steps) -> Floats:
    """Return the time derivative, (n) or (2, n).

    Central difference if both steps beside the sample are continuous, one-sided if only one is, else NaN.
    """
    rise, span, result = np.zeros_like(values), np.zeros_like(values), np.full_like(values, np.nan)
    with np.errstate(invalid="ignore"):
        difference = np.diff(values)
    usable = step.continuous & np.isfinite(difference)
    for side in (slice(None, -1), slice(1, None)):
        rise[..., side] += np.where(usable, difference, 0.0)
        span[..., side] += np.where(usable, step.dt_s, 0.0)
    np.divide(rise, span, out=result, where=span > 0)
    return result


def steps_with_known_motion(states: States, step: Steps) -> Mask:
    """Return the mask of the steps (n - 1) that are continuous and whose position and velocity are known at both ends."""
    has_motion = np.ones(len(states), np.bool_)
    for name in ("x_m", "y_m", "vx_mps", "vy_mps"):
        has_motion &= np.isfinite(states.numbers[name])
    return step.continuous & has_motion[1:] & has_motion[:-1]


def integral_per_step(rate: Floats, step: Steps, known_steps: Mask) -> Floats:
    """Integrate a rate, (n) or (2, n), over each step by the trapezoidal rule; 0 for steps that are not in `known_steps`."""
    led: Floats = rate[..., 1:] + rate[..., :-1]
    led *= 0.5
    led *= step.dt_s
    np.copyto(led, 0.0, where=~known_steps)
    return led


def motion_over_steps(
    states: States, step: Steps, known_steps: Mask, n_steps: int
) -> tuple[Floats, Floats, Mask, Floats]:
    """Return, for every `n_steps` successive steps, the displacement of the positions and that of the integrated velocities.

    Returns, indexed by first row: both displacements (2, n - n_steps) in metres, whether all `n_steps` steps are known, and the time in
    seconds.
    """
    went, led = np.empty((2, 2, max(0, len(states) - n_steps)))
    for axis, (place, rate) in enumerate((("x_m", "vx_mps"), ("y_m", "vy_mps"))):
        np.subtract(states.numbers[place][n_steps:], states.numbers[place][:-n_steps], out=went[axis])
        led[axis] = sliding_sums(integral_per_step(states.numbers[rate], step, known_steps), n_steps)
    whole: Mask = sliding_sums(~known_steps, n_steps) == 0
    return went, led, whole, np.subtract(states.t_ns[n_steps:], states.t_ns[:-n_steps]) * 1e-9


def sliding_sums(values: Floats | Mask, width: int) -> Floats:
    """Return the sum of every k neighbouring values along the last axis: m - k + 1 sums of m values."""
    total = prefix_sums(values)
    return total[..., width:] - total[..., :-width]


def prefix_sums(values: Floats | Mask) -> Floats:
    """Return the sums of the first 0, 1, ... m values along the last axis: m + 1 sums."""
    total = np.zeros((*values.shape[:-1], values.shape[-1] + 1))
    np.cumsum(values, axis=-1, out=total[..., 1:])
    return total


def track_starts(actor: NDArray[np.int32]) -> Indices:
    """Return the first row of each actor's track (`actor`: the actor's number per row, ascending); empty without rows."""
    return np.flatnonzero(np.r_[True, actor[1:] != actor[:-1]][: len(actor)])


def extent_by_track(values: Floats, starts: Indices) -> Floats:
    """Return the largest minus the smallest known value of each track (`starts`: first rows); NaN if no value is known."""
    return np.fmax.reduceat(values, starts, axis=-1) - np.fmin.reduceat(values, starts, axis=-1)
