"""Interpolates objects that are sampled at other times than the ego to the ego's steps.

Every rule needs the position of every actor at each step of the ego. Between two samples, positions are interpolated linearly (at 10 Hz
and 5 m/s2 this is 6 mm off). An object has no state before its first sample, after its last one, or in a hole of its track. There is one
exception: if its track starts or ends within one sampling period of the log's start or end, it is extrapolated to there by its velocity.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.arrays import wrap_angles
from drivelint.drive.order import LONGEST_INTERPOLATED_PERIOD_NS, MAX_GAP_PERIODS, sorted_states
from drivelint.drive.trace import STATE_COLUMNS, QualityFinding, States
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from drivelint.arrays import Times

DIFFERENT_RATE_FACTOR: Final = 1.5
"""Above this ratio of a track's sampling period to the ego's, the track has another rate; below it, only single samples are missing."""
LEAST_SHARE_OF_EGO_STEPS_WITH_SAMPLE: Final = 0.75
"""A track with samples at this share of the ego's steps between its first and its last sample is not interpolated."""
_POSITION_AND_VELOCITY_COLUMNS: Final = (("x_m", "vx_mps"), ("y_m", "vy_mps"))


def align_to_ego_steps(states: States, egos: list[str]) -> tuple[States, list[QualityFinding]]:
    """Interpolate tracks with other sampling times to the steps of the only ego; return the states and a finding about it."""
    if len(egos) != 1 or egos[0] not in states.ids:
        return states, []
    starts = np.searchsorted(states.actor, np.arange(len(states.ids) + 1))
    ego = states.ids.index(egos[0])
    grid = states.t_ns[starts[ego] : starts[ego + 1]]
    if len(grid) < 2:
        return states, []
    period = float(np.median(np.diff(grid)))
    log_ns = int(states.t_ns.min()), int(states.t_ns.max())
    kept_rows, aligned_tracks, names, longest = np.ones(len(states), np.bool_), [], [], 0
    for i, name in enumerate(states.ids):
        span = slice(int(starts[i]), int(starts[i + 1]))
        track_period = _period_of_track_to_align_ns(states.t_ns[span], grid, period)
        if track_period is None:
            continue
        # a track with a shorter period also keeps its own samples; every track keeps its samples before and after the ego's steps
        kept_rows[span] = (track_period < period) | (states.t_ns[span] < grid[0]) | (states.t_ns[span] > grid[-1])
        track = _track_at_ego_steps(states, span, grid, track_period, log_ns)
        aligned_tracks.append(track.take(~np.isin(track.t_ns, states.t_ns[span])) if track_period < period else track)
        names.append(name)
        longest = max(longest, track_period)
    if not names:
        return states, []
    message = (
        f"actors that are sampled at other times than the ego ({name_list(names)}): their states are interpolated at its steps, "
        f"between samples no more than {MAX_GAP_PERIODS * longest / 1e9:g} s apart"
    )
    finding = QualityFinding.of_actors("aligned", "info", message, names)
    return sorted_states(States.concatenate([states.take(kept_rows), *aligned_tracks])), [finding]


def _period_of_track_to_align_ns(t_ns: Times, ego_steps_ns: Times, ego_period_ns: float) -> int | None:
    """Return the sampling period of a track that has to be aligned.

    None: its samples are at the ego's steps (but for a few), fewer than two, or too far apart.
    """
    n = len(t_ns)
    if n < 2:
        return None
    first = int(np.searchsorted(ego_steps_ns, t_ns[0]))
    if first + n <= len(ego_steps_ns) and np.array_equal(t_ns, ego_steps_ns[first : first + n]):
        return None
    own_period = int(np.median(np.diff(t_ns)))
    if own_period > LONGEST_INTERPOLATED_PERIOD_NS:
        return None
    steps = ego_steps_ns[first : np.searchsorted(ego_steps_ns, t_ns[-1], side="right")]
    shared = len(np.intersect1d(steps, t_ns, assume_unique=True))
    if shared >= LEAST_SHARE_OF_EGO_STEPS_WITH_SAMPLE * len(steps):  # also true if the ego has no step during the track
        return None
    return own_period if own_period > DIFFERENT_RATE_FACTOR * ego_period_ns or shared < 0.5 * n else None


def _track_at_ego_steps(
    states: States, span: slice, ego_steps_ns: Times, period_ns: int, log_span_ns: tuple[int, int]
) -> States:
    """Return the states of one track at those steps of the ego (`ego_steps_ns`) where they are known.

    `period_ns`: the track's sampling period. `log_span_ns`: the first and the last time of the log.
    """
    t_ns = states.t_ns[span]
    first = log_span_ns[0] if t_ns[0] - log_span_ns[0] <= period_ns else t_ns[0]
    last = log_span_ns[1] if log_span_ns[1] - t_ns[-1] <= period_ns else t_ns[-1]
    steps = ego_steps_ns[np.searchsorted(ego_steps_ns, first) : np.searchsorted(ego_steps_ns, last, side="right")]
    before = np.searchsorted(t_ns, steps, side="right") - 1
    inside = (before >= 0) & (steps <= t_ns[-1])
    before = np.clip(before, 0, len(t_ns) - 1)
    after = np.minimum(before + (inside & (t_ns[before] < steps)), len(t_ns) - 1)
    is_known = t_ns[after] - t_ns[before] <= MAX_GAP_PERIODS * period_ns
    steps, before, after, inside = steps[is_known], before[is_known], after[is_known], inside[is_known]
    rows, later = span.start + before, span.start + after
    apart = np.maximum(t_ns[after] - t_ns[before], 1)
    share = np.where(inside, (steps - t_ns[before]) / apart, 0.0)
    numbers = {name: values[rows] for name, values in states.numbers.items()}
    for name in STATE_COLUMNS:
        values = states.numbers[name]
        rise = wrap_angles(values[later] - values[rows]) if name == "yaw_rad" else values[later] - values[rows]
        numbers[name] = np.where(share > 0.0, values[rows] + share * rise, values[rows])
    numbers["yaw_rad"] = wrap_angles(numbers["yaw_rad"])
    age_s = np.where(inside, 0.0, (steps - t_ns[before]) / 1e9)
    for place, velocity in _POSITION_AND_VELOCITY_COLUMNS:
        numbers[place] = np.where(inside, numbers[place], numbers[place] + age_s * numbers[velocity])
    codes = {name: values[rows] for name, values in states.codes.items()}
    return States(states.ids, states.actor[rows], steps, numbers, codes, states.not_finite[rows])
