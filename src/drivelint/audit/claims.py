"""Claims: several audits that write to the same place share its drives without a scheduler.

Before an audit judges a drive, it writes a claim with its own id. The audit also writes a heartbeat every few seconds. If an audit writes
no heartbeat for `LEASE_S`, its claims expire. Claims only save work: if two audits judge the same drive, one receipt is valid.
"""

from __future__ import annotations

import json
import threading
import time
import uuid
from contextlib import contextmanager
from enum import Enum
from itertools import islice
from typing import TYPE_CHECKING, Final

from drivelint.audit.driver import MAX_TASK_DRIVES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from drivelint.audit.model import AuditDrive
    from drivelint.audit.store import ResultStore

LEASE_S: Final = 60.0
"""Seconds without a heartbeat after which claims expire. The clocks of the machines must differ by less than that."""


class ClaimOutcome(Enum):
    """Which audit owns a drive after an attempt to claim it. `NO_WORK_LEFT`: the drive has its result, or this audit already judges it."""

    THIS_AUDIT = "this audit"
    ANOTHER_AUDIT = "another audit"
    NO_WORK_LEFT = "no work left"


class Claims:
    """The claims of one audit among several that write to the same place."""

    def __init__(self, results: ResultStore, lease_s: float = LEASE_S) -> None:
        self._results = results
        self._lease_s = lease_s
        self._owner = uuid.uuid4().hex
        self._stop = threading.Event()
        self.n_waiting = self.n_claimed = 0

    @contextmanager
    def keep_alive(self) -> Iterator[None]:
        """Write heartbeats until the block ends."""
        self._write_heartbeat()
        beat = threading.Thread(target=self._write_heartbeats, daemon=True)
        beat.start()
        try:
            yield
        finally:
            self._stop.set()
            beat.join()
            self._results.delete([f"claims/owners/{self._owner}.json"])

    def claim_drives(self, todo: Iterable[AuditDrive]) -> Iterator[AuditDrive]:
        """Yield the drives that this audit claims in one pass over `todo`, the drives that have no result yet.

        Afterwards, `n_waiting` is the number of drives that other live audits have claimed; later these are done or free. The method never
        waits. The caller marks judged drives as done.
        """
        self.n_waiting = self.n_claimed = 0
        left = iter(todo)
        while some := list(islice(left, MAX_TASK_DRIVES)):
            alive: dict[str, bool] = {}
            for drive in some:
                claim, owner = self._claim_drive(drive)
                if claim is ClaimOutcome.NO_WORK_LEFT:
                    continue
                if claim is ClaimOutcome.ANOTHER_AUDIT:
                    if owner not in alive:
                        alive[owner] = self._is_alive(owner)
                    if alive[owner]:
                        self.n_waiting += 1
                        continue
                    self._results.write(_claim_name(drive), self._claim_content())
                self.n_claimed += 1
                yield drive

    def pause_before_next_pass(self) -> None:
        """Wait a sixth of the lease for other audits, after a pass that claimed no drive."""
        time.sleep(self._lease_s / 6)

    def mark_done(self, drives: Iterable[AuditDrive]) -> None:
        """Record that the results of these drives are written."""
        for drive in drives:
            self._results.write(_claim_name(drive), b'{"owner": ""}\n')

    def _claim_drive(self, drive: AuditDrive) -> tuple[ClaimOutcome, str]:
        """Claim a drive. Return the outcome, and the id of the audit that owns the drive; '' if the drive is done."""
        if self._results.create(_claim_name(drive), self._claim_content()):
            return ClaimOutcome.THIS_AUDIT, self._owner
        content = self._results.read(_claim_name(drive))
        owner = "" if content is None else str(json.loads(content)["owner"])
        return (ClaimOutcome.NO_WORK_LEFT if owner in {"", self._owner} else ClaimOutcome.ANOTHER_AUDIT), owner

    def _claim_content(self) -> bytes:
        return f'{{"owner": "{self._owner}"}}\n'.encode()

    def _is_alive(self, owner: str) -> bool:
        sign_of_life = self._results.read(f"claims/owners/{owner}.json")
        return sign_of_life is not None and time.time() - float(json.loads(sign_of_life)["at"]) < self._lease_s

    def _write_heartbeat(self) -> None:
        self._results.write(f"claims/owners/{self._owner}.json", f'{{"at": {time.time()}}}\n'.encode())

    def _write_heartbeats(self) -> None:
        while not self._stop.wait(self._lease_s / 6):
            self._write_heartbeat()


def _claim_name(drive: AuditDrive) -> str:
    return f"claims/{drive.source_id[:2]}/{drive.source_id}.json"
