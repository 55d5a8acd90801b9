"""The trace format ROS 2 with messages of other types, which a mapping with `[[ros]]` makes a table.

The mapping states whether positions are those of the box centre, the front bumper or the rear axle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.formats.mcap import trace as mcap

if TYPE_CHECKING:
    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {}
takes_mapping: Final = True


def accepts(probe: Probe) -> bool:
    """Return whether the log is of ROS 2 and the mapping is one of messages."""
    if probe.options.mapping is None or not mcap.accepts(probe):
        return False
    from drivelint.formats.ros2 import topic_mapping

    return topic_mapping.is_message_mapping(probe.options.mapping)


def read(probe: Probe) -> Recording:
    """Read the topics of the mapping."""
    from drivelint.formats.ros2 import mapped_messages

    return mapped_messages.read(probe)
