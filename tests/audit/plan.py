"""What an audit of ten million drives would take, from the unit costs of a small one: `python -m tests.audit plan DRIVES`.

Judging is not in it: that is the CPU time of a check. Here is what the audit adds: requests, bytes, listing, packing.
"""

from __future__ import annotations

import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

from drivelint.audit import AuditRequest, audit
from drivelint.audit.compact import compact
from drivelint.audit.driver import SUBMITTED_TASKS_PER_WORKER, divide_into_tasks
from drivelint.audit.identity import OptionHashes
from drivelint.audit.model import AuditDrive
from drivelint.audit.store import LocalFolder
from drivelint.drive.trace import DriveInput
from drivelint.report.progress import Silent
from tests.audit import fleet
from tests.audit.here import SETTINGS, InThisProcess

if TYPE_CHECKING:
    from collections.abc import Sequence

DRIVES: Final = 10_000_000
PUT_PRICE, GET_PRICE, GB_MONTH_PRICE = 5e-6, 0.4e-6, 0.023
"""US dollars for a write or a listing of 1,000 names, a read, and a GB kept for a month: list prices of a large store in 2026."""


def plan(n_drives: int) -> list[str]:
    """Return the lines of a Markdown table: unit costs measured on so many drives, and ten million times as much."""
    with TemporaryDirectory(prefix="drivelint-plan-") as home:
        drives = fleet.write(Path(home) / "fleet", n_drives)
        out = Path(home) / "out"
        request = AuditRequest(
            sources=(str(drives.manifest),), map=drives.road, out=str(out), settings=SETTINGS, shard=(1, 1)
        )
        audit(request, Silent(), InThisProcess())
        receipts, batches = _files(out / "receipts"), _files(out / "batches")
        begin = time.perf_counter()
        compact(LocalFolder(out))
        packing = time.perf_counter() - begin
        packed = _files(out / "tables")
        listing = _listing(drives)
    n_batches = len(batches) / 3
    puts = (len(receipts) + len(batches) + len(packed)) / n_drives
    rows = [
        ("drives in a task", f"{n_drives / n_batches:.0f}", ""),
        ("bytes of a receipt", f"{_mean(receipts):.0f}", ""),
        ("writes per drive", f"{puts:.2f}", f"{DRIVES * puts * PUT_PRICE:,.0f} $"),
        ("reads per drive (log, receipt, packing)", "4", f"{DRIVES * 4 * GET_PRICE:,.0f} $"),
        ("bytes per drive, packed", f"{sum(packed) / n_drives:.0f}", f"{DRIVES * sum(packed) / n_drives / 1e9:.1f} GB"),
        (
            "seconds to list and hash 1,000",
            f"{1e3 * listing / n_drives:.2f}",
            f"{DRIVES * listing / n_drives / 3600:.1f} h",
        ),
        ("seconds to pack 1,000", f"{1e3 * packing / n_drives:.2f}", f"{DRIVES * packing / n_drives / 3600:.1f} h"),
        ("names to list at the start, 1,000 a request", "", f"{DRIVES / 1000 * PUT_PRICE:,.2f} $"),
    ]
    return ["| what | measured | ten million drives |", "|---|---|---|", *(f"| {a} | {b} | {c} |" for a, b, c in rows)]


def _files(folder: Path) -> list[int]:
    return [path.stat().st_size for path in folder.rglob("*") if path.is_file()]


def _mean(sizes: Sequence[int]) -> float:
    return sum(sizes) / max(1, len(sizes))


def _listing(drives: fleet.Fleet) -> float:
    """Return the seconds to list the fleet, to hash its options, and to cut it into tasks."""
    begin = time.perf_counter()
    hashes, options = OptionHashes(), DriveInput(map=drives.road)
    listed = [
        AuditDrive(str(path), options).with_ids(path.stat().st_size, "0", "run", hashes.hash_of(options))
        for path in sorted((drives.manifest.parent / "logs").iterdir())
    ]
    cut = [
        len(task.drives)
        for task in divide_into_tasks(listed, "", "run", SETTINGS, group_size=SUBMITTED_TASKS_PER_WORKER)
    ]
    assert sum(cut) == len(listed)
    return time.perf_counter() - begin
