"""Counts the messages of an MCAP file, and compares the counts with those in the file's indexes."""

from __future__ import annotations

import struct
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mcap.records import Channel, Statistics

MESSAGE_INDEX_HEADER: Final = struct.Struct("<HI")
"""The header of a message index: channel id, and length in bytes of the entries that follow."""
_MESSAGE_INDEX_ENTRY: Final = struct.Struct("<QQ")
_MOST_LISTED_CONTRADICTIONS: Final = 3


@dataclass
class MessageCounts:
    """The number of messages per channel id. `unread_channels`: channels that are not read, so that missing messages are no loss."""

    by_channel: Counter[int] = field(default_factory=Counter)
    unread_channels: set[int] = field(default_factory=set)
    _open_chunk: dict[int, list[int]] | None = (
        None  # channel -> log times of its messages in the chunk that is being read
    )
    _last_chunk: dict[int, list[int]] | None = None  # the same for the previous chunk, if it was read to its end

    def add(self, channel: int, log_ns: int) -> None:
        """Count a message."""
        self.by_channel[channel] += 1
        if self._open_chunk is not None:
            self._open_chunk.setdefault(channel, []).append(log_ns)

    def begin_chunk(self) -> None:
        """Start a chunk: the next messages belong to it."""
        self._open_chunk, self._last_chunk = {}, None

    def end_chunk(self) -> None:
        """End the chunk, after all its messages were read."""
        self._open_chunk, self._last_chunk = None, self._open_chunk

    def count_missing_messages_of_chunk_and_return_times(self, index: memoryview) -> list[int]:
        """Return the log times of messages that are in the message index after a chunk, but not in the chunk.

        These messages are added to the counts, because the caller reports them as lost.
        """
        channel, length = MESSAGE_INDEX_HEADER.unpack_from(index)
        times = None if self._last_chunk is None else self._last_chunk.get(channel, [])
        if times is None or length <= _MESSAGE_INDEX_ENTRY.size * len(times) or channel in self.unread_channels:
            return []
        index_times = Counter(
            log_ns for log_ns, _ in _MESSAGE_INDEX_ENTRY.iter_unpack(index[MESSAGE_INDEX_HEADER.size :])
        )
        lacking = sorted((index_times - Counter(times)).elements())
        self.by_channel[channel] += len(lacking)
        return lacking

    def contradiction_text(
        self, statistics: Statistics, channels: Mapping[int, Channel], *, is_damaged: bool
    ) -> str | None:
        """Return, in words, the counts of the index that differ from those of the messages; None if all are equal.

        An index with a wrong CRC (`is_damaged`) is compared only if its counts per channel sum up to its total:
        the same damage may have removed messages.
        """
        index_counts, total = statistics.channel_message_counts, self.by_channel.total()
        agrees = not index_counts or sum(index_counts.values()) == statistics.message_count
        if is_damaged and not agrees:
            return None
        names = {number: f"topic {channel.topic!r}" for number, channel in channels.items()}
        contradictions = [
            f"{n} messages of {names.get(number, f'channel {number}')}, the file has {self.by_channel[number]}"
            for number, n in sorted(index_counts.items())
            if number not in self.unread_channels and n != self.by_channel[number]
        ]
        if not contradictions and not (index_counts and agrees) and statistics.message_count != total:
            contradictions = [f"{statistics.message_count} messages, the file has {total}"]
        return "; ".join(contradictions[:_MOST_LISTED_CONTRADICTIONS]) or None
