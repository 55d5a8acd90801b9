"""Finds the frames of the cameras of a 123D log by time: a file per camera, of which only the times are read until a frame is requested.

py123d 0.7.0 keeps frames as JPEG or PNG in the file, as numbers of frames of a video beside it, or as paths into the original data set.
"""

from __future__ import annotations

import mmap
from typing import TYPE_CHECKING, Final, NamedTuple, Self

import numpy as np
import pyarrow as pa

from drivelint.formats.d123.arrow_files import file_path
from drivelint.pictures.frames import EncodedImage, FrameError, FramePlace

if TYPE_CHECKING:
    from pathlib import Path

    from PIL.Image import Image

    from drivelint.arrays import Times

_CAMERA_FILE_PREFIX: Final = "camera."
_RANK_OF_DIRECTION: Final = {"f": 0, "l": 2, "r": 2, "b": 3, "d": 3}
"""First letter of the place of a camera (front, left, right, back, down) -> its rank; other cameras have rank 1."""


class _CameraFile(NamedTuple):
    """The open file of a camera. `t_us`: the times of its frames, `batches` and `rows`: where each is in the file, in time order."""

    name: str
    reader: pa.RecordBatchFileReader
    t_us: Times
    batches: Times
    rows: Times


def camera_names(folder: Path) -> tuple[str, ...]:
    """Return the names of the cameras of a log; cameras that look ahead come first. Depth and label images are no camera pictures."""
    names = [path.name.removesuffix(".arrow") for path in folder.glob(f"{_CAMERA_FILE_PREFIX}*.arrow")]
    return tuple(sorted(names, key=_camera_sort_key))


def _camera_sort_key(name: str) -> tuple[int, str]:
    _, _, place = name.rpartition("_")
    return _RANK_OF_DIRECTION.get(place[:1], 1) if place[1:].isdigit() else 1, name


class D123FrameSource:
    """The camera files of a 123D log, open for reading frames; its methods are those of `McapFrameSource`."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files: list[_CameraFile] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._files.clear()

    def frame_places(self, topic: str, since_ns: int, until_ns: int) -> list[FramePlace]:
        """Return the places of a camera's frames with times of the log from `since_ns` to `until_ns`, in time order."""
        number, file = self._number_and_file(topic)
        first, last = np.searchsorted(file.t_us, [-(-since_ns // 1000), until_ns // 1000 + 1])
        return [
            FramePlace(int(file.t_us[n]) * 1000, number, 0, int(file.batches[n]), int(file.rows[n]))
            for n in range(first, last)
        ]

    def stamp_ns(self, place: FramePlace) -> int | None:
        """Return None: the time of a frame is that of its row."""

    def picture(self, topic: str, place: FramePlace) -> EncodedImage | Image:
        """Return the image at a place; a frame of a video is decoded."""
        file = self._files[place.file]
        try:
            data = file.reader.get_batch(place.chunk).column(f"{topic}.data")[place.at].as_py()
        except (pa.ArrowException, KeyError, IndexError, OSError) as error:
            raise FrameError(f"a file that cannot be read ({error})") from error
        if isinstance(data, bytes):
            return EncodedImage(data)
        if isinstance(data, int):
            from drivelint.pictures.video import video_file_image

            return video_file_image(self._folder / f"{topic}.mp4", data)
        raise FrameError("a path into the original data set: convert it with the frames as JPEG" if data else "nothing")

    def _number_and_file(self, name: str) -> tuple[int, _CameraFile]:
        for number, file in enumerate(self._files):
            if file.name == name:
                return number, file
        try:
            self._files.append(_open_camera_file(self._folder, name))
        except (
            pa.ArrowException,
            KeyError,
            OSError,
            ValueError,
        ) as error:  # ValueError: an empty file cannot be mapped
            raise FrameError(f"a file that cannot be read ({error})") from error
        return len(self._files) - 1, self._files[-1]


def _open_camera_file(folder: Path, name: str) -> _CameraFile:
    """Open a camera's file and read the times of its frames, without the frames."""
    # opened by Python, so that a receipt of the run knows the file
    with file_path(folder, name).open("rb") as file:
        source = pa.BufferReader(pa.py_buffer(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)))
    column = pa.ipc.open_file(source).schema.get_field_index(f"{name}.timestamp_us")
    if column < 0:
        raise KeyError(f"no column {name}.timestamp_us")
    times_alone = pa.ipc.open_file(source, options=pa.ipc.IpcReadOptions(included_fields=[column]))
    times = [
        times_alone.get_batch(n).column(0).to_numpy(zero_copy_only=False) for n in range(times_alone.num_record_batches)
    ]
    t_us = np.concatenate([np.zeros(0, np.int64), *times]).astype(np.int64)
    batches = np.repeat(np.arange(len(times)), [len(part) for part in times])
    rows = np.concatenate([np.zeros(0, np.int64), *(np.arange(len(part)) for part in times)]).astype(np.int64)
    order = np.argsort(t_us, kind="stable")
    return _CameraFile(name, pa.ipc.open_file(source), t_us[order], batches[order], rows[order])
