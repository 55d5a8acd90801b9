"""A worker: judges the drives of a task and writes their results and receipts. Its database stays open between tasks."""

from __future__ import annotations

import hashlib
import io
from contextlib import ExitStack
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from drivelint import catalogue
from drivelint.audit import bucket
from drivelint.audit.model import AuditDrive, JudgeSettings, Receipt, Task, digest
from drivelint.audit.store import open_store
from drivelint.engine.apart import judge_and_refuse_faulty
from drivelint.engine.barrier import RefusedLog, refusal_of
from drivelint.engine.batch import drive_with_map
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.memory import DEFAULT_MEMORY_BYTES, MemoryLimit
from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.engine.robustness.copies import MeasurementErrors
from drivelint.engine.session import JudgingSession
from drivelint.errors import DriveLintError, MapError, TraceError
from drivelint.formats import read_trace
from drivelint.formats.files import identify
from drivelint.result import collect
from drivelint.result.model import LIMIT_ERROR_CODES, map_misfit_reason
from drivelint.sql import declarations, store

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.audit.store import ResultStore
    from drivelint.drive.trace import DriveInput, Identity
    from drivelint.engine.batch import Drive

TABLES = ("verdicts", "findings", "drives")
"""The tables of an audit: the tables of a check with the additional column `key`; `drives` also has `log` and `tags`."""
TASKS_PER_RELEASE = 8
"""After this many tasks a worker frees memory that it does not need. For short drives this takes less than 1 % of the time."""
_LASTING_TABLES = frozenset({"profile", "environment", "map_quality"})


