"""MCAP, a file or a folder of rosbag2: ASAM OSI ground truth, ROS 2 messages or Foxglove scenes.

Each of their readers states its reference point: all hand over box centres.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.errors import TraceError
from drivelint.formats.folders import folder_kind
from drivelint.phrases import listed

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {
    "osi-mcap": ("ASAM OSI in MCAP", "the log's host vehicle"),
    "ros2-mcap": ("ROS 2 in MCAP", "the odometry's vehicle"),
    "foxglove-mcap": ("Foxglove scene in MCAP", "named with --ego"),
}
takes_mapping: Final = False
_MAX_TOPICS: Final = 8
"""Topics that an error names before it says how many more there are."""


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
    if family == "none":
        _refuse_other_messages(probe.path)
    if probe.path.is_dir():
        raise TraceError(f"{probe.path}: a bag of OSI messages: give one of its files")
    return osi.read_mcap(probe.path, probe.options.topic)


def _refuse_other_messages(path: Path) -> None:
    """Refuse a log of ROS 2 or Foxglove that has neither an ego nor road users. Errors: `TraceError` with its topics."""
    from drivelint.formats.mcap import bag

    kinds = bag.topics(path)
    if path.is_dir() or any("/" in kind or kind.startswith("foxglove.") for kind in kinds.values()):
        has = listed([f"{kind} on {topic}" for topic, kind in sorted(kinds.items())], _MAX_TOPICS) or "no topic"
        raise TraceError(f"{path}: no nav_msgs/Odometry and no road users: it has {has}; see drivelint docs traces")
