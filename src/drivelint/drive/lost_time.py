"""Stretches of time of which a damaged log has lost something: nothing is judged across them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import LostTime, QualityFinding

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.arrays import Times
    from drivelint.drive.trace import FrameTimes

LOST_TIME: Final = "lost_time"
"""The check of `quality` whose rows are the stretches; the table lost_time follows from them."""
MOST_STRETCHES: Final = 200
"""More than this many are told, and judged, as one from the first to the last."""
LATEST_NS: Final = 1 << 62
"""The year 2116: a clock beyond it is broken, and bounds nothing."""
_BESIDE: Final = 50
"""So many frames before and after a stretch tell how its clock and the log's differ there."""


def lost_time_findings(lost: Sequence[LostTime], frames: FrameTimes | None, t_ns: Times) -> list[QualityFinding]:
    """Return one finding per stretch, its times in the clock of the states (`t_ns`: theirs)."""
    if len(lost) > MOST_STRETCHES:
        begins, ends = ([ns for ns in column if ns is not None] for column in list(zip(*lost, strict=True))[:2])
        first = min(begins) if len(begins) == len(lost) else None
        last = max(ends) if len(ends) == len(lost) else None
        lost = [LostTime(first, last, f"{len(lost)} places cannot be read, the first: {lost[0].what}")]
    start = int(t_ns.min())
    findings = []
    for each in lost:
        since, until = _in_clock_of_states(each, frames)
        message = f"{each.what}: what was recorded {_words(since, until, start)} is lost: nothing is judged across it"
        findings.append(QualityFinding(LOST_TIME, "error", message, 1, since, None, until))
    return findings


def _words(since: int | None, until: int | None, start: int) -> str:
    """Return a stretch in seconds of the log."""
    if since is not None and until is not None and until - since <= 2:
        return f"at {(since + 1 - start) / 1e9:.3f} s"
    begin = "from the beginning" if since is None else f"from {(since - start) / 1e9:.3f} s"
    return begin + (" to the end" if until is None else f" to {(until - start) / 1e9:.3f} s")


def _in_clock_of_states(lost: LostTime, frames: FrameTimes | None) -> tuple[int | None, int | None]:
    """Return a stretch in the states' clock: as wide as the frames beside it, which come more or less late, can make it."""
    since, until = lost.since_ns, lost.until_ns
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
