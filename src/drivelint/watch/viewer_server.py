"""A Foxglove WebSocket server: announces channels, and sends their messages to the subscribers.

Source: foxglove/ws-protocol, docs/spec.md; the subprotocol foxglove.sdk.v1 has the same messages. Unlike Foxglove's own server, it checks
the `Origin` of web pages and refuses pages of other sites. A connected client does not prevent the end of the program.
"""

from __future__ import annotations

import asyncio
import base64
import json
import logging
import struct
from collections import deque
from contextlib import suppress
from threading import Thread
from typing import TYPE_CHECKING, Any, Final

from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import WebSocketException
from websockets.typing import Subprotocol

from drivelint.phrases import terminal_safe_line

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mcap.records import Schema
    from websockets.asyncio.server import Server
    from websockets.http11 import Request, Response

SUBPROTOCOLS: Final = (Subprotocol("foxglove.sdk.v1"), Subprotocol("foxglove.websocket.v1"))
MOST_WAITING_MESSAGES: Final = 1024
"""The most messages that wait for a slow viewer; beyond that, the oldest are dropped."""
FLUSH_TIMEOUT_S: Final = 0.5
CLOSE_TIMEOUT_S: Final = 0.5
"""At the end, the server waits `FLUSH_TIMEOUT_S` for the delivery of all messages, and `CLOSE_TIMEOUT_S` for the closing handshake."""
MOST_RECEIVED_MESSAGE_BYTES: Final = 1 << 16
"""The longest message that is accepted: viewers only send subscriptions, which are shorter."""
_MESSAGE_HEADER: Final = struct.Struct("<BIQ")
_MESSAGE_DATA_OPCODE: Final = 1


def _silent_logger() -> logging.Logger:
    """Return a disabled logger: connections are not reported, and stderr has only drivelint's messages."""
    logger = logging.getLogger("drivelint.viewers")
    logger.disabled = True
    return logger


class _Viewer:
    """A connected client, and the messages that wait for it."""

    def __init__(self, connection: ServerConnection) -> None:
        self.connection = connection
        self.subscriptions: dict[int, int] = {}
        """The client's number of a subscription -> the channel."""
        self.waiting: deque[bytes | str] = deque(maxlen=MOST_WAITING_MESSAGES)
        self.news = asyncio.Event()

    def put(self, message: bytes | str) -> None:
        self.waiting.append(message)
        self.news.set()

    async def send(self) -> None:
        while True:
            await self.news.wait()
            self.news.clear()
            while self.waiting:
                await self.connection.send(self.waiting.popleft())


