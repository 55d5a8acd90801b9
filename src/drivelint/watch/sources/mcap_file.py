"""A source of the messages of an MCAP file that another process writes. The file is the recording itself."""

from __future__ import annotations

import time
from collections import Counter, deque
from typing import TYPE_CHECKING, Final, cast

import numpy as np

from drivelint.drive.lost_time import LATEST_CREDIBLE_NS
from drivelint.formats.mcap.bag import OSI_SCHEMAS
from drivelint.formats.mcap.writer import Sink
from drivelint.watch.source import Frame, WindowFileSource
from drivelint.watch.sources.growing_file import GrowingFile
from drivelint.watch.sources.mcap_memory import ChannelMemory, is_watched, memory_for
from drivelint.watch.sources.mcap_scene import SceneMemory
from drivelint.watch.sources.mcap_stream import DamagedChunk, McapStream, MessageRecord, NumberedMessage
from drivelint.watch.sources.osi_static import StaticContent

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

MCAP_HEADER_LIBRARY: Final = "drivelint watch"
MOST_PENDING_BYTES: Final = 512 << 20
"""The most bytes of pending messages, those later than the start of the last window. No window is as large."""
MOST_BYTES_PER_READ: Final = 32 << 20
"""One `read` returns about this many bytes of messages at most, if the file is long when the watch begins."""


class McapSource(WindowFileSource):
    """A source of the messages of an MCAP file, see `drivelint.watch.source.Source`.

    A frame is a message that drivelint's readers read, at its log time, or a damaged chunk. Earlier messages that are still valid in a
    window are written into it, so a window must not start before the previous one.
    """

    window_name = "window.mcap"
    is_advanced_by_reads = False

    def __init__(self, path: Path, *, idle_s: float | None) -> None:
        self.recording = path
        self._file = GrowingFile(path, idle_s=idle_s)
        self._stream = McapStream(str(path))
        self._ended = False
        self._count = 0
        self._last_ns = 0
        self._pending: deque[NumberedMessage] = deque()  # messages after the start of the last window
        self._pending_bytes = 0
        self._memories: dict[int, ChannelMemory] = {}
        self._first: dict[int, NumberedMessage] = {}  # OSI channel -> its first message
        self._static: dict[int, StaticContent] = {}

    def read(self, timeout_s: float) -> Sequence[Frame] | None:
        """See `Source`."""
        until = time.monotonic() + timeout_s
        frames_read: list[Frame] = []
        size = 0
        while not self._ended and size < MOST_BYTES_PER_READ:
            data = self._file.read(0.0 if frames_read else max(until - time.monotonic(), 0.0))
            if data:
                frames = self._frames_of_records(self._stream.parse(data))
                frames_read += frames
                size += sum(frame.size for frame in frames)
            elif data is not None:
                break
            self._ended = data is None or self._stream.ended
            if time.monotonic() >= until:
                break
        return None if self._ended and not frames_read else frames_read

    def _frames_of_records(self, records: Iterable[MessageRecord | DamagedChunk]) -> list[Frame]:
        frames = []
        for record in records:
            if isinstance(record, DamagedChunk):
                frames.append(Frame(self._last_ns, (self._count, record), len(record.record)))
                continue
            schema = self._schema_name(record.channel)
            if not is_watched(schema):
                continue
            if record.log_ns <= LATEST_CREDIBLE_NS:  # a later time is malformed
                self._last_ns = record.log_ns
            numbered = NumberedMessage(self._count, record)
            self._count += 1
            if schema in OSI_SCHEMAS:
                self._first.setdefault(record.channel, numbered)
            self._pending.append(numbered)
            self._pending_bytes += len(record.record)
            while self._pending_bytes > MOST_PENDING_BYTES:
                self._move_oldest_pending_to_memory()
            frames.append(Frame(self._last_ns, numbered, len(record.record)))
        return frames

    def _schema_name(self, channel: int) -> str:
        schema = self._stream.schemas.get(self._stream.channels[channel].schema_id)
        return "" if schema is None else schema.name

    def notes(self) -> Sequence[str]:
        """See `Source`."""
        new_notes, self._stream.notes = self._stream.notes, []
        return new_notes

    def write_window(self, frames: Sequence[Frame], path: Path, *, may_omit_earlier_data: bool = False) -> None:
        """See `Source`."""
        records = [cast("tuple[int, MessageRecord | DamagedChunk]", frame.data) for frame in frames]
        begin = records[0][0] if records else 0
        while not may_omit_earlier_data and self._pending and self._pending[0].number < begin:
            self._move_oldest_pending_to_memory()
        begun: set[int] = set()
        with path.open("wb") as file:
            writer = _WindowWriter(Sink(file))
            writer.begin(self._stream)
            # the memory of a scene may contain entities that were replaced since the start of the last window
            memories = [
                item
                for item in self._memories.values()
                if not (may_omit_earlier_data and isinstance(item, SceneMemory))
            ]
            current = [item for memory in memories for item in memory.current_messages()]
            for numbered in sorted(current, key=lambda item: item.number):
                if numbered.number < begin:
                    writer.add(numbered.message)
            for number, item in records:
                if isinstance(item, DamagedChunk):
                    writer.add_damaged_chunk(item)
                    continue
                is_first = item.channel not in begun
                begun.add(item.channel)
                writer.add(self._with_static_content(number, item) if is_first else item)
            writer.finish()

    def _move_oldest_pending_to_memory(self) -> None:
        """Move the first pending message into the memory of its channel."""
        numbered = self._pending.popleft()
        self._pending_bytes -= len(numbered.message.record)
        channel = numbered.message.channel
        if channel not in self._memories:
            self._memories[channel] = memory_for(self._stream.channels[channel], self._schema_name(channel))
        self._memories[channel].add(numbered)

    def _with_static_content(self, number: int, message: MessageRecord) -> MessageRecord:
        """Return a window's first message of an OSI channel, with the static content of the file's first message."""
        first = self._first.get(message.channel)
        if first is None or first.number == number:
            return message
        if message.channel not in self._static:
            content = StaticContent(first.message.content, self._schema_name(message.channel))
            self._static[message.channel] = content
        return message.with_content(self._static[message.channel].add_to_message(message.content))

    def end_sender_if_possible(self) -> None:
        """See `Source`. The program that writes the file cannot be ended from here."""

    def close(self) -> None:
        """See `Source`."""
        self._file.close()


