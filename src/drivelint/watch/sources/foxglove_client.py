"""A client of a Foxglove WebSocket server: messages of the channels that are read, as they come.

Source: foxglove/ws-protocol, docs/spec.md. The SDK's later subprotocol, foxglove.sdk.v1, has the same messages.
"""

from __future__ import annotations

import base64
import binascii
import json
import struct
import threading
from collections import deque
from contextlib import ExitStack, suppress
from typing import TYPE_CHECKING, Any, Final

from mcap.records import Schema

from drivelint.errors import TraceError, UsageError
from drivelint.phrases import listed, one_line
from drivelint.watch.sources.mcap_memory import is_watched
from drivelint.watch.sources.recordings import LiveChannel, LiveMessage

if TYPE_CHECKING:
    from websockets.sync.client import ClientConnection

SUBPROTOCOLS: Final = ("foxglove.sdk.v1", "foxglove.websocket.v1")
CONNECT_S: Final = 10.0
MOST_WAITING_BYTES: Final = 256 << 20
"""Where more waits to be taken, no more is read: then the server waits, or drops what is oldest."""
_SCHEMA_ENCODINGS: Final = {"protobuf": "protobuf", "json": "jsonschema", "cdr": "ros2msg", "ros1": "ros1msg"}
"""Encoding of messages -> that of their schema, where the server does not say it."""
_IN_BASE64: Final = frozenset({"protobuf", "flatbuffer"})
_MESSAGE_DATA: Final = 1
_MESSAGE: Final = struct.Struct("<BIQ")
_WARNING: Final = 1


class FoxgloveClient:
    """Reads in a thread of its own, so that the server need not wait while a window is judged.

    Errors: `UsageError` for an address that is none or where the extra is missing, `TraceError` where no such server answers.
    """

    def __init__(self, uri: str) -> None:
        self._uri = uri
        self._connection = ExitStack()
        self._ws = _connected(uri, self._connection)
        self._changed = threading.Condition()
        self._waiting: deque[LiveMessage] = deque()
        self._bytes = 0
        self._notes: deque[str] = deque()
        self._ended = self._stopped = False
        self._by_subscription: dict[int, LiveChannel] = {}
        self._by_channel: dict[int, int] = {}
        self._unread: set[str] = set()
        self._thread = threading.Thread(target=self._run, name="drivelint-foxglove", daemon=True)
        self._thread.start()

    def take(self, timeout_s: float) -> list[LiveMessage] | None:
        """Return what came since; nothing after so many seconds; None: the server has gone."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._ended, timeout_s)
            found = list(self._waiting)
            self._waiting.clear()
            self._bytes = 0
            self._changed.notify_all()
            return found if found or not self._ended else None

    def notes(self) -> list[str]:
        """Return what the server said of itself, and which of its channels are not read, once."""
        with self._changed:
            found = list(self._notes)
            self._notes.clear()
            return found

    def close(self) -> None:
        """Leave the server. What waits can still be taken. May be called twice."""
        with self._changed:
            self._stopped = True
            self._changed.notify_all()
        self._connection.close()
        self._thread.join()

    def _run(self) -> None:
        from websockets.exceptions import WebSocketException

        try:
            with suppress(WebSocketException, OSError):
                while True:
                    self._take(self._ws.recv())
        finally:
            with self._changed:
                self._ended = True
                self._changed.notify_all()

    def _take(self, data: str | bytes) -> None:
        if isinstance(data, bytes):
            if len(data) >= _MESSAGE.size and data[0] == _MESSAGE_DATA:
                _, subscription, log_ns = _MESSAGE.unpack_from(data)
                self._message(subscription, log_ns, data[_MESSAGE.size :])
            return
        try:
            said = json.loads(data)
            kind = said["op"]
            if kind == "advertise":
                self._advertised(said["channels"])
            elif kind == "unadvertise":
                for channel in said["channelIds"]:
                    self._by_channel.pop(channel, None)
            elif kind == "status" and said["level"] >= _WARNING:
                self._note(f"{self._uri} says: {one_line(str(said['message']))}")
        except (ValueError, KeyError, TypeError, binascii.Error) as error:
            self._note(f"{self._uri}: a message of the server that cannot be understood ({error!r}): it is passed over")

    def _advertised(self, channels: list[dict[str, Any]]) -> None:
        """Subscribe to the channels that are read. The id of a subscription is never used again."""
        new = []
        for each in channels:
            if each["id"] in self._by_channel:
                continue
            if not is_watched(each["schemaName"]):
                self._unread.add(each["topic"])
                continue
            number = len(self._by_subscription)
            self._by_subscription[number] = _advertised(each)
            self._by_channel[each["id"]] = number
            new.append({"id": number, "channelId": each["id"]})
        if new:
            self._ws.send(json.dumps({"op": "subscribe", "subscriptions": new}))
        elif not self._by_subscription and channels:
            self._note(f"{self._uri}: nothing on {listed(sorted(self._unread))} is read")

    def _message(self, subscription: int, log_ns: int, content: bytes) -> None:
        channel = self._by_subscription.get(subscription)
        if channel is None:
            return
        with self._changed:
            self._waiting.append(LiveMessage(channel, log_ns, content))
            self._bytes += len(content)
            self._changed.notify_all()
            self._changed.wait_for(lambda: self._bytes < MOST_WAITING_BYTES or self._stopped)

    def _note(self, text: str) -> None:
        with self._changed:
            self._notes.append(text)


def _advertised(said: dict[str, Any]) -> LiveChannel:
    encoding = str(said["encoding"])
    of_schema = str(said.get("schemaEncoding") or _SCHEMA_ENCODINGS.get(encoding, ""))
    text = str(said["schema"])
    data = base64.b64decode(text, validate=True) if of_schema in _IN_BASE64 else text.encode()
    return LiveChannel(said["topic"], encoding, Schema(id=0, name=said["schemaName"], encoding=of_schema, data=data))


def _connected(uri: str, stack: ExitStack) -> ClientConnection:
    """Return a connection, which `stack` closes."""
    try:
        from websockets.exceptions import InvalidURI, WebSocketException
        from websockets.sync.client import connect
        from websockets.typing import Subprotocol
    except ImportError as error:
        raise UsageError(f"{uri}: {error.name} is not installed: pip install 'drivelint[live]'") from error
    offered = [Subprotocol(each) for each in SUBPROTOCOLS]
    try:
        ws = stack.enter_context(
            connect(uri, subprotocols=offered, compression=None, max_size=None, open_timeout=CONNECT_S, proxy=None)
        )
    except InvalidURI as error:
        raise UsageError(f"{uri}: no address of a WebSocket: give ws://HOST:PORT") from error
    except (OSError, WebSocketException) as error:  # a timeout is an OSError
        raise TraceError(
            f"{uri}: no Foxglove WebSocket server answers: {one_line(str(error)) or 'timed out'}"
        ) from error
    if ws.subprotocol not in SUBPROTOCOLS:
        stack.close()
        raise TraceError(f"{uri}: this WebSocket server speaks none of {' and '.join(SUBPROTOCOLS)}")
    return ws
