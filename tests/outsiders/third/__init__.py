"""The scenes of the third outsider: Great Britain first, and for Germany the whole scene mirrored.

A place across the road is `d`: metres to the left of the way that the vehicle goes (right, in a mirrored scene). The name of a
scene that another outsider has drawn too ends in 3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.third.british_crossings import british_crossings
from tests.outsiders.third.british_junctions import british_junctions
from tests.outsiders.third.british_motorways import british_motorways
from tests.outsiders.third.british_oddities import british_oddities
from tests.outsiders.third.british_overtaking import british_overtaking
from tests.outsiders.third.british_roads import british_roads
from tests.outsiders.third.german_motorways import german_motorways
from tests.outsiders.third.german_oddities import german_oddities
from tests.outsiders.third.german_roads import german_roads
from tests.outsiders.third.german_systems import german_systems

if TYPE_CHECKING:
    from tests.outsiders.third.drive import Drive


CHAPTERS = (
    british_overtaking,
    british_roads,
    british_motorways,
    british_junctions,
    british_crossings,
    british_oddities,
    german_motorways,
    german_systems,
    german_roads,
    german_oddities,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
