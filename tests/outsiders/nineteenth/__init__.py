"""The scenes of the nineteenth outsider: country roads, motorways, junctions and crossings, in Great Britain and in Germany.

Everything is drawn as driven on the right, along x, with y to the left; drives in Great Britain are mirrored. Each verdict has its
reason; what a scene says is those reasons.
"""

from __future__ import annotations

from tests.outsiders.nineteenth.crossings import contact, crossing_traffic, signalled_crossings, zebras
from tests.outsiders.nineteenth.drive import Drive
from tests.outsiders.nineteenth.following_drives import close_behind, closing_in, cut_in_on, odd_ones_ahead
from tests.outsiders.nineteenth.junctions import crossing_ways, stopping_at_lines, turning_across, turning_near_side
from tests.outsiders.nineteenth.meeting import being_overtaken, obstructions
from tests.outsiders.nineteenth.motorways import (
    braking_and_speed,
    distances,
    exits,
    lorries_and_shoulders,
    on_the_wrong_side,
    stopping,
)
from tests.outsiders.nineteenth.overtaking import (
    declared_decisions,
    declared_looks,
    lines_that_end,
    long_and_fast,
    oncoming_and_lines,
    others_about,
)
from tests.outsiders.nineteenth.passing_drives import cyclists, horses, in_germany, more_cyclists
from tests.outsiders.nineteenth.roads import footways_and_limits, parking_and_choice
from tests.outsiders.nineteenth.systems import accelerations, lane_keeping

CHAPTERS = (
    oncoming_and_lines,
    lines_that_end,
    others_about,
    long_and_fast,
    declared_decisions,
    declared_looks,
    obstructions,
    being_overtaken,
    cut_in_on,
    close_behind,
    closing_in,
    odd_ones_ahead,
    cyclists,
    in_germany,
    more_cyclists,
    horses,
    footways_and_limits,
    parking_and_choice,
    distances,
    braking_and_speed,
    stopping,
    on_the_wrong_side,
    lorries_and_shoulders,
    exits,
    accelerations,
    lane_keeping,
    stopping_at_lines,
    turning_across,
    turning_near_side,
    crossing_ways,
    zebras,
    signalled_crossings,
    crossing_traffic,
    contact,
)


def drives() -> list[Drive]:
    """Return every drive."""
    drawn = [drive for chapter in CHAPTERS for drive in chapter()]
    return [drive.placed(i) for i, drive in enumerate(drawn)]
