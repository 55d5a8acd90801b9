"""The interface of a source of a growing log."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import partial
from typing import TYPE_CHECKING, NamedTuple, Protocol

from drivelint.formats import read_trace

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from drivelint.drive.trace import IngestOptions, Trace


class Frame(NamedTuple):
    """A piece of a log that came at one time: only its source knows its content.

    `t_ns`: its time on a clock of the log that advances as the drive does, in nanoseconds. `size`: about how many bytes it takes.
    What must be known of earlier frames, such as a map that only the first message has, its source adds to a window.
    """

    t_ns: int
    data: object
    size: int


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

    @property
    def is_due(self) -> bool:
        """Whether such a source has given all steps until the next window is to be judged; never of one that goes on by itself."""
        ...

    def read(self, timeout_s: float) -> Sequence[Frame] | None:
        """Return the frames that came since, in the order of the recording; none after so many seconds; None: it has ended.

        Errors: `TraceError` for what is no log of this kind.
        """
        ...

    def notes(self) -> Sequence[str]:
        """Return notes on the source since the last call, such as lost frames."""
        ...

    def window(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Callable[[], Trace]:
        """Return what reads a log of these frames alone, as the recording is read, and may do so in another thread.

        `folder` may be written to. Windows begin one after another as the drive does. Both raise what `read_trace` does, while there is
        too little to judge.
        """
        ...

    def latest(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Trace:
        """Return a log of the newest frames alone, read as the recording is read; what holds of earlier ones may be missing.

        Errors: as above.
        """
        ...

    def halt(self) -> None:
        """End what makes the frames, where it can be ended from here."""
        ...

    def close(self) -> None:
        """Finish the recording and let go of files, sockets and simulations. May be called twice."""
        ...


class WrittenWindows(ABC):
    """The part of a source that writes windows as small logs of its format."""

    is_due = False
    window_name: str
    """Name of the file of a window, which determines the format."""

    @abstractmethod
    def write_window(self, frames: Sequence[Frame], path: Path, *, latest: bool = False) -> None:
        """Write a log of these frames alone, as one that `read_trace` reads as it reads the recording.

        `latest`: what holds of earlier frames may be left out.
        """

    def window(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Callable[[], Trace]:
        """See `Source`."""
        path = folder / self.window_name
        self.write_window(frames, path)
        return partial(read_trace, path, options)

    def latest(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Trace:
        """See `Source`."""
        path = folder / f"latest-{self.window_name}"
        self.write_window(frames, path, latest=True)
        return read_trace(path, options)
