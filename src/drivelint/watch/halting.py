"""Starts a program whose log is watched, and ends it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

GRACE_S: Final = 5.0
"""So long a program may take to end by itself when it is asked to."""


class Child:
    """A program and all that it starts, in a process group of its own. What it prints goes to stderr: stdout is for data."""

    def __init__(self, command: Sequence[str]) -> None:
        try:
            self._process = subprocess.Popen(command, stdout=sys.stderr.fileno(), start_new_session=True)  # noqa: S603 - asked for
        except OSError as error:
            raise UsageError(f"{command[0]}: cannot be started: {error.strerror or error}") from error

    @property
    def code(self) -> int | None:
        """The program's exit code; None: it runs."""
        return self._process.poll()

    def leave(self) -> None:
        """Give the program time to end by itself, then end it."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(GRACE_S)
        self.end()

    def end(self) -> None:
        """Ask the group to end, and kill it if it does not."""
        for number in (signal.SIGTERM, signal.SIGKILL):
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, number)
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(GRACE_S)
                break
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)  # children that outlived it
