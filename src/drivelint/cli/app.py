"""The command line: it parses arguments, calls the pipeline, prints the result and exits. stdout has data, stderr progress and diagnostics.

Slow imports are inside the commands, so that `--help` stays fast.
"""

from __future__ import annotations

import gc
import os
import sys
from contextlib import redirect_stdout
from copy import copy
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, NoReturn

import typer
from typer.main import get_command_name

from drivelint import __version__, option_values, temporary
from drivelint.cli import audits, checking, ending_signals, fleets, options, packs, results, rules, streams, watching
from drivelint.cli import docs as docs_
from drivelint.cli.console import print_rich, run_interruptible
from drivelint.cli.grouped_help import GroupedCommand
from drivelint.cli.options import Texts, argument, option
from drivelint.errors import (
    LEAST_ADDRESS_SPACE_BYTES,
    DriveLintError,
    ExitCode,
    ProblemLinesError,
    UsageError,
    describe_machine_error,
    memory_limit_of_process_bytes,
)
from drivelint.options.arguments import DriveArguments  # noqa: TC001 - read at runtime
from drivelint.options.declaration import engine_values
from drivelint.options.settings_file import settings_of_check
from drivelint.phrases import terminal_safe, terminal_safe_json, terminal_safe_line
from drivelint.settings import find_settings
from drivelint.without_pandas import block_pandas_import

if TYPE_CHECKING:
    from typer.models import CommandInfo

