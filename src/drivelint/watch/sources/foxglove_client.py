"""A client of a Foxglove WebSocket server, which receives the messages of the channels that drivelint reads.

Source: foxglove/ws-protocol, docs/spec.md. The SDK's later subprotocol, foxglove.sdk.v1, has the same messages.
"""

from __future__ import annotations

import base64
import binascii
import json
import socket
import ssl
import struct
import time
from contextlib import ExitStack, suppress
from typing import TYPE_CHECKING, Any, Final

from mcap.records import Schema

from drivelint.errors import TraceError, UsageError
from drivelint.phrases import name_list, one_line
from drivelint.watch.sources.background import STOP_CHECK_PERIOD_S, BackgroundReader
from drivelint.watch.sources.mcap_memory import is_watched
from drivelint.watch.sources.recordings import LiveChannel, LiveMessage
from drivelint.watch.sources.transports import CONNECT_RETRY_S, IdleTimeout

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence

    from websockets.sync.client import ClientConnection

SUBPROTOCOLS: Final = ("foxglove.sdk.v1", "foxglove.websocket.v1")
CONNECT_TIMEOUT_S: Final = 10.0
_SCHEMA_ENCODINGS: Final = {"protobuf": "protobuf", "json": "jsonschema", "cdr": "ros2msg", "ros1": "ros1msg"}
"""Encoding of messages -> encoding of their schema, if the server does not name it."""
_BASE64_SCHEMA_ENCODINGS: Final = frozenset({"protobuf", "flatbuffer"})
_MESSAGE_DATA_OPCODE: Final = 1
_MESSAGE_HEADER: Final = struct.Struct("<BIQ")
_WARNING_LEVEL: Final = 1


