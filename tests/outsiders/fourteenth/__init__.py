"""The scenes of the fourteenth outsider: following, speeds and lane changes on motorways, automated systems, and the rest.

Places along a road are metres along its reference line (`s`) and across it, counted to the side that is driven on (`u`).
"""

from __future__ import annotations

from tests.outsiders.fourteenth.between_steps import between_steps
from tests.outsiders.fourteenth.braking import braking
from tests.outsiders.fourteenth.british_motorways import british_motorways
from tests.outsiders.fourteenth.crossings import crossings
from tests.outsiders.fourteenth.cut_ins import cut_ins
from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.excuses import excuses
from tests.outsiders.fourteenth.exits import exits
from tests.outsiders.fourteenth.gaps import gaps
from tests.outsiders.fourteenth.german_gaps import german_gaps
from tests.outsiders.fourteenth.german_lanes import german_lanes
from tests.outsiders.fourteenth.german_stops import german_stops
from tests.outsiders.fourteenth.hard_driving import hard_driving
from tests.outsiders.fourteenth.lane_changes import lane_changes
from tests.outsiders.fourteenth.looks import looks
from tests.outsiders.fourteenth.marks import marks
from tests.outsiders.fourteenth.overtakes import overtakes
from tests.outsiders.fourteenth.own_changes import own_changes
from tests.outsiders.fourteenth.red_lights import red_lights
from tests.outsiders.fourteenth.soft_users import soft_users
from tests.outsiders.fourteenth.speeds import speeds
from tests.outsiders.fourteenth.stop_signs import stop_signs
from tests.outsiders.fourteenth.streets import streets
from tests.outsiders.fourteenth.turned_lines import turned_lines
from tests.outsiders.fourteenth.turns import turns

CHAPTERS = (
    gaps,
    cut_ins,
    braking,
    lane_changes,
    turned_lines,
    speeds,
    german_gaps,
    german_lanes,
    german_stops,
    british_motorways,
    exits,
    overtakes,
    marks,
    soft_users,
    streets,
    looks,
    hard_driving,
    red_lights,
    stop_signs,
    turns,
    crossings,
    own_changes,
    between_steps,
    excuses,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
