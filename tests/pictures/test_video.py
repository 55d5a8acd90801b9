"""A frame of a video is that frame: decoded from the last one before it that needs no other, where PyAV is installed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from drivelint.pictures.frames import Frame, FrameError, FramePlace, VideoFrame
from drivelint.pictures.images import small_jpeg
from drivelint.pictures.video import video_image
from tests.pictures.camera_bag import bars, number_in

N, EVERY_NS = 24, 100_000_000


class Log:
    """The frames of a video, without a file."""

    def __init__(self, frames: list[VideoFrame]) -> None:
        self.frames = frames

    def places(self, _topic: str, since_ns: int, until_ns: int) -> list[FramePlace]:
        times = [n * EVERY_NS for n in range(len(self.frames))]
        return [FramePlace(t_ns, 0, 1, 0, n) for n, t_ns in enumerate(times) if since_ns <= t_ns <= until_ns]

    def frame(self, place: FramePlace) -> Frame:
        return Frame(place.log_ns, self.frames[place.at])


def video(codec: str, encoder: str) -> list[VideoFrame]:
    """Return frames that show their own numbers, every eighth of which needs no other."""
    av = pytest.importorskip("av", reason="PyAV is not installed: pip install av")
    try:
        context = av.CodecContext.create(encoder, "w")
    except ValueError:
        pytest.skip(f"PyAV has no encoder {encoder} here")
    context.width, context.height, context.pix_fmt, context.framerate = 320, 192, "yuv420p", 10
    context.gop_size, context.max_b_frames = 8, 0
    context.options = {"tune": "zerolatency", "x265-params": "log-level=none:keyint=8:min-keyint=8:bframes=0"}
    images = [av.VideoFrame.from_ndarray(np.ascontiguousarray(bars(n, 320, 192)), "rgb24") for n in range(N)]
    for n, image in enumerate(images):
        image.pts = n
    packets: list[Any] = [packet for image in (*images, None) for packet in context.encode(image)]
    assert len(packets) == N
    return [VideoFrame(codec, bytes(packet)) for packet in packets]


@pytest.mark.parametrize(("codec", "encoder"), [("h264", "libx264"), ("h265", "libx265")])
def test_each_frame_is_that_frame(codec: str, encoder: str) -> None:
    log: Any = Log(video(codec, encoder))
    for n in (0, 5, 8, 15, 23):
        place = log.frame_places("", 0, n * EVERY_NS)[-1]
        assert number_in(small_jpeg(video_image(log, "", place)).data) == n


def test_without_a_frame_that_needs_no_other_there_is_no_picture() -> None:
    log: Any = Log(video("h264", "libx264")[1:6])
    with pytest.raises(FrameError):
        video_image(log, "", log.frame_places("", 0, 4 * EVERY_NS)[-1])


def test_other_codecs_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("av", reason="PyAV is not installed: pip install av")
    log: Any = Log([VideoFrame("mjpeg2000", b"x")])
    with pytest.raises(FrameError, match="mjpeg2000"):
        video_image(log, "", log.frame_places("", 0, 0)[-1])