class FoxgloveClient:
    """Receives messages in a thread of its own, so that the server need not wait while a window is judged.

    `idle_s`: how long it waits for the server to start, and then for each message; None: for ever.
    Errors: `UsageError` for an invalid address, or if the extra `live` is missing.
    """

    def __init__(self, uri: str, *, idle_s: float | None = None) -> None:
        _refuse_invalid_address(uri)
        self._uri = uri
        self._idle_s = idle_s
        self._notes: list[str] = []
        self._by_subscription: dict[int, LiveChannel] = {}
        self._by_channel: dict[int, int] = {}
        self._unread: set[str] = set()
        self._reader = BackgroundReader(self._received_messages(), size=_content_bytes)

    def take(self, timeout_s: float) -> list[LiveMessage] | None:
        """Return the messages since the last call; empty after `timeout_s`; None: the server closed, or was idle for too long.

        Errors: `TraceError` if no such server answers.
        """
        batches = self._reader.take(timeout_s)
        return None if batches is None else [message for messages in batches for message in messages]

    def notes(self) -> list[str]:
        """Return the new notes on the server: its status, channels that are not read, and the wait for its start."""
        new_notes = list(self._notes)
        del self._notes[: len(new_notes)]  # the thread may have added more
        return new_notes

    def close(self) -> list[LiveMessage]:
        """Close the connection, and return the messages that were not taken. May be called twice."""
        self._reader.stop()
        return [message for messages in self._reader.take_remaining() for message in messages]

    def _received_messages(self) -> Generator[list[LiveMessage], None, None]:
        """Connect, waiting for the server to start, and yield its messages until it closes the connection."""
        from websockets.exceptions import WebSocketException

        with ExitStack() as stack:
            ws = yield from self._open_connection(stack)
            patience = IdleTimeout(self._idle_s)
            stack.enter_context(suppress(WebSocketException, OSError))
            while not patience.is_over:
                try:
                    messages = self._handle_message(ws, ws.recv(timeout=STOP_CHECK_PERIOD_S))
                except TimeoutError:
                    messages = []
                yield messages
                if messages:
                    patience.restart()

    def _open_connection(self, stack: ExitStack) -> Generator[list[LiveMessage], None, ClientConnection]:
        """Return a connection, which `stack` closes; yield empty lists until it is open. Errors: `TraceError`."""
        from websockets.exceptions import WebSocketException
        from websockets.sync.client import connect
        from websockets.typing import Subprotocol

        offered = [Subprotocol(name) for name in SUBPROTOCOLS]
        patience, is_told = IdleTimeout(self._idle_s), False
        while True:
            try:
                ws = stack.enter_context(
                    connect(
                        self._uri,
                        subprotocols=offered,
                        compression=None,
                        max_size=None,
                        open_timeout=CONNECT_TIMEOUT_S,
                        proxy=None,
                    )
                )
            except (OSError, WebSocketException) as error:  # a timeout is an OSError
                is_in_vain = isinstance(error, (WebSocketException, ssl.SSLError, socket.gaierror))
                if is_in_vain or patience.is_over:
                    why = one_line(str(error)) or "timed out"
                    raise TraceError(f"{self._uri}: no Foxglove WebSocket server answers: {why}") from error
                if not is_told:
                    self._notes.append(f"{self._uri}: no server answers yet: waiting for it")
                    is_told = True
                yield []
                time.sleep(CONNECT_RETRY_S)
                continue
            if ws.subprotocol not in SUBPROTOCOLS:
                raise TraceError(f"{self._uri}: this WebSocket server speaks none of {' and '.join(SUBPROTOCOLS)}")
            return ws

    def _handle_message(self, ws: ClientConnection, data: str | bytes) -> list[LiveMessage]:
        """Handle a WebSocket message; return the channel's message that it contains, if any."""
        if isinstance(data, bytes):
            if len(data) < _MESSAGE_HEADER.size or data[0] != _MESSAGE_DATA_OPCODE:
                return []
            _, subscription, log_ns = _MESSAGE_HEADER.unpack_from(data)
            channel = self._by_subscription.get(subscription)
            return [] if channel is None else [LiveMessage(channel, log_ns, data[_MESSAGE_HEADER.size :])]
        try:
            message = json.loads(data)
            kind = message["op"]
            if kind == "advertise":
                self._subscribe_to_channels(ws, message["channels"])
            elif kind == "unadvertise":
                for channel in message["channelIds"]:
                    self._by_channel.pop(channel, None)
            elif kind == "status" and message["level"] >= _WARNING_LEVEL:
                self._notes.append(f"{self._uri} says: {one_line(str(message['message']))}")
        except (ValueError, KeyError, TypeError, binascii.Error) as error:
            self._notes.append(
                f"{self._uri}: a message of the server that cannot be understood ({error!r}): it is ignored"
            )
        return []

    def _subscribe_to_channels(self, ws: ClientConnection, channels: list[dict[str, Any]]) -> None:
        """Subscribe to the channels that drivelint reads. The id of a subscription is never reused."""
        new = []
        for channel in channels:
            if channel["id"] in self._by_channel:
                continue
            if not is_watched(channel["schemaName"]):
                self._unread.add(channel["topic"])
                continue
            number = len(self._by_subscription)
            self._by_subscription[number] = _live_channel(channel)
            self._by_channel[channel["id"]] = number
            new.append({"id": number, "channelId": channel["id"]})
        if new:
            ws.send(json.dumps({"op": "subscribe", "subscriptions": new}))
        elif not self._by_subscription and channels:
            self._notes.append(f"{self._uri}: nothing on {name_list(sorted(self._unread))} is read")


def _content_bytes(messages: Sequence[LiveMessage]) -> int:
    return sum(len(message.content) for message in messages)


def _live_channel(advertisement: dict[str, Any]) -> LiveChannel:
    encoding = str(advertisement["encoding"])
    of_schema = str(advertisement.get("schemaEncoding") or _SCHEMA_ENCODINGS.get(encoding, ""))
    text = str(advertisement["schema"])
    data = base64.b64decode(text, validate=True) if of_schema in _BASE64_SCHEMA_ENCODINGS else text.encode()
    return LiveChannel(
        advertisement["topic"], encoding, Schema(id=0, name=advertisement["schemaName"], encoding=of_schema, data=data)
    )


def _refuse_invalid_address(uri: str) -> None:
    """Raise `UsageError` for an invalid address, or if the extra `live` is missing."""
    try:
        from websockets.exceptions import InvalidURI
        from websockets.sync.client import connect  # noqa: F401 - checks that it is installed
        from websockets.uri import parse_uri
    except ImportError as error:
        raise UsageError(f"{uri}: {error.name} is not installed: pip install 'drivelint[live]'") from error
    try:
        parse_uri(uri)
    except InvalidURI as error:
        raise UsageError(f"{uri}: no address of a WebSocket: write ws://HOST:PORT") from error
