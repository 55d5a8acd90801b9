"""ASAM OSI trace file: length-prefixed ground truth or sensor views."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {"osi-file": ("ASAM OSI trace file", "the log's host vehicle")}
takes_mapping: Final = False


def accepts(probe: Probe) -> bool:
    """Accept by the first length and the message behind it."""
    from drivelint.formats.osi import file_reader as osi_file

    return not probe.path.is_dir() and osi_file.is_osi_trace(probe.head, probe.path.stat().st_size)


def read(probe: Probe) -> Recording:
    """Read the messages."""
    from drivelint.formats.osi import file_reader as osi_file

    return osi_file.read(probe.path)
