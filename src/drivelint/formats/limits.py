"""Limits the time and memory of reading a file: a small file can describe a huge drive or map.

The limits of processor time and memory growth depend on the size of the file. Reading that exceeds a limit is interrupted between two
Python instructions; a call into a library continues to its end.
"""

from __future__ import annotations

import ctypes
import threading
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeVar

from drivelint.computing import ProcessorClock, resident_bytes
from drivelint.receipts.events import report_not_repeatable

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.errors import DriveLintError

T = TypeVar("T")

BASE_CPU_S: Final = 60.0
CPU_S_PER_FILE_BYTE: Final = 20e-6
"""The limit of CPU time in seconds is `BASE_CPU_S` plus this per byte of the file: forty times the need of
the slowest readers for real files."""
BASE_MEMORY_BYTES: Final = 2 << 30
MEMORY_BYTES_PER_FILE_BYTE: Final = 64
"""The limit of memory in bytes is `BASE_MEMORY_BYTES` plus this per byte of the file."""
_READING_LIMIT_CHECK_PERIOD_S: Final = 0.1
_PACKAGE_FOLDER: Final = Path(__file__).parents[1]


def memory_limit_bytes(n_bytes: int) -> int:
    """Return the memory in bytes that reading a file of `n_bytes` may take."""
    return BASE_MEMORY_BYTES + n_bytes * MEMORY_BYTES_PER_FILE_BYTE


class _LimitExceededError(BaseException):
    """Interrupts reading. It is no `Exception`, because readers catch exceptions as signs of a damaged file."""


class _ReadingWatch:
    """Measures the CPU time of the thread that created it and the growth of the process's memory; interrupts that thread at a limit.

    The measuring runs in a thread of its own.
    """

    def __init__(self, n_bytes: int) -> None:
        self.seconds, self.bytes = BASE_CPU_S + n_bytes * CPU_S_PER_FILE_BYTE, memory_limit_bytes(n_bytes)
        self.excess = ""
        self._reader = threading.get_ident()
        self._work, self._before = ProcessorClock(threading.get_native_id()), resident_bytes()
        self._over, self._lock = threading.Event(), threading.Lock()

    def begin(self) -> None:
        """Start measuring."""
        threading.Thread(target=self._watch_until_end, daemon=True, name="limits of reading").start()

    def end(self) -> None:
        """Stop measuring. A pending interrupt is raised before this returns."""
        self._over.set()
        with self._lock:
            pass
        _raise_pending_interrupt()

    def _watch_until_end(self) -> None:
        while not self._over.wait(_READING_LIMIT_CHECK_PERIOD_S):
            if self._work.seconds() > self.seconds:
                excess = f"more than {self.seconds:.0f} s of computing"
            elif resident_bytes() - self._before > self.bytes:
                excess = f"more than {self.bytes >> 20} MiB of memory"
            else:
                continue
            with self._lock:
                if not self._over.is_set():
                    self.excess = excess
                    report_not_repeatable(f"reading took {excess}")
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(
                        ctypes.c_ulong(self._reader), ctypes.py_object(_LimitExceededError)
                    )
            return


def _raise_pending_interrupt() -> None:
    """Do nothing: Python raises a pending interrupt where a function begins."""


def read_within_limits(read_file: Callable[[], T], name: str, n_bytes: int, error_class: type[DriveLintError]) -> T:
    """Return the result of `read_file` for a file of `n_bytes`. Errors: `error_class`, with `name`, the exceeded limit and the module."""
    watch = _ReadingWatch(n_bytes)
    try:
        try:
            watch.begin()
            return read_file()
        finally:
            watch.end()
    except _LimitExceededError as error:
        files = [Path(frame.filename) for frame in traceback.extract_tb(error.__traceback__)]
        inner = [
            file.relative_to(_PACKAGE_FOLDER)
            for file in files
            if file.is_relative_to(_PACKAGE_FOLDER) and file != Path(__file__)
        ]
        place = inner[-1].with_suffix("").as_posix() if inner else "the end"
        raise error_class(
            f"{name}: reading took {watch.excess}, too much for a file of {n_bytes} bytes (in {place}): the file "
            "describes more than a drive or a road network contains: use a part of it"
        ) from None
