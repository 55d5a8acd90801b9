"""The shapes of CommonRoad obstacles: their boxes, and the offsets of the box centres from the recorded positions.

A state records the position of the shape's origin. The offset of the box centre from this origin is given in one of two ways:

* `originXShift` of a rectangle or truck (written by commonroad-io 2026.1): how far the origin lies ahead of the centre, along the obstacle.
* `center` and `orientation` of a rectangle or circle (2018b, 2020a; read by commonroad-io 2024.3): centre and rotation of the box in the
  frame of the shape. The format does not say whether that frame turns with the obstacle; commonroad-io 2024.3 adds the centre without
  turning it. Where the two interpretations differ, the place of the box is not known.

commonroad-io 2024.3 rotates a polygon about its centroid, 2026.1 about its origin: its centre is known only where both agree.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.arrays import rotate_vectors
from drivelint.drive.box_centre import lever_to_centre
from drivelint.drive.trace import QualityFinding
from drivelint.formats import safe_xml
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lxml import etree

    from drivelint.arrays import Floats

SAME_PLACE_TOLERANCE_M: Final = 0.01
"""Two interpretations of a box's place that differ by less agree: positions are accurate to a centimetre at best."""
_POLYGON: Final = "a polygon"
_TRAILER: Final = "a truck with its trailer"
_SEVERAL_SHAPES: Final = "several shapes"
_UNSUPPORTED_SHAPE: Final = "a shape that is not supported"


class ObstacleShape(NamedTuple):
    """The box of an obstacle in metres and radians, NaN where it is not known.

    `ahead_m`: how far its centre lies ahead of the origin, along the obstacle. `centre_m`: x and y of the centre in the frame of the
    shape. `turn_rad`: the box's heading minus the obstacle's. `no_box`: what the shape is instead of a box, '' for a box.
    """

    length_m: float = math.nan
    width_m: float = math.nan
    ahead_m: float = 0.0
    centre_m: tuple[float, float] = (0.0, 0.0)
    turn_rad: float = 0.0
    no_box: str = ""


def read_shape(obstacle: etree._Element) -> ObstacleShape:
    """Return the shape of an obstacle, with NaN for a number that cannot be read and for an origin outside the box."""
    parts = [part for part in obstacle.iterfind("shape/*") if isinstance(part.tag, str)]
    if len(parts) == 1 and parts[0].tag == "truckShape":
        return _rectangle(parts[0].find("truckDims"), parts[0])
    if len(parts) == 1 and parts[0].tag == "rectangle":
        return _rectangle(parts[0], parts[0])
    if len(parts) == 1 and parts[0].tag == "circle":
        # the box is the square around the circle
        size = 2.0 * safe_xml.number_or_nan(parts[0].findtext("radius"))
        return ObstacleShape(size, size, centre_m=_centre(parts[0]))
    if len(parts) == 1 and (truck := parts[0].find("truckShape")) is not None:
        # the recorded position is that of the truck; how far the trailer extends depends on the hitch angle
        ahead = _rectangle(truck.find("truckDims"), truck).ahead_m
        return ObstacleShape(ahead_m=ahead, no_box=_TRAILER)
    if len(parts) == 1 and parts[0].tag == "polygon":
        return ObstacleShape(centre_m=_bounding_box_centre(parts[0]), no_box=_POLYGON)
    several = len(parts) > 1 or any(part.tag == "shapeGroup" for part in parts)
    return (
        ObstacleShape(ahead_m=math.nan, no_box=_SEVERAL_SHAPES) if several else ObstacleShape(no_box=_UNSUPPORTED_SHAPE)
    )


def _rectangle(size: etree._Element | None, origin: etree._Element) -> ObstacleShape:
    """Return a box. `size`: the element with length and width; `origin`: the element that states where the shape's origin lies."""
    if size is None:
        return ObstacleShape(ahead_m=math.nan, no_box=_UNSUPPORTED_SHAPE)
    length, width = (safe_xml.number_or_nan(size.findtext(name)) for name in ("length", "width"))
    shift = _child_number(origin, "originXShift")
    if abs(shift) > length / 2:
        shift = math.nan
    return ObstacleShape(length, width, -shift, _centre(origin), _child_number(origin, "orientation"))


def _centre(element: etree._Element) -> tuple[float, float]:
    centre = element.find("center")
    return (0.0, 0.0) if centre is None else (_child_number(centre, "x"), _child_number(centre, "y"))


def _bounding_box_centre(polygon: etree._Element) -> tuple[float, float]:
    """Return the centre of a polygon's bounding rectangle along the axes of its frame."""
    corners = np.array(
        [[_child_number(p, axis) for axis in "xy"] for p in polygon.iterfind("point")], np.float64
    ).reshape(-1, 2)
    if not len(corners):
        return math.nan, math.nan
    x, y = (corners.min(axis=0) + corners.max(axis=0)) / 2
    return float(x), float(y)


def _child_number(parent: etree._Element, name: str) -> float:
    """Return the number of a child element, 0 without one; NaN if it is not a number."""
    text = parent.findtext(name)
    return 0.0 if text is None else safe_xml.number_or_nan(text)


def box_offsets(shape: ObstacleShape, yaw_rad: Floats) -> Floats:
    """Return the vectors (2, n) from the origin to the box centre in metres, for these headings (n,) of an obstacle; NaN: not known."""
    n = len(yaw_rad)
    offset = lever_to_centre(np.full(n, shape.ahead_m), np.zeros(n), yaw_rad)
    if shape.centre_m == (0.0, 0.0):
        return offset
    along_axes = np.tile(np.array(shape.centre_m)[:, None], (1, n))
    along_obstacle = np.stack(rotate_vectors(along_axes[0], along_axes[1], yaw_rad))
    agree = np.hypot(*(along_obstacle - along_axes)) <= SAME_PLACE_TOLERANCE_M
    if shape.ahead_m != 0.0:
        agree[:] = False  # both offsets are given: it is not known whether one includes the other
    return offset + np.where(agree, along_axes, np.nan)


def shape_findings(
    ids: Sequence[str], shapes: Sequence[ObstacleShape], unplaced: Sequence[bool]
) -> list[QualityFinding]:
    """Return findings on obstacles without a known box, and on obstacles with states where the place of the box is unknown (`unplaced`)."""
    findings = []
    for form in sorted({shape.no_box for shape in shapes} - {""}):
        names = [name for name, shape in zip(ids, shapes, strict=True) if shape.no_box == form]
        message = f"{form} instead of a box: length and width of {name_list(names)} are not known"
        findings.append(QualityFinding.of_actors("no_box", "warning", message, names))
    if names := [name for name, is_unplaced in zip(ids, unplaced, strict=True) if is_unplaced]:
        message = (
            f"the position of the boxes of {name_list(names)} relative to their states is not known: give only "
            "originXShift, a number within the box (the format does not define whether a center turns with the "
            "obstacle)"
        )
        findings.append(QualityFinding.of_actors("shape_origin", "warning", message, names))
    return findings
