"""The scenes of the sixth outsider.

A place across the road is `u`: metres from its middle to the side that is driven on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.sixth.british_crossings import british_crossings
from tests.outsiders.sixth.british_following import british_following
from tests.outsiders.sixth.british_junctions import british_junctions
from tests.outsiders.sixth.british_motorways import british_motorways
from tests.outsiders.sixth.british_oddities import british_oddities
from tests.outsiders.sixth.british_overtaking import british_overtaking
from tests.outsiders.sixth.british_roads import british_roads
from tests.outsiders.sixth.german_following import german_following
from tests.outsiders.sixth.german_motorways import german_motorways
from tests.outsiders.sixth.german_oddities import german_oddities
from tests.outsiders.sixth.german_roads import german_roads
from tests.outsiders.sixth.german_systems import german_systems

if TYPE_CHECKING:
    from tests.outsiders.sixth.drive import Drive

CHAPTERS = (
    british_following,
    british_motorways,
    british_overtaking,
    british_roads,
    british_junctions,
    british_crossings,
    british_oddities,
    german_following,
    german_motorways,
    german_systems,
    german_roads,
    german_oddities,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
