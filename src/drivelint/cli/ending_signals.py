"""Ctrl-C, SIGTERM and SIGHUP end a command, wherever its main thread is.

Python's own handler raises `KeyboardInterrupt` where the main thread happens to be. In a callback of an import or of the garbage collector
that error is printed, and is gone; between two statements of a library's lock it leaves the lock closed. So a signal is noted, too, and
while another thread works, it raises nothing: whoever waits for that thread asks.
"""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_NAMES: Final = ("SIGINT", "SIGTERM", "SIGHUP")  # the last one is not on Windows
_noted: Final[list[int]] = []


def install() -> None:
    """Let SIGTERM, and SIGHUP of a terminal that is gone, end a command as Ctrl-C does: what is judged is kept. `nohup` holds."""
    _noted.clear()
    for name in _NAMES:
        number = getattr(signal, name, None)
        if number is not None and (name == "SIGTERM" or signal.getsignal(number) is not signal.SIG_IGN):
            signal.signal(number, _raise)


@contextmanager
def noted_only() -> Iterator[Callable[[], int]]:
    """Let signals raise nothing inside the block; yield what returns how many came, those before it that were lost included."""
    if threading.current_thread() is not threading.main_thread():  # signals are the main thread's
        yield lambda: 0
        return
    numbers = [getattr(signal, name) for name in _NAMES if hasattr(signal, name)]
    before = {number: handler for number in numbers if callable(handler := signal.getsignal(number))}
    for number in before:
        signal.signal(number, _note)
    try:
        yield lambda: len(_noted)
    finally:
        _noted.clear()
        for number, handler in before.items():
            signal.signal(number, handler)


def _note(number: int, _frame: object) -> None:
    _noted.append(number)


def _raise(number: int, _frame: object) -> None:
    _noted.append(number)
    raise KeyboardInterrupt
