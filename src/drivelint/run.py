"""The whole pipeline: traces and a map in, verdicts out. Stages meet only in tables."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

import duckdb
import pyarrow as pa

from drivelint import catalogue, conditions, store
from drivelint.annotate import Annotator
from drivelint.batch import Drive, Refused, cut, in_order, read
from drivelint.errors import DriveLintError, TraceError, UsageError
from drivelint.ingest import IngestOptions, expand
from drivelint.judge import Bench
from drivelint.maps.library import MapLibrary
from drivelint.profiles import DEFAULT, load_profiles, profile_table
from drivelint.report import collect, evidence
from drivelint.report.asked import Asked
from drivelint.report.files import OutputError
from drivelint.report.result import Result
from drivelint.report.rulebook import rule_table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from drivelint.ingest.trace import EgoSize
    from drivelint.judge import Witness
    from drivelint.report.progress import Progress

# what the database keeps in memory before it uses the disk: measured to cost nothing on a drive of 600,000 states, and to hold
# one of 4.8 million in 2.3 GB instead of 13.7
MEMORY: Final = "1200MB"


@dataclass(frozen=True)
class Settings:
    """What `check` is asked to do; the names are those of its options."""

    traces: tuple[str, ...]
    map: Path | None = None
    out: Path | None = None
    rules: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    profiles: tuple[str, ...] = ()
    params: tuple[str, ...] = ()
    ego: str | None = None
    mapping: str | None = None
    topic: str | None = None
    map_offset: tuple[float, float] | None = None
    map_dir: Path | None = None
    map_origin: tuple[float, float] | None = None
    handedness: str = "auto"
    sensor_range_m: float | None = None
    visibility: str = "line-of-sight"
    ego_size: EgoSize | None = None
    env: tuple[str, ...] = ()
    rules_dirs: tuple[Path, ...] = field(default=())
    fail_on: str = "critical"
    strict: bool = False
    margins: bool = False
    keep_db: bool = False
    annotate: bool = True


def check(settings: Settings, progress: Progress) -> Result:
    """Judge every drive by every selected rule.

    Errors: `UsageError`, `RuleError` for what was asked; `MapError`, `TraceError` if no drive at all could be judged. A drive that
    cannot be judged beside others that can is a row of the table `drive`.
    """
    rules = catalogue.select(catalogue.load(settings.rules_dirs), settings.rules, settings.ignore)
    params = catalogue.parse_params(rules, settings.params)
    profiles = profile_table(load_profiles(settings.rules_dirs), settings.profiles)
    if (settings.margins or settings.keep_db) and settings.out is None:
        raise UsageError("--margins and --keep-db write files: say where with --out DIR")
    paths = in_order(expand(settings.traces))
    options = IngestOptions(
        settings.mapping,
        settings.ego,
        settings.topic,
        settings.sensor_range_m,
        conditions=conditions.parse(settings.env),
        ego_size=settings.ego_size,
        in_sight=settings.visibility == "line-of-sight",
    )
    library = MapLibrary(
        settings.map, settings.map_offset, settings.handedness, origin=settings.map_origin, folder=settings.map_dir
    )

    with TemporaryDirectory(prefix="drivelint-") as spill, store.connect(memory_limit=MEMORY, spill=Path(spill)) as con:
        store.insert(con, "profile", profiles)
        table = rule_table(rules, params, settings.profiles or DEFAULT)
        bench = Bench(
            con,
            rules,
            params,
            settings.out,
            margins=settings.margins,
            keep_db=settings.keep_db,
            witnesses=_witnesses(settings, table),
        )
        progress.stage("checking", len(paths))
        refused: list[Refused] = []
        said: set[str] = set()
        places: dict[str, str] = {}
        try:
            for batch in cut(_noting(read(paths, options, library), places)):
                failed = _judge(bench, batch, progress, said)
                refused += failed
                if len(paths) > 1:  # a single one is the error of the whole run
                    for each in failed:
                        progress.note(f"not judged: {each.error}")
        finally:
            bench.close()
        if len(refused) == len(paths):
            raise _none_judged(refused)
        unjudged = [collect.unjudged(r.path.stem, r.path.name, str(r.error)) for r in refused]
        drives = pa.concat_tables([collect.drives(con), *unjudged]).sort_by(
            [("drive_id", "ascending"), ("file_name", "ascending")]
        )
        return Result(
            verdicts=collect.verdicts(con),
            findings=collect.findings(con),
            drives=drives,
            rules=table,
            scenes=evidence.scenes(con),
            lanes=evidence.lanes(con),
            spaces=evidence.spaces(con),
            courses=evidence.courses(con),
            overtakes=evidence.overtakes(con),
            opportunities=evidence.opportunities(con),
            margins_file=bench.margins_file,
            fail_on=settings.fail_on,
            strict=settings.strict,
            asked=_asked(settings, places),
        )


def _noting(drives: Iterable[Drive | Refused], places: dict[str, str]) -> Iterator[Drive | Refused]:
    """Yield them, and note where the log of each lies."""
    for drive in drives:
        if isinstance(drive, Drive):
            places.setdefault(drive.trace.drive_id, str(drive.trace.path))
        yield drive


def _asked(settings: Settings, places: dict[str, str]) -> Asked:
    return Asked(
        traces=places,
        map=None if settings.map is None else str(settings.map),
        map_dir=None if settings.map_dir is None else str(settings.map_dir),
        map_offset=settings.map_offset,
        map_origin=settings.map_origin,
        handedness=settings.handedness,
        mapping=settings.mapping,
        topic=settings.topic,
        sensor_range_m=settings.sensor_range_m,
        visibility=settings.visibility,
        ego_size=settings.ego_size,
        env=settings.env,
        profiles=settings.profiles,
        params=settings.params,
        rules_dirs=tuple(str(folder) for folder in settings.rules_dirs),
    )


def _witnesses(settings: Settings, rules: pa.Table) -> list[Witness]:
    """Return who looks at each batch before its tables are cleared: the report, the annotated logs."""
    if settings.out is None:
        return []
    seen: list[Witness] = [_gather]
    if settings.annotate:
        seen.append(Annotator(settings.out / "annotated", rules, fail_on=settings.fail_on, strict=settings.strict))
    return seen


def _gather(con: duckdb.DuckDBPyConnection, _drives: Sequence[Drive], **_part: bool) -> None:
    evidence.gather(con)


def _judge(bench: Bench, batch: Iterable[Drive | Refused], progress: Progress, said: set[str]) -> list[Refused]:
    """Judge a batch; if it errs, drive by drive, so that one bad drive harms no other. Return what could not be judged.

    `said`: notes of earlier logs, not to be repeated for each of a thousand.
    """
    refused: list[Refused] = []
    drives: list[Drive] = []
    for item in batch:
        if isinstance(item, Refused):
            refused.append(item)
        elif bench.knows(item) or any(item.trace.drive_id == d.trace.drive_id for d in drives):
            progress.note(f"{item.trace.path}: the same log as one before ({item.trace.drive_id}), judged once")
        else:
            drives.append(item)
            for note in item.trace.notes:
                if note not in said:
                    progress.note(f"{item.trace.path.name}: {note}")
            said.update(item.trace.notes)
    try:
        bench.judge(drives)
    except OutputError:
        raise  # the folder for the results fails, not the drive
    except (DriveLintError, duckdb.Error) as whole:
        refused += [_failed(drives[0], whole)] if len(drives) == 1 else _one_by_one(bench, drives)
    progress.advance(len(drives) + len(refused))
    return refused


def _one_by_one(bench: Bench, drives: Iterable[Drive]) -> list[Refused]:
    refused: list[Refused] = []
    for drive in drives:
        try:
            bench.judge([drive])
        except OutputError:
            raise
        except (DriveLintError, duckdb.Error) as error:
            refused.append(_failed(drive, error))
    return refused


def _failed(drive: Drive, error: Exception) -> Refused:
    if isinstance(error, DriveLintError):
        return Refused(drive.trace.path, error)
    return Refused(drive.trace.path, TraceError(f"{drive.trace.path}: {str(error).splitlines()[0]}"))


def _none_judged(refused: list[Refused]) -> DriveLintError:
    first = refused[0].error
    if len(refused) == 1:
        return first
    return TraceError(f"none of {len(refused)} logs could be judged; the first: {first}")
