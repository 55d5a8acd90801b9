"""Sources of OSI ground truths or sensor views: a growing file, standard input, TCP, or UDP as esmini sends it."""

from __future__ import annotations

import socket
import sys
from contextlib import ExitStack, contextmanager
from itertools import count
from typing import TYPE_CHECKING, Final, Protocol, cast

from drivelint.errors import TraceError, UsageError
from drivelint.formats.osi.trace_file import LENGTH_FIELD_BYTES
from drivelint.watch.source import Frame, WindowFileSource
from drivelint.watch.sources import transports
from drivelint.watch.sources.background import BackgroundReader
from drivelint.watch.sources.datagram_socket import datagrams, request_arrival_times_and_drop_counts
from drivelint.watch.sources.growing_file import GrowingFile
from drivelint.watch.sources.osi_datagrams import MessageAssembler
from drivelint.watch.sources.osi_messages import MessageCutter, message_kind, message_time_ns
from drivelint.watch.sources.osi_static import StaticContent

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence
    from pathlib import Path
    from typing import BinaryIO

RECORDING_NAME: Final = "recording"


class Receiver(Protocol):
    """Provides OSI messages from a file, a stream or datagrams."""

    def take(self, timeout_s: float) -> list[bytes] | None:
        """Return the messages since the last call; empty after `timeout_s`; None: no more will come."""
        ...

    def notes(self) -> list[str]:
        """Return the notes on losses since the last call."""
        ...

    def close(self) -> None:
        """Close the file or connection of the messages. May be called twice."""
        ...


class OsiSource(WindowFileSource):
    """A source of OSI messages, see `drivelint.watch.source.Source`.

    A frame is a message, at the message's own time. Content that only the drive's first message has, such as lanes, is copied into the
    first message of every window.
    """

    window_name = "window.osi"
    is_advanced_by_reads = False

    def __init__(self, recording: Path, receiver: Receiver) -> None:
        self.recording = recording
        self._receiver = receiver
        self._first: bytes | None = None
        self._kind: str | None = None
        self._static: StaticContent | None = None
        self._last_ns = 0
        self._count = 0

    def read(self, timeout_s: float) -> Sequence[Frame] | None:
        """See `Source`."""
        messages = self._receiver.take(timeout_s)
        return None if messages is None else [self._frame(message) for message in messages]

    def _frame(self, data: bytes) -> Frame:
        if self._first is None:
            self._first = data
        if self._kind is None:
            self._kind = message_kind(data)
        t_ns = message_time_ns(data, self._kind)
        if t_ns is not None:
            self._last_ns = t_ns
        self._count += 1
        return Frame(self._last_ns, (self._count == 1, data), len(data))

    def notes(self) -> Sequence[str]:
        """See `Source`."""
        return self._receiver.notes()

    def write_window(self, frames: Sequence[Frame], path: Path, *, may_omit_earlier_data: bool = False) -> None:  # noqa: ARG002 - as in all sources
        """See `Source`."""
        with path.open("wb") as file:
            for k, frame in enumerate(frames):
                is_first, data = cast("tuple[bool, bytes]", frame.data)
                file.write(with_length_prefix(self._with_static_content(data) if k == 0 and not is_first else data))

    def _with_static_content(self, data: bytes) -> bytes:
        if self._static is None and self._kind is not None and self._first is not None:
            self._static = StaticContent(self._first, self._kind)
        return data if self._static is None else self._static.add_to_message(data)

    def end_sender_if_possible(self) -> None:
        """See `Source`. The sender of the messages cannot be ended from here."""

    def close(self) -> None:
        """See `Source`."""
        self._receiver.close()


def with_length_prefix(data: bytes) -> bytes:
    """Return a message preceded by its length, as in a trace file."""
    return len(data).to_bytes(LENGTH_FIELD_BYTES, "little") + data


class FileReceiver:
    """Reads the messages of a file that another process writes."""

    def __init__(self, path: Path, *, idle_s: float | None) -> None:
        self._path = path
        self._file = GrowingFile(path, idle_s=idle_s)
        self._cutter = MessageCutter()
        self._ended = False
        self._notes: list[str] = []

    def take(self, timeout_s: float) -> list[bytes] | None:
        """See `Receiver`."""
        if self._ended:
            return None
        data = self._file.read(timeout_s)
        messages = self._cutter.cut(data or b"", ended=data is None)
        if self._cutter.trouble is not None:
            self._notes.append(f"{self._path}: {self._cutter.trouble}: nothing after that is read")
        self._ended = data is None or self._cutter.trouble is not None
        return messages or (None if self._ended else [])

    def notes(self) -> list[str]:
        """See `Receiver`."""
        new_notes, self._notes = self._notes, []
        return new_notes

    def close(self) -> None:
        """See `Receiver`."""
        self._file.close()


class StreamReceiver:
    """Reads the messages of a stream, and records its bytes as they arrive: the check at the end reads exactly these bytes."""

    def __init__(self, where: str, blocks: Generator[bytes, None, None], recording: BinaryIO, notes: list[str]) -> None:
        self._where = where
        self._cutter = MessageCutter()
        self._recording = recording
        self._reader = BackgroundReader(_recorded_blocks(blocks, recording))
        self._notes = notes
        self._ended = False

    def take(self, timeout_s: float) -> list[bytes] | None:
        """See `Receiver`."""
        if self._ended:
            return None
        blocks = self._reader.take(timeout_s)
        messages = self._cutter.cut(b"".join(blocks or ()), ended=blocks is None)
        if self._cutter.trouble is not None:
            self._notes.append(f"{self._cutter.trouble}: nothing after that is read")
        self._ended = blocks is None or self._cutter.trouble is not None
        return messages or (None if self._ended else [])

    def notes(self) -> list[str]:
        """See `Receiver`."""
        new_notes = [f"{self._where}: {note}" for note in self._notes]
        del self._notes[: len(new_notes)]  # the thread may have added more
        return new_notes

    def close(self) -> None:
        """See `Receiver`."""
        self._reader.stop()
        self._recording.close()


