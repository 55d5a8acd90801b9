"""The scenes of the sixteenth outsider: Germany first, then what holds in both countries, then Great Britain.

Everything is drawn on roads on which the right is driven on; British drives are written as mirror images, so "left" in an
indicator or a look is the side of the oncoming traffic here. Each verdict has its reason; what a scene says is those reasons.
"""

from __future__ import annotations

from tests.outsiders.sixteenth.british_crossings import british_crossings
from tests.outsiders.sixteenth.british_gaps import british_gaps
from tests.outsiders.sixteenth.british_junctions import british_junctions
from tests.outsiders.sixteenth.british_roads import british_roads
from tests.outsiders.sixteenth.collisions import collisions
from tests.outsiders.sixteenth.comforts import comforts
from tests.outsiders.sixteenth.declarations import declarations
from tests.outsiders.sixteenth.drive import Drive
from tests.outsiders.sixteenth.german_gaps import german_gaps
from tests.outsiders.sixteenth.german_motorways import german_motorways
from tests.outsiders.sixteenth.german_roads import german_roads
from tests.outsiders.sixteenth.german_speeds import german_speeds
from tests.outsiders.sixteenth.german_systems import german_systems
from tests.outsiders.sixteenth.overtakes import overtakes

CHAPTERS = (
    german_gaps,
    german_speeds,
    german_motorways,
    german_roads,
    german_systems,
    comforts,
    declarations,
    overtakes,
    collisions,
    british_gaps,
    british_junctions,
    british_crossings,
    british_roads,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
