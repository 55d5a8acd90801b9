"""Finds the frames of a drive's cameras in its SQLite files by time, without decoding images."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, Self

from drivelint.errors import TraceError
from drivelint.formats.sqlite_bag.database import convert_sqlite_errors, open_database
from drivelint.formats.sqlite_bag.reader import SqliteFile
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
    import sqlite3
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.pictures.frames import Frame


def camera_topics(files: Sequence[Path]) -> tuple[str, ...]:
    """Return the topics of the cameras in SQLite files; cameras that look ahead come first, compressed frames are preferred."""
    of_camera: dict[str, str] = {}
    for path in files:
        index = SqliteFile(path).index()
        topics = [
            channel.topic for channel in index.channels.values() if is_camera(channel, index.schemas[channel.schema_id])
        ]
        for topic in sorted(topics, key=lambda topic: (topic.endswith("/compressed"), topic)):
            of_camera[camera_name(topic)] = topic
    return tuple(sorted(of_camera.values(), key=camera_sort_key))


class SqliteFrameSource(MessageFrameSource):
    """The SQLite files of one drive, open for reading frames.

    Errors: `OSError` if they can no longer be opened; of all methods `FrameError` for damaged data.
    """

    def __init__(self, files: Sequence[Path]) -> None:
        self._stack = ExitStack()
        self._paths = list(files)
        try:
            self._indexes = [SqliteFile(path).index() for path in files]
            self._open: list[sqlite3.Connection] = [self._stack.enter_context(open_database(path)) for path in files]
        except TraceError as error:  # it was readable when the drive was judged
            raise OSError(str(error)) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._stack.close()

    def frame_places(self, topic: str, since_ns: int, until_ns: int) -> list[FramePlace]:
        """Return the places of a camera's frames with log times from `since_ns` to `until_ns`, in time order."""
        places: list[FramePlace] = []
        for no, index in enumerate(self._indexes):
            number = next((channel.id for channel in index.channels.values() if channel.topic == topic), None)
            if number is None:
                continue
            query = (
                "SELECT messages.rowid, timestamp FROM messages JOIN topics ON topics.id = topic_id "
                "WHERE name = ? AND timestamp BETWEEN ? AND ?"
            )
            for row, t_ns in self._query_rows(no, query, topic, since_ns, until_ns):
                places.append(FramePlace(int(t_ns), no, number, 0, int(row)))
        return sorted(places)

    def frame(self, place: FramePlace) -> Frame:
        """Return the frame at a place."""
        rows = self._query_rows(place.file, "SELECT data FROM messages WHERE rowid = ?", place.at)
        if not rows or not isinstance(rows[0][0], bytes):
            raise FrameError(f"row {place.at} of messages, which has no data")
        index = self._indexes[place.file]
        channel = index.channels[place.channel]
        return read_frame(channel, index.schemas[channel.schema_id], rows[0][0])

    def _query_rows(self, file: int, query: str, *values: str | int) -> list[tuple[int | bytes, ...]]:
        try:
            with convert_sqlite_errors(self._paths[file]):
                return self._open[file].execute(query, values).fetchall()
        except TraceError as error:
            raise FrameError(str(error)) from error
