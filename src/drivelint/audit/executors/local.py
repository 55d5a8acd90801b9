"""A pool of processes on this machine: one warm worker per core, with a limit of memory and of time for each task."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
from concurrent.futures import FIRST_COMPLETED, CancelledError, wait
from concurrent.futures import TimeoutError as TookTooLongError
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import resource_tracker
from typing import TYPE_CHECKING

from pebble import ProcessExpired, ProcessPool

from drivelint.audit.executors import Outcome
from drivelint.audit.worker import run_task
from drivelint.without_pandas import leave_out_pandas

if TYPE_CHECKING:
    from collections.abc import Iterator
    from concurrent.futures import Future

    from drivelint.audit.model import Receipt, Task

TASKS_PER_WORKER = 500
"""After so many tasks a worker is replaced, so that nothing that a library keeps can add up."""


class LocalPool:
    """Runs tasks in processes. A process that dies is replaced.

    `workers`: number of processes, None: one per core. `memory`: limit of one process in bytes. `timeout_s`: limit per drive in seconds.
    """

    def __init__(self, workers: int | None = None, memory: int | None = None, timeout_s: float | None = None) -> None:
        self._workers = workers or cores()
        self._memory = memory
        self._timeout_s = timeout_s
        self._pool = self._started()
        self._running: dict[Future[list[Receipt]], Task] = {}

    @property
    def capacity(self) -> int:
        """See `Executor.capacity`."""
        return self._workers

    def submit(self, task: Task) -> None:
        """See `Executor.submit`."""
        limit = None if self._timeout_s is None else self._timeout_s * len(task.drives)
        self._running[self._pool.schedule(run_task, args=[task], timeout=limit)] = task

    def wait(self) -> list[Outcome]:
        """See `Executor.wait`."""
        ended = wait(self._running, return_when=FIRST_COMPLETED).done if self._running else set()
        if any(isinstance(future.exception(), BrokenProcessPool) for future in ended):
            # a worker died between two tasks, and the pool has given up all of them
            self.close()
            self._pool = self._started()
            ended = set(self._running)
        return [_outcome(future, self._running.pop(future)) for future in ended]

    def _started(self) -> ProcessPool:
        pool = ProcessPool(
            max_workers=self._workers,
            max_tasks=TASKS_PER_WORKER,
            initializer=begin_worker,
            initargs=(self._memory, os.getpid()),
            context=multiprocessing.get_context("spawn"),  # a fork would copy threads that hold locks
        )
        with deaf_to_ctrl_c():
            _ = pool.active  # this starts the threads that start the processes
        return pool

    def close(self) -> None:
        """See `Executor.close`."""
        self._pool.stop()  # type: ignore[no-untyped-call]
        self._pool.join()


@contextmanager
def deaf_to_ctrl_c() -> Iterator[None]:
    """Block Ctrl-C in threads and processes that start inside this block: the main thread alone handles it."""
    sys.warnoptions.append("ignore:resource_tracker")  # it removes what an interrupted audit leaves, without a word
    resource_tracker.ensure_running()  # its start inside the block would end the block
    sys.warnoptions.pop()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _outcome(future: Future[list[Receipt]], task: Task) -> Outcome:
    try:
        return Outcome(task, future.result())
    except (BrokenProcessPool, CancelledError):
        return Outcome(task, lost="the workers died")
    except ProcessExpired as error:
        return Outcome(task, lost=f"the worker died (exit code {error.exitcode})")
    except TookTooLongError:
        return Outcome(task, lost="the worker took too long")
    except Exception as error:  # noqa: BLE001 - handed on: the driver tells them apart
        return Outcome(task, error=error)


def begin_worker(memory: int | None, parent: int) -> None:
    """Prepare a worker: Ctrl-C is the driver's, memory has a limit, and a worker whose driver was killed ends."""
    leave_out_pandas()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # the command's own way to end is not a worker's
    try:
        import ctypes
        import resource

        if memory is not None:
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        ctypes.CDLL(None).prctl(1, signal.SIGTERM)  # PR_SET_PDEATHSIG
        if os.getppid() != parent:
            os._exit(1)
    except (ImportError, OSError, AttributeError):  # not Linux
        return


def cores() -> int:
    """Return how many cores this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not Linux
        return os.cpu_count() or 1
