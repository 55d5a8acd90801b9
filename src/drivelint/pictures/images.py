"""Converts images to small JPEG files. Only this module imports Pillow, so that it is loaded only for a log with cameras."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from PIL import Image, UnidentifiedImageError

from drivelint.pictures.frames import EncodedImage, FrameError, RawImage

if TYPE_CHECKING:
    from numpy.typing import NDArray

LARGEST_WIDTH_AND_HEIGHT_PX: Final = (640, 480)
"""The greatest width and height of a picture."""
LOWER_QUALITY_ABOVE_BYTES: Final = 30_000
"""A larger picture is encoded with a lower quality; a noisy picture may still be a little larger then."""
_QUALITY, _LOW_QUALITY, _LEAST_QUALITY = 70, 35, 10
_ROWS_PER_BAND: Final = 16
"""The rows of a band: a JPEG has blocks of 16 rows where its colours have half the resolution."""
_BANDS_PER_SAMPLED_BAND: Final = 6
_ACCEPTED_IMAGE_FORMATS: Final = ("JPEG", "PNG", "WEBP")
_MOST_PIXELS: Final = 100_000_000
_PILLOW_MODES: Final = {
    "rgb8": ("RGB", "RGB", 3), "bgr8": ("RGB", "BGR", 3), "8UC3": ("RGB", "BGR", 3), "rgba8": ("RGB", "RGBX", 4),
    "bgra8": ("RGB", "BGRX", 4), "mono8": ("L", "L", 1), "8UC1": ("L", "L", 1),
}  # fmt: skip
"""Encoding of a raw image -> mode and raw mode of Pillow, bytes per pixel. In 8UC3, a name of OpenCV, blue is the first channel."""
_LUMA_INDEX: Final = {"yuv422": 1, "uyvy": 1, "yuv422_yuy2": 0, "yuyv": 0}
"""Encoding with two bytes per pixel -> which byte is the brightness."""
_COLOUR_FILTERS: Final = {f"bayer_{order}8": order for order in ("rggb", "bggr", "gbrg", "grbg")}


class Jpeg(NamedTuple):
    """A JPEG file and its size in pixels."""

    data: bytes
    width_px: int
    height_px: int


def small_jpeg(image: EncodedImage | RawImage | Image.Image) -> Jpeg:
    """Return an image as a JPEG of at most 640 by 480 pixels, without the metadata of its file. Errors: `FrameError`.

    Its sides are divided by a whole number, which takes a third of the time of any other scale.
    """
    try:
        pillow_image = _pillow_image(image)
        whole = pillow_image if pillow_image.mode == "RGB" else pillow_image.convert("RGB")
        small = whole.reduce(times) if (times := _shrink_factor(whole)) > 1 else whole
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise FrameError(f"an image that cannot be decoded ({error})") from error
    quality = _jpeg_quality_for_size(_estimated_jpeg_size_bytes(small))
    data = _jpeg_bytes(small, quality)
    if len(data) > LOWER_QUALITY_ABOVE_BYTES and quality == _QUALITY:  # the estimate was too low
        data = _jpeg_bytes(small, _jpeg_quality_for_size(len(data)))
    return Jpeg(data, *small.size)


def _jpeg_quality_for_size(bytes_at_full_quality: float) -> int:
    """Return the quality for an image whose JPEG of full quality has this many bytes."""
    if bytes_at_full_quality <= LOWER_QUALITY_ABOVE_BYTES:
        return _QUALITY
    return _LOW_QUALITY if bytes_at_full_quality < 2 * LOWER_QUALITY_ABOVE_BYTES else _LEAST_QUALITY


def _estimated_jpeg_size_bytes(image: Image.Image) -> float:
    """Return about how many bytes a JPEG of full quality has, from every sixth band of 16 rows: a sixth of the work of encoding it.

    An image of less than twelve bands is small at every quality: zero.
    """
    bands = image.height // _ROWS_PER_BAND
    if bands < 2 * _BANDS_PER_SAMPLED_BAND:
        return 0.0
    rows = np.asarray(image)[: bands * _ROWS_PER_BAND].reshape(bands, _ROWS_PER_BAND, image.width, 3)
    sample = rows[_BANDS_PER_SAMPLED_BAND // 2 :: _BANDS_PER_SAMPLED_BAND]
    data = _jpeg_bytes(Image.fromarray(sample.reshape(-1, image.width, 3)), _QUALITY)
    return len(data) * image.height / (len(sample) * _ROWS_PER_BAND)


def _jpeg_bytes(image: Image.Image, quality: int) -> bytes:
    sink = io.BytesIO()
    image.save(sink, "JPEG", quality=quality, exif=b"", comment=b"")
    return sink.getvalue()


def _pillow_image(image: EncodedImage | RawImage | Image.Image) -> Image.Image:
    if isinstance(image, RawImage):
        return _image_of_pixels(image)
    return _open_image(image) if isinstance(image, EncodedImage) else image


def _shrink_factor(image: Image.Image) -> int:
    """Return the whole number by which the sides of an image are divided."""
    return max(1, *(-(-side // limit) for side, limit in zip(image.size, LARGEST_WIDTH_AND_HEIGHT_PX, strict=True)))


def _open_image(image: EncodedImage) -> Image.Image:
    try:
        picture = Image.open(io.BytesIO(image.data), formats=_ACCEPTED_IMAGE_FORMATS)
        if picture.width * picture.height > _MOST_PIXELS:
            raise FrameError(f"an image of {picture.width} x {picture.height} pixels")
        times = _shrink_factor(picture)
        picture.draft(
            "RGB", (picture.width // times, picture.height // times)
        )  # a JPEG is decoded in the smallest size that is sufficient
    except UnidentifiedImageError as error:
        raise FrameError("an image that is no JPEG, PNG or WebP") from error
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise FrameError(f"an image that cannot be decoded ({error})") from error
    return picture


def _image_of_pixels(image: RawImage) -> Image.Image:
    """Return a raw image in Pillow's form; an image with a Bayer filter is returned at half its size."""
    mode, raw_mode, size = _PILLOW_MODES.get(image.encoding, ("", "", 2 if image.encoding in _LUMA_INDEX else 1))
    if not mode and image.encoding not in _LUMA_INDEX and image.encoding not in _COLOUR_FILTERS:
        raise FrameError(f"an image in {image.encoding!r}, which is not read")
    if image.width * size > image.step or image.height * image.step > len(image.data) or not image.width * image.height:
        raise FrameError(f"an image of {image.width} x {image.height} pixels in {len(image.data)} bytes")
    if mode:
        return Image.frombytes(mode, (image.width, image.height), image.data, "raw", raw_mode, image.step)
    rows = np.frombuffer(image.data, np.uint8, image.height * image.step).reshape(image.height, image.step)
    pixels = rows[:, : image.width * size].reshape(image.height, image.width, size)
    if size == 2:
        return Image.fromarray(_rgb_of_yuv(pixels, _LUMA_INDEX[image.encoding]))
    if min(pixels.shape[:2]) < 2:
        raise FrameError("an image smaller than its colour filter")
    return Image.fromarray(_rgb_of_colour_filter(pixels[:, :, 0], _COLOUR_FILTERS[image.encoding]))


