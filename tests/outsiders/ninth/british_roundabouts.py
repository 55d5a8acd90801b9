"""Great Britain: roundabouts."""

from __future__ import annotations

import math

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.junctions import ARM_M, roundabout
from tests.outsiders.ninth.maps import route
from tests.outsiders.ninth.movement import ego, who
from tests.outsiders.ninth.ways import Piece, along, cubic, meet, when


def _wrong_way_round() -> Drive:
    entry = cubic((-45, -1.75, 0), (20.5 * math.cos(2.58), 20.5 * math.sin(2.58), 2.58 - math.pi / 2))
    wrong = along([Piece(-145, -1.75, 0, 100), entry, Piece(*entry.end(), 110, -1 / 20.5)])
    return draw(
        "gb_roundabout_wrong_way_k",
        "The ego goes round a roundabout the wrong way.",
        "fail r143.direction",
        roundabout(60, "mph"),
        [ego(wrong, 0, [(4, 12), (8, 6.5)]), who("honest", "car", route("SE"), 60, [(6, 8), (9, 0)])],
        30,
    )


def _third_exit() -> Drive:
    drawn = roundabout(60, "mph")
    way, other = drawn.routes["WN"][0], drawn.routes["NE"][0]
    _, its = meet(way, other, ARM_M + 5)
    speeds = [(6, 14), (13, 0), (17, 0), (21, 6), (36, 6), (40, 12)]
    indicator = [(0, "off"), (7, "offside"), (29, "near"), (38, "off")]
    return draw(
        "gb_roundabout_waits_then_third_exit_k",
        "The ego waits for a car on a roundabout and takes the third exit.",
        "pass r143.direction no-collision",
        drawn,
        [ego(way, ARM_M - 3 - 84 - 49, speeds, indicator=indicator), who("round", "car", other, its - 7 * 16, 7)],
        46,
    )


def _into_a_lorry() -> Drive:
    drawn = roundabout(40, "mph")
    way, other = drawn.routes["WE"][0], drawn.routes["NE"][0]
    there, its = meet(way, other, ARM_M + 5)
    speeds = [(4, 11), (8, 6)]
    start = its - 7 * when(speeds, 80, there) - 3.5
    return draw(
        "gb_roundabout_pulls_out_into_lorry_k",
        "The ego drives onto a roundabout and into a lorry on it.",
        "fail no-collision",
        drawn,
        [ego(way, 80, speeds), who("lorry", "truck", other, start, 7)],
        20,
    )


def _across_a_cyclist() -> Drive:
    drawn = roundabout(40, "mph")
    way, _, exit_at = drawn.routes["WE"]
    past = drawn.routes["WN"][0]
    outer = past.beside(-1.8)
    speeds = [(4, 10), (8, 6)]
    there, its = meet(way, outer, exit_at - 45)
    start = its - 5 * (when(speeds, 60, there) + 1.2)
    return draw(
        "gb_roundabout_exit_across_cyclist_k",
        "The ego leaves a roundabout before a cyclist who goes on round it.",
        "fail h3.no-cut-across",
        drawn,
        [ego(way, 60, speeds, indicator=[(0, "off"), (14, "near")]), who("cyc", "bicycle", outer, start, 5)],
        38,
    )


def british_roundabouts() -> list[Drive]:
    """Return its drives."""
    return [
        _wrong_way_round(),
        _third_exit(),
        _into_a_lorry(),
        _across_a_cyclist(),
    ]
