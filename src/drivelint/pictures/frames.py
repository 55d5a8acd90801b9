"""Reads camera messages of several types: the time of the frame, and its encoded image.

ROS 2: https://docs.ros.org/en/rolling/p/sensor_msgs; Foxglove: https://docs.foxglove.dev/docs/sdk/schemas.
"""

from __future__ import annotations

import base64
import json
import struct
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol, Self

from drivelint.formats.ros2.cdr import BYTE_ORDERS, HEADER_BYTES
from drivelint.formats.ros2.types import short_type_name

if TYPE_CHECKING:
    from mcap.records import Channel, Schema
    from PIL.Image import Image


class FrameError(Exception):
    """A frame cannot be shown; the text states why."""


class EncodedImage(NamedTuple):
    """An image file: JPEG, PNG or WebP."""

    data: bytes


class RawImage(NamedTuple):
    """Rows of pixels, `step` bytes each, in an encoding of ROS."""

    width: int
    height: int
    encoding: str
    step: int
    is_big_endian: bool
    data: bytes


class VideoFrame(NamedTuple):
    """One frame of a video, which may need earlier frames for decoding."""

    codec: str
    data: bytes


class Frame(NamedTuple):
    """The content of a camera message; `stamp_ns`: when the frame was taken; None: the message has no time."""

    stamp_ns: int | None
    image: EncodedImage | RawImage | VideoFrame


class FramePlace(NamedTuple):
    """The place of a frame: its log time, file, channel, chunk, and offset in the unpacked chunk."""

    log_ns: int
    file: int
    channel: int
    chunk: int
    at: int


class FrameSource(Protocol):
    """The frames of the cameras of one log, by time. Errors of all methods: `FrameError`."""

    def __enter__(self) -> Self:
        """Open the log."""

    def __exit__(self, *_error: object) -> None:
        """Close the log."""

    def frame_places(self, topic: str, since_ns: int, until_ns: int) -> list[FramePlace]:
        """Return the places of a camera's frames with log times from `since_ns` to `until_ns`, in time order."""

    def stamp_ns(self, place: FramePlace) -> int | None:
        """Return when the frame at a place was taken, if the frame contains its time."""

    def picture(self, topic: str, place: FramePlace) -> EncodedImage | RawImage | Image:
        """Return the image at a place."""


class MessageSource(Protocol):
    """The messages of the cameras of one log, by time. Errors of all methods: `FrameError`."""

    def frame_places(self, topic: str, since_ns: int, until_ns: int) -> list[FramePlace]:
        """Return the places of a camera's frames with log times from `since_ns` to `until_ns`, in time order."""

    def frame(self, place: FramePlace) -> Frame:
        """Return the content of the message at a place."""


_KIND_OF_CAMERA_MESSAGE: Final = {
    ("cdr", "sensor_msgs/CompressedImage"): "ros image",
    ("cdr", "sensor_msgs/Image"): "ros raw",
    ("cdr", "foxglove_msgs/CompressedImage"): "cdr image",
    ("cdr", "foxglove_msgs/CompressedVideo"): "cdr video",
    ("protobuf", "foxglove.CompressedImage"): "image",
    ("protobuf", "foxglove.CompressedVideo"): "video",
    ("protobuf", "foxglove.RawImage"): "raw",
    ("json", "foxglove.CompressedImage"): "image",
    ("json", "foxglove.CompressedVideo"): "video",
    ("json", "foxglove.RawImage"): "raw",
}
"""Encoding and schema of a camera message -> the kind of its content, which decides how it is read."""
_TOPIC_WORDS_OF_NON_CAMERA_IMAGES: Final = (
    "depth",
    "disparity",
    "segmentation",
    "instance",
    "optical_flow",
    "mask",
    "dvs",
)
"""Words in the topics of images that are not camera pictures."""
_WORDS_OF_SIDE_VIEWS: Final = ("left", "right", "rear", "back", "side")


def is_camera(channel: Channel, schema: Schema) -> bool:
    """Return whether the messages of a channel are frames of a camera."""
    return has_pictures(channel.topic, schema.name, channel.message_encoding)


def has_pictures(topic: str, schema: str, encoding: str) -> bool:
    """Return whether the messages of a topic are frames of a camera. `schema`: name of their schema; `encoding`: their encoding."""
    is_known = (encoding, short_type_name(schema)) in _KIND_OF_CAMERA_MESSAGE
    return is_known and not any(word in topic.lower() for word in _TOPIC_WORDS_OF_NON_CAMERA_IMAGES)


def camera_sort_key(topic: str) -> tuple[int, str]:
    """Return the sort key of a camera's topic: cameras that look ahead come first."""
    name = topic.lower()
    is_aside = any(side in name for side in _WORDS_OF_SIDE_VIEWS)
    return (2 if is_aside else 0 if "front" in name else 1), topic


