"""MCAP, a file or a folder of rosbag2: ASAM OSI ground truth, ROS 2 messages or Foxglove scenes.

Each of their readers states its reference point: all hand over box centres.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.errors import TraceError
from drivelint.formats.folders import folder_kind

if TYPE_CHECKING:
    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {
    "osi-mcap": ("ASAM OSI in MCAP", "the log's host vehicle"),
    "ros2-mcap": ("ROS 2 in MCAP", "the odometry's vehicle"),
    "foxglove-mcap": ("Foxglove scene in MCAP", "named with --ego"),
}
takes_mapping: Final = False


def accepts(probe: Probe) -> bool:
    """Accept by the container's magic bytes, or the folder's description."""
    return probe.head.startswith(b"\x89MCAP") or folder_kind(probe.path) == "bag"


def read(probe: Probe) -> Recording:
    """Read the messages of the log, OSI before the others."""
    from drivelint.formats.mcap import bag
    from drivelint.formats.osi import reader as osi

    family = bag.message_family(probe.path)
    if family == "ros2":
        from drivelint.formats.ros2 import reader as ros

        return ros.read(probe.path, probe.options)
    if family == "foxglove":
        from drivelint.formats.foxglove import scene as foxglove_scene

        return foxglove_scene.read(probe.path, probe.options.topic)
    if probe.path.is_dir():
        raise TraceError(f"{probe.path}: a bag without ROS 2 or Foxglove messages that are read: give one of its files")
    return osi.read_mcap(probe.path, probe.options.topic)
