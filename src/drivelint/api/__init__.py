"""The Python interface: what the command line does, as functions that return and raise and never exit."""

from __future__ import annotations

from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING

from drivelint import run
from drivelint.api import options
from drivelint.api.check_result import CheckResult
from drivelint.api.progress import kept_notes
from drivelint.api.tables import Table
from drivelint.api.trace_tables import TraceTables
from drivelint.cli import values
from drivelint.drive.trace import DriveInput
from drivelint.errors import UsageError
from drivelint.formats import registry
from drivelint.gate import GateInputs
from drivelint.report import outputs
from drivelint.result import request
from drivelint.result.files import prepare_folder
from drivelint.result.load import load_result

if TYPE_CHECKING:
    from drivelint.api.options import AnyPath, Assignments, FailOn, Handedness, Pair, Paths, Texts, Visibility
    from drivelint.api.progress import NoteKeeper
    from drivelint.result.model import Result

__all__ = ["CheckResult", "Table", "TraceTables", "check", "open", "read_trace"]


def check(
    traces: Paths,
    *,
    map: AnyPath | None = None,  # noqa: A002 - the option's name
    map_dir: AnyPath | None = None,
    map_offset: Pair = None,
    map_origin: Pair = None,
    handedness: Handedness = "auto",
    mapping: AnyPath | None = None,
    topic: str | None = None,
    ego: str | int | None = None,
    sensor_range: float | None = None,
    visibility: Visibility = "line-of-sight",
    ego_size: str | tuple[float, ...] | None = None,
    env: Assignments = None,
    rules: Texts = None,
    ignore: Texts = None,
    profile: Texts = None,
    param: Assignments = None,
    rules_dir: Paths | None = None,
    fail_on: FailOn = "critical",
    strict: bool = False,
    out: AnyPath | None = None,
    margins: bool = False,
    keep_db: bool = False,
    annotate: bool = True,
    baseline: AnyPath | None = None,
    waivers: AnyPath | None = None,
    today: date | str | None = None,
    memory: str | None = None,
    rule_timeout: float = 30.0,
    progress: bool = False,
) -> CheckResult:
    """Judge recorded drives against the rules.

    The keywords are the options of `drivelint check`, which `drivelint check --help` describes: one value or several where an
    option is repeatable; `env` and `param` also as a dictionary, pairs of numbers also as a tuple. `drivelint.toml` is not read.
    `progress`: show a bar. Errors: `DriveLintError` for what was asked, or if no drive at all could be judged.
    """
    paths, folder = options.texts(traces), options.path(out)
    if not paths:
        raise UsageError("no traces: give files, globs or folders")
    day = values.parse_today(today.isoformat() if isinstance(today, date) else today)
    gate_inputs = GateInputs.from_files(options.path(baseline), options.path(waivers), None, day, folder)
    settings = run.CheckOptions(
        traces=paths,
        **options.map_input(
            map_=map, map_dir=map_dir, map_offset=map_offset, map_origin=map_origin, handedness=handedness
        ),
        **options.drive_input(
            ego=ego,
            mapping=mapping,
            topic=topic,
            sensor_range=sensor_range,
            visibility=visibility,
            ego_size=ego_size,
            env=env,
        ),
        out=folder,
        rules=options.texts(rules),
        ignore=options.texts(ignore),
        profiles=options.texts(profile),
        params=options.assignments(param),
        rules_dirs=tuple(Path(each) for each in options.texts(rules_dir)),
        fail_on=options.one_of("fail_on", fail_on, options.FailOn),
        strict=strict,
        margins=margins,
        keep_db=keep_db,
        annotate=annotate,
        evidence=True,
        memory=values.parse_memory(memory),
        rule_timeout=rule_timeout,
    )
    if folder is not None:
        prepare_folder(folder)
    with kept_notes(progress) as listener:
        result = _interruptible(settings, listener)
    if gate_inputs is not None:
        result = gate_inputs.apply_to(result)
    if folder is not None:
        outputs.write(result, folder)
    return CheckResult(replace(result, margins_file=None), folder, tuple(listener.notes))


def _interruptible(settings: run.CheckOptions, listener: NoteKeeper) -> Result:
    """Run a check; an interrupt is `KeyboardInterrupt`, which DuckDB hides in an error of its own."""
    try:
        return run.check(settings, listener)
    except RuntimeError as error:
        if isinstance(error.__cause__, KeyboardInterrupt):
            raise error.__cause__ from None
        raise


def open(folder: AnyPath) -> CheckResult:  # noqa: A001 - read as drivelint.open
    """Return the result in a folder that `check --out` wrote.

    Errors: `DriveLintError` for a folder without a whole result, or one of another version.
    """
    place = Path(folder)
    asked = request.load(place) if (place / request.RUN_FILE).is_file() else None
    return CheckResult(replace(load_result(place), asked=asked), place)


def read_trace(
    path: AnyPath,
    *,
    mapping: AnyPath | None = None,
    topic: str | None = None,
    ego: str | int | None = None,
    sensor_range: float | None = None,
    visibility: Visibility = "line-of-sight",
    ego_size: str | tuple[float, ...] | None = None,
    env: Assignments = None,
) -> TraceTables:
    """Read one recorded drive into tables, checked and in SI units, as `check` reads it; the ego may be missing.

    Errors: `DriveLintError` for a log that is missing, unreadable or has nothing to judge, or a bad mapping.
    """
    asked = DriveInput(
        **options.drive_input(
            ego=ego,
            mapping=mapping,
            topic=topic,
            sensor_range=sensor_range,
            visibility=visibility,
            ego_size=ego_size,
            env=env,
        )
    )
    return TraceTables(registry.read_trace(Path(path), asked.ingest_options(need_ego=False)))
