"""Measures the cost of work: processor seconds, which do not depend on other programs of the machine, and memory."""

from __future__ import annotations

import os
import threading
from contextlib import suppress
from time import process_time


class ProcessorClock:
    """Counts the processor seconds of this process without its other Python threads, such as threads that read logs.

    `thread_id`: the system's number of the thread whose work is counted. The threads of the database work for it and are counted, too.
    """

    def __init__(self, thread_id: int) -> None:
        self._thread = thread_id
        self._seconds = 0.0
        self._process_s, self._others_s = process_time(), self._cpu_s_of_other_threads()

    def seconds(self) -> float:
        """Return the processor seconds counted so far."""
        process_s, others_s = process_time(), self._cpu_s_of_other_threads()
        by_others = sum(now - self._others_s.get(thread, 0.0) for thread, now in others_s.items())
        self._seconds += max(0.0, process_s - self._process_s - by_others)
        self._process_s, self._others_s = process_s, others_s
        return self._seconds

    def _cpu_s_of_other_threads(self) -> dict[int, float]:
        """Return thread number -> processor seconds of each other Python thread; empty if the system does not report them."""
        seconds: dict[int, float] = {}
        for thread in threading.enumerate():
            if (number := thread.native_id) is not None and number != self._thread:
                with suppress(OSError, ValueError, IndexError):
                    seconds[number] = int(_read_system_file(f"/proc/self/task/{number}/schedstat").split()[0]) / 1e9
        return seconds


def resident_bytes(process: int | None = None) -> int:
    """Return the resident memory of a process (None: this process); 0 if the system does not report it."""
    try:
        return int(_read_system_file(f"/proc/{process or 'self'}/statm").split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, IndexError):  # the file may be empty if the process ends during the read
        return 0


def _read_system_file(path: str) -> bytes:
    """Return the first 1024 bytes of a system file, without a `Path` object: creating it would take longer than reading the file."""
    file = os.open(path, os.O_RDONLY)
    try:
        return os.read(file, 1024)
    finally:
        os.close(file)
