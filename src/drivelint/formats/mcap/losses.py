"""The losses of an MCAP file: lost bytes, and the range of log times of the messages that these bytes may have contained."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

from drivelint.drive.trace import LostTime

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

MOST_BACKWARD_LOG_TIME_JUMP_NS: Final = 1_000_000_000
"""If log times go back by more, messages are not in the order of time, and lost bytes between two messages may be of any time."""


@dataclass(frozen=True)
class LostBytes:
    """Bytes `start` to `end` of a file, and why they were lost.

    The lost messages have log times after `since_ns` and before `until_ns`; None: no bound. `timed`: the bounds come from the lost
    messages, not from their neighbours.
    """

    start: int
    end: int
    cause: str
    since_ns: int | None
    until_ns: int | None = None
    timed: bool = False


@dataclass
class Losses:
    """The lost bytes of a file, in the order in which they were found. Its truth value: whether there are any.

    `first_ns`, `last_ns`: log times of the first and last message read so far.
    """

    lost_bytes: list[LostBytes] = field(default_factory=list)
    first_ns: int | None = None
    last_ns: int | None = None
    _latest_ns: int = -1
    _backward: bool = False
    _open: int = 0

    def __bool__(self) -> bool:
        return bool(self.lost_bytes)

    @property
    def first(self) -> LostBytes:
        """The lost bytes that were found first."""
        return self.lost_bytes[0]

    @property
    def last(self) -> LostBytes:
        """The lost bytes that were found last."""
        return self.lost_bytes[-1]

    def bound_loss_times_by_message(self, log_ns: int) -> None:
        """Record the log time of a message that was read: it bounds the lost bytes before and after it."""
        if self.first_ns is None:
            self.first_ns = log_ns
        for k in range(self._open, len(self.lost_bytes)):
            if not self.lost_bytes[k].timed:
                self.lost_bytes[k] = replace(self.lost_bytes[k], until_ns=log_ns)
        self._open = len(self.lost_bytes)
        self._backward = self._backward or log_ns < self._latest_ns - MOST_BACKWARD_LOG_TIME_JUMP_NS
        self._latest_ns = max(self._latest_ns, log_ns)
        self.last_ns = log_ns

    def add(self, start: int, end: int, cause: str, since_ns: int | None = None, until_ns: int | None = None) -> None:
        """Add lost bytes; `since_ns` and `until_ns`: the log times of their first and last message, if the index has them."""
        if since_ns is None or until_ns is None:
            self.lost_bytes.append(LostBytes(start, end, cause, self.last_ns))
        else:
            self.lost_bytes.append(LostBytes(start, end, cause, since_ns - 1, until_ns + 1, timed=True))
            self._open = len(self.lost_bytes)

    def add_undecodable_message(self, offset: int, cause: str, log_ns: int) -> None:
        """Add a message that cannot be decoded."""
        self.lost_bytes.append(LostBytes(offset, offset, cause, log_ns - 1, log_ns + 1, timed=True))

    @property
    def has_lost_bytes(self) -> bool:
        """Whether bytes are lost, not only single messages that cannot be decoded."""
        return any(loss.end > loss.start for loss in self.lost_bytes)

    def covers(self, offset: int) -> bool:
        """Return whether the byte at `offset` is lost."""
        return any(loss.start <= offset < loss.end for loss in self.lost_bytes)

    def bound_loss_times_by_chunks(self, chunks: Mapping[int, tuple[int, int, int]]) -> None:
        """Bound the times of lost bytes by the times that the index has for the chunks in them.

        `chunks`: offset of a chunk -> its length, first and last log time.
        """
        for k, loss in enumerate(self.lost_bytes):
            inside = [times for offset, (_, *times) in chunks.items() if loss.start <= offset < loss.end]
            if inside and not loss.timed:
                since, until = min(a for a, _ in inside) - 1, max(b for _, b in inside) + 1
                self.lost_bytes[k] = replace(loss, since_ns=since, until_ns=until, timed=True)

    def lost_times(self, path: Path) -> list[LostTime]:
        """Return the losses as ranges of log time, each with a text for the user."""
        lost_times = []
        for loss in self.lost_bytes:
            since, until = loss.since_ns, loss.until_ns
            if self._backward and not loss.timed:
                since = until = None
            elif since is not None and until is not None and until < since:
                since, until = until, since
            cause = loss.cause.removeprefix(f"{path}: ")
            cause = cause.partition(": the log is damaged")[0].partition(": record or copy")[0]
            if loss.end > loss.start:
                cause = f"{loss.end - loss.start} bytes from byte {loss.start} on cannot be read ({cause})"
            lost_times.append(LostTime(since, until, f"{path.name}: {cause}"))
        return lost_times


def lost_times_of_parts(parts: Sequence[tuple[Path, Losses]]) -> list[LostTime]:
    """Return the losses of a log in several files, given in their order.

    If a loss has no bound, it gets the time of the last message in earlier files, or of the first in later files.
    """
    lost_times = []
    for k, (path, losses) in enumerate(parts):
        before = max(
            (other_losses.last_ns for _, other_losses in parts[:k] if other_losses.last_ns is not None), default=None
        )
        after = min(
            (other_losses.first_ns for _, other_losses in parts[k + 1 :] if other_losses.first_ns is not None),
            default=None,
        )
        for lost_time in losses.lost_times(path):
            since = before if lost_time.since_ns is None else lost_time.since_ns
            lost_times.append(
                lost_time._replace(since_ns=since, until_ns=after if lost_time.until_ns is None else lost_time.until_ns)
            )
    return lost_times
