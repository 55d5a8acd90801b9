"""A pool of worker processes on this machine, one per core, each with limits of memory and computing time."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
from collections import deque
from contextlib import contextmanager, suppress
from multiprocessing import resource_tracker
from multiprocessing.connection import wait
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Final

from drivelint.audit.executors import TaskOutcome
from drivelint.audit.worker import open_judge, run_task
from drivelint.computing import resident_bytes
from drivelint.errors import InternalError
from drivelint.without_pandas import block_pandas_import

if TYPE_CHECKING:
    from collections.abc import Iterator
    from multiprocessing.connection import Connection

    from drivelint.audit.model import Receipt, Task

TASKS_BEFORE_WORKER_REPLACEMENT: Final = 500
"""A worker is replaced after this many tasks, so that leaks in libraries cannot accumulate."""
_WORKER_CHECK_PERIOD_S: Final = 0.1
_BEGUN_MESSAGE: Final = "begun"
"""The message of a worker that has opened its database. Its computing time counts from then on."""


class LocalPool:
    """Runs tasks in processes. A process that dies is replaced; a process that exceeds a limit is killed.

    `workers`: number of processes; None: one per core. `memory`: limit of resident bytes per process. `timeout_s`: limit of computing time
    per drive in seconds. The start of a process does not count, nor the time in which it waits for a processor.
    """

    def __init__(self, workers: int | None = None, memory: int | None = None, timeout_s: float | None = None) -> None:
        self._capacity = workers or core_count()
        self._memory = memory
        self._timeout_s = timeout_s
        self._waiting: deque[Task] = deque()
        self._workers: list[_Worker] = []

    @property
    def capacity(self) -> int:
        """See `Executor.capacity`."""
        return self._capacity

    def submit(self, task: Task) -> None:
        """See `Executor.submit`."""
        self._waiting.append(task)
        self._assign_tasks()

    def wait(self) -> list[TaskOutcome]:
        """See `Executor.wait`."""
        while busy := [worker for worker in self._workers if worker.task is not None]:
            heard = wait([worker.pipe for worker in busy], timeout=_WORKER_CHECK_PERIOD_S)
            outcomes = [
                worker.receive_message() if worker.pipe in heard else worker.kill_if_over_limit() for worker in busy
            ]
            if ended := [outcome for outcome in outcomes if outcome is not None]:
                self._assign_tasks()
                return ended
        return []

    def close(self) -> None:
        """See `Executor.close`."""
        for worker in self._workers:
            worker.kill()
        self._workers.clear()

    def _assign_tasks(self) -> None:
        """Give waiting tasks to idle workers, and start workers up to the capacity."""
        for worker in [candidate for candidate in self._workers if candidate.is_to_be_replaced]:
            worker.kill()
            self._workers.remove(worker)
        while self._waiting:
            idle = next((worker for worker in self._workers if worker.task is None), None)
            if idle is None and len(self._workers) == self._capacity:
                return
            if idle is None:
                idle = _Worker(self._memory, self._timeout_s)
                self._workers.append(idle)
            idle.send_task(self._waiting.popleft())


class _Worker:
    """One worker process and its task, if it has one."""

    def __init__(self, memory: int | None, timeout_s: float | None) -> None:
        context = multiprocessing.get_context("spawn")  # a fork would copy threads that hold locks
        self.pipe, theirs = context.Pipe()
        self._process = context.Process(target=_run_tasks_from_pipe, args=(theirs, os.getpid()), daemon=True)
        with block_ctrl_c():
            self._process.start()
        theirs.close()
        self._memory = memory
        self._timeout_s = timeout_s
        self._n_tasks = 0
        self.task: Task | None = None
        self._cpu_s_at_begin: float | None = None

    @property
    def is_to_be_replaced(self) -> bool:
        """Whether the worker has no task and must not get another one."""
        return self.task is None and (self._n_tasks >= TASKS_BEFORE_WORKER_REPLACEMENT or not self._process.is_alive())

    def send_task(self, task: Task) -> None:
        """Send a task to the worker."""
        self.task, self._cpu_s_at_begin = task, None
        self._n_tasks += 1
        with suppress(OSError):  # the worker has died, which `receive_message` reports
            self.pipe.send(task)

    def receive_message(self) -> TaskOutcome | None:
        """Receive a message of the worker. Return the outcome of the task; None: the task has only begun."""
        try:
            message: str | list[Receipt] | Exception = self.pipe.recv()
        except (EOFError, OSError):
            self._process.join()
            return self._kill_and_return_loss(f"the worker died (exit code {self._process.exitcode})")
        if isinstance(message, str):
            self._cpu_s_at_begin = self._last_cpu_s = self._processor_seconds()
            self._advanced_at_s = monotonic()
            return None
        task = self._remove_current_task()
        return TaskOutcome(task, error=message) if isinstance(message, Exception) else TaskOutcome(task, message)

    def kill_if_over_limit(self) -> TaskOutcome | None:
        """Kill the worker if it exceeds a limit, and return the loss as the task's outcome; None: it is within its limits."""
        if self._memory is not None and (resident := resident_bytes(self._process.pid)) > self._memory:
            return self._kill_and_return_loss(
                f"the worker took {resident / 1e6:.0f} MB of memory, but the limit is {self._memory / 1e6:.0f} MB"
            )
        if self._timeout_s is None or self._cpu_s_at_begin is None or self.task is None:
            return None
        limit_s, now_s = self._timeout_s * len(self.task.drives), self._processor_seconds()
        if now_s - self._cpu_s_at_begin > limit_s:
            return self._kill_and_return_loss(f"the worker took too long: it computed for more than {limit_s:g} s")
        if now_s > self._last_cpu_s:
            self._last_cpu_s, self._advanced_at_s = now_s, monotonic()
        elif monotonic() - self._advanced_at_s > limit_s:
            return self._kill_and_return_loss(f"the worker took too long: it did nothing for {limit_s:g} s")
        return None

    def _kill_and_return_loss(self, why: str) -> TaskOutcome:
        self.kill()
        return TaskOutcome(self._remove_current_task(), loss_reason=why)

    def _remove_current_task(self) -> Task:
        task, self.task = self.task, None
        if task is None:
            raise ValueError("a worker without a task has no outcome")
        return task

    def _processor_seconds(self) -> float:
        return processor_seconds(self._process.pid)

    def kill(self) -> None:
        """Kill the process."""
        self.pipe.close()
        self._process.kill()
        self._process.join()


