"""SUMO floating car data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {"sumo-fcd": ("SUMO floating car data", "said with --ego")}
takes_mapping: Final = True


def accepts(probe: Probe) -> bool:
    """Accept by its element or its columns."""
    from drivelint.formats.sumo import fcd as sumo

    return not probe.path.is_dir() and sumo.is_fcd(probe.path, probe.head)


def read(probe: Probe) -> Recording:
    """Read the log; its mapping is the file with the vehicle types."""
    from drivelint.formats.sumo import fcd as sumo

    return sumo.read(probe.path, probe.options.mapping)
