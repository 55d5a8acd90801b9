"""Opens the source that the options name, and chooses the folder of its recording."""

from __future__ import annotations

from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError
from drivelint.temporary import exclude_from_removal, temporary_folder
from drivelint.watch import sources
from drivelint.watch.sources.replay import Replay
from drivelint.watch.window import NS_PER_S

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.report.progress import Progress
    from drivelint.watch.options import WatchOptions
    from drivelint.watch.source import Source

RECORDINGS_FOLDER: Final = "recorded"
"""The folder of recordings in the folder of results. Recordings are no result files: they are never replaced."""


@contextmanager
def source_of_watch(options: WatchOptions, progress: Progress) -> Iterator[Source]:
    """Open the source of a watch, and close it after the block. Without `--out`, the recording is then deleted, but not after an error.

    Errors: `UsageError` for a name of no source; the errors of the source.
    """
    with nullcontext(options.out / RECORDINGS_FOLDER) if options.out is not None else temporary_folder() as home:
        source, is_done = None, False
        try:
            source = _source_by_options(options, home)
            yield source
            is_done = True
        finally:
            if source is not None:
                source.close()
            if not is_done and options.out is None and any(home.iterdir()):
                progress.note(f"the recording is kept: {home}")
                exclude_from_removal(home)


def _source_by_options(options: WatchOptions, folder: Path) -> Source:
    if options.replay is None:
        _refuse_source_unfit_for_command(options)
        return sources.open_source(options.source, folder, idle_s=options.idle_s, every_s=options.every_s)
    if options.command:
        raise UsageError("--replay watches a finished log: there is no program to start")
    return Replay(
        Path(options.source), options.ingest_options(), speed=options.replay, every_ns=round(options.every_s * NS_PER_S)
    )


def _refuse_source_unfit_for_command(options: WatchOptions) -> None:
    """Raise `UsageError` for a source that cannot be written by a program that the watch starts."""
    if not options.command:
        return
    if options.source == "-":
        raise UsageError("-: stdin exists before the program after -- is started: start that program separately")
    if "://" not in options.source and Path(options.source).exists():
        raise UsageError(
            f"{options.source}: exists already: the program after -- must write a new file: remove it, or name another"
        )