def _rgb_of_colour_filter(pixels: NDArray[np.uint8], pattern: str) -> NDArray[np.uint8]:
    even = pixels[: pixels.shape[0] // 2 * 2, : pixels.shape[1] // 2 * 2]
    quarters = {i: even[i // 2 :: 2, i % 2 :: 2].astype(np.uint16) for i in range(4)}
    of = {colour: [quarters[i] for i, letter in enumerate(pattern) if letter == colour] for colour in "rgb"}
    return np.stack([(sum(of[colour]) // len(of[colour])) for colour in "rgb"], axis=2).astype(np.uint8)


def _rgb_of_yuv(pixels: NDArray[np.uint8], luma_index: int) -> NDArray[np.uint8]:
    """Return YUV 4:2:2 as RGB (ITU-R BT.601)."""
    even = pixels[:, : pixels.shape[1] // 2 * 2].astype(np.float32)
    y, chroma = even[:, :, luma_index], even[:, :, 1 - luma_index] - 128
    u, v = (np.repeat(chroma[:, i::2], 2, axis=1) for i in (0, 1))
    red, green, blue = y + 1.402 * v, y - 0.344 * u - 0.714 * v, y + 1.772 * u
    return np.asarray(np.clip(np.stack([red, green, blue], axis=2), 0, 255), np.uint8)
