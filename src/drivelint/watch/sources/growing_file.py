"""Reads the bytes that another process appends to a file, each byte once."""

from __future__ import annotations

import os
import stat
import time
from typing import TYPE_CHECKING, Final

from drivelint.errors import TraceError

if TYPE_CHECKING:
    from io import FileIO
    from pathlib import Path

GROWTH_CHECK_PERIOD_S: Final = 0.05
"""The interval at which a file is checked for growth."""
MOST_BYTES_PER_READ: Final = 4 << 20
"""The most bytes that are read at a time."""


class GrowingFile:
    """A file that grows, or that does not exist yet.

    `idle_s`: seconds without growth after which the file counts as ended; None: no limit.
    """

    def __init__(self, path: Path, *, idle_s: float | None) -> None:
        self.path = path
        self.offset = 0
        self._idle_s = idle_s
        self._grew_at = time.monotonic()
        self._file: FileIO | None = None

    def read(self, timeout_s: float) -> bytes | None:
        """Return the appended bytes; empty after `timeout_s`; None: the file has not grown for `idle_s`.

        Errors: `TraceError` for a file that was truncated, replaced or removed, or that cannot be read.
        """
        until = time.monotonic() + timeout_s
        while True:
            if data := self._read_appended():
                self._grew_at = time.monotonic()
                return data
            now = time.monotonic()
            if self._idle_s is not None and now - self._grew_at >= self._idle_s:
                return None
            if now >= until:
                return b""
            time.sleep(min(GROWTH_CHECK_PERIOD_S, until - now))

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()

    def _read_appended(self) -> bytes:
        try:
            if self._file is None:
                try:
                    if not stat.S_ISREG(self.path.stat().st_mode):
                        raise TraceError(
                            f"{self.path}: a pipe, a device or a folder: a file that grows is watched, and - reads stdin"
                        )
                    self._file = self.path.open("rb", buffering=0)
                except FileNotFoundError:
                    return b""
            self._refuse_replaced_or_truncated(self._file)
            data = self._file.read(MOST_BYTES_PER_READ)
        except OSError as error:
            raise TraceError(f"{self.path}: cannot be read: {error.strerror or error}") from error
        self.offset += len(data)
        return data

    def _refuse_replaced_or_truncated(self, file: FileIO) -> None:
        status = os.fstat(file.fileno())
        try:
            there = self.path.stat()
        except FileNotFoundError:
            there = None
        if there is None or not os.path.samestat(status, there):
            change = "taken away" if there is None else "replaced by another file"
        elif status.st_size < self.offset:
            change = f"truncated to {status.st_size} of {self.offset} bytes"
        else:
            return
        raise TraceError(f"{self.path}: the log was {change} while it was watched: watch it again")
