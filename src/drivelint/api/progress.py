"""Progress for Python callers: it stores the pipeline's notes, and shows a progress bar only if requested."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from drivelint.report.progress import Progress, Silent, progress_bar

if TYPE_CHECKING:
    from collections.abc import Iterator


class NoteKeeper(Progress):
    """Stores the notes of the pipeline, and forwards every call to another `Progress`."""

    def __init__(self, display: Progress) -> None:
        self.notes: list[str] = []
        self._display = display

    def stage(self, name: str, total: int | None = None) -> None:
        """Begin a stage."""
        self._display.stage(name, total)

    def advance(self, n: int = 1) -> None:
        """Report `n` finished units."""
        self._display.advance(n)

    def doing(self, activity: str, units_since_advance: float = 0.0) -> None:
        """Report the current activity."""
        self._display.doing(activity, units_since_advance)

    def note(self, text: str) -> None:
        """Store a note."""
        self.notes.append(text)
        self._display.note(text)


@contextmanager
def note_keeper(show_bar: bool) -> Iterator[NoteKeeper]:
    """Yield a progress object that stores notes; with `show_bar`, it also shows the command line's progress bar on stderr."""
    if not show_bar:
        yield NoteKeeper(Silent())
        return
    with progress_bar() as progress:
        yield NoteKeeper(progress)
