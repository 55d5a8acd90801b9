"""Encodes primitives of a `foxglove.SceneEntity`, in map coordinates, as protobuf."""

from __future__ import annotations

import math
from functools import cache
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from drivelint.formats.foxglove import messages as foxglove
from drivelint.formats.protobuf import wire

MAP_FRAME: Final = "map"
_CUBES, _LINES, _TRIANGLES, _TEXTS, _ARROWS = 8, 11, 12, 13, 7
_LABEL_FONT_SIZE_PX: Final = 14.0
Points = NDArray[np.float64]


class Colour(NamedTuple):
    """Red, green, blue and opacity, 0 to 1."""

    r: float
    g: float
    b: float
    a: float = 1.0

    def with_opacity(self, opacity: float) -> Colour:
        """Return the same colour with another opacity."""
        return self._replace(a=opacity)


def entity(name: str, log_time: int, primitives: bytes, facts: dict[str, str] | None = None) -> bytes:
    """Return a scene entity as a field of a SceneUpdate; `facts` are shown when a user clicks on the entity."""
    head = wire.time(1, log_time) + wire.text(2, MAP_FRAME) + wire.text(3, name)
    return wire.nested(2, head + facts_fields(facts or {}) + primitives)


def facts_fields(facts: dict[str, str]) -> bytes:
    """Return the fields of a scene entity that contain its facts."""
    return b"".join(wire.nested(6, wire.text(1, key) + wire.text(2, value)) for key, value in facts.items())


def deletion_of_all(log_time: int) -> bytes:
    """Return the deletion of everything shown before, as a field of a SceneUpdate."""
    return wire.nested(1, wire.time(1, log_time) + wire.integer(2, foxglove.DELETE_ALL))


@cache
def colour_field(field_number: int, colour: Colour) -> bytes:
    """Return a field that contains a colour."""
    return wire.nested(field_number, wire.doubles(*colour))


def pose(x: float, y: float, z: float, yaw: float = 0.0, *, field_number: int = 1) -> bytes:
    """Return a primitive's pose, rotated about the vertical axis: field 1 of all primitives except lines."""
    turned = wire.doubles(math.sin(yaw / 2), math.cos(yaw / 2), first_number=3)
    return wire.nested(field_number, wire.nested(1, wire.doubles(x, y, z)) + wire.nested(2, turned))


def line(xyz: Points, colour: Colour, *, thickness: float, line_type: int, pixels: bool = True) -> bytes:
    """Return a line. `thickness`: pixels, or metres without `pixels`. Points are relative to the first, which keeps them exact."""
    origin = pose(*map(float, xyz[0]), field_number=2)
    head = wire.integer(1, line_type) + origin + wire.doubles(thickness, first_number=3) + wire.integer(4, int(pixels))
    return wire.nested(_LINES, head + wire.points(5, xyz - xyz[0]) + colour_field(6, colour))


def ribbon(left: Points, right: Points, colour: Colour) -> bytes:
    """Return the area between two lines with the same number of points, as triangles."""
    origin, n = left[0], len(left)
    k = np.arange(n - 1, dtype=np.uint32)
    corners = np.stack([k, k + n, k + 1, k + 1, k + n, k + n + 1], axis=1)
    content = pose(*map(float, origin)) + wire.points(2, np.concatenate([left, right]) - origin)
    return wire.nested(_TRIANGLES, content + colour_field(3, colour) + wire.indices(5, corners.ravel()))


def label(x: float, y: float, z: float, text: str, colour: Colour) -> bytes:
    """Return a text that faces the viewer and has the same size at any distance."""
    look = wire.integer(2, 1) + wire.doubles(_LABEL_FONT_SIZE_PX, first_number=3) + wire.integer(4, 1)
    return wire.nested(_TEXTS, pose(x, y, z) + look + colour_field(5, colour) + wire.text(6, text))


def arrow(foot: tuple[float, float, float], yaw: float, length: float, colour: Colour) -> bytes:
    """Return a horizontal arrow from a point in direction `yaw`."""
    shape = wire.doubles(0.6 * length, 0.15, 0.4 * length, 0.5, first_number=2)
    return wire.nested(_ARROWS, pose(*foot, yaw) + shape + colour_field(6, colour))


def cube_without_pose(length: float, width: float, height: float, colour: Colour) -> bytes:
    """Return size and colour of a cube; its pose must be added."""
    return wire.nested(2, wire.doubles(length, width, height)) + colour_field(3, colour)


def cube_header(size: int) -> bytes:
    """Return the beginning of a cube that is `size` bytes long."""
    return wire.varint(_CUBES << 3 | 2) + wire.varint(size)
