"""Runs a check: reads traces and a map, judges them by the rules, and returns a result. The stages exchange only tables."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, fields, replace
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc

from drivelint import catalogue
from drivelint.drive.trace import NOT_IN_FOLDER_CHECK
from drivelint.engine.apart import judge_and_refuse_faulty
from drivelint.engine.barrier import RefusedLog
from drivelint.engine.batch import Drive, cut_batches, read_drives, sorted_logs
from drivelint.engine.default_rules import with_selectors_of_run
from drivelint.engine.interruption import InterruptedRunError, Interruption, NothingJudgedError
from drivelint.engine.judging_options import JudgingOptions
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.memory import MemoryLimit
from drivelint.engine.profiles import DEFAULT_PROFILES, load_profiles, profile_table
from drivelint.engine.robustness.copies import MeasurementErrors
from drivelint.engine.session import JudgingSession
from drivelint.errors import TraceError, UsageError
from drivelint.evaluate.limits import RuleLimits
from drivelint.formats import expand_traces
from drivelint.pictures import PictureTaker, planned_shots, rows_of_planned_shots
from drivelint.report.log_notes import LogNote, LogNotes, note_on_repeated_log, notes_without_repeats
from drivelint.report.rule_progress import ReportingRuleLimits
from drivelint.result import collect, evidence
from drivelint.result.counts import group_rows, one_finding_per_event, severity_counts_text
from drivelint.result.joining import join_results
from drivelint.result.model import Result
from drivelint.result.request import RunRequest
from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from drivelint.catalogue import Rule
    from drivelint.drive.trace import DriveInput
    from drivelint.engine.session import BatchObserver
    from drivelint.evaluate.limits import UnstoppableRuleHandler
    from drivelint.report.progress import Progress

CHECKING_STAGE: Final = "checking"
"""The stage in which drives are judged; their copies are judged in a later stage."""
_INTERRUPTED_REASON: Final = "the run was interrupted before this drive was judged"


@dataclass(frozen=True)
class CheckOptions(JudgingOptions):
    """The options of the command `check`; each field is named like its option."""

    traces: tuple[str, ...]
    out: Path | None = None
    margins: bool = False
    keep_db: bool = False
    named_rules: tuple[str, ...] | None = None
    """Ids of the rules that the user named; None: all ids of rules among the selectors."""
    manifest_options: Mapping[Path, DriveInput] = field(default_factory=dict, hash=False)
    """Log -> the options that a manifest gives for the log and its map; they replace the general options."""
    min_judged: float | None = None
    """The least share of rules that must be decided, see `result.model.decided_share`."""
    pictures: bool = True
    """Take pictures from the cameras in the logs, if evidence is gathered."""
    evidence: bool = False
    """Gather the evidence for reports even without `out`."""
    threads: int | None = None
    """How many cores a statement may use; None: all."""

    @classmethod
    def from_judging_options(
        cls, traces: tuple[str, ...], options: JudgingOptions, out: Path | None = None
    ) -> CheckOptions:
        """Return the options of a check of these logs, with the judging options of `options` and without its other fields."""
        return cls(traces, out, **{field.name: getattr(options, field.name) for field in fields(JudgingOptions)})


class RunRules(NamedTuple):
    """The rules of a run: the rules, the ids of required rules, their parameters, and the table of profiles."""

    rules: Sequence[Rule]
    required: tuple[str, ...]
    params: Mapping[str, Mapping[str, object]]
    profiles: pa.Table

    @classmethod
    def from_options(cls, settings: CheckOptions) -> RunRules:
        """Return the rules and profiles that the options of a run choose. Errors: `UsageError`, `RuleError`."""
        rules_by_id = catalogue.load_rules(settings.rules_dirs)
        rules = catalogue.select_rules(rules_by_id, settings.rules, settings.ignore, named_ids=settings.named_rules)
        required = catalogue.required_rules(rules_by_id, rules, settings.require, settings.ignore)
        params = catalogue.parse_params(rules, settings.params)
        profiles = profile_table(load_profiles(settings.rules_dirs), settings.profiles)
        if (settings.margins or settings.keep_db) and settings.out is None:
            raise UsageError("--margins and --keep-db write files: name their folder with --out DIR")
        return cls(rules, required, params, profiles)


@dataclass(frozen=True)
class JudgedLogs:
    """The outcome of some logs of a run: a result, and the notes on the logs."""

    result: Result
    notes: tuple[LogNote, ...]
    refused_logs: tuple[RefusedLog, ...]
    cameras: Mapping[str, tuple[str, ...]]
    """drive_id -> topics of its cameras; only drives with cameras."""


def check(
    settings: CheckOptions,
    progress: Progress,
    interruption: Interruption | None = None,
    unstoppable_rule_handler: UnstoppableRuleHandler | None = None,
    on_nothing_judged: Callable[[Result], object] | None = None,
) -> Result:
    """Judge every drive by every selected rule.

    `unstoppable_rule_handler`: which rules are known to continue after an interrupt, and what to do about another such rule.
    `on_nothing_judged`: called with the result if no drive could be judged, before the error is raised; an earlier result left in `out`
    would look like that of this run.

    After an interruption, the result contains the remaining drives as not judged. If no drive was judged before it, the error is
    `NothingJudgedError`, a `KeyboardInterrupt`.
    Errors: `UsageError`, `RuleError` for wrong options or rules; `MapError`, `TraceError` if no drive could be judged. If only some drives
    cannot be judged, they are rows of the table `drive`, and no error is raised.
    """
    library = MapLibrary(settings)
    settings = with_selectors_of_run(settings, library)
    run_rules = RunRules.from_options(settings)
    paths, refused_logs = named_logs(settings)
    progress.stage(CHECKING_STAGE, len(paths))
    judged_logs = judge_logs(
        settings,
        run_rules,
        paths,
        refused_logs=refused_logs,
        progress=progress,
        notes=LogNotes(progress, len(paths)),
        interruption=interruption,
        unstoppable_rule_handler=unstoppable_rule_handler,
        library=library,
    )
    return join_parts(paths, [judged_logs], on_nothing_judged)


def judge_logs(
    settings: CheckOptions,
    run_rules: RunRules,
    paths: Sequence[Path],
    *,
    refused_logs: list[RefusedLog],
    progress: Progress,
    notes: LogNotes,
    interruption: Interruption | None = None,
    unstoppable_rule_handler: UnstoppableRuleHandler | None = None,
    library: MapLibrary | None = None,
) -> JudgedLogs:
    """Judge logs in one database, in their order; add logs that could not be judged to `refused_logs`.

    `library`: the maps of these options, some of which may be read already.
    """
    interruption = interruption or Interruption()
    rules, required, params, profiles = run_rules
    with store.temporary_database(settings.memory, threads=settings.threads) as con:
        memory = MemoryLimit(con, settings.memory, progress.note)
        store.insert(con, "profile", profiles)
        table = collect.rule_table(rules, params, settings.profiles or DEFAULT_PROFILES)
        # the report and the annotated logs read each batch before its tables are cleared
        observers: list[BatchObserver] = []
        if settings.out or settings.evidence:
            observers.append(lambda con, _drives, **_part: evidence.gather(con))
        cameras = PictureTaker() if settings.pictures and (settings.out or settings.evidence) else None
        if cameras is not None:
            observers.append(cameras)
        if settings.out and settings.annotate:
            from drivelint.annotate import Annotator  # its libraries take a tenth of a second to import

            annotated = settings.out / "annotated"
            observers.append(
                Annotator(
                    annotated,
                    table,
                    fail_on=settings.fail_on,
                    strict=settings.strict,
                    required=required,
                    note=progress.note,
                    release_memory=memory.release_unused_memory,
                )
            )
        limits = ReportingRuleLimits(
            progress,
            len(rules),
            settings.rule_timeout,
            task="drives",
            unstoppable_rule_handler=unstoppable_rule_handler,
        )
        session = JudgingSession(
            con,
            rules,
            params,
            settings.out,
            margins=settings.margins,
            keep_db=settings.keep_db,
            observers=observers,
            memory=memory,
            interruption=interruption,
            errors=None if settings.robustness is False else MeasurementErrors(),
            copies_of_all=settings.robustness is True,
            limits=limits,
            limits_of_copies=RuleLimits(
                settings.rule_timeout, task="copies", unstoppable_rule_handler=unstoppable_rule_handler
            ),
        )
        ids: dict[Path, str] = {}
        incoming = _with_reading_progress(_read_logs(paths, settings, library), len(paths), progress)
        incoming = takewhile(lambda _item: not interruption.requested, incoming)
        try:
            with suppress(InterruptedRunError):
                for batch in cut_batches(incoming):
                    ids |= {drive.trace.path: drive.trace.drive_id for drive in batch if isinstance(drive, Drive)}
                    _judge_batch(session, batch, refused_logs, progress=progress, notes=notes, limits=limits)
            _judge_copies(session, progress, memory)
        finally:
            session.close()
        # of two logs with the same content, the first determines the path and the options
        judged_drives = [(name, path) for path, name in reversed(ids.items()) if name in session.judged_drive_ids]
        finished_paths = {path for _, path in judged_drives} | {log.path for log in refused_logs}
        missed = sorted(set(paths) - finished_paths) if interruption.requested else []
        unjudged = [collect.unjudged_drive(r.path.stem, r.path.name, str(r.error)) for r in refused_logs]
        unjudged += [collect.unjudged_drive(path.stem, path.name, _INTERRUPTED_REASON) for path in missed]
        drives = pa.concat_tables([memory.run_job(collect.drives), *unjudged])
        result = Result(
            verdicts=memory.run_job(collect.verdicts),
            findings=memory.run_job(collect.findings),
            drives=drives.sort_by([("drive_id", "ascending"), ("file_name", "ascending")]),
            rules=table,
            **memory.run_job(evidence.evidence_tables),
            margins_file=session.margins_file,
            fail_on=settings.fail_on,
            strict=settings.strict,
            required=required,
            min_judged=settings.min_judged,
            interrupted=bool(missed),
            run_options=RunRequest.from_options(
                settings,
                {name: str(path) for name, path in judged_drives},
                {
                    name: settings.manifest_options[path]
                    for name, path in judged_drives
                    if path in settings.manifest_options
                },
            ),
        )
        if cameras is not None and cameras.topics_by_drive:
            progress.doing("taking pictures from cameras")
            pictures, troubles = cameras.take_pictures(result)
            result = replace(result, pictures=pictures)
            for trouble in troubles:
                notes.add(LogNote(trouble.path, trouble.text, once=True))
        return JudgedLogs(
            result, tuple(notes.notes), tuple(refused_logs), {} if cameras is None else cameras.topics_by_drive
        )


def join_parts(
    paths: Sequence[Path], parts: Sequence[JudgedLogs], on_nothing_judged: Callable[[Result], object] | None = None
) -> Result:
    """Return the result of a run, joined from its parts, which have no drive in common.

    The notes are in the order of the logs, `paths`. Errors: as `check`, if no drive could be judged.
    """
    result = parts[0].result
    if len(parts) > 1:
        result = join_results([part.result for part in parts])
        cameras = {drive: topics for part in parts for drive, topics in part.cameras.items()}
        result = replace(result, pictures=rows_of_planned_shots(result.pictures, planned_shots(result, cameras)))
    place = {path: n for n, path in enumerate(paths)}
    notes = sorted((note for part in parts for note in part.notes), key=lambda note: place.get(note.path, -1))
    result = replace(result, notes=tuple(note.full_text for note in notes_without_repeats(notes)))
    statuses = result.drives["status"].to_pylist()
    if result.interrupted and "judged" not in statuses:
        raise NothingJudgedError
    refusals = [refusal for part in parts for refusal in part.refused_logs]
    if len(refusals) >= len(statuses):
        if on_nothing_judged is not None:
            on_nothing_judged(result)
        first = refusals[0].error
        error = TraceError(f"none of {len(refusals)} logs could be judged; the first: {first}")
        raise first if len(refusals) == 1 else error
    return result


def named_logs(settings: CheckOptions) -> tuple[list[Path], list[RefusedLog]]:
    """Return the logs that the options name, and no refusals; if a name matches no log and `out` is given, only its refusal.

    Errors: `TraceError` for such a name without `out`; `UsageError` for a name in a manifest that is not one log.
    """
    try:
        paths = sorted_logs(expand_traces(settings.traces, map_path=settings.map))
    except TraceError:
        for name in settings.traces if settings.out is not None else ():
            try:
                expand_traces([name])
            except TraceError as error:
                return [], [RefusedLog(Path(name), error)]
        raise
    if no_logs := sorted(str(path) for path in settings.manifest_options.keys() - set(paths)):
        raise UsageError(f"{no_logs[0]}: is not one log: a manifest names each log in a row of its own")
    return paths, []


def _read_logs(
    paths: Sequence[Path], settings: CheckOptions, library: MapLibrary | None
) -> Iterator[Drive | RefusedLog]:
    """Yield every log, read with the options that apply to it; logs with the same options are read together."""
    for options, logs in group_rows(paths, lambda path: settings.manifest_options.get(path, settings)).items():
        maps = library if library is not None and options is settings else MapLibrary(options)
        yield from read_drives(logs, options.ingest_options(), maps)


def _with_reading_progress(
    drives: Iterable[Drive | RefusedLog], n: int, progress: Progress
) -> Iterator[Drive | RefusedLog]:
    """Yield the logs, and show which log is read next: a batch is read before it is judged."""
    progress.doing(f"reading 1/{n}")
    for n_read, item in enumerate(drives, 1):
        yield item
        progress.doing(f"reading {min(n_read + 1, n)}/{n}")


def _missing_map_messages(drive: Drive) -> list[str]:
    """Return the message that the folder of maps has no map of the drive's place; empty if it has one."""
    quality = drive.trace.tables["quality"]
    texts: list[str] = quality.filter(pc.equal(quality["check_id"], NOT_IN_FOLDER_CHECK))["message"].to_pylist()
    return texts


