"""The kinds of sources, one module per kind, and the names that open them."""

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

DEFAULT_UDP_PORT: Final = 48198
"""The port to which esmini sends OSI messages."""


class SourceOptions(NamedTuple):
    """The options of a source, see `open_source`."""

    folder: Path
    idle_s: float | None
    every_s: float


class SourceOpener(NamedTuple):
    """A kind of source: the pattern of its names in lower case, their description for users, and the function that opens a source."""

    pattern: str
    label: str
    open: Callable[[str, SourceOptions], Source]

    def accepts(self, name: str) -> bool:
        """Return whether a name is of this kind."""
        return fnmatchcase(name.lower(), self.pattern)


def open_source(name: str, folder: Path, *, idle_s: float | None, every_s: float = 0.5) -> Source:
    """Open the source with this name.

    `folder`: for the recording, unless the source is a growing file, which is the recording itself. `idle_s`: seconds without data after
    which the source ends; None: no limit. `every_s`: simulated seconds per window.
    Errors: `UsageError` for a name of no known kind, or an address without a port.
    """
    for opener in OPENERS:
        if opener.accepts(name):
            return opener.open(name, SourceOptions(folder, idle_s, every_s))
    labels = ", ".join(opener.label for opener in OPENERS)
    raise UsageError(f"{name}: no source of this kind is known: use {labels}")


def _open_mcap(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources.mcap_file import McapSource

    return McapSource(Path(name), idle_s=options.idle_s)


def _open_osi_file(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import osi

    return osi.open_file(Path(name), idle_s=options.idle_s)


def _open_standard_input(_: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import osi

    return osi.open_standard_input(options.folder, idle_s=options.idle_s)


def _open_tcp(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import osi

    host, port = _host_and_port(name, None)
    if not host or name.lower().startswith("tcp-listen://"):
        return osi.open_tcp_server(host or LOOPBACK, port, options.folder, idle_s=options.idle_s)
    return osi.open_tcp(host, port, options.folder, idle_s=options.idle_s)


def _open_udp(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import osi

    host, port = _host_and_port(name, DEFAULT_UDP_PORT)
    return osi.open_udp(host or LOOPBACK, port, options.folder, idle_s=options.idle_s)


def _open_foxglove(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import foxglove_ws

    return foxglove_ws.open(name, options.folder, idle_s=options.idle_s)


def _open_sumo(name: str, options: SourceOptions) -> Source:
    from drivelint.watch.sources import sumo

    return sumo.open(name, options.folder, span_s=options.every_s)


def _host_and_port(name: str, usual_port: int | None) -> tuple[str, int]:
    """Return the host ("" if the name has none) and the port. Errors: `UsageError`."""
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


OPENERS: Final[tuple[SourceOpener, ...]] = (
    SourceOpener("tcp://*", "tcp://HOST:PORT or tcp://:PORT (OSI over TCP)", _open_tcp),
    SourceOpener("tcp-listen://*", "tcp-listen://HOST:PORT", _open_tcp),
    SourceOpener("udp://*", "udp://HOST:PORT (OSI of esmini)", _open_udp),
    SourceOpener("ws://*", "ws://HOST:PORT", _open_foxglove),
    SourceOpener("wss://*", "wss://HOST:PORT (a Foxglove WebSocket server)", _open_foxglove),
    SourceOpener("*.mcap", "an .mcap file that grows", _open_mcap),
    SourceOpener("*.osi", "an .osi file that grows", _open_osi_file),
    SourceOpener("*.sumocfg", "a .sumocfg (SUMO is started and stepped)", _open_sumo),
    SourceOpener("-", "- (OSI on standard input)", _open_standard_input),
)
"""The first opener that accepts a name is used. Openers import their modules when they are called, so that `drivelint --help` is fast."""
