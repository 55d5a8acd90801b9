"""Tasks on a Dask cluster, whose workers have one thread each and lie where logs, map and results can be reached."""

from __future__ import annotations

import logging
import time
from concurrent.futures import CancelledError
from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

from drivelint.audit.executors import ClusterError, Outcome
from drivelint.audit.worker import run_task

if TYPE_CHECKING:
    from drivelint.audit.model import Task

distributed: Any = import_module("distributed")  # not typed
ANSWER_S = 30.0
"""Seconds in which a scheduler must answer."""
WORKERLESS_S = 120.0
"""Seconds for which an audit waits for a worker when there is none."""
_LOOK_S: Final = 5.0
"""Seconds after which a wait looks whether the scheduler and workers are still there."""
_ENDED: Final = frozenset({"finished", "error"})


class DaskCluster:
    """A Dask scheduler at an address, with TLS for `tls://` as Dask's own configuration says.

    A task whose worker dies is lost once the scheduler has tried it as often as its `allowed-failures` say: set them to 0, as the
    driver tries again, each drive alone. Errors: `ClusterError` where no scheduler answers, has no workers, or they have threads.
    """

    def __init__(self, address: str) -> None:
        # Dask logs a lost scheduler with a traceback; `ClusterError` says it in one line
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

    def wait(self) -> list[Outcome]:
        """See `Executor.wait`."""
        while self._running:
            try:
                ended = distributed.wait(list(self._running), timeout=_LOOK_S, return_when="FIRST_COMPLETED").done
            except TimeoutError:
                ended = set()
            except CancelledError as error:  # our words replace its text, which lists all tasks
                lost = self._client.status != "running"
                raise self._scheduler_error(
                    "the connection was lost" if lost else "its tasks were cancelled"
                ) from error
            except Exception as error:
                raise self._scheduler_error(str(error)) from error
            if self._client.status != "running":
                raise self._scheduler_error("the connection was lost")
            # a result that was lost with its worker is among them: another worker makes it again
            ended = {future for future in ended if future.status in _ENDED}
            if ended:
                self._workerless_since = None
                return [self._outcome(future, self._running.pop(future)) for future in ended]
            self._require_workers()
        return []

    def close(self) -> None:
        """See `Executor.close`. The workers are the cluster's and stay."""
        for future in self._running:
            future.cancel()
        self._client.close(timeout=5)

    def _outcome(self, future: Any, task: Task) -> Outcome:
        try:
            return Outcome(task, future.result())
        except distributed.KilledWorker as error:
            where = error.last_worker.address if error.last_worker else "unknown"
            return Outcome(task, loss_reason=f"the worker died ({where})")
        except Exception as error:
            if future.status != "error":  # the task has not failed: its result cannot be fetched
                raise self._scheduler_error("a result could not be fetched") from error
            return Outcome(task, error=error)  # the driver distinguishes them

    def _require_workers(self) -> None:
        try:
            workers = self._client.nthreads(callback_timeout=_LOOK_S)
        except OSError:  # Dask finds out whether the connection is lost, and then cancels the tasks
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
