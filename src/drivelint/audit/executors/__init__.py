"""The executors of tasks: one small protocol, and one adapter for each engine."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from drivelint.errors import DriveLintError, ExitCode

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.audit.model import Receipt, Task


class TaskOutcome(NamedTuple):
    """The outcome of a task: its receipts, the error that it raised, or why its worker was lost (died, hung, out of memory)."""

    task: Task
    receipts: Sequence[Receipt] = ()
    error: Exception | None = None
    loss_reason: str | None = None


class Executor(Protocol):
    """Runs tasks. The driver is responsible for order, retries and quarantine."""

    @property
    def capacity(self) -> int:
        """The number of tasks that run at a time."""
        ...

    def submit(self, task: Task) -> None:
        """Submit a task."""
        ...

    def wait(self) -> list[TaskOutcome]:
        """Wait until at least one task has ended, and return the outcomes of all ended tasks; an empty list if no task is running.

        Errors: `ClusterError` if the engine does not respond.
        """
        ...

    def close(self) -> None:
        """Stop all workers, including busy ones."""
        ...


class ClusterError(DriveLintError):
    """A cluster does not answer, or was lost. The same command can be run again."""

    exit_code = ExitCode.TEMPFAIL
