"""Great Britain: crossroads."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.junctions import ARM_M, crossroads
from tests.outsiders.ninth.maps import route
from tests.outsiders.ninth.movement import ego, who
from tests.outsiders.ninth.ways import Way, meet, when


def _across_the_oncoming() -> Drive:
    drawn = crossroads()
    way, other = drawn.routes["WN"][0], drawn.routes["EW"][0]
    speeds = [(4, 11), (7, 6), (14, 6), (18, 10)]
    there, its = meet(way, other, ARM_M)
    start = its - 13 * (when(speeds, 100, there) + 1.8)
    return draw(
        "gb_turns_across_oncoming_k",
        "The ego turns right less than a second before an oncoming car.",
        "fail r180.right-turn-gap criticality.pet",
        drawn,
        [ego(way, 100, speeds, indicator=[(0, "offside")]), who("onc", "car", other, start, 13)],
        24,
    )


def _left_hook() -> Drive:
    drawn = crossroads()
    way, ahead = drawn.routes["WS"][0], drawn.routes["WE"][0]
    beside = Way(ahead.x, ahead.y - 1.3, ahead.heading)
    speeds = [(7.4, 11), (9.4, 5.5), (13, 5.5), (16, 9)]
    there, its = meet(way, beside, ARM_M)
    indicator = [(0, "off"), (7, "near"), (15, "off")]
    start = its - 5.5 * (when(speeds, 60, there) + 1.3)
    return draw(
        "gb_left_hook_k",
        "The ego passes a cyclist closely and turns left before it.",
        "fail h3.no-cut-across r182.no-pass-before-turn r163.cyclist",
        drawn,
        [
            ego(way, 60, speeds, [(3, 0), (5, 0.5), (8, 0.5), (9.4, 0)], indicator=indicator),
            who("cyc", "bicycle", beside, start, 5.5),
        ],
        20,
    )


def british_junctions() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_stop_sign_rolled_k",
            "The ego rolls past a stop sign.",
            "fail r171.stop-sign",
            crossroads(stops="WE"),
            [ego(route("WE"), 40, [(7, 11), (11, 3.2), (12.5, 3.2), (16, 9)])],
            20,
        ),
        draw(
            "gb_green_among_red_heads_k",
            "The ego drives through a junction on green, which all others have red.",
            "pass r175.red",
            crossroads(lights="WENS"),
            [ego(route("WE"), 40, 11)],
            20,
            lights={"LW": [(0, "red"), (4, "red_amber"), (5.5, "green")], **{f"L{arm}": [(0, "red")] for arm in "ENS"}},
        ),
        _across_the_oncoming(),
        _left_hook(),
    ]
