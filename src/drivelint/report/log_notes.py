"""The notes on the logs of a run: shown during the run, and kept for the result."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from drivelint.engine.barrier import RefusedLog
    from drivelint.report.progress import Progress


class LogNote(NamedTuple):
    """A note on a log. `once`: for all logs with this text, only the first is named."""

    path: Path
    text: str
    once: bool = False

    @property
    def full_text(self) -> str:
        """The note as a person reads it."""
        return f"{self.path.name}: {self.text}" if self.once else self.text


class LogNotes:
    """Shows the notes on the logs, and keeps them for the result."""

    def __init__(self, progress: Progress, n_logs: int) -> None:
        self.notes: list[LogNote] = []
        self._n_logs = n_logs
        self._progress = progress
        self._said: set[str] = set()

    def add(self, note: LogNote) -> None:
        """Keep a note, and show it unless it was shown of an earlier log: not a thousand times for a thousand logs."""
        self.notes.append(note)
        if not (note.once and note.text in self._said):
            self._progress.note(note.full_text)
        if note.once:
            self._said.add(note.text)

    def add_refused(self, refused_logs: Iterable[RefusedLog]) -> None:
        """Add why logs are not judged; that of a single one is the error of the whole run."""
        for each in refused_logs if self._n_logs > 1 else ():
            self.add(LogNote(each.path, f"not judged: {each.error}"))


def same_log(path: Path, drive_id: str) -> LogNote:
    """Return the note on a log that is there twice."""
    return LogNote(path, f"{path}: the same log as one before ({drive_id}), judged once")


def told_once(notes: Iterable[LogNote]) -> Iterator[LogNote]:
    """Yield the notes; of those with `once`, the first."""
    told: set[str] = set()
    for note in notes:
        if not (note.once and note.text in told):
            yield note
        if note.once:
            told.add(note.text)
