"""Functions that commands share: run a job in a second thread, show progress, print formatted text."""

from __future__ import annotations

import os
import sys
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import contextmanager, nullcontext
from typing import TYPE_CHECKING, Any, TypeVar

import typer

from drivelint.cli import ending_signals
from drivelint.errors import DriveLintError
from drivelint.phrases import plural, terminal_safe, terminal_safe_line

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from contextlib import AbstractContextManager
    from pathlib import Path

    from rich.console import Console, RenderableType
    from rich.segment import Segment

    from drivelint.report.progress import Progress

T = TypeVar("T")


def run_interruptible(job: Callable[[], T], interrupt: Callable[[], None] | None = None) -> T:
    """Run `job` in a second thread, so that Ctrl-C interrupts it while the database computes.

    The main thread wakes several times a second, because some libraries make the system restart a wait that a signal interrupted.
    With `interrupt`, the first Ctrl-C calls `interrupt` repeatedly until the job ends; a second Ctrl-C raises `KeyboardInterrupt`.
    """
    running = ThreadPoolExecutor(max_workers=1).submit(job)
    with ending_signals.count_signals_only() as n_signals:
        is_told = False
        while not running.done():
            if n_signals() > (interrupt is not None):
                raise KeyboardInterrupt
            if interrupt is not None and n_signals():
                if not is_told:
                    typer.echo(
                        "drivelint: interrupted: finishing what is begun; press Ctrl-C again to stop at once and keep nothing",
                        err=True,
                    )
                is_told = True
                interrupt()
            wait([running], timeout=0.2)
    return running.result()


def say_nothing_kept(out: Path | None, *, judged_none: bool) -> None:
    """Print on stderr why an interrupted check has no result, and that its folder contains none."""
    why = "nothing was judged yet" if judged_none else "stopped at once: nothing is kept"
    typer.echo(
        f"drivelint: {why}{'' if out is None else f'; {terminal_safe_line(str(out))} contains no result'}", err=True
    )


@contextmanager
def say_earlier_folder_on_failure(out: Path | None) -> Iterator[None]:
    """Print where the earlier result is, if the run inside the block ends without a result."""
    from drivelint.result.folder import EARLIER_RESULT_FOLDER

    try:
        yield
    except (DriveLintError, KeyboardInterrupt):
        if (
            out is not None
            and (out / EARLIER_RESULT_FOLDER / "summary.json").is_file()
            and not (out / "summary.json").is_file()
        ):
            typer.echo(
                f"drivelint: the result of an earlier run is now in {terminal_safe_line(str(out / EARLIER_RESULT_FOLDER))}",
                err=True,
            )
        raise


def say_kept_drives(drive_statuses: Sequence[str], out: Path | None) -> None:
    """Print how many drives an interrupted check has judged and kept."""
    where = "" if out is None else f" in {terminal_safe_line(str(out))}"
    sentence = f"kept {drive_statuses.count('judged')} of {plural(len(drive_statuses), 'drive')}{where}"
    typer.echo(f"drivelint: {sentence}", err=True)


def progress(quiet: bool) -> AbstractContextManager[Progress]:
    """Return a progress bar if stderr is a terminal; else an object that prints only the pipeline's notes, as lines."""
    from drivelint.report.progress import Silent, note_printer, progress_bar

    if quiet:
        return nullcontext(Silent())
    return progress_bar() if sys.stderr.isatty() else note_printer()


def _console_class_without_control_sequences() -> type[Console]:
    """Return a console class that removes terminal control sequences from text, so that only rich's styles control the terminal."""
    from rich.console import Console

    class ConsoleWithoutControlSequences(Console):
        def render(self, *args: Any, **options: Any) -> Iterator[Segment]:
            for segment in super().render(*args, **options):
                yield segment if segment.control else segment._replace(text=terminal_safe(segment.text))

    return ConsoleWithoutControlSequences


def print_rich(content: RenderableType | Callable[[int], RenderableType], *, soft_wrap: bool = False) -> None:
    """Print on stdout, formatted by `rich_text`."""
    typer.echo(rich_text(content, soft_wrap=soft_wrap), nl=False)


def rich_text(content: RenderableType | Callable[[int], RenderableType], *, soft_wrap: bool = False) -> str:
    """Return formatted text for stdout: plain and 120 columns wide if stdout is not a terminal.

    `content`: a renderable, or a function from the width to a renderable.
    """
    terminal = sys.stdout.isatty()
    console = _console_class_without_control_sequences()(
        width=None if terminal or "COLUMNS" in os.environ else 120, highlight=False
    )
    with console.capture() as captured:
        console.print(content(console.width) if callable(content) else content, soft_wrap=soft_wrap)
    if terminal:
        return captured.get()
    return "\n".join(terminal_safe(line.rstrip()) for line in captured.get().split("\n")).rstrip("\n") + "\n"
