"""The executors of tasks: one small protocol, and an adapter for each engine that implements it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from drivelint.errors import DriveLintError, ExitCode

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.audit.model import Receipt, Task


class Outcome(NamedTuple):
    """The outcome of a task: its receipts, or the error that it raised, or why its worker was lost (died, hung, out of memory)."""

    task: Task
    receipts: Sequence[Receipt] = ()
    error: Exception | None = None
    loss_reason: str | None = None


class Executor(Protocol):
    """Runs tasks. Order, retries and quarantine are the driver's."""

    @property
    def capacity(self) -> int:
        """The number of tasks that run at a time."""
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