def _judge_copies(session: JudgingSession, progress: Progress, memory: MemoryLimit) -> None:
    """Judge the copies that are not judged yet, even after an interruption."""
    if session.n_waiting_drives:
        findings = one_finding_per_event(memory.run_job(collect.findings).to_pylist())
        # the number of findings is shown before the copies are judged
        word = "finding" if len(findings) == 1 else "findings"
        progress.stage(f"{severity_counts_text(findings)} {word}; judging copies", session.n_findings_to_copy_first())
        session.judge_copies(progress.advance)


def _judge_batch(
    session: JudgingSession,
    batch: Iterable[Drive | RefusedLog],
    refused_logs: list[RefusedLog],
    *,
    progress: Progress,
    notes: LogNotes,
    limits: ReportingRuleLimits,
) -> None:
    """Judge a batch; if this fails, drive by drive, so that a bad drive affects no other. Add refused drives to `refused_logs`."""
    n_before = len(refused_logs)
    drives: list[Drive] = []
    for item in batch:
        if isinstance(item, RefusedLog):
            refused_logs.append(item)
        elif session.has_judged(item) or any(item.trace.drive_id == d.trace.drive_id for d in drives):
            notes.add(note_on_repeated_log(item.trace.path, item.trace.drive_id))
        else:
            drives.append(item)
            for text in item.trace.notes:
                notes.add(LogNote(item.trace.path, text, once=True))
            for text in _missing_map_messages(item):
                notes.add(LogNote(item.trace.path, text))
    limits.begin_batch(len(drives))
    n_unread = len(refused_logs) - n_before
    try:
        judge_and_refuse_faulty(session, drives, refused_logs)
    finally:
        notes.add_refused_logs(refused_logs[n_before:])
    progress.advance(len(drives) + n_unread)
