"""The Python interface: the commands of the command line as functions, which return a result or raise an error, and never exit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from drivelint import demo, option_values, run
from drivelint.api.arguments import with_argument_checks, with_arguments_of
from drivelint.api.audit_result import AuditResult
from drivelint.api.check_result import CheckResult
from drivelint.api.compared import Comparison, diff
from drivelint.api.explained import Explained
from drivelint.api.keywords import rewrite_options_in_errors
from drivelint.api.progress import note_keeper
from drivelint.api.tables import Table
from drivelint.api.trace_tables import TraceTables
from drivelint.drive.trace import DriveInput
from drivelint.engine.map_library import MapLibrary
from drivelint.errors import UsageError
from drivelint.formats import registry
from drivelint.gate import GateInputs
from drivelint.options.arguments import CheckArguments, ReadTraceArguments
from drivelint.options.declaration import engine_values, options_of_engine
from drivelint.options.types import to_path
from drivelint.report import outputs
from drivelint.result import request
from drivelint.result.evidence import lane_shapes_of_map
from drivelint.result.load import load_result
from drivelint.result.names import RUN_FILE

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.api.progress import NoteKeeper
    from drivelint.options.types import AnyPath
    from drivelint.result.model import Result

__all__ = [
    "AuditResult",
    "CheckResult",
    "Comparison",
    "Explained",
    "Table",
    "TraceTables",
    "check",
    "diff",
    "open",
    "read_trace",
    "write_demo",
]


@with_arguments_of(CheckArguments)
def check(arguments: CheckArguments) -> CheckResult:
    """Judge recorded drives against the rules.

    The keywords are the options of `drivelint check`, see `drivelint check --help`. A repeatable option takes one value or several;
    `env` and `param` also take a dictionary, and pairs of numbers may be a tuple. `drivelint.toml` is not read. `progress`: show a
    progress bar. Errors: `DriveLintError` for invalid arguments, or if no drive could be judged. In the second case, `out` has a result
    with the reasons.
    """
    with rewrite_options_in_errors():
        values, folder = engine_values(arguments), to_path(arguments.out)
        if not values["traces"]:
            raise UsageError("no traces: name files, globs or folders")
        if arguments.rules is not None and not values["rules"]:
            raise UsageError("rules names none: leave it out for the rules that are checked by default")
        if arguments.keep_db and folder is None:
            raise UsageError("--keep-db writes a file: name its folder with --out DIR")
        robustness = option_values.robustness_option_with_confidence(arguments.confidence, arguments.robustness)
        gate_inputs = GateInputs.from_files(
            values["baseline"],
            values["waivers"],
            None,
            option_values.parse_today(arguments.today),
            folder,
            confidence=values["confidence"],
        )
        pack = option_values.pack_request(
            values["evidence_pack"], values["sign"], folder, overwrite=arguments.overwrite
        )
        settings = options_of_engine(
            run.CheckOptions,
            values,
            annotate=arguments.annotate and folder is not None,
            evidence=True,
            robustness=robustness,
        )
        scratch = TemporaryDirectory(prefix="drivelint-") if arguments.margins and folder is None else None
        with (
            outputs.working_folder(folder, overwrite=arguments.overwrite) as work,
            note_keeper(arguments.progress) as listener,
        ):
            place = work if scratch is None else Path(scratch.name)

            def gate_and_write(result: Result) -> Result:
                if gate_inputs is not None:
                    result = gate_inputs.apply_to(result)
                if folder is not None:
                    outputs.write(result, folder, work, overwrite=arguments.overwrite)
                return result

            result = gate_and_write(_run_interruptible_check(replace(settings, out=place), listener, gate_and_write))
        if pack is not None:
            from drivelint.pack import write_pack

            write_pack(pack)
        return CheckResult(result, folder, tuple(listener.notes), scratch)


def _run_interruptible_check(
    settings: run.CheckOptions, listener: NoteKeeper, on_nothing_judged: Callable[[Result], Result]
) -> Result:
    """Run a check and return its result. Errors: also `KeyboardInterrupt`, which DuckDB would hide in a `RuntimeError`."""
    try:
        return run.check(settings, listener, on_nothing_judged=on_nothing_judged)
    except RuntimeError as error:
        if isinstance(error.__cause__, KeyboardInterrupt):
            raise error.__cause__ from None
        raise


@with_argument_checks
def open(folder: AnyPath) -> CheckResult:  # noqa: A001 - read as drivelint.open
    """Return the result in a folder that `check --out` wrote.

    Errors: `DriveLintError` for a folder without a complete result, or a result of another version.
    """
    place = Path(folder)
    run_options = request.load(place) if (place / RUN_FILE).is_file() else None
    result = load_result(place)
    return CheckResult(replace(result, run_options=run_options), place, result.notes)


@with_argument_checks
def write_demo(folder: AnyPath) -> list[Path]:
    """Write six recorded drives and their road, `road.xodr`, into a folder, and return the paths of the files.

    Errors: `DriveLintError` if the folder cannot be written, or has a file of the same name that is not from an earlier demo.
    """
    with rewrite_options_in_errors():
        return demo.write(Path(folder))


@with_arguments_of(ReadTraceArguments)
def read_trace(arguments: ReadTraceArguments) -> TraceTables:
    """Read one recorded drive into tables, checked and in SI units, as `check` reads it, and return them; the ego may be missing.

    With a map, given or embedded in the log, the table `lanes` has its lanes, and the drive is in the map's coordinates.
    Errors: `DriveLintError` for a log that is missing, unreadable or has nothing to judge, an invalid mapping, or a map that cannot be
    read or does not cover the drive.
    """
    with rewrite_options_in_errors():
        drive = DriveInput(**engine_values(arguments))
        trace = registry.read_trace(Path(arguments.path), drive.ingest_options(need_ego=False))
        environment, trace = MapLibrary(drive).find(trace)
        return TraceTables(trace, None if environment is None else lane_shapes_of_map(environment))
