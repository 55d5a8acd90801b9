"""One run of an audit: finds the drives without a result, lets workers judge them, packs the results and summarises them."""

from __future__ import annotations

import json
import multiprocessing
import os
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import nullcontext, suppress
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

from drivelint.audit import delta_lake, listing, parts, sealed
from drivelint.audit.claims import LEASE_S, Claims
from drivelint.audit.compact import compact, create_views, open_database, remove_drives
from drivelint.audit.driver import (
    MAX_TASK_DRIVES,
    SUBMITTED_TASKS_PER_WORKER,
    TaskDriver,
    divide_into_tasks,
    max_drives_per_task,
)
from drivelint.audit.executors.choice import open_executor
from drivelint.audit.executors.local import block_ctrl_c, prepare_worker_process
from drivelint.audit.identity import rule_table, run_id, versions
from drivelint.audit.lock import lock_results
from drivelint.audit.model import JudgeSettings
from drivelint.audit.sources import tag_warnings
from drivelint.audit.store import LocalFolder, open_store
from drivelint.audit.summary import AuditSummary, summary_of_all_drives, sums_of_receipts
from drivelint.audit.unpacked import SUMMARY_FILE
from drivelint.drive.trace import DriveInput
from drivelint.engine.default_rules import selectors_of_run
from drivelint.engine.memory import DEFAULT_MEMORY_BYTES, LEAST_MEMORY_BYTES
from drivelint.errors import UsageError
from drivelint.phrases import plural
from drivelint.result.files import parquet_bytes
from drivelint.result.names import GATE_FILE
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import duckdb
    import pyarrow as pa

    from drivelint.audit.executors import Executor
    from drivelint.audit.model import Receipt
    from drivelint.audit.store import ResultStore
    from drivelint.report.progress import Progress

AUDIT_FILE: Final = "audit.json"
RULES_FILE: Final = "rules.parquet"
_LISTED_RECEIPTS_SQL: Final = "(FROM receipts SEMI JOIN _listed USING (source_id))"
"""The receipts that were packed before, of drives that this part of the audit lists."""
RECEIPTS_PER_COMPACTION: Final = 4_000
WORKER_BYTES_BESIDE_DATABASE: Final = 500_000_000
"""Bytes that a worker needs besides its database: for the program, its libraries, and the log that it reads."""


@dataclass(frozen=True, kw_only=True)
class AuditRequest(DriveInput):
    """The options of the command `audit`, under the same names.

    `shard`: (i, n) judges the i-th of n parts of the source, counted from 1. `claim`: several audits that write to the same place share the
    drives. With either, `merge` packs the results later.
    `worker_memory`: limit of one worker in bytes. `drive_timeout_s`: limit of computing time per drive.
    """

    sources: tuple[str, ...]
    out: str
    settings: JudgeSettings = field(default_factory=JudgeSettings)
    fail_on: str = "critical"
    strict: bool = False
    min_judged: float | None = None
    """The least share of rules that must be decided (pass or fail), see `result.model.decided_share`."""
    workers: int | None = None
    worker_memory: int | None = None
    drive_timeout_s: float | None = None
    shard: tuple[int, int] | None = None
    claim: bool = False
    lease_s: float = LEASE_S
    retry_errors: bool = False
    prune: bool = False
    """Remove the results of logs that are not among the sources."""
    cluster: str | None = None
    delta: str | None = None
    """Folder or URL prefix where the packed tables are also written as Delta tables."""


def audit(request: AuditRequest, progress: Progress, executor: Executor | None = None) -> AuditSummary:
    """Judge every drive of the sources that has no result, and return the summary of all drives of the sources.

    Errors: `UsageError`, `RuleError`, `TraceError` for a wrong request; `OutputError` if results cannot be written. After any error, the
    results so far stay, and the same command continues with the other drives.
    """
    rules = selectors_of_run(request.settings.rules, request.settings.rules_dirs, request)
    request = replace(request, settings=replace(request.settings, rules=rules))
    run_hash = run_id(request.settings)
    results = open_store(request.out)
    alone = request.shard is None and not request.claim
    if request.delta is not None:
        if not alone:
            raise UsageError("--delta needs packed tables: when all parts have ended, run drivelint merge --delta")
        delta_lake.require_writable(request.delta, request.out, run_hash)
    was_unchanged = _create_or_check_settings_and_test_seal(request, results, run_hash)
    if not alone and (request.retry_errors or request.prune):
        raise UsageError("--retry-errors and --prune remove results: use them without --shard and --claim")
    part = parts.part_name(request.shard, claim=request.claim)
    with lock_results(results, shared=not alone):
        parts.record_begin(results, part)
        audit_summary = _audit_under_lock(
            request, results, progress, run_hash=run_hash, executor=executor, was_unchanged=was_unchanged
        )
        parts.record_end(results, part)
    return audit_summary


