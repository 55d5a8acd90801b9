"""The scenes of the eighth outsider, who drew interactions: who forces whom to brake, near misses, collisions, recorder faults.

Places across are metres to the left of the way that somebody goes (`left`); arms of a junction are named by their angle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.eighth.british_collisions import british_collisions
from tests.outsiders.eighth.british_crossings import british_crossings
from tests.outsiders.eighth.british_declared import british_declared
from tests.outsiders.eighth.british_driving import british_driving
from tests.outsiders.eighth.british_following import british_following
from tests.outsiders.eighth.british_junctions import british_junctions
from tests.outsiders.eighth.british_motorways import british_motorways
from tests.outsiders.eighth.british_overtaking import british_overtaking
from tests.outsiders.eighth.british_passing import british_passing
from tests.outsiders.eighth.british_systems import british_systems
from tests.outsiders.eighth.german_lanes import german_lanes
from tests.outsiders.eighth.german_others import german_others
from tests.outsiders.eighth.german_roads import german_roads
from tests.outsiders.eighth.german_speeds import german_speeds
from tests.outsiders.eighth.german_systems import german_systems
from tests.outsiders.eighth.roundabouts_and_more import roundabouts_and_more

if TYPE_CHECKING:
    from tests.outsiders.eighth.drive import Drive

CHAPTERS = (
    british_driving,
    british_passing,
    british_crossings,
    british_overtaking,
    british_following,
    british_junctions,
    british_collisions,
    british_motorways,
    british_declared,
    british_systems,
    german_speeds,
    german_lanes,
    german_roads,
    german_systems,
    german_others,
    roundabouts_and_more,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
