"""The scenes of the ninth outsider: country roads, overtakes of many kinds, roundabouts, riders, and Germany's Landstraßen.

All is drawn as for traffic on the right, with the offside to the left, and mirrored for Great Britain.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.ninth.british_crossings import british_crossings
from tests.outsiders.ninth.british_junctions import british_junctions
from tests.outsiders.ninth.british_lines import british_lines
from tests.outsiders.ninth.british_motorways import british_motorways
from tests.outsiders.ninth.british_oddities import british_oddities
from tests.outsiders.ninth.british_overtaken import british_overtaken
from tests.outsiders.ninth.british_overtaking import british_overtaking
from tests.outsiders.ninth.british_riders import british_riders
from tests.outsiders.ninth.british_roundabouts import british_roundabouts
from tests.outsiders.ninth.british_speeds import british_speeds
from tests.outsiders.ninth.british_streets import british_streets
from tests.outsiders.ninth.german_crossings import german_crossings
from tests.outsiders.ninth.german_junctions import german_junctions
from tests.outsiders.ninth.german_motorways import german_motorways
from tests.outsiders.ninth.german_roads import german_roads
from tests.outsiders.ninth.german_systems import german_systems

if TYPE_CHECKING:
    from tests.outsiders.ninth.drive import Drive

CHAPTERS = (
    british_overtaking,
    british_lines,
    british_overtaken,
    british_oddities,
    british_riders,
    british_speeds,
    british_streets,
    british_crossings,
    british_junctions,
    british_roundabouts,
    british_motorways,
    german_roads,
    german_motorways,
    german_junctions,
    german_crossings,
    german_systems,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