app = typer.Typer(
    name="drivelint",
    help="Checks recorded drives against the rules of the road.",
    epilog="To begin: `drivelint demo` writes drives to try it on and prints the command that checks them; "
    "`drivelint inspect TRACE` shows what a log of yours can decide; `drivelint docs` lists the guides.",
    rich_markup_mode=None,  # plain text in two columns: in 80 columns, frames and types would leave too little width for the help
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(rules.app, name="rules")


def _print_version(is_requested: bool) -> None:
    if is_requested:
        typer.echo(f"drivelint {__version__}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _root(
    ctx: typer.Context,
    *,
    version: Annotated[  # noqa: ARG001 - the callback handles it
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Checks recorded drives against the rules of the road."""
    if ctx.invoked_subcommand is None:
        with redirect_stdout(sys.stderr):
            typer.echo(ctx.get_help())
        raise typer.Exit(int(ExitCode.USAGE))


app.command(cls=GroupedCommand)(checking.check)


@app.command()
def demo(
    folder: Annotated[Path | None, argument("[DIR]", "Folder for the logs and their road. Default: demo.")] = None,
    *,
    out: Annotated[Path | None, option("--out", "DIR", "The same folder.")] = None,
) -> None:
    """Write example drives.

    Three overtakes at two speeds, as ASAM OSI in MCAP, and their road. Prints the command that checks them.
    """
    from drivelint import demo

    files = demo.write(place := option_values.folder_of_argument_or_option(folder, out, Path("demo")))
    typer.echo(f"{place}: {len(files) - 1} drives and their road are there. Check them with:", err=True)
    typer.echo(demo.check_command(place, sys.argv[0]))


@app.command()
@options.DeclaredCommand
def inspect(
    *,
    trace: Annotated[str, argument("TRACE", "One recorded drive.")],
    drive: DriveArguments,
    rules: Annotated[Texts, option("--rules", "SEL", "Rules to list, as in check. Repeatable. Default: ukhc.")] = None,
    rules_dirs: options.RulesDirs = None,
    memory: options.MemorySize = None,
    format_: options.FormatOption = "text",
) -> None:
    """Show the content of a log, and the rules that it can decide.

    Also shows whether the log fits the map, the problems of the log, and what to provide so that more rules can be decided.
    """
    from drivelint import inspect as inspection

    request = inspection.InspectRequest(
        trace=trace,
        **engine_values(drive),
        rules=tuple(rules or ()),
        rules_dirs=tuple(rules_dirs or ()),
        memory=option_values.parse_memory(memory),
    )
    outcome = run_interruptible(lambda: inspection.inspect(request))
    if format_ == "json":
        typer.echo(terminal_safe_json(inspection.to_json(outcome)))
    else:
        from drivelint.inspect.text import render

        print_rich(render(outcome, trace))
    raise typer.Exit(int(inspection.exit_code(outcome)))


@app.command()
@options.DeclaredCommand
def convert(
    *,
    trace: Annotated[str, argument("TRACE", "One recorded drive.")],
    to: Annotated[
        options.ConvertTarget, option("--to", None, "mcap: one file of ASAM OSI; parquet: a folder of tables.")
    ],
    out: Annotated[Path, option("--out", "DIR", "Folder for the converted log.")],
    clip: Annotated[
        str | None,
        option(
            "--clip",
            "FINDING",
            "Only from 15 s before to 7 s after this finding, or longer if the same finding needs it. With --in.",
        ),
    ] = None,
    folder: Annotated[Path | None, option("--in", "DIR", "With --clip: the folder that check --out wrote.")] = None,
    drive: DriveArguments,
) -> None:
    """Convert a log to OSI in MCAP, or to Parquet.

    The new log is in metres, seconds and box centres, and includes its map. It needs no mapping and has the same verdicts.
    A clip is long enough that, judged alone, it has the same finding.
    """
    from drivelint import convert as converter
    from drivelint.engine.memory import DEFAULT_MEMORY_BYTES

    request = converter.ConvertRequest(trace=trace, to=to, out=out, **engine_values(drive))
    if (clip is None) is not (folder is None):
        raise UsageError(
            "--clip and --in need each other: --clip gives the finding, --in the folder that check --out wrote"
        )
    if clip is not None and folder is not None:
        from drivelint.incident.clip import write_clip

        name, result = clip, folder
        converted_trace = run_interruptible(lambda: write_clip(request, name, result, DEFAULT_MEMORY_BYTES))
    else:
        converted_trace = run_interruptible(lambda: converter.convert(request))
    for note in converted_trace.notes:
        typer.echo(f"drivelint: {terminal_safe_line(note)}", err=True)
    typer.echo(terminal_safe(converter.summary_text(converted_trace)))


app.command(cls=GroupedCommand)(watching.watch)
app.command()(results.report)
app.command()(results.explain)
app.command("diff")(results.diff)
app.command()(packs.pack)
app.command()(packs.verify)
app.command()(audits.audit)
app.command()(audits.merge)
app.command()(audits.sql)
app.command()(fleets.trend)
app.command("what-if")(fleets.what_if)
app.command("docs")(docs_.docs)


NEW_OBJECTS_BEFORE_GARBAGE_COLLECTION: Final = 50_000
"""New objects before a garbage collection. With the default of Python 3.11 and 3.12 (700), it takes 4 % of the time of short commands."""


def main() -> NoReturn:
    """Run the command line; for every mistake of a user, print one line on stderr and exit with its code."""
    from typer.exceptions import TyperException

    streams.make_stdout_and_stderr_writable()
    if (limit := memory_limit_of_process_bytes()) is not None and limit < LEAST_ADDRESS_SPACE_BYTES:
        _exit_with_error(
            f"a limit of {limit / 1e6:.0f} MB of memory (ulimit -v) is too low: raise it", ExitCode.TEMPFAIL
        )
    block_pandas_import()
    ending_signals.install_handlers()
    gc.set_threshold(NEW_OBJECTS_BEFORE_GARBAGE_COLLECTION)
    try:
        code = _app_with_command("".join(sys.argv[1:2]))(
            standalone_mode=False, default_map=_default_options_of_settings_file()
        )
        sys.stdout.flush()
    except DriveLintError as error:
        _exit_with_error(
            f"{error}{_settings_hint(str(error))}", error.exit_code, has_lines=isinstance(error, ProblemLinesError)
        )
    except TyperException as error:
        settings = find_settings()
        also = "" if settings is None else f" and {settings}{' in this folder' if settings.parent == Path() else ''}"
        words = error.format_message().replace("Value error, ", "")  # a prefix from the library
        _exit_with_error(f"{words} (see drivelint {_command_words_of_error(error)}--help{also})", ExitCode.USAGE)
    except (KeyboardInterrupt, typer.Abort):
        code = ExitCode.INTERRUPTED
    except streams.ReaderLeftError:
        code = streams.READER_LEFT_EXIT_CODE
    except Exception as error:  # noqa: BLE001 - Python's exit code for it would be 1, which means a failed rule
        import traceback

        if not ending_signals.is_any_recorded():
            if (message_and_code := describe_machine_error(error)) is not None:
                _exit_with_error(*message_and_code)
            streams.print_on_stderr(terminal_safe(traceback.format_exc().rstrip()))
            _exit_with_error(f"internal error: {type(error).__name__}: {error}: please report it", ExitCode.NOT_JUDGED)
        code = ExitCode.INTERRUPTED  # for example an import that the signal ended
    if code == ExitCode.INTERRUPTED:
        streams.print_on_stderr("drivelint: error: interrupted")
        temporary.remove_all()
        os._exit(code)  # without waiting for the database, which may still compute in its thread
    sys.exit(code or 0)


def _app_with_command(name: str) -> typer.Typer:
    """Return the command line with only the command or group of this name: building all takes longer than some commands run.

    Return all commands if none has this name, and for `docs`, which describes all commands.
    """
    if name == "docs":
        return app
    part = copy(app)
    part.registered_commands = [entry for entry in app.registered_commands if _command_name(entry) == name]
    part.registered_groups = [entry for entry in app.registered_groups if entry.name == name]
    return part if part.registered_commands or part.registered_groups else app


def _command_name(command: CommandInfo) -> str:
    return command.name or get_command_name(command.callback.__name__ if command.callback else "")


def _command_words_of_error(error: Exception) -> str:
    """Return the words of the command in which the error occurred, each followed by a space; '' without a command."""
    about, words = getattr(error, "ctx", None), ""
    while about is not None and about.parent is not None:
        about, words = about.parent, f"{about.info_name} {words}"
    return words


def _settings_hint(message: str) -> str:
    """Return the settings file in brackets if a message begins with an option that the command line lacks; '' otherwise."""
    option = message.partition(" ")[0].rstrip(":")
    is_given = any(word.partition("=")[0] == option for word in sys.argv)
    settings = None if is_given or not option.startswith("--") else find_settings()
    return "" if settings is None else f" (see {settings})"


_OPTIONS_REPLACING_MAP_SETTING: Final = frozenset({"--map", "--map-dir", "--help", "-h"})
"""If one of these options is given, the map in the settings file is not used."""


def _default_options_of_settings_file() -> dict[str, Any]:
    """Return the options of the settings file for `check`, `inspect` or `convert`.

    `inspect` and `convert` do not use the options about the output of `check`.
    """
    name = "".join(sys.argv[1:2])
    if name not in {"check", "inspect", "convert"} or (file := find_settings()) is None:
        return {}
    (callback,) = (
        command.callback for command in app.registered_commands if _command_name(command) == name and command.callback
    )
    of_command = signature(callback).parameters.keys() - (set() if name == "check" else {"out", "format_"})
    values = {param: value for param, value in settings_of_check(file).items() if param in of_command}
    map_file = (
        None if _OPTIONS_REPLACING_MAP_SETTING & {word.partition("=")[0] for word in sys.argv} else values.get("map")
    )
    if map_file is not None and not Path(map_file).exists():
        raise UsageError(f"{file}: map = {map_file!r}: does not exist: correct it, or give --map")
    return {name: values}


def _exit_with_error(message: str, code: ExitCode, *, has_lines: bool = False) -> NoReturn:
    """Print an error and exit. `has_lines`: it has a line per problem; the later ones are indented, unlike the lines of drivelint."""
    first, *more = message.split("\n") if has_lines else [message]
    streams.print_on_stderr(f"drivelint: error: {terminal_safe_line(first)}")
    for line in more:
        streams.print_on_stderr(f"  {terminal_safe_line(line)}")
    sys.exit(int(code))
