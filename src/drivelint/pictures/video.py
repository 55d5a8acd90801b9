"""Decodes frames of a video with PyAV, if it is installed. drivelint does not require PyAV, whose wheels contain codecs under the GPL."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from drivelint.pictures.frames import FrameError, VideoFrame

if TYPE_CHECKING:
    from pathlib import Path

    from PIL.Image import Image

    from drivelint.pictures.frames import FramePlace, MessageSource

_KEY_FRAME_SEARCH_NS: Final = 10_000_000_000
"""A key frame, which can be decoded alone, is searched in this time before the wanted frame."""
_CODECS: Final = {"h264": "h264", "h265": "hevc", "hevc": "hevc", "vp9": "vp9", "av1": "av1"}
_IS_KEY_FRAME_UNIT: Final = {"h264": lambda head: head & 0x1F == 5, "hevc": lambda head: 16 <= (head >> 1) & 0x3F <= 23}
"""Codec -> whether a unit with this first byte belongs to a key frame."""


def video_image(log: MessageSource, topic: str, place: FramePlace) -> Image:
    """Return a frame of a video, decoded from the last key frame up to it. Errors: `FrameError`."""
    av = _pyav()
    waiting: list[VideoFrame] = []
    for frame_place in reversed(log.frame_places(topic, place.log_ns - _KEY_FRAME_SEARCH_NS, place.log_ns)):
        image = log.frame(frame_place).image
        if frame_place > place or not isinstance(image, VideoFrame):
            continue
        waiting.append(image)
        if is_known_key_frame(image):
            break
    codec = _CODECS.get(waiting[0].codec.lower()) if waiting else None
    if codec is None:
        raise FrameError(f"a video in {waiting[0].codec if waiting else 'nothing'!r}, which is not read")
    decoded = _last_image(av, codec, [frame.data for frame in reversed(waiting)])
    if decoded is None:
        raise FrameError("a video without a frame that needs no other in the 10 s before")
    return decoded


def video_file_image(path: Path, frame_number: int) -> Image:
    """Return a frame of a video file by its number, from 0, decoded from the last key frame up to it. Errors: `FrameError`."""
    av = _pyav()
    try:
        with av.open(str(path)) as container:
            stream = container.streams.video[0]
            times = sorted(packet.pts for packet in container.demux(stream) if packet.pts is not None)
            if not 0 <= frame_number < len(times):
                raise FrameError(f"frame {frame_number} of a video of {len(times)} frames")
            container.seek(times[frame_number], stream=stream)
            for decoded in container.decode(stream):
                if decoded.pts == times[frame_number]:
                    image: Image = decoded.to_image()
                    return image
    except (av.FFmpegError, OSError, IndexError, ValueError) as error:
        raise FrameError(f"a video that cannot be decoded ({error})") from error
    raise FrameError(f"a video without its frame {frame_number}")


def _pyav() -> Any:
    try:
        import av
    except ImportError:
        raise FrameError("a video, for which PyAV is not installed (pip install av)") from None
    return av


def is_known_key_frame(frame: VideoFrame) -> bool:
    """Return whether a frame is a key frame; False if the units of its codec do not show this."""
    codec = _CODECS.get(frame.codec.lower(), "")
    if codec not in _IS_KEY_FRAME_UNIT:
        return False
    units = frame.data.split(b"\0\0\1")[1:]
    return any(unit and _IS_KEY_FRAME_UNIT[codec](unit[0]) for unit in units)


def _last_image(av: Any, codec: str, data: list[bytes]) -> Image | None:
    """Return the image of the last of several frames; None: no image was decoded."""
    context = av.CodecContext.create(codec, "r")
    image: Image | None = None
    try:
        for packet in (*(av.Packet(frame_data) for frame_data in data), None):
            for frame in context.decode(packet):
                image = frame.to_image()
    except (av.error.FFmpegError, ValueError) as error:
        raise FrameError(f"a video that cannot be decoded ({error})") from error
    return image
