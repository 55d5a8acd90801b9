"""The notes on the logs of a run: shown during the run, and kept for the result."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from drivelint.engine.barrier import RefusedLog
    from drivelint.report.progress import Progress


class LogNote(NamedTuple):
    """A note on a log. `once`: if several logs have a note with this text, only the first log's note is shown."""

    path: Path
    text: str
    once: bool = False

    @property
    def full_text(self) -> str:
        """The text that is shown; with `once` it begins with the log's name."""
        return f"{self.path.name}: {self.text}" if self.once else self.text


class LogNotes:
    """Shows the notes on the logs, and keeps them for the result."""

    def __init__(self, progress: Progress, n_logs: int) -> None:
        self.notes: list[LogNote] = []
        self._n_logs = n_logs
        self._progress = progress
        self._said: set[str] = set()

    def add(self, note: LogNote) -> None:
        """Keep a note, and show it, unless it has `once` and was shown for an earlier log."""
        self.notes.append(note)
        if not (note.once and note.text in self._said):
            self._progress.note(note.full_text)
        if note.once:
            self._said.add(note.text)

    def add_refused_logs(self, refused_logs: Iterable[RefusedLog]) -> None:
        """Add a note on each refused log; if the run has a single log, its refusal is the error of the run instead."""
        for log in refused_logs if self._n_logs > 1 else ():
            self.add(LogNote(log.path, f"not judged: {log.error}"))


def note_on_repeated_log(path: Path, drive_id: str) -> LogNote:
    """Return the note on a log with the same content as an earlier log."""
    return LogNote(path, f"{path}: the same content as the log of {drive_id}: judged once")


def notes_without_repeats(notes: Iterable[LogNote]) -> Iterator[LogNote]:
    """Yield the notes, but of several notes with `once` and the same text only the first."""
    texts: set[str] = set()
    for note in notes:
        if not (note.once and note.text in texts):
            yield note
        if note.once:
            texts.add(note.text)
