"""What messages of cameras say, in every encoding that is read; what cannot be read is a `FrameError`."""

from __future__ import annotations

import base64
import json
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2
from hypothesis import given
from hypothesis import strategies as st
from mcap.records import Channel, Schema
from PIL import Image

from drivelint.pictures.frames import (
    EncodedImage,
    FrameError,
    RawImage,
    VideoFrame,
    camera_sort_key,
    is_camera,
    read_frame,
)
from drivelint.pictures.images import LOWER_QUALITY_ABOVE_BYTES, small_jpeg
from drivelint.pictures.video import is_known_key_frame
from tests.formats.ros2 import ros_log as ros
from tests.pictures.camera_bag import bars, jpeg, number_in

TYPES = {
    **ros.BASE,
    "sensor_msgs/CompressedImage": "std_msgs/Header header\nstring format\nuint8[] data",
    "sensor_msgs/Image": (
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data"
    ),
}
FOXGLOVE = {
    "CompressedImage": "timestamp 1 T, data 2 bytes, format 3 string, frame_id 4 string",
    "CompressedVideo": "timestamp 1 T, frame_id 2 string, data 3 bytes, format 4 string",
    "RawImage": "timestamp 1 T, width 2 fixed32, height 3 fixed32, encoding 4 string, step 5 fixed32, data 6 bytes, frame_id 7 string",
}
STAMP_NS = 1_700_000_000_250_000_000
SMALL = bars(42, 64, 32)


def channel(encoding: str, topic: str = "/camera/front") -> Channel:
    return Channel(1, topic, encoding, {}, 1)


