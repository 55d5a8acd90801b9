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
    """The options of the command `watch`; each field is named like its option."""

    source: str
    command: tuple[str, ...] = ()
    """Name and arguments of a program to start, which writes the source; empty: another program writes it."""
    out: Path | None = None
    window_s: float = DEFAULT_WINDOW_S
    """Seconds of log time that are judged at a time."""
    every_s: float = DEFAULT_EVERY_S
    """Seconds of log time after which the window is judged again, if the machine is fast enough."""
    idle_s: float | None = DEFAULT_IDLE_S
    """Seconds without new data after which the source counts as ended; None: there is no such limit."""
    replay: float | None = None
    """The speed at which a finished log is replayed: seconds of log time per second; 0: as fast as it can be judged."""
    halt_on: str | None = None
    """The least severity of alarms that halt the drive."""
    warn: bool = False
    advise: bool = False
    on: tuple[str, ...] = ()
    """`SEL=COMMAND`: the command to start at an alarm of the rules that SEL selects."""
    serve: str | None = None
    """`HOST:PORT` of the watch's own WebSocket server for viewers."""
    allow_origin: tuple[str, ...] = ()
    """Origins of web pages that may connect to `serve`."""
