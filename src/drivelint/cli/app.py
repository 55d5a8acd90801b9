"""The command line: parse, call, print, exit. stdout is data, stderr is progress and diagnostics.

Everything heavy is imported inside the commands, so that `--help` stays fast.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from drivelint import __version__, temporary
from drivelint.cli import audits, completion, fleets, options, packs, results, rules, streams, values, watching
from drivelint.cli import docs as docs_
from drivelint.cli.console import print_rich, run_interruptible, say_kept, say_nothing_kept, tells_of_earlier
from drivelint.cli.console import progress as bar
from drivelint.cli.grouped_help import GroupedCommand
from drivelint.cli.options import Texts, argument, option
from drivelint.cli.restart import Restart
from drivelint.errors import DriveLintError, ExitCode, UsageError
from drivelint.phrases import inert, inert_json, inert_line
from drivelint.without_pandas import leave_out_pandas

app = typer.Typer(
    name="drivelint",
    help="Checks recorded drives against the rules of the road.",
    epilog="To begin: `drivelint demo` writes drives to try it on and prints the command that checks them; "
    "`drivelint inspect TRACE` shows what a log of yours can decide; `drivelint docs` lists the guides.",
    rich_markup_mode=None,  # two columns of text: frames and types leave a help of 80 columns no room for words
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(rules.app, name="rules")


def _version(value: bool) -> None:
    if value:
        typer.echo(f"drivelint {__version__}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _root(
    ctx: typer.Context,
    *,
    version: Annotated[  # noqa: ARG001 - its callback acts
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Checks recorded drives against the rules of the road."""
    if ctx.invoked_subcommand is None:
        with redirect_stdout(sys.stderr):
            typer.echo(ctx.get_help())
        raise typer.Exit(int(ExitCode.USAGE))


@app.command(cls=GroupedCommand)
@options.takes_drive_input
def check(
    *,
    traces: Annotated[list[str], argument("TRACE", "Recorded drives: files, globs or folders.")],
    drive: options.DriveInputValues,
    out: Annotated[
        Path | None, option("--out", "DIR", "Folder for the result files. An earlier result in it is replaced.")
    ] = None,
    overwrite: options.Overwrite = False,
    rules: Annotated[
        Texts, options.rules("Rules to judge by, see above. Repeatable. Default: stable rules of ukhc.")
    ] = None,
    ignore: options.Ignore = None,
    profile: Annotated[
        Texts,
        options.profile(
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
            "These of the rules may not be unknown: exit code 4. Repeatable.",
            autocompletion=completion.rule_ids,
        ),
    ] = None,
    format_: options.FormatOption = "text",
    margins: Annotated[bool, option("--margins", None, "Also write margins.parquet: every judged step.")] = False,
    keep_db: Annotated[bool, option("--keep-db", None, "Also keep the database with every stage's tables.")] = False,
    annotate: Annotated[
        bool,
        option("--annotate/--no-annotate", None, "With --out: copy each log with its verdicts in it, for a viewer."),
    ] = True,
    robustness: Annotated[
        bool | None,
        options.robustness(
            "Count in how many copies of the drive with recording errors a critical or major finding stays. "
            "Default: for the gravest finding of each rule, and for those that small errors may take away."
        ),
    ] = None,
    confidence: Annotated[
        float | None,
        option(
            "--confidence",
            "SHARE",
            "Only findings that stay in this share of their copies gate, such as 0.95. Default: all gate.",
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
            "Seconds that a rule may take on a batch of drives: beyond them that rule is an error, the others go on.",
            min=0.1,
        ),
    ] = 30.0,
    evidence: options.Evidence = None,
    sign: options.Sign = None,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Print every table, not only the summary of one screen.")
    ] = False,
    quiet: options.Quiet = False,
) -> None:
    """Judge recorded drives against the rules.

    With --out: tables of verdicts and findings, report.html, and the logs with their verdicts in them.

    SEL is a rule's id, a glob, a pack, all, or what a rule says of itself: kind:invariant, severity:critical,
    status:draft, legal:must, clause:R162, requires:indicator. A comma means both (ukhc,legal:must), --rules twice either.

    Exit codes: 0 nothing failed at or above --fail-on; 1 something did (with --baseline, --waivers or --confidence: something
    that is new, that nobody answers for, that is sure); 2 usage or rule error; 3 judged on lossy input; 4 some drives not
    judged (with --strict or --require: some rule unknown); 75 the machine failed, try again; 130 interrupted: what was judged
    until then is kept.
    """
    from drivelint import run
    from drivelint.engine.interruption import Interruption, NothingJudgedError
    from drivelint.engine.memory import format_bytes, peak_bytes
    from drivelint.gate import GateInputs, refuse_own_baseline
    from drivelint.report import summary, terminal
    from drivelint.report.outputs import working_folder, write
    from drivelint.result.model import Result, exit_status
    from drivelint.result.one_line import on_one_line
    from drivelint.settings import SETTINGS_FILE

    robustness = values.robustness_for(confidence, robustness)
    pack = packs.asked_pack(evidence, sign, out, overwrite=overwrite)
    day = values.parse_today(today)
    refuse_own_baseline(baseline, out)
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
        margins=margins,
        keep_db=keep_db,
        annotate=annotate,
        robustness=robustness,
        memory=values.parse_memory(memory),
        rule_timeout=rule_timeout,
    )
    interruption = Interruption()
    with tells_of_earlier(out), working_folder(out, overwrite=overwrite) as work, bar(quiet) as progress:
        settings = replace(settings, out=work)
        gate_inputs = GateInputs.from_files(baseline, waivers, Path(SETTINGS_FILE), day, out, confidence=confidence)
        deaf = Restart.if_possible(progress, work)

        def kept(result: Result) -> Result:
            if gate_inputs is not None:
                result = gate_inputs.apply_to(result)
            if out is not None:
                write(result, out, work, overwrite=overwrite)
            return result

        try:
            result = kept(
                run_interruptible(lambda: run.check(settings, progress, interruption, deaf, kept), interruption.request)
            )
        except KeyboardInterrupt as stop:
            say_nothing_kept(out, judged_none=isinstance(stop, NothingJudgedError))
            raise
        if memory is not None and (most := peak_bytes()) is not None:
            progress.note(
                f"{format_bytes(most)} of memory were taken at most, with everything that is not the database's"
            )
    if format_ == "json":
        typer.echo(inert_json(summary.render(result).decode()), nl=False)
    else:
        told = on_one_line(result)
        print_rich(lambda width: terminal.render(told, None if out is None else str(out), width, verbose=verbose))
    if result.interrupted:
        say_kept(result.drives["status"].to_pylist(), out)
    elif pack is not None:
        packs.write_and_tell(pack, err=True)
    raise typer.Exit(int(exit_status(result).code))


