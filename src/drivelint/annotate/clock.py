"""Converts times of a trace to log times, so that a viewer shows new messages together with the log's own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True)
class LogClock:
    """Converts times of the trace to log times. If the container has its own clock, the last frame up to that time gives the log time.

    `t_ns` and `log_ns`: the frames' times on both clocks, `t_ns` strictly increasing. If both are empty, the log time is the trace's time
    plus `shift_ns`, since log times cannot be less than 0.
    """

    t_ns: NDArray[np.int64]
    log_ns: NDArray[np.uint64]
    shift_ns: int = 0

    def log_times(self, t_ns: NDArray[np.int64]) -> NDArray[np.uint64]:
        """Convert times of the trace to log times."""
        if not len(self.t_ns):
            return (t_ns + self.shift_ns).astype(np.uint64)
        frame = np.clip(np.searchsorted(self.t_ns, t_ns, side="right") - 1, 0, None)
        return self.log_ns[frame]

    def log_time_at(self, t_ns: int) -> int:
        """Convert one time of the trace to a log time."""
        return int(self.log_times(np.array([t_ns], np.int64))[0])


def of_frames(t_ns: NDArray[np.int64], log_ns: NDArray[np.uint64]) -> LogClock:
    """Return the clock of a log whose frames have both times; of several frames at the same time, the first is used."""
    times, first = np.unique(t_ns, return_index=True)
    return LogClock(times, log_ns[first])


def of_trace(t_start_ns: int) -> LogClock:
    """Return the clock of a trace whose container has no clock of its own."""
    return LogClock(np.zeros(0, np.int64), np.zeros(0, np.uint64), max(0, -t_start_ns))
