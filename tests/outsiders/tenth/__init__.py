"""The scenes of the tenth outsider: Great Britain first, then Germany.

Places across a road are offsets `t` of OpenDRIVE, and the offsets of an actor are metres to the left of its way. Each verdict
has its reason; what a scene says is those reasons.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.tenth.british_junctions import british_junctions
from tests.outsiders.tenth.british_lights import british_lights
from tests.outsiders.tenth.british_motorways import british_motorways
from tests.outsiders.tenth.british_oddities import british_oddities
from tests.outsiders.tenth.british_roads import british_roads
from tests.outsiders.tenth.british_signalled_crossings import british_signalled_crossings
from tests.outsiders.tenth.british_zebras import british_zebras
from tests.outsiders.tenth.german_motorways import german_motorways
from tests.outsiders.tenth.german_roads import german_roads
from tests.outsiders.tenth.german_systems import german_systems

if TYPE_CHECKING:
    from tests.outsiders.tenth.drive import Drive


CHAPTERS = (
    british_zebras,
    british_signalled_crossings,
    british_lights,
    british_junctions,
    british_roads,
    british_motorways,
    british_oddities,
    german_motorways,
    german_roads,
    german_systems,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
