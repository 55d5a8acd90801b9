"""Audits that judge in the process of the test."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drivelint.audit import AuditRequest, JudgeSettings, audit
from drivelint.audit.executors import TaskOutcome
from drivelint.audit.worker import run_task
from drivelint.report.progress import Silent
from tests.audit import fleet

if TYPE_CHECKING:
    from drivelint.audit import AuditSummary
    from drivelint.audit.model import Task

SETTINGS = JudgeSettings(rules=(fleet.RULE,), memory=200_000_000)


@dataclass
class InThisProcess:
    """An executor that judges in this process, and loses the tasks that have a log of `poison`."""

    poison: str = "nothing"
    capacity: int = 2
    tasks: list[Task] = field(default_factory=list)
    lost_sizes: list[int] = field(default_factory=list)

    def submit(self, task: Task) -> None:
        self.tasks.append(task)

    def wait(self) -> list[TaskOutcome]:
        task = self.tasks.pop(0)
        if any(self.poison in drive.log for drive in task.drives):
            self.lost_sizes.append(len(task.drives))
            return [TaskOutcome(task, loss_reason="the worker died")]
        return [TaskOutcome(task, run_task(task))]

    def close(self) -> None:
        pass


class Stopped(InThisProcess):
    """An executor that interrupts the audit before its last two tasks."""

    def wait(self) -> list[TaskOutcome]:
        if len(self.tasks) < 2:
            raise KeyboardInterrupt
        return super().wait()


def run_audit(
    drives: fleet.Fleet,
    out: Path | str,
    executor: InThisProcess | None = None,
    *,
    sources: str | None = None,
    road: str | None = None,
    **options: Any,
) -> AuditSummary:
    """Audit a fleet; `sources` and `road`: where it is copied to."""
    where = Path(road) if road else drives.road
    request = AuditRequest(
        sources=(sources or str(drives.manifest),), map=where, out=str(out), settings=SETTINGS, **options
    )
    return audit(request, Silent(), executor or InThisProcess())