def ros_message(name: str, order: str = "<", **content: Any) -> tuple[Channel, Schema, bytes]:
    stamp = {"sec": STAMP_NS // 10**9, "nanosec": STAMP_NS % 10**9}
    value = {"header": {"stamp": stamp, "frame_id": "camera"}, **content}
    return channel("cdr"), Schema(1, b"", "ros2msg", name.replace("/", "/msg/")), ros.encode(name, value, TYPES, order)


def foxglove_message(name: str, **content: Any) -> tuple[Channel, Schema, bytes]:
    file = descriptor_pb2.FileDescriptorProto(name="camera.proto", package="foxglove", syntax="proto3")
    file.dependency.append("google/protobuf/timestamp.proto")
    described = file.message_type.add(name=name)
    for text in FOXGLOVE[name].split(", "):
        field, number, kind = text.split()
        added = described.field.add(name=field, number=int(number), label=1)
        added.type = {"T": 11, "bytes": 12, "string": 9, "fixed32": 7}[kind]  # type: ignore[assignment]
        if kind == "T":
            added.type_name = ".google.protobuf.Timestamp"
    files = descriptor_pb2.FileDescriptorSet()
    timestamp_pb2.DESCRIPTOR.CopyToProto(files.file.add())
    files.file.append(file)
    pool = descriptor_pool.DescriptorPool()
    for each in files.file:
        pool.Add(each)
    message: Any = message_factory.GetMessageClass(pool.FindMessageTypeByName(f"foxglove.{name}"))(**content)
    message.timestamp.FromNanoseconds(STAMP_NS)
    return (
        channel("protobuf"),
        Schema(1, files.SerializeToString(), "protobuf", f"foxglove.{name}"),
        message.SerializeToString(),
    )


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("form", ["JPEG", "PNG", "WEBP"])
def test_compressed_images_of_ros(form: str, order: str) -> None:
    data = jpeg(SMALL, form)
    frame = read_frame(*ros_message("sensor_msgs/CompressedImage", order, format=form, data=list(data)))
    assert frame == (STAMP_NS, EncodedImage(data))
    assert number_in(small_jpeg(EncodedImage(data)).data) == 42


def _raw(encoding: str) -> tuple[bytes, int]:
    """Return the bars in an encoding, each row with 4 bytes behind it, and the bytes of a row."""
    grey = SMALL[:, :, 0]
    pixels = {
        "rgb8": SMALL, "bgr8": SMALL, "rgba8": np.dstack([SMALL, grey]), "bgra8": np.dstack([SMALL, grey]), "mono8": grey,
        "yuv422": np.dstack([np.full_like(grey, 128), grey]), "yuyv": np.dstack([grey, np.full_like(grey, 128)]),
        "bayer_rggb8": grey, "bayer_gbrg8": grey,
    }[encoding]  # fmt: skip
    rows = np.ascontiguousarray(pixels).reshape(len(grey), -1)
    padded = np.pad(rows, ((0, 0), (0, 4)))
    return padded.tobytes(), padded.shape[1]


@pytest.mark.parametrize(
    "encoding", ["rgb8", "bgr8", "rgba8", "bgra8", "mono8", "yuv422", "yuyv", "bayer_rggb8", "bayer_gbrg8"]
)
def test_raw_images_of_ros(encoding: str) -> None:
    data, step = _raw(encoding)
    message = ros_message("sensor_msgs/Image", height=32, width=64, encoding=encoding, step=step, data=list(data))
    stamp_ns, image = read_frame(*message)
    assert stamp_ns == STAMP_NS
    assert isinstance(image, RawImage)
    assert number_in(small_jpeg(image).data) == 42


def test_blue_first_is_not_red_first() -> None:
    red = np.zeros((16, 16, 3), np.uint8)
    red[:, :, 0] = 255
    for encoding, pixels in (("rgb8", red), ("bgr8", red[:, :, ::-1])):
        shown = small_jpeg(RawImage(16, 16, encoding, 48, False, pixels.tobytes()))
        red_mean, _, blue_mean = _mean(shown.data)
        assert red_mean > 200
        assert blue_mean < 100


def _mean(data: bytes) -> Any:
    import io

    from PIL import Image

    return np.asarray(Image.open(io.BytesIO(data))).mean(axis=(0, 1))


def test_images_of_foxglove_in_protobuf_and_json() -> None:
    data = jpeg(SMALL)
    assert read_frame(*foxglove_message("CompressedImage", data=data, format="jpeg")) == (STAMP_NS, EncodedImage(data))
    assert read_frame(*foxglove_message("CompressedVideo", data=b"abc", format="h264")) == (
        STAMP_NS,
        VideoFrame("h264", b"abc"),
    )
    raw = read_frame(
        *foxglove_message("RawImage", width=64, height=32, encoding="rgb8", step=192, data=SMALL.tobytes())
    )
    assert isinstance(raw.image, RawImage)
    assert number_in(small_jpeg(raw.image).data) == 42
    said = {
        "timestamp": {"sec": 1_700_000_000, "nsec": 250_000_000},
        "data": base64.b64encode(data).decode(),
        "format": "jpeg",
    }
    as_json = channel("json"), Schema(1, b"", "jsonschema", "foxglove.CompressedImage"), json.dumps(said).encode()
    assert read_frame(*as_json) == (STAMP_NS, EncodedImage(data))


@given(st.binary(max_size=80), st.integers(0, 60))
def test_damage_is_told(noise: bytes, length: int) -> None:
    messages = [
        ros_message("sensor_msgs/CompressedImage", format="jpeg", data=list(jpeg(SMALL))),
        ros_message("sensor_msgs/Image", height=32, width=64, encoding="rgb8", step=192, data=list(SMALL.tobytes())),
    ]
    for camera, schema, data in messages:
        for damaged in (data[:4] + noise, data[: 4 + length]):
            with suppress(FrameError):
                image = read_frame(camera, schema, damaged).image
                assert isinstance(image, (EncodedImage, RawImage))
                small_jpeg(image)


def test_a_picture_is_small_whatever_it_shows() -> None:
    noise = np.random.default_rng(0).integers(0, 256, (1080, 1920, 3), np.uint8)
    shown = small_jpeg(EncodedImage(jpeg(noise)))
    assert (shown.width_px, shown.height_px) == (480, 270)  # a quarter
    assert len(shown.data) <= LOWER_QUALITY_ABOVE_BYTES


@pytest.mark.parametrize(("first", "last"), [(0, 360), (0, 180), (180, 360), (170, 190), (0, 0)])
def test_the_quality_follows_the_whole_picture(first: int, last: int) -> None:
    """A part of the rows is of noise: a sixth of the rows tells whether full quality is too large."""
    pixels = np.full((360, 640, 3), 90, np.uint8)
    pixels[first:last] = np.random.default_rng(0).integers(0, 256, (last - first, 640, 3), np.uint8)
    shown, full = small_jpeg(Image.fromarray(pixels)), jpeg(pixels, quality=70)
    same_tables = shown.data[:600] == full[:600]  # those of quantisation
    assert same_tables == (len(full) <= LOWER_QUALITY_ABOVE_BYTES)
    assert len(shown.data) <= 1.1 * LOWER_QUALITY_ABOVE_BYTES


def test_what_shows_no_picture_is_no_camera() -> None:
    schema = Schema(1, b"", "ros2msg", "sensor_msgs/msg/Image")
    assert is_camera(channel("cdr", "/carla/hero/rgb_front/image"), schema)
    assert not is_camera(channel("cdr", "/carla/hero/depth_front/image"), schema)
    assert not is_camera(channel("cdr"), Schema(1, b"", "ros2msg", "sensor_msgs/msg/PointCloud2"))
    topics = ["/cam/back", "/cam/front_left", "/cam/front", "/cam/main"]
    assert sorted(topics, key=camera_sort_key) == ["/cam/front", "/cam/main", "/cam/back", "/cam/front_left"]


def test_frames_of_a_video_that_need_no_other() -> None:
    assert is_known_key_frame(VideoFrame("h264", b"\0\0\0\1\x67abc\0\0\0\1\x65abc"))
    assert not is_known_key_frame(VideoFrame("h264", b"\0\0\0\1\x41abc"))
    assert is_known_key_frame(VideoFrame("h265", b"\0\0\0\1\x40\1a\0\0\1\x26\1abc"))
    assert not is_known_key_frame(VideoFrame("h265", b"\0\0\0\1\x02\1abc"))
