"""An object of the map at its place."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from lxml import etree

    from drivelint.arrays import Floats
    from drivelint.formats.opendrive.network import Road

_KIND_BY_TYPE = {
    "crosswalk": "crossing", "parkingSpace": "parking_space", "obstacle": "obstacle", "barrier": "barrier",
    "railing": "barrier", "guardRail": "barrier", "soundBarrier": "barrier", "wall": "barrier", "pole": "pole",
    "streetLamp": "pole", "signalPole": "pole", "rail-pole": "pole", "guide-post": "pole", "tree": "tree",
    "vegetation": "tree", "building": "building", "trafficIsland": "island", "roadMark": "marking",
    "stopLine": "stop_line",
}  # fmt: skip
_KIND_BY_NAME_PART = (
    ("stopline_pedestrian", "marking"),  # RoadRunner's edge of a pedestrian crossing, right across the road
    ("stopline", "stop_line"), ("stop_line", "stop_line"), ("crosswalk", "crossing"), ("zebra", "crossing"),
    ("parking", "parking_space"), ("stencil", "marking"), ("crosshatch", "marking"), ("chevron", "marking"),
    ("solid", "marking"), ("dashed", "marking"), ("signpost", "pole"), ("pole", "pole"), ("building", "building"),
    ("tree", "tree"), ("island", "island"), ("barrier", "barrier"), ("fence", "barrier"), ("railing", "barrier"),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class PlacedObject:
    """One object in the map; the outline is (n, 2) map metres, None for a point."""

    road: Road
    element: etree._Element
    object_id: str
    s: float
    x: float
    y: float
    outline: Floats | None

    @cached_property
    def kind(self) -> str:
        """The kind of the object, by its type, else by its name; a cross path is a crossing."""
        if self.element.tag == "crossPath":
            return "crossing"
        name = (self.element.get("name") or "").lower()
        by_name = next((kind for part, kind in _KIND_BY_NAME_PART if part in name), "other")
        return _KIND_BY_TYPE.get(self.element.get("type", ""), by_name)

    def road_object_row(self) -> dict[str, Any]:
        """Return the row of `road_object`."""
        outline = None if self.outline is None else counter_clockwise(self.outline)
        return {
            "object_id": self.object_id, "kind": self.kind, "name": self.element.get("name") or None,
            "road_id": self.road.road_id, "road_s_m": self.s, "x_m": self.x, "y_m": self.y,
            "outline_x_m": None if outline is None else outline[:, 0].tolist(),
            "outline_y_m": None if outline is None else outline[:, 1].tolist(),
        }  # fmt: skip


def counter_clockwise(outline: Floats) -> Floats:
    """Return the corners with the inside on the left; a closing corner that repeats the first is dropped."""
    if len(outline) > 1 and np.allclose(outline[0], outline[-1], atol=1e-6):
        outline = outline[:-1]
    x, y = (outline - outline[0]).T
    area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    return outline if area >= -1e-6 else outline[::-1]  # the area of a line is 0 except for rounding: keep its order
