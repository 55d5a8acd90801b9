"""Finds the stretches of time from which a damaged log may have lost rows: nothing is judged across them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import LostTime, QualityFinding

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.arrays import Mask, Times
    from drivelint.drive.trace import FrameTimes

LOST_TIME_CHECK: Final = "lost_time"
"""The id of the check whose rows in `quality` are the stretches; the table `lost_time` is derived from these rows."""
MOST_REPORTED_LOST_STRETCHES: Final = 200
"""If there are more stretches than this, they are reported and judged as a single one, from the first to the last."""
LATEST_CREDIBLE_NS: Final = 1 << 62
"""The year 2116: a later time means a broken clock, and is not used as a bound."""
_FRAMES_USED_EACH_SIDE: Final = 50
"""How many frames before and after a stretch are used to estimate the offset between the two clocks of the log."""


def times_of_lost_rows(t_ns: Times, timed: Mask, lost_rows: Mask, cause: str) -> list[LostTime]:
    """Return the stretches of time in which unusable rows (`lost_rows`, in the order of the file) were recorded.

    A row with a time (`timed`) gives this time; a row without one gives the stretch between the timed rows beside it, or the whole drive if
    the times in the file are not ascending. Stretches without another row's time between them are merged. `cause`: the text of the finding,
    to which the number of rows is added.
    """
    rows, timed_rows = np.flatnonzero(lost_rows), np.flatnonzero(timed)
    if not len(rows):
        return []
    times = t_ns[timed_rows]
    unknown = ~timed[rows]
    if not len(timed_rows) or (unknown.any() and (np.diff(times) < 0).any()):
        return [LostTime(None, None, f"{cause}: {len(rows)}")]
    place = np.searchsorted(timed_rows, rows)
    begin, end = np.iinfo(np.int64).min, np.iinfo(np.int64).max
    since = np.where(unknown, np.r_[begin, times][place], t_ns[rows])
    until = np.where(unknown, np.r_[times, end][place], t_ns[rows])
    order = np.argsort(since, kind="stable")
    since, until = since[order], np.maximum.accumulate(until[order])
    moments = np.unique(times)
    apart = np.searchsorted(moments, since[1:]) > np.searchsorted(moments, until[:-1], side="right")
    firsts = np.r_[0, np.flatnonzero(apart) + 1]
    counts = np.diff(np.r_[firsts, len(rows)])
    return [
        LostTime(
            None if since[k] == begin else int(since[k]) - 1,
            None if until[k + n - 1] == end else int(until[k + n - 1]) + 1,
            f"{cause}: {n}",
        )
        for k, n in zip(firsts.tolist(), counts.tolist(), strict=True)
    ]


def lost_time_findings(lost_times: Sequence[LostTime], frames: FrameTimes | None, t_ns: Times) -> list[QualityFinding]:
    """Return one finding per stretch, with times in the clock of the states (`t_ns`: the times of the states)."""
    if len(lost_times) > MOST_REPORTED_LOST_STRETCHES:
        begins, ends = ([ns for ns in column if ns is not None] for column in list(zip(*lost_times, strict=True))[:2])
        first = min(begins) if len(begins) == len(lost_times) else None
        last = max(ends) if len(ends) == len(lost_times) else None
        lost_times = [
            LostTime(first, last, f"{len(lost_times)} places cannot be read, the first: {lost_times[0].cause}")
        ]
    start = int(t_ns.min())
    findings = []
    for lost_time in lost_times:
        since, until = _span_in_clock_of_states(lost_time, frames)
        message = f"{lost_time.cause}: the recording {_stretch_text(since, until, start)} is lost: no rule is judged across this time"
        findings.append(QualityFinding(LOST_TIME_CHECK, "error", message, 1, since, None, until))
    return findings


def _stretch_text(since_ns: int | None, until_ns: int | None, log_start_ns: int) -> str:
    """Return the start and end of a stretch as text, in seconds since the start of the log."""
    if since_ns is not None and until_ns is not None and until_ns - since_ns <= 2:
        return f"at {(since_ns + 1 - log_start_ns) / 1e9:.3f} s"
    begin = "from the beginning" if since_ns is None else f"from {_seconds_text(since_ns - log_start_ns)}"
    return begin + (" to the end" if until_ns is None else f" to {_seconds_text(until_ns - log_start_ns)}")


def _seconds_text(ns: int) -> str:
    return f"{round(ns / 1e9, 3) + 0.0:.3f} s"  # + 0.0 turns -0.0 into 0.0


def _span_in_clock_of_states(lost_time: LostTime, frames: FrameTimes | None) -> tuple[int | None, int | None]:
    """Convert a stretch from the container's clock to the states' clock.

    The delay between them varies: its extremes in nearby frames give the widest possible stretch.
    """
    since, until = lost_time.since_ns, lost_time.until_ns
    times = [ns for ns in (since, until) if ns is not None]
    if frames is not None and len(frames.t_ns):
        times += [int(frames.log_ns.max()), int(frames.t_ns.max()), -int(frames.t_ns.min())]
    if max(times, default=0) > LATEST_CREDIBLE_NS:
        return None, None
    if frames is None or not len(frames.t_ns):
        return since, until
    order = np.argsort(frames.log_ns, kind="stable")
    log_ns, t_ns = frames.log_ns[order].astype(np.int64), frames.t_ns[order]
    at = np.searchsorted(log_ns, [0 if since is None else since, np.iinfo(np.int64).max if until is None else until])
    beside = slice(max(0, int(at[0]) - _FRAMES_USED_EACH_SIDE), int(at[1]) + _FRAMES_USED_EACH_SIDE)
    late = (log_ns - t_ns)[beside]
    return (
        None if since is None else since - int(late.max()),
        None if until is None else until - int(late.min()),
    )
