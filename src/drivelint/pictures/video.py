"""Frames of a video, by PyAV where it is installed: drivelint does not bring it, for its wheels hold codecs under the GPL."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from drivelint.pictures.frames import FrameError, VideoFrame

if TYPE_CHECKING:
    from PIL.Image import Image

    from drivelint.pictures.camera_log import CameraLog, Place

_LOOKED_BACK_NS: Final = 10_000_000_000
"""A frame that needs no other is looked for so far back."""
_CODECS: Final = {"h264": "h264", "h265": "hevc", "hevc": "hevc", "vp9": "vp9", "av1": "av1"}
_ENTRY_UNITS: Final = {"h264": lambda head: head & 0x1F == 5, "hevc": lambda head: 16 <= (head >> 1) & 0x3F <= 23}
"""Codec -> whether the first byte of a unit begins a picture that needs no other."""


def video_image(log: CameraLog, topic: str, place: Place) -> Image:
    """Return a frame of a video, decoded from the last one before it that needs no other. Errors: `FrameError`."""
    try:
        import av
    except ImportError:
        raise FrameError("a video, for which PyAV is not installed (pip install av)") from None
    waiting: list[VideoFrame] = []
    for each in reversed(log.places(topic, place.log_ns - _LOOKED_BACK_NS, place.log_ns)):
        image = log.frame(each).image
        if each > place or not isinstance(image, VideoFrame):
            continue
        waiting.append(image)
        if is_entry(image):
            break
    codec = _CODECS.get(waiting[0].codec.lower()) if waiting else None
    if codec is None:
        raise FrameError(f"a video in {waiting[0].codec if waiting else 'nothing'!r}, which is not read")
    decoded = _decoded(av, codec, [frame.data for frame in reversed(waiting)])
    if decoded is None:
        raise FrameError("a video without a frame that needs no other in the 10 s before")
    return decoded


def is_entry(frame: VideoFrame) -> bool:
    """Whether a frame needs no other; False where its codec does not say so by its units."""
    codec = _CODECS.get(frame.codec.lower(), "")
    if codec not in _ENTRY_UNITS:
        return False
    units = frame.data.split(b"\0\0\1")[1:]
    return any(unit and _ENTRY_UNITS[codec](unit[0]) for unit in units)


def _decoded(av: Any, codec: str, data: list[bytes]) -> Image | None:
    """Return the image of the last of some frames."""
    context = av.CodecContext.create(codec, "r")
    image: Image | None = None
    try:
        for packet in (*(av.Packet(each) for each in data), None):
            for frame in context.decode(packet):
                image = frame.to_image()
    except (av.error.FFmpegError, ValueError) as error:
        raise FrameError(f"a video that cannot be decoded ({error})") from error
    return image
