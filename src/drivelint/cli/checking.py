"""`drivelint check`: judges recorded drives, or shows the result of an earlier run with the same inputs."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import typer

from drivelint import option_values
from drivelint.cli import options, packs, streams
from drivelint.cli.console import progress as bar
from drivelint.cli.console import (
    rich_text,
    run_interruptible,
    say_earlier_folder_on_failure,
    say_kept_drives,
    say_nothing_kept,
)
from drivelint.cli.restart import Restart
from drivelint.errors import UsageError
from drivelint.options.arguments import CheckCommandArguments, DriveArguments
from drivelint.options.declaration import engine_values, options_of_engine
from drivelint.options.types import Format, to_path
from drivelint.phrases import plural, terminal_safe_json, terminal_safe_line
from drivelint.settings import find_settings

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from drivelint.engine.interruption import Interruption
    from drivelint.report.progress import Progress
    from drivelint.result.model import Result
    from drivelint.run import CheckOptions


@options.DeclaredCommand
def check(arguments: CheckCommandArguments) -> None:
    """Judge recorded drives against the rules.

    With --out: writes tables of verdicts and findings, report.html, and copies of the logs that include their verdicts.

    SEL is a rule's id, a glob, a pack, all, or a property of a rule: kind:invariant, severity:critical,
    status:draft, legal:must, clause:R162, requires:indicator. A comma means "and" (ukhc,legal:must); --rules twice means "or".

    Exit codes: 0 nothing failed at or above --fail-on; 1 something failed (with --baseline, --waivers or --confidence:
    something new, not waived, and sure); 2 usage or rule error; 3 judged on lossy input; 4 some drives not judged, or nothing
    could be decided (with --strict or --require: some rule unknown; with --min-judged: too few rules decided); 75 the machine
    failed, try again; 130 interrupted: results so far are kept.
    """
    from drivelint.cli.receipts import StoredRunOfCheck

    engine_values(arguments, DriveArguments)  # an invalid value is an error before anything is printed
    out, overwrite, baseline = to_path(arguments.out), arguments.overwrite, to_path(arguments.baseline)
    settings_file = _find_and_print_settings_file(quiet=arguments.quiet)
    robustness = option_values.robustness_option_with_confidence(arguments.confidence, arguments.robustness)
    day = option_values.parse_today(arguments.today)
    receipts = StoredRunOfCheck(vars(arguments), day, settings_file)
    with say_earlier_folder_on_failure(out):
        earlier = receipts.repeat_earlier_run()
    if earlier is not None:
        typer.echo(earlier.stdout, nl=False)
        raise typer.Exit(earlier.exit_code)

    from drivelint import run
    from drivelint.engine.interruption import Interruption, NothingJudgedError
    from drivelint.gate import GateInputs, refuse_to_overwrite_baseline
    from drivelint.report.outputs import working_folder, write
    from drivelint.result.model import exit_status

    pack = option_values.pack_request(to_path(arguments.evidence), to_path(arguments.sign), out, overwrite=overwrite)
    refuse_to_overwrite_baseline(baseline, out)
    settings, interruption = (
        options_of_engine(run.CheckOptions, engine_values(arguments), robustness=robustness),
        Interruption(),
    )
    with (
        say_earlier_folder_on_failure(out),
        working_folder(out, arguments.report or (), overwrite=overwrite) as work,
        bar(arguments.quiet) as progress,
    ):
        unstoppable_rule_handler = Restart.if_possible(progress, work)
        grown: tuple[str, ...] = ()

        def gate_and_write(result: Result) -> Result:
            nonlocal grown
            if gate_inputs is not None:
                result = gate_inputs.apply_to(result)
            if out is not None:
                grown = write(result, out, work, reports=arguments.report or (), overwrite=overwrite)
            return result

        try:
            with receipts.record_inputs():
                settings = _with_manifests_replaced_by_logs(
                    replace(settings, out=work), are_results_packed=pack is not None
                )
                gate_inputs = GateInputs.from_files(
                    baseline, to_path(arguments.waivers), settings_file, day, out, confidence=arguments.confidence
                )
                checked_logs = run_interruptible(
                    lambda: _judge(
                        settings,
                        arguments.jobs,
                        progress,
                        interruption=interruption,
                        unstoppable_rule_handler=unstoppable_rule_handler,
                        keep=gate_and_write,
                    ),
                    interruption.request,
                )
        except KeyboardInterrupt as stop:
            say_nothing_kept(out, judged_none=isinstance(stop, NothingJudgedError))
            raise
        result = gate_and_write(checked_logs)
        stdout, code = (
            _stdout_text(result, arguments.format_, out, verbose=arguments.verbose),
            int(exit_status(result).code),
        )
        receipts.store_receipt(
            result, stdout, code, files_written_while_judging=grown, gate=gate_inputs, interruption=interruption
        )
        if arguments.memory is not None and arguments.jobs == 1:
            _note_peak_memory(progress)
    typer.echo(stdout, nl=False)
    _name_map_beside_logs(settings.traces if not arguments.quiet else (), result)
    if result.interrupted:
        say_kept_drives(result.drives["status"].to_pylist(), out)
    elif pack is not None:
        packs.write_and_print_summary(pack, on_stderr=True)
    raise typer.Exit(code)


def _note_peak_memory(progress: Progress) -> None:
    """Note how much memory this process took, not counting processes that it started."""
    from drivelint.engine.memory import format_bytes, peak_bytes

    if (peak := peak_bytes()) is not None:
        progress.note(f"the process took at most {format_bytes(peak)} of memory, including memory outside the database")


def _name_map_beside_logs(traces: Sequence[str], result: Result) -> None:
    """Print the map that lies in the folders of logs if all of them were judged without a map."""
    from drivelint.formats.files import maps_beside_traces

    if result.drives["map_name"].drop_null():
        return
    if maps := [terminal_safe_line(str(path)) for path in maps_beside_traces(traces)]:
        more = f" ({plural(len(maps) - 1, 'other map')} there)" if len(maps) > 1 else ""
        streams.print_on_stderr(f"drivelint: a map lies beside the logs: judge them on it with --map {maps[0]}{more}")


def _find_and_print_settings_file(*, quiet: bool) -> Path | None:
    """Return the settings file that applies, and print its name unless the run is quiet."""
    file = find_settings()
    if file is not None and not quiet:
        streams.print_on_stderr(f"drivelint: settings: {terminal_safe_line(str(file))}")
    return file


def _with_manifests_replaced_by_logs(settings: CheckOptions, *, are_results_packed: bool) -> CheckOptions:
    """Return the settings with manifests replaced by the logs that they name. Errors: `UsageError`."""
    if not any(trace.lower().endswith((".csv", ".parquet")) for trace in settings.traces):
        return settings
    from drivelint.audit.sources import expand_manifests

    logs, manifest_options = expand_manifests(
        settings.traces, settings, lambda text: streams.print_on_stderr(f"drivelint: {terminal_safe_line(text)}")
    )
    if manifest_options and are_results_packed:
        raise UsageError(
            "--evidence: a pack needs the same options for all logs, but this manifest has options per log: "
            "audit the manifest, and pack the audit"
        )
    return replace(settings, traces=logs, manifest_options=manifest_options)


def _judge(
    settings: CheckOptions,
    jobs: int,
    progress: Progress,
    *,
    interruption: Interruption,
    unstoppable_rule_handler: Restart | None,
    keep: Callable[[Result], Result],
) -> Result:
    """Judge the logs in this process, or in several processes."""
    if jobs > 1:
        from drivelint import parallel

        return parallel.check(
            settings,
            jobs,
            progress,
            interruption=interruption,
            unstoppable_rule_handler=unstoppable_rule_handler,
            on_nothing_judged=keep,
        )
    from drivelint import run

    return run.check(settings, progress, interruption, unstoppable_rule_handler, keep)


def _stdout_text(result: Result, format_: Format, out: Path | None, *, verbose: bool) -> str:
    """Return the text of a result for stdout."""
    from drivelint.report import summary, terminal
    from drivelint.result.one_line import result_on_one_line

    if format_ == "json":
        return terminal_safe_json(summary.render(result).decode())
    shown_result = result_on_one_line(result)
    return rich_text(
        lambda width: terminal.render(shown_result, None if out is None else str(out), width, verbose=verbose)
    )
