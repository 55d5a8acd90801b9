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
    """A piece of a log that arrived at one time; only its source can read its content.

    `t_ns`: the time in nanoseconds, on a clock of the log that advances with the drive. `size`: the approximate number of bytes.
    A window may need data of earlier frames, such as a map in the first message; the source adds these data.
    """

    t_ns: int
    data: object
    size: int


class Source(Protocol):
    """Provides the frames of one drive while it is recorded."""

    @property
    def recording(self) -> Path:
        """The log of all frames, which `read_trace` can read once the source is closed."""
        ...

    @property
    def is_advanced_by_reads(self) -> bool:
        """Whether the source advances only when it is read, like a simulation that drivelint steps."""
        ...

    @property
    def is_window_due(self) -> bool:
        """Whether a source in step has provided all steps up to the next window; always False for other sources."""
        ...

    def read(self, timeout_s: float) -> Sequence[Frame] | None:
        """Return the frames since the last call, in the order of the recording; empty after `timeout_s`; None: the source has ended.

        Errors: `TraceError` if the data are no log of this kind.
        """
        ...

    def notes(self) -> Sequence[str]:
        """Return notes on the source since the last call, such as lost frames."""
        ...

    def window_reader(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Callable[[], Trace]:
        """Return a function that reads a log of these frames alone, as the recording is read. Another thread may call the function.

        `folder`: for temporary files. Each window starts no earlier than the previous one. While there is too little to judge, this
        method and the function raise the errors of `read_trace`.
        """
        ...

    def latest_trace(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Trace:
        """Return a log of the newest frames alone, read as the recording is read. Data that only earlier frames contain may be missing.

        Errors: as `window`.
        """
        ...

    def end_sender_if_possible(self) -> None:
        """End the program that produces the frames, if drivelint can end it."""
        ...

    def close(self) -> None:
        """Finish the recording, and close files, sockets and simulations. May be called twice."""
        ...


class WindowFileSource(ABC):
    """Base class of sources that write windows as small logs of their format."""

    is_window_due = False
    window_name: str
    """File name of a window; its suffix determines the format."""

    @abstractmethod
    def write_window(self, frames: Sequence[Frame], path: Path, *, may_omit_earlier_data: bool = False) -> None:
        """Write a log of these frames alone, which `read_trace` reads like the recording.

        `may_omit_earlier_data`: data that only earlier frames contain may be left out.
        """

    def window_reader(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Callable[[], Trace]:
        """See `Source`."""
        path = folder / self.window_name
        self.write_window(frames, path)
        return partial(read_trace, path, options)

    def latest_trace(self, frames: Sequence[Frame], folder: Path, options: IngestOptions) -> Trace:
        """See `Source`."""
        path = folder / f"latest-{self.window_name}"
        self.write_window(frames, path, may_omit_earlier_data=True)
        return read_trace(path, options)
