"""Copies a recorded log, an MCAP or SQLite file or a bag of several, into an annotated log."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

from drivelint.errors import ChangedLogError
from drivelint.formats.mcap.bag import bag_files
from drivelint.formats.mcap.bag_folder import is_bag
from drivelint.formats.mcap.original import OriginalFile, open_log
from drivelint.formats.mcap.part_copy import PartCopy
from drivelint.formats.mcap.resume import MAGIC
from drivelint.formats.sqlite_bag.database import MAGIC as SQLITE_MAGIC
from drivelint.formats.sqlite_bag.database import is_sqlite

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.formats.mcap.writer import Sink


def copy_original(original: OriginalFile, sink: Sink) -> None:
    """Append the data of one file to a sink, and add the copied records to the sink's index.

    Errors: `TraceError` for a damaged file; `ChangedLogError` if the file changed after ingest had read it.
    """
    if original.sha256 is None:
        PartCopy(original, sink).run()
        return
    with ThreadPoolExecutor(max_workers=1) as pool:
        digest = pool.submit(original.current_sha256)
        PartCopy(original, sink).run()
        if digest.result() != original.sha256:
            raise ChangedLogError(
                f"{original.path}: the log changed while it was judged: check it again when it is complete"
            )


def copy_log(path: Path, sha256: str, sink: Sink) -> None:
    """Copy a file, or all files of a bag in their order, into an empty sink. Errors: those of `copy_original`.

    Messages in SQLite become an MCAP file; the caller compares the hash of the whole log then.
    """
    for part in bag_files(path):
        if is_sqlite(part):
            from drivelint.formats.sqlite_bag.copy import copy_messages

            copy_messages(part, sink)
            continue
        with OriginalFile(part, None if path.is_dir() else sha256) as original:
            copy_original(original, sink)


def is_message_log(path: Path) -> bool:
    """Return whether a trace is a bag, or begins as files of MCAP or SQLite do."""
    if path.is_dir():
        return is_bag(path)
    with open_log(path) as file:
        return file.read(len(SQLITE_MAGIC)).startswith((MAGIC, SQLITE_MAGIC))
