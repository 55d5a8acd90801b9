"""The options of `watch`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path  # noqa: TC003 - a dataclass names it

from drivelint.engine.judging_options import JudgingOptions

DEFAULT_WINDOW_S = 30.0
DEFAULT_EVERY_S = 1.0
DEFAULT_IDLE_S = 10.0


@dataclass(frozen=True, kw_only=True)
class WatchOptions(JudgingOptions):
    """The options of `watch`, under the names that they have there."""

    source: str
    command: tuple[str, ...] = ()
    """Arguments of a program to start, which writes what is watched; empty: it is started elsewhere."""
    out: Path | None = None
    window_s: float = DEFAULT_WINDOW_S
    """Seconds of log time that are judged at a time."""
    every_s: float = DEFAULT_EVERY_S
    """Seconds of log time after which the window is judged again, where the machine keeps up."""
    idle_s: float | None = DEFAULT_IDLE_S
    """Seconds without anything new after which the source has ended; None: it is waited for without end."""
    replay: float | None = None
    """A finished log is watched as if it were recorded now: seconds of log time per second, 0: as fast as it can be judged."""
    halt_on: str | None = None
    """The least severity of an alarm that halts."""
    warn: bool = False
    advise: bool = False
    on: tuple[str, ...] = ()
    """`SEL=COMMAND`: the command for an alarm of these rules."""
    serve: str | None = None
    """`HOST:PORT` of the watch's own WebSocket server for viewers."""
    allow_origin: tuple[str, ...] = ()
    """Origins of pages that may watch at `serve`."""
