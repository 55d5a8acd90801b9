"""The place of a SUMO net on the earth: its `location` element."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from lxml import etree

from drivelint.road.geo_reference import GeoFrame, why_unusable

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.arrays import Floats, Mask

NO_PROJECTION: Final = "!"
_BEYOND_M: Final = 100.0
"""So far a vehicle may be outside a net's boundary: that is of its nodes and middle lines, not of the places to park."""


class Location(NamedTuple):
    """A net's projection, the offset (x, y in metres) that was added to its coordinates (None: it cannot be read), its boundary."""

    reference: str
    offset: tuple[float, float] | None
    offset_text: str | None
    boundary: tuple[float, ...] | None

    def frame(self) -> GeoFrame | None:
        """Return how the net's coordinates become those of its projection; None: it has none, or its offset cannot be read."""
        if self.reference == NO_PROJECTION or self.offset is None:
            return None
        return GeoFrame(self.reference, -self.offset[0], -self.offset[1])

    def trouble(self) -> str | None:
        """Return why the net gives no places on the earth; None: it gives them."""
        if self.reference == NO_PROJECTION:
            return "it has no projection"
        frame = self.frame()
        if frame is None:
            return f"its netOffset is {self.offset_text!r}"
        west, south, east, north = self.boundary or (0.0, 0.0, 0.0, 0.0)
        found = why_unusable(frame, (west + east) / 2.0, (south + north) / 2.0)
        return found and f"of its projection {self.reference!r}: {found}"

    def surrounds(self, xy: Floats) -> Mask:
        """Return for places (n, 2) in the net's coordinates whether they lie in the net; none does if its boundary is not known."""
        if self.boundary is None:
            return np.zeros(len(xy), np.bool_)
        low, high = np.array(self.boundary).reshape(2, 2)
        inside: Mask = np.logical_and.reduce((xy > low - _BEYOND_M) & (xy < high + _BEYOND_M), axis=1)
        return inside


def location_of(element: etree._Element | None) -> Location:
    """Return the content of a `location` element; without one a net has no projection."""
    if element is None:
        return Location(NO_PROJECTION, None, None, None)
    offset, boundary = (_numbers(element.get(name)) for name in ("netOffset", "convBoundary"))
    return Location(
        element.get("projParameter", NO_PROJECTION).strip(),
        (offset[0], offset[1]) if len(offset) == 2 else None,
        element.get("netOffset"),
        boundary if len(boundary) == 4 else None,
    )


def read_location(net: Path) -> Location | None:
    """Read no more of a file than a net's `location`; None: it cannot be read, or is no net."""
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
            if tag == "junction":  # all that comes before edges is over
                break
    except (etree.XMLSyntaxError, OSError):
        return None
    return location_of(None) if root == "net" else None


def _numbers(text: str | None) -> tuple[float, ...]:
    try:
        return tuple(map(float, (text or "").split(",")))
    except ValueError:
        return ()