class _WindowWriter:
    """Writes messages of another file unchanged, with its schemas, channels and metadata."""

    _CHUNK: Final = 4 << 20

    def __init__(self, sink: Sink) -> None:
        self._sink = sink
        self._content: list[bytes] = []
        self._index: list[tuple[int, int, int]] = []  # channel, log time, offset within the chunk
        self._size = 0

    def begin(self, stream: McapStream) -> None:
        """Write the schemas, channels and metadata."""
        self._sink.begin(MCAP_HEADER_LIBRARY)
        for schema in stream.schemas.values():
            self._sink.write_schema(schema)
        for channel in stream.channels.values():
            self._sink.write_channel(channel)
        for name, content in stream.metadata.items():
            self._sink.add_metadata(name, content)

    def add(self, message: MessageRecord) -> None:
        """Write a message."""
        self._index.append((message.channel, message.log_ns, self._size))
        self._content.append(message.record)
        self._size += len(message.record)
        if self._size >= self._CHUNK:
            self._flush()

    def add_damaged_chunk(self, chunk: DamagedChunk) -> None:
        """Write a chunk that cannot be read, so that its content is missing in the window, too."""
        self._flush()
        self._sink.write(chunk.record)

    def finish(self) -> None:
        """End the file."""
        self._flush()
        self._sink.finish()

    def _flush(self) -> None:
        if not self._content:
            return
        channels = np.array([channel for channel, _, _ in self._index])
        entries = np.array([entry[1:] for entry in self._index], np.uint64)
        index = {number: entries[channels == number] for number in Counter(channels.tolist())}
        self._sink.add_chunk(b"".join(self._content), index, compressed=False)
        self._content, self._index, self._size = [], [], 0
