"""Germany: crossroads and a roundabout."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.junctions import ARM_M, crossroads, roundabout
from tests.outsiders.ninth.maps import route
from tests.outsiders.ninth.movement import ego, who
from tests.outsiders.ninth.ways import gone, meet, straight, when


def _in_the_way() -> Drive:
    braking = [(7, 11), (11, 3.5), (14, 0)]
    ahead = 60 + gone(braking, 14) + 7
    first = [(0, "green"), (18, "amber"), (21, "red")]
    second = [(0, "red"), (24, "green")]
    return draw(
        "de_kreuzung_zugestellt_k",
        "The ego enters a junction on green and stands in it behind a car.",
        "fail r176.green-exit-clear",
        crossroads(limit=50, unit="km/h", lights="WENS"),
        [
            ego(route("WE"), 60, [*braking, (25, 0), (29, 6)]),
            who("vor", "car", route("WE"), ahead, [(24, 0), (28, 7)]),
        ],
        36,
        lights={"LW": first, "LE": first, "LN": second, "LS": second},
    )


def _cut_corner() -> Drive:
    drawn = crossroads("rural", 70, "km/h", 0)
    way, other = drawn.routes["WN"][0], drawn.routes["EW"][0]
    speeds = [(3, 13), (6, 6.5), (14, 6.5), (17, 11)]
    there, its = meet(way, other, ARM_M)
    t = when(speeds, 80, there)
    braking = [(t - 2, 16), (t + 0.5, 5)]
    start = its - 14 - gone(braking, t + 0.5) + 4
    return draw(
        "de_linksabbieger_schneidet_k",
        "The ego turns left before an oncoming car, which brakes, and cuts the corner.",
        "fail r180.right-turn-gap r180.corner-cut",
        drawn,
        [
            ego(
                way,
                80,
                speeds,
                [(7, 0), (10.5, 2.6), (14, 2.6), (17, 0)],
                indicator=[(0, "off"), (3, "offside"), (18, "off")],
            ),
            who("onc", "car", other, start, [*braking, (t + 3, 5), (t + 6, 14)]),
        ],
        24,
    )


def _before_a_walker() -> Drive:
    drawn = crossroads(limit=50, unit="km/h")
    way, walker = drawn.routes["WS"][0], straight(8, -17, -6, -17)
    speeds = [(6, 10), (9, 5)]
    there, its = meet(way, walker, ARM_M)
    start = its - 1.4 * (when(speeds, 70, there) + 1.9)
    return draw(
        "de_rechtsabbieger_fussgaenger_k",
        "The ego turns right before somebody who crosses the side road.",
        "fail h2.turn-pedestrian",
        drawn,
        [
            ego(way, 70, speeds, indicator=[(0, "off"), (5, "near"), (18, "off")]),
            who("fuss", "pedestrian", walker, start, 1.4),
        ],
        24,
    )


def german_junctions() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "de_stoppschild_ueberrollt_k",
            "The ego rolls past a stop sign.",
            "fail stvo.rin1 r171.stop-sign",
            crossroads("rural", 70, "km/h", 0, stops="WE"),
            [ego(route("WS"), 40, [(6, 12), (11, 2.5), (14, 2.5), (19, 8)], indicator=[(0, "off"), (6, "near")])],
            22,
        ),
        draw(
            "de_kreisel_zu_schnell_k",
            "The ego drives through a roundabout at 36 km/h.",
            "fail comfort.lateral | pass r143.direction",
            roundabout(70, "km/h"),
            [ego(route("WE"), 60, [(4, 14), (6, 10), (20, 10)])],
            22,
        ),
        _in_the_way(),
        _cut_corner(),
        _before_a_walker(),
    ]
