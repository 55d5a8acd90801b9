"""Reads a socket or a pipe in a thread of its own, so that no data are lost between two reads."""

from __future__ import annotations

from collections import deque
from contextlib import closing
from threading import Condition, Thread
from typing import TYPE_CHECKING, Any, Final, Generic, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

T = TypeVar("T")

MOST_WAITING_BYTES: Final = 256 << 20
"""If more bytes than this wait to be taken, the thread does not read. Then the writer waits, or drops its oldest data."""
STOP_CHECK_PERIOD_S: Final = 0.1
"""The interval at which a wait for a socket checks whether to stop."""


class BackgroundReader(Generic[T]):
    """Runs a generator in a thread, and keeps its items until they are taken.

    The generator yields an empty item at least every `STOP_CHECK_PERIOD_S`, so that it can be stopped. `size` returns the number of bytes
    of an item.
    """

    def __init__(
        self,
        items: Generator[T, None, None],
        *,
        size: Callable[[Any], int] = len,
        most_bytes: int = MOST_WAITING_BYTES,
    ) -> None:
        self._items = items
        self._size = size
        self._most = most_bytes
        self._changed = Condition()
        self._waiting: deque[T] = deque()
        self._bytes = 0
        self._error: BaseException | None = None
        self._ended = self._stopped = False
        # a daemon: an interrupted watch must end even if a read never returns
        self._thread = Thread(target=self._read_items, name="drivelint-source", daemon=True)
        self._thread.start()

    def take(self, timeout_s: float) -> list[T] | None:
        """Return the items since the last call; empty after `timeout_s`; None: the generator has ended. Errors: as the generator."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._ended, timeout_s)
            if items := self._take_waiting():
                return items
            if self._ended and self._error is not None:
                raise self._error
            return None if self._ended else []

    def take_remaining(self) -> list[T]:
        """Return the waiting items, even if the thread ended with an error."""
        with self._changed:
            return self._take_waiting()

    def stop(self) -> None:
        """End the thread; waiting items can still be taken. May be called twice."""
        with self._changed:
            self._stopped = True
            self._changed.notify_all()
        self._thread.join(timeout=10 * STOP_CHECK_PERIOD_S)

    def _take_waiting(self) -> list[T]:
        items = list(self._waiting)
        self._waiting.clear()
        self._bytes = 0
        self._changed.notify_all()
        return items

    def _read_items(self) -> None:
        try:
            with closing(self._items):
                for item in self._items:
                    if not self._keep_item_unless_stopped(item):
                        break
        except BaseException as error:  # noqa: BLE001 (`take` raises it)
            self._error = error
        finally:
            with self._changed:
                self._ended = True
                self._changed.notify_all()

    def _keep_item_unless_stopped(self, item: T) -> bool:
        """Keep an item, wait while there are too many bytes, and return whether to continue."""
        with self._changed:
            if item:
                self._waiting.append(item)
                self._bytes += self._size(item)
                self._changed.notify_all()
            self._changed.wait_for(lambda: self._bytes < self._most or self._stopped)
            return not self._stopped
