"""Where tasks run: one small protocol, and an adapter for each engine that implements it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

from drivelint.errors import DriveLintError, ExitCode, UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.audit.model import Receipt, Task


_HOST_AND_PORT: Final = re.compile(r"[\w.-]+:\d+")
"""How Ray names a cluster to a process that runs on one of its nodes."""


class Outcome(NamedTuple):
    """What became of a task: its receipts; or the error that it raised; or why its worker was lost (died, hung, out of memory)."""

    task: Task
    receipts: Sequence[Receipt] = ()
    error: Exception | None = None
    lost: str | None = None


class Executor(Protocol):
    """Runs tasks. Order, retries and quarantine are the driver's."""

    @property
    def capacity(self) -> int:
        """How many tasks run at a time."""
        ...

    def submit(self, task: Task) -> None:
        """Hand over a task."""
        ...

    def wait(self) -> list[Outcome]:
        """Return outcomes of tasks that have ended since, at least one; nothing only where no task is running.

        Errors: `ClusterError` where the whole engine is gone.
        """
        ...

    def close(self) -> None:
        """End all workers, also those that are at work."""
        ...


class ClusterError(DriveLintError):
    """A cluster that does not answer, or is gone: the same command can be given again."""

    exit_code = ExitCode.TEMPFAIL


def open_executor(cluster: str | None, *, workers: int | None, memory: int | None, timeout_s: float | None) -> Executor:
    """Return the executor for `--cluster`, or the local one, whose options the others are.

    Errors: `UsageError` for an address of neither, or an engine that is not installed; `ClusterError`.
    """
    if cluster is None:
        from drivelint.audit.executors.local import LocalPool

        return LocalPool(workers, memory, timeout_s)
    try:
        if cluster.startswith(("tcp://", "tls://")):
            from drivelint.audit.executors.dask import DaskCluster

            return DaskCluster(cluster)
        if cluster == "auto" or cluster.startswith("ray://") or _HOST_AND_PORT.fullmatch(cluster):
            from drivelint.audit.executors.ray import RayCluster

            return RayCluster(cluster)
    except ModuleNotFoundError as error:
        extra = "ray" if error.name == "ray" else "dask"
        raise UsageError(
            f"--cluster {cluster}: {error.name} is not installed: pip install 'drivelint[{extra}]'"
        ) from error
    raise UsageError(
        f"--cluster {cluster}: give the address of a Dask scheduler (tcp://..., tls://...) or of Ray (ray://..., auto)"
    )
