"""What a source of a growing log has to do, whatever it comes from."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


class Frame(NamedTuple):
    """A piece of a log that came at one time: what it holds is known to its source alone.

    `t_ns`: its time on a clock of the log that advances as the drive does. `static`: what follows cannot be read without it,
    such as a map that only the first message has; it stays in every window.
    """

    t_ns: int
    data: object
    size: int
    static: bool = False


class Source(Protocol):
    """Gives the frames of one drive while it is recorded."""

    @property
    def recording(self) -> Path:
        """The log of all frames, which `read_trace` can read once the source is closed."""
        ...

    @property
    def in_step(self) -> bool:
        """Whether the source waits until it is asked for more, as a simulation that is stepped from here does."""
        ...

    def read(self, timeout_s: float) -> Sequence[Frame] | None:
        """Return the frames that came since, in the order of the recording; none after so many seconds; None: it has ended.

        Errors: `TraceError` for what is no log of this kind.
        """
        ...

    def notes(self) -> Sequence[str]:
        """Return what has to be told of the source since the last call, such as frames that were lost on the way."""
        ...

    def write_window(self, frames: Sequence[Frame], path: Path) -> None:
        """Write a log of these frames alone, as one that `read_trace` reads as it reads the recording."""
        ...

    def halt(self) -> None:
        """End what makes the frames, where it can be ended from here."""
        ...

    def close(self) -> None:
        """Finish the recording and let go of files, sockets and simulations. May be called twice."""
        ...
