"""Dask and Ray clusters on loopback, as processes that a test can kill."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path


class DaskProcesses(NamedTuple):
    """The scheduler's address, its process, and those of its workers."""

    address: str
    scheduler: subprocess.Popen[bytes]
    workers: list[subprocess.Popen[bytes]]


@contextmanager
def dask(home: Path, n_workers: int, port: int = 0) -> Iterator[DaskProcesses]:
    """Run a scheduler and workers of one thread each; they end with the block."""
    quiet = {**os.environ, "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}
    log = home / "scheduler.log"
    running = [_start(["scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard"], log, quiet)]
    try:
        address = _told(log, r"Scheduler at:\s+(tcp://\S+)")
        for n in range(n_workers):
            words = ["worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--memory-limit", "0"]
            running.append(_start([*words, "--local-directory", str(home)], home / f"worker{n}.log", quiet))
        for n in range(n_workers):
            _told(home / f"worker{n}.log", r"(Registered to)")
        yield DaskProcesses(address, running[0], running[1:])
    finally:
        for each in running:
            with suppress(ProcessLookupError):
                each.send_signal(signal.SIGKILL)
            each.wait()


def _start(words: Sequence[str], log: Path, environment: dict[str, str]) -> subprocess.Popen[bytes]:
    with log.open("wb") as file:
        return subprocess.Popen([sys.executable, "-m", "dask", *words], stdout=file, stderr=file, env=environment)


def _told(log: Path, pattern: str) -> str:
    """Wait until a log says something, and return it."""
    for _ in range(600):
        if found := re.search(pattern, log.read_text(encoding="utf-8", errors="replace")):
            return found[1]
        time.sleep(0.1)
    raise AssertionError(f"{log} never said {pattern}: {log.read_text(encoding='utf-8', errors='replace')[-2000:]}")
