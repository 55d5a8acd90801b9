"""Frames of cameras that are messages: the part that all containers of messages share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Final

from drivelint.pictures.frames import VideoFrame

if TYPE_CHECKING:
    from collections.abc import Callable

    from PIL.Image import Image

    from drivelint.pictures.frames import EncodedImage, Frame, FramePlace, RawImage


_MOST_CACHED_STAMPS: Final = 65_536
"""How many stamps are kept: moments of a drive that are near each other search the same frames."""


class MessageFrameSource(ABC):
    """The files of one drive, open for reading frames. Errors of all methods: `FrameError` for damaged data."""

    @abstractmethod
    def frame_places(self, topic: str, since_ns: int, until_ns: int) -> list[FramePlace]:
        """Return the places of a camera's frames with log times from `since_ns` to `until_ns`, in time order."""

    @abstractmethod
    def frame(self, place: FramePlace) -> Frame:
        """Return the frame at a place."""

    def stamp_ns(self, place: FramePlace) -> int | None:
        """Return when the frame at a place was taken, by its message; None: the message has no time."""
        return self._cached_stamp_function(place)

    @cached_property
    def _cached_stamp_function(self) -> Callable[[FramePlace], int | None]:
        return lru_cache(maxsize=_MOST_CACHED_STAMPS)(lambda place: self.frame(place).stamp_ns)

    def picture(self, topic: str, place: FramePlace) -> EncodedImage | RawImage | Image:
        """Return the image at a place; a frame of a video is decoded."""
        image = self.frame(place).image
        if not isinstance(image, VideoFrame):
            return image
        from drivelint.pictures.video import video_image

        return video_image(self, topic, place)
