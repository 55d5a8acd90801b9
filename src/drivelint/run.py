"""Runs a check: reads traces and a map, judges by the rules, returns a result. Stages meet only in tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import duckdb
import pyarrow as pa

from drivelint import catalogue
from drivelint.annotate import Annotator
from drivelint.drive.trace import DriveInput
from drivelint.engine.batch import Drive, RefusedLog, cut_batches, read_drives, sorted_logs
from drivelint.engine.copies import MeasurementErrors
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.memory import DEFAULT_MEMORY, Memory
from drivelint.engine.profiles import DEFAULT_PROFILES, load_profiles, profile_table
from drivelint.engine.session import JudgingSession
from drivelint.errors import DriveLintError, MemoryShortError, TraceError, UsageError
from drivelint.formats import expand_traces
from drivelint.result import collect, evidence
from drivelint.result.files import OutputError
from drivelint.result.model import Result
from drivelint.result.request import RunRequest
from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from drivelint.engine.session import BatchObserver
    from drivelint.report.progress import Progress


@dataclass(frozen=True)
class CheckOptions(DriveInput):
    """The options of `check`, under the names that they have there."""

    traces: tuple[str, ...]
    out: Path | None = None
    rules: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    profiles: tuple[str, ...] = ()
    params: tuple[str, ...] = ()
    rules_dirs: tuple[Path, ...] = ()
    fail_on: str = "critical"
    strict: bool = False
    margins: bool = False
    keep_db: bool = False
    annotate: bool = True
    robustness: bool = True
    memory: int | None = DEFAULT_MEMORY
    """Bytes that the database keeps to before it uses the disk; None: 80 % of the machine's."""


def check(settings: CheckOptions, progress: Progress) -> Result:
    """Judge every drive by every selected rule.

    Errors: `UsageError`, `RuleError` for what was asked; `MapError`, `TraceError` if no drive at all could be judged. A drive that
    cannot be judged beside others that can is a row of the table `drive`.
    """
    rules = catalogue.select_rules(catalogue.load_rules(settings.rules_dirs), settings.rules, settings.ignore)
    params = catalogue.parse_params(rules, settings.params)
    profiles = profile_table(load_profiles(settings.rules_dirs), settings.profiles)
    if (settings.margins or settings.keep_db) and settings.out is None:
        raise UsageError("--margins and --keep-db write files: say where with --out DIR")
    paths = sorted_logs(expand_traces(settings.traces))
    options, library = settings.ingest_options(), MapLibrary(settings)

    with store.workspace(settings.memory) as con:
        memory = Memory(con, settings.memory, progress.note)
        store.insert(con, "profile", profiles)
        table = collect.rule_table(rules, params, settings.profiles or DEFAULT_PROFILES)
        # the report and the annotated logs read each batch before its tables are cleared
        observers: list[BatchObserver] = []
        if settings.out:
            observers.append(lambda con, _drives, **_part: evidence.gather(con))
        if settings.out and settings.annotate:
            annotated = settings.out / "annotated"
            observers.append(Annotator(annotated, table, fail_on=settings.fail_on, strict=settings.strict))
        session = JudgingSession(
            con,
            rules,
            params,
            settings.out,
            margins=settings.margins,
            keep_db=settings.keep_db,
            observers=observers,
            memory=memory,
            errors=MeasurementErrors() if settings.robustness else None,
        )
        progress.stage("checking", len(paths))
        refused: list[RefusedLog] = []
        said: set[str] = set()
        places: dict[str, str] = {}
        try:
            for batch in cut_batches(read_drives(paths, options, library)):
                for drive in batch:
                    if isinstance(drive, Drive):
                        places.setdefault(drive.trace.drive_id, str(drive.trace.path))
                failed = _judge(session, batch, progress, said)
                refused += failed
                if len(paths) > 1:  # a single one is the error of the whole run
                    for each in failed:
                        progress.note(f"not judged: {each.error}")
        finally:
            session.close()
        if len(refused) == len(paths):
            first = refused[0].error
            many = TraceError(f"none of {len(refused)} logs could be judged; the first: {first}")
            raise first if len(refused) == 1 else many
        unjudged = [collect.unjudged_drive(r.path.stem, r.path.name, str(r.error)) for r in refused]
        drives = pa.concat_tables([memory.run_job(collect.drives), *unjudged])
        return Result(
            verdicts=memory.run_job(collect.verdicts),
            findings=memory.run_job(collect.findings),
            drives=drives.sort_by([("drive_id", "ascending"), ("file_name", "ascending")]),
            rules=table,
            **memory.run_job(evidence.tables),
            margins_file=session.margins_file,
            fail_on=settings.fail_on,
            strict=settings.strict,
            asked=RunRequest.from_options(settings, places),
        )


def _judge(
    session: JudgingSession, batch: Iterable[Drive | RefusedLog], progress: Progress, said: set[str]
) -> list[RefusedLog]:
    """Judge a batch; if it errs, drive by drive, so that one bad drive harms no other. Return what could not be judged.

    `said`: notes of earlier logs, not to be repeated for each of a thousand.
    """
    refused: list[RefusedLog] = []
    drives: list[Drive] = []
    for item in batch:
        if isinstance(item, RefusedLog):
            refused.append(item)
        elif session.has_judged(item) or any(item.trace.drive_id == d.trace.drive_id for d in drives):
            progress.note(f"{item.trace.path}: the same log as one before ({item.trace.drive_id}), judged once")
        else:
            drives.append(item)
            for note in item.trace.notes:
                if note not in said:
                    progress.note(f"{item.trace.path.name}: {note}")
            said.update(item.trace.notes)
    refused += _judged(session, drives)
    progress.advance(len(drives) + len(refused))
    return refused


def _judged(session: JudgingSession, drives: Sequence[Drive]) -> list[RefusedLog]:
    try:
        session.judge(drives)
    except OutputError:
        raise  # the folder for the results fails, not the drive
    except (DriveLintError, duckdb.Error) as error:
        if len(drives) == 1:
            return [_failed(drives[0], error)]
        # in the order of a batch's rows: files that grow with the batches have the same rows in the same order however they are cut
        drives = sorted(drives, key=lambda drive: drive.trace.drive_id)
        many = len(drives) // 2 if isinstance(error, duckdb.OutOfMemoryException) else 1
        pieces = [drives[at : at + many] for at in range(0, len(drives), many)]
        return [each for piece in pieces for each in _judged(session, piece)]
    return []


def _failed(drive: Drive, error: Exception) -> RefusedLog:
    if isinstance(error, DriveLintError):
        return RefusedLog(drive.trace.path, error)
    if isinstance(error, duckdb.OutOfMemoryException):
        return RefusedLog(drive.trace.path, MemoryShortError(str(drive.trace.path)))
    return RefusedLog(drive.trace.path, TraceError(f"{drive.trace.path}: {str(error).splitlines()[0]}"))
