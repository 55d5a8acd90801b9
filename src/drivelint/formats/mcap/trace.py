"""The trace formats MCAP and SQLite, a file or a rosbag2 folder, with ASAM OSI ground truth, ROS 2 messages or Foxglove scenes.

The reader of each message type states its reference point; all return box centres.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.errors import TraceError
from drivelint.formats.folders import folder_kind
from drivelint.formats.sqlite_bag.database import MAGIC as SQLITE_MAGIC

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {
    "osi-mcap": ("ASAM OSI in MCAP", "the log's host vehicle"),
    "ros2-mcap": ("ROS 2 in MCAP", "the vehicle of the odometry, or of the frame base_link"),
    "ros2-sqlite": ("ROS 2 in SQLite", "the vehicle of the odometry, or of the frame base_link"),
    "foxglove-mcap": ("Foxglove scene in MCAP", "named with --ego"),
}
takes_mapping: Final = False


def accepts(probe: Probe) -> bool:
    """Return whether the file has the magic bytes of MCAP, or of SQLite and a bag's suffix, or the folder is a bag."""
    if probe.head.startswith(SQLITE_MAGIC):
        return probe.path.suffix.lower() == ".db3"
    return probe.head.startswith(b"\x89MCAP") or folder_kind(probe.path) == "bag"


def read(probe: Probe) -> Recording:
    """Read the log's OSI messages; if there are none, its ROS 2 messages; if neither, its Foxglove messages."""
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
        _refuse_log_without_road_users(probe.path)
    if probe.path.is_dir():
        raise TraceError(f"{probe.path}: a bag of OSI messages is not read as a whole: give one of its files")
    return osi.read_mcap(probe.path, probe.options.topic)


def _refuse_log_without_road_users(path: Path) -> None:
    """Raise `TraceError` for a bag, or a ROS 2 or Foxglove log, without odometry and road users; the error lists the topics."""
    from drivelint.formats.mcap import bag

    kinds = bag.kinds_by_topic(path)
    if path.is_dir() or any("/" in kind or kind.startswith("foxglove.") for kind in kinds.values()):
        raise TraceError(f"{path}: no nav_msgs/Odometry and no road users: {bag.topics_text(path)}")
