"""One run of an audit: finds what has no result yet, has it judged, packs the results and sums them up."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field, fields
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

import msgspec
import pyarrow as pa

from drivelint.audit import sources
from drivelint.audit.bucket import is_url, look
from drivelint.audit.compact import compact, create_views, database, drop, tables_digest
from drivelint.audit.driver import WINDOW, Driver, tasks
from drivelint.audit.executors import open_executor
from drivelint.audit.identity import OptionHashes, rule_table, run_id, versions
from drivelint.audit.model import AuditDrive, JudgeSettings, Receipt, digest
from drivelint.audit.store import LocalFolder, open_store
from drivelint.drive.trace import DriveInput
from drivelint.errors import ExitCode, UsageError
from drivelint.result.counts import SEVERITIES
from drivelint.result.files import parquet_bytes
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Iterator

    import duckdb

    from drivelint.audit.executors import Executor
    from drivelint.audit.store import ResultStore
    from drivelint.report.progress import Progress

AUDIT_FILE: Final = "audit.json"
SUMMARY_FILE: Final = "summary.json"
RULES_FILE: Final = "rules.parquet"
RECEIPTS_PER_COMPACTION: Final = 4_000
_LISTED: Final = 20_000
"""Drives of the source that are held against the receipts at a time."""


@dataclass(frozen=True, kw_only=True)
class AuditRequest(DriveInput):
    """The options of `audit`, under the names that they have there.

    `shard`: (i, n) judges the i-th of n parts of the source, counted from 1, and leaves the packing to `merge`.
    `worker_memory` in bytes, `drive_timeout_s`: what one worker may take.
    """

    sources: tuple[str, ...]
    out: str
    settings: JudgeSettings = field(default_factory=JudgeSettings)
    fail_on: str = "critical"
    strict: bool = False
    workers: int | None = None
    worker_memory: int | None = None
    drive_timeout_s: float | None = None
    shard: tuple[int, int] | None = None
    retry_errors: bool = False
    cluster: str | None = None


@dataclass
class AuditSummary:
    """What an audit comes to. `digest` is that of all rows; None where the results are not packed (`--shard`)."""

    n_drives: int = 0
    judged: int = 0
    reused: int = 0
    lossy: int = 0
    refused: int = 0
    quarantined: int = 0
    km: float = 0.0
    hours: float = 0.0
    failed: dict[str, int] = field(default_factory=dict)
    unknown: int = 0
    errors: int = 0
    digest: str | None = None

    def count(self, receipt: Receipt) -> None:
        """Add a drive."""
        self.n_drives += 1
        self.reused += receipt.reused
        self.judged += receipt.status == "judged"
        self.refused += receipt.status == "refused"
        self.quarantined += receipt.status == "quarantined"
        self.lossy += receipt.lossy
        self.km += receipt.km
        self.hours += receipt.duration_s / 3600
        self.failed = dict(Counter(self.failed) + Counter(receipt.failed))
        self.unknown += receipt.unknown
        self.errors += receipt.counts.get("error", 0)

    def exit_code(self, fail_on: str, *, strict: bool) -> ExitCode:
        """Return the exit code of DESIGN.md, by its precedence 2 > 1 > 4 > 3 > 0."""
        gating = SEVERITIES[: SEVERITIES.index(fail_on) + 1] if fail_on != "never" else ()
        if self.errors:
            return ExitCode.USAGE
        if any(self.failed.get(severity) for severity in gating):
            return ExitCode.FAILED
        if self.refused or self.quarantined or not self.n_drives or (strict and self.unknown):
            return ExitCode.NOT_JUDGED
        return ExitCode.LOSSY if self.lossy else ExitCode.OK


def audit(request: AuditRequest, progress: Progress, executor: Executor | None = None) -> AuditSummary:
    """Judge every drive of the sources that has no result yet, and return what all drives of the sources come to.

    Errors: `UsageError`, `RuleError`, `TraceError` for what was asked; `OutputError` where results cannot be written. Whatever ends
    it, what was judged stays, and the same command goes on with the rest.
    """
    id_ = run_id(request.settings)
    results = open_store(request.out)
    _begin(request, results, id_)
    alone = request.shard is None
    if alone:
        if isinstance(results, LocalFolder):
            results.sweep()
        compact(results)
    with database() as con, TemporaryDirectory(prefix="drivelint-audit-") as home:
        n_drives = _list(con, request, id_, progress)
        create_views(con, results, Path(home))
        if alone:
            stale = con.execute(statement("audit/stale"), {"retry": request.retry_errors}).to_arrow_table()["key"]
            drop(results, stale.combine_chunks())
            create_views(con, results, Path(home))
            if len(stale):
                progress.note(f"{len(stale)} drives are judged again: changed since, or not judged before")
        counted = AuditSummary()
        fresh = 0

        def tell(receipt: Receipt) -> None:
            nonlocal fresh
            fresh += not receipt.reused
            counted.count(receipt)
            progress.advance()
            if receipt.status != "judged":
                progress.note(f"not judged: {receipt.reason}")

        def busy() -> None:
            nonlocal fresh
            if alone and fresh >= RECEIPTS_PER_COMPACTION:
                compact(results, while_judging=True)
                fresh = 0

        (n_known,) = con.execute("SELECT count(*) FROM _listed SEMI JOIN receipts USING (source_id)").fetchall()[0]
        progress.stage("auditing", n_drives)
        progress.advance(n_known)
        workers = executor or open_executor(
            request.cluster,
            workers=request.workers,
            memory=request.worker_memory,
            timeout_s=request.drive_timeout_s,
        )
        try:
            ahead = WINDOW * workers.capacity * 16
            todo = tasks(_todo(con), str(request.out), id_, request.settings, ahead)
            Driver(workers, results, tell, busy).run(todo)
        finally:
            workers.close()
        if alone:
            compact(results)
            create_views(con, results, Path(home))
            counted = _summed(con, n_known)
    if alone:
        results.write(SUMMARY_FILE, (json.dumps(vars(counted), indent=2, sort_keys=True) + "\n").encode())
    return counted


def merge(out: str, progress: Progress) -> AuditSummary:
    """Pack the results of shards, when none of them runs any more, and sum them up. Errors: `UsageError`, `OutputError`."""
    results = open_store(out)
    if results.read(AUDIT_FILE) is None:
        raise UsageError(f"{out}: no audit is here: name the folder that `audit --out` wrote")
    progress.stage("packing", None)
    if isinstance(results, LocalFolder):
        results.sweep()
    compact(results)
    with database() as con, TemporaryDirectory(prefix="drivelint-audit-") as home:
        create_views(con, results, Path(home))
        counted = _summed(con, 0)
    results.write(SUMMARY_FILE, (json.dumps(vars(counted), indent=2, sort_keys=True) + "\n").encode())
    return counted


def _begin(request: AuditRequest, results: ResultStore, id_: str) -> None:
    """Write down what decides the results, or make sure that the audit that is there has the same.

    Errors: `UsageError` for an audit by other rules, parameters or versions.
    """
    told = {"run_id": id_, "versions": versions(), "settings": _plain(request.settings), "fail_on": request.fail_on}
    content = (json.dumps(told, indent=2, sort_keys=True, default=str) + "\n").encode()
    if results.create(AUDIT_FILE, content):
        results.write(RULES_FILE, parquet_bytes(rule_table(request.settings), "rule"))
        return
    there = json.loads(results.read(AUDIT_FILE) or b"{}")
    if there.get("run_id") != id_:
        changed = sorted(name for name, value in versions().items() if there.get("versions", {}).get(name) != value)
        why = f"other versions of {', '.join(changed)}" if changed else "other rules, parameters or profiles"
        raise UsageError(f"{request.out}: the audit there was made with {why}: choose another --out")
    results.delete([SUMMARY_FILE])  # it is not of what is there from now on


def _plain(settings: JudgeSettings) -> dict[str, Any]:
    return {key: value for key, value in vars(settings).items() if key != "memory"}


def _list(con: duckdb.DuckDBPyConnection, request: AuditRequest, id_: str, progress: Progress) -> int:
    """Fill the table `_listed` with the drives of the sources; return how many there are."""
    con.execute(statement("audit/listed"))
    hashes = OptionHashes()
    progress.stage("listing", None)
    some: list[dict[str, Any]] = []
    for drive in sources.drives(request.sources, _drive_input(request)):
        if request.shard and int(digest(drive.log)[:8], 16) % request.shard[1] != request.shard[0] - 1:
            continue
        options_id = hashes.of(drive.options)
        size, stamp = (drive.size, drive.stamp) if drive.stamp else _stamp(drive.log)
        found = drive.found(size, stamp, id_, options_id)
        some.append(
            {
                "source_id": found.source_id,
                "log": found.log,
                "size": size,
                "stamp": stamp,
                "options_id": options_id,
                "options": msgspec.json.encode(drive.options, enc_hook=str).decode(),
                "tags": sorted(drive.tags.items()),
            }
        )
        if len(some) >= _LISTED:
            _insert(con, some)
            some = []
    if some:
        _insert(con, some)
    (n,) = con.execute("SELECT count(*) FROM _listed").fetchall()[0]
    return int(n)


def _insert(con: duckdb.DuckDBPyConnection, rows: list[dict[str, Any]]) -> None:
    text = ("source_id", "log", "stamp", "options_id", "options")
    schema = pa.schema(
        [(name, pa.string()) for name in text] + [("size", pa.int64()), ("tags", pa.map_(pa.string(), pa.string()))]
    )
    con.register("_some", pa.Table.from_pylist(rows, schema=schema))
    con.execute("INSERT INTO _listed BY NAME FROM _some")
    con.unregister("_some")


def _todo(con: duckdb.DuckDBPyConnection) -> Iterator[AuditDrive]:
    """Yield the listed drives that have no receipt, in the order of their logs."""
    rows = con.cursor().execute(statement("audit/todo"))
    for batch in rows.to_arrow_reader(1_000):
        for row in batch.to_pylist():
            options = msgspec.json.decode(row["options"], type=DriveInput, dec_hook=lambda kind, value: kind(value))
            tags = dict(row["tags"])
            yield AuditDrive(row["log"], options, tags, row["size"], row["stamp"], row["source_id"], row["options_id"])


def _summed(con: duckdb.DuckDBPyConnection, n_reused: int) -> AuditSummary:
    """Return what all drives that have receipts come to; `n_reused`: those that had one before."""
    (row,) = con.execute(statement("audit/summed")).to_arrow_table().to_pylist()
    failed = dict(con.execute(statement("audit/failed")).fetchall())
    return AuditSummary(**row, reused=n_reused, failed=failed, digest=tables_digest(con))


def _drive_input(request: AuditRequest) -> DriveInput:
    return DriveInput(**{each.name: getattr(request, each.name) for each in fields(DriveInput)})


def _stamp(log: str) -> tuple[int, str]:
    """Return a log's size in bytes and the time of its last change, or its ETag; (0, "") where it cannot be looked at."""
    if is_url(log):
        found = look(log)
        return (0, "") if found is None else (found.size, found.e_tag)
    path = Path(log)
    try:
        files = sorted(file for file in path.rglob("*") if file.is_file()) if path.is_dir() else [path]
        about = [(file.stat().st_size, file.stat().st_mtime_ns) for file in files]
    except OSError:
        return 0, ""
    return sum(size for size, _ in about), str(max((changed for _, changed in about), default=0))