def _audit_under_lock(
    request: AuditRequest,
    results: ResultStore,
    progress: Progress,
    *,
    run_hash: str,
    executor: Executor | None,
    was_unchanged: bool,
) -> AuditSummary:
    """Run the audit while its lock is held. `was_unchanged`: the files of the earlier audit are known to be unchanged."""
    alone = request.shard is None and not request.claim
    if alone:
        if isinstance(results, LocalFolder):
            results.remove_unfinished_files()
        progress.stage("looking at earlier results", None)
        sealed.require_rows_unchanged(results, request.out, packed=not was_unchanged)
        compact(results)
    with open_database() as con, TemporaryDirectory(prefix="drivelint-audit-") as downloads:
        progress.stage("listing", None)
        n_drives = listing.fill_listed_drives(con, request.sources, _drive_input(request), run_hash, request.shard)
        parts.record_drive_count(results, parts.part_name(request.shard, claim=request.claim), n_drives)
        create_views(con, results, Path(downloads))
        if alone and (n_stale := _remove_stale_results(con, results, with_unjudged=request.retry_errors)):
            create_views(con, results, Path(downloads))
            progress.note(f"{plural(n_stale, 'drive')} judged again: changed since, or not judged before")
        n_absent = _count_or_prune_absent(con, results, request, progress) if alone else 0
        if n_absent and request.prune:
            create_views(con, results, Path(downloads))
        (n_known,) = con.execute("SELECT count(*) FROM _listed SEMI JOIN receipts USING (source_id)").fetchall()[0]
        for doubt in _tag_warnings(con):
            progress.note(doubt)
        progress.stage("auditing", n_drives)
        progress.advance(n_known)
        if not alone and (n_stale := len(_stale_keys(con, with_unjudged=False))):
            raise UsageError(f"{plural(n_stale, 'log')} changed since: run the audit once without --shard and --claim")
        audit_summary = _judge_remaining(request, con, results, progress, run_hash=run_hash, executor=executor)
        n_reused = n_known + audit_summary.reused
        if not alone:
            return replace(audit_summary.plus(sums_of_receipts(con, _LISTED_RECEIPTS_SQL)), reused=n_reused)
        audit_summary = _pack_and_seal(con, results, Path(downloads), n_reused)
        if request.delta is not None:
            _write_delta(
                request.delta, con, results, Path(downloads), progress, run_hash=run_hash, audit_summary=audit_summary
            )
        return replace(audit_summary, n_asked=n_drives, n_absent=0 if request.prune else n_absent)


def _tag_warnings(con: duckdb.DuckDBPyConnection) -> Iterator[str]:
    """Yield warnings about tags whose names look like a condition or an option of the manifest."""
    rows = con.execute("SELECT DISTINCT unnest(map_keys(tags)) FROM _listed ORDER BY 1").fetchall()
    yield from tag_warnings([name for (name,) in rows])


def _judge_remaining(
    request: AuditRequest,
    con: duckdb.DuckDBPyConnection,
    results: ResultStore,
    progress: Progress,
    *,
    run_hash: str,
    executor: Executor | None,
) -> AuditSummary:
    """Let workers judge the listed drives that have no receipt; return the summary of these drives."""
    audit_summary, fresh = AuditSummary(), 0
    claims = Claims(results, request.lease_s) if request.claim else None

    def count_receipt(receipt: Receipt) -> None:
        nonlocal fresh
        fresh += not receipt.reused
        audit_summary.add_receipt(receipt)
        progress.advance()
        if receipt.status != "judged":
            progress.note(f"not judged: {receipt.reason}")

    def compact_if_due() -> None:
        nonlocal fresh
        if request.shard is None and claims is None and fresh >= RECEIPTS_PER_COMPACTION:
            _compact_in_new_process(request.out)
            fresh = 0

    workers = executor or open_executor(
        request.cluster, workers=request.workers, memory=request.worker_memory, timeout_s=request.drive_timeout_s
    )
    try:
        with claims.keep_alive() if claims else nullcontext():
            ahead = SUBMITTED_TASKS_PER_WORKER * workers.capacity * 16 if claims is None else MAX_TASK_DRIVES
            (n_left,) = con.execute("SELECT count(*) FROM _listed").fetchall()[0]
            max_drives = max_drives_per_task(n_left, workers.capacity)
            driver = TaskDriver(
                workers, results, count_receipt, compact_if_due, claims.mark_done if claims else lambda _drives: None
            )
            while True:
                todo = claims.claim_drives(listing.unjudged_drives(con)) if claims else listing.unjudged_drives(con)
                settings, n_small = _settings_of_workers(request), workers.capacity
                driver.run(
                    divide_into_tasks(
                        todo, request.out, run_hash, settings, group_size=ahead, max_drives=max_drives, n_small=n_small
                    )
                )
                if claims is None or not claims.n_waiting:
                    break
                if not claims.n_claimed:
                    claims.pause_before_next_pass()
    finally:
        workers.close()
    return audit_summary


