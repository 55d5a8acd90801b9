"""The interface through which the pipeline reports progress and notes to the user."""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager, suppress
from threading import Event, Thread
from typing import TYPE_CHECKING, Final

from drivelint.phrases import terminal_safe_line

if TYPE_CHECKING:
    from collections.abc import Iterator

    import rich.progress


PROGRESS_PRINT_INTERVAL_S: Final = 60.0
_PRINT_DUE_CHECK_PERIOD_S: Final = 1.0
_LEAST_DONE_SHARE_FOR_TIME_ESTIMATE: Final = 0.1
"""The remaining time is estimated after this share of the work."""
_RESUMED_UNITS_REPORTED_WITHIN_S: Final = 0.5
"""Units that are reported within this time after the beginning of a stage were done by an earlier run."""


class Progress:
    """Receives progress and notes from the pipeline, but no results. This base class ignores all messages."""

    def stage(self, name: str, total: int | None = None) -> None:
        """Begin a stage of `total` units of work (None: not known)."""

    def advance(self, n: int = 1) -> None:
        """Report `n` more units of the current stage done."""

    def doing(self, activity: str, units_since_advance: float = 0.0) -> None:
        """Report the current activity within the stage. `units_since_advance`: the units done since the last call of `advance`."""

    def note(self, text: str) -> None:
        """Print a line for the user."""

    def release_terminal(self) -> None:
        """Restore the terminal before another program uses it."""


class Silent(Progress):
    """A `Progress` that ignores all messages."""


class NotePrinter(Silent):
    """A `Progress` for a stderr that is no terminal: prints each note, and the progress every minute, as one line."""

    def __init__(self) -> None:
        self._name, self._activity, self._done, self._part = "", "", 0, 0.0
        self._told_s = self._begun_s = time.monotonic()
        self._had = 0
        self._total: int | None = None

    def stage(self, name: str, total: int | None = None) -> None:
        """Begin a stage without printing anything."""
        self._name, self._total, self._begun_s = name, total, time.monotonic()
        self._activity, self._done, self._part, self._had = "", 0, 0.0, 0

    def advance(self, n: int = 1) -> None:
        """Count the units, and print the progress if the last progress line is at least a minute old."""
        self._done, self._part = self._done + n, 0.0
        if time.monotonic() - self._begun_s < _RESUMED_UNITS_REPORTED_WITHIN_S:
            self._had = self._done  # done by an earlier run: not used to estimate the time left
        self.print_progress_if_due()

    def doing(self, activity: str, units_since_advance: float = 0.0) -> None:
        """Keep the activity for the next line of progress."""
        self._activity, self._part = activity, units_since_advance

    def print_progress_if_due(self) -> None:
        """Print the progress and an estimate of the time left, if the last progress line is at least a minute old."""
        now_s = time.monotonic()
        if self._total is None or now_s - self._told_s < PROGRESS_PRINT_INTERVAL_S:
            return
        self._told_s = now_s
        new = self._done + self._part - self._had
        todo = self._total - self._had
        # no estimate from the first part of the work, which includes initialisation
        left_s = (
            (now_s - self._begun_s) / new * (todo - new)
            if new >= min(1.0, _LEAST_DONE_SHARE_FOR_TIME_ESTIMATE * todo) and new
            else None
        )
        self.note(
            f"{self._name}: {self._done:,} of {self._total:,}"
            f"{f' ({self._activity})' if self._activity else ''}{'' if left_s is None else f', {_rough_duration_text(left_s)} left'}"
        )

    def note(self, text: str) -> None:
        """Print the note."""
        with suppress(OSError):  # the reader of stderr may have closed it
            print(f"drivelint: {terminal_safe_line(text)}", file=sys.stderr, flush=True)


def _rough_duration_text(seconds: float) -> str:
    """Return a rough duration in words."""
    minutes = round(seconds / 60)
    return (
        "less than a minute"
        if minutes < 1
        else f"about {minutes} min"
        if minutes < 120
        else f"about {round(seconds / 3600)} h"
    )


@contextmanager
def note_printer() -> Iterator[NotePrinter]:
    """Yield a `NotePrinter` that also prints the progress every minute while a single step takes long."""
    printer, over = NotePrinter(), Event()

    def print_progress_until_over() -> None:
        while not over.wait(_PRINT_DUE_CHECK_PERIOD_S):
            printer.print_progress_if_due()

    teller = Thread(target=print_progress_until_over, daemon=True, name="tells how far it is")
    teller.start()
    try:
        yield printer
    finally:
        over.set()
        teller.join()


class ProgressBar(Progress):
    """A `Progress` drawn with rich."""

    def __init__(self, progress: rich.progress.Progress) -> None:
        self._progress = progress
        self._task = self._progress.add_task("starting", total=None)
        self._done = 0

    def stage(self, name: str, total: int | None = None) -> None:
        """Begin a stage: its name beside an empty bar."""
        self._done = 0
        self._progress.reset(self._task, description=name, total=total)

    def advance(self, n: int = 1) -> None:
        """Move the bar by `n` units."""
        self._done += n
        self._progress.update(self._task, completed=self._done)

    def doing(self, activity: str, units_since_advance: float = 0.0) -> None:
        """Show the activity beside the bar, and move the bar by `units_since_advance`."""
        self._progress.update(self._task, description=activity, completed=self._done + units_since_advance)

    def note(self, text: str) -> None:
        """Print a line above the bar."""
        self._progress.console.print(terminal_safe_line(text), markup=False, highlight=False)

    def release_terminal(self) -> None:
        """Remove the bar."""
        self._progress.stop()


@contextmanager
def progress_bar() -> Iterator[ProgressBar]:
    """Show a bar on a terminal's stderr, or below a notebook's cell, and remove it at the end."""
    from rich import progress as drawn
    from rich.console import Console

    columns = (
        drawn.SpinnerColumn(),
        drawn.TextColumn("{task.description}"),
        drawn.BarColumn(),
        drawn.MofNCompleteColumn(),
        drawn.TimeElapsedColumn(),
        drawn.TimeRemainingColumn(),
    )
    console = Console(stderr=True)
    if console.is_jupyter:  # rich's display for notebooks needs ipywidgets, and without them warns at each step
        console = Console(stderr=True, force_jupyter=False, force_terminal=True)
    with drawn.Progress(*columns, console=console, transient=True) as progress:
        yield ProgressBar(progress)
