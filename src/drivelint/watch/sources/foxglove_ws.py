"""A source of the messages of a Foxglove WebSocket server, recorded as MCAP."""

from __future__ import annotations

import re
from itertools import count
from typing import TYPE_CHECKING

from drivelint.errors import TraceError
from drivelint.watch.source import WindowFileSource
from drivelint.watch.sources.foxglove_client import FoxgloveClient
from drivelint.watch.sources.mcap_file import McapSource
from drivelint.watch.sources.recordings import McapRecording, convert_write_errors

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.watch.source import Frame
    from drivelint.watch.sources.recordings import LiveMessage


def open(name: str, folder: Path, *, idle_s: float | None = None) -> FoxgloveSource:  # noqa: A001
    """Return a source for `ws://HOST:PORT` or `wss://...` with its recording in `folder`.

    Errors: `UsageError` for an invalid address, or if the extra `live` is missing.
    """
    return FoxgloveSource(name, folder, idle_s=idle_s)


class FoxgloveSource(WindowFileSource):
    """A source of the messages that drivelint's MCAP readers read. It ends with the server, or after `idle_s` without messages.

    Frames and windows are read from the recording, a growing MCAP file. `read` waits until the server starts.
    Errors of `read`: `TraceError` if no such server answers.
    """

    window_name = "window.mcap"
    is_advanced_by_reads = False

    def __init__(self, uri: str, folder: Path, *, idle_s: float | None) -> None:
        self._uri = uri
        self._client = FoxgloveClient(uri, idle_s=idle_s)
        base = re.sub(r"[^\w.-]+", "-", uri.partition("://")[2]).strip("-.") or "live"
        names = (base if n == 1 else f"{base}_{n}" for n in count(1))
        self.recording = next(path for name in names if not (path := folder / f"{name}.mcap").exists())
        self._writer: McapRecording | None = None
        self._reader = McapSource(self.recording, idle_s=None)
        self._closed = False

    def read(self, timeout_s: float) -> Sequence[Frame] | None:
        """See `Source`."""
        messages = self._client.take(timeout_s)
        if not messages:
            return None if messages is None else []
        self._write_to_recording(messages)
        return self._reader.read(0.0)

    def _write_to_recording(self, messages: Sequence[LiveMessage]) -> None:
        with convert_write_errors(self.recording):
            if self._writer is None:
                self._writer = McapRecording(self.recording)
            self._writer.add(messages)

    def notes(self) -> Sequence[str]:
        """Return the new notes on the server and on the recording."""
        return [*self._client.notes(), *self._reader.notes()]

    def write_window(self, frames: Sequence[Frame], path: Path, *, may_omit_earlier_data: bool = False) -> None:
        """See `Source`. Errors: `TraceError` before the first message."""
        if self._writer is None:
            raise TraceError(f"{self._uri}: no message came")
        self._reader.write_window(frames, path, may_omit_earlier_data=may_omit_earlier_data)

    def end_sender_if_possible(self) -> None:
        """See `Source`. The sender of the messages cannot be ended from here."""

    def close(self) -> None:
        """Close the connection, and finish the recording with the messages that were not taken."""
        rest = self._client.close()
        if self._closed:
            return
        self._closed = True
        if rest:
            self._write_to_recording(rest)
        self._reader.close()
        if self._writer is not None:
            with convert_write_errors(self.recording):
                self._writer.finish()
