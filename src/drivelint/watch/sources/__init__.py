"""One module per kind of source, and the names by which each is opened."""

from __future__ import annotations

from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple
from urllib.parse import urlsplit

from drivelint.errors import UsageError
from drivelint.watch.sources.transports import LOOPBACK

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.watch.source import Source

UDP_PORT: Final = 48198
"""The port that esmini sends OSI to."""


class SourceOptions(NamedTuple):
    """`folder`: where a recording is written, if what is watched is none itself. `idle_s`, `every_s`: see `open_source`."""

    folder: Path
    idle_s: float | None
    every_s: float


class Opener(NamedTuple):
    """A kind of source: the pattern of its names, in small letters, their description for a user, and the function that opens one."""

    pattern: str
    label: str
    open: Callable[[str, SourceOptions], Source]

    def accepts(self, name: str) -> bool:
        """Say whether a name is of this kind."""
        return fnmatchcase(name.lower(), self.pattern)


def open_source(name: str, folder: Path, *, idle_s: float | None, every_s: float = 0.5) -> Source:
    """Open the source of this name.

    `folder`: where its recording is written, unless it is a file that grows and so is the recording itself. `idle_s`: it ends when nothing
    has come for so many seconds; None: it does not. `every_s`: what a simulation is advanced by at a time.
    Errors: `UsageError` for a name of no known kind, or one that lacks its port.
    """
    for opener in OPENERS:
        if opener.accepts(name):
            return opener.open(name, SourceOptions(folder, idle_s, every_s))
    known = ", ".join(opener.label for opener in OPENERS)
    raise UsageError(f"{name}: no source of this kind is known: use {known}")


def _mcap(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources.mcap_file import McapFile

    return McapFile(Path(name), idle_s=options.idle_s)


def _osi_file(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import osi

    return osi.open_file(Path(name), idle_s=options.idle_s)


def _standard_input(_: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import osi

    return osi.open_standard_input(options.folder, idle_s=options.idle_s)


def _tcp(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import osi

    host, port = _address(name, None)
    if not host or name.lower().startswith("tcp-listen://"):
        return osi.open_tcp_server(host or LOOPBACK, port, options.folder, idle_s=options.idle_s)
    return osi.open_tcp(host, port, options.folder, idle_s=options.idle_s)


def _udp(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import osi

    host, port = _address(name, UDP_PORT)
    return osi.open_udp(host or LOOPBACK, port, options.folder, idle_s=options.idle_s)


def _foxglove(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import foxglove_ws

    return foxglove_ws.open(name, options.folder, idle_s=options.idle_s)


def _sumo(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import sumo

    return sumo.open(name, options.folder, span_s=options.every_s)


def _address(name: str, usual_port: int | None) -> tuple[str, int]:
    """Return host ("": none is named) and port. Errors: `UsageError`."""
    try:
        parts = urlsplit(name)
        port = usual_port if parts.port is None else parts.port
    except ValueError as error:
        raise UsageError(
            f"{name}: no address ({error}): write a host and a port, such as tcp://127.0.0.1:9000"
        ) from error
    if port is None or parts.path or parts.query:
        raise UsageError(f"{name}: no address: write a host and a port, such as tcp://127.0.0.1:9000")
    return parts.hostname or "", port


OPENERS: Final[tuple[Opener, ...]] = (
    Opener("tcp://*", "tcp://HOST:PORT or tcp://:PORT (OSI over TCP)", _tcp),
    Opener("tcp-listen://*", "tcp-listen://HOST:PORT", _tcp),
    Opener("udp://*", "udp://HOST:PORT (OSI of esmini)", _udp),
    Opener("ws://*", "ws://HOST:PORT", _foxglove),
    Opener("wss://*", "wss://HOST:PORT (a Foxglove WebSocket server)", _foxglove),
    Opener("*.mcap", "an .mcap file that grows", _mcap),
    Opener("*.osi", "an .osi file that grows", _osi_file),
    Opener("*.sumocfg", "a .sumocfg (SUMO is started and stepped)", _sumo),
    Opener("-", "- (OSI on standard input)", _standard_input),
)
"""The first that accepts a name opens it. Each imports its module when it is asked, so that `drivelint --help` stays fast."""
