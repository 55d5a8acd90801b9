"""The interface through which the pipeline reports progress and notes to a person."""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Final

from drivelint.phrases import inert_line

if TYPE_CHECKING:
    from collections.abc import Iterator

    import rich.progress


TELL_EVERY_S: Final = 60.0


class Progress:
    """Listener of the pipeline: progress and diagnostics, never results. This one ignores what it is told."""

    def stage(self, name: str, total: int | None = None) -> None:
        """Begin a stage of `total` units of work (None: not known)."""

    def advance(self, n: int = 1) -> None:
        """Report `n` more units of the current stage done."""

    def doing(self, what: str) -> None:
        """Say what is done within the stage; its units stay as they are."""

    def note(self, text: str) -> None:
        """Print a line for a person who waits."""

    def leave(self) -> None:
        """Leave the terminal as it was, before another program takes over."""


class Silent(Progress):
    """A `Progress` that nobody listens to."""


class NotePrinter(Silent):
    """A `Progress` for a stderr that is no terminal: what a person should read, and every minute how far it is, one line each."""

    def __init__(self) -> None:
        self._name, self._done, self._told_s = "", 0, time.monotonic()
        self._total: int | None = None

    def stage(self, name: str, total: int | None = None) -> None:
        """Begin a stage; nothing is printed yet."""
        self._name, self._total, self._done = name, total, 0

    def advance(self, n: int = 1) -> None:
        """Print how far the stage is, if nothing was printed of it for a while."""
        self._done += n
        if self._total is not None and time.monotonic() - self._told_s >= TELL_EVERY_S:
            self._told_s = time.monotonic()
            self.note(f"{self._name}: {self._done:,} of {self._total:,}")

    def note(self, text: str) -> None:
        """Print the note."""
        with suppress(OSError):  # nobody may listen any more
            print(f"drivelint: {inert_line(text)}", file=sys.stderr, flush=True)


class Bar(Progress):
    """A `Progress` drawn with rich."""

    def __init__(self, progress: rich.progress.Progress) -> None:
        self._progress = progress
        self._task = self._progress.add_task("starting", total=None)

    def stage(self, name: str, total: int | None = None) -> None:
        """Begin a stage: its name beside an empty bar."""
        self._progress.reset(self._task, description=name, total=total)

    def advance(self, n: int = 1) -> None:
        """Move the bar by `n` units."""
        self._progress.advance(self._task, n)

    def doing(self, what: str) -> None:
        """Show it beside the bar."""
        self._progress.update(self._task, description=what)

    def note(self, text: str) -> None:
        """Print a line above the bar."""
        self._progress.console.print(inert_line(text), markup=False, highlight=False)

    def leave(self) -> None:
        """Take the bar away."""
        self._progress.stop()


@contextmanager
def bar() -> Iterator[Bar]:
    """Show a bar on a terminal's stderr, which goes away at the end, or under a notebook's cell."""
    from rich import progress as drawn
    from rich.console import Console

    columns = (
        drawn.SpinnerColumn(),
        drawn.TextColumn("{task.description}"),
        drawn.BarColumn(),
        drawn.MofNCompleteColumn(),
        drawn.TimeElapsedColumn(),
    )
    console = Console(stderr=True)
    if console.is_jupyter:  # rich's own way needs ipywidgets, and warns at each step where they are not installed
        console = Console(stderr=True, force_jupyter=False, force_terminal=True)
    with drawn.Progress(*columns, console=console, transient=True) as progress:
        yield Bar(progress)
