"""Keeps the frames of the last seconds of a log, and newer frames that are not judged yet."""

from __future__ import annotations

from collections import deque
from itertools import chain
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.watch.source import Frame

NS_PER_S: Final = 1_000_000_000
"""One second in nanoseconds."""


class _FrameOnSteadyClock(NamedTuple):
    """A frame, its time on a clock that does not jump, and whether the log's clock jumped before it."""

    at_ns: int
    frame: Frame
    is_cut: bool


class Window:
    """The frames of the last `length_ns` of a log, and the waiting frames: newer ones that `advance` has not reached.

    If the log's clock jumps by more than `length_ns`, forwards or backwards, the window starts again: nothing is judged across the jump.
    Memory: the frames of the window and the waiting frames.
    """

    def __init__(self, length_ns: int) -> None:
        self._length_ns = length_ns
        self._frames: deque[_FrameOnSteadyClock] = deque()
        self._waiting: deque[_FrameOnSteadyClock] = deque()
        self._last: _FrameOnSteadyClock | None = None
        self._latest_ns = 0
        """The latest time of all frames on the clock without jumps."""
        self._newest_ns: int | None = None
        """The latest time of the frames in the window on the clock without jumps."""
        self.is_whole = True
        """No frame of the log has left the window yet."""
        self.jumps: list[tuple[int, int]] = []
        """The times before and after each jump of the log's clock, for notes about it."""

    def add(self, frames: Iterable[Frame]) -> None:
        """Add new frames, which wait for `advance`."""
        for frame in frames:
            last = self._last
            step_ns = 0 if last is None else frame.t_ns - last.frame.t_ns
            is_cut = abs(step_ns) > self._length_ns
            if is_cut and last is not None:
                self.jumps.append((last.frame.t_ns, frame.t_ns))
            at_ns = frame.t_ns if last is None else self._latest_ns + 1 if is_cut else last.at_ns + step_ns
            self._last = _FrameOnSteadyClock(at_ns, frame, is_cut)
            self._waiting.append(self._last)
            self._latest_ns = at_ns if last is None else max(at_ns, self._latest_ns)

    @property
    def unjudged_ns(self) -> int:
        """The log time that is not judged yet."""
        if not self._waiting:
            return 0
        since_ns = self._waiting[0].at_ns if self._newest_ns is None else self._newest_ns
        return max(0, self._latest_ns - since_ns)

    def advance(self, most_ns: int) -> bool:
        """Move the window forward over waiting frames, by at most `most_ns`. Return whether it moved."""
        if not self._waiting:
            return False
        until_ns = most_ns + (self._waiting[0].at_ns if self._newest_ns is None else self._newest_ns)
        has_moved = False
        while self._waiting and (not has_moved or (self._waiting[0].at_ns <= until_ns and not self._waiting[0].is_cut)):
            entry = self._waiting.popleft()
            if entry.is_cut:
                self._frames.clear()
                self.is_whole = False
            self._frames.append(entry)
            self._newest_ns = entry.at_ns if self._newest_ns is None else max(entry.at_ns, self._newest_ns)
            has_moved = True
        while self._newest_ns is not None and self._frames[0].at_ns < self._newest_ns - self._length_ns:
            self._frames.popleft()
            self.is_whole = False
        return has_moved

    @property
    def frames(self) -> list[Frame]:
        """The frames of the window in the order of their arrival."""
        return [entry.frame for entry in self._frames]

    def frames_since(self, t_ns: int) -> list[Frame]:
        """Return the frames after the last frame older than `t_ns`, or after the last jump of the log's clock if that is later.

        They include waiting frames, and are in the order of their arrival.
        """
        newest: list[Frame] = []
        for entry in chain(reversed(self._waiting), reversed(self._frames)):
            if entry.frame.t_ns < t_ns:
                break
            newest.append(entry.frame)
            if entry.is_cut:
                break
        return newest[::-1]
