"""Frames of cameras that are messages: the part that all containers of messages share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from drivelint.pictures.frames import VideoFrame

if TYPE_CHECKING:
    from PIL.Image import Image

    from drivelint.pictures.frames import EncodedImage, Frame, FramePlace, RawImage


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
        return self.frame(place).stamp_ns

    def picture(self, topic: str, place: FramePlace) -> EncodedImage | RawImage | Image:
        """Return the image at a place; a frame of a video is decoded."""
        image = self.frame(place).image
        if not isinstance(image, VideoFrame):
            return image
        from drivelint.pictures.video import video_image

        return video_image(self, topic, place)
