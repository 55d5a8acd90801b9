"""Keeps the frames of the last seconds of a log, and reads them as a log of their own."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.watch.source import Frame

S: Final = 1_000_000_000
"""Nanoseconds of a second."""


class Window:
    """The frames of the last `length_ns` of a log, and those that have come but are not judged yet.

    Static frames stay for good. Memory: frames of the window and of what waits.
    """

    def __init__(self, length_ns: int) -> None:
        self._length_ns = length_ns
        self._static: list[Frame] = []
        self._frames: deque[Frame] = deque()
        self._waiting: deque[Frame] = deque()
        self._newest_ns: int | None = None
        self._newest_waiting_ns: int | None = None
        self.is_whole = True
        """No frame of the log has left the window yet."""

    def add(self, frames: Iterable[Frame]) -> None:
        """Take frames that came; they wait until `advance`."""
        for frame in frames:
            self._waiting.append(frame)
            self._newest_waiting_ns = max(frame.t_ns, self._newest_waiting_ns or frame.t_ns)

    @property
    def behind_ns(self) -> int:
        """How much log time waits to be judged."""
        if self._newest_waiting_ns is None:
            return 0
        first = self._newest_ns if self._newest_ns is not None else self._waiting[0].t_ns if self._waiting else 0
        return max(0, self._newest_waiting_ns - first)

    def advance(self, most_ns: int) -> bool:
        """Move the window forward over what waits, by at most `most_ns`. Return whether it moved."""
        if not self._waiting:
            return False
        until = (self._waiting[0].t_ns if self._newest_ns is None else self._newest_ns) + most_ns
        moved = False
        # behind a hole in the log's time the window moves all the same
        while self._waiting and (self._waiting[0].t_ns <= until or not moved):
            frame = self._waiting.popleft()
            (self._static if frame.static else self._frames).append(frame)
            self._newest_ns = max(frame.t_ns, frame.t_ns if self._newest_ns is None else self._newest_ns)
            moved = True
        assert self._newest_ns is not None  # noqa: S101 - one frame was taken
        while self._frames and self._frames[0].t_ns < self._newest_ns - self._length_ns:
            self._frames.popleft()
            self.is_whole = False
        return moved

    @property
    def frames(self) -> list[Frame]:
        """The frames in the order in which they came, the static ones first."""
        return [*self._static, *self._frames]

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to judge."""
        return not self._frames and not self._static
