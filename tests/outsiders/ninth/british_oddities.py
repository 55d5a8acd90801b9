"""Great Britain: overtakes in logs that lack something, and a bridge."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from tests.outsiders.ninth.cast import FASTER, INDICATED, out_and_back
from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import country, opposite, own
from tests.outsiders.ninth.movement import SIZELESS, ego, oncoming, who
from tests.outsiders.ninth.ways import chain, gone

if TYPE_CHECKING:
    from tests.outsiders.ninth.road import Map


def _under_a_bridge() -> Map:
    drawn, other = country(), country()
    above = other.roads[0]
    above.number, above.pieces, above.level, above.bridge = (
        2,
        chain(400, -200, math.pi / 2, [(400, 0)]),
        8.0,
        (150, 100),
    )
    drawn.roads.append(above)
    return drawn


def british_oddities() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_overtake_heading_turned_k",
            "The ego squeezes past an oncoming car; the headings of the others are turned round in the log.",
            "not pass r162.safe-distance-ahead rss.opposite",
            country(1200),
            [
                ego(own, 60, FASTER, out_and_back(), indicator=INDICATED),
                who("slow", "car", own, 100, 13, turned=True),
                oncoming("onc", "car", 60 + gone(FASTER, 14.3), 14.3, 24, -0.9, turned=True),
            ],
            22,
        ),
        draw(
            "gb_overtake_no_sizes_k",
            "The ego squeezes past somebody oncoming who has neither class nor size.",
            "not pass r162.safe-distance-ahead no-collision",
            country(1200),
            [
                ego(own, 60, FASTER, out_and_back(), indicator=None),
                who("slow", None, own, 100, 13),
                oncoming("onc", None, 60 + gone(FASTER, 14.5), 14.5, 24, -0.9, size=SIZELESS),
            ],
            22,
        ),
        draw(
            "gb_overtake_oncoming_vanishes_k",
            "The ego overtakes; the track of the oncoming car ends 90 m ahead.",
            "not pass r162.safe-distance-ahead",
            country(1200),
            [
                ego(own, 60, FASTER, out_and_back(), indicator=INDICATED),
                who("slow", "car", own, 100, 13),
                oncoming("onc", "car", 60 + gone(FASTER, 13.8), 13.8, 24, -0.9, until=11.8),
            ],
            22,
        ),
        draw(
            "gb_overtake_two_hertz_k",
            "The ego overtakes a bus and squeezes past a lorry; the log has two steps a second.",
            "not pass r162.safe-distance-ahead",
            country(1200),
            [
                ego(own, 60, FASTER, out_and_back(), indicator=INDICATED),
                who("slow", "bus", own, 104, 13),
                oncoming("onc", "truck", 60 + gone(FASTER, 14.7), 14.7, 22, -0.7),
            ],
            24,
            rate=2,
        ),
        draw(
            "gb_overtake_off_the_map_k",
            "The ego overtakes near the end of the map, from beyond which a car comes.",
            "not pass r162.safe-distance-ahead",
            country(300),
            [
                ego(own, 60, FASTER, out_and_back(), indicator=INDICATED),
                who("slow", "car", own, 100, 13),
                who("onc", "car", opposite, 300 - (60 + gone(FASTER, 15)) - 23 * 15, 23, -0.8),
            ],
            22,
        ),
        draw(
            "gb_under_the_bridge_k",
            "The ego drives under a bridge as a lorry drives over it.",
            "not fail no-collision criticality.pet",
            _under_a_bridge(),
            [
                ego(own, 60, 20),
                who("above", "truck", lambda drawn: drawn.way(1.8, 1).back(), 400 - 198.2 - 20 * 17, 20),
            ],
            24,
        ),
    ]