@app.command()
def demo(
    folder: Annotated[Path | None, argument("[DIR]", "Folder for the logs and their road. Default: demo.")] = None,
    *,
    out: Annotated[Path | None, option("--out", "DIR", "The same folder.")] = None,
) -> None:
    """Write drives to try drivelint on.

    Three overtakes at two speeds, as ASAM OSI in MCAP, and their road. Prints the command that checks them.
    """
    from drivelint import demo

    written = demo.write(place := values.one_folder(folder, out, Path("demo")))
    typer.echo(f"{place}: {len(written) - 1} drives and their road are there. Check them with:", err=True)
    typer.echo(demo.check_command(place, sys.argv[0]))


@app.command()
@options.takes_drive_input
def inspect(
    *,
    trace: Annotated[str, argument("TRACE", "One recorded drive.")],
    drive: options.DriveInputValues,
    rules: Annotated[
        Texts, option("--rules", "SEL", "Rules to ask about, as in check. Repeatable. Default: ukhc.")
    ] = None,
    rules_dir: options.RulesDirs = None,
    memory: options.MemorySize = None,
    format_: options.FormatOption = "text",
) -> None:
    """Show what is in a log and what it can decide.

    Also how it lies on the map, what is wrong with it, and what to provide so that more rules can be decided.
    """
    from drivelint import inspect as inspection

    request = inspection.InspectRequest(
        trace=trace,
        **drive,
        rules=tuple(rules or ()),
        rules_dirs=tuple(rules_dir or ()),
        memory=values.parse_memory(memory),
    )
    found = run_interruptible(lambda: inspection.inspect(request))
    if format_ == "json":
        typer.echo(inert_json(inspection.to_json(found)))
    else:
        from drivelint.inspect.text import render

        print_rich(render(found, trace))
    raise typer.Exit(int(inspection.exit_code(found)))


