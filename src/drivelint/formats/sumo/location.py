"""The geodetic frame of a SUMO net: its `location` element."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from lxml import etree

from drivelint.road.geo_reference import GeoFrame, why_unusable

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.arrays import Floats, Mask

NO_PROJECTION: Final = "!"
_BOUNDARY_MARGIN_M: Final = 100.0
"""How far outside a net's boundary a vehicle may be: the boundary includes nodes and centre lines, but not parking areas."""


class Location(NamedTuple):
    """A net's projection, the offset (x, y in metres) that was added to its coordinates, and its boundary; None: cannot be read."""

    reference: str
    offset: tuple[float, float] | None
    offset_text: str | None
    boundary: tuple[float, ...] | None

    def geo_frame(self) -> GeoFrame | None:
        """Return the geodetic frame of the net's coordinates; None: it has no projection, or its offset cannot be read."""
        if self.reference == NO_PROJECTION or self.offset is None:
            return None
        return GeoFrame(self.reference, -self.offset[0], -self.offset[1])

    def why_unconvertible(self) -> str | None:
        """Return why the net's coordinates cannot be converted to longitude and latitude; None if they can."""
        if self.reference == NO_PROJECTION:
            return "it has no projection"
        frame = self.geo_frame()
        if frame is None:
            return f"its netOffset is {self.offset_text!r}"
        west, south, east, north = self.boundary or (0.0, 0.0, 0.0, 0.0)
        reason = why_unusable(frame, (west + east) / 2.0, (south + north) / 2.0)
        return reason and f"of its projection {self.reference!r}: {reason}"

    def is_in_net(self, xy: Floats) -> Mask:
        """Return for places (n, 2) in the net's coordinates whether they lie in the net; False if its boundary is not known."""
        if self.boundary is None:
            return np.zeros(len(xy), np.bool_)
        low, high = np.array(self.boundary).reshape(2, 2)
        inside: Mask = np.logical_and.reduce((xy > low - _BOUNDARY_MARGIN_M) & (xy < high + _BOUNDARY_MARGIN_M), axis=1)
        return inside


def location_of(element: etree._Element | None) -> Location:
    """Return the content of a `location` element; without this element, a net has no projection."""
    if element is None:
        return Location(NO_PROJECTION, None, None, None)
    offset, boundary = (_numbers_in_text(element.get(name)) for name in ("netOffset", "convBoundary"))
    return Location(
        element.get("projParameter", NO_PROJECTION).strip(),
        (offset[0], offset[1]) if len(offset) == 2 else None,
        element.get("netOffset"),
        boundary if len(boundary) == 4 else None,
    )


def read_location(net: Path) -> Location | None:
    """Return the `location` of a net without reading the whole file; None if the file cannot be read, or is not a net."""
    try:
        root = None
        for _, element in etree.iterparse(
            str(net), events=("start",), resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False
        ):
            tag = element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""
            root = root or tag
            if root != "net":
                return None
            if tag == "location":
                return location_of(element)
            if tag == "junction":  # there is no `location` after the first junction
                break
    except (etree.XMLSyntaxError, OSError):
        return None
    return location_of(None) if root == "net" else None


def _numbers_in_text(text: str | None) -> tuple[float, ...]:
    try:
        return tuple(map(float, (text or "").split(",")))
    except ValueError:
        return ()
