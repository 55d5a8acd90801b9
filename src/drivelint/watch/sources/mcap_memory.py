"""Keeps earlier messages that are still valid in a window, according to the purpose of their channel.

Messages of road users and odometry are valid only at their own time, messages of traffic lights until the next message. Transforms, maps,
parameters, reports and declared events are rare or valid for longer: the first and the last messages of a channel are kept. Entities of a
scene are valid until they are replaced, deleted or expired, see `mcap_scene`.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Final, Protocol

from drivelint.formats.foxglove.decode import SCENE
from drivelint.formats.mcap.bag import FOXGLOVE_ROLE_BY_SCHEMA, OSI_SCHEMAS, ROS_ROLE_BY_SCHEMA
from drivelint.formats.osi.metadata import EVENT_MESSAGE
from drivelint.formats.osi.schema import OPEN_DRIVE
from drivelint.formats.ros2.messages import (
    DETECTIONS_ROLE,
    LIGHT_GROUPS,
    ODOMETRY_ROLE,
    OLD_LIGHT_GROUPS,
    PARAMETER_EVENTS,
    ROAD_USERS_ROLE,
)
from drivelint.formats.ros2.types import message_kind
from drivelint.watch.sources.mcap_scene import SceneMemory

if TYPE_CHECKING:
    from mcap.records import Channel

    from drivelint.watch.sources.mcap_stream import NumberedMessage

RECENT_MESSAGES_SPAN_NS: Final = 2_000_000_000
"""Older messages are not valid: a report of lights is valid for one second, and transforms are joined over at most half a second."""
MOST_KEPT_FIRST_MESSAGES: Final = 200
MOST_KEPT_FIRST_EVENTS: Final = 20_000
"""The largest number of first messages of a channel that are kept: `MOST_KEPT_FIRST_EVENTS` for events and parameters, which may be
valid to the end of the log; `MOST_KEPT_FIRST_MESSAGES` for other channels."""
_MOST_KEPT_FIRST_MESSAGES_BY_KIND: Final = {
    EVENT_MESSAGE: MOST_KEPT_FIRST_EVENTS,
    PARAMETER_EVENTS: MOST_KEPT_FIRST_EVENTS,
    LIGHT_GROUPS: 0,
    OLD_LIGHT_GROUPS: 0,
}
MOST_KEPT_BYTES_OF_FIRST_MESSAGES: Final = 64 << 20
_READABLE_KINDS: Final = {*OSI_SCHEMAS, OPEN_DRIVE, EVENT_MESSAGE, *ROS_ROLE_BY_SCHEMA, *FOXGLOVE_ROLE_BY_SCHEMA}


class ChannelMemory(Protocol):
    """Keeps the messages of a channel that are still valid when a window begins."""

    def add(self, numbered: NumberedMessage) -> None:
        """Add the next message."""
        ...

    def current_messages(self) -> list[NumberedMessage]:
        """Return messages with the content that is still valid."""
        ...


def is_watched(schema: str) -> bool:
    """Return whether any of drivelint's readers reads messages with a schema of this name."""
    return message_kind(schema) in _READABLE_KINDS


def memory_for(channel: Channel, schema: str) -> ChannelMemory:
    """Return the memory for the messages of a channel whose schema has this name."""
    kind = message_kind(schema)
    if kind == SCENE:
        return SceneMemory(channel.message_encoding)
    if kind in OSI_SCHEMAS or ROS_ROLE_BY_SCHEMA.get(kind) in {ROAD_USERS_ROLE, DETECTIONS_ROLE, ODOMETRY_ROLE}:
        return EmptyMemory()
    return FirstAndRecentMemory(_MOST_KEPT_FIRST_MESSAGES_BY_KIND.get(kind, MOST_KEPT_FIRST_MESSAGES))


class EmptyMemory:
    """Keeps nothing: each message is valid only at its own time."""

    def add(self, numbered: NumberedMessage) -> None:
        """See `ChannelMemory`."""

    def current_messages(self) -> list[NumberedMessage]:
        """See `ChannelMemory`."""
        return []


class FirstAndRecentMemory:
    """Keeps the first messages, without repeated equal ones, and the messages of the last `RECENT_MESSAGES_SPAN_NS`."""

    def __init__(self, most_first: int) -> None:
        self._most = most_first
        self._first: list[NumberedMessage] = []
        self._first_bytes = 0
        self._recent: deque[NumberedMessage] = deque()

    def add(self, numbered: NumberedMessage) -> None:
        """See `ChannelMemory`."""
        data = numbered.message
        if not self._recent and self._first and self._first[-1].message.content == data.content:
            return
        if not self._recent and len(self._first) < self._most and self._first_bytes < MOST_KEPT_BYTES_OF_FIRST_MESSAGES:
            self._first.append(numbered)
            self._first_bytes += len(data.record)
            return
        self._recent.append(numbered)
        while len(self._recent) > 1 and self._recent[0].message.log_ns < data.log_ns - RECENT_MESSAGES_SPAN_NS:
            self._recent.popleft()

    def current_messages(self) -> list[NumberedMessage]:
        """See `ChannelMemory`."""
        return [*self._first, *self._recent]
