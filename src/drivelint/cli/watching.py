"""`drivelint watch`: judges a drive while it is recorded."""

from __future__ import annotations

import json
from pathlib import Path  # noqa: TC003 - Typer looks the annotations up
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from drivelint import option_values
from drivelint.cli import options
from drivelint.cli.console import progress as bar
from drivelint.cli.console import run_interruptible, say_earlier_folder_on_failure, say_nothing_kept
from drivelint.cli.options import Texts, argument, option
from drivelint.cli.streams import ReaderLeftError
from drivelint.options.arguments import DriveArguments, ExitCodeArguments, RuleArguments  # noqa: TC001 - read at runtime
from drivelint.options.declaration import engine_values
from drivelint.phrases import terminal_safe_json
from drivelint.temporary import temporary_folder

if TYPE_CHECKING:
    from drivelint.report.progress import Progress
    from drivelint.watch.interruption import InterruptionOfWatchOrCheck
    from drivelint.watch.messages import Message
    from drivelint.watch.options import WatchOptions

Severity = Literal["critical", "major", "minor"]


@options.DeclaredCommand
def watch(
    *,
    source: Annotated[
        str,
        argument(
            "SOURCE",
            "A growing log (.mcap, .osi), - for OSI messages on stdin, tcp://HOST:PORT, udp://HOST:PORT, ws://HOST:PORT, "
            "or a simulation (.sumocfg). With --replay: any log.",
        ),
    ],
    command: Annotated[
        list[str] | None, argument("[-- COMMAND...]", "A program to start, which writes the log.")
    ] = None,
    drive: DriveArguments,
    halt_on: Annotated[
        Severity | None,
        option(
            "--halt-on",
            None,
            "End the watch, and COMMAND or the simulation, at the first alarm of this severity or a worse one.",
        ),
    ] = None,
    warn: Annotated[
        bool, option("--warn", None, "Also warn of a margin that is small and shrinks, with the time until it is 0.")
    ] = False,
    advise: Annotated[
        bool,
        option(
            "--advise", None, "Also print the profile with which an overtake would be possible. Advice, not control."
        ),
    ] = False,
    on: Annotated[
        Texts,
        option(
            "--on",
            "SEL=COMMAND",
            "Run COMMAND, without a shell, at an alarm of these rules. It gets the alarm on stdin. At most once a second. Repeatable.",
        ),
    ] = None,
    serve: Annotated[
        str | None,
        option(
            "--serve",
            "HOST:PORT",
            "Start a WebSocket server that shows the drive live in Foxglove. Needs drivelint[live].",
        ),
    ] = None,
    allow_origin: Annotated[
        Texts,
        option(
            "--allow-origin",
            "ORIGIN",
            "With --serve: web pages of this origin may connect, such as https://app.foxglove.dev. Repeatable. Default: none.",
        ),
    ] = None,
    replay: Annotated[
        float | None,
        option(
            "--replay",
            "SPEED",
            "Replay a finished log as if it were being recorded. 1: at its own speed, 0: step by step.",
            min=0.0,
        ),
    ] = None,
    window: Annotated[float, option("--window", "S", "Seconds of the log that are judged at a time.", min=11.0)] = 30.0,
    every: Annotated[
        float,
        option(
            "--every",
            "S",
            "Seconds of the log between two judgements, if the machine is fast enough.",
            min=0.01,
        ),
    ] = 1.0,
    idle: Annotated[
        float,
        option("--idle", "S", "The source has ended after this many seconds without new data; 0: never.", min=0.0),
    ] = 10.0,
    out: Annotated[
        Path | None,
        option("--out", "DIR", "Folder for the recording and, at the end, for the result files, as those of check."),
    ] = None,
    overwrite: options.Overwrite = False,
    selection: RuleArguments,
    exit_codes: ExitCodeArguments,
    robustness: Annotated[
        bool | None,
        option(
            "--robustness/--no-robustness",
            None,
            "At the end, count how robust critical and major findings are, as check does.",
        ),
    ] = None,
    memory: options.MemorySize = None,
    quiet: options.Quiet = False,
) -> None:
    """Judge a drive while it is recorded: print alarms at once, verdicts at the end.

    Prints one JSON object per line: alarm, over, warning, mode, halt, note; at the end checked, verdict and end. An alarm is
    a preliminary finding; at the end, the check of the whole recording confirms it or not, and prints the verdicts.

    This is not a safety function of a vehicle: drivelint docs watching describes its limits and its speed.

    Exit codes: those of check, for the whole recording; 1 also if an alarm halted the watch. Ctrl-C ends the recording, which is
    then checked; a second Ctrl-C ends watch at once.
    """
    from drivelint.engine.interruption import NothingJudgedError
    from drivelint.errors import DriveLintError, ExitCode
    from drivelint.report.outputs import working_folder
    from drivelint.watch import messages
    from drivelint.watch.interruption import InterruptionOfWatchOrCheck
    from drivelint.watch.options import WatchOptions

    settings = WatchOptions(
        source=source,
        command=tuple(command or ()),
        **engine_values(drive),
        **engine_values(selection),
        **engine_values(exit_codes),
        out=out,
        robustness=robustness,
        memory=option_values.parse_memory(memory),
        window_s=window,
        every_s=every,
        idle_s=idle or None,
        replay=replay,
        halt_on=halt_on,
        warn=warn,
        advise=advise,
        on=tuple(on or ()),
        serve=serve,
        allow_origin=tuple(allow_origin or ()),
    )
    emit, interruption = _Printer(), InterruptionOfWatchOrCheck()
    with say_earlier_folder_on_failure(out), working_folder(out, overwrite=overwrite) as work, bar(quiet) as progress:
        try:
            code = run_interruptible(
                lambda: _watch_and_check(settings, work, emit, interruption, progress, overwrite=overwrite),
                interruption.request,
            )
        except NothingJudgedError:
            emit(messages.end({}, int(ExitCode.INTERRUPTED), "interrupted before the recording was judged"))
            say_nothing_kept(out, judged_none=True)
            raise
        except DriveLintError as error:
            emit(messages.end({}, int(error.exit_code), str(error)))
            raise
    if emit.has_reader_left:
        raise ReaderLeftError
    raise typer.Exit(code)


