"""Stretches of time of which a damaged log has lost something: nothing is judged across them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import LostTime, QualityFinding

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.arrays import Mask, Times
    from drivelint.drive.trace import FrameTimes

LOST_TIME: Final = "lost_time"
"""The check of `quality` whose rows are the stretches; the table lost_time follows from them."""
MOST_STRETCHES: Final = 200
"""More than this many are reported, and judged, as one from the first to the last."""
LATEST_NS: Final = 1 << 62
"""The year 2116: a clock beyond it is broken, and bounds nothing."""
_BESIDE: Final = 50
"""This many frames before and after a stretch show how its clock and the log's differ there."""


def times_of_lost_rows(t_ns: Times, timed: Mask, lost_rows: Mask, cause: str) -> list[LostTime]:
    """Return when rows were recorded that cannot be used: `lost_rows`, in the order of the file. `cause`: the text without their number.

    That is the time of the row, where it has one (`timed`), else any between the rows before and after it; without rows in the order of
    their times, any of the whole drive. Stretches without a whole time between them are one.
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
    """Return one finding per stretch, its times in the clock of the states (`t_ns`: theirs)."""
    if len(lost_times) > MOST_STRETCHES:
        begins, ends = ([ns for ns in column if ns is not None] for column in list(zip(*lost_times, strict=True))[:2])
        first = min(begins) if len(begins) == len(lost_times) else None
        last = max(ends) if len(ends) == len(lost_times) else None
        lost_times = [
            LostTime(first, last, f"{len(lost_times)} places cannot be read, the first: {lost_times[0].cause}")
        ]
    start = int(t_ns.min())
    findings = []
    for each in lost_times:
        since, until = _in_clock_of_states(each, frames)
        message = f"{each.cause}: the recording {_words(since, until, start)} is lost: nothing is judged across it"
        findings.append(QualityFinding(LOST_TIME, "error", message, 1, since, None, until))
    return findings


def _words(since: int | None, until: int | None, start: int) -> str:
    """Return a stretch in seconds of the log."""
    if since is not None and until is not None and until - since <= 2:
        return f"at {(since + 1 - start) / 1e9:.3f} s"
    begin = "from the beginning" if since is None else f"from {_seconds(since - start)}"
    return begin + (" to the end" if until is None else f" to {_seconds(until - start)}")


def _seconds(ns: int) -> str:
    return f"{round(ns / 1e9, 3) + 0.0:.3f} s"  # + 0.0: without the sign of -0.0


def _in_clock_of_states(lost_time: LostTime, frames: FrameTimes | None) -> tuple[int | None, int | None]:
    """Return a stretch in the states' clock: as wide as the frames beside it, which come more or less late, can make it."""
    since, until = lost_time.since_ns, lost_time.until_ns
    times = [ns for ns in (since, until) if ns is not None]
    if frames is not None and len(frames.t_ns):
        times += [int(frames.log_ns.max()), int(frames.t_ns.max()), -int(frames.t_ns.min())]
    if max(times, default=0) > LATEST_NS:
        return None, None
    if frames is None or not len(frames.t_ns):
        return since, until
    order = np.argsort(frames.log_ns, kind="stable")
    log_ns, t_ns = frames.log_ns[order].astype(np.int64), frames.t_ns[order]
    at = np.searchsorted(log_ns, [0 if since is None else since, np.iinfo(np.int64).max if until is None else until])
    beside = slice(max(0, int(at[0]) - _BESIDE), int(at[1]) + _BESIDE)
    late = (log_ns - t_ns)[beside]
    return (
        None if since is None else since - int(late.max()),
        None if until is None else until - int(late.min()),
    )
