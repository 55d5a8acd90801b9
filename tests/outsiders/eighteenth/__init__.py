"""The scenes of the eighteenth outsider: German motorways, automated systems and collisions, other German roads, Great Britain.

Places are given along the road (s) and to the side that is driven on (o): the middle of the road, or a motorway's border to the
middle, is o = 0. Each verdict has its reason; what a scene says is those reasons.
"""

from __future__ import annotations

from tests.outsiders.eighteenth import britain, motorways, systems, town
from tests.outsiders.eighteenth.drive import Drive

CHAPTERS = (motorways, systems, town, britain)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter.all_drives()]