class _Printer:
    """Prints messages. If the reader closes stdout, the watch continues, to write its result and to halt at alarms."""

    has_reader_left = False

    def __call__(self, message: Message) -> None:
        """Print a message as one line of JSON."""
        try:
            if not self.has_reader_left:
                typer.echo(terminal_safe_json(json.dumps(message, ensure_ascii=False, allow_nan=False)))
        except ReaderLeftError:
            self.has_reader_left = True


def _watch_and_check(
    settings: WatchOptions,
    work: Path | None,
    emit: _Printer,
    interruption: InterruptionOfWatchOrCheck,
    progress: Progress,
    *,
    overwrite: bool,
) -> int:
    """Watch a source, check the recording, and return the exit code. `work`: the folder in which the result is made."""
    from drivelint.report.outputs import write
    from drivelint.result.model import exit_status
    from drivelint.watch import messages
    from drivelint.watch.ending import check_recording, report_outcome_and_return_counts_text
    from drivelint.watch.judge import WindowJudge
    from drivelint.watch.run import Watch
    from drivelint.watch.server import open_server
    from drivelint.watch.sources.choice import source_of_watch

    with (
        temporary_folder() as folder,
        # reads rules and map, so that an error in them ends the watch before the source or COMMAND starts
        WindowJudge(settings) as judge,
        open_server(settings.serve, judge.rules, settings.allow_origin) as server,
        source_of_watch(settings, progress) as source,
        Watch(settings, source, emit, interruption.of_watch, server, judge=judge) as watch,
    ):
        progress.stage("watching")
        watched = watch.watch()
        source.close()
        for text in source.notes():
            emit(messages.note(text))
        progress.note(watched.timing_text())
        interruption.switch_to_check()
        result = check_recording(
            settings,
            source.recording,
            work,
            watch,
            folder=folder,
            progress=progress,
            interruption=interruption.of_check,
        )
        if interruption.of_check.requested and not result.interrupted:
            emit(messages.note("interrupted: the test of how sure the findings are was not finished"))
        counts_text = report_outcome_and_return_counts_text(result, watch, emit)
        if settings.out is not None:
            write(result, settings.out, work, overwrite=overwrite)
        progress.note(counts_text)
        return int(exit_status(result).code)