def _recorded_blocks(blocks: Generator[bytes, None, None], recording: BinaryIO) -> Generator[bytes, None, None]:
    for data in blocks:
        _write_at_once(recording, data)
        yield data


def _write_at_once(recording: BinaryIO, data: bytes) -> None:
    """Write and flush bytes, so that they are kept even if this process is killed."""
    try:
        recording.write(data)
        recording.flush()
    except OSError as error:
        raise TraceError(f"{recording.name}: the recording cannot be written: {error.strerror or error}") from error


class DatagramReceiver:
    """Joins the datagrams of UDP to messages, and records the complete messages."""

    def __init__(
        self, where: str, receiver: socket.socket, recording: BinaryIO, notes: list[str], *, idle_s: float | None
    ) -> None:
        self._where = where
        self._recording = recording
        self._notes = notes
        self._assembler = MessageAssembler(where)
        self._told = 0
        self._ended = False
        request_arrival_times_and_drop_counts(receiver)
        self._reader = BackgroundReader(self._messages(receiver, idle_s))

    def _messages(self, receiver: socket.socket, idle_s: float | None) -> Generator[bytes, None, None]:
        patience = transports.IdleTimeout(idle_s)
        with receiver:
            for datagram in datagrams(receiver):
                if datagram is not None:
                    patience.restart()
                message = None if datagram is None else self._assembler.add_datagram(datagram)
                if message is not None:
                    _write_at_once(self._recording, with_length_prefix(message))
                yield message or b""
                if patience.is_over:
                    return

    def take(self, timeout_s: float) -> list[bytes] | None:
        """See `Receiver`."""
        messages = self._reader.take(timeout_s)
        self._ended = messages is None
        return messages

    def notes(self) -> list[str]:
        """See `Receiver`. Losses are reported when their number has doubled since the last report, and at the end."""
        new_notes, self._notes = [f"{self._where}: {note}" for note in self._notes], []
        losses = self._assembler.losses
        if losses.total >= max(2 * self._told, 1) or (self._ended and losses.total > self._told):
            self._told = losses.total
            new_notes.append(f"{self._where}: lost so far: {losses.summary_text()}")
        return new_notes

    def close(self) -> None:
        """See `Receiver`."""
        self._ended = True
        self._reader.stop()
        self._recording.close()


def open_file(path: Path, *, idle_s: float | None) -> OsiSource:
    """Return a source for a file, which is the recording itself."""
    return OsiSource(path, FileReceiver(path, idle_s=idle_s))


def open_standard_input(folder: Path, *, idle_s: float | None) -> OsiSource:
    """Return a source for standard input."""
    blocks = transports.blocks_of_descriptor(sys.stdin.fileno(), idle_s)
    return _stream_source("standard input", blocks, folder, [])


def open_tcp(host: str, port: int, folder: Path, *, idle_s: float | None) -> OsiSource:
    """Return a source for a writer that waits for a connection at an address."""
    notes: list[str] = []
    return _stream_source(f"tcp://{host}:{port}", transports.connect_and_read(host, port, idle_s, notes), folder, notes)


def open_tcp_server(host: str, port: int, folder: Path, *, idle_s: float | None) -> OsiSource:
    """Return a source for the first writer that connects to a port of this machine."""
    where = f"tcp-listen://{host}:{port}"
    server = transports.bound_socket(socket.SOCK_STREAM, host, port, where)
    server.listen(1)
    notes = transports.notes_on_open_address(host)
    with _closed_on_error(server):
        return _stream_source(where, transports.listen_and_read(server, idle_s, notes), folder, notes)


def open_udp(host: str, port: int, folder: Path, *, idle_s: float | None) -> OsiSource:
    """Return a source for messages that esmini sends to a port of this machine."""
    where = f"udp://{host}:{port}"
    receiver = transports.bound_socket(socket.SOCK_DGRAM, host, port, where)
    with _closed_on_error(receiver):
        recording, file = _open_new_recording(folder)
        notes = transports.notes_on_open_address(host)
        return OsiSource(recording, DatagramReceiver(where, receiver, file, notes, idle_s=idle_s))


@contextmanager
def _closed_on_error(bound_socket: socket.socket) -> Generator[None, None, None]:
    with ExitStack() as undo:
        undo.callback(bound_socket.close)
        yield
        undo.pop_all()


def _stream_source(where: str, blocks: Generator[bytes, None, None], folder: Path, notes: list[str]) -> OsiSource:
    recording, file = _open_new_recording(folder)
    return OsiSource(recording, StreamReceiver(where, blocks, file, notes))


def _open_new_recording(folder: Path) -> tuple[Path, BinaryIO]:
    """Open a recording under a new name, since recordings are never replaced. Errors: `UsageError` if it cannot be written."""
    for number in count(1):
        path = folder / (f"{RECORDING_NAME}.osi" if number == 1 else f"{RECORDING_NAME}-{number}.osi")
        try:
            folder.mkdir(parents=True, exist_ok=True)
            return path, path.open("xb")
        except FileExistsError:
            continue
        except OSError as error:
            raise UsageError(f"{path}: the recording cannot be written: {error.strerror or error}") from error
    raise AssertionError
