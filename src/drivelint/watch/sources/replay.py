"""A source that replays a finished log, of any format that `check` reads, as if it were being recorded."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.time_span import cut_trace
from drivelint.formats import read_trace
from drivelint.watch.source import Frame

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from drivelint.drive.trace import IngestOptions, Trace


FIRST_WINDOW_LENGTH_NS: Final = 1_000_000_000
"""The length of the first window, which is short so that the ego is known early."""


class Replay:
    """Provides the steps of a log at a given speed, or as fast as they are read.

    `speed`: seconds of log time per second; 0: `every_ns` of log time per `read`. Values that the log's reader derives from the whole log,
    such as velocities, are known from the beginning; the steps after the window are not.
    """

    def __init__(self, path: Path, options: IngestOptions, *, speed: float, every_ns: int) -> None:
        self.recording = path
        self.is_advanced_by_reads = self.is_window_due = speed == 0
        self._speed = speed
        self._every_ns = every_ns
        self._trace = read_trace(path, options)
        self._times = np.unique(self._trace.tables["actor_state"]["t_ns"].to_numpy())
        self._at = 0
        self._begun_s: float | None = None
        self._halted = False

    def read(self, timeout_s: float) -> Sequence[Frame] | None:
        """Return the next steps, each as a frame without content."""
        if self._halted or self._at >= len(self._times):
            return None
        end = self._number_of_due_steps(timeout_s)
        frames = [Frame(int(t_ns), None, 0) for t_ns in self._times[self._at : end]]
        self._at = end
        return frames

    def _number_of_due_steps(self, timeout_s: float) -> int:
        """Return how many steps are due, after a wait of at most `timeout_s`."""
        if self.is_advanced_by_reads:
            span_ns = self._every_ns if self._at else min(self._every_ns, FIRST_WINDOW_LENGTH_NS)
            return int(np.searchsorted(self._times, self._times[self._at] + span_ns, side="left"))
        now = time.monotonic()
        if self._begun_s is None:
            self._begun_s = now
        next_s = self._begun_s + (self._times[self._at] - self._times[0]) / 1e9 / self._speed
        if next_s > now:
            time.sleep(min(timeout_s, next_s - now))
            now = time.monotonic()
        gone_ns = (now - self._begun_s) * self._speed * 1e9
        return int(np.searchsorted(self._times, self._times[0] + gone_ns, side="right"))

    def notes(self) -> Sequence[str]:
        """Return no notes: nothing is lost from a finished log."""
        return ()

    def window_reader(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Callable[[], Trace]:  # noqa: ARG002 - see `Source`
        """See `Source`."""
        times = [frame.t_ns for frame in frames]
        return partial(cut_trace, self._trace, min(times), max(times))

    def latest_trace(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Trace:
        """See `Source`."""
        return self.window_reader(frames, folder, options)()

    def end_sender_if_possible(self) -> None:
        """Provide no more steps."""
        self._halted = True

    def close(self) -> None:
        """Do nothing: the log stays as it is."""