class Judge:
    """A database with rules and maps that judges one task after the other. It uses one thread: a machine has one worker per core."""

    def __init__(self, settings: JudgeSettings) -> None:
        self._stack = ExitStack()
        memory = DEFAULT_MEMORY_BYTES if settings.memory is None else settings.memory
        self._con = self._stack.enter_context(store.temporary_database(memory))
        self._con.execute("SET threads=1")
        rules = catalogue.select_rules(catalogue.load_rules(settings.rules_dirs), settings.rules, settings.ignore)
        params = catalogue.parse_params(rules, settings.params)
        profiles = profile_table(load_profiles(settings.rules_dirs), settings.profiles)
        store.insert(self._con, "profile", profiles)
        self._stable_rule_ids = pa.array([rule.id for rule in rules if rule.status == "stable"], pa.string())
        errors = MeasurementErrors() if settings.robustness else None
        self._memory = MemoryLimit(self._con, memory)
        self._session = JudgingSession(
            self._con, rules, params, None, memory=self._memory, errors=errors, copies_of_all=True
        )
        self._n_tasks = 0
        self._library, self._maps = cache(MapLibrary), cache(self._download_map)
        self._worker_folder = Path(self._stack.enter_context(TemporaryDirectory(prefix="drivelint-worker-")))
        self._task_folder = self._worker_folder

    def judge(self, task: Task) -> list[Receipt]:
        """Judge the drives of a task that have no receipt yet. Write the tables, then the receipts. Return the receipts of all drives of
        the task."""
        with TemporaryDirectory(dir=self._worker_folder) as folder:
            self._task_folder = Path(folder)
            receipts = self._judge_drives(task, open_store(task.dest))
        self._n_tasks += 1
        if self._n_tasks % TASKS_PER_RELEASE == 0:
            self._memory.release_unused_memory()
        return receipts

    def _judge_drives(self, task: Task, results: ResultStore) -> list[Receipt]:
        receipts: list[Receipt] = []
        unjudged: dict[str, tuple[AuditDrive, Drive | RefusedLog]] = {}
        for drive in task.drives:
            key, as_read = self._find_receipt_or_read_drive(drive, task.run_id, results)
            if isinstance(as_read, Receipt):
                receipts.append(as_read)
            elif key in unjudged:  # the same log twice in one task is judged once
                continue
            else:
                unjudged[key] = drive, as_read
        # drives with the same content but different options have the same id: they cannot be judged together
        while unjudged:
            ids: set[str] = set()
            part: dict[str, tuple[AuditDrive, Drive | RefusedLog]] = {}
            for key, (_, as_read) in list(unjudged.items()):
                name = as_read.path.name if isinstance(as_read, RefusedLog) else as_read.trace.drive_id
                if name not in ids:
                    ids.add(name)
                    part[key] = unjudged.pop(key)
            receipts += self._judge_distinct_drives(part, results)
        return receipts

    def _find_receipt_or_read_drive(
        self, drive: AuditDrive, run_id: str, results: ResultStore
    ) -> tuple[str, Receipt | Drive | RefusedLog]:
        """Return the key of a drive, and its receipt if one exists, else the drive that was read or the refusal of its log."""
        path, key = Path(drive.log), drive.source_id
        try:
            path, options = self._download_inputs(drive)
            identity = identify(path)
            # includes the file name, with which the ids of the drive and its findings begin, and the tags, which are in the drive's row
            key = digest([run_id, drive.options_id, identity.sha256, identity.file_name, drive.tags])
            if (content := results.read(receipt_name(key))) is not None:
                return key, replace(Receipt.from_json(content), reused=True)
            trace = read_trace(path, options.ingest_options())
            _require_unchanged(path, identity)
            return key, drive_with_map(trace, self._library(options))
        except BaseException as error:  # noqa: BLE001 - some libraries raise errors that are not an Exception
            return key, refusal_of(path, error)

    def _download_inputs(self, drive: AuditDrive) -> tuple[Path, DriveInput]:
        """Return the local path of the log, and the drive's options with the local path of the map. Both files are downloaded if they are
        in a bucket."""
        options = drive.options
        if options.map is not None and (url := bucket.url_of_path(options.map)) is not None:
            options = replace(options, map=self._maps(url))
        if not bucket.is_url(drive.log):
            return Path(drive.log), options
        return bucket.download(bucket.BucketObject(drive.log, drive.size, drive.stamp), self._task_folder), options

    def _download_map(self, url: str) -> Path:
        remote = bucket.find_object(url)
        if remote is None:
            raise MapError(f"map {url}: no such object: check the URL")
        home = self._worker_folder / "maps" / digest(url)
        home.mkdir(parents=True)
        return bucket.download(remote, home)

    def _judge_distinct_drives(
        self, part: Mapping[str, tuple[AuditDrive, Drive | RefusedLog]], results: ResultStore
    ) -> list[Receipt]:
        """Judge drives that all have different ids together, write the results, and return the receipts."""
        for table in declarations.tables_of_lifetime("run"):
            if table not in _LASTING_TABLES:
                store.recreate_empty(self._con, [table])
        self._session.forget_judged_logs()
        drives = [outcome for _, outcome in part.values() if not isinstance(outcome, RefusedLog)]
        refusals: list[RefusedLog] = []
        if drives:
            judge_and_refuse_faulty(self._session, drives, refusals)
            self._session.judge_copies()
        failed = {refusal.path: refusal for refusal in refusals}
        tables = {"verdicts": collect.verdicts(self._con), "findings": collect.findings(self._con)}
        drive_rows = collect.drives(self._con)
        rows: dict[str, list[pa.Table]] = {table: [] for table in TABLES}
        receipts: list[Receipt] = []
        for key, (drive, as_read) in sorted(part.items()):
            outcome = as_read if isinstance(as_read, RefusedLog) else failed.get(as_read.trace.path, as_read)
            if isinstance(outcome, RefusedLog):
                path = outcome.path
                rows_of_drive = {
                    "verdicts": tables["verdicts"].slice(0, 0),
                    "findings": tables["findings"].slice(0, 0),
                    "drives": collect.unjudged_drive(path.stem, path.name, str(outcome.error), _log_sha256(path)),
                }
            else:
                name = outcome.trace.drive_id
                rows_of_drive = {table: of.filter(pc.equal(of["drive_id"], name)) for table, of in tables.items()}
                rows_of_drive["drives"] = drive_rows.filter(pc.equal(drive_rows["drive_id"], name))
            marked = {
                table: with_key(rows_of_drive[table], key, drive if table == "drives" else None) for table in TABLES
            }
            for table, of in marked.items():
                rows[table].append(of)
            receipts.append(self._receipt_of_rows(key, drive, marked))
        return write_batch_and_return_valid_receipts(
            results, {table: pa.concat_tables(of) for table, of in rows.items()}, receipts
        )

    def _receipt_of_rows(self, key: str, drive: AuditDrive, rows: Mapping[str, pa.Table]) -> Receipt:
        return Receipt(
            key=key,
            source_id=drive.source_id,
            batch="",
            log=drive.log,
            size=drive.size,
            stamp=drive.stamp,
            tags=drive.tags,
            options=drive.options_json,
            **receipt_fields(rows, self._stable_rule_ids),
        )

    def close(self) -> None:
        """Close the database."""
        self._stack.close()


_judge_of_settings: dict[JudgeSettings, Judge] = {}


def run_task(task: Task) -> list[Receipt]:
    """Judge a task in this process, and keep its database open for the next task. Errors: `OutputError`, `UsageError`, `RuleError`."""
    open_judge(task.settings)
    with ExitStack() as after_error:
        # an error may leave the database in any state, so the next task gets a new one
        after_error.callback(lambda: _judge_of_settings.pop(task.settings).close())
        receipts = _judge_of_settings[task.settings].judge(task)
        after_error.pop_all()
    return receipts


def open_judge(settings: JudgeSettings) -> None:
    """Open the database in which this process judges with these settings, unless it is already open."""
    if settings not in _judge_of_settings:
        for judge in _judge_of_settings.values():
            judge.close()
        _judge_of_settings.clear()
        _judge_of_settings[settings] = Judge(settings)


