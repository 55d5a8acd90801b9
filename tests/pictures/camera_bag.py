"""A bag, written by rosbags, of an ego that drives into a parked car, with two cameras whose frames show their own numbers.

The front camera sends JPEG, and late; the left one raw pixels. A frame is eight black or white bars: the bits of its number.
"""

from __future__ import annotations

import io
from collections.abc import Container
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tests.formats.ros2 import ros_log as ros

T0 = 1_700_000_000.0
LENGTH_S = 8.0
FRONT, LEFT = "/camera/front/image_raw/compressed", "/camera/left/image_raw"
EVERY_S = {FRONT: 0.1, LEFT: 0.2}
FIRST_S = {FRONT: 0.033, LEFT: 0.07}
LATE_S = {FRONT: 0.25, LEFT: 0.04}
"""From when a frame is taken until it is recorded: longer than from one frame to the next."""
BITS = 8


def taken_s(topic: str) -> NDArray[np.float64]:
    """Return when the frames of a camera were taken, in seconds from the start."""
    return np.arange(FIRST_S[topic], LENGTH_S, EVERY_S[topic])


def bars(number: int, width: int = 640, height: int = 360) -> NDArray[np.uint8]:
    """Return the pixels of a frame, red, green and blue: the bits of its number from left to right, the lowest first, on grey."""
    pixels = np.full((height, width, 3), 96, np.uint8)
    for bit in range(BITS):
        pixels[height // 4 : 3 * height // 4, bit * width // BITS : (bit + 1) * width // BITS] = 255 * (
            number >> bit & 1
        )
    return pixels


def number_in(jpeg: bytes) -> int:
    """Return the number that a picture shows."""
    row = np.asarray(Image.open(io.BytesIO(jpeg)).convert("L"))
    middle = row[row.shape[0] // 2]
    return sum(int(middle[(2 * bit + 1) * len(middle) // (2 * BITS)] > 127) << bit for bit in range(BITS))


def jpeg(pixels: NDArray[np.uint8], form: str = "JPEG", quality: int = 75) -> bytes:
    """Return pixels as an image file."""
    sink = io.BytesIO()
    Image.fromarray(pixels).save(sink, form, quality=quality)
    return sink.getvalue()


def write_bag(
    folder: Path, *, cameras: bool = True, noise: bool = False, contacts: int = 1, damaged: Container[int] = (),
    storage: StoragePlugin = StoragePlugin.MCAP, states_late_s: float = 0.01,
) -> Path:  # fmt: skip
    """Write the bag. `noise`: the frames are of random pixels, which no encoder makes small; `contacts`: people in the way, 3 m apart.

    `damaged`: numbers of frames of the front camera that are no image; `states_late_s`: from the time of a state until it is recorded.
    """
    store = get_typestore(Stores.ROS2_HUMBLE)
    for name in ("shape_msgs/SolidPrimitive", "derived_object_msgs/Object", "derived_object_msgs/ObjectArray"):
        store.register(get_types_from_msg(ros.BASE[name], name.replace("/", "/msg/")))
    messages: list[tuple[float, str, str, bytes]] = []
    for n in range(int(LENGTH_S / 0.05)):
        t_s = T0 + 0.05 * n
        cars = [ros.thing(9, 45.0, 0.0)] if contacts == 1 else [_person(9 + k, 12.0 + 3.0 * k) for k in range(contacts)]
        for topic, name, _, content in (ros.odometry(t_s, 10 * 0.05 * n, 0.0, 0.0, 10.0), ros.things(t_s, *cars)):
            messages.append((t_s + states_late_s, topic, name, ros.encode(name, content)))
    rng = np.random.default_rng(1)
    for topic in (FRONT, LEFT) if cameras else ():
        for n, t_s in enumerate(taken_s(topic)):
            pixels = rng.integers(0, 256, (360, 640, 3), np.uint8) if noise else bars(n)
            kind, data = _image(store, topic, T0 + t_s, pixels, is_damaged=topic == FRONT and n in damaged)
            messages.append((T0 + t_s + LATE_S[topic], topic, kind, data))
    folder.parent.mkdir(parents=True, exist_ok=True)
    with Writer(folder, version=9, storage_plugin=storage) as writer:
        topics: dict[str, Any] = {}
        for t_s, topic, kind, data in sorted(messages, key=lambda each: each[0]):
            if topic not in topics:
                topics[topic] = writer.add_connection(topic, kind.replace("/", "/msg/"), typestore=store)
            writer.write(topics[topic], round(t_s * 1e9), data)
    return folder


def _person(number: int, x_m: float) -> dict[str, Any]:
    return ros.thing(number, x_m, 0.0, classification=4, shape={"type": 1, "dimensions": [0.5, 0.5, 1.7]})


def _image(store: Any, topic: str, t_s: float, pixels: NDArray[np.uint8], *, is_damaged: bool) -> tuple[str, bytes]:
    types = store.types
    stamp = ros.stamp(t_s)
    header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](**stamp), "camera")
    if topic == FRONT:
        kind = "sensor_msgs/CompressedImage"
        file = np.frombuffer(b"no image" if is_damaged else jpeg(pixels), np.uint8)
        message = types["sensor_msgs/msg/CompressedImage"](header, "bgr8; jpeg compressed bgr8", file)
    else:
        kind, (height, width, _) = "sensor_msgs/Image", pixels.shape
        data = np.ascontiguousarray(pixels[:, :, ::-1]).reshape(-1)
        message = types["sensor_msgs/msg/Image"](header, height, width, "bgr8", 0, 3 * width, data)
    return kind, bytes(store.serialize_cdr(message, kind.replace("/", "/msg/")))
