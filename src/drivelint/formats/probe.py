"""This module defines the interface of a trace reader, and the probe by which a reader recognises a trace."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Protocol

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from drivelint.drive.trace import IngestOptions, Recording

HEAD_BYTES = 4096
WRAPPINGS: Final = {
    b"PK\x03\x04": "a zip archive: unpack it",
    b"\x1f\x8b": "compressed with gzip: unpack it",
    b"\x28\xb5\x2f\xfd": "compressed with zstd: unpack it",
    b"/annex/objects/": "a pointer of git-annex, not the file itself: fetch that with git annex get",
    b"version https://git-lfs": "a pointer of Git LFS, not the file itself: fetch that with git lfs pull",
}
"""First bytes of a file that replaces the real file (an archive or a pointer) -> its kind, and the remedy."""


def wrapping_and_remedy(head: bytes) -> str | None:
    """Return the kind of a file with these first bytes, and the remedy, if it is an archive or a pointer; else None."""
    return next((remedy for magic, remedy in WRAPPINGS.items() if head.startswith(magic)), None)


@dataclass(frozen=True)
class Probe:
    """A trace that is not read yet: its path and its first bytes (at most 4096; none for a folder)."""

    path: Path
    head: bytes
    options: IngestOptions


class Reader(Protocol):
    """The interface of a trace reader: a module with these four names."""

    @property
    def formats(self) -> Mapping[str, tuple[str, str]]:
        """Return `Recording.format` -> the format's title, and how its ego is determined. Empty if the format is a mapping's name."""
        ...

    @property
    def takes_mapping(self) -> bool:
        """Return whether this reader uses `--mapping`."""
        ...

    def accepts(self, probe: Probe) -> bool:
        """Return whether this reader can read the trace."""
        ...

    def read(self, probe: Probe) -> Recording:
        """Read the trace. Errors: `TraceError` or `UsageError` with a message of one line."""
        ...
