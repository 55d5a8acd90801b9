"""Signal handlers: Ctrl-C, SIGTERM and SIGHUP end a command, whatever its main thread is doing.

Python's handler raises `KeyboardInterrupt` at the current statement of the main thread. In a callback of an import or of the garbage
collector, Python only prints this error and continues; an extension module that is being imported makes an `ImportError` of it; within a
library's locking code, it leaves the lock locked. So the handlers here also record each signal. While another thread works, they only
record it: the main thread polls the record while it waits.
"""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_SIGNAL_NAMES: Final = ("SIGINT", "SIGTERM", "SIGHUP")  # Windows has no SIGHUP
_recorded_signals: Final[list[int]] = []


def install_handlers() -> None:
    """Make SIGTERM, and SIGHUP from a closed terminal, end a command like Ctrl-C: results so far are kept.

    Ignored signals stay ignored, as with `nohup`, except SIGTERM.
    """
    _recorded_signals.clear()
    for name in _SIGNAL_NAMES:
        number = getattr(signal, name, None)
        if number is not None and (name == "SIGTERM" or signal.getsignal(number) is not signal.SIG_IGN):
            signal.signal(number, _raise_interrupt)


def is_any_recorded() -> bool:
    """Return whether a signal came since `install_handlers`, even if its exception was lost or became another one."""
    return bool(_recorded_signals)


@contextmanager
def count_signals_only() -> Iterator[Callable[[], int]]:
    """Only record signals inside the block, without an exception; yield a function that returns the number of recorded signals.

    The number includes signals before the block whose exception was lost.
    """
    if threading.current_thread() is not threading.main_thread():  # Python handles signals only in the main thread
        yield lambda: 0
        return
    numbers = [getattr(signal, name) for name in _SIGNAL_NAMES if hasattr(signal, name)]
    before = {number: handler for number in numbers if callable(handler := signal.getsignal(number))}
    for number in before:
        signal.signal(number, _record_signal)
    try:
        yield lambda: len(_recorded_signals)
    finally:
        _recorded_signals.clear()
        for number, handler in before.items():
            signal.signal(number, handler)


def _record_signal(number: int, _frame: object) -> None:
    _recorded_signals.append(number)


def _raise_interrupt(number: int, _frame: object) -> None:
    _recorded_signals.append(number)
    raise KeyboardInterrupt
