"""A Foxglove WebSocket server made with Foxglove's own SDK, which plays an MCAP file."""

from __future__ import annotations

import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

from mcap.reader import make_reader

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

MOST_S = 10.0


def until(condition: Callable[[], bool]) -> None:
    """Wait until something holds. Errors: `TimeoutError`."""
    end = time.monotonic() + MOST_S
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError
        time.sleep(0.01)


class Player:
    """Announces the channels of a log, and sends its messages when it is told to."""

    def __init__(self, log: Path, port: int) -> None:
        import foxglove

        self._context = context = foxglove.Context()  # without it its channels are gone
        self._server = foxglove.start_server(port=port, context=context, message_backlog_size=100_000)
        self.uri = f"ws://127.0.0.1:{self._server.port}"
        with log.open("rb") as file:
            reader = make_reader(file)
            summary = reader.get_summary()
            assert summary is not None
            self._channels = {}
            for number, each in summary.channels.items():
                own = summary.schemas[each.schema_id]
                schema = foxglove.Schema(name=own.name, encoding=own.encoding, data=own.data)
                self._channels[number] = foxglove.Channel(
                    each.topic, message_encoding=each.message_encoding, schema=schema, context=context
                )
            self._messages = [(m.channel_id, m.log_time, m.data) for _, _, m in reader.iter_messages()]
        self.n_messages = len(self._messages)

    def play(self, first: int = 0, end: int | None = None) -> None:
        """Send messages once somebody has subscribed."""
        until(lambda: all(each.has_sinks() for each in self._channels.values()))
        for channel, log_ns, data in self._messages[first:end]:
            self._channels[channel].log(data, log_time=log_ns)

    def stop(self) -> None:
        """Go away."""
        self._server.stop()


@contextmanager
def player(log: Path, port: int = 0) -> Iterator[Player]:
    """Give a server that plays a log; port 0: any that is free."""
    made = Player(log, port)
    try:
        yield made
    finally:
        made.stop()
