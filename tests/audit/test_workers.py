"""Workers on this machine: what one of them takes too much costs its drive only, and what others do with the machine costs nothing."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from drivelint.audit import AuditRequest, AuditSummary, audit
from drivelint.audit.driver import TaskDriver
from drivelint.audit.executors import TaskOutcome
from drivelint.audit.executors import local as pool
from drivelint.audit.model import AuditDrive, JudgeSettings, Task
from drivelint.audit.store import LocalFolder
from drivelint.drive.trace import DriveInput
from drivelint.errors import ExitCode
from drivelint.report.progress import Silent
from drivelint.result.publishing import OutputError
from tests.audit import fleet
from tests.audit.here import SETTINGS, run_audit

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.audit.model import Receipt


@pytest.mark.slow
def test_a_drive_that_exhausts_its_worker_is_quarantined_and_the_others_are_as_without_it(tmp_path: Path) -> None:
    drives = fleet.write(tmp_path / "fleet", 5)
    undisturbed = run_audit(drives, tmp_path / "before")
    log = tmp_path / "fleet" / "logs" / "drive-00005.parquet"
    fleet.write_exhausting(log, log.with_name("drive-00004.parquet"))
    counted = audit(
        AuditRequest(
            sources=(str(drives.manifest), str(log)),
            map=drives.road,
            out=str(tmp_path / "out"),
            settings=SETTINGS,
            workers=2,
            worker_memory=fleet.LITTLE_BYTES,
        ),
        Silent(),
    )
    assert (counted.n_judged, counted.quarantined) == (5, 1)
    assert "MB of memory, but the limit is 600 MB" in counted.not_judged[0]["reason"]
    alone = run_audit(drives, tmp_path / "out", prune=True)
    assert (alone.reused, alone.digest) == (5, undisturbed.digest)


class Meets:
    """An executor whose worker meets an error with every task that has a log of this name."""

    capacity = 1

    def __init__(self, name: str, error: Exception) -> None:
        self._name, self._error = name, error
        self._tasks: list[Task] = []
        self.n_drives: list[int] = []

    def submit(self, task: Task) -> None:
        self._tasks.append(task)

    def wait(self) -> list[TaskOutcome]:
        task = self._tasks.pop(0)
        self.n_drives.append(len(task.drives))
        met = self._name in {drive.log for drive in task.drives}
        return [TaskOutcome(task, error=self._error) if met else TaskOutcome(task)]

    def close(self) -> None:
        pass


@pytest.mark.parametrize("error", [MemoryError(), RuntimeError("std::bad_alloc")])
def test_an_unexpected_error_costs_one_drive_after_three_tries(error: Exception, tmp_path: Path) -> None:
    told: list[Receipt] = []
    executor = Meets("b", error)
    task = Task(tuple(AuditDrive(name, DriveInput()) for name in "abc"), str(tmp_path), "", JudgeSettings())
    TaskDriver(executor, LocalFolder(tmp_path), told.append).run([task])
    assert executor.n_drives == [3, 1, 1, 1, 1]
    (receipt,) = told
    assert (receipt.log, receipt.status) == ("b", "quarantined")
    assert type(error).__name__ in str(receipt.reason)


def test_an_error_of_the_run_ends_it(tmp_path: Path) -> None:
    task = Task((AuditDrive("b", DriveInput()),), str(tmp_path), "", JudgeSettings())
    with pytest.raises(OutputError):
        TaskDriver(Meets("b", OutputError("full")), LocalFolder(tmp_path), lambda _receipt: None).run([task])


class Clocks:
    """A worker's clock and that of the wall."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.computed = self.wall = 0.0
        monkeypatch.setattr(pool, "processor_seconds", lambda _process: self.computed)
        monkeypatch.setattr(pool, "monotonic", lambda: self.wall)


class Pipe:
    """Says what a worker says."""

    def recv(self) -> str:
        return "begun"

    def send(self, _task: object) -> None:
        pass

    def close(self) -> None:
        pass


class Process:
    """No process."""

    pid = -1

    def kill(self) -> None:
        pass

    def join(self) -> None:
        pass


def test_only_what_a_worker_computes_itself_counts_and_its_start_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    clocks = Clocks(monkeypatch)
    worker = pool._Worker.__new__(pool._Worker)
    worker.pipe, worker._process = Pipe(), Process()  # type: ignore[assignment]
    worker._memory, worker._timeout_s, worker._n_tasks = None, 10.0, 0
    worker.send_task(Task((AuditDrive("b", DriveInput()),), "", "", JudgeSettings()))
    clocks.computed = clocks.wall = 100.0  # a start on a busy machine
    assert worker.kill_if_over_limit() is None
    assert worker.receive_message() is None
    for _ in range(9):
        clocks.computed, clocks.wall = clocks.computed + 1.0, clocks.wall + 9.0
        assert worker.kill_if_over_limit() is None
    clocks.computed += 2.0
    lost = worker.kill_if_over_limit()
    assert lost is not None
    assert lost.loss_reason == "the worker took too long: it computed for more than 10 s"


def test_a_worker_that_does_nothing_at_all_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    clocks = Clocks(monkeypatch)
    worker = pool._Worker.__new__(pool._Worker)
    worker.pipe, worker._process = Pipe(), Process()  # type: ignore[assignment]
    worker._memory, worker._timeout_s, worker._n_tasks = None, 10.0, 0
    worker.send_task(Task((AuditDrive("b", DriveInput()),), "", "", JudgeSettings()))
    assert worker.receive_message() is None
    clocks.wall = 11.0
    lost = worker.kill_if_over_limit()
    assert lost is not None
    assert "it did nothing for 10 s" in str(lost.loss_reason)


STAYS = """
import sys, time
from drivelint.audit.executors import local
from drivelint.audit.executors.local import LocalPool
from drivelint.audit.model import JudgeSettings, Task

if __name__ == "__main__":
    pool = LocalPool(1)
    pool.submit(Task((), "/nowhere", "", JudgeSettings(rules=("ukhc.no-collision",))))
    print(len(pool.wait()), pool.wait())
    pool._workers[0]._process.kill()
    pool._workers[0]._process.join()
    pool.submit(Task((), "/nowhere", "", JudgeSettings(rules=("ukhc.no-collision",))))
    print([outcome.loss_reason for outcome in pool.wait()])
    pool.close()
"""


@pytest.mark.ci
def test_a_worker_that_dies_between_two_tasks_is_replaced(tmp_path: Path) -> None:
    script = tmp_path / "stays.py"
    script.write_text(STAYS, encoding="utf-8")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == ["1 []", "[None]"]


@pytest.mark.parametrize(
    ("beyond_limits", "code"), [(2, ExitCode.NOT_JUDGED), (1, ExitCode.USAGE), (0, ExitCode.USAGE)]
)
def test_rules_that_only_took_too_much_are_no_mistake_of_the_user(beyond_limits: int, code: ExitCode) -> None:
    counted = AuditSummary(n_drives=1, n_judged=1, errors=2, beyond_limits=beyond_limits)
    assert counted.exit_code("never", strict=False) == code
