"""Chooses the source that a name means, and where its recording lies."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError
from drivelint.watch import sources
from drivelint.watch.sources.replay import Replay
from drivelint.watch.window import S

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.watch.options import WatchOptions
    from drivelint.watch.source import Source

RECORDED: Final = "recorded"
"""The folder of recordings in that of the results. No result file: what was recorded is never replaced."""


@contextmanager
def open_source(options: WatchOptions) -> Iterator[Source]:
    """Open the source of a watch; close it afterwards. Errors: `UsageError` for a name that means none, those of the source."""
    with TemporaryDirectory(prefix="drivelint-") as elsewhere:
        source = _opened(options, Path(elsewhere) if options.out is None else options.out / RECORDED)
        try:
            yield source
        finally:
            source.close()


def _opened(options: WatchOptions, folder: Path) -> Source:
    if options.replay is None:
        return sources.open_source(options.source, folder, idle_s=options.idle_s, every_s=options.every_s)
    if options.command:
        raise UsageError("--replay watches a finished log: there is no program to start")
    return Replay(
        Path(options.source), options.ingest_options(), speed=options.replay, every_ns=round(options.every_s * S)
    )
