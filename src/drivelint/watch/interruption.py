"""What Ctrl-C ends: the recording while a drive is watched, and then the check of it."""

from __future__ import annotations

from drivelint.engine.interruption import Interruption


class WatchInterruption:
    """Two runs in a row, of which one alone is interrupted: the one that goes on when it is asked for first."""

    def __init__(self) -> None:
        self.of_watch = Interruption()
        self.of_check = Interruption()
        self._running = self.of_watch
        self._asked: Interruption | None = None

    def begin_check(self) -> None:
        """From now on an interruption ends the check, unless it has ended the watch."""
        self._running = self.of_check

    def request(self) -> None:
        """Interrupt the present part; to be called again until it has ended, as that of `Interruption`."""
        self._asked = self._asked or self._running
        self._asked.request()