def with_key(rows: pa.Table, key: str, drive: AuditDrive | None) -> pa.Table:
    """Return rows of a check's table as rows of an audit's table: with `key` as first column; if `drive` is given, also with its log and
    tags."""
    fields = [pa.field("key", pa.string(), nullable=False)]
    table = rows.add_column(0, fields[0], pa.repeat(pa.scalar(key, pa.string()), rows.num_rows))
    if drive is not None:
        table = table.append_column("log", pa.repeat(pa.scalar(drive.log, pa.string()), rows.num_rows))
        tags = pa.array([sorted(drive.tags.items())] * rows.num_rows, pa.map_(pa.string(), pa.string()))
        table = table.append_column("tags", tags)
    return table


def receipt_fields(rows: Mapping[str, pa.Table], stable_rule_ids: pa.Array) -> dict[str, Any]:
    """Return the fields of a receipt that follow from a drive's rows. `stable_rule_ids`: the ids of the stable rules."""
    (about,) = rows["drives"].to_pylist()
    verdicts = rows["verdicts"]
    gating = verdicts.filter(pc.is_in(verdicts["rule_id"], value_set=stable_rule_ids))
    limited = pc.is_in(verdicts["reason_code"], value_set=pa.array(LIMIT_ERROR_CODES, pa.string()))
    return {
        "status": "judged" if about["status"] == "judged" else "refused",
        "drive_id": about["drive_id"],
        "log_sha256": about["sha256"],
        "map_sha256": about["map_sha256"],
        "reason": about["status_reason"],
        "lossy": about["lossy"],
        "off_map": map_misfit_reason(about) is not None,
        "rows_sha256": rows_sha256(rows),
        "km": about["km"],
        "duration_s": about["duration_s"] or 0.0,
        "counts": _rows_per_value(verdicts, "verdict"),
        "failed": _rows_per_value(gating.filter(pc.equal(gating["verdict"], "fail")), "severity"),
        "unknown": _rows_per_value(gating, "verdict").get("unknown", 0),
        "beyond_limits": _rows_per_value(verdicts.filter(limited), "verdict").get("error", 0),
    }


def rows_sha256(rows: Mapping[str, pa.Table]) -> str:
    """Return the hash of a drive's rows in all tables. The columns `log` and `tags` are left out, because they do not describe the
    content."""
    whole = hashlib.sha256()
    for table in TABLES:
        columns = [name for name in rows[table].column_names if name not in {"log", "tags"}]
        whole.update(_parquet_bytes(rows[table].select(columns)))
    return whole.hexdigest()


def write_batch_and_return_valid_receipts(
    results: ResultStore, rows: Mapping[str, pa.Table], receipts: Sequence[Receipt]
) -> list[Receipt]:
    """Write one file per table, then the receipt of each drive. Return the receipts that are valid.

    If another worker has already written the receipt of a drive, that receipt is valid. Errors: `OutputError`; `DriveLintError` if its rows
    differ.
    """
    batch = digest(sorted(receipt.key for receipt in receipts))[:32]
    files = {batch_name(table, batch): _parquet_bytes(rows[table]) for table in TABLES}
    for name, content in files.items():
        results.write(name, content)
    valid: list[Receipt] = []
    for receipt in receipts:
        own_receipt = replace(receipt, batch=batch, n_in_batch=len(receipts))
        if results.create(receipt_name(own_receipt.key), own_receipt.to_json()):
            valid.append(own_receipt)
            continue
        there = Receipt.from_json(results.read(receipt_name(own_receipt.key)) or b"")
        if there.rows_sha256 != own_receipt.rows_sha256:
            raise DriveLintError(
                f"{own_receipt.log}: two workers got different results for one key ({own_receipt.key}): "
                "use one machine image for all workers"
            )
        valid.append(replace(there, reused=True))
    if results.read(next(reversed(files))) is None:
        # Another audit has begun before the receipts existed, and has removed the files as leftovers of a killed worker.
        for name, content in files.items():
            results.write(name, content)
    return valid


def batch_name(table: str, batch: str) -> str:
    """Return the file name of a batch in one table."""
    return f"batches/{table}/{batch}.parquet"


def receipt_name(key: str) -> str:
    """Return the file name of the receipt with this key."""
    return f"receipts/{key[:2]}/{key}.json"


def _log_sha256(log: Path) -> str | None:
    """Return the hash of a refused log, which identifies copies of the log; None if the log cannot be read."""
    try:
        return identify(log).sha256
    except TraceError:
        return None


def _require_unchanged(path: Path, identity: Identity) -> None:
    if identify(path).sha256 != identity.sha256:
        raise TraceError(f"{path}: changed while it was read: audit it again when it is whole")


def _parquet_bytes(rows: pa.Table) -> bytes:
    sink = io.BytesIO()
    pq.write_table(rows.combine_chunks(), sink, compression="zstd")
    return sink.getvalue()


def _rows_per_value(rows: pa.Table, column: str) -> dict[str, int]:
    row_counts = rows.group_by(column).aggregate([([], "count_all")]).to_pylist()
    return {row[column]: row["count_all"] for row in sorted(row_counts, key=lambda row: str(row[column]))}