def camera_name(topic: str) -> str:
    """Return the name of a camera, which is the same for all topics with its frames."""
    return topic.removesuffix("/compressed").removesuffix("/image_raw").removesuffix("/image") or topic


def read_frame(channel: Channel, schema: Schema, data: bytes | memoryview) -> Frame:
    """Return the content of a camera message. Errors: `FrameError` if the message cannot be read."""
    kind = _KIND_OF_CAMERA_MESSAGE[channel.message_encoding, short_type_name(schema.name)]
    try:
        if channel.message_encoding == "cdr":
            return _cdr_frame(kind, _CdrReader(data))
        if channel.message_encoding == "json":
            return _foxglove_frame(kind, json.loads(bytes(data)))
        return _foxglove_frame(kind, _protobuf_fields(schema.name, schema.data, bytes(data)))
    except (struct.error, ValueError, KeyError, TypeError, IndexError) as error:
        raise FrameError(f"a message that cannot be read ({error})") from error


class _CdrReader:
    """Reads the members of one CDR message (XCDR1), one after another."""

    def __init__(self, data: bytes | memoryview) -> None:
        self._data = data
        self._at = HEADER_BYTES
        self._order = BYTE_ORDERS[data[1]]

    def read_number(self, code: str) -> Any:
        size = struct.calcsize(code)
        self._at += -(self._at - HEADER_BYTES) % size
        (value,) = struct.unpack_from(self._order + code, self._data, self._at)
        self._at += size
        return value

    def read_bytes(self) -> bytes:
        size = self.read_number("I")
        if size > len(self._data) - self._at:
            raise ValueError("it ends within its data")
        self._at += size
        return bytes(self._data[self._at - size : self._at])

    def read_text(self) -> str:
        return self.read_bytes().rstrip(b"\0").decode("utf-8", "replace")

    def read_stamp_ns(self) -> int | None:
        seconds, nanoseconds = self.read_number("i"), self.read_number("I")
        return seconds * 10**9 + nanoseconds or None


def _cdr_frame(kind: str, message: _CdrReader) -> Frame:
    stamp_ns = message.read_stamp_ns()
    message.read_text()  # the coordinate frame
    if kind == "ros image":
        message.read_text()  # the format, which the image file itself contains
        return Frame(stamp_ns, EncodedImage(message.read_bytes()))
    if kind == "ros raw":
        height, width, encoding = message.read_number("I"), message.read_number("I"), message.read_text()
        is_big_endian, step = bool(message.read_number("B")), message.read_number("I")
        return Frame(stamp_ns, RawImage(width, height, encoding, step, is_big_endian, message.read_bytes()))
    data, format_ = message.read_bytes(), message.read_text()
    return Frame(stamp_ns, VideoFrame(format_, data) if kind == "cdr video" else EncodedImage(data))


def _foxglove_frame(kind: str, fields: dict[str, Any]) -> Frame:
    timestamp = fields.get("timestamp") or {}
    seconds, part = timestamp.get("sec", timestamp.get("seconds", 0)), timestamp.get("nsec", timestamp.get("nanos", 0))
    stamp_ns = int(seconds) * 10**9 + int(part) or None
    data = fields["data"]
    data = base64.b64decode(data) if isinstance(data, str) else data
    if kind == "image":
        return Frame(stamp_ns, EncodedImage(data))
    if kind == "video":
        return Frame(stamp_ns, VideoFrame(fields.get("format", ""), data))
    width, height = int(fields["width"]), int(fields["height"])
    return Frame(stamp_ns, RawImage(width, height, fields["encoding"], int(fields["step"]), False, data))


def _protobuf_fields(type_name: str, schema_data: bytes, data: bytes) -> dict[str, Any]:
    """Return field name -> value of a message; the field `timestamp` becomes a dictionary of `sec` and `nsec`."""
    message = _message_class(type_name, schema_data).FromString(data)
    fields = {field.name: getattr(message, field.name) for field in message.DESCRIPTOR.fields}
    if "timestamp" in fields:
        fields["timestamp"] = {"sec": fields["timestamp"].seconds, "nsec": fields["timestamp"].nanos}
    return fields


@lru_cache(maxsize=16)
def _message_class(type_name: str, schema_data: bytes) -> Any:
    """Return the class of the messages that a schema record of the log describes. Errors: `FrameError`."""
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

    try:
        pool = descriptor_pool.DescriptorPool()
        for file in descriptor_pb2.FileDescriptorSet.FromString(schema_data).file:
            pool.Add(file)
        return message_factory.GetMessageClass(pool.FindMessageTypeByName(type_name))
    except Exception as error:
        raise FrameError(f"the log has no valid schema for the message type {type_name}") from error
