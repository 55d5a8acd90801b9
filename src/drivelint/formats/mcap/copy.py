"""Copies a recorded log, an MCAP file or a bag of several, into an annotated log."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

from drivelint.errors import ChangedLogError
from drivelint.formats.mcap.bag import mcap_files
from drivelint.formats.mcap.bag_folder import is_bag
from drivelint.formats.mcap.original import Original, open_log
from drivelint.formats.mcap.part_copy import PartCopy
from drivelint.formats.mcap.resume import MAGIC

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.formats.mcap.writer import Sink


def copy_original(original: Original, sink: Sink) -> None:
    """Append the data of one file to a sink, and add the copied records to the sink's index.

    Errors: `TraceError` for a damaged file; `ChangedLogError` if the file changed after ingest had read it.
    """
    if original.sha256 is None:
        PartCopy(original, sink).run()
        return
    with ThreadPoolExecutor(max_workers=1) as pool:
        digest = pool.submit(original.digest)
        PartCopy(original, sink).run()
        if digest.result() != original.sha256:
            raise ChangedLogError(
                f"{original.path}: the log changed while it was judged: check it again when it is complete"
            )


def copy_log(path: Path, sha256: str, sink: Sink) -> None:
    """Copy an MCAP file, or all files of a bag in their order, into an empty sink. Errors: those of `copy_original`."""
    for part in mcap_files(path):
        with Original(part, None if path.is_dir() else sha256) as original:
            copy_original(original, sink)


def is_mcap(path: Path) -> bool:
    """Return whether a trace is a bag, or begins with MCAP's magic bytes."""
    if path.is_dir():
        return is_bag(path)
    with open_log(path) as file:
        return file.read(len(MAGIC)) == MAGIC
