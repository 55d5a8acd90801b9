"""This module defines what a trace reader provides, and the probe by which it recognises a trace."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from drivelint.drive.trace import IngestOptions, Recording

HEAD_BYTES = 4096


@dataclass(frozen=True)
class Probe:
    """A trace that is not read yet: its path and its first bytes (at most 4096; none for a folder)."""

    path: Path
    head: bytes
    options: IngestOptions


class Reader(Protocol):
    """One trace format: a module with these four names."""

    @property
    def formats(self) -> Mapping[str, tuple[str, str]]:
        """What `Recording.format` may be -> the format's title, and how its ego is known. Empty: it is the name of a mapping."""
        ...

    @property
    def takes_mapping(self) -> bool:
        """Whether `--mapping` is for this reader."""
        ...

    def accepts(self, probe: Probe) -> bool:
        """Say whether this reader is the one for the trace."""
        ...

    def read(self, probe: Probe) -> Recording:
        """Read the trace. Errors: `TraceError` or `UsageError` with one clear line."""
        ...