def _settings_of_workers(request: AuditRequest) -> JudgeSettings:
    """Return the settings with a memory limit of the database that leaves `WORKER_BYTES_BESIDE_DATABASE` to its worker.
    This changes no result.
    """
    if request.worker_memory is None:
        return request.settings
    memory = DEFAULT_MEMORY_BYTES if request.settings.memory is None else request.settings.memory
    left = max(LEAST_MEMORY_BYTES, request.worker_memory - WORKER_BYTES_BESIDE_DATABASE)
    return replace(request.settings, memory=min(memory, left))


def _compact_in_new_process(out: str) -> None:
    """Pack the complete results in a separate process, so that its memory does not add to the driver's. Errors: as `compact`."""
    context = multiprocessing.get_context("spawn")  # a fork would copy threads that hold locks
    with (
        suppress(BrokenProcessPool),  # if the process is killed, the next compaction packs its results
        ProcessPoolExecutor(1, context, initializer=prepare_worker_process, initargs=(os.getpid(),)) as apart,
    ):
        with block_ctrl_c():
            packing = apart.submit(_compact_whole_batches, out)
        packing.result()


def _compact_whole_batches(out: str) -> None:
    compact(open_store(out), while_judging=True)


def _remove_stale_results(con: duckdb.DuckDBPyConnection, results: ResultStore, *, with_unjudged: bool) -> int:
    """Remove the results of changed logs; with `with_unjudged`, also those of drives that were not judged. Return how many were removed."""
    stale = _stale_keys(con, with_unjudged=with_unjudged)
    remove_drives(results, stale)
    return len(stale)


def _stale_keys(con: duckdb.DuckDBPyConnection, *, with_unjudged: bool) -> pa.Array:
    return con.execute(statement("audit/stale"), {"retry": with_unjudged}).to_arrow_table()["key"].combine_chunks()


def _pack_and_seal(
    con: duckdb.DuckDBPyConnection,
    results: ResultStore,
    downloads: Path,
    n_reused: int,
    missing_parts: Sequence[str] = (),
) -> AuditSummary:
    """Pack everything, then write the summary and the list of files. Return the summary."""
    sealed.unseal(results)
    compact(results)
    create_views(con, results, downloads)
    audit_file = read_audit_file(results, "the audit") or {}
    robust = bool(audit_file.get("settings", {}).get("robustness"))
    audit_summary = replace(summary_of_all_drives(con, n_reused), missing_parts=list(missing_parts), robust=robust)
    content = (json.dumps(audit_summary.file_content(), indent=2, sort_keys=True) + "\n").encode()
    sealed.seal(results, [AUDIT_FILE, RULES_FILE], content)
    return audit_summary


def _write_delta(
    dest: str,
    con: duckdb.DuckDBPyConnection,
    results: ResultStore,
    downloads: Path,
    progress: Progress,
    *,
    run_hash: str,
    audit_summary: AuditSummary,
) -> None:
    """Write the packed results to the Delta tables. Leave the tables unchanged if parts of the audit have not ended."""
    if audit_summary.missing_parts:
        progress.note(f"{dest}: the Delta tables stay as they are: parts of the audit have not ended")
        return
    progress.stage("writing Delta tables", None)
    change = delta_lake.write_tables(con, results, downloads, dest, run_id=run_hash, digest=audit_summary.digest)
    progress.note(change.sentence(dest))


