"""The scenes of the twentieth outsider: junctions, crossings, roads between them, motorways.

Everything is drawn in terms of the near side, which is the left where the left is driven on: the same scene works in Great Britain
and in Germany. Offsets across a road or lane are positive towards the near side.
"""

from __future__ import annotations

from tests.outsiders.twentieth import beside, crossings, lights, motorways, obstacles, open_roads, overtaking, turns
from tests.outsiders.twentieth.drive import Drive

CHAPTERS = (lights, turns, crossings, obstacles, beside, overtaking, open_roads, motorways)


def drives() -> list[Drive]:
    """Return every drive; the names end as all of this outsider do."""
    found = [drive for chapter in CHAPTERS for drive in chapter.drives()]
    for drive in found:
        drive.name += "_v"
    return found
