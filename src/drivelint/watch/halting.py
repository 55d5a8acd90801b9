"""Starts a program whose log is watched, and ends it."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

_PR_SET_PDEATHSIG: Final = 1
GRACE_S: Final = 5.0
"""So long a program may take to end by itself when it is asked to."""


class Child:
    """A program and all that it starts, in a process group of its own. What it prints goes to stderr: stdout is for data.

    It is ended if this process dies, for whatever reason.
    """

    def __init__(self, command: Sequence[str]) -> None:
        try:
            self._process = subprocess.Popen(  # noqa: S603 - asked for
                command,
                stdin=subprocess.DEVNULL,
                stdout=sys.stderr.fileno(),
                start_new_session=True,
                preexec_fn=_end_with_parent if sys.platform == "linux" else None,  # noqa: PLW1509 - one system call
            )
        except OSError as error:
            raise UsageError(f"{command[0]}: cannot be started: {error.strerror or error}") from error

    @property
    def code(self) -> int | None:
        """The program's exit code; None: it runs."""
        return self._process.poll()

    def leave(self) -> int | None:
        """Give the program time to end by itself, then end it. Return its own exit code; None: it did not end by itself."""
        with suppress(subprocess.TimeoutExpired):
            return self._process.wait(GRACE_S)
        self.end()
        return None

    def end(self) -> None:
        """Request the group to end, and kill the remaining processes after a while."""
        self._signal(signal.SIGTERM)
        until = time.monotonic() + GRACE_S
        while self._is_there() and time.monotonic() < until:
            time.sleep(0.02)
        self._signal(signal.SIGKILL)
        self._process.wait()

    def _is_there(self) -> bool:
        """Whether any process of the group runs: the program may be a shell that has ended before what it started."""
        self._process.poll()  # a program that was not waited for is there
        return self._signal(0)

    def _signal(self, number: int) -> bool:
        try:
            os.killpg(self._process.pid, number)
        except (ProcessLookupError, PermissionError):
            return False
        return True


def _end_with_parent() -> None:
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
