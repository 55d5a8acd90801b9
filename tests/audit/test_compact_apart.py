"""While workers judge, results are packed in a process of their own, so that the driver's memory does not grow with the drives."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from drivelint.audit import run as audit_run
from drivelint.audit.compact import batch_rows_query, chunk_ids, compact
from drivelint.audit.executors import TaskOutcome
from drivelint.audit.store import LocalFolder, ResultStore
from drivelint.errors import DriveLintError, UsageError
from tests.audit import fleet
from tests.audit.here import InThisProcess, run_audit


class Watched(InThisProcess):
    """Counts the chunks that are there before each task, and may spoil a receipt."""

    def __init__(self, out: Path, spoiled: bool = False) -> None:
        super().__init__()
        self.out, self.spoiled, self.seen = out, spoiled, [0]

    def wait(self) -> list[TaskOutcome]:
        self.seen.append(len(chunk_ids(LocalFolder(self.out))))
        found = super().wait()
        if self.spoiled:
            next(self.out.glob("receipts/*/*.json")).write_bytes(b"{}")
        return found


@pytest.mark.slow
def test_it_packs_elsewhere_while_judging(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drives = fleet.write(tmp_path / "fleet", 12)
    whole = run_audit(drives, tmp_path / "whole")
    here: list[bool] = []

    def noted(results: ResultStore, *, while_judging: bool = False) -> int:
        here.append(while_judging)
        return compact(results, while_judging=while_judging)

    monkeypatch.setattr(audit_run, "compact", noted)
    monkeypatch.setattr(audit_run, "RECEIPTS_PER_COMPACTION", 8)
    executor = Watched(tmp_path / "out")
    assert run_audit(drives, tmp_path / "out", executor).digest == whole.digest
    assert executor.seen[-1] > 0, "there was a chunk before the end"
    assert here, "the test can fail"
    assert not any(here), f"process {os.getpid()} packed while it judged"


@pytest.mark.ci
def test_its_errors_keep_their_type(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drives = fleet.write(tmp_path / "fleet", 12)
    monkeypatch.setattr(audit_run, "RECEIPTS_PER_COMPACTION", 8)
    with pytest.raises(UsageError, match="not a receipt of drivelint"):
        run_audit(drives, tmp_path / "out", Watched(tmp_path / "out", spoiled=True))


@pytest.mark.ci
def test_receipts_without_rows_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drives = fleet.write(tmp_path / "fleet", 2)
    rows = batch_rows_query
    monkeypatch.setattr(
        "drivelint.audit.compact.batch_rows_query", lambda *about: f"SELECT * FROM ({rows(*about)}) LIMIT 0"
    )
    with pytest.raises(DriveLintError, match=r"^2 receipts have 0 rows in the table drives"):
        run_audit(drives, tmp_path / "out")
