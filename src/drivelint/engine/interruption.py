"""Stops a run from another thread, and keeps the results so far."""

from __future__ import annotations

import time
from contextlib import contextmanager
from threading import Lock
from typing import TYPE_CHECKING, Final

from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Iterator

    import duckdb


LATEST_COPY_BEGIN_AFTER_INTERRUPTION_S: Final = 20.0
"""For this time (s) after an interruption, judging of copies may still begin."""


class InterruptedRunError(Exception):
    """A batch was aborted because the run was interrupted."""


class NothingJudgedError(KeyboardInterrupt):
    """A run was interrupted before any drive was judged: there is no result."""


class Interruption:
    """Whether a run was interrupted. An interruption ends only statements of the batch that is being judged."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._con: duckdb.DuckDBPyConnection | None = None
        self.requested = False
        self._requested_s = 0.0

    def request(self) -> None:
        """Interrupt the run. Call it again while the run continues: an interrupt between two statements has no effect."""
        with self._lock:
            if not self.requested:
                self._requested_s = time.monotonic()
            self.requested = True
            if self._con is not None:
                store.interrupt(self._con)

    def forbids_new_copies(self) -> bool:
        """Return whether judging of copies must not begin: the run was interrupted more than `LATEST_COPY_BEGIN_AFTER_INTERRUPTION_S`
        ago."""
        return self.requested and time.monotonic() > self._requested_s + LATEST_COPY_BEGIN_AFTER_INTERRUPTION_S

    @contextmanager
    def interruptible(self, con: duckdb.DuckDBPyConnection) -> Iterator[None]:
        """Allow the interruption of statements on `con` inside the block.

        Errors: `InterruptedRunError` if the run was interrupted before the end of the block, whatever the block raised: an interrupted rule
        looks like a failed one.
        """
        with self._lock:
            if self.requested:
                raise InterruptedRunError
            self._con = con
        try:
            yield
        except Exception as error:
            self._forget_connection()
            if self.requested:
                raise InterruptedRunError from error
            raise
        else:
            self._forget_connection()
            if self.requested:
                raise InterruptedRunError

    def _forget_connection(self) -> None:
        with self._lock:
            self._con = None
