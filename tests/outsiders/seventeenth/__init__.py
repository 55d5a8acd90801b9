"""The scenes of the seventeenth outsider: both countries and all packs, Great Britain above all.

Each verdict has its reason; what a scene says is those reasons.
"""

from __future__ import annotations

from tests.outsiders.seventeenth import (
    british_crossings,
    british_gaps,
    british_lights,
    british_lines,
    british_motorways,
    british_overtakes,
    british_rounds,
    british_turns,
    comfort,
    declared,
    german_motorways,
    german_systems,
    passing,
    stops,
    streets,
)
from tests.outsiders.seventeenth.drive import Drive

CHAPTERS = (
    british_gaps.DRIVES,
    british_overtakes.DRIVES,
    passing.DRIVES,
    british_lines.DRIVES,
    streets.DRIVES,
    stops.DRIVES,
    british_lights.DRIVES,
    british_turns.DRIVES,
    british_crossings.DRIVES,
    british_rounds.DRIVES,
    british_motorways.DRIVES,
    german_motorways.DRIVES,
    german_systems.DRIVES,
    comfort.DRIVES,
    declared.DRIVES,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [drive for chapter in CHAPTERS for drive in chapter]
