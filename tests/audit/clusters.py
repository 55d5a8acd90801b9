"""Dask clusters on loopback or on hosts of their own, as processes that a test can kill."""

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

    from tests.audit.hosts import Hosts


class DaskProcesses(NamedTuple):
    """The scheduler's address, its process, those of its workers, and the folders of their temporary files."""

    address: str
    scheduler: subprocess.Popen[bytes]
    workers: list[subprocess.Popen[bytes]]
    temporary: list[Path]

    def wait_for_task(self, worker: int) -> None:
        """Wait until a worker judges its first drives, for which it makes a folder. It takes a second or more for them."""
        for _ in range(6000):
            if any(self.temporary[worker].glob("drivelint-worker-*/tmp*")):
                return
            time.sleep(0.02)
        raise AssertionError(f"worker {worker} has got no task")


@contextmanager
def dask(home: Path, n_workers: int, port: int = 0, hosts: Hosts | None = None) -> Iterator[DaskProcesses]:
    """Run a scheduler and workers of one thread each; they end with the block.

    `hosts`: the scheduler runs on host 0, and worker n on host n + 1. They notice after 11 s that a connection is cut.
    """
    environment = {**os.environ, "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}
    if hosts is not None:
        environment["DASK_DISTRIBUTED__COMM__TIMEOUTS__TCP"] = "11s"  # the least that Dask takes
    running: list[subprocess.Popen[bytes]] = []

    def start(words: Sequence[str], name: str) -> Path:
        on = [] if hosts is None else hosts.on(len(running))
        temporary = home / name
        temporary.mkdir(parents=True)
        with (home / f"{name}.log").open("wb") as file:
            command = [*on, sys.executable, "-m", "dask", *words]
            own = {**environment, "TMPDIR": str(temporary)}
            running.append(subprocess.Popen(command, stdout=file, stderr=file, env=own))
        return temporary

    try:
        host = "127.0.0.1" if hosts is None else hosts.address(0)
        start(["scheduler", "--host", host, "--port", str(port), "--no-dashboard"], "scheduler")
        address = _wait_for_text(home / "scheduler.log", r"Scheduler at:\s+(tcp://\S+)")
        words = ["worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--memory-limit", "0"]
        temporary = [start(words, f"worker{n}") for n in range(n_workers)]
        for n in range(n_workers):
            _wait_for_text(home / f"worker{n}.log", r"(Registered to)")
        yield DaskProcesses(address, running[0], running[1:], temporary)
    finally:
        for each in running:
            with suppress(ProcessLookupError):
                each.send_signal(signal.SIGKILL)
            each.wait()


def _wait_for_text(log: Path, pattern: str) -> str:
    """Wait until a log says something, and return it."""
    for _ in range(600):
        if found := re.search(pattern, log.read_text(encoding="utf-8", errors="replace")):
            return found[1]
        time.sleep(0.1)
    raise AssertionError(f"{log} never said {pattern}: {log.read_text(encoding='utf-8', errors='replace')[-2000:]}")
