"""The scenes of the fourth outsider: Germany first, and for Great Britain the whole scene mirrored.

`near` is the side of the kerb (right in Germany, left in Great Britain) and `far` that of the oncoming traffic. The name of a
scene that another outsider has drawn too ends in 4.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.fourth.british_crossings import british_crossings
from tests.outsiders.fourth.british_junctions import british_junctions
from tests.outsiders.fourth.british_motorways import british_motorways
from tests.outsiders.fourth.british_roads import british_roads
from tests.outsiders.fourth.german_comfort import german_comfort
from tests.outsiders.fourth.german_motorways import german_motorways
from tests.outsiders.fourth.german_roads import german_roads
from tests.outsiders.fourth.german_systems import german_systems

if TYPE_CHECKING:
    from tests.outsiders.fourth.drive import Drive


CHAPTERS = (
    german_systems,
    german_comfort,
    german_motorways,
    german_roads,
    british_roads,
    british_motorways,
    british_junctions,
    british_crossings,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