class ViewerServer:
    """Serves viewers at `ws://host:port` in a thread of its own. Port 0: any free port.

    `allowed_origins`: origins of web pages that may connect. Errors: `OSError` if the server cannot start.
    """

    def __init__(self, host: str, port: int, allowed_origins: Sequence[str] = ()) -> None:
        self._allowed = frozenset(origin.rstrip("/").casefold() for origin in allowed_origins)
        self._channels: list[dict[str, Any]] = []
        self._n_channels = 0
        self._viewers: set[_Viewer] = set()
        self._notes: list[str] = []
        self._refused: set[str] = set()
        self._loop = asyncio.new_event_loop()
        self._thread = Thread(target=self._loop.run_forever, daemon=True, name="viewers")
        self._thread.start()
        try:
            self._server = asyncio.run_coroutine_threadsafe(self._started(host, port), self._loop).result()
        except BaseException:
            self._stop_loop()
            raise

    @property
    def port(self) -> int:
        """The port that is served."""
        return int(next(iter(self._server.sockets)).getsockname()[1])

    def add_channel(self, topic: str, encoding: str, schema: Schema) -> int:
        """Announce a channel, and return its number. `schema`: as in an MCAP log."""
        text = base64.b64encode(schema.data) if schema.encoding == "protobuf" else schema.data
        self._n_channels += 1
        channel = {
            "id": self._n_channels,
            "topic": topic,
            "encoding": encoding,
            "schemaName": schema.name,
            "schemaEncoding": schema.encoding,
            "schema": text.decode(),
        }
        self._call_in_thread(self._announce, channel)
        return self._n_channels

    def publish(self, channel: int, content: bytes, log_ns: int) -> None:
        """Send a message to the viewers that subscribe to its channel."""
        self._call_in_thread(self._send_to_subscribers, channel, content, log_ns)

    def n_subscriptions(self, channel: int) -> int:
        """Return how many viewers subscribe to a channel."""
        return sum(channel in viewer.subscriptions.values() for viewer in list(self._viewers))

    def notes(self) -> list[str]:
        """Return the new notes on refused clients."""
        new_notes = list(self._notes)
        del self._notes[: len(new_notes)]  # the thread may have added more
        return new_notes

    def close(self) -> None:
        """Disconnect the viewers and end the server, even if a viewer does not respond. May be called twice."""
        if self._thread.is_alive():
            with suppress(TimeoutError):
                asyncio.run_coroutine_threadsafe(self._stopped(), self._loop).result(
                    FLUSH_TIMEOUT_S + 2 * CLOSE_TIMEOUT_S
                )
            self._stop_loop()

    def _stop_loop(self) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(CLOSE_TIMEOUT_S)

    def _call_in_thread(self, function: Any, *arguments: object) -> None:
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(function, *arguments)

    async def _started(self, host: str, port: int) -> Server:
        return await serve(
            self._connected,
            host,
            port,
            subprotocols=SUBPROTOCOLS,
            process_request=self._refusal,
            compression=None,
            max_size=MOST_RECEIVED_MESSAGE_BYTES,
            close_timeout=CLOSE_TIMEOUT_S,
            server_header=None,
            logger=_silent_logger(),
        )

    async def _stopped(self) -> None:
        for _ in range(int(FLUSH_TIMEOUT_S / 0.01)):
            if not any(viewer.waiting for viewer in self._viewers):
                break
            await asyncio.sleep(0.01)
        self._server.close()
        with suppress(TimeoutError):
            await asyncio.wait_for(self._server.wait_closed(), CLOSE_TIMEOUT_S)
        left = asyncio.all_tasks() - {asyncio.current_task()}
        for task in left:
            task.cancel()
        if left:
            await asyncio.wait(left, timeout=CLOSE_TIMEOUT_S)

    def _refusal(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return the refusal of a web page of another site; None: the client may connect. Other programs send no origin."""
        origins = request.headers.get_all("Origin")
        if all(origin.rstrip("/").casefold() in self._allowed for origin in origins):
            return None
        origins_text = terminal_safe_line(" ".join(origins))[:200]
        if origins_text not in self._refused and len(self._refused) < MOST_WAITING_MESSAGES:
            self._refused.add(origins_text)
            self._notes.append(
                f"--serve: a page of {origins_text} was refused: give --allow-origin {origins_text} if it is to watch"
            )
        return connection.respond(403, "pages of this origin may not connect\n")

    async def _connected(self, connection: ServerConnection) -> None:
        viewer = _Viewer(connection)
        viewer.put(json.dumps({"op": "serverInfo", "name": "drivelint watch", "capabilities": [], "metadata": {}}))
        if self._channels:
            viewer.put(json.dumps({"op": "advertise", "channels": self._channels}))
        self._viewers.add(viewer)
        sending = asyncio.ensure_future(viewer.send())
        try:
            async for message in connection:
                self._handle_request(viewer, message)
        except WebSocketException:
            pass  # the client disconnected without a closing handshake
        finally:
            self._viewers.discard(viewer)
            sending.cancel()
            with suppress(asyncio.CancelledError, WebSocketException):
                await sending

    def _handle_request(self, viewer: _Viewer, message: str | bytes) -> None:
        """Handle a request of a viewer; unknown requests are ignored."""
        with suppress(ValueError, KeyError, TypeError):
            request = json.loads(message)
            if request["op"] == "subscribe":
                for subscription in request["subscriptions"]:
                    if len(viewer.subscriptions) < MOST_WAITING_MESSAGES and 0 <= subscription["id"] < 1 << 32:
                        viewer.subscriptions[subscription["id"]] = subscription["channelId"]
            elif request["op"] == "unsubscribe":
                for number in request["subscriptionIds"]:
                    viewer.subscriptions.pop(number, None)

    def _announce(self, channel: dict[str, Any]) -> None:
        self._channels.append(channel)
        for viewer in self._viewers:
            viewer.put(json.dumps({"op": "advertise", "channels": [channel]}))

    def _send_to_subscribers(self, channel: int, content: bytes, log_ns: int) -> None:
        for viewer in self._viewers:
            for number, subscribed in viewer.subscriptions.items():
                if subscribed == channel:
                    viewer.put(_MESSAGE_HEADER.pack(_MESSAGE_DATA_OPCODE, number, log_ns) + content)
