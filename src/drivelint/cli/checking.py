"""`drivelint check`: judges recorded drives, or shows the result of an earlier run with the same inputs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path  # noqa: TC003 - Typer reads the types
from typing import TYPE_CHECKING, Annotated

import typer

from drivelint import option_values
from drivelint.cli import completion, options, packs, streams
from drivelint.cli.console import progress as bar
from drivelint.cli.console import (
    rich_text,
    run_interruptible,
    say_earlier_folder_on_failure,
    say_kept_drives,
    say_nothing_kept,
)
from drivelint.cli.options import Texts, argument, option
from drivelint.cli.restart import Restart
from drivelint.errors import UsageError
from drivelint.phrases import terminal_safe_json, terminal_safe_line
from drivelint.settings import find_settings

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.engine.interruption import Interruption
    from drivelint.report.progress import Progress
    from drivelint.result.model import Result
    from drivelint.run import CheckOptions


@options.add_drive_options
def check(
    *,
    traces: Annotated[
        list[str], argument("TRACE", "Recorded drives: files, globs, folders, or a manifest of them, as in audit.")
    ],
    drive: options.DriveInputValues,
    out: Annotated[
        Path | None, option("--out", "DIR", "Folder for the result files. An earlier result in it is replaced.")
    ] = None,
    overwrite: options.Overwrite = False,
    rules: Annotated[
        Texts,
        options.rules_option(
            "Rules to judge by, see above. Repeatable. Default: stable rules of ukhc, in Germany (--env, --map) of stvo too."
        ),
    ] = None,
    ignore: options.Ignore = None,
    profile: Annotated[
        Texts,
        options.profile_option(
            "relaxed, nominal, aggressive, observed, or your own. Repeatable. Default: nominal and observed."
        ),
    ] = None,
    param: options.Param = None,
    rules_dir: options.RulesDirs = None,
    fail_on: options.FailOnOption = "critical",
    strict: options.Strict = False,
    require: Annotated[
        Texts,
        option(
            "--require",
            "SEL",
            "Exit code 4 if one of these rules is unknown. Repeatable.",
            autocompletion=completion.rule_ids,
        ),
    ] = None,
    min_judged: options.MinJudged = None,
    format_: options.FormatOption = "text",
    report: Annotated[
        list[options.ReportFormat] | None,
        option(
            "--report",
            "html|junit|sarif|xqar|markdown",
            "With --out: also write this report, as drivelint report does. report.html and junit.xml are always written. Repeatable.",
        ),
    ] = None,
    margins: Annotated[
        bool, option("--margins", None, "Also write margins.parquet, with a row per judged step.")
    ] = False,
    keep_db: Annotated[
        bool, option("--keep-db", None, "Also keep the database with the tables of every stage.")
    ] = False,
    annotate: Annotated[
        bool,
        option(
            "--annotate/--no-annotate",
            None,
            "With --out: write a copy of each log that includes its verdicts, for a viewer.",
        ),
    ] = True,
    pictures: Annotated[
        bool,
        option("--pictures/--no-pictures", None, "With --out: show frames of the log's own cameras beside findings."),
    ] = True,
    robustness: Annotated[
        bool | None,
        options.robustness_option(
            "Count in how many copies of the drive with recording errors a critical or major finding stays. "
            "Default: only for the gravest finding of each rule, and for findings that small errors may remove."
        ),
    ] = None,
    confidence: Annotated[
        float | None,
        option(
            "--confidence",
            "SHARE",
            "Only findings that stay in at least this share of their copies can fail the run, such as 0.95. Default: all findings can.",
            min=0.0,
            max=1.0,
        ),
    ] = None,
    baseline: options.Baseline = None,
    waivers: options.Waivers = None,
    today: options.Today = None,
    memory: options.MemorySize = None,
    rule_timeout: Annotated[
        float,
        option(
            "--rule-timeout",
            "S",
            "Seconds that a rule may compute on a batch of drives. A rule that takes longer is an error; the others continue.",
            min=0.1,
        ),
    ] = 30.0,
    evidence: options.Evidence = None,
    sign: options.Sign = None,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Print every table, not only the summary.")] = False,
    jobs: Annotated[
        int,
        typer.Option(
            "--jobs",
            "-j",
            metavar="N",
            min=1,
            help="Number of processes. Each judges a part of the logs; the result is the same.",
        ),
    ] = 1,
    cache: Annotated[
        bool,
        option(
            "--cache/--no-cache",
            None,
            "If logs, map, rules and options are those of an earlier run, write and print the same as it did, without judging. "
            "--no-cache always judges, and keeps no receipt.",
            envvar="DRIVELINT_CHECK_CACHE",
        ),
    ] = True,
    quiet: options.Quiet = False,
) -> None:
    """Judge recorded drives against the rules.

    With --out: writes tables of verdicts and findings, report.html, and copies of the logs that include their verdicts.

    SEL is a rule's id, a glob, a pack, all, or a property of a rule: kind:invariant, severity:critical,
    status:draft, legal:must, clause:R162, requires:indicator. A comma means "and" (ukhc,legal:must); --rules twice means "or".

    Exit codes: 0 nothing failed at or above --fail-on; 1 something failed (with --baseline, --waivers or --confidence:
    something new, not waived, and sure); 2 usage or rule error; 3 judged on lossy input; 4 some drives not judged, or nothing
    could be decided (with --strict or --require: some rule unknown; with --min-judged: too few rules decided); 75 the machine
    failed, try again; 130 interrupted: results so far are kept.
    """
    arguments = dict(locals())

    from drivelint.cli.receipts import StoredRunOfCheck

    settings_file = _find_and_print_settings_file(quiet=quiet)
    robustness = option_values.robustness_option_with_confidence(confidence, robustness)
    day = option_values.parse_today(today)
    receipts = StoredRunOfCheck(arguments, day, settings_file)
    with say_earlier_folder_on_failure(out):
        earlier = receipts.repeat_earlier_run()
    if earlier is not None:
        typer.echo(earlier.stdout, nl=False)
        raise typer.Exit(earlier.exit_code)

    from drivelint import run
    from drivelint.engine.interruption import Interruption, NothingJudgedError
    from drivelint.engine.memory import format_bytes, peak_bytes
    from drivelint.gate import GateInputs, refuse_to_overwrite_baseline
    from drivelint.report.outputs import working_folder, write
    from drivelint.result.model import exit_status

    pack = option_values.pack_request(evidence, sign, out, overwrite=overwrite)
    refuse_to_overwrite_baseline(baseline, out)
    settings = run.CheckOptions(
        traces=tuple(traces),
        **drive,
        rules=tuple(rules or ()),
        ignore=tuple(ignore or ()),
        profiles=tuple(profile or ()),
        params=tuple(param or ()),
        rules_dirs=tuple(rules_dir or ()),
        fail_on=fail_on,
        strict=strict,
        require=tuple(require or ()),
        min_judged=min_judged,
        margins=margins,
        keep_db=keep_db,
        annotate=annotate,
        pictures=pictures,
        robustness=robustness,
        memory=option_values.parse_memory(memory),
        rule_timeout=rule_timeout,
    )
    interruption = Interruption()
    with (
        say_earlier_folder_on_failure(out),
        working_folder(out, report or (), overwrite=overwrite) as work,
        bar(quiet) as progress,
    ):
        unstoppable_rule_handler = Restart.if_possible(progress, work)
        grown: tuple[str, ...] = ()

        def gate_and_write(result: Result) -> Result:
            nonlocal grown
            if gate_inputs is not None:
                result = gate_inputs.apply_to(result)
            if out is not None:
                grown = write(result, out, work, reports=report or (), overwrite=overwrite)
            return result

        try:
            with receipts.record_inputs():
                settings = _with_manifests_replaced_by_logs(
                    replace(settings, out=work), are_results_packed=pack is not None
                )
                gate_inputs = GateInputs.from_files(baseline, waivers, settings_file, day, out, confidence=confidence)
                judged = run_interruptible(
                    lambda: _judge(
                        settings,
                        jobs,
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
        result = gate_and_write(judged)
        stdout, code = _stdout_text(result, format_, out, verbose=verbose), int(exit_status(result).code)
        receipts.store_receipt(
            result, stdout, code, files_written_while_judging=grown, gate=gate_inputs, interruption=interruption
        )
        if memory is not None and jobs == 1 and (most := peak_bytes()) is not None:  # the peak of this process only
            progress.note(
                f"the process took at most {format_bytes(most)} of memory, including memory outside the database"
            )
    typer.echo(stdout, nl=False)
    if result.interrupted:
        say_kept_drives(result.drives["status"].to_pylist(), out)
    elif pack is not None:
        packs.write_and_print_summary(pack, on_stderr=True)
    raise typer.Exit(code)


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


def _stdout_text(result: Result, format_: options.Format, out: Path | None, *, verbose: bool) -> str:
    """Return the text of a result for stdout."""
    from drivelint.report import summary, terminal
    from drivelint.result.one_line import result_on_one_line

    if format_ == "json":
        return terminal_safe_json(summary.render(result).decode())
    told = result_on_one_line(result)
    return rich_text(lambda width: terminal.render(told, None if out is None else str(out), width, verbose=verbose))
