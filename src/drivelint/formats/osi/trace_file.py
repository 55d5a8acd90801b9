"""Splits an OSI trace file into its messages, up to the first damage.

Each message follows its length, and nothing else marks where a message begins. So everything after an impossible length is lost:
bytes there that look like a message may be the inside of another.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.formats.mcap.losses import LostBytes
from drivelint.formats.mcap.reader import BATCH_BYTES, LogMessage

if TYPE_CHECKING:
    import mmap
    from collections.abc import Iterator
    from pathlib import Path

    from mcap.records import Channel

    from drivelint.arrays import Times
    from drivelint.drive.trace import LostTime
    from drivelint.formats.mcap.losses import Losses

LENGTH_FIELD_BYTES: Final = 4
"""The number of bytes of a message's length field."""
MOST_MESSAGE_BYTES: Final = 512 << 20
"""A longer message is impossible: even messages with a map are much shorter."""
_POSSIBLE_FIRST_MESSAGE_BYTES: Final = frozenset({0x0A, 0x12, 0x1A})
"""The possible first bytes of an OSI message: the tags of version, time stamp or an id (fields 1 to 3, length-delimited)."""


def may_be_osi_trace(head: bytes, size: int) -> bool:
    """Return whether a file of `size` bytes that begins with `head` can be an OSI trace: a possible length, then a message."""
    length = int.from_bytes(head[:LENGTH_FIELD_BYTES], "little")
    return (
        2 <= length <= min(size - LENGTH_FIELD_BYTES, MOST_MESSAGE_BYTES)
        and len(head) > LENGTH_FIELD_BYTES
        and head[LENGTH_FIELD_BYTES] in _POSSIBLE_FIRST_MESSAGE_BYTES
    )


def message_batches(channel: Channel, content: mmap.mmap, losses: Losses) -> Iterator[list[LogMessage]]:
    """Yield batches of messages of about `BATCH_BYTES` up to the damage; then add the lost bytes after them to `losses`.

    After each batch, the caller must add the times of the decoded messages to `losses`.
    """
    waiting: list[LogMessage] = []
    at = size = 0
    while at < len(content) and (why := _why_length_is_wrong(content, at)) is None:
        start = at + LENGTH_FIELD_BYTES
        end = start + int.from_bytes(content[at:start], "little")
        waiting.append(LogMessage(channel, 0, content[start:end], at))
        size += end - at
        at = end
        if size >= BATCH_BYTES:
            yield waiting
            waiting, size = [], 0
    if waiting:
        yield waiting
    if at < len(content):
        while (
            losses.lost_bytes and losses.lost_bytes[-1].end == at
        ):  # the length of a message that cannot be decoded may be wrong, too
            at = losses.lost_bytes.pop().start
        since = losses.last_ns
        if (
            since is not None
            and len(content) > at + LENGTH_FIELD_BYTES
            and content[at + LENGTH_FIELD_BYTES] not in _POSSIBLE_FIRST_MESSAGE_BYTES
        ):
            since -= 1  # no message begins here: a wrong length may have cut off the last message
        losses.lost_bytes.append(LostBytes(at, len(content), str(why), since))


def _why_length_is_wrong(content: mmap.mmap, at: int) -> str | None:
    """Return the reason why the length at byte `at` cannot be right; None if it can."""
    start = at + LENGTH_FIELD_BYTES
    length = int.from_bytes(content[at:start], "little")
    if start > len(content):
        return f"the file ends within the length of the message at byte {at}"
    if not length:
        return f"a message of 0 bytes at byte {at}"
    if length > MOST_MESSAGE_BYTES or start + length > len(content):
        short = start + length - len(content)
        return f"the message at byte {at} should have {length} bytes" + (
            f" and the file ends {short} bytes before that" if short > 0 else ", which is too many"
        )
    end = start + length
    if _is_message_start(content, at) or end == len(content) or _is_message_start(content, end):
        return None
    return f"no message begins at byte {at}, nor at byte {end} after the {length} bytes that the message should have"


def _is_message_start(content: mmap.mmap, at: int) -> bool:
    return may_be_osi_trace(content[at : at + LENGTH_FIELD_BYTES + 1], len(content) - at)


def lost_times(path: Path, losses: Losses, t_ns: Times) -> list[LostTime]:
    """Return the losses as ranges of the messages' own time. `t_ns`: the times of the messages that were read, in the file's order.

    If times go back, messages were written late. Lost messages may have been late, too, so the ranges are widened by the largest delay.
    If all times are equal, the ranges have no bounds.
    """
    steps = np.diff(t_ns)
    late = -min(int(steps.min(initial=0)), 0)
    if len(steps) and not steps.any():
        return [lost_time._replace(since_ns=None, until_ns=None) for lost_time in losses.lost_times(path)]
    return [
        lost_time._replace(
            since_ns=None if lost_time.since_ns is None else lost_time.since_ns - late,
            until_ns=None if lost_time.until_ns is None else lost_time.until_ns + late,
        )
        for lost_time in losses.lost_times(path)
    ]
