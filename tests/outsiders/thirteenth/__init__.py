"""The scenes of the thirteenth outsider: junctions, overtaking and people on foot, on bicycles and on horses; then the rest.

Roads go along x, and junctions lie about the origin. Each verdict has its reason; what a scene says is those reasons.
"""

from __future__ import annotations

from tests.outsiders.thirteenth import (
    crossings,
    declared,
    following,
    junctions,
    motorways,
    overtaking,
    passing,
    roads,
    systems,
    turns,
)
from tests.outsiders.thirteenth.drive import Drive

CHAPTERS = (
    overtaking.with_oncoming,
    overtaking.seen_late,
    overtaking.room,
    overtaking.lines,
    overtaking.signs,
    passing.british_cyclists,
    passing.german_cyclists,
    passing.animals,
    passing.by_others,
    passing.parked,
    junctions.british_stop_signs,
    junctions.german_stop_signs,
    junctions.red_lights,
    junctions.red_in_time,
    junctions.queues,
    junctions.straight_on,
    junctions.roundabouts,
    turns.across_the_oncoming,
    turns.corners,
    turns.people_on_foot,
    turns.cyclists,
    turns.passed_before_a_turn,
    crossings.zebras,
    crossings.standing,
    crossings.past_others,
    crossings.signalled,
    crossings.second_look,
    motorways.distances,
    motorways.lorry_distances,
    motorways.speeds,
    motorways.lane_changes,
    motorways.passing,
    motorways.standing,
    motorways.lorries,
    motorways.hard_shoulders,
    motorways.exits,
    following.headways,
    following.headways_kept,
    following.conflicts,
    following.dropping_back,
    roads.keeping_to_it,
    roads.limits,
    roads.lamps,
    roads.comfort,
    roads.by_hand,
    roads.cyclists,
    declared.speeds,
    declared.overtakes,
    systems.gaps,
    systems.manoeuvres,
    systems.lane_changes,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter()]
