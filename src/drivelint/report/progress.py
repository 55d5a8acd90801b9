"""The interface through which the pipeline reports progress and notes to a person."""

from __future__ import annotations

import sys
from typing import Protocol


class Progress(Protocol):
    """Listener of the pipeline: progress and diagnostics, never results."""

    def stage(self, name: str, total: int | None = None) -> None:
        """Begin a stage of `total` units of work (None: not known)."""

    def advance(self, n: int = 1) -> None:
        """Report `n` more units of the current stage done."""

    def note(self, text: str) -> None:
        """Print a line for a person who waits."""


class Silent:
    """A `Progress` that nobody listens to."""

    def stage(self, name: str, total: int | None = None) -> None:
        """Ignore the stage."""

    def advance(self, n: int = 1) -> None:
        """Ignore the work done."""

    def note(self, text: str) -> None:
        """Ignore the note."""


class NotePrinter(Silent):
    """A `Progress` for a stderr that is no terminal: only what a person should read, one line each."""

    def note(self, text: str) -> None:
        """Print the note."""
        print(f"drivelint: {text}", file=sys.stderr, flush=True)