def _run_tasks_from_pipe(pipe: Connection, driver_pid: int) -> None:
    """Run the tasks that arrive through the pipe. This is the main function of a worker process."""
    prepare_worker_process(driver_pid)
    while True:
        try:
            task: Task = pipe.recv()
        except (EOFError, OSError):
            return
        answer: list[Receipt] | Exception
        try:
            open_judge(task.settings)
            pipe.send(_BEGUN_MESSAGE)
            answer = run_task(task)
        except Exception as error:  # noqa: BLE001 - passed on: the driver distinguishes errors
            answer = error
        try:
            pipe.send(answer)
        except OSError:
            return
        except Exception:  # noqa: BLE001 - some errors of libraries cannot be pickled
            pipe.send(InternalError(f"{type(answer).__name__}: {answer}"))


@contextmanager
def block_ctrl_c() -> Iterator[None]:
    """Block Ctrl-C in threads and processes that start inside this block: only the main thread handles it."""
    sys.warnoptions.append("ignore:resource_tracker")  # no warnings about resources that it frees
    resource_tracker.ensure_running()  # started later, it would unblock the signal
    sys.warnoptions.pop()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def prepare_worker_process(driver_pid: int) -> None:
    """Prepare a worker process: it ignores Ctrl-C and a closed terminal, which the driver handles, and ends if its driver was killed."""
    block_pandas_import()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if (hang_up := getattr(signal, "SIGHUP", None)) is not None:  # not on Windows
        signal.signal(hang_up, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # the handler of the command is not for workers
    try:
        import ctypes

        ctypes.CDLL(None).prctl(1, signal.SIGTERM)  # PR_SET_PDEATHSIG
        if os.getppid() != driver_pid:
            os._exit(1)
    except (ImportError, OSError, AttributeError):  # not Linux
        return


def core_count() -> int:
    """Return how many cores this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not Linux
        return os.cpu_count() or 1


def processor_seconds(process: int | None) -> float:
    """Return the processor time of a process in seconds; if the system does not report it, a monotonic clock."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text(encoding="ascii", errors="replace").rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")  # utime and stime, of all its threads
    except (OSError, ValueError, IndexError):
        return monotonic()
