"""The scenes of the eleventh outsider: country roads first, then Germany, junctions, fast roads and driving systems.

Places across a road are metres from its middle, near side positive; those of a track are metres to the left of its path.
"""

from __future__ import annotations

from tests.outsiders.eleventh.british_crossings import british_crossings
from tests.outsiders.eleventh.british_cyclists import british_cyclists
from tests.outsiders.eleventh.british_fast_roads import british_fast_roads
from tests.outsiders.eleventh.british_hindrances import british_hindrances
from tests.outsiders.eleventh.british_horses import british_horses
from tests.outsiders.eleventh.british_junctions import british_junctions
from tests.outsiders.eleventh.british_overtakes import british_overtakes
from tests.outsiders.eleventh.british_roads import british_roads
from tests.outsiders.eleventh.declarations import declarations
from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.german_junctions import german_junctions
from tests.outsiders.eleventh.german_motorways import german_motorways
from tests.outsiders.eleventh.german_roads import german_roads
from tests.outsiders.eleventh.systems import systems

CHAPTERS = (
    british_horses,
    british_cyclists,
    british_overtakes,
    british_roads,
    british_hindrances,
    german_roads,
    german_junctions,
    german_motorways,
    british_junctions,
    british_crossings,
    british_fast_roads,
    systems,
    declarations,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