@app.command()
@options.takes_drive_input
def convert(
    *,
    trace: Annotated[str, argument("TRACE", "One recorded drive.")],
    to: Annotated[
        options.ConvertTarget, option("--to", None, "mcap: one file of ASAM OSI; parquet: a folder of tables.")
    ],
    out: Annotated[Path, option("--out", "DIR", "Folder for the converted log.")],
    clip: Annotated[
        str | None,
        option("--clip", "FINDING", "Only 15 s before to 7 s after this finding, or more if it needs more. With --in."),
    ] = None,
    folder: Annotated[Path | None, option("--in", "DIR", "With --clip: what check --out wrote.")] = None,
    drive: options.DriveInputValues,
) -> None:
    """Write a log anew, as OSI in MCAP or as Parquet.

    In metres, seconds and box centres, with its map, so that it needs no mapping any more and gives the same verdicts.
    A clip is judged alone, and is as long as it must be to give the same finding.
    """
    from drivelint import convert as converter
    from drivelint.engine.memory import DEFAULT_MEMORY

    request = converter.ConvertRequest(trace=trace, to=to, out=out, **drive)
    if (clip is None) is not (folder is None):
        raise UsageError("--clip and --in belong together: the finding, and the folder that check --out wrote")
    if clip is not None and folder is not None:
        from drivelint.incident.clip import write_clip

        name, result = clip, folder
        written = run_interruptible(lambda: write_clip(request, name, result, DEFAULT_MEMORY))
    else:
        written = run_interruptible(lambda: converter.convert(request))
    for note in written.notes:
        typer.echo(f"drivelint: {inert_line(note)}", err=True)
    typer.echo(inert(converter.summary_text(written)))


app.command(cls=GroupedCommand)(watching.watch)
app.command()(results.report)
app.command()(results.explain)
app.command("diff")(results.diff)
app.command()(packs.pack)
app.command()(packs.verify)
app.command()(audits.audit)
app.command()(audits.merge)
app.command()(audits.sql)
app.command("what-if")(fleets.what_if)
app.command("docs")(docs_.docs)


def main() -> NoReturn:
    """Run the command line; every mistake of a user ends in one line on stderr and its exit code."""
    from typer.exceptions import TyperException

    streams.prepare()
    leave_out_pandas()
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C: what is judged is kept
    try:
        code = app(standalone_mode=False, default_map=_settings())
        sys.stdout.flush()
    except DriveLintError as error:
        _fail(str(error), error.exit_code)
    except TyperException as error:
        also = " and drivelint.toml in this folder" if Path("drivelint.toml").is_file() else ""
        words = error.format_message().replace("Value error, ", "")  # the library's, not ours
        _fail(f"{words} (see drivelint {_asked(error)}--help{also})", ExitCode.USAGE)
    except (KeyboardInterrupt, typer.Abort):
        code = ExitCode.INTERRUPTED
    except streams.ReaderLeftError:
        code = streams.READER_LEFT
    except Exception as error:  # noqa: BLE001 - Python's own exit code for it is that of a broken rule
        import traceback

        streams.say(inert(traceback.format_exc().rstrip()))
        _fail(f"internal error: {type(error).__name__}: {error}: please report it", ExitCode.NOT_JUDGED)
    if code == ExitCode.INTERRUPTED:
        streams.say("drivelint: error: interrupted")
        temporary.remove_all()
        os._exit(code)  # the database may still be computing in its thread: there is nothing to wait for
    sys.exit(code or 0)


def _asked(error: Exception) -> str:
    """Return the words of the command that a mistake was made in, each with a space behind it; '' for none."""
    about, words = getattr(error, "ctx", None), ""
    while about is not None and about.parent is not None:
        about, words = about.parent, f"{about.info_name} {words}"
    return words


def _settings() -> dict[str, Any]:
    """Return what `drivelint.toml` in the current folder says about the options of `check`, or of others that read a log.

    Those take what is about the log and its map, not where `check` writes to and how it prints.
    """
    from drivelint.settings import SETTINGS_FILE, read_settings

    name = "".join(sys.argv[1:2])
    if name not in {"check", "inspect", "convert"} or not Path(SETTINGS_FILE).is_file():
        return {}
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    params = commands["check"].params
    known = {p.opts[0].lstrip("-"): (p.name, p.multiple) for p in params if p.param_type_name == "option"}
    for name_ in ("help", "today"):  # a day that stands in a file would keep waivers from expiring
        known.pop(name_, None)
    taken = {p.name for p in commands[name].params}
    if name != "check":
        taken -= {"out", "format_"}
    return {name: {param: value for param, value in read_settings(known).items() if param in taken}}


def _fail(message: str, code: ExitCode) -> NoReturn:
    streams.say(f"drivelint: error: {inert_line(message)}")
    sys.exit(int(code))