def merge(out: str, progress: Progress, delta_dest: str | None = None) -> AuditSummary:
    """Pack the results of all shards and claims after they have ended, and return their summary.

    `delta_dest`: folder or URL prefix where the packed tables are also written as Delta tables. Errors: `UsageError`, `OutputError`.
    """
    results = open_store(out)
    audit_file = read_audit_file(results, out)
    if audit_file is None:
        raise UsageError(f"{out}: no audit is here: name the folder that `audit --out` wrote")
    run_hash = audit_file["run_id"]
    if delta_dest is not None:
        delta_lake.require_writable(delta_dest, out, run_hash)
    progress.stage("packing", None)
    with (
        lock_results(results, shared=False),
        open_database() as con,
        TemporaryDirectory(prefix="drivelint-audit-") as downloads,
    ):
        if isinstance(results, LocalFolder):
            results.remove_unfinished_files()
        sealed.require_rows_unchanged(results, out, packed=not _has_intact_seal(results, out))
        results.delete(list(results.names("claims")))
        audit_summary = _pack_and_seal(con, results, Path(downloads), 0, parts.unfinished_parts(results))
        if delta_dest is not None:
            _write_delta(
                delta_dest, con, results, Path(downloads), progress, run_hash=run_hash, audit_summary=audit_summary
            )
        return replace(audit_summary, n_asked=parts.n_expected_drives(results))


def _count_or_prune_absent(
    con: duckdb.DuckDBPyConnection, results: ResultStore, request: AuditRequest, progress: Progress
) -> int:
    """Return how many results belong to logs that are not among the sources; remove these results if the request says `prune`."""
    absent = con.execute(statement("audit/absent")).to_arrow_table()["key"].combine_chunks()
    if request.prune and len(absent):
        remove_drives(results, absent)
        progress.note(f"{plural(len(absent), 'result')} removed: their logs are not among the sources")
    return len(absent)


def _create_or_check_settings_and_test_seal(request: AuditRequest, results: ResultStore, run_hash: str) -> bool:
    """Write `audit.json` with the settings that determine the results; if it exists, check that its settings are the same.

    Return whether an audit exists that has ended and whose files are unchanged since then. Errors: `UsageError` if the existing audit used
    other rules, parameters or versions, or if its files were changed after it ended.
    """
    audit_file = {"run_id": run_hash, "versions": versions(), "settings": _settings_without_memory(request.settings)}
    audit_file |= {name: getattr(request, name) for name in ("fail_on", "strict", "min_judged")}
    content = (json.dumps(audit_file, indent=2, sort_keys=True, default=str) + "\n").encode()
    was_unchanged = False
    if not results.create(AUDIT_FILE, content):
        there = read_audit_file(results, request.out) or {}
        if there.get("run_id") != run_hash:
            names = sorted(name for name, value in versions().items() if there.get("versions", {}).get(name) != value)
            why = f"other versions of {', '.join(names)}" if names else "other rules, parameters or profiles"
            raise UsageError(f"{request.out}: the audit there was made with {why}: choose another --out")
        was_unchanged = _has_intact_seal(results, request.out)
        sealed.unseal(results)
        results.delete([SUMMARY_FILE, GATE_FILE])  # they describe the earlier results
        if request.shard is None and not request.claim:
            results.write(AUDIT_FILE, content)  # its `fail_on`, `strict` and `min_judged` may differ
    # The process that wrote audit.json may not have written the rules yet, or was killed before it could.
    results.create(RULES_FILE, parquet_bytes(rule_table(request.settings), "rule"))
    return was_unchanged


def read_audit_file(results: ResultStore, dest: str) -> dict[str, Any] | None:
    """Return the content of `audit.json`; None: there is no audit. `dest`: the place, for the error message. Errors: `UsageError` for a
    damaged file."""
    content = results.read(AUDIT_FILE)
    try:
        document = None if content is None else json.loads(content)
        if document is None or (isinstance(document["settings"], dict) and isinstance(document["run_id"], str)):
            return document
    except (ValueError, KeyError, TypeError, RecursionError):
        pass
    raise UsageError(
        f"{dest}: {AUDIT_FILE} was changed since drivelint audit wrote it: audit the drives again into another --out"
    )


def _has_intact_seal(results: ResultStore, dest: str) -> bool:
    with TemporaryDirectory(prefix="drivelint-audit-") as downloads:
        return sealed.require_listed_files_unchanged_and_return_has_list(results, Path(downloads), dest)


def _settings_without_memory(settings: JudgeSettings) -> dict[str, Any]:
    return {key: value for key, value in vars(settings).items() if key != "memory"}


def _drive_input(request: AuditRequest) -> DriveInput:
    return DriveInput(**{field.name: getattr(request, field.name) for field in fields(DriveInput)})
