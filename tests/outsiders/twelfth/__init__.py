"""The scenes of the twelfth outsider: Great Britain first, then Germany.

Roads go along x; y is to the left of that, so the near side is at y > 0 in Great Britain and at y < 0 in Germany. Each verdict has
its reason; what a scene says is those reasons.
"""

from __future__ import annotations

from tests.outsiders.twelfth.british_crossings import british_crossings
from tests.outsiders.twelfth.british_declared import british_declared
from tests.outsiders.twelfth.british_junctions import british_junctions
from tests.outsiders.twelfth.british_motorways import british_motorways
from tests.outsiders.twelfth.british_overtaking import british_overtaking
from tests.outsiders.twelfth.british_passing import british_passing
from tests.outsiders.twelfth.british_roads import british_roads
from tests.outsiders.twelfth.drive import Drive
from tests.outsiders.twelfth.german_motorways import german_motorways
from tests.outsiders.twelfth.german_roads import german_roads
from tests.outsiders.twelfth.german_systems import german_systems

CHAPTERS = (
    british_roads,
    british_passing,
    british_overtaking,
    british_motorways,
    british_junctions,
    british_crossings,
    british_declared,
    german_motorways,
    german_roads,
    german_systems,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
