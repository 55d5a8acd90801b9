"""Joins datagrams to OSI messages: esmini sends each message over UDP in one or more datagrams.

A datagram is a header of a signed and an unsigned 32-bit integer, counter and size, and `size` bytes of the message, at most 8192.
The datagrams of a message count 1, 2, 3, ...; the last counter is negative: three datagrams have 1, 2, -3, a single datagram has -1.
The header does not name the message: only the order shows to which message a datagram belongs. Source:
`OSIReporter::UpdateOSIGroundTruth` and `osi_udp_buf` in esmini's EnvironmentSimulator/Modules/ScenarioEngine/SourceFiles/OSIReporter.cpp,
received by `OSIReceiver` in its scripts/udp_driver/udp_osi_common.py (https://github.com/esmini/esmini). Older versions count from 0 and
end each message with -1, so that a lost datagram cannot be detected: such a stream is refused.
"""

from __future__ import annotations

import struct
from collections import deque
from dataclasses import dataclass
from statistics import median
from typing import Final

from drivelint.drive.order import MAX_GAP_PERIODS
from drivelint.errors import TraceError
from drivelint.formats.osi.trace_file import MOST_MESSAGE_BYTES
from drivelint.phrases import plural
from drivelint.watch.sources.osi_messages import is_complete_message, message_time_ns

DATAGRAM_HEADER: Final = struct.Struct("<iI")
MOST_PAUSE_WITHIN_MESSAGE_NS: Final = 10_000_000
"""The longest pause between two datagrams of a message from another machine: they are sent at once, so in a longer pause some were lost."""
LEAST_HOLE_AFTER_LOSS_PERIODS: Final = MAX_GAP_PERIODS + 0.25
"""The length, in time steps, of the hole that is left after a lost message: the checker joins states that are closer together."""
_MOST_KEPT_TIME_STEPS: Final = 101
"""The number of steps from which the usual time step is computed."""


@dataclass(frozen=True)
class Datagram:
    """A received datagram. `at_ns`: its arrival, on any clock. `dropped`: how many datagrams the system had dropped by then.

    `local`: the sender is on this machine, so that only the system can have dropped datagrams.
    """

    data: bytes
    sender: object = None
    at_ns: int = 0
    dropped: int = 0
    local: bool = False


@dataclass
class Losses:
    """Counts of the losses, by their kind."""

    gaps: int = 0
    distrusted: int = 0
    strange: int = 0
    foreign: int = 0
    dropped: int = 0

    @property
    def total(self) -> int:
        """The sum of the counts."""
        return sum(vars(self).values())

    def summary_text(self) -> str:
        """Return the counts that are not 0, in words."""
        counts = {
            f"datagrams missing or out of order in {plural(self.gaps, 'place')}": self.gaps,
            f"{plural(self.dropped, 'datagram')} for which the buffer had no room": self.dropped,
            f"{plural(self.distrusted, 'message')} left out after them": self.distrusted,
            f"{plural(self.strange, 'datagram')} of no OSI message": self.strange,
            f"{plural(self.foreign, 'datagram')} of another sender": self.foreign,
        }
        return ", ".join(text for text, n in counts.items() if n)


