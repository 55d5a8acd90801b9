"""Makes states unknown where the log's clock goes back and covers the same time twice."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.order import UNKNOWN_CODE, repetition_mask_and_index_without_repetitions, value_changes_by_column
from drivelint.drive.trace import QualityFinding, States

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drivelint.arrays import Indices, Mask, Times

LEAST_STATES_OF_CLOCK_RUN: Final = 10
"""At least this many successive states of an actor with ascending times are a run of the clock; fewer are late messages."""
LEAST_INTERLEAVED_STATES: Final = 5
"""At least this many states of one run that are in time between states of another are not late messages."""
LEAST_HOLE_PER_MEDIAN_STEP: Final = 1.5
"""A step longer than the median step by this factor is a hole, which late messages may fill."""


def backward_step_findings(t_ns: Times, topic: str | None = None) -> list[QualityFinding]:
    """Return a finding if the times of messages, in the order of the file, go back; `topic`: the topic of the messages."""
    back = np.diff(t_ns) < 0
    if not back.any():
        return []
    n, first = int(back.sum()), int(t_ns[1:][back][0])
    of_topic = "" if topic is None else f" of {topic}"
    first_s = (first - int(t_ns.min())) / 1e9
    message = (
        f"backward steps of the clock{of_topic}: {n}, the first to {first_s:g} s: states are sorted by their times"
    )
    return [QualityFinding("clock_jump", "warning", message, n, first)]


def rows_back_in_time(t_ns: Times, actor: NDArray[np.int32]) -> Indices:
    """Return, ascending, the rows whose time is before that of the previous row of the same actor (rows in the order of the file)."""
    if np.all(t_ns[1:] >= t_ns[:-1]):
        return np.zeros(0, np.int64)
    by_actor = np.argsort(actor, kind="stable")
    is_back = (np.diff(t_ns[by_actor]) < 0) & (np.diff(actor[by_actor]) == 0)
    return np.sort(by_actor[1:][is_back])


def without_values_at_restarts(states: States) -> tuple[States, list[QualityFinding]]:
    """Make the states of all actors unknown where the clock covers the same time twice (states in the log's own order).

    Late messages are not a restart: sorted by time, they belong to one recording. If two recordings cover the same time, it is unknown
    which actors were there together. Rows that are equal in both recordings stay.
    """
    back = np.diff(states.t_ns) < 0
    if not back.any():
        return states, []
    run = np.concatenate([[0], np.cumsum(back)])
    twice = np.zeros(len(states), np.bool_)
    for pair, (since, until) in _spans_covered_twice(states, run).items():
        for k in pair:
            rows = slice(*np.searchsorted(run, [k, k + 1]))
            twice[rows] |= (states.t_ns[rows] >= since) & (states.t_ns[rows] <= until)
    twice &= ~_equal_repetitions(states, twice)
    if not twice.any():
        return states, []
    numbers = {name: np.where(twice, np.nan, values) for name, values in states.numbers.items()}
    codes = {name: np.where(twice, UNKNOWN_CODE, codes) for name, codes in states.codes.items()}
    n, first = int(twice.sum()), int(states.t_ns[twice].min())
    message = (
        f"the clock goes back and repeats the same time, from {(first - int(states.t_ns.min())) / 1e9:g} s on: the values of {n} of "
        f"{len(states)} states in that time are unknown"
    )
    return replace(states, numbers=numbers, codes=codes), [QualityFinding("clock_restart", "error", message, n, first)]


def _spans_covered_twice(states: States, run: Times) -> dict[tuple[int, int], tuple[int, int]]:
    """Return, for each pair of runs of the clock that cover the same time of an actor, the first and last time covered twice."""
    by = np.lexsort((run, states.actor))
    begin = np.flatnonzero(np.r_[True, (np.diff(states.actor[by]) != 0) | (np.diff(run[by]) != 0)])
    end = np.r_[begin[1:], len(by)]
    tracks: dict[int, list[Indices]] = {}
    for i in np.flatnonzero(end - begin >= LEAST_STATES_OF_CLOCK_RUN):
        tracks.setdefault(int(states.actor[by[begin[i]]]), []).append(by[begin[i] : end[i]])
    spans: dict[tuple[int, int], tuple[int, int]] = {}
    for pieces in tracks.values():
        for first, second in combinations(pieces, 2):
            times, second_times = states.t_ns[first], states.t_ns[second]
            if _interleaved_count(times, second_times) >= LEAST_INTERLEAVED_STATES:
                pair = int(run[first[0]]), int(run[second[0]])
                since, until = max(int(times[0]), int(second_times[0])), min(int(times[-1]), int(second_times[-1]))
                span = spans.get(pair, (since, until))
                spans[pair] = min(span[0], since), max(span[1], until)
    return spans


def _interleaved_count(run_ns: Times, other_run_ns: Times) -> int:
    """Count the times of `other_run_ns` that lie between times of `run_ns`, but not in its holes (both ascending)."""
    steps = np.diff(run_ns)
    before = np.clip(np.searchsorted(run_ns, other_run_ns), 1, len(run_ns) - 1) - 1
    inside = (
        (other_run_ns >= run_ns[0])
        & (other_run_ns <= run_ns[-1])
        & (steps[before] <= LEAST_HOLE_PER_MEDIAN_STEP * np.median(steps))
    )
    return int(inside.sum())


def _equal_repetitions(states: States, rows: Mask) -> Mask:
    """Return the mask of given rows whose actor and time occur more than once among them, with equal values each time."""
    agreed = np.zeros(len(rows), np.bool_)
    chosen_rows = np.flatnonzero(rows)
    chosen_rows = chosen_rows[np.lexsort((states.t_ns[chosen_rows], states.actor[chosen_rows]))]
    ordered = states.take(chosen_rows)
    again, of = repetition_mask_and_index_without_repetitions(ordered)
    several = np.bincount(of) > 1
    differs = again & np.any(list(value_changes_by_column(ordered).values()), axis=0)
    contradicted = np.bincount(of[differs], minlength=len(several)) > 0
    agreed[chosen_rows] = (several & ~contradicted)[of]
    return agreed
