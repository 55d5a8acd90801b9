"""Runs tasks on a Dask cluster. Its workers have one thread each, and must be able to access logs, map and results."""

from __future__ import annotations

import logging
import time
from concurrent.futures import CancelledError
from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

from drivelint.audit.executors import ClusterError, TaskOutcome
from drivelint.audit.worker import run_task

if TYPE_CHECKING:
    from drivelint.audit.model import Task

distributed: Any = import_module("distributed")  # not typed
ANSWER_S = 30.0
"""Seconds in which a scheduler must answer."""
WORKERLESS_S = 120.0
"""Seconds for which an audit waits for a worker if the cluster has none."""
_CLUSTER_CHECK_PERIOD_S: Final = 5.0
"""Seconds between checks whether the scheduler and workers are still there."""
_STATUSES_OF_ENDED_TASKS: Final = frozenset({"finished", "error"})


class DaskCluster:
    """A Dask scheduler at an address; for `tls://`, Dask's own configuration sets up TLS.

    If a worker dies, the scheduler repeats the task up to `allowed-failures` times before the task is lost. Set this to 0, because the
    driver itself repeats each drive alone. Errors: `ClusterError` if no scheduler answers, it has no workers, or a worker has several
    threads.
    """

    def __init__(self, address: str) -> None:
        # Dask logs a lost scheduler with a traceback; `ClusterError` reports it in one line
        logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        try:
            self._client = distributed.Client(address, timeout=ANSWER_S)
            workers = self._client.scheduler_info(n_workers=-1)["workers"]
        except (OSError, TimeoutError, ValueError) as error:
            raise ClusterError(f"--cluster {address}: no Dask scheduler answers: {error}") from error
        if not workers:
            raise ClusterError(f"--cluster {address}: the scheduler has no workers: start some")
        if any(worker["nthreads"] != 1 for worker in workers.values()):
            raise ClusterError(f"--cluster {address}: a worker has several threads: start workers with --nthreads 1")
        self._address = address
        self._capacity = len(workers)
        self._running: dict[Any, Task] = {}
        self._workerless_since: float | None = None

    @property
    def capacity(self) -> int:
        """See `Executor.capacity`."""
        return self._capacity

    def submit(self, task: Task) -> None:
        """See `Executor.submit`."""
        self._running[self._client.submit(run_task, task, pure=False)] = task

    def wait(self) -> list[TaskOutcome]:
        """See `Executor.wait`."""
        while self._running:
            try:
                ended = distributed.wait(
                    list(self._running), timeout=_CLUSTER_CHECK_PERIOD_S, return_when="FIRST_COMPLETED"
                ).done
            except TimeoutError:
                ended = set()
            except CancelledError as error:  # our message replaces the original text, which lists all tasks
                is_lost = self._client.status != "running"
                raise self._scheduler_error(
                    "the connection was lost" if is_lost else "its tasks were cancelled"
                ) from error
            except Exception as error:
                raise self._scheduler_error(str(error)) from error
            if self._client.status != "running":
                raise self._scheduler_error("the connection was lost")
            # futures whose result was lost with a worker are skipped: another worker computes them again
            ended = {future for future in ended if future.status in _STATUSES_OF_ENDED_TASKS}
            if ended:
                self._workerless_since = None
                return [self._task_outcome(future, self._running.pop(future)) for future in ended]
            self._fail_if_long_workerless()
        return []

    def close(self) -> None:
        """See `Executor.close`. The workers belong to the cluster and keep running."""
        for future in self._running:
            future.cancel()
        self._client.close(timeout=5)

    def _task_outcome(self, future: Any, task: Task) -> TaskOutcome:
        try:
            return TaskOutcome(task, future.result())
        except distributed.KilledWorker as error:
            where = error.last_worker.address if error.last_worker else "unknown"
            return TaskOutcome(task, loss_reason=f"the worker died ({where})")
        except Exception as error:
            if future.status != "error":  # the task itself has not failed, but its result cannot be fetched
                raise self._scheduler_error("a result could not be fetched") from error
            return TaskOutcome(task, error=error)  # the driver distinguishes kinds of errors

    def _fail_if_long_workerless(self) -> None:
        try:
            workers = self._client.nthreads(callback_timeout=_CLUSTER_CHECK_PERIOD_S)
        except OSError:  # Dask itself detects a lost connection, and then cancels the tasks
            return
        now = time.monotonic()
        if workers:
            self._workerless_since = None
        elif self._workerless_since is None:
            self._workerless_since = now
        elif now - self._workerless_since >= WORKERLESS_S:
            raise ClusterError(
                f"--cluster {self._address}: no worker for {WORKERLESS_S:.0f} s: start some and run the same command again"
            )

    def _scheduler_error(self, why: str) -> ClusterError:
        return ClusterError(
            f"--cluster {self._address}: the scheduler is gone ({why}): start it and run the same command again"
        )
