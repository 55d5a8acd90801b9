"""Reads CommonRoad's environment obstacles (buildings, pillars, median strips) as outlines. Their shapes are in the scenario's frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from drivelint.drive.outlines.shapes import Outline, box_shape
from drivelint.formats import safe_xml

if TYPE_CHECKING:
    from lxml import etree


def environment_outlines(root: etree._Element) -> tuple[list[Outline], list[str]]:
    """Return the outlines of environment obstacles, and the ids of those with a shape that cannot be read."""
    outlines: list[Outline] = []
    unread: list[str] = []
    for obstacle in root.findall("environmentObstacle"):
        name = str(obstacle.get("id"))
        shapes = [_shape(part) for part in obstacle.iterfind("shape/*") if isinstance(part.tag, str)]
        shape = shapely.unary_union(shapes) if shapes else shapely.Point()
        if any(part.is_empty for part in shapes) or shape.is_empty:
            unread.append(name)
        kind = (obstacle.findtext("type") or "obstacle").strip()
        outlines += [] if shape.is_empty else [Outline(f"{kind} {name}", shape)]
    return outlines, unread


def _shape(element: etree._Element) -> shapely.Geometry:
    """Return a rectangle, circle or polygon; an empty point for anything else, and for a number that cannot be read."""
    x, y = (_number(element, f"center/{axis}", 0.0) for axis in "xy")
    if element.tag == "rectangle":
        numbers = (x, y, _number(element, "orientation", 0.0), _number(element, "length"), _number(element, "width"))
        return box_shape(*numbers) if np.isfinite(numbers).all() else shapely.Point()
    if element.tag == "circle":
        radius = _number(element, "radius")
        return shapely.Point(x, y).buffer(radius) if np.isfinite([x, y, radius]).all() else shapely.Point()
    corners = np.array([[_number(point, axis) for axis in "xy"] for point in element.iterfind("point")]).reshape(-1, 2)
    if element.tag != "polygon" or len(corners) < 3 or not np.isfinite(corners).all():
        return shapely.Point()
    return shapely.make_valid(shapely.Polygon(corners))


def _number(parent: etree._Element, path: str, default: float = np.nan) -> float:
    text = parent.findtext(path)
    return default if text is None else safe_xml.number_or_nan(text)
