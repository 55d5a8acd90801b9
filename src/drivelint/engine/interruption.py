"""Stops a run from another thread, so that the results so far can be kept."""

from __future__ import annotations

import time
from contextlib import contextmanager
from threading import Lock
from typing import TYPE_CHECKING, Final

from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Iterator

    import duckdb


COPIES_S: Final = 20.0
"""Time after an interruption in which judging of copies may still begin."""


class InterruptedRunError(Exception):
    """A batch was given up because the run was interrupted."""


class NothingJudgedError(KeyboardInterrupt):
    """A run was interrupted before any drive was judged: there is no result."""


class Interruption:
    """Whether a run was interrupted. It ends the statements of a batch that is being judged, and no other ones."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._con: duckdb.DuckDBPyConnection | None = None
        self.requested = False
        self._requested_s = 0.0

    def request(self) -> None:
        """Interrupt the run; to be called again while it goes on, as an interrupt between two statements is lost."""
        with self._lock:
            if not self.requested:
                self._requested_s = time.monotonic()
            self.requested = True
            if self._con is not None:
                store.interrupt(self._con)

    def ends_judging_of_copies(self) -> bool:
        """Whether judging of copies may no longer begin: for complete batches it still may for a while, so that the result has them."""
        return self.requested and time.monotonic() > self._requested_s + COPIES_S

    @contextmanager
    def interruptible(self, con: duckdb.DuckDBPyConnection) -> Iterator[None]:
        """Let statements on `con` be interrupted inside the block.

        Errors: `InterruptedRunError` before it, or at its end whatever came of it: a rule that was interrupted looks like one that erred.
        """
        with self._lock:
            if self.requested:
                raise InterruptedRunError
            self._con = con
        try:
            yield
        except Exception as error:
            self._release()
            if self.requested:
                raise InterruptedRunError from error
            raise
        else:
            self._release()
            if self.requested:
                raise InterruptedRunError

    def _release(self) -> None:
        with self._lock:
            self._con = None
