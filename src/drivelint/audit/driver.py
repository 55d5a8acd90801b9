"""The driver: divides drives into tasks, gives them to the workers, repeats lost tasks, and quarantines drives that kill workers."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING, Final

from drivelint.audit.model import AuditDrive, Receipt, Task
from drivelint.audit.worker import TABLES, rows_sha256, with_key, write_batch_and_return_valid_receipts
from drivelint.drive.trace import DriveInput
from drivelint.errors import DriveLintError, InternalError
from drivelint.result import collect
from drivelint.result.names import TABLE_OF_FILE
from drivelint.result.schemas import empty_table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    import pyarrow as pa

    from drivelint.audit.executors import Executor, TaskOutcome
    from drivelint.audit.model import JudgeSettings
    from drivelint.audit.store import ResultStore

SUBMITTED_TASKS_PER_WORKER: Final = 4
"""Number of tasks per worker that are submitted and not finished: enough to keep it busy, few enough to fit into memory."""
FULL_TASK_BYTES: Final = 8_000_000
MAX_TASK_DRIVES: Final = 64
"""A task ends when its logs have `FULL_TASK_BYTES` or it has `MAX_TASK_DRIVES` drives, so short drives are judged together."""
SMALL_TASK_MAX_DRIVES: Final = 8
"""Number of drives in a task if there are few drives. Results then come early, and all workers have work."""
MOST_ATTEMPTS_PER_DRIVE: Final = 3
"""A drive is quarantined after this many workers died on it. From the second attempt on it is judged alone."""


def max_drives_per_task(n_drives: int, capacity: int) -> int:
    """Return the largest number of drives that a task may have."""
    return max(SMALL_TASK_MAX_DRIVES, min(MAX_TASK_DRIVES, n_drives // (SUBMITTED_TASKS_PER_WORKER * capacity)))


def divide_into_tasks(
    drives: Iterable[AuditDrive],
    dest: str,
    run_id: str,
    settings: JudgeSettings,
    *,
    group_size: int,
    max_drives: int = MAX_TASK_DRIVES,
    n_small: int = 0,
) -> Iterator[Task]:
    """Divide drives into tasks. Each group of `group_size` drives starts with its largest logs, so that no long log is left for the end.

    The first `n_small` tasks are small, so that an audit that is interrupted early has some results.
    """
    left, n_cut = iter(drives), 0
    while some := list(islice(left, group_size)):
        some.sort(key=lambda drive: (-drive.size, drive.log))
        part: list[AuditDrive] = []
        for drive in some:
            part.append(drive)
            largest = min(max_drives, SMALL_TASK_MAX_DRIVES) if n_cut < n_small else max_drives
            if len(part) >= largest or sum(drive_of_part.size for drive_of_part in part) >= FULL_TASK_BYTES:
                yield Task(tuple(part), dest, run_id, settings)
                part, n_cut = [], n_cut + 1
        if part:
            yield Task(tuple(part), dest, run_id, settings)
            n_cut += 1


@dataclass
class TaskDriver:
    """Runs tasks on an executor.

    `on_receipt` receives every receipt. `mark_done` receives the drives of a completed task. `between_tasks` is called between tasks.
    """

    executor: Executor
    results: ResultStore
    on_receipt: Callable[[Receipt], None]
    between_tasks: Callable[[], None] = lambda: None
    mark_done: Callable[[tuple[AuditDrive, ...]], None] = lambda _drives: None

    def run(self, todo: Iterable[Task]) -> None:
        """Run all tasks.

        Errors: any `DriveLintError` except `InternalError`, such as `OutputError`. Every other error counts as a loss of the task, and its
        drives are tried again.
        """
        waiting = iter(todo)
        again: deque[Task] = deque()
        n_running = 0
        while True:
            while n_running < SUBMITTED_TASKS_PER_WORKER * self.executor.capacity:
                task = again.popleft() if again else next(waiting, None)
                if task is None:
                    break
                self.executor.submit(task)
                n_running += 1
            if not n_running:
                return
            for outcome in self.executor.wait():
                n_running -= 1
                if isinstance(outcome.error, DriveLintError) and not isinstance(outcome.error, InternalError):
                    raise outcome.error
                if (why := _loss_reason(outcome)) is not None:
                    again.extend(self._quarantine_or_return_repeated_tasks(outcome.task, why))
                else:
                    self.mark_done(outcome.task.drives)
                for receipt in outcome.receipts:
                    self.on_receipt(receipt)
            self.between_tasks()

    def _quarantine_or_return_repeated_tasks(self, task: Task, why: str) -> list[Task]:
        """Return the tasks that repeat a lost task: one task per drive. If the task had only one drive, it is repeated until it is
        quarantined."""
        attempts = task.attempts + 1
        if len(task.drives) > 1:
            return [replace(task, drives=(drive,), attempts=attempts) for drive in task.drives]
        if attempts < MOST_ATTEMPTS_PER_DRIVE:
            return [replace(task, attempts=attempts)]
        for receipt in self._quarantine(task.drives[0], f"{attempts} workers died on this drive: {why}"):
            self.on_receipt(receipt)
        self.mark_done(task.drives)
        return []

    def _quarantine(self, drive: AuditDrive, why: str) -> list[Receipt]:
        """Write the receipt of a drive on which every worker died, and return it. Its key is the `source_id`, not a hash of the log's
        content."""
        key = drive.source_id
        name = drive.log.rpartition("/")[2]
        about = collect.unjudged_drive(name.rpartition(".")[0] or name, name, f"{drive.log}: {why}")
        rows = {table: with_key(empty_table(TABLE_OF_FILE[table]), key, None) for table in TABLES[:2]}
        rows["drives"] = with_key(about, key, drive)
        receipt = Receipt(
            key=key,
            source_id=key,
            batch="",
            status="quarantined",
            log=drive.log,
            size=drive.size,
            stamp=drive.stamp,
            drive_id=about["drive_id"][0].as_py(),
            log_sha256=None,
            map_sha256=None,
            reason=why,
            rows_sha256=rows_sha256(rows),
            tags=drive.tags,
            options=drive.options_json,
        )
        return write_batch_and_return_valid_receipts(self.results, rows, [receipt])


def _loss_reason(outcome: TaskOutcome) -> str | None:
    """Return why a task has no result; None: it has a result. An unexpected error, such as lack of memory, counts as caused by its
    drives."""
    if outcome.error is None:
        return outcome.loss_reason
    words = (str(outcome.error).splitlines() or [""])[0][:200]
    return f"the worker met an unexpected error: {type(outcome.error).__name__}: {words}"


def empty_tables() -> dict[str, pa.Table]:
    """Return all tables of an audit, each with no rows."""
    no_drive = AuditDrive("", DriveInput())
    return {
        table: with_key(empty_table(TABLE_OF_FILE[table]), "", no_drive if table == "drives" else None)
        for table in TABLES
    }
