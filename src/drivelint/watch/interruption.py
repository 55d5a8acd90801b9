"""The effect of Ctrl-C: it ends the recording while a drive is watched, and later the check of the recording."""

from __future__ import annotations

from drivelint.engine.interruption import Interruption


class InterruptionOfWatchOrCheck:
    """Interrupts only one of two successive parts, the watch and the check: the part that runs at the first request."""

    def __init__(self) -> None:
        self.of_watch = Interruption()
        self.of_check = Interruption()
        self._running = self.of_watch
        self._asked: Interruption | None = None

    def switch_to_check(self) -> None:
        """Let later interruptions end the check, unless the watch was already interrupted."""
        self._running = self.of_check

    def request(self) -> None:
        """Interrupt the running part; to be called again until it has ended, like `Interruption.request`."""
        self._asked = self._asked or self._running
        self._asked.request()
