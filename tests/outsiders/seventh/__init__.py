"""The scenes of the seventh outsider: all British rules in turn on odd roads, Germany, systems, and damaged logs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.seventh import (
    british_crossings,
    british_following,
    british_lights,
    british_lines,
    british_motorways,
    british_overtaking,
    british_passing,
    british_roundabouts,
    british_streets,
    british_turning,
    british_waiting,
    german_motorways,
    german_roads,
    german_stopping,
    german_systems,
)

if TYPE_CHECKING:
    from tests.outsiders.seventh.drive import Drive

CHAPTERS = (
    british_crossings.DRAWN,
    british_waiting.DRAWN,
    british_overtaking.DRAWN,
    british_lines.DRAWN,
    british_passing.DRAWN,
    british_following.DRAWN,
    british_streets.DRAWN,
    british_lights.DRAWN,
    british_turning.DRAWN,
    british_roundabouts.DRAWN,
    british_motorways.DRAWN,
    german_motorways.DRAWN,
    german_stopping.DRAWN,
    german_systems.DRAWN,
    german_roads.DRAWN,
)


def drives() -> list[Drive]:
    """Return every drive."""
    return [scene() for chapter in CHAPTERS for scene in chapter]
