"""Receives datagrams with data that reveal losses: the time of each, and how many the system had dropped by then."""

from __future__ import annotations

import socket
import struct
import sys
import time
from typing import TYPE_CHECKING, Any, Final

from drivelint.watch.sources.background import STOP_CHECK_PERIOD_S
from drivelint.watch.sources.osi_datagrams import Datagram

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence

_IS_LINUX: Final = sys.platform == "linux"
_TIME, _OVERFLOW = 35, 40  # SO_TIMESTAMPNS and SO_RXQ_OVFL of asm-generic/socket.h, which Python does not name
_ANCILLARY_BYTES: Final = 256
_TIMESPEC: Final = struct.Struct("@ll")
_DROP_COUNT: Final = struct.Struct("@I")
RECEIVE_BUFFER_BYTES: Final = 16 << 20
"""The size in bytes of the receive buffer that is requested; the system may provide less."""
MOST_DATAGRAM_BYTES: Final = 65535
"""The largest size of a UDP datagram."""


def request_arrival_times_and_drop_counts(receiver: socket.socket) -> None:
    """Request a large receive buffer, and the arrival time and the number of drops with each datagram."""
    receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVE_BUFFER_BYTES)
    receiver.settimeout(STOP_CHECK_PERIOD_S)
    if _IS_LINUX:
        for option in (_TIME, _OVERFLOW):
            receiver.setsockopt(socket.SOL_SOCKET, option, 1)


def datagrams(receiver: socket.socket) -> Generator[Datagram | None, None, None]:
    """Yield datagrams as they arrive; None at least ten times a second."""
    while True:
        try:
            if _IS_LINUX:
                data, ancillary, _, sender = receiver.recvmsg(MOST_DATAGRAM_BYTES, _ANCILLARY_BYTES)
            else:
                (data, sender), ancillary = receiver.recvfrom(MOST_DATAGRAM_BYTES), []
        except TimeoutError:
            yield None
            continue
        at_ns, dropped = _time_and_drops(ancillary)
        # only if the system counts its drops, it is certain that no other datagram was lost on this machine
        yield Datagram(data, sender, at_ns, dropped, local=_IS_LINUX and _is_local(sender))


def _time_and_drops(ancillary_data: Sequence[tuple[int, int, bytes]]) -> tuple[int, int]:
    at_ns, dropped = time.monotonic_ns(), 0
    for level, kind, content in ancillary_data:
        if level == socket.SOL_SOCKET and kind == _TIME and len(content) >= _TIMESPEC.size:
            seconds, nanos = _TIMESPEC.unpack_from(content)
            at_ns = seconds * 1_000_000_000 + nanos
        elif level == socket.SOL_SOCKET and kind == _OVERFLOW and len(content) >= _DROP_COUNT.size:
            (dropped,) = _DROP_COUNT.unpack_from(content)
    return at_ns, dropped


def _is_local(sender: Any) -> bool:
    return isinstance(sender, tuple) and (sender[0].startswith("127.") or sender[0] == "::1")
