"""Decodes batches of messages, and leaves out and counts malformed messages if they are few."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeVar

from drivelint.drive.lost_time import LATEST_CREDIBLE_NS
from drivelint.formats.mcap.reader import MessageError

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.formats.mcap.reader import Container, LogMessage

T = TypeVar("T")

MOST_MALFORMED_SHARE: Final = 0.1
"""If a larger share of messages cannot be decoded, the schema is wrong, and the other messages were decoded by chance."""


def decode_readable_and_record_losses(
    container: Container, log_messages: list[LogMessage], decode: Callable[[list[LogMessage]], T]
) -> tuple[T | None, list[LogMessage]]:
    """Decode a batch, and add its malformed messages to the losses of `container`.

    Return the decoded data (None if no message is readable), and the messages that were decoded.
    Errors: the error of the first malformed message, if more than a tenth of the batch is malformed.
    """

    def decode_if_times_credible(batch: list[LogMessage]) -> T:
        if max(log_message.log_time_ns for log_message in batch) > LATEST_CREDIBLE_NS:
            late = next(log_message for log_message in batch if log_message.log_time_ns > LATEST_CREDIBLE_NS)
            raise late.error(container.path, "its log time is not in this or the next century")
        return decode(batch)

    decoded, malformed = decode_without_malformed(log_messages, decode_if_times_credible)
    for k, why in malformed.items():
        container.losses.add_undecodable_message(log_messages[k].offset, str(why), log_messages[k].log_time_ns)
    return decoded, [log_message for k, log_message in enumerate(log_messages) if k not in malformed]


def decode_without_malformed(
    log_messages: list[LogMessage], decode: Callable[[list[LogMessage]], T]
) -> tuple[T | None, dict[int, MessageError]]:
    """Decode a batch without its malformed messages.

    Return the decoded data (None if no message is readable), and place in the batch -> error for the malformed messages.
    Errors: the error of the first malformed message, if more than a tenth of the batch is malformed.
    """
    try:
        return decode(log_messages), {}
    except MessageError as error:
        first = error
    malformed = dict(_malformed_places_and_errors(log_messages, decode))
    if len(malformed) > max(1, MOST_MALFORMED_SHARE * len(log_messages)):
        raise first
    readable = [log_message for k, log_message in enumerate(log_messages) if k not in malformed]
    return (decode(readable) if readable else None), malformed


def _malformed_places_and_errors(
    log_messages: list[LogMessage], decode: Callable[[list[LogMessage]], object]
) -> list[tuple[int, MessageError]]:
    """Return place and error of each message that cannot be decoded, found by bisection."""
    malformed_messages: list[tuple[int, MessageError]] = []
    waiting = [(0, len(log_messages))]
    while waiting and len(malformed_messages) <= max(1, MOST_MALFORMED_SHARE * len(log_messages)):
        begin, end = waiting.pop()
        try:
            decode(log_messages[begin:end])
        except MessageError as error:
            if end - begin == 1:
                malformed_messages.append((begin, error))
            else:
                middle = (begin + end) // 2
                waiting += [(middle, end), (begin, middle)]
    return malformed_messages
