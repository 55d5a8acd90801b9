"""A CommonRoad scenario."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {"commonroad": ("CommonRoad scenario", "said with --ego")}
takes_mapping: Final = False


def accepts(probe: Probe) -> bool:
    """Accept by its root element."""
    from drivelint.formats.commonroad import scenario as commonroad

    return commonroad.is_scenario(probe.head)


def read(probe: Probe) -> Recording:
    """Read obstacles and map."""
    from drivelint.formats.commonroad import scenario as commonroad

    return commonroad.read(probe.path)
