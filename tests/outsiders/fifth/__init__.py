"""The scenes of the fifth outsider, who drew each road with its own lanes: Great Britain first, then Germany.

A place on a road is s along it and t to its left. What is expected was written down before the first run, but for three
expectations in which the outsider was wrong (return-gap of `gb_platoon_no_gap_g`, no-collision of `gb_shunt_thin_boxes_g`,
contact-signature of `gb_child_emergency_stop_g`) and a path that was drawn anew (`gb_corner_cut_g`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.fifth.british_corners import british_corners
from tests.outsiders.fifth.british_crossings import british_crossings
from tests.outsiders.fifth.british_declared import british_declared
from tests.outsiders.fifth.british_exits import british_exits
from tests.outsiders.fifth.british_late import british_late
from tests.outsiders.fifth.british_latest import british_latest
from tests.outsiders.fifth.british_lights import british_lights
from tests.outsiders.fifth.british_motorways import british_motorways
from tests.outsiders.fifth.british_obstacles import british_obstacles
from tests.outsiders.fifth.british_overtaken import british_overtaken
from tests.outsiders.fifth.british_overtaking import british_overtaking
from tests.outsiders.fifth.british_passing import british_passing
from tests.outsiders.fifth.british_streets import british_streets
from tests.outsiders.fifth.british_systems import british_systems
from tests.outsiders.fifth.british_turning import british_turning
from tests.outsiders.fifth.german_junctions import german_junctions
from tests.outsiders.fifth.german_lanes import german_lanes
from tests.outsiders.fifth.german_late import german_late
from tests.outsiders.fifth.german_motorways import german_motorways
from tests.outsiders.fifth.german_roads import german_roads

if TYPE_CHECKING:
    from tests.outsiders.fifth.drive import Drive

CHAPTERS = (
    british_overtaking,
    british_overtaken,
    british_passing,
    british_obstacles,
    british_lights,
    british_turning,
    british_corners,
    british_crossings,
    british_streets,
    british_motorways,
    british_exits,
    british_systems,
    british_declared,
    german_motorways,
    german_lanes,
    german_roads,
    german_junctions,
    british_late,
    british_latest,
    german_late,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
