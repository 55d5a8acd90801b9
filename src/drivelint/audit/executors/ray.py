"""Runs tasks on a Ray cluster, whose workers must be able to access logs, map and results."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

from drivelint.audit.executors import ClusterError, TaskOutcome
from drivelint.audit.worker import run_task

if TYPE_CHECKING:
    from drivelint.audit.model import Task

ray: Any = import_module("ray")  # only partly typed, and not installed where types are checked
exceptions: Any = import_module("ray.exceptions")
_WORKER_LOSS_ERRORS: Final = (
    exceptions.WorkerCrashedError,
    exceptions.NodeDiedError,
    exceptions.OutOfMemoryError,
    exceptions.LocalRayletDiedError,
    exceptions.ObjectLostError,
)


class RayCluster:
    """A Ray cluster at an address (`ray://...`, or `auto` for the cluster of this machine). A task uses one CPU.

    Errors: `ClusterError` if no cluster answers.
    """

    def __init__(self, address: str) -> None:
        try:
            ray.init(address=address, log_to_driver=False, logging_level="ERROR")
            self._capacity = max(1, int(ray.cluster_resources().get("CPU", 1)))
        except (ConnectionError, OSError, TimeoutError, RuntimeError) as error:
            raise ClusterError(f"--cluster {address}: no Ray cluster answers: {error}") from error
        self._run = ray.remote(run_task).options(num_cpus=1, max_retries=0)
        self._running: dict[Any, Task] = {}

    @property
    def capacity(self) -> int:
        """See `Executor.capacity`."""
        return self._capacity

    def submit(self, task: Task) -> None:
        """See `Executor.submit`."""
        self._running[self._run.remote(task)] = task

    def wait(self) -> list[TaskOutcome]:
        """See `Executor.wait`."""
        if not self._running:
            return []
        try:
            ended, _ = ray.wait(list(self._running), num_returns=1)
        except (exceptions.RaySystemError, ConnectionError) as error:
            raise ClusterError(f"the Ray cluster is gone ({error}): start it and run the same command again") from error
        return [_task_outcome(future, self._running.pop(future)) for future in ended]

    def close(self) -> None:
        """See `Executor.close`. The cluster keeps running."""
        for future in self._running:
            ray.cancel(future, force=True)
        ray.shutdown()


def _task_outcome(future: Any, task: Task) -> TaskOutcome:
    try:
        return TaskOutcome(task, ray.get(future))
    except _WORKER_LOSS_ERRORS as error:
        return TaskOutcome(task, loss_reason=f"the worker died ({type(error).__name__})")
    except exceptions.RayTaskError as error:
        return TaskOutcome(task, error=error.cause if isinstance(error.cause, Exception) else error)
