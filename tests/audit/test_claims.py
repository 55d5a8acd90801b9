"""Several audits into one folder share its drives; what a dead one has claimed is taken over."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from typing import TYPE_CHECKING

import pytest

from drivelint.audit import merge
from drivelint.audit.claims import Claims
from drivelint.audit.model import AuditDrive
from drivelint.audit.store import LocalFolder
from drivelint.drive.trace import DriveInput
from drivelint.errors import ExitCode
from drivelint.report.progress import Silent
from tests.audit import fleet
from tests.audit.here import judged

if TYPE_CHECKING:
    from pathlib import Path

N_DRIVES = 18


def _drives(n: int) -> list[AuditDrive]:
    return [AuditDrive(f"log{i}", DriveInput(), source_id=f"{i:064x}") for i in range(n)]


def test_each_drive_is_given_to_one_of_two(tmp_path: Path) -> None:
    results = LocalFolder(tmp_path)
    first, second = Claims(results, 0.5), Claims(results, 0.5)
    with first.alive(), second.alive():
        one = first.mine(lambda: _drives(6))
        got = [next(one), next(one)]
        other = second.mine(lambda: _drives(6))
        rest = [next(other) for _ in range(4)]
        first.done(got)
        assert list(other) == []
        second.done(rest)
        assert list(one) == []
    assert sorted(drive.log for drive in got + rest) == [f"log{i}" for i in range(6)]


def test_what_a_dead_one_has_claimed_is_taken_over(tmp_path: Path) -> None:
    results = LocalFolder(tmp_path)
    dead = Claims(results, 0.3)
    with dead.alive():
        next(iter(dead.mine(lambda: _drives(3))))
    living = Claims(results, 0.3)
    with living.alive():
        assert [drive.log for drive in living.mine(lambda: _drives(3))] == ["log0", "log1", "log2"]


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
    assert all(each.stderr is None or not each.stderr.read() for each in running[n_killed:])
    assert codes.count(-signal.SIGKILL) == n_killed
    assert set(codes[n_killed:]) <= {ExitCode.OK, ExitCode.FAILED, ExitCode.NOT_JUDGED}
    counted = merge(str(tmp_path / "out"), Silent())
    assert counted.n_drives == N_DRIVES
    assert counted.digest == judged(drives, tmp_path / "whole").digest
    assert json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["quarantined"] == 0
