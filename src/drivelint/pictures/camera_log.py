"""Finds the frames of a drive's cameras in its MCAP files by time, with the indexes of the files and without decoding images."""

from __future__ import annotations

import mmap
import struct
from contextlib import ExitStack
from functools import lru_cache
from typing import TYPE_CHECKING, Final, Self

import numpy as np

from drivelint.errors import TraceError
from drivelint.formats.mcap.chunk import ChunkError, chunk_records, parse_chunk
from drivelint.formats.mcap.counts import MESSAGE_INDEX_HEADER
from drivelint.formats.mcap.summary import Summary, read_index, read_summary
from drivelint.pictures.frames import (
    FrameError,
    FramePlace,
    camera_name,
    camera_sort_key,
    is_camera,
    read_frame,
)
from drivelint.pictures.message_frames import MessageFrameSource

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.pictures.frames import Frame

_RECORD_HEAD: Final = struct.Struct("<BQ")
_MESSAGE_HEAD: Final = struct.Struct("<HIQQ")
_MOST_CACHED_CHUNKS: Final = 4
"""How many unpacked chunks are kept: frames of the same time are often in the same chunk."""


def camera_topics(files: Sequence[Path]) -> tuple[str, ...]:
    """Return the topics of the cameras in the indexes of MCAP files; cameras that look ahead come first.

    If a camera has several topics, the topic with compressed frames is used.
    """
    of_camera: dict[str, str] = {}
    for summary in map(_summary_or_empty, files):
        for topic in sorted(
            _topics_with_camera_frames(summary), key=lambda topic: (topic.endswith("/compressed"), topic)
        ):
            of_camera[camera_name(topic)] = topic
    return tuple(sorted(of_camera.values(), key=camera_sort_key))


class McapFrameSource(MessageFrameSource):
    """The MCAP files of one drive, open for reading frames. Errors of all methods: `FrameError` for damaged data."""

    def __init__(self, files: Sequence[Path]) -> None:
        self._stack = ExitStack()
        self._views: list[memoryview] = []
        self._summaries: list[Summary] = []
        for path in files:
            file = self._stack.enter_context(path.open("rb"))
            self._views.append(memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)))
            self._summaries.append(read_summary(self._views[-1], may_lack_crc=True))
        self._chunk = lru_cache(maxsize=_MOST_CACHED_CHUNKS)(self._unpacked_chunk)
        self._index = lru_cache(maxsize=4096)(self._message_index)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._chunk.cache_clear()
        self._stack.close()

    def frame_places(self, topic: str, since_ns: int, until_ns: int) -> list[FramePlace]:
        """Return the places of a camera's frames with log times from `since_ns` to `until_ns`, in time order."""
        frame_places: list[FramePlace] = []
        for no, summary in enumerate(self._summaries):
            numbers = [number for number, channel in summary.channels.items() if channel.topic == topic]
            for chunk, (_, first_ns, last_ns) in summary.chunks.items():
                if last_ns < since_ns or first_ns > until_ns:
                    continue
                for number in numbers:
                    for log_ns, at in self._index(no, chunk, number):
                        if since_ns <= log_ns <= until_ns:
                            frame_places.append(FramePlace(log_ns, no, number, chunk, at))
        return sorted(frame_places)

    def frame(self, place: FramePlace) -> Frame:
        """Return the frame at a place."""
        records, summary = self._chunk(place.file, place.chunk), self._summaries[place.file]
        try:
            _, length = _RECORD_HEAD.unpack_from(records, place.at)
            body = memoryview(records)[place.at + _RECORD_HEAD.size : place.at + _RECORD_HEAD.size + length]
            number, *_ = _MESSAGE_HEAD.unpack_from(body)
        except struct.error as error:
            raise FrameError("an index that does not fit its messages") from error
        if number != place.channel or len(body) != length:
            raise FrameError("an index that does not fit its messages")
        channel = summary.channels[place.channel]
        return read_frame(channel, summary.schemas[channel.schema_id], body[_MESSAGE_HEAD.size :])

    def _message_index(self, file: int, chunk: int, channel: int) -> list[tuple[int, int]]:
        """Return log time and offset of each message of a channel in a chunk."""
        view, at = self._views[file], self._summaries[file].message_indexes.get(chunk, {}).get(channel)
        if at is None:
            return []
        try:
            _, length = _RECORD_HEAD.unpack_from(view, at)
            number, n_bytes = MESSAGE_INDEX_HEADER.unpack_from(view, at + _RECORD_HEAD.size)
        except struct.error as error:
            raise FrameError("a damaged index of messages") from error
        start = at + _RECORD_HEAD.size + MESSAGE_INDEX_HEADER.size
        if (
            number != channel
            or n_bytes != length - MESSAGE_INDEX_HEADER.size
            or n_bytes % 16
            or start + n_bytes > len(view)
        ):
            raise FrameError("a damaged index of messages")
        return [
            (int(log_ns), int(at)) for log_ns, at in np.frombuffer(view[start : start + n_bytes], "<u8").reshape(-1, 2)
        ]

    def _unpacked_chunk(self, file: int, chunk: int) -> bytes:
        view = self._views[file]
        try:
            _, length = _RECORD_HEAD.unpack_from(view, chunk)
            body = view[chunk + _RECORD_HEAD.size : chunk + _RECORD_HEAD.size + length]
            return chunk_records(parse_chunk(body), f"byte {chunk}")
        except (struct.error, ChunkError, TraceError) as error:
            raise FrameError(str(error)) from error


def _summary_or_empty(file: Path) -> Summary:
    try:
        return read_index(file)
    except (OSError, ValueError):
        return Summary()  # the file is missing or empty: reading the log reports it


def _topics_with_camera_frames(summary: Summary) -> list[str]:
    indexed = {number for of_chunk in summary.message_indexes.values() for number in of_chunk}
    return [
        channel.topic
        for number, channel in summary.channels.items()
        if number in indexed
        and (schema := summary.schemas.get(channel.schema_id)) is not None
        and is_camera(channel, schema)
    ]
