"""Yields bytes from standard input or TCP as they arrive, and an empty piece at least ten times a second."""

from __future__ import annotations

import os
import select
import socket
import time
from ipaddress import ip_address
from typing import TYPE_CHECKING, Final

from drivelint.errors import TraceError
from drivelint.watch.sources.background import STOP_CHECK_PERIOD_S

if TYPE_CHECKING:
    from collections.abc import Generator

BLOCK_BYTES: Final = 1 << 18
CONNECT_RETRY_S: Final = 0.5
"""The interval between attempts to connect to a writer that is not started yet."""


LOOPBACK: Final = "127.0.0.1"


def is_loopback(host: str) -> bool:
    """Return whether only programs of this machine can reach an address."""
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host.casefold() == "localhost"


def notes_on_open_address(host: str) -> list[str]:
    """Return the note that other machines can reach an address; empty if they cannot."""
    return [] if is_loopback(host) else ["whoever reaches this address can send what is judged"]


class IdleTimeout:
    """A timeout after `idle_s` seconds without data; None: there is no timeout."""

    def __init__(self, idle_s: float | None) -> None:
        self._idle_s = idle_s
        self._came_at = time.monotonic()

    def restart(self) -> None:
        """Restart the timeout, because data came."""
        self._came_at = time.monotonic()

    @property
    def is_over(self) -> bool:
        """Whether no data came for `idle_s` seconds."""
        return self._idle_s is not None and time.monotonic() - self._came_at >= self._idle_s


def blocks_of_descriptor(number: int, idle_s: float | None) -> Generator[bytes, None, None]:
    """Yield the bytes of an open file descriptor, such as standard input, up to its end."""
    patience = IdleTimeout(idle_s)
    while not patience.is_over:
        if not select.select([number], [], [], STOP_CHECK_PERIOD_S)[0]:
            yield b""
            continue
        try:
            data = os.read(number, BLOCK_BYTES)
        except OSError as error:
            raise TraceError(f"standard input cannot be read: {error.strerror or error}") from error
        if not data:
            return
        yield data
        patience.restart()


def blocks_of_connection(
    connection: socket.socket, idle_s: float | None, notes: list[str]
) -> Generator[bytes, None, None]:
    """Yield the bytes of a TCP connection until the writer closes it or the connection fails; a failure is added to `notes`."""
    patience = IdleTimeout(idle_s)
    with connection:
        connection.settimeout(STOP_CHECK_PERIOD_S)
        while not patience.is_over:
            try:
                data = connection.recv(BLOCK_BYTES)
            except TimeoutError:
                yield b""
                continue
            except OSError as error:
                notes.append(f"the connection broke: {error.strerror or error}")
                return
            if not data:
                return
            yield data
            patience.restart()


def connect_and_read(host: str, port: int, idle_s: float | None, notes: list[str]) -> Generator[bytes, None, None]:
    """Connect to a writer, waiting for it to start, and yield the bytes that it sends.

    Errors: `TraceError` for an unknown host.
    """
    where = f"tcp://{host}:{port}"
    patience = IdleTimeout(idle_s)
    while not patience.is_over:
        try:
            connection = socket.create_connection((host, port), timeout=CONNECT_RETRY_S)
        except socket.gaierror as error:
            raise TraceError(f"{where}: the host is not known: {error.strerror or error}") from error
        except OSError:
            yield b""
            time.sleep(CONNECT_RETRY_S)
        else:
            yield from blocks_of_connection(connection, idle_s, notes)
            return


def listen_and_read(server: socket.socket, idle_s: float | None, notes: list[str]) -> Generator[bytes, None, None]:
    """Wait for one writer to connect, and yield the bytes that it sends."""
    patience = IdleTimeout(idle_s)
    with server:
        server.settimeout(STOP_CHECK_PERIOD_S)
        while not patience.is_over:
            try:
                connection, _ = server.accept()
            except TimeoutError:
                yield b""
                continue
            server.close()  # a second writer would be another drive
            yield from blocks_of_connection(connection, idle_s, notes)
            return


def bound_socket(kind: socket.SocketKind, host: str, port: int, where: str) -> socket.socket:
    """Return a socket bound to an address of this machine. Errors: `TraceError` if the address cannot be used."""
    try:
        family = socket.getaddrinfo(host, port, type=kind)[0][0]
        bound = socket.socket(family, kind)
        try:
            if kind == socket.SOCK_STREAM:
                bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            bound.bind((host, port))
        except OSError:
            bound.close()
            raise
    except OSError as error:
        raise TraceError(
            f"{where}: this address cannot be opened to receive data: {error.strerror or error}"
        ) from error
    return bound
