"""Takes the pictures of a run: stores which judged drives have cameras, and reads the chosen frames at the end of the run."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import pyarrow as pa

from drivelint.drive.trace import LOG_TIME_CHECK, FrameTimes
from drivelint.formats.mcap import trace as mcap
from drivelint.formats.mcap.bag import bag_files
from drivelint.formats.ros2.merge import SQLITE_FORMAT
from drivelint.pictures.camera_log import McapFrameSource, camera_topics
from drivelint.pictures.clock import DriveClock, nearest_frame
from drivelint.pictures.frames import FrameError
from drivelint.pictures.shots import SHOT_OFFSET_NS, planned_shots
from drivelint.result.counts import group_rows
from drivelint.result.schemas import empty_table
from drivelint.sql.store import arrow_schemas

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    import duckdb

    from drivelint.drive.trace import Trace
    from drivelint.engine.batch import Drive
    from drivelint.pictures.frames import FramePlace, FrameSource
    from drivelint.pictures.images import Jpeg
    from drivelint.pictures.shots import Shot
    from drivelint.result.model import Result


_MOST_CACHED_JPEGS: Final = 256
"""How many pictures are kept, each of some 30 kB."""
D123_FORMAT: Final = "123d"
"""The format of `drivelint.formats.d123`, whose modules are imported only for its logs."""


class DriveCameras(NamedTuple):
    """The log of a drive that has cameras: how to open it, the drive's clock, and the names of the cameras in the order of importance."""

    path: Path
    open_log: Callable[[], FrameSource]
    clock: DriveClock
    topics: tuple[str, ...]


class PictureTrouble(NamedTuple):
    """Why pictures of a log are missing."""

    path: Path
    text: str


class PictureTaker:
    """Stores the drives with cameras of each judged batch, and takes the pictures when all batches are judged."""

    def __init__(self) -> None:
        self._drives: dict[str, DriveCameras] = {}

    def __call__(self, _con: duckdb.DuckDBPyConnection, drives: Sequence[Drive], **_part: bool) -> None:
        """Store the drives of a batch whose logs have cameras."""
        for drive in drives:
            trace = drive.trace
            (format_,) = trace.tables["data_log"]["format"].to_pylist()
            if trace.drive_id not in self._drives and (cameras := _drive_cameras(trace, format_)) is not None:
                self._drives[trace.drive_id] = cameras

    @property
    def topics_by_drive(self) -> dict[str, tuple[str, ...]]:
        """drive_id -> topics of its cameras; only drives with cameras."""
        return {drive_id: drive.topics for drive_id, drive in self._drives.items()}

    def take_pictures(self, result: Result) -> tuple[pa.Table, list[PictureTrouble]]:
        """Return the table `picture` of a result, sorted, and why pictures are missing, each reason once per camera."""
        rows: list[dict[str, Any]] = []
        troubles: dict[PictureTrouble, None] = {}
        of_drives = group_rows(planned_shots(result, self.topics_by_drive), lambda shot: shot.drive_id)
        for drive_id, shots in sorted(of_drives.items()):
            drive = self._drives[drive_id]
            try:
                with drive.open_log() as log:
                    jpeg_of = _cached_jpeg_function(log)
                    for moment in sorted({(shot.t_ns, shot.camera_no) for shot in shots}):
                        moment_shots = [shot for shot in shots if (shot.t_ns, shot.camera_no) == moment]
                        rows += _picture_rows(log, drive, moment_shots, jpeg_of, troubles)
            except (OSError, ValueError) as error:  # ValueError: an empty file cannot be mapped
                troubles[PictureTrouble(drive.path, f"no pictures: the log cannot be read any more ({error})")] = None
        if not rows:
            return empty_table("picture"), list(troubles)
        return pa.Table.from_pylist(rows, schema=arrow_schemas()["picture"]), list(troubles)


def _drive_cameras(trace: Trace, format_: str) -> DriveCameras | None:
    """Return the cameras of a log; None: it has none."""
    if format_ in mcap.formats:
        files = tuple(bag_files(trace.path))
        has_log_times = LOG_TIME_CHECK in trace.tables["quality"]["check_id"].to_pylist()
        clock = DriveClock(trace.frame_times, uses_log_times=has_log_times)
        if format_ == SQLITE_FORMAT:
            from drivelint.pictures import sqlite_log

            if topics := sqlite_log.camera_topics(files):
                return DriveCameras(trace.path, lambda: sqlite_log.SqliteFrameSource(files), clock, topics)
        elif topics := camera_topics(files):
            return DriveCameras(trace.path, lambda: McapFrameSource(files), clock, topics)
    elif format_ == D123_FORMAT:
        from drivelint.formats.d123.reader import log_time_converter
        from drivelint.pictures.d123_log import D123FrameSource, camera_names

        if not (topics := camera_names(trace.path)):
            return None
        zero_ns = log_time_converter(trace.path).zero_us * 1000
        times = FrameTimes(np.array([0]), np.array([zero_ns], np.uint64))
        return DriveCameras(trace.path, lambda: D123FrameSource(trace.path), DriveClock(times), topics)
    return None


def _cached_jpeg_function(log: FrameSource) -> Callable[[str, FramePlace], Jpeg]:
    """Return a function that makes a small JPEG of a camera's frame; moments that are near each other share frames."""
    from drivelint.pictures.images import small_jpeg

    return lru_cache(maxsize=_MOST_CACHED_JPEGS)(lambda topic, place: small_jpeg(log.picture(topic, place)))


def _picture_rows(
    log: FrameSource, drive: DriveCameras, shots: Sequence[Shot], jpeg_of: Callable[[str, FramePlace], Jpeg],
    troubles: dict[PictureTrouble, None],
) -> list[dict[str, Any]]:  # fmt: skip
    """Return the rows of the shots of one moment by one camera, in time order; no frame is used twice."""
    topic = drive.topics[shots[0].camera_no]
    rows: list[dict[str, Any]] = []
    shown_places: set[FramePlace] = set()
    for shot in sorted(shots, key=lambda shot: (shot.shot != "at", SHOT_OFFSET_NS[shot.shot])):
        try:
            frame = nearest_frame(log, topic, drive.clock, shot.t_ns + SHOT_OFFSET_NS[shot.shot])
            if frame is None or frame[0] in shown_places:
                continue
            shown_places.add(frame[0])
            picture = jpeg_of(topic, frame[0])
        except FrameError as error:
            troubles.setdefault(PictureTrouble(drive.path, f"camera {topic}: no picture of {error}"))
            continue
        rows.append(
            {
                **shot._asdict(),
                "camera": topic,
                "t_frame_ns": frame[1],
                "width_px": picture.width_px,
                "height_px": picture.height_px,
            }
            | {"jpeg": picture.data}
        )
    return sorted(rows, key=lambda row: row["t_frame_ns"])
