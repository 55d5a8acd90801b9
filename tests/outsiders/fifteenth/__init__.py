"""The scenes of the fifteenth outsider: British junctions, crossings, overtaking and motorways at length, and every pack.

A scene is drawn in a frame in which the ego drives along +x. Places across a road are told by u, towards the near side of the ego, so
that one drawing serves left-hand and right-hand traffic; the world that it is written in may be shifted and turned.
"""

from __future__ import annotations

from tests.outsiders.fifteenth import (
    comfort,
    crossings,
    declared,
    junctions,
    motorways,
    overtaking,
    roadside,
    systems,
    vulnerable,
)
from tests.outsiders.fifteenth.drives import Drive

CHAPTERS = (junctions, crossings, overtaking, vulnerable, roadside, motorways, systems, comfort, declared)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter.drives()]
