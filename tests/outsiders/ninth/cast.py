"""How the ego overtakes in many scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.outsiders.ninth.ways import Knots

FASTER: Knots = [(4, 13), (10, 23)]
SCHNELLER: Knots = [(4, 19), (10, 27.5)]
INDICATED = [(0.0, "off"), (2.0, "offside"), (8.0, "off"), (12.0, "near"), (16.0, "off")]


def out_and_back(width: float = 3.6, out: float = 5, back: float = 13, lasting: float = 3) -> Knots:
    """Return how far out it is: a lane's width, from when to when."""
    return [(out, 0), (out + lasting, width), (back, width), (back + lasting, 0)]