class MessageAssembler:
    """Returns messages of which every datagram came in order; all other messages are left out and counted in `losses`.

    The next messages after a lost one are left out, too: they may contain its late datagrams. The resulting hole is so long that the
    checker judges nothing across it; a single missing step would look like a slow recorder. Only the first message's sender is accepted.

    Three losses cannot be detected: (1) all datagrams of a message from another machine are lost; (2) a datagram that comes two messages
    late replaces a lost one; (3) the remaining datagrams of two messages within `MOST_PAUSE_WITHIN_MESSAGE_NS` have consecutive counters.
    """

    def __init__(self, where: str) -> None:
        self.losses = Losses()
        self._where = where
        self._parts: list[bytes] = []
        self._previous: Datagram | None = None
        self._is_lost = False  # whether the message that arrives at present is lost
        self._in_doubt = False
        self._left_out = 0  # messages since the last one that was returned
        self._sender: object = None
        self._last = b""
        self._last_part = b""
        self._last_ns: int | None = None
        self._steps_ns: deque[int] = deque(maxlen=_MOST_KEPT_TIME_STEPS)

    def add_datagram(self, datagram: Datagram) -> bytes | None:
        """Return the message that this datagram completes, if any. Errors: `TraceError` for a stream that counts from 0."""
        if self._sender is not None and datagram.sender != self._sender:
            self.losses.foreign += 1
            return None
        counter, size = (
            DATAGRAM_HEADER.unpack_from(datagram.data) if len(datagram.data) > DATAGRAM_HEADER.size else (1, -1)
        )
        data = datagram.data[DATAGRAM_HEADER.size :]
        if size != len(data):
            self.losses.strange += 1
            return None
        if counter == 0:
            raise TraceError(
                f"{self._where}: the datagrams are counted from 0, as an old esmini does: a lost one could not be detected: "
                "use a newer one, or let it write a file (--osi_file) and watch that"
            )
        if self._may_have_losses_before(datagram) and self._parts:
            self._give_up_message()
        if not self._is_expected_part(counter, data):
            return None
        self._parts.append(data)
        if sum(map(len, self._parts)) > MOST_MESSAGE_BYTES:
            self._give_up_message()
        return self._finish_message(datagram.sender) if counter < 0 and self._parts else None

    def _is_expected_part(self, counter: int, data: bytes) -> bool:
        """Return whether a datagram is the expected one; if not, the parts of its message are left out."""
        # the first part of a message contains the message's time: an equal one is a duplicate
        if counter == 1 and [data] == self._parts:
            return False
        if counter < 0 and not self._parts and data == self._last_part:
            return False
        if counter in {1, -1}:
            if self._parts:
                self._give_up_message()
            self._is_lost = False
        elif abs(counter) != len(self._parts) + 1:
            if not self._is_lost:
                self._give_up_message()
            self._is_lost = counter > 0
            return False
        return True

    def _may_have_losses_before(self, datagram: Datagram) -> bool:
        """Return whether datagrams may have been lost just before this one."""
        previous, self._previous = self._previous, datagram
        if previous is None:
            return False
        paused = not datagram.local and datagram.at_ns - previous.at_ns > MOST_PAUSE_WITHIN_MESSAGE_NS
        dropped = max(datagram.dropped - previous.dropped, 0)
        self.losses.dropped += dropped
        if dropped:
            self._in_doubt = True
        if paused or dropped:
            self._last_part = b""
        return paused or dropped > 0 or previous.sender != datagram.sender

    def _give_up_message(self) -> None:
        self.losses.gaps += 1
        self._is_lost = self._in_doubt = True
        self._parts.clear()

    def _finish_message(self, sender: object) -> bytes | None:
        message = b"".join(self._parts)
        self._last_part = self._parts[-1]
        self._parts.clear()
        t_ns = message_time_ns(message, None)
        if t_ns is None or not is_complete_message(message):
            self.losses.strange += 1
            return None
        if message == self._last:
            return None
        if self._in_doubt:
            self._left_out += 1
            self._in_doubt = self._must_leave_out_next_message(t_ns)
            self.losses.distrusted += 1
            return None
        if self._last_ns is not None and t_ns > self._last_ns and not self._left_out:
            self._steps_ns.append(t_ns - self._last_ns)
        self._last, self._last_ns, self._sender = message, t_ns, sender
        self._left_out = 0
        return message

    def _must_leave_out_next_message(self, t_ns: int) -> bool:
        """Return whether the hole is still too short if the message at `t_ns` is the last one that is left out."""
        if self._last_ns is None:
            return False
        if not self._steps_ns:
            return self._left_out < 2
        period = median(self._steps_ns)
        return 0 <= t_ns + period - self._last_ns < LEAST_HOLE_AFTER_LOSS_PERIODS * period
