"""The scenes of the first outsider: ways through places (s, n), British roads first.

Roads are OpenDRIVE, written here; movement is smooth: speeds are given at a few times and blurred, ways at a few places and
joined without kinks. `n` is the distance to the near side of a road's reference line (left in Britain, right in Germany), seen
by whoever drives with growing s: one's own lane has n > 0, the oncoming one n < 0. What is expected was written down before the
first run, but for one expectation in which the outsider was wrong: r126.ds-av-out-of-ov of `overtake_last_moment`, where the ego's
outline stays 3 cm out of the danger space.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.first.crossings import crossings
from tests.outsiders.first.following import following
from tests.outsiders.first.germany import germany
from tests.outsiders.first.harder import harder
from tests.outsiders.first.junctions import junctions
from tests.outsiders.first.lanes import lanes
from tests.outsiders.first.motorways import motorways
from tests.outsiders.first.overtaking import overtaking
from tests.outsiders.first.town import town

if TYPE_CHECKING:
    from tests.outsiders.first.chapter import Spec

CHAPTERS = (overtaking, following, lanes, town, crossings, junctions, motorways, germany, harder)


def drives() -> list[Spec]:
    """Return every drive."""
    return [spec for chapter in CHAPTERS for spec in chapter()]
