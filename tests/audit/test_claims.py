"""Several audits into one folder share its drives; what a dead one has claimed is taken over."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from typing import TYPE_CHECKING

import pytest

from drivelint.audit import merge
from drivelint.audit.claims import Claims
from drivelint.audit.driver import MAX_TASK_DRIVES, divide_into_tasks
from drivelint.audit.model import AuditDrive, JudgeSettings
from drivelint.audit.store import LocalFolder
from drivelint.drive.trace import DriveInput
from drivelint.errors import ExitCode
from drivelint.report.progress import Silent
from tests.audit import fleet
from tests.audit.here import run_audit

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.ci

N_DRIVES = 18


def _drives(n: int) -> list[AuditDrive]:
    return [AuditDrive(f"log{i}", DriveInput(), source_id=f"{i:064x}") for i in range(n)]


def test_each_drive_is_given_to_one_of_two(tmp_path: Path) -> None:
    results = LocalFolder(tmp_path)
    first, second = Claims(results, 0.5), Claims(results, 0.5)
    with first.keep_alive(), second.keep_alive():
        one = first.claim_drives(_drives(6))
        got = [next(one), next(one)]
        rest = list(second.claim_drives(_drives(6)))
        assert second.n_waiting == 2
        assert list(one) == []
        assert first.n_waiting == 4
        first.mark_done(got)
        second.mark_done(rest)
        for each in (first, second):
            assert list(each.claim_drives(_drives(6))) == []
            assert each.n_waiting == 0
    assert sorted(drive.log for drive in got + rest) == [f"log{i}" for i in range(6)]


def test_what_a_dead_one_has_claimed_is_taken_over(tmp_path: Path) -> None:
    results = LocalFolder(tmp_path)
    dead = Claims(results, 0.3)
    with dead.keep_alive():
        next(iter(dead.claim_drives(_drives(3))))
    living = Claims(results, 0.3)
    with living.keep_alive():
        assert [drive.log for drive in living.claim_drives(_drives(3))] == ["log0", "log1", "log2"]


def test_two_with_more_drives_than_a_task_has_come_to_an_end(tmp_path: Path) -> None:
    results = LocalFolder(tmp_path)
    n = 3 * MAX_TASK_DRIVES
    done: list[list[str]] = [[], []]

    def share(no: int) -> None:
        claims = Claims(results, 2.0)
        with claims.keep_alive():
            while True:
                given = divide_into_tasks(
                    claims.claim_drives(_drives(n)), "", "run", JudgeSettings(), group_size=MAX_TASK_DRIVES
                )
                for task in given:
                    done[no] += [drive.log for drive in task.drives]
                    claims.mark_done(task.drives)
                if not claims.n_waiting:
                    return
                if not claims.n_claimed:
                    claims.pause_before_next_pass()

    threads = [threading.Thread(target=share, args=[no], daemon=True) for no in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive()
    assert sorted(done[0] + done[1]) == sorted(f"log{i}" for i in range(n))


@pytest.mark.slow
@pytest.mark.parametrize("n_killed", [0, 1])
def test_three_audits_give_the_tables_of_one(tmp_path: Path, n_killed: int) -> None:
    drives = fleet.write(tmp_path / "fleet", N_DRIVES)
    command = drives.command(tmp_path / "out", "--claim", "--lease", "3", "--workers", "1", "--memory", "200MB")
    running = [
        subprocess.Popen(
            [sys.executable, "-m", "drivelint", *command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )
        for _ in range(3)
    ]
    for victim in running[:n_killed]:
        time.sleep(3.0)
        os.kill(victim.pid, signal.SIGKILL)
    codes = [each.wait() for each in running]
    said = [each.stderr.read().decode() for each in running[n_killed:] if each.stderr is not None]
    assert not any(said), "".join(said)
    assert codes.count(-signal.SIGKILL) == n_killed
    assert set(codes[n_killed:]) <= {ExitCode.OK, ExitCode.FAILED, ExitCode.NOT_JUDGED}
    counted = merge(str(tmp_path / "out"), Silent())
    assert counted.n_drives == N_DRIVES
    assert counted.digest == run_audit(drives, tmp_path / "whole").digest
    assert json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["quarantined"] == 0
