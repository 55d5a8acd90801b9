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
GRACE_BEFORE_KILL_S: Final = 5.0
"""How long a program may take to end before it is killed."""


class ChildProgram:
    """A program and all processes that it starts, in a process group of its own. Its output goes to stderr: stdout is for data.

    The program is ended if this process dies, for whatever reason.
    """

    def __init__(self, command: Sequence[str]) -> None:
        try:
            self._process = subprocess.Popen(  # noqa: S603 - the user gave the command
                command,
                stdin=subprocess.DEVNULL,
                stdout=sys.stderr.fileno(),
                start_new_session=True,
                preexec_fn=_end_with_parent if sys.platform == "linux" else None,  # noqa: PLW1509 - one system call
            )
        except OSError as error:
            raise UsageError(f"{command[0]}: cannot be started: {error.strerror or error}") from error

    @property
    def exit_code(self) -> int | None:
        """The program's exit code; None: it still runs."""
        return self._process.poll()

    def wait_or_end(self) -> int | None:
        """Wait until the program ends, but end it after `GRACE_BEFORE_KILL_S`. Return its exit code; None: it did not end by itself."""
        with suppress(subprocess.TimeoutExpired):
            return self._process.wait(GRACE_BEFORE_KILL_S)
        self.end()
        return None

    def end(self) -> None:
        """Send SIGTERM to the process group, and kill the processes that remain after `GRACE_BEFORE_KILL_S`."""
        self._send_signal(signal.SIGTERM)
        until = time.monotonic() + GRACE_BEFORE_KILL_S
        while self._is_any_process_running() and time.monotonic() < until:
            time.sleep(0.02)
        self._send_signal(signal.SIGKILL)
        self._process.wait()

    def _is_any_process_running(self) -> bool:
        """Return whether any process of the group runs: a shell may end before the processes that it started."""
        self._process.poll()  # an ended process counts as running until it is polled
        return self._send_signal(0)

    def _send_signal(self, number: int) -> bool:
        try:
            os.killpg(self._process.pid, number)
        except (ProcessLookupError, PermissionError):
            return False
        return True


def _end_with_parent() -> None:
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
