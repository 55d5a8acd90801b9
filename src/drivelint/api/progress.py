"""Progress for a caller in Python: nothing is shown unless requested, and the notes are kept."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from drivelint.report.progress import Progress, Silent, bar

if TYPE_CHECKING:
    from collections.abc import Iterator


class NoteKeeper(Progress):
    """Keeps the notes of the pipeline, and hands all on to another `Progress`."""

    def __init__(self, display: Progress) -> None:
        self.notes: list[str] = []
        self._display = display

    def stage(self, name: str, total: int | None = None) -> None:
        """Begin a stage."""
        self._display.stage(name, total)

    def advance(self, n: int = 1) -> None:
        """Report units done."""
        self._display.advance(n)

    def doing(self, activity: str, part: float = 0.0) -> None:
        """Say what is done."""
        self._display.doing(activity, part)

    def note(self, text: str) -> None:
        """Keep the note."""
        self.notes.append(text)
        self._display.note(text)


@contextmanager
def kept_notes(show: bool) -> Iterator[NoteKeeper]:
    """Keep the notes; `show`: with a bar on stderr, as the command line has it."""
    if not show:
        yield NoteKeeper(Silent())
        return
    with bar() as shown:
        yield NoteKeeper(shown)
